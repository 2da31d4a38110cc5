// The load of a body force on the condensed block.
#pragma once

#include "quasistatic/condensed.hpp"

namespace strata {

/// Loads the condensed block with the body force at a time (s): state.body, and condensed.load for it. With f_u on the
/// unknowns of the intact block and f_j on the jumps, K u + G j = f_u and G^T u + K_jj j = f_j + D^T t A, so that
///   S j = D^T t A + f_j - G^T u_0,  u_0 = K^-1 f_u,  u = u_0 - K^-1 G j.
/// Does nothing where the scene has no body force, or where that time's is there already. Throws NumericalFailure where
/// a formula is not finite, or where the force has a resultant along a motion of the whole block that no edge holds.
void load_body(const Scene& scene, double time, const IntactBody& body, State& state, Condensed& condensed);

}  // namespace strata
