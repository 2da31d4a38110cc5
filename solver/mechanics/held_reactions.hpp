// Reactions of the places that contact, stick and springs hold, solved together.
#pragma once

#include "state/state.hpp"

namespace strata {

/// Starts a step's sweeps near their end: places stay closed, open, stuck or sliding as their reactions r say, and
/// those that are held by a stiffness k (contact, stick) or D (springs) get the reactions that solve, with w the jump
/// at the step's end, linear in all reactions of the step,
///   w + r/k = rest of the law
/// along the normal, the tangent or both. (A D M^-1 D^T + A/k, small, banded and positive definite, is factored anew
/// only where a place changes.) The laws themselves are not looked at: sweeps from here find out where a place lets go,
/// closes or slides. Changes reactions of the state's points and surfaces.rate_x, rate_y.
void solve_held_reactions(State& state, TotalSurfaces& surfaces);

}  // namespace strata
