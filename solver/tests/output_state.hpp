// A made-up scene and state for the tests of the output: every number is different and none is round.
#pragma once

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <string_view>

#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "scene/scene.hpp"
#include "state/state.hpp"
#include "temporary_folder.hpp"

namespace strata::test {

inline std::string content_of(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

// The value of a row under a column's name.
template <class Row>
auto& of(Row&& row, std::string_view name) {
  const auto columns = history_columns();
  const auto at = std::ranges::find(columns, name, &HistoryColumn::name);
  if (at == columns.end()) throw std::logic_error("no such column");
  return row.at(static_cast<std::size_t>(at - columns.begin()));
}

// Numbers that need all their digits, a different one each time.
struct Numbers {
  double next() { return std::sin(1.0 + 0.7 * ++count) / 3.0; }
  int count = 0;
};

inline Scene made_scene() {
  Scene scene;
  scene.title = "made up";
  scene.variant = "soft";
  scene.domain.width_m = 8.0;
  scene.domain.height_m = 8.0;
  scene.rocks.resize(2);
  scene.rocks[0] = {"stiff", 40e9, 0.25, 2600.0, 1.45e6};
  scene.rocks[1] = {"soft", 8e9, 0.1, 2300.0, 1e6};
  scene.laws.resize(2);
  scene.laws[1].name = "bedding";
  scene.laws[1].kind = InterfaceLaw::Kind::weak;
  scene.laws[1].failure_length_m = 4.0;
  scene.strata.layers = {{0, 0.0, 3.0}, {1, 3.0, 5.0}, {0, 5.0, 8.0}};
  scene.strata.interfaces = {{0, 3.0}, {1, 5.0}};
  scene.fracture = Fracture{};
  scene.fracture->path_m = {{4.0, 0.0}, {4.0, 2.0}};
  scene.fluid.start_Pa = 16e6;
  scene.fluid.rate_Pa_s = 0.4e6;
  scene.fluid.minimum_opening_m = 1e-4;
  scene.numerics.cell_m = 1.0;
  scene.stop.time_s = 10.0;
  scene.resolved_toml = "[domain]\nwidth_m = 8.0\n";
  return scene;
}

inline Particles made_particles(std::size_t n, Numbers& number) {
  Particles p;
  const auto fill = [&](SpreadArray& array) {
    for (std::size_t k = 0; k < n; ++k) array.push_back(number.next());
  };
  fill(p.x), fill(p.y), fill(p.u_x), fill(p.u_y), fill(p.v_x), fill(p.v_y);
  fill(p.g_xx), fill(p.g_xy), fill(p.g_yx), fill(p.g_yy), fill(p.m), fill(p.V), fill(p.half_x), fill(p.half_y);
  for (std::size_t k = 0; k < n; ++k) {
    p.rock.push_back(static_cast<std::uint8_t>(k % 2));
    p.sides.push_back(static_cast<SideWord>(k * 7 + 1));
    p.in_situ.push_back({1e6 * number.next(), 1e6 * number.next(), 1e6 * number.next()});
    p.id.push_back(static_cast<std::int32_t>((k * 3 + 1) % n));  // n is no multiple of 3: a permutation
  }
  p.next_id = static_cast<std::int32_t>(n) + 5;
  return p;
}

// Gives a point of a surface, whose geometry is set, all else that it carries.
inline void fill_point(SurfacePoint& s, Numbers& number) {
  s.w = 1e-3 * Vec2{number.next(), number.next()};
  s.reaction = 1e6 * Vec2{number.next(), number.next()};
  s.in_situ = 1e6 * Vec2{number.next(), number.next()};
  s.P = 1e6 * number.next();
  s.memory.slip = number.next();
  s.column = ++number.count;
  s.sides = static_cast<SideWord>(number.count);
  s.split = number.count % 2 == 0;
  s.failed_s = 1e-3 * number.count;
}

inline Tip made_tip(bool at_back, Numbers& number) {
  Tip tip;
  tip.at_back = at_back;
  tip.growing = !at_back;
  tip.stopped_by = at_back ? "an interface" : "";
  tip.K_I = 1e6 * number.next(), tip.K_II = 1e6 * number.next(), tip.J = number.next();
  tip.J_spread = number.next(), tip.ring_m = number.next(), tip.kink = number.next();
  tip.near = at_back ? Obstacle::rock_border : Obstacle::none;
  tip.last_growth_s = number.next(), tip.last_growth_Pa = number.next(), tip.due_s = number.next();
  tip.runs_until_s = number.next();
  tip.has_grown = !at_back, tip.closed = !at_back, tip.crossed = !at_back;
  tip.arrested = at_back;
  tip.reached = {2, 1};
  return tip;
}

inline void fill_monitors(Numbers& number, Monitors& m) {
  m = {number.next(), number.next(), 77, 3, number.next()};
  for (double* value :
       {&m.contact_residual,  &m.volume_balance,     &m.largest_open_J,     &m.largest_made_J,  &m.largest_strain_J,
        &m.largest_kinetic_J, &m.expected_x,         &m.expected_y,         &m.largest_drift,   &m.largest_momentum,
        &m.force_balance,     &m.largest_imbalance,  &m.delivered_m2,       &m.J_spread_sum,    &m.largest_J_spread,
        &m.contact_left,      &m.largest_contact_Pa, &m.largest_tension_Pa, &m.largest_strain,  &m.largest_rotation,
        &m.largest_jump,      &m.net_at_start_Pa,    &m.largest_net_Pa,     &m.flow_fall_Pa,    &m.flow_fall,
        &m.largest_flow_fall, &m.floor_share[0],     &m.floor_share[1],     &m.floor_share_sum, &m.viscous_tip[0],
        &m.viscous_tip[1],    &m.viscous_at_growth}) {
    *value = number.next();
  }
  m.mirror = 1;
  m.growths = 14, m.growths_apart = 5, m.flow_growths = 18;
}

// Fracture from (4, 0) to (4, 2) with normals towards -x, and the scene's upper interface, of 13 particles.
inline State made_state() {
  Numbers number;
  State state;
  state.time = number.next();
  state.step = 123456789012;
  state.dt = number.next();
  state.grid = {8, 9, 1.0};
  state.particles = made_particles(13, number);
  state.has_fracture = true;
  state.surfaces.resize(2);
  state.surfaces[0].kind = Surface::Kind::fracture;
  state.surfaces[0].vertices.resize(3), state.surfaces[0].points.resize(2);
  state.surfaces[1].kind = Surface::Kind::interface;
  state.surfaces[1].bit = 1;
  state.surfaces[1].law = 1;
  state.surfaces[1].vertices.resize(5), state.surfaces[1].points.resize(4);
  for (std::size_t k = 0; k < 3; ++k) state.surfaces[0].vertices[k].x = Vec2{4.0, static_cast<double>(k)};
  for (std::size_t k = 0; k < 5; ++k) state.surfaces[1].vertices[k].x = Vec2{2.0 * static_cast<double>(k), 5.0};
  for (Surface& surface : state.surfaces) {
    update_geometry(surface);
    for (SurfacePoint& s : surface.vertices) fill_point(s, number);
    for (SurfacePoint& s : surface.points) fill_point(s, number);
  }
  state.fluid = {{16.1e6, 15.3e6 / 0.9, 0.0}, 1, 16.7e6 / 0.9, {1e-3 / 3.0, -2e-4}};
  state.tips = {made_tip(true, number)};
  state.ties = {{44, 101, 102, number.next(), {}}};
  fill_point(state.ties[0].s, number);
  state.events = {{"start", 0.1 / 3, 1e6 / 3, 4.0, 2.1 / 3, false, "J"},
                  {"arrest", 0.2 / 3, 2e6 / 3, 3.9, 2.3 / 3, true, "energy", "lower"}};
  Ledger& l = state.ledger;
  for (double* value :
       {&l.kinetic, &l.strain, &l.interface_strain, &l.fluid_work, &l.in_situ_work, &l.edge_work, &l.body_work,
        &l.initial_kinetic, &l.damping, &l.transfer, &l.integration, &l.friction, &l.fracture, &l.largest}) {
    *value = number.next();
  }
  l.largest = 1.0 + l.largest * l.largest;
  fill_monitors(number, state.monitors);
  return state;
}

}  // namespace strata::test
