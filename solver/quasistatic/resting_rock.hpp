// Growth of runs with inertia where energy decides: between equilibria of the same particles at the present pressures.
#pragma once

#include <functional>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// What explicit steps ask before tips may grow (WeighGrowth): notes what decides about each tip and, where that is
/// energy, what growth would release at the present pressures, in tip.G_trial. It is looked at again once pressures
/// have changed by a third of what is missing, by 0.2 % at least and 10 % at most of the net pressure; under a body
/// force each time. Where the rock at rest has no equilibrium, as where surfaces cut off parts that nothing but inertia
/// holds, K decides, and monitors.growth_unweighed counts it. What it keeps from one call to the next follows from the
/// state: make it anew wherever a resumed run would begin. scene and rocks must outlive it. Throws nothing but
/// std::bad_alloc.
std::function<void(State&)> growth_weighing(const Scene& scene, const Rocks& rocks);

}  // namespace strata
