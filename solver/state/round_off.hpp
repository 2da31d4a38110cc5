// What is too small to be anything but round-off.
#pragma once

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// Figures below which nothing is said of a run: what is left where stresses of the scene's size cancel. A stress s
// leaves 1e-16 s an operation, and thousands of these add up: 1e-12 s. With it go displacements and velocities, so that
// energies, which are products of two, have its square.
struct RoundOff {
  double stress = 0.0;    // Pa
  double energy = 0.0;    // s^2 V/(2 E') of the block (J/m)
  double momentum = 0.0;  // s V/c_S of the block, whose velocity is s/(rho c_S) (kg/s)
};

/// By the largest of the in-situ stresses and the inlet's pressures, at the start and now; nothing in a scene that has
/// none of these. Throws nothing.
RoundOff round_off(const Scene& scene, const State& state);

}  // namespace strata
