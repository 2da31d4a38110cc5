#include "interfaces/surface_law.hpp"

#include <algorithm>
#include <cmath>

namespace strata {

double contact_stiffness(const InterfaceLaw& law, const std::vector<Elasticity>& rocks, const Grid& grid) {
  double E_prime = 0.0;
  for (const Elasticity& rock : rocks) E_prime = std::max(E_prime, rock.E_prime);
  const double k = 1e4 * E_prime / grid.h;
  return law.kind == InterfaceLaw::Kind::soft ? std::max(k, 10.0 * law.normal_stiffness_Pa_m) : k;
}

namespace {

using Piece = LawAnswer::Piece;

LawAnswer soft_law(const InterfaceLaw& law, double k, const LawInput& in) {
  LawAnswer r;
  const double D_n = law.normal_stiffness_Pa_m, D_t = law.shear_stiffness_Pa_m;
  const double pushed = in.n_rest - k * in.w_n, pulled = -D_n * in.w_n;
  const bool contact = law.compression == InterfaceLaw::Compression::contact;
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

LawAnswer law_at(const InterfaceLaw& law, double k, const LawInput& in) {
  if (law.kind == InterfaceLaw::Kind::soft) return soft_law(law, k, in);
  LawAnswer r;
  const double pushed = in.n_rest - k * in.w_n, at_rest = std::max(0.0, in.n_rest);
  r.energy = (std::max(0.0, pushed) * std::max(0.0, pushed) - at_rest * at_rest) / (2.0 * k);
  const bool closed = pushed > 0.0, given = in.bound >= 0.0;
  if (closed) r.piece = Piece::closed, r.n = pushed, r.n_0 = in.n_rest, r.dn_dn = -k;
  // A bound that is given does not ask for the normal reaction: else friction would jump where a face opens, and the
  // energy with it.
  if (!closed && !given) return r;
  const double mu = law.kind == InterfaceLaw::Kind::weak ? law.residual_friction : law.coefficient;
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

InterfaceLaw face_law(const Scene& scene) {
  InterfaceLaw law;
  if (scene.fracture && scene.fracture->faces == Fracture::Faces::free) {
    law.kind = InterfaceLaw::Kind::soft;
    law.normal_stiffness_Pa_m = law.shear_stiffness_Pa_m = 0.0;
    law.compression = InterfaceLaw::Compression::spring;
    return law;
  }
  law.kind = InterfaceLaw::Kind::friction;
  law.coefficient = 0.0;
  return law;
}

}  // namespace strata
