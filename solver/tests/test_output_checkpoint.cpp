#include <catch2/catch.hpp>
#include <vector>

#include "output/checkpoint.hpp"
#include "output/run_folder.hpp"
#include "output_state.hpp"

using namespace strata;
using namespace strata::test;

namespace strata {
inline bool operator==(const Stress& a, const Stress& b) {
  return a.xx == b.xx && a.yy == b.yy && a.xy == b.xy;
}
}  // namespace strata

namespace {

void require_same(const SurfacePoint& a, const SurfacePoint& b) {
  CHECK(a.x == b.x);
  CHECK(a.n == b.n);
  CHECK(a.A == b.A);
  CHECK(a.arc == b.arc);
  CHECK(a.w == b.w);
  CHECK(a.u == b.u);
  CHECK(a.reaction == b.reaction);
  CHECK(a.in_situ == b.in_situ);
  CHECK(a.P == b.P);
  CHECK(a.memory.slip == b.memory.slip);
  CHECK(a.column == b.column);
  CHECK(a.sides == b.sides);
  CHECK(a.split == b.split);
  CHECK(a.failed_s == b.failed_s);
}

void require_same(const Surface& a, const Surface& b) {
  CHECK(a.kind == b.kind);
  CHECK(a.bit == b.bit);
  CHECK(a.law == b.law);
  REQUIRE(a.vertices.size() == b.vertices.size());
  REQUIRE(a.points.size() == b.points.size());
  for (std::size_t k = 0; k < a.vertices.size(); ++k) require_same(a.vertices[k], b.vertices[k]);
  for (std::size_t k = 0; k < a.points.size(); ++k) require_same(a.points[k], b.points[k]);
}

void require_same(const Tip& a, const Tip& b) {
  CHECK(a.at_back == b.at_back);
  CHECK(a.growing == b.growing);
  CHECK(a.stopped_by == b.stopped_by);
  CHECK(a.K_I == b.K_I);
  CHECK(a.K_II == b.K_II);
  CHECK(a.J == b.J);
  CHECK(a.J_spread == b.J_spread);
  CHECK(a.ring_m == b.ring_m);
  CHECK(a.kink == b.kink);
  CHECK(a.near == b.near);
  CHECK(a.crossed == b.crossed);
  CHECK(a.closed == b.closed);
  CHECK(a.last_growth_s == b.last_growth_s);
  CHECK(a.due_s == b.due_s);
  CHECK(a.runs_until_s == b.runs_until_s);
  CHECK(a.last_growth_Pa == b.last_growth_Pa);
  CHECK(a.has_grown == b.has_grown);
  CHECK(a.arrested == b.arrested);
  CHECK(a.reached == b.reached);
}

void require_same(const TipTie& a, const TipTie& b) {
  CHECK(a.node == b.node);
  CHECK(a.plus == b.plus);
  CHECK(a.minus == b.minus);
  CHECK(a.stiffness == b.stiffness);
  require_same(a.s, b.s);
}

void require_same(const Event& a, const Event& b) {
  CHECK(a.kind == b.kind);
  CHECK(a.time_s == b.time_s);
  CHECK(a.inlet_Pa == b.inlet_Pa);
  CHECK(a.tip_x_m == b.tip_x_m);
  CHECK(a.tip_y_m == b.tip_y_m);
  CHECK(a.at_interface == b.at_interface);
}

void require_same(const Ledger& a, const Ledger& b) {
  CHECK(a.kinetic == b.kinetic);
  CHECK(a.strain == b.strain);
  CHECK(a.interface_strain == b.interface_strain);
  CHECK(a.fluid_work == b.fluid_work);
  CHECK(a.in_situ_work == b.in_situ_work);
  CHECK(a.edge_work == b.edge_work);
  CHECK(a.body_work == b.body_work);
  CHECK(a.initial_kinetic == b.initial_kinetic);
  CHECK(a.damping == b.damping);
  CHECK(a.transfer == b.transfer);
  CHECK(a.integration == b.integration);
  CHECK(a.friction == b.friction);
  CHECK(a.fracture == b.fracture);
  CHECK(a.largest == b.largest);
}

void require_same(const Particles& a, const Particles& b) {
  CHECK(a.x == b.x);
  CHECK(a.y == b.y);
  CHECK(a.u_x == b.u_x);
  CHECK(a.u_y == b.u_y);
  CHECK(a.v_x == b.v_x);
  CHECK(a.v_y == b.v_y);
  CHECK(a.g_xx == b.g_xx);
  CHECK(a.g_xy == b.g_xy);
  CHECK(a.g_yx == b.g_yx);
  CHECK(a.g_yy == b.g_yy);
  CHECK(a.m == b.m);
  CHECK(a.V == b.V);
  CHECK(a.half_x == b.half_x);
  CHECK(a.half_y == b.half_y);
  CHECK(a.rock == b.rock);
  CHECK(a.sides == b.sides);
  CHECK(a.in_situ == b.in_situ);
  CHECK(a.id == b.id);
  CHECK(a.next_id == b.next_id);
}

void require_same(const State& a, const State& b) {
  CHECK(a.time == b.time);
  CHECK(a.step == b.step);
  CHECK(a.dt == b.dt);
  CHECK(a.grid.nx == b.grid.nx);
  CHECK(a.grid.ny == b.grid.ny);
  CHECK(a.grid.h == b.grid.h);
  require_same(a.particles, b.particles);
  CHECK(a.has_fracture == b.has_fracture);
  REQUIRE(a.surfaces.size() == b.surfaces.size());
  for (std::size_t k = 0; k < a.surfaces.size(); ++k) require_same(a.surfaces[k], b.surfaces[k]);
  CHECK(a.fluid.P == b.fluid.P);
  CHECK(a.fluid.inlet == b.fluid.inlet);
  CHECK(a.fluid.inlet_Pa == b.fluid.inlet_Pa);
  CHECK(a.fluid.w_rate == b.fluid.w_rate);
  REQUIRE(a.tips.size() == b.tips.size());
  for (std::size_t k = 0; k < a.tips.size(); ++k) require_same(a.tips[k], b.tips[k]);
  REQUIRE(a.ties.size() == b.ties.size());
  for (std::size_t k = 0; k < a.ties.size(); ++k) require_same(a.ties[k], b.ties[k]);
  REQUIRE(a.events.size() == b.events.size());
  for (std::size_t k = 0; k < a.events.size(); ++k) require_same(a.events[k], b.events[k]);
  require_same(a.ledger, b.ledger);
  CHECK(a.monitors.largest_courant == b.monitors.largest_courant);
  CHECK(a.monitors.largest_penetration == b.monitors.largest_penetration);
  CHECK(a.monitors.contact_sweeps == b.monitors.contact_sweeps);
  CHECK(a.monitors.contact_unconverged == b.monitors.contact_unconverged);
  const auto values = [](const Monitors& m) {
    return std::vector<double>{
        m.largest_particle_velocity, m.contact_residual,  m.volume_balance,     m.largest_open_J,    m.largest_made_J,
        m.largest_strain_J,          m.largest_kinetic_J, m.expected_x,         m.expected_y,        m.largest_drift,
        m.largest_momentum,          m.force_balance,     m.largest_imbalance,  m.delivered_m2,      m.J_spread_sum,
        m.largest_J_spread,          m.contact_left,      m.largest_contact_Pa, m.largest_tension_Pa};
  };
  CHECK(values(a.monitors) == values(b.monitors));
  CHECK(a.monitors.mirror == b.monitors.mirror);
  CHECK(a.monitors.growths == b.monitors.growths);
  CHECK(a.monitors.growths_apart == b.monitors.growths_apart);
}

const Written written{{{0.1 / 3, 2.0}, {0.2 / 3, 4.0}}, {0.1 / 7}};

}  // namespace

TEST_CASE("a checkpoint gives the state back to the same digits") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  State state = made_state();
  state.surfaces[0].vertices[1].u = {1e-3, -2e-3};
  Numbers number{900};
  state.tips.push_back(made_tip(false, number));
  save_checkpoint(file, made_scene(), {state, written});
  const Checkpoint checkpoint = load_checkpoint(file, made_scene());
  require_same(checkpoint.state, state);
  CHECK(checkpoint.written.rows == written.rows);
  CHECK(checkpoint.written.output_times == written.output_times);

  SECTION("and the same bytes if saved again") {
    const std::string before = content_of(file);
    save_checkpoint(file, made_scene(), checkpoint);
    CHECK(content_of(file) == before);
  }
}

TEST_CASE("an empty state and numbers that are not finite survive a checkpoint") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  State state;
  state.ledger.strain = std::numeric_limits<double>::infinity();
  state.ledger.kinetic = -0.0;
  save_checkpoint(file, made_scene(), {state, {}});
  const Checkpoint checkpoint = load_checkpoint(file, made_scene());
  require_same(checkpoint.state, state);
  CHECK(std::signbit(checkpoint.state.ledger.kinetic));
}

TEST_CASE("a checkpoint that was cut short or changed anywhere is refused") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  save_checkpoint(file, made_scene(), {made_state(), written});
  const std::string whole = content_of(file);
  for (std::size_t n = 0; n < whole.size(); n += n < 80 ? 1 : 97) {
    INFO("cut to " << n << " of " << whole.size() << " bytes");
    std::ofstream(file, std::ios::binary) << whole.substr(0, n);
    CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("checkpoint.bin: is "));
  }
  for (std::size_t n = 0; n < whole.size(); n += n < 80 ? 1 : 97) {
    INFO("byte " << n << " changed");
    std::string changed = whole;
    changed[n] = static_cast<char>(changed[n] ^ 4);
    std::ofstream(file, std::ios::binary) << changed;
    CHECK_THROWS_AS(load_checkpoint(file, made_scene()), std::runtime_error);
  }
  std::ofstream(file, std::ios::binary) << whole << "more";
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("is torn"));
}

TEST_CASE("a checkpoint of another scene, another format or none at all is refused by name") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("checkpoint.bin: cannot be opened"));
  std::ofstream(file) << "something else altogether, and long enough to be one, if only its beginning were right";
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("is no checkpoint of strata"));

  save_checkpoint(file, made_scene(), {made_state(), written});
  Scene other = made_scene();
  other.resolved_toml += "height_m = 7.0\n";
  CHECK_THROWS_WITH(load_checkpoint(file, other), Catch::Contains("belongs to another scene"));

  std::string bytes = content_of(file);
  bytes[std::string("strata-checkpoint ").size()] = '9';
  std::ofstream(file, std::ios::binary) << bytes;
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("has another version's format"));
}
