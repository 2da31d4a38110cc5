// Laws of surfaces: the reaction that one face exerts on the other as a function of the jump between them, and when a
// bonded place fails. Reactions act on the + face; their normal component is positive in compression.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// What a law is asked: the jump that the end of the step would see without this place's own reaction.
struct FreeJump {
  double n = 0.0;        // normal (m), positive open
  double t = 0.0;        // tangential (m)
  double t_start = 0.0;  // tangential jump at the start of the step (m), where sticking holds it
  double per_n = 0.0;    // change of the normal jump per unit of normal reaction (m/Pa)
  double per_t = 0.0;    // and of the tangential one
  double n_rest = 0.0;   // normal reaction of closed contact at zero jump (Pa): in-situ less fluid
};

// Contact yields by this fraction of per_n for each unit of reaction beyond n_rest, some 1e-4 of what a cell of rock
// yields. Rigid contact at two points a cell asks for more than the one jump a cell that exists, and the reactions
// drift.
constexpr double contact_compliance = 1e-3;

struct Reaction {
  double n = 0.0;  // Pa
  double t = 0.0;  // Pa
};

/// The reaction that satisfies a law at the end of the step, found with the place's own compliance (backward Euler, so
/// stable for any stiffness). friction, failed weak: n >= 0, w_n >= 0, n w_n = 0, |t| <= mu n (Coulomb), t opposing
/// slip; soft: n = -D_n w_n, t = -D_t w_t (the study's eq. 6), in compression contact, or n = n_rest - D_n w_n both
/// ways.
Reaction react(const InterfaceLaw& law, const FreeJump& w);

/// True if a bonded place fails under the reaction r: weak by (S/Sc)^2 + (N/Nc)^2 >= 1 with N in tension only (the
/// study's eq. 5); friction where |t| > mu n or in tension.
bool fails(const InterfaceLaw& law, const Reaction& r);

/// Checks the bonded points of weak and friction interfaces against the mean total stress of the particles around them
/// and splits the columns of those that fail, with the compression they carried as first guess of the reaction. Returns
/// true if any did; the copies must then be rebuilt.
bool fail_interfaces(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

/// Finds the reactions of all split places and of the springs of tips together (successive over-relaxation on D M^-1
/// D^T, started from the last step's reactions) and adds what they do to state.motion, which holds the motion without
/// them. Jumps are those at the end of the step. Adds to the ledger's friction, to slip and to the monitors. Throws
/// nothing: a solve that runs out of sweeps is counted there.
void solve_reactions(const Scene& scene, State& state);

/// Energy in the springs of soft interfaces, sum A (D_n w_n^2 + D_t w_t^2)/2, and of tips, sum k w^2/2 (J/m).
double spring_energy(const Scene& scene, const State& state);

}  // namespace strata
