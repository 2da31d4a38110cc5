// What is told of a tip: a number that is none is not shown as one.
#pragma once

#include <string>

#include "state/state.hpp"

namespace strata {

// J, K and kink of a tip; not-a-number where there is no such number, and then why.
struct TipNumbers {
  double K_I_Pa_sqrt_m, K_II_Pa_sqrt_m, J_N_m, J_spread, kink_deg;
  std::string reason;  // why some are none, a sentence; empty where all are there
};

/// The numbers of a tip. Where its rings cross an obstacle J and K are none (but for a tip whose faces touch and do not
/// slide: 0), nor is the kink of a closed tip, nor a J below zero without inertia. Throws nothing but std::bad_alloc.
TipNumbers tip_numbers(const Scene& scene, const Tip& tip);

/// What is too near to a tip, in a word or two: "interface", "rock border", "symmetry line", "edge", "fracture"; ""
/// where nothing. Throws nothing.
const char* name_of(Obstacle what);

}  // namespace strata
