#include "state/elasticity.hpp"

#include "scene/in_situ.hpp"

namespace strata {
namespace {

double rayleigh_speed(double c_P, double c_S) {
  const double ratio = (c_S / c_P) * (c_S / c_P);
  const auto f = [ratio](double q) {
    return (2.0 - q) * (2.0 - q) - 4.0 * std::sqrt(1.0 - q) * std::sqrt(1.0 - q * ratio);
  };
  double lo = 0.5, hi = 1.0;  // q lies between 0.76 (nu = 0) and 0.92 (nu = 0.5); f < 0 below the root
  for (int k = 0; k < 60; ++k) {
    const double mid = 0.5 * (lo + hi);
    (f(mid) < 0.0 ? lo : hi) = mid;
  }
  return c_S * std::sqrt(lo);
}

Elasticity make_elasticity(const Rock& rock) {
  const double E = rock.youngs_modulus_Pa, nu = rock.poisson_ratio;
  Elasticity e;
  e.nu = nu;
  e.rho = rock.density_kg_m3;
  e.lambda = E * nu / ((1.0 + nu) * (1.0 - 2.0 * nu));
  e.mu = E / (2.0 * (1.0 + nu));
  e.E_prime = E / (1.0 - nu * nu);
  e.c_P = std::sqrt((e.lambda + 2.0 * e.mu) / e.rho);
  e.c_S = std::sqrt(e.mu / e.rho);
  e.c_R = rayleigh_speed(e.c_P, e.c_S);
  e.J_c = rock.toughness_Pa_sqrt_m * rock.toughness_Pa_sqrt_m / e.E_prime;
  return e;
}

}  // namespace

Rocks make_elasticities(const Scene& scene) {
  Rocks all;
  for (const Rock& rock : scene.rocks) all.push_back(make_elasticity(rock));
  return all;
}

std::size_t rock_at(const Scene& scene, const Vec2& x) {
  return scene.strata.layers[layer_at(scene, {x.x(), x.y()})].rock;
}

std::vector<Stress> prescribed_stress(const Scene& scene, const std::vector<Vec2>& places) {
  std::vector<Point> points;
  for (const Vec2& x : places) points.push_back({x.x(), x.y()});
  std::vector<Stress> out;
  for (const InSituStress& s : in_situ_stress(scene, points)) out.push_back({-s.horizontal, -s.vertical, s.shear});
  return out;
}

Stress edges_stress(const Scene& scene) {
  return {-scene.in_situ.horizontal_Pa.number, -scene.in_situ.vertical_Pa.number, 0.0};
}

double strain_energy(const Rocks& rocks, const Particles& p) {
  double energy = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Stress s = stress_of(rocks[p.rock[q]], p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
    energy += 0.5 * p.V[q] * (s.xx * p.g_xx[q] + s.yy * p.g_yy[q] + s.xy * (p.g_xy[q] + p.g_yx[q]));
  }
  return energy;
}

}  // namespace strata
