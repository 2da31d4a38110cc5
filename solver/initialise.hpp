// The state a run starts from.
#pragma once

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Particles on a lattice at rest in the in-situ state, the fracture filled at its start pressure, interfaces bonded
/// (soft ones split), all derived members built. Throws NumericalFailure where the loaded in-situ state cannot be
/// found.
State initialise(const Scene& scene, const Rocks& rocks);

/// Builds the derived members of a state that was read back; what was saved stays as it is. Throws NumericalFailure as
/// rebuild_copies() does.
void restore(const Scene& scene, State& state);

}  // namespace strata
