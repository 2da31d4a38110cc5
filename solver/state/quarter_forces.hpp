// Forces of the rock where particles stand for four (see state/quarters.hpp).
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Adds to state.sums, as particles_to_grid() leaves them, what the forces f_i = -sum V sigma grad N_i (N/m) of the
/// quarters that particles stand for are more than these particles' own; u: displacements of all records (m). Throws
/// nothing but std::bad_alloc.
void exert_quarters(const Scene& scene, const std::vector<Elasticity>& rocks, const std::vector<Vec2>& u, State& state);

}  // namespace strata
