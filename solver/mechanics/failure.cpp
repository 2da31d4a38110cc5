#include "mechanics/failure.hpp"

#include <algorithm>
#include <cmath>

namespace strata {

namespace {

// Mean total stress over the samples.
Stress sampled_stress(const std::vector<Elasticity>& rocks, const Particles& p,
                      const std::vector<StressSample>& samples) {
  Stress mean;
  for (const StressSample& sample : samples) {
    const auto q = static_cast<std::size_t>(sample.particle);
    const Stress change = stress_of(rocks[p.rock[q]], p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
    mean = mean + sample.weight * (p.in_situ[q] + change);
  }
  return mean;
}

}  // namespace

double failure_index(const InterfaceLaw& law, double n, double t) {
  if (law.kind == InterfaceLaw::Kind::weak) {
    const double S = t / law.shear_strength_Pa, N = std::max(0.0, -n) / law.tensile_strength_Pa;
    return std::sqrt(S * S + N * N);
  }
  if (law.kind != InterfaceLaw::Kind::friction) return 0.0;
  if (n < 0.0) return HUGE_VAL;
  return t == 0.0 ? 0.0 : std::abs(t) / (law.coefficient * n);
}

std::vector<BondedPlace> bonded_places(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state) {
  std::vector<BondedPlace> places;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const Surface& surface = state.surfaces[k];
    if (state.stress_samples[k].empty()) continue;
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      const SurfacePoint& s = surface.points[q];
      if (s.split) continue;
      BondedPlace place{k, q, 0.0, -sampled_stress(rocks, state.particles, state.stress_samples[k][q]).on(s.n)};
      const Vec2 t{s.n.y(), -s.n.x()};
      place.index = failure_index(scene.laws[surface.law], place.carried.dot(s.n), place.carried.dot(t));
      places.push_back(place);
    }
  }
  return places;
}

}  // namespace strata
