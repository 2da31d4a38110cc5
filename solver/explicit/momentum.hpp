// The nodal part of an explicit step, between the two loops over particles.
#pragma once

#include <algorithm>

#include "explicit/transfers.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// Sums over the nodes of a step, those of them that a stage forms.
struct NodeTotals {
  double kinetic = 0.0;    // sum m v^2/2 (J/m)
  double increment = 0.0;  // sum m dv^2/2, dv what all forces added in the step (J/m)
  double power = 0.0;      // sum m v . a (W/m)
  double product = 0.0;    // sum m v . v, the velocities of the step's start and end (J/m)
  double largest_speed2 = 0.0;

  NodeTotals& operator+=(const NodeTotals& more) {
    kinetic += more.kinetic, increment += more.increment, power += more.power, product += more.product;
    largest_speed2 = std::max(largest_speed2, more.largest_speed2);
    return *this;
  }
};

/// Momentum balance at the masters: v_i = mom_i/m_i (1 - damping dt) + dt f_i/m_i, written to state.motion with the
/// increment dt f_i/m_i beside it. Forces are those of the step's start, t; v stands for t + dt/2, and places are those
/// of the central difference u(t + dt) - 2 u(t) + u(t - dt) = dt^2 f(t)/m, of second order in dt for any load that is
/// taken at t. Ghosts must be folded before. Returns kinetic energy and power of the velocities mom_i/m_i.
NodeTotals advance_momentum(double damping, State& state);

/// Kinetic energy, increment and product over masters, once reactions have been added to state.motion; momenta are
/// those of the step's start.
NodeTotals grid_energy(const State& state);

/// Adds to the ledger what damping took in a step, its force damping m v_start along the mean of the velocities at the
/// step's start and end: with keep = 1 - damping dt, (1 - keep) sum m v_start . (v_start + v_end)/2 (J/m). What this
/// and the loss of kinetic energy by damping alone differ by goes to the step itself (Ledger::integration). kinetic: at
/// the start; product: of grid_energy() (J/m). Throws nothing.
void take_damping(double keep, double kinetic, double product, Ledger& ledger);

/// Gives tied records the motion of their masters.
void spread_to_tied(State& state);

/// Work of the body force in the step, dt sum_i f_i . v_i (J/m), from what add_body_force() left; tied records must
/// have their motion.
double body_work(const State& state);

/// What particles take up under the scene's transfer, and the share of their own velocity they keep: FLIP dv and
/// 1 - damping dt; PIC v and XPIC(2) 2 v - v** + dv with the mapped v, and nothing.
Uptake prepare_transfer(const Scene& scene, State& state);

/// Throws NumericalFailure where the motion has become unstable: where its kinetic energy is not finite, or more than
/// 10 times all that loads have put in or drawn out and the block started with, and more than rounding makes.
void require_stable(const Scene& scene, const Rocks& rocks, const State& state);

/// Energy that the time step and the transfer have made, net (J/m), for the monitors. Velocities stand for the middle
/// of a step and strain for its end, so that their energies' sum swings; what central differences keep is
/// v_(n-1/2) M v_(n+1/2)/2 + u_n K u_n/2 (e.g. Hairer, Lubich & Wanner 2003, Acta Numerica 12, 399), which is kinetic +
/// swing + strain with swing = dt v_(n-1/2) . f_n/2 of the forces taken at t_n, friction's among them; springs'
/// implicit step does not swing. Beyond the stable step kinetic + swing falls below zero without bound: what it is
/// below minus the largest energy exchanged so far counts as made. kinetic: at t_(n-1/2), J/m. Throws nothing.
void watch_made(double kinetic, double swing, State& state);

/// Expected momentum after one step of inertia: sum m v of its start, less what damping took, plus dt sum m b of the
/// body force (kg/s per metre of thickness). Tractions on the two faces of a surface cancel, in-situ ones at edges are
/// in balance with the in-situ state. Throws nothing.
void expect_momentum(const Scene& scene, State& state);

/// Time step (s): courant h/c_P of the fastest rock. Limits by the largest eigenvalue of M^-1 K beside free edges, with
/// 4 points a cell: 1.16 (B-spline) and 1.00 (linear) times h/c_P; 4/(2 - S) instead of 4 in (omega dt)^2 where FLIP
/// smooths accelerations to the fraction S: 0.86 and 0.75, as points move 0.69 and 0.65; uGIMP particles that reach
/// over a free edge lower it to 0.59 (4 points a cell), 0.53 (9) and 0.48 (16). verification/stability measures them.
double time_step(const Scene& scene, double fastest);

}  // namespace strata
