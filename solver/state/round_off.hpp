// What is too small to be anything but round-off.
#pragma once

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// Figures below which nothing is said of a run: what is left where stresses of the scene's size cancel. A stress s
// leaves 1e-16 s an operation, and thousands of these add up: 1e-12 s. With it go displacements and velocities, and the
// work of the whole of s on such displacements; energies of rock, products of two of these, have its square.
struct RoundOff {
  double stress = 0.0;    // Pa
  double work = 0.0;      // 1e-12 of s^2 V/(2 E') of the block (J/m)
  double energy = 0.0;    // 1e-24 of it
  double momentum = 0.0;  // s V/c_S of the block, whose velocity is s/(rho c_S) (kg/s)
};

/// By the largest of the in-situ stresses and the inlet's pressures, at the start and now; nothing in a scene that has
/// none of these. Throws nothing.
RoundOff round_off(const Scene& scene, const State& state);

}  // namespace strata
