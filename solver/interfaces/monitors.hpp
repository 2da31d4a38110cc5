// What the monitors take up beside the steps (see state/monitors.hpp).
#pragma once

#include "state/state.hpp"

namespace strata {

/// Strain and rotation of particles and the jumps of faces as they now are: all particles must be up to date. Throws
/// nothing.
void watch_deformation(State& state);

/// Energies, momentum, contact and the fluid's net pressure as they now are, at a row of the history: the ledger's
/// strain and the particles must be up to date. At step 0 the momentum found is the one expected from there on. Throws
/// nothing.
void watch_row(const Scene& scene, State& state);

/// Throws NumericalFailure where an energy of the ledger is no finite number, and names it: all that a row or a
/// checkpoint would say of energies from there on were worth nothing.
void require_finite(const State& state);

}  // namespace strata
