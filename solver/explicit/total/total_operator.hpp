// The rock's force under kinematics = "total": one fixed operator of nodal displacements between two events.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// -M^-1 K of a state as runs of records that share a stencil, and single ones: rows are assembled from the particles'
/// own weights, and records with the same surroundings share them. Its copies and masters must be built.
StencilOperator make_operator(const Scene& scene, const Rocks& rocks, const State& state);

// Sums over the nodes of a step, taken part by part so that they do not depend on the number of threads.
struct NodeTotals {
  double kinetic = 0.0;    // sum m v^2/2 (J/m)
  double increment = 0.0;  // sum m dv^2/2, dv what all forces added in the step (J/m)
  double power = 0.0;      // sum m v . a (W/m)
  double product = 0.0;    // sum m v . v, the velocities before and after (J/m)
  double largest_speed2 = 0.0;
};

/// v_i = keep v_i + dt a_i, u_i += dt v_i. Power is that of the a_i given, at the new velocities.
NodeTotals move_nodes(double keep, State& state);

/// a_i = a_i at the base - (M^-1 K u)_i, by numerics.kernels through the composed stencils or by a loop over all
/// particles. Returns the power sum m v . a of these forces.
double find_accelerations(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
