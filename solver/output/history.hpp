// The history of a run: one row per growth event and per output time, without anything that depends on the wall clock.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"
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

/// The tip with the largest y, the first of equal ones, or nullptr where there is none; throws nothing.
const Tip* leading_tip(const State& state);

/// The tip that is not the leading one, or nullptr where there are not two; throws nothing.
const Tip* lower_tip(const State& state);

/// Opening face to face (m) at the end of the fracture on the symmetry line y = 0 or, where none lies there, the
/// largest of its vertices; 0 without a fracture. Throws nothing.
double mouth_opening(const State& state);

/// Area between the fracture's faces (m^2), sum A w . n, without what symmetry left out; 0 without a fracture. Throws
/// nothing.
double fracture_volume(const State& state);

/// Fluid that the rock has taken through the faces there (m^2). Throws nothing.
double leaked_volume(const State& state);

// A column's name, which ends in its unit, the unit apart, its value in a state, and what it is.
struct HistoryColumn {
  std::string name;
  const char* unit;
  double value;
  const char* description;
};

/// The columns in the order of history.csv, with their values in a state: of the leading tip, nan where it has no such
/// number or there is none (opening, volume and inlet pressure are 0 then); leaked_m2 where a rock takes up fluid; more
/// of the lower tip where there are two.
/// Throws std::bad_alloc only.
std::vector<HistoryColumn> history_columns(const Scene& scene = Scene(), const State& state = State());

using HistoryRow = std::vector<double>;  // a value of each column

/// The row that describes a state; throws std::bad_alloc only.
HistoryRow history_row(const Scene& scene, const State& state);

/// The first line of history.csv and that of a row, of which numbers are the shortest that read back to the same
/// double. Throws std::bad_alloc only.
std::string history_header(const std::vector<HistoryColumn>& columns = history_columns());
std::string history_line(const HistoryRow& row);

}  // namespace strata
