// Contact, friction and springs of an explicit step: the reactions that the faces of all split places exert on each
// other at its end. Reactions act on the + face; their normal component is positive in compression.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// Change of a sweep, of the largest reaction, at which a step's sweeps end. What is left is not lost: the next step
// starts from these reactions and sees the jumps they led to.
constexpr double reaction_tolerance = 1e-6;
// Bounds the time of a step; steps that end here are counted in the monitors.
constexpr int most_sweeps = 200;
// Share of the largest traction that the last sweep of a step may change. What the experiments leave is below 3e-3;
// friction coefficients of 1e3 and more leave more than this.
constexpr double most_left = 0.1;

/// Notes how many sweeps a step took and, where it ran out of them, what they left: the last change of a reaction (Pa)
/// against the largest reaction (Pa, 1 at least).
void note_sweeps(int sweeps, double change, double largest, Monitors& monitors);

/// Ends the run where a step ran out of sweeps while a reaction still changed by more than most_left of the largest
/// traction at any split place (Pa: reaction, fluid or in-situ, 1 at least). Throws NumericalFailure.
void require_settled(int sweeps, double change, double largest, const State& state);

/// Finds the split places of a state and the springs of its tips, state.split. Weights of stencils must be known
/// (update_stencil_weights()), and masses folded to masters: those of state.sums or, once kinematics = "total" has its
/// operator, of state.total. Throws nothing but std::bad_alloc.
void find_split_places(const Scene& scene, const Rocks& rocks, State& state);

/// Adds what the reactions of split places do in the step to state.motion, which holds the motion without them
/// (successive over-relaxation on D M^-1 D^T, started from the last step's reactions), and their jumps of the step,
/// w += dt D v, with their shares of the ledger and the monitors. Throws NumericalFailure as require_settled() does.
void solve_reactions(const Scene& scene, const Rocks& rocks, State& state);

/// The same under kinematics = "total" for places that stay as they are, with the net tractions P n - t_in_situ. What
/// they exert is added to the accelerations of the nodes, state.total.a_x and a_y. Returns its power sum m v . a at the
/// velocities of the step's end (W/m). keep: share of its velocity that a node keeps.
double push_split_places(double keep, State& state);

}  // namespace strata
