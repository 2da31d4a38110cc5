// Laws of surfaces: the reaction that one face exerts on the other as a function of the jump between them, and when a
// bonded place fails. Reactions act on the + face; their normal component is positive in compression.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// What a law is asked: the jump that the end of the step would see without this place's own reaction.
struct FreeJump {
  double n = 0.0;          // normal (m), positive open
  double t = 0.0;          // tangential (m)
  double t_start = 0.0;    // what friction remembers: tangential jump (m)
  double r_t_start = 0.0;  // and reaction (Pa) at the start of the step
  double per_n = 0.0;      // change of the normal jump per unit of normal reaction (m/Pa)
  double per_t = 0.0;      // and of the tangential one
  double n_rest = 0.0;     // normal reaction of closed contact at zero jump (Pa): in-situ less fluid
};

struct Reaction {
  double n = 0.0;  // Pa
  double t = 0.0;  // Pa
};

/// The reaction that satisfies law_at() with contact stiffness k (Pa/m) at the end of the step: r = law(w_free + per r)
/// in closed form (backward Euler, so stable for any stiffness). What runs with inertia settle on is therefore the
/// equilibrium of the law itself, whatever the step. perfect: none.
Reaction react(const InterfaceLaw& law, double k, const FreeJump& w);

// Change of a sweep, of the largest reaction, at which a step's sweeps over its places end. What is left is not lost:
// the next step starts from these reactions and sees the jumps they led to.
constexpr double reaction_tolerance = 1e-6;
// Bounds the time of a step; steps that end here are counted in the monitors.
constexpr int most_sweeps = 200;
// Share of the largest traction that the last sweep of a step may change. What the experiments leave is below 3e-3 of
// the largest reaction; friction coefficients of 1e3 and more leave more than this.
constexpr double most_left = 0.1;

/// The reaction nearest to r that a law allows whatever the jump: contact only pushes, friction is bounded.
Reaction admissible(const InterfaceLaw& law, const Reaction& r);

/// One visit of successive over-relaxation to a place whose reaction is `now`: past react(), but never out of what the
/// law allows.
Reaction over_relax(const InterfaceLaw& law, double k, const FreeJump& w, const Reaction& now);

/// The law of a tip's spring, which holds in both directions.
InterfaceLaw tie_law(const TipTie& tie);

/// Energy in the springs of a place under its law (J/m); 0 where it is not split or has none.
double spring_energy_at(const InterfaceLaw& law, const SurfacePoint& s);

/// Notes that the jump of a place changes by dw (m) under its reaction: slip (m), the ledger's friction and the
/// monitored penetration and contact pressure. Leaves the jump itself as it is.
void note_jump(const InterfaceLaw& law, const Vec2& dw, SurfacePoint& s, State& state);

/// Notes how many sweeps a step took and, where it ran out of them, what they left: the last change of a reaction (Pa)
/// against the largest reaction (Pa, 1 at least).
void note_sweeps(int sweeps, double change, double largest, Monitors& monitors);

/// Ends the run where a step ran out of sweeps while a reaction still changed by more than a tenth (most_left) of the
/// largest traction at any split place (Pa: reaction, fluid or in-situ, 1 at least): reactions that far from their laws
/// are no solution. What is left below that is noted, and marks the run. Throws NumericalFailure.
void require_settled(int sweeps, double change, double largest, const State& state);

// Bonded interfaces are looked at every so many steps: at a Courant number of 0.5 a front of failure, which goes by a
// column a look, is then as fast as a P wave.
constexpr std::int64_t looks_at_bonds = 2;

/// Whether any bonded place of a run with inertia fails now, by judge_bonds(), which is left in state.bonds. Throws
/// NumericalFailure where what it carries is not finite.
bool bonds_fail(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

/// Finds the reactions of all split places and of the springs of tips together (successive over-relaxation on D M^-1
/// D^T, started from the last step's reactions) and adds what they do to state.motion, which holds the motion without
/// them. Jumps are those at the end of the step. Adds to the ledger's friction, to slip and to the monitors. A
/// solve that runs out of sweeps is counted there. Throws NumericalFailure as require_settled() does.
void solve_reactions(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

/// Energy in the springs of soft interfaces, sum A (D_n w_n^2 + D_t w_t^2)/2, and of tips, sum k w^2/2 (J/m).
double spring_energy(const Scene& scene, const State& state);

}  // namespace strata
