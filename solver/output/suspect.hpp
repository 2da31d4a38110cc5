// What the monitors of a run say of it, and from where on they mark it: a run that is marked may be right, but is not
// to be trusted unseen.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// A figure about a run that has no unit and is judged or only told.
struct Watched {
  std::string monitor;              // its key among the summary's monitors
  double value = 0.0;               // a share
  std::optional<double> threshold;  // above it, and where the value is no finite number, the run is suspect; none: a
                                    // figure alone
  std::string why;                  // what it means for the run
};

/// The figures that apply to a run of this scene, from its state's monitors and ledger; each with the reason for its
/// threshold in the source. Throws nothing but std::bad_alloc.
std::vector<Watched> watched(const Scene& scene, const State& state);

/// Those that mark it: above their threshold, or not finite.
std::vector<Watched> suspicions(const Scene& scene, const State& state);

}  // namespace strata
