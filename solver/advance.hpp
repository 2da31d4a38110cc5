// One step of a run: the only place where mechanics, flow and fracture meet.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Rebuilds all that follows from particles and surfaces (rebuild_copies) and the springs of tips.
void rebuild(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

/// Advances the state by one explicit step of state.dt. Update stress last: forces come from the stress at the start of
/// the step, and stress, positions and jumps then take up the same new velocities, which makes the step symplectic in
/// the linear elastic part and the pressure's work exactly p dV. Throws NumericalFailure; `state` is then that of the
/// failure.
void advance(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

}  // namespace strata
