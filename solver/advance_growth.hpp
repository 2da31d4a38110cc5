// Growth of runs with inertia where energy decides: between equilibria of the same particles at the present pressures.
#pragma once

#include <memory>
#include <vector>

#include "advance_trials.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// The rock of a run with inertia as it would be at rest. All of it follows from the state.
struct RestingRock {
  Scene scene;  // the run's, without inertia
  State state;
  QuasistaticModel model;
  std::vector<GrowthTrial> trials;
  std::vector<double> P;      // of the fracture's points when it was last looked at (Pa)
  double nearest = 0.0;       // sqrt(G/J_c) of the tip nearest to growth then
  bool without_rest = false;  // there is no equilibrium
};

// Made where it is first needed; forget it (reset) wherever a resumed run would begin.
using Resting = std::unique_ptr<RestingRock>;

/// Notes what decides about each tip and, where that is energy, what growth would release at the present pressures, in
/// tip.G_trial. It is looked at again once pressures have changed by a third of what is missing, by 0.2 % at least and
/// 10 % at most of the net pressure; under a body force each time. Where the rock at rest has no equilibrium, as where
/// surfaces cut off parts that nothing but inertia holds, K decides, and monitors.growth_unweighed counts it. Throws
/// nothing but std::bad_alloc.
void weigh_growth(const Scene& scene, const std::vector<Elasticity>& rocks, State& state, Resting& resting);

}  // namespace strata
