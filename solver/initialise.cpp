#include "initialise.hpp"

#include <algorithm>
#include <cmath>

#include "fracture/growth.hpp"
#include "mechanics/equilibrium.hpp"
#include "mechanics/explicit_step.hpp"
#include "mechanics/tip_ties.hpp"
#include "state/rebuild.hpp"

namespace strata {

namespace {

Grid make_grid(const Scene& scene) {
  const double h = scene.numerics.cell_m;
  return {static_cast<int>(std::lround(scene.domain.width_m / h)),
          static_cast<int>(std::lround(scene.domain.height_m / h)), h};
}

void append_particle(const Scene& scene, const std::vector<Elasticity>& rocks, const Vec2& x, double side_m,
                     Particles& p) {
  const std::size_t rock = rock_at(scene, x);
  for (auto* array : {&p.u_x, &p.u_y, &p.v_x, &p.v_y, &p.g_xx, &p.g_xy, &p.g_yx, &p.g_yy}) array->push_back(0.0);
  p.x.push_back(x.x()), p.y.push_back(x.y());
  p.V.push_back(side_m * side_m);
  p.m.push_back(rocks[rock].rho * side_m * side_m);
  p.half.push_back(0.5 * side_m);
  p.rock.push_back(static_cast<std::uint8_t>(rock));
  p.sides.push_back(0);
  p.in_situ.push_back({-scene.in_situ.horizontal_Pa, -scene.in_situ.vertical_Pa, 0.0});
  p.id.push_back(p.next_id++);
}

Particles make_particles(const Scene& scene, const std::vector<Elasticity>& rocks, const Grid& grid) {
  const int across = static_cast<int>(std::lround(std::sqrt(scene.numerics.particles_per_cell)));
  const double side_m = grid.h / across;
  Particles particles;
  for (int j = 0; j < grid.ny * across; ++j) {
    for (int i = 0; i < grid.nx * across; ++i)
      append_particle(scene, rocks, {(i + 0.5) * side_m, (j + 0.5) * side_m}, side_m, particles);
  }
  return particles;
}

void make_fracture(const Scene& scene, State& state) {
  if (!scene.fracture) return;
  std::vector<Vec2> path;
  for (const auto& x : scene.fracture->path_m) path.emplace_back(x[0], x[1]);
  state.has_fracture = true;
  state.surfaces.push_back(make_surface(Surface::Kind::fracture, 0, path, surface_spacing(state.grid)));
  const Surface& fracture = state.fracture();
  state.fluid.P.assign(fracture.vertices.size(), scene.fluid.start_Pa);
  state.fluid.inlet_Pa = scene.fluid.start_Pa;
  const bool from_symmetry = scene.domain.bottom == Edge::symmetry && path.front().y() == 0.0;
  // A fracture within the block is fed at its middle and has two tips.
  const auto middle = std::min_element(
      fracture.vertices.begin(), fracture.vertices.end(), [&](const SurfacePoint& a, const SurfacePoint& b) {
        return std::abs(a.arc - 0.5 * fracture.length()) < std::abs(b.arc - 0.5 * fracture.length());
      });
  state.fluid.inlet = from_symmetry ? 0 : static_cast<std::size_t>(middle - fracture.vertices.begin());
  if (!from_symmetry) state.tips.push_back(Tip{});
  for (Tip& tip : state.tips) tip.at_back = false;
  state.tips.push_back(Tip{});
}

void make_interfaces(const Scene& scene, State& state) {
  const bool along_x = scene.strata.along == Strata::Along::y;
  for (const InterfacePlace& place : scene.strata.interfaces) {
    if (scene.laws[place.law].kind == InterfaceLaw::Kind::perfect) continue;
    const Vec2 from = along_x ? Vec2{0.0, place.at_m} : Vec2{place.at_m, 0.0};
    const Vec2 to = along_x ? Vec2{scene.domain.width_m, place.at_m} : Vec2{place.at_m, scene.domain.height_m};
    Surface surface = make_surface(Surface::Kind::interface, static_cast<int>(state.surfaces.size()), {from, to},
                                   surface_spacing(state.grid));
    surface.law = place.law;
    for (SurfacePoint& s : surface.points) {
      s.column = state.grid.nearest(along_x ? s.x.x() : s.x.y());
      s.split = scene.laws[place.law].kind == InterfaceLaw::Kind::soft;
    }
    state.surfaces.push_back(surface);
  }
}

// A fracture's faces and soft interfaces start with what they carried in the in-situ state: fluid pressure or contact.
void set_start_reactions(State& state) {
  for (Surface& surface : state.surfaces) {
    for (SurfacePoint& s : surface.points) {
      const bool fracture = surface.kind == Surface::Kind::fracture;
      if (fracture) s.P = state.fluid.inlet_Pa;
      if (s.split) s.reaction = std::max(0.0, s.closing_stress() - s.P) * s.n;
    }
  }
}

}  // namespace

State initialise(const Scene& scene, const std::vector<Elasticity>& rocks) {
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
  if (state.has_fracture) refine_particles(state, 0, state.fracture().points.size());
  for (std::size_t q = 0; q < p.size(); ++q) p.sides[q] = sides_at(state, {p.x[q], p.y[q]}, -1);
  for (Surface& surface : state.surfaces) place_points(scene, state, surface);
  set_start_reactions(state);
  rebuild(scene, rocks, state);
  return state;
}

void restore(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  rebuild(scene, rocks, state);
}

}  // namespace strata
