// The opening operator D of surfaces and its transpose: the same weights serve both, so that the work of a traction on
// a surface is exactly the traction times the change of the jump.
#pragma once

#include "state/state.hpp"

namespace strata {

/// Recomputes the weights N_i(x_s) of all surface stencils at the present positions of the surfaces, after masses have
/// come to the nodes and before ghosts are folded. Surfaces use the B-spline or, for linear and uGIMP particles, the
/// hat functions.
void update_stencil_weights(const Scene& scene, State& state);

/// D u: jump of a nodal vector field across the surface at a stencil, sum_i N_i (u[plus_i] - u[minus_i]).
Vec2 jump(const SurfaceStencil& stencil, const NodalMotion& motion);

/// Mean of the two sides' velocities (m/s) at a stencil: surfaces are massless and follow it.
Vec2 mean_velocity(const SurfaceStencil& stencil, const NodalMotion& motion);

/// D^T: adds the force of a traction t (Pa, on the + face; the - face takes its opposite) over the length A (m) to the
/// sums.
void add_traction(const SurfaceStencil& stencil, const Vec2& t, double A, NodalSums& sums);

/// Adds fluid pressure beyond the in-situ traction of all split surface points: t = P n - in_situ on the fracture,
/// t = -in_situ on interfaces, whose laws then add their reactions.
void add_net_tractions(State& state);

/// Moves surfaces with the rock for state.dt, x += dt mean(v), and adds up the jumps of vertices and of what is not
/// split, w += dt D v: those of split places come with their reactions.
void follow_surfaces(State& state);

}  // namespace strata
