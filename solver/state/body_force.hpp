// Body forces and initial velocities that a scene gives as formulas of the place where a particle starts.
#pragma once

#include "state/state.hpp"

namespace strata {

/// The body force per mass b(X, Y, t) at every particle (m/s^2) into state.body, in the particles' present order, at a
/// time (s); leaves it empty where the scene gives none. Throws NumericalFailure where a formula is not finite.
void set_body_acceleration(const Scene& scene, double time, State& state);

/// Gives particles their velocities (m/s) and the ledger their energy. Velocities stand half a step before places (see
/// advance_momentum()), so that a scene's velocity v_0 and body force at time 0 give v_0 - (dt/2) b(X, Y, 0): with it
/// places are right to second order in dt, and free fall to round-off. Does nothing where the scene has neither. Throws
/// NumericalFailure where a formula is not finite.
void set_initial_velocity(const Scene& scene, State& state);

}  // namespace strata
