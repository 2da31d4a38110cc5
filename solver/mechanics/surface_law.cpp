#include "mechanics/surface_law.hpp"

#include <algorithm>
#include <cmath>

namespace strata {

double contact_stiffness(const InterfaceLaw& law, const std::vector<Elasticity>& rocks, const Grid& grid) {
  double E_prime = 0.0;
  for (const Elasticity& rock : rocks) E_prime = std::max(E_prime, rock.E_prime);
  const double k = 1e4 * E_prime / grid.h;
  return law.kind == InterfaceLaw::Kind::soft ? std::max(k, 10.0 * law.normal_stiffness_Pa_m) : k;
}

LawAnswer law_at(const InterfaceLaw& law, double k, const LawInput& in) {
  LawAnswer r;
  const double pushed = in.n_rest - k * in.w_n;
  if (law.kind == InterfaceLaw::Kind::soft) {
    const double pulled = -law.normal_stiffness_Pa_m * in.w_n;
    const bool closed = law.compression == InterfaceLaw::Compression::contact && pushed > pulled;
    r.n = closed ? pushed : pulled;
    r.dn_dn = closed ? -k : -law.normal_stiffness_Pa_m;
    r.t = -law.shear_stiffness_Pa_m * in.w_t;
    r.dt_dt = -law.shear_stiffness_Pa_m;
    return r;
  }
  if (pushed <= 0.0) return r;
  r.n = pushed;
  r.dn_dn = -k;
  const double mu = law.kind == InterfaceLaw::Kind::weak ? law.residual_friction : law.coefficient;
  if (mu == 0.0) return r;
  const double held = in.r_t_start - k * (in.w_t - in.w_t_start);
  r.t = std::clamp(held, -mu * r.n, mu * r.n);
  if (r.t == held) {
    r.dt_dt = -k;
  } else {
    r.dt_dn = std::copysign(mu, held) * r.dn_dn;
  }
  return r;
}

InterfaceLaw face_law() {
  InterfaceLaw law;
  law.kind = InterfaceLaw::Kind::friction;
  law.coefficient = 0.0;
  return law;
}

}  // namespace strata
