#include "interfaces/surface_law.hpp"

#include <algorithm>
#include <cmath>

namespace strata {

namespace {

using Piece = LawAnswer::Piece;
using Kind = InterfaceLaw::Kind;
using Compression = InterfaceLaw::Compression;

// A spring both ways, D (Pa/m) along the normal and the tangent.
InterfaceLaw spring_law(double D) {
  InterfaceLaw law;
  law.kind = Kind::soft;
  law.normal_stiffness_Pa_m = law.shear_stiffness_Pa_m = D;
  law.compression = Compression::spring;
  return law;
}

// r = r_rest - D w with w = w_free + per r, in the form that keeps its digits for any D > 0.
double spring(double D, double r_rest, double w_free, double per) {
  return D > 0.0 ? (r_rest / D - w_free) / (1.0 / D + per) : 0.0;
}

LawAnswer soft_law(const InterfaceLaw& law, double k, const LawInput& in) {
  LawAnswer r;
  const double D_n = law.normal_stiffness_Pa_m, D_t = law.shear_stiffness_Pa_m;
  const double pushed = in.n_rest - k * in.w_n, pulled = -D_n * in.w_n;
  const bool contact = law.compression == Compression::contact;
  const auto energy = [&](double w_n) {
    if (!contact || in.n_rest - k * w_n <= -D_n * w_n) return 0.5 * D_n * w_n * w_n;
    const double w = in.n_rest / (k - D_n);  // where contact hands over to the spring
    return 0.5 * D_n * w * w + (in.n_rest * (w_n - w) - 0.5 * k * (w_n * w_n - w * w)) * -1.0;
  };
  const bool closed = contact && pushed > pulled;
  r.piece = closed ? Piece::closed : Piece::open;
  r.n = closed ? pushed : pulled;
  r.n_0 = closed ? in.n_rest : 0.0;
  r.dn_dn = closed ? -k : -D_n;
  r.t = -D_t * in.w_t;
  r.dt_dt = -D_t;
  r.energy = energy(in.w_n) - energy(0.0) + 0.5 * D_t * in.w_t * in.w_t;
  return r;
}

}  // namespace

double contact_stiffness(const InterfaceLaw& law, const Rocks& rocks, const Grid& grid) {
  double E_prime = 0.0;
  for (const Elasticity& rock : rocks) E_prime = std::max(E_prime, rock.E_prime);
  const double k = 1e4 * E_prime / grid.h;
  return law.kind == Kind::soft ? std::max(k, 10.0 * law.normal_stiffness_Pa_m) : k;
}

LawAnswer law_at(const InterfaceLaw& law, double k, const LawInput& in) {
  if (law.kind == Kind::soft) return soft_law(law, k, in);
  LawAnswer r;
  const double pushed = in.n_rest - k * in.w_n, at_rest = std::max(0.0, in.n_rest);
  r.energy = (std::max(0.0, pushed) * std::max(0.0, pushed) - at_rest * at_rest) / (2.0 * k);
  const bool closed = pushed > 0.0, given = in.bound >= 0.0;
  if (closed) r.piece = Piece::closed, r.n = pushed, r.n_0 = in.n_rest, r.dn_dn = -k;
  // A bound that is given does not ask for the normal reaction: else friction would jump where a face opens, and the
  // energy with it.
  if (!closed && !given) return r;
  const double mu = sliding_coefficient(law);
  if (mu == 0.0) return r;
  const double held = in.r_t_start - k * (in.w_t - in.w_t_start);
  const double bound = given ? in.bound : mu * r.n;
  const double at_start = in.r_t_start * in.r_t_start / (2.0 * k);
  if (std::abs(held) <= bound) {
    r.piece = closed ? Piece::stick : Piece::open_stick;
    r.t = held, r.t_0 = in.r_t_start + k * in.w_t_start, r.dt_dt = -k;
    r.energy += held * held / (2.0 * k) - at_start;
    return r;
  }
  const double sign = std::copysign(1.0, held);
  if (closed)
    r.piece = sign > 0.0 ? Piece::slip_plus : Piece::slip_minus;
  else
    r.piece = sign > 0.0 ? Piece::open_slip_plus : Piece::open_slip_minus;
  r.t = sign * bound;
  r.t_0 = given ? r.t : sign * mu * in.n_rest;
  r.dt_dn = given ? 0.0 : sign * mu * r.dn_dn;
  // A given bound makes sliding the gradient of an energy, too.
  r.energy += (given ? 2.0 * bound * std::abs(held) - bound * bound : bound * bound) / (2.0 * k) - at_start;
  return r;
}

// Of soft: both branches fall as the jump grows, so that the larger answer is that of the larger branch.
Reaction react(const InterfaceLaw& law, double k, const FreeJump& w) {
  if (law.kind == Kind::perfect) return {};
  const double pushed = spring(k, w.n_rest, w.n, w.per_n);
  if (law.kind == Kind::soft) {
    const double pulled = spring(law.normal_stiffness_Pa_m, 0.0, w.n, w.per_n);
    return {law.compression == Compression::contact ? std::max(pulled, pushed) : pulled,
            spring(law.shear_stiffness_Pa_m, 0.0, w.t, w.per_t)};
  }
  return admissible(law, {pushed, spring(k, w.r_t_start, w.t - w.t_start, w.per_t)});
}

Reaction admissible(const InterfaceLaw& law, const Reaction& r) {
  if (law.kind == Kind::soft) return r;
  const double n = std::max(0.0, r.n), bound = sliding_coefficient(law) * n;
  return {n, std::clamp(r.t, -bound, bound)};
}

InterfaceLaw face_law(const Scene& scene) {
  if (scene.fracture && scene.fracture->faces == Fracture::Faces::free) return spring_law(0.0);
  InterfaceLaw law;
  law.kind = Kind::friction;
  law.coefficient = 0.0;
  return law;
}

InterfaceLaw tie_law(const TipTie& tie) {
  return spring_law(tie.stiffness);
}

// Closed contact and stick hold r^2/(2k), some 1e-4 of what the rock beside them does: that is left in the ledger's
// friction, which is then negative by as much while load comes on. All of it is counted, so the ledger closes.
double spring_energy_at(const InterfaceLaw& law, const SurfacePoint& s) {
  if (law.kind != Kind::soft || !s.split) return 0.0;
  const double w_n = s.opening(), w_t = s.w.dot(tangent_of(s.n));
  const bool closed = law.compression == Compression::contact && w_n < 0.0;
  return 0.5 * s.A * ((closed ? 0.0 : law.normal_stiffness_Pa_m * w_n * w_n) + law.shear_stiffness_Pa_m * w_t * w_t);
}

double spring_energy(const Scene& scene, const State& state) {
  double energy = 0.0;
  for (const TipTie& tie : state.ties) energy += spring_energy_at(tie_law(tie), tie.s);
  for (const Surface& surface : state.surfaces) {
    if (surface.kind != Surface::Kind::interface) continue;
    for (const SurfacePoint& s : surface.points) energy += spring_energy_at(scene.laws[surface.law], s);
  }
  return energy;
}

}  // namespace strata
