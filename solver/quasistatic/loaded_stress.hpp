// Static equilibrium of the intact block on the same particles, shapes and grid.
#pragma once

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// The in-situ state `loaded`: K u = f with K = sum_p V_p B^T C B of the bonded block without fracture under the
/// in-situ tractions on sides and top (and bottom, where it is no symmetry line), whatever the scene's edges are
/// afterwards; writes the stress to particles.in_situ (Pa). Rigid motion that no edge holds is taken out. Throws
/// NumericalFailure where the factorisation fails.
void load_in_situ(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
