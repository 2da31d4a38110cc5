// The rock's force under kinematics = "total": one fixed operator of nodal displacements between two events.
#pragma once

#include "explicit/momentum.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// -M^-1 K of a state as runs of records that share a row: rows are assembled from the particles' own weights, and
/// records with the same surroundings share them. Its copies and masters must be built.
StencilOperator make_operator(const Scene& scene, const Rocks& rocks, const State& state);

/// v_i = keep v_i + dt a_i, u_i += dt v_i. Power is that of the a_i given, at the new velocities; product that of the
/// velocities before and after.
NodeTotals move_nodes(double keep, State& state);

/// a_i = a_i at the base - (M^-1 K u)_i, by numerics.kernels through the composed stencils or by a loop over all
/// particles. Returns the power sum m v . a of these forces.
double find_accelerations(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
