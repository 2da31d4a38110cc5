// Forces of the rock where particles stand for four (see state/quarters.hpp).
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Puts the forces f_i = -sum V sigma grad N_i (N/m) of the quarters that particles stand for in the place of these
/// particles' own in state.sums, as particles_to_grid() leaves them; u: displacements of all records (m). Throws
/// nothing.
void exert_quarters(const Scene& scene, const std::vector<Elasticity>& rocks, const std::vector<Vec2>& u, State& state);

}  // namespace strata
