// One step of a run with inertia: where its stages, flow and fracture meet.
#pragma once

#include <functional>
#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// Notes what decides about each tip before it may grow and, where that is energy, what growth would release: equilibria
// of the rock at rest, which this room knows nothing of (see quasistatic/resting_rock.hpp).
using WeighGrowth = std::function<void(State&)>;

// Derived members are rebuilt at multiples of these steps in every run (of steps_between_bases under kinematics =
// "total"), and checkpoints are written at no others, so that a resumed run starts from exactly what an uninterrupted
// one holds there.
constexpr std::int64_t steps_between_rebuilds = 250, steps_between_bases = 500;

/// Advances the state by one explicit step of state.dt. Update stress last: forces come from the stress at the start of
/// the step, and stress, positions and jumps take up the same new velocities, which makes the step symplectic in the
/// linear elastic part and the pressure's work exactly p dV. Tips are measured and may grow at multiples of
/// numerics.tip_steps, and in every step while they run (runs()); look: they are measured in any case. Under kinematics
/// = "total" particles stand still until bring_up_to_date(). Throws NumericalFailure; `state` is then that of the
/// failure.
void advance(const Scene& scene, const Rocks& rocks, State& state, const WeighGrowth& weigh, bool look = true);

/// Whether any bonded place of a run with inertia fails now, by judge_bonds(), which is left in state.bonds; looked at
/// every other step. Throws NumericalFailure where what it carries is not finite.
bool bonds_fail(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
