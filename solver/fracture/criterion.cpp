#include "fracture/criterion.hpp"

#include <algorithm>
#include <cmath>

#include "fracture/tip_rings.hpp"
#include "state/rebuild.hpp"

namespace strata {
namespace {

constexpr double slope_cells = 3.0;        // from here on K is right to 0.3 %, at 2 cells to 3 % between unlike rocks
constexpr double looked_back_cells = 8.0;  // farther back an interface is of no concern
constexpr double round_off_cells = 0.01;   // distances of tips that stand so many cells off

// Whether the faces of an interface are apart within a cell of a place.
bool apart_at(const Surface& surface, const Vec2& x, double h) {
  return std::ranges::any_of(surface.points, [&](const SurfacePoint& s) { return s.split && (s.x - x).norm() < h; });
}

// Distance (m) from a tip to the nearest real interface ahead of it (sign 1) or behind (-1); one it stands on is both.
double to_interface(const Scene& scene, const State& state, const Tip& tip, double sign) {
  const Vec2 x = tip_position(state, tip);
  const double at = scene.stacking(x);
  const double way = scene.stacking(tip_direction(state.fracture(), tip.at_back));
  double nearest = HUGE_VAL;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    const double off = scene.strata.interfaces[k].at_m - at;
    const bool level = std::abs(way) < 1e-6, on = std::abs(off) < ahead_cells * state.grid.h;
    if (scene.changes_at(k, scene.beside(x)) && (level || on || sign * off * way > 0.0))
      nearest = std::min(nearest, std::abs(off));
  }
  return nearest;
}

// Whether the in-situ stress jumps within a tip's rings. J then has the jump times the opening there, which is some per
// cent off next to a tip: 5 to 11 % of J one or two cells past a border where K is 0.2 % off.
bool stress_jumps_near(const Scene& scene, const State& state, const Tip& tip) {
  const auto& layers = scene.strata.layers;
  const double at = scene.stacking(tip_position(state, tip)), reach = (scene.numerics.ring_cells + 2.0) * state.grid.h;
  for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
    if (!layers[k].has_stress_of(layers[k + 1]) && std::abs(layers[k].to_m - at) < reach) return true;
  }
  return false;
}

}  // namespace

bool apart_at(const Scene& scene, const State& state, std::size_t interface, const Vec2& x) {
  constexpr double told_apart_cells = 0.4;  // interfaces lie half a cell from each other or more
  const double at = scene.strata.interfaces[interface].at_m, h = state.grid.h;
  return std::ranges::any_of(state.surfaces, [&](const Surface& surface) {
    return surface.kind == Surface::Kind::interface &&
           std::abs(scene.stacking(surface.vertices.front().x) - at) < told_apart_cells * h && apart_at(surface, x, h);
  });
}

double past_open_interface(const Scene& scene, const State& state, const Tip& tip) {
  const Surface& fracture = state.fracture();
  const Vec2 at = tip_position(state, tip), way = tip_direction(fracture, tip.at_back);
  const SideWord ahead = sides_ahead(state, tip);
  const double h = state.grid.h;
  double nearest = HUGE_VAL;
  for (const Surface& surface : state.surfaces) {
    if (surface.kind != Surface::Kind::interface) continue;
    const bool behind = std::ranges::any_of(
        fracture.points, [&](const SurfacePoint& s) { return ((s.sides ^ ahead) & surface.mask()) != 0; });
    const double off = scene.stacking(at - surface.vertices.front().x), rate = scene.stacking(way);
    const double along = std::abs(off / rate);
    if (!behind || !(along < looked_back_cells * h) || !apart_at(surface, at - off / rate * way, h)) continue;
    nearest = std::min(nearest, std::abs(off) < ahead_cells * h ? 0.0 : along);
  }
  return nearest;
}

Criterion criterion_of(const Scene& scene, const State& state, const Tip& tip) {
  if (scene.fracture->growth == Fracture::Growth::energy) return Criterion::energy;
  const Criterion J_or_K = stress_jumps_near(scene, state, tip) ? Criterion::K : Criterion::J;
  if (scene.fracture->crossing != Fracture::Crossing::energy) return J_or_K;
  const double h = state.grid.h, da = scene.fracture->crossing_increment() + round_off_cells * h;
  const double past = past_open_interface(scene, state, tip);
  if (past == 0.0) return Criterion::energy;
  if (to_interface(scene, state, tip, 1.0) <= da) return Criterion::energy;
  if (past < (slope_cells - round_off_cells) * h) return Criterion::slope;
  if (past < trusted_cells_at_interface * h) return Criterion::K;
  const double behind = to_interface(scene, state, tip, -1.0);
  return behind <= da && behind < past - round_off_cells * h ? Criterion::energy : J_or_K;
}

const char* name_of(Criterion criterion) {
  if (criterion == Criterion::J) return "J";
  return criterion == Criterion::energy ? "energy" : "K";
}

double driving(const Elasticity& rock, const Tip& tip) {
  if (tip.criterion == Criterion::energy) return tip.G_trial;
  if (tip.criterion == Criterion::slope) return tip.closed ? 0.0 : tip.G_trial;
  const double G = (tip.K_I * tip.K_I + tip.K_II * tip.K_II) / rock.E_prime;
  if (tip.K_I <= 0.0) return 0.0;
  if (tip.criterion == Criterion::K) return G;
  if (tip.J <= 0.0) return 0.0;
  return tip.near != Obstacle::none ? tip.J : std::min(tip.J, 2.0 * G);
}

}  // namespace strata
