// The laws of split places as lines over the jump: what the solvers with and without inertia share.
#pragma once

#include <array>
#include <limits>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// The reaction on the + face (Pa, its normal component positive in compression; the tangent is (n_y, -n_x)). Laws are
// linear in pieces: on this one n = n_0 + dn_dn w_n and t = t_0 + dt_dn w_n + dt_dt w_t.
struct LawAnswer {
  // The line of the normal reaction, and 4 times what friction makes of shear.
  enum class Piece : char { open, closed, stick = 5, slip_plus = 9, slip_minus = 13 };
  enum class Shear { free, sticks, slips_plus, slips_minus };
  Piece piece = Piece::open;
  double n = 0.0, t = 0.0;
  double n_0 = 0.0, t_0 = 0.0;
  double dn_dn = 0.0, dt_dt = 0.0, dt_dn = 0.0;  // Pa/m
  double energy = 0.0;  // stored on the way from no jump, that of friction's own dissipation aside (J/m^2)

  Shear shear() const { return Shear{static_cast<int>(piece) / 4}; }
  void set(Shear to) { piece = Piece{static_cast<char>(static_cast<int>(piece) % 4 + 4 * static_cast<int>(to))}; }
};

struct Reaction {
  double n = 0.0, t = 0.0;  // Pa, n positive in compression
};

// The jump that a step's end would see without this place's own reaction (m), and what a reaction adds to it (m/Pa).
struct FreeJump {
  double n = 0.0, t = 0.0, per_n = 0.0, per_t = 0.0;
};

// What a place held when the step began, or at the last equilibrium.
struct LawStart {
  double w_t = 0.0, r_t = 0.0;  // tangential jump (m) and reaction (Pa)
  InterfaceLaw::Memory memory;
  double r_n = 0.0;  // normal reaction (Pa)
};

// A line of a law, r = r_0 - D (w - w_0).
struct LawLine {
  LawAnswer::Piece piece = LawAnswer::Piece::open;
  double D = 0.0, r_0 = 0.0, w_0 = 0.0;  // Pa/m, Pa, m

  double at(double w) const { return r_0 - D * (w - w_0); }
  double at_end_of_step(double w_free, double per) const;  // r = at(w_free + per r)
};

// A law at a place: the normal reaction is the largest of some lines; friction bounds the tangential one.
struct LawLines {
  static constexpr LawLine none{LawAnswer::Piece::open, 0.0, -std::numeric_limits<double>::infinity()};
  LawLine contact = none;  // of faces that push each other
  LawLine own;             // what else the law exerts
  LawLine shear;
  double friction = 0.0;  // coefficient
  bool slides = true;     // whether friction bounds shear

  std::array<LawLine, 2> normal() const { return {own, contact}; }
  double bound(double n) const;  // of shear, at a normal reaction (Pa)

  /// The reaction at a jump (m): continuous and, but for the bound of friction, the gradient of a convex energy.
  /// given: the bound of friction where it is not to follow the normal reaction (Pa); it then acts on open faces, too.
  LawAnswer at(double w_n, double w_t, double given = -1.0) const;

  /// The reaction that satisfies at() at the end of a step, in closed form (backward Euler, so stable for any
  /// stiffness): what runs with inertia settle on is the equilibrium of the law itself, whatever the step.
  Reaction at_end_of_step(const FreeJump& w) const;

  /// The reaction nearest to r that the law allows whatever the jump: contact only pushes, friction is bounded.
  Reaction admissible(const Reaction& r) const;

  /// The stiffness that holds a place under a normal reaction (Pa).
  const LawLine& holding(double n) const { return n > 0.0 && contact.D > 0.0 ? contact : own; }

  /// What the normal reaction takes up on the way from no jump to w_n (J/m^2).
  double energy(double w_n) const;
};

/// The lines of a law with contact stiffness k (Pa/m), after a start; n_rest: normal reaction of closed contact at zero
/// jump (Pa), in-situ less fluid.
///   friction, failed weak: n = max(0, n_rest - k w_n), t = r_t - k (w_t' - w_t), no more than mu n (Coulomb);
///   soft: t = -D_t w_t, n = max(-D_n w_n, n_rest - k w_n), or -D_n w_n both ways (the study's eq. 6).
LawLines lines_of(const InterfaceLaw& law, double k, const LawStart& start, double n_rest);

/// What a place's law starts from, where the place is in equilibrium or at the end of a step.
LawStart start_of(const SurfacePoint& s);

/// Takes a movement into what a place remembers: to the opening w_n, by dw_t along the tangent (m).
void remember(const InterfaceLaw& law, double w_n, double dw_t, InterfaceLaw::Memory& memory);

/// Stiffness of closed contact (Pa/m), the same on all places of a surface: 1e4 of what a cell of the scene's stiffest
/// rock has, so that faces overlap by less than 1e-4 of what a cell deforms; above that of the springs of a soft
/// interface, 10 D. Rigid contact at two places a cell would ask for more than the one jump a cell that exists, and its
/// reactions would not be unique.
double contact_stiffness(const InterfaceLaw& law, const Rocks& rocks, const Grid& grid);

/// The law of a surface; that of the fracture's own faces: contact under fracture.friction, or none at all
/// (fracture.faces = "free"), a spring of no stiffness both ways.
InterfaceLaw law_of(const Scene& scene, const Surface& surface);
InterfaceLaw face_law(const Scene& scene);

/// The law of a tip's spring, which holds in both directions.
InterfaceLaw tie_law(const TipTie& tie);

/// Energy in the springs of a place under its law (J/m); 0 where it is not split or has none.
double spring_energy_at(const InterfaceLaw& law, const SurfacePoint& s);

/// Energy in the springs of soft interfaces, sum A (D_n w_n^2 + D_t w_t^2)/2, and of tips, sum k w^2/2 (J/m).
double spring_energy(const Scene& scene, const State& state);

}  // namespace strata
