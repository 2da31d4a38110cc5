// How near the next event of a run without inertia is.
#pragma once

#include "quasistatic/load_steps.hpp"

namespace strata {

/// How near tip k is to growth, sqrt(G/J_c) by what decides about it, which the tip notes, or the fluid's front on its
/// way to it through an initial fracture that is dry ahead (front_margin()); where the fracture that a
/// trial makes has no equilibrium, K decides. Throws nothing.
double tip_margin(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run, std::size_t k);

/// The largest margin of all events at the state's load, 1 where one happens: growth of a tip and parting of an
/// interface by energy, sqrt(G/J_c), and failure of a bonded place, its load over its strength. Notes in `run` the
/// margins of tips and of partings, and in tips what decided. Throws NumericalFailure where one is not finite, and as
/// find_forces() does.
double margin_of(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run);

/// Throws NumericalFailure where a tip that the fluid has not come to through the initial fracture would grow by the
/// slip of its closed faces, sqrt(K_II^2/E') at J_c or above: the fluid's front, which decides there, knows nothing of
/// that.
void require_dry_tips_at_rest(const Scene& scene, const Rocks& rocks, const State& state);

}  // namespace strata
