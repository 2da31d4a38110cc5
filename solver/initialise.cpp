#include "initialise.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "explicit/momentum.hpp"
#include "fracture/growth.hpp"
#include "interfaces/failure.hpp"
#include "interfaces/tip_ties.hpp"
#include "quasistatic/intact_body.hpp"
#include "scene/derived.hpp"
#include "state/body_force.hpp"
#include "state/rebuild.hpp"

namespace strata {
namespace {

Particles make_particles(const Scene& scene, const Rocks& rocks, const Grid& grid) {
  const std::vector<GridPoint> columns = points_along(grid, Axis::x, points_across(scene));
  Particles p;
  std::vector<Vec2> places;
  for (const GridPoint& y : points_along(grid, Axis::y, points_across(scene))) {
    for (const GridPoint& x : columns) {
      const std::size_t rock = rock_at(scene, {x.at, y.at});
      for (auto* zero : {&p.u_x, &p.u_y, &p.v_x, &p.v_y, &p.g_xx, &p.g_xy, &p.g_yx, &p.g_yy}) zero->push_back(0.0);
      p.x.push_back(x.at), p.y.push_back(y.at);
      p.V.push_back(x.length * y.length);
      p.m.push_back(rocks[rock].rho * x.length * y.length);
      p.half_x.push_back(0.5 * x.length), p.half_y.push_back(0.5 * y.length);
      p.rock.push_back(static_cast<std::uint8_t>(rock));
      p.sides.push_back(0);
      p.id.push_back(p.next_id++);
      places.emplace_back(x.at, y.at);
    }
  }
  p.in_situ = prescribed_stress(scene, places);
  return p;
}

void make_fracture(const Scene& scene, State& state) {
  if (!scene.fracture) return;
  std::vector<Vec2> path;
  for (const auto& x : scene.fracture->path_m) {
    const Point from = path.empty() ? x : Point{path.back().x(), path.back().y()};
    for (const Point& end : legs_between_interfaces(scene, from, x)) path.emplace_back(end[0], end[1]);
  }
  state.has_fracture = true;
  state.surfaces.push_back(make_surface(Surface::Kind::fracture, 0, path, surface_spacing(state.grid)));
  const Surface& fracture = state.fracture();
  state.fluid.P.resize(fracture.vertices.size());
  state.fluid.inlet_Pa = scene.fluid.start_Pa;
  const bool from_symmetry = scene.domain.bottom == Edge::symmetry && path.front().y() == 0.0;
  // A fracture within the block is fed at its middle and has two tips.
  const auto middle = std::ranges::min_element(
      fracture.vertices, {}, [&](const SurfacePoint& s) { return std::abs(s.arc - 0.5 * fracture.length()); });
  state.fluid.inlet = from_symmetry ? 0 : static_cast<std::size_t>(middle - fracture.vertices.begin());
  rest_fluid(scene.fluid, state);
  if (!from_symmetry) state.tips.emplace_back().at_back = false;
  state.tips.emplace_back();
}

// The points of an interface at `at` (m). Along a graded grid its legs are halves of spans, each with a point in its
// middle where the particles stand too: what a law exerts then balances a uniform stress in the rock at every node.
Surface make_interface(const Scene& scene, const Grid& grid, const InterfacePlace& place, int bit) {
  const bool along_x = scene.strata.upwards();
  const std::vector<double>& knots = along_x ? grid.x_knots : grid.y_knots;
  const auto [from, to] = scene.held_by(place);
  std::vector<Vec2> path;
  const auto add = [&, from = from, to = to](double s) {
    s = std::clamp(s, from, to);
    const Vec2 x = along_x ? Vec2{s, place.at_m} : Vec2{place.at_m, s};
    if (path.empty() || (x - path.back()).norm() > 1e-6 * grid.h) path.push_back(x);
  };
  if (knots.empty()) {
    add(from), add(to);
    return make_surface(Surface::Kind::interface, bit, path, surface_spacing(grid));
  }
  for (int k = 0; k <= (along_x ? grid.nx : grid.ny); ++k) {
    if (k > 0) add(knots[static_cast<std::size_t>(k + 1)]);
    add(along_x ? grid.x(k) : grid.y(k));
  }
  return make_surface(Surface::Kind::interface, bit, path, std::numeric_limits<double>::infinity());
}

void make_interfaces(const Scene& scene, State& state) {
  for (const InterfacePlace& place : scene.strata.interfaces) {
    if (!scene.has_law(place)) continue;
    Surface surface = make_interface(scene, state.grid, place, static_cast<int>(state.surfaces.size()));
    surface.law = place.law;
    for (SurfacePoint& s : surface.points) {
      const bool along_x = scene.strata.upwards();
      const auto column_of = [&](double x) { return along_x ? state.grid.column_at(x) : state.grid.row_at(x); };
      // An end stands on a grid line, whose node stays whole as that of a fracture's tip does.
      const Stretch rock = scene.along_interfaces(), held = scene.held_by(place);
      const int low = held.from > rock.from ? column_of(held.from) + 1 : 0,
                high = held.to < rock.to ? column_of(held.to) - 1 : state.grid.nodes();
      s.column = std::clamp(column_of(scene.beside(s.x)), low, high);
      s.split = scene.laws[place.law].apart_at_start();
    }
    state.surfaces.push_back(surface);
  }
}

// A fracture's faces and interfaces that are apart start with what they carried in the in-situ state: fluid pressure or
// contact.
void set_start_reactions(State& state) {
  if (state.has_fracture) pass_to_points(state);
  for (Surface& surface : state.surfaces) {
    for (SurfacePoint& s : surface.points) {
      if (s.split) s.reaction = std::max(0.0, s.closing_stress() - s.P) * s.n;
    }
  }
}

}  // namespace

State initialise(const Scene& scene, const Rocks& rocks) {
  State state;
  state.grid = make_grid(scene);
  state.particles = make_particles(scene, rocks, state.grid);
  double fastest = 0.0;
  for (const Layer& layer : scene.strata.layers) fastest = std::max(fastest, rocks[layer.rock].c_P);
  state.dt = time_step(scene, fastest);
  state.monitors.largest_courant = fastest * state.dt / state.grid.h;
  if (scene.in_situ.initialise == InSitu::Initialise::loaded) load_in_situ(scene, rocks, state);
  make_fracture(scene, state);
  make_interfaces(scene, state);
  Particles& p = state.particles;
  if (state.has_fracture) refine_particles(scene, state, 0, state.fracture().points.size());
  for (std::size_t q = 0; q < p.size(); ++q) p.sides[q] = sides_at(state, {p.x[q], p.y[q]}, -1);
  for (Surface& surface : state.surfaces) place_points(scene, state, surface);
  if (scene.in_situ.initialise == InSitu::Initialise::loaded) hand_over_in_situ(scene, state);
  set_start_reactions(state);
  set_initial_velocity(scene, state);
  rebuild(scene, rocks, state);
  return state;
}

void restore(const Scene& scene, State& state) {
  rebuild_copies(scene, state);  // springs of tips were saved with what they carry
  if (scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics) state.bonds = find_bonds(scene, state);
}

}  // namespace strata
