// The laws of split places as pure functions of the jump: what the solvers with and without inertia share.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// What a law is asked at a place; the tangent is (n_y, -n_x).
struct LawInput {
  double w_n = 0.0;        // normal jump (m), positive open
  double w_t = 0.0;        // tangential jump (m)
  double w_t_start = 0.0;  // what friction remembers: tangential jump (m)
  double r_t_start = 0.0;  // and reaction (Pa) of the last equilibrium
  double bound = -1.0;     // friction's bound where it is given (Pa), instead of mu n; it then acts on open faces, too
  double n_rest = 0.0;     // normal reaction of closed contact at zero jump (Pa): in-situ less fluid
};

// The reaction on the + face (Pa, its normal component positive in compression). Laws are linear in pieces: on this one
// n = n_0 + dn_dn w_n and t = t_0 + dt_dn w_n + dt_dt w_t.
struct LawAnswer {
  enum class Piece : char { open, closed, stick, slip_plus, slip_minus, open_stick, open_slip_plus, open_slip_minus };
  Piece piece = Piece::open;
  double n = 0.0, t = 0.0;
  double n_0 = 0.0, t_0 = 0.0;
  double dn_dn = 0.0, dt_dt = 0.0, dt_dn = 0.0;  // Pa/m
  double energy = 0.0;  // stored on the way from no jump, that of friction's own dissipation aside (J/m^2)
};

/// Stiffness of closed contact (Pa/m), the same on all places of a surface: 1e4 of what a cell of the scene's stiffest
/// rock has, so that faces overlap by less than 1e-4 of what a cell deforms; above that of the springs of a soft
/// interface, 10 D. Rigid contact at two places a cell would ask for more than the one jump a cell that exists, and its
/// reactions would not be unique.
double contact_stiffness(const InterfaceLaw& law, const Rocks& rocks, const Grid& grid);

/// Reaction of a law with contact stiffness k (Pa/m) at a jump.
///   friction, failed weak: n = max(0, n_rest - k w_n), t = r_t_start - k (w_t - w_t_start), no more than mu n
///   (Coulomb); soft: t = -D_t w_t, n = max(-D_n w_n, n_rest - k w_n), or -D_n w_n both ways (the study's eq. 6).
/// Continuous and, but for the bound of friction, the gradient of a convex energy. Throws nothing.
LawAnswer law_at(const InterfaceLaw& law, double k, const LawInput& in);

// What a law is asked in an implicit step: the jump that its end would see without this place's own reaction.
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
  double n = 0.0, t = 0.0;  // Pa, n positive in compression
};

/// The reaction that satisfies law_at() at the end of the step: r = law(w_free + per r) in closed form (backward Euler,
/// so stable for any stiffness). What runs with inertia settle on is therefore the equilibrium of the law itself,
/// whatever the step. perfect: none. Throws nothing.
Reaction react(const InterfaceLaw& law, double k, const FreeJump& w);

/// The reaction nearest to r that a law allows whatever the jump: contact only pushes, friction is bounded.
Reaction admissible(const InterfaceLaw& law, const Reaction& r);

/// Coefficient of friction between split faces: that of sliding where a weak interface has failed; springs have none.
inline double sliding_coefficient(const InterfaceLaw& law) {
  if (law.kind == InterfaceLaw::Kind::weak) return law.residual_friction;
  return law.kind == InterfaceLaw::Kind::friction ? law.coefficient : 0.0;
}

/// The law of the fracture's own faces: contact without friction, or none at all (fracture.faces = "free"): a spring of
/// no stiffness both ways.
InterfaceLaw face_law(const Scene& scene);

/// The law of a tip's spring, which holds in both directions.
InterfaceLaw tie_law(const TipTie& tie);

/// Energy in the springs of a place under its law (J/m); 0 where it is not split or has none.
double spring_energy_at(const InterfaceLaw& law, const SurfacePoint& s);

/// Energy in the springs of soft interfaces, sum A (D_n w_n^2 + D_t w_t^2)/2, and of tips, sum k w^2/2 (J/m).
double spring_energy(const Scene& scene, const State& state);

}  // namespace strata
