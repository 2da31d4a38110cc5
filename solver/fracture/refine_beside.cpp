#include "fracture/refine_beside.hpp"

#include <algorithm>
#include <cmath>

#include "state/quarters.hpp"

namespace strata {

namespace {

// Where a particle's middle may be if it is to tell which nodes a surface cuts, or what their copies are made of.
constexpr double beside_surface_cells = 3.25;

struct Square {
  Vec2 at = Vec2::Zero();
  double half = 0.0;
  bool holds(const Vec2& x) const { return (x - at).lpNorm<Eigen::Infinity>() < half; }
};

// Around the fracture's points [first, last) and the tips.
std::vector<Square> squares_of(const Scene& scene, const State& state, std::size_t first, std::size_t last) {
  const double h = state.grid.h;
  std::vector<Square> squares;
  for (std::size_t k = first; k < last; ++k)
    squares.push_back({state.fracture().points[k].x, beside_surface_cells * h});
  const double around_tip_cells = scene.numerics.ring_cells + 2.0;  // as far as J's weight reaches beyond
  for (const Tip& tip : state.tips) squares.push_back({tip_position(state, tip), around_tip_cells * h});
  return squares;
}

bool beside_interface(const Scene& scene, double h, const Vec2& x) {
  const double at = scene.strata.along == Strata::Along::y ? x.y() : x.x();
  return std::ranges::any_of(scene.strata.interfaces, [&](const InterfacePlace& place) {
    const bool parts = scene.laws[place.law].kind != InterfaceLaw::Kind::perfect;
    return parts && std::abs(place.at_m - at) < beside_surface_cells * h;
  });
}

bool border_within(const Scene& scene, const Particles& p, std::size_t q) {
  const bool along_y = scene.strata.along == Strata::Along::y;
  const double at = along_y ? p.y[q] : p.x[q], half = along_y ? p.half_y[q] : p.half_x[q];
  return std::ranges::any_of(scene.strata.interfaces, [&](const InterfacePlace& place) {
    return std::abs(place.at_m - at) < (1.0 - 1e-9) * half;
  });
}

}  // namespace

void refine_beside(const Scene& scene, State& state, std::size_t first, std::size_t last) {
  const Quarters quarters(scene, state.grid);
  if (!quarters.in_use()) return;
  const std::vector<Square> squares = squares_of(scene, state, first, last);
  Particles& p = state.particles;
  const std::size_t before = p.size();
  for (std::size_t q = 0; q < before; ++q) {
    const Vec2 x{p.x[q], p.y[q]};
    const bool near = std::ranges::any_of(squares, [&](const Square& square) { return square.holds(x); });
    if (near && quarters.whole(p, q)) quarters.divide(p, q);
  }
}

void refine_beside_all(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  const Quarters quarters(scene, state.grid);
  if (!quarters.in_use()) return;
  Particles& p = state.particles;
  const std::size_t before = p.size();
  for (std::size_t q = 0; q < before; ++q) {
    const bool border = border_within(scene, p, q);
    if (!border && !beside_interface(scene, state.grid.h, {p.x[q], p.y[q]})) continue;
    quarters.divide(p, q);
    for (const std::size_t k : {q, p.size() - 3, p.size() - 2, p.size() - 1}) {
      const std::size_t rock = rock_at(scene, {p.x[k], p.y[k]});
      p.rock[k] = static_cast<std::uint8_t>(rock);
      p.m[k] = rocks[rock].rho * p.V[k];
    }
  }
  refine_beside(scene, state, 0, state.fracture().points.size());
}

}  // namespace strata
