// Reactions of the places that contact, stick and springs hold, solved together.
#pragma once

#include "state/state.hpp"

namespace strata {

/// Brings a step's sweeps near their end: places stay closed, open, stuck or sliding as their reactions r say, and
/// those that are held by a stiffness k (contact, stick) or D (springs) get the reactions that solve, with w the jump
/// at the step's end, linear in all reactions of the step,
///   w + r/k = rest of the law
/// along the normal, the tangent or both. Places that then pull or are beyond friction's bound open or slide, and the
/// rest is solved again (an active set that only shrinks, Nocedal & Wright 2006, 16.5; 8 times at most). Sweeps from
/// here find out where a place closes or sticks again. (A D M^-1 D^T + A/k, small, banded and positive definite, is
/// factored anew only where a place changes.) Changes reactions of the state's points and surfaces.rate_x, rate_y.
void solve_held_reactions(State& state, TotalSurfaces& surfaces);

}  // namespace strata
