#include "interfaces/parting.hpp"

#include <cmath>
#include <span>
#include <utility>

#include "scene/graded_cells.hpp"

namespace strata {
namespace {

// What parts from one end of a stretch of bonded places (back: from its last one); of no length where nothing ends
// there.
Parting parting_from(const Scene& scene, const Rocks& rocks, const State& state, std::span<const BondedPlace> stretch,
                     bool back) {
  const bool along_x = scene.strata.upwards();
  const auto column_at = [&](int c) { return along_x ? state.grid.x(c) : state.grid.y(c); };
  const BondedPlace &first = back ? stretch.back() : stretch.front(), &last = back ? stretch.front() : stretch.back();
  const Surface& surface = state.surfaces[first.surface];
  const SurfacePoint& s = surface.points[first.point];
  Parting parting;
  if (first.point == (back ? surface.points.size() - 1 : 0)) return parting;
  // What has parted ends at the first node that is whole, as a fracture does.
  Vec2 from = surface.vertices[first.point + (back ? 1 : 0)].x;
  if (surface.points[back ? first.point + 1 : first.point - 1].split) {
    from[along_x ? 0 : 1] = column_at(s.column);
  } else {
    parting.mask = state.fracture().mask(), parting.sides = s.sides & parting.mask;
  }
  const double at = from[along_x ? 0 : 1], wanted = (1.0 - 1e-6) * scene.fracture->crossing_increment();
  const int end = surface.points[last.point].column, way = back ? -1 : 1;
  for (int c = s.column; c != end + way && parting.length < wanted; c += way) {
    parting.columns.emplace(first.surface, c);
    parting.length = std::abs(column_at(c == end ? c : c + way) - at);
  }
  const Vec2 beside = ahead_cells * state.grid.h * s.n;
  const double K = scene.laws[surface.law].toughness_Pa_sqrt_m.value();
  for (const Vec2& x : {Vec2{s.x + beside}, Vec2{s.x - beside}})
    parting.J_c += 0.5 * K * K / rocks[rock_at(scene, x)].E_prime;
  parting.from.push_back(from);
  return parting;
}

// The places from `first` on that are bonded without a break.
std::span<const BondedPlace> stretch_from(const Bonds& bonds, std::size_t first) {
  std::size_t last = first + 1;
  while (last < bonds.places.size() && !bonds.places[last].begins) ++last;
  return {&bonds.places[first], last - first};
}

}  // namespace

std::vector<Parting> next_partings(const Scene& scene, const Rocks& rocks, const State& state, const Bonds& bonds) {
  std::vector<Parting> partings;
  const bool mirrored = mirror_symmetric(scene);
  const double middle = 0.5 * scene.domain.width_m;
  for (std::size_t k = 0; k < bonds.places.size() && scene.fracture;) {
    const std::span<const BondedPlace> stretch = stretch_from(bonds, k);
    k += stretch.size();
    const Surface& surface = state.surfaces[stretch.front().surface];
    if (!scene.laws[surface.law].has_toughness()) continue;
    for (const bool back : {false, true}) {
      const BondedPlace& first = back ? stretch.back() : stretch.front();
      if (mirrored && surface.points[first.point].x.x() > middle) continue;
      Parting parting = parting_from(scene, rocks, state, stretch, back);
      if (parting.length == 0.0) continue;
      if (mirrored) {
        for (const auto& [of, column] : Columns{parting.columns}) parting.columns.emplace(of, state.grid.nx - column);
        parting.from.push_back({2.0 * middle - parting.from[0].x(), parting.from[0].y()});
        parting.length *= 2.0;
        parting.mask = parting.sides = 0;
      }
      partings.push_back(std::move(parting));
    }
  }
  return partings;
}

}  // namespace strata
