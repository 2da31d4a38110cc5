// What a step of inertia tells the monitors of energy and momentum (see state/monitors.hpp).
#pragma once

#include "state/state.hpp"

namespace strata {

/// Energy that the time step and the transfer have made, net (J/m). Velocities stand for the middle of a step and
/// strain for its end, so that their energies' sum swings by a share omega dt/2 of itself though nothing is made; what
/// steps of the central difference keep is v_(n-1/2) M v_(n+1/2)/2 + u_n K u_n/2 (e.g. Hairer, Lubich & Wanner 2003,
/// Acta Numerica 12, 399), which is kinetic + swing + strain with swing = dt v_(n-1/2) . f_n/2 of the forces that are
/// taken at t_n, friction's among them; springs' are not, as their implicit step keeps the sum itself from swinging. It
/// is kept beyond the limit of the step as well, where kinetic + swing falls below zero without bound: velocities
/// follow each other with opposite signs and growing. What it is below minus the largest energy exchanged so far counts
/// as made. kinetic: at t_(n-1/2), J/m. Throws nothing.
void watch_made(double kinetic, double swing, State& state);

/// Expected momentum after one step of inertia: sum m v of its start, less what damping took, plus dt sum m b of the
/// body force (kg/s per metre of thickness). Tractions on the two faces of a surface cancel, in-situ ones at edges are
/// in balance with the in-situ state. Throws nothing.
void expect_momentum(const Scene& scene, State& state);

}  // namespace strata
