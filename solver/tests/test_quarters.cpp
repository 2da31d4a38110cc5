#include "state/quarters.hpp"

#include <catch2/catch.hpp>

#include "force_balance.hpp"
#include "fracture/growth.hpp"
#include "quasistatic/load_steps.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// A leaning crack in a 48 m block between layers side by side: both tips turn as they grow.
Scene turning(const InterfaceLaw& law = weak_law(0.4e6, 0.4e6), double border = 31.0) {
  Scene scene = without_lanes(block(48, 48));
  hold_edges(scene);
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  scene.strata.along = Strata::Along::x;
  scene.rocks.push_back({"soft", 5e9, 0.25, 2400.0, 1.25e6});
  add_interface(scene, law, border, 1);
  scene.in_situ = {3e6, 2e6};
  add_fracture(scene, {{18.2, 20.1}, {21.3, 24.9}}, 2.6e6);
  scene.fracture->growth = Fracture::Growth::J;
  scene.fracture->direction = Fracture::Direction::max_hoop;
  scene.fluid.rate_Pa_s = 1e6;
  return scene;
}

// The same with 4 x 4 points in all cells.
Scene all_fine(Scene scene) {
  scene.numerics.particles_per_cell = 16;
  return scene;
}

struct Steps {
  Run run;
  Quasistatic statics;
  explicit Steps(const Scene& scene) : run(scene) { start_quasistatic(run.scene, run.rocks, run.state, statics); }
  void advance(int steps) {
    for (int k = 0; k < steps; ++k) advance_quasistatic(run.scene, run.rocks, 10.0, run.state, statics);
  }
};

// Largest difference of the answers of two bodies to a load, by the largest answer.
double difference(const IntactBody& a, const IntactBody& b) {
  REQUIRE(a.unknowns() == b.unknowns());
  Eigen::VectorXd load = Eigen::VectorXd::Zero(a.unknowns());
  for (std::size_t k = 0; k < a.masters().size(); ++k) {
    for (int component = 0; component < 2; ++component) {
      const Unknown at = unknown_of(a.masters(), static_cast<int>(k), component);
      if (at.index >= 0) load[at.index] = std::sin(0.37 * at.index);
    }
  }
  const Eigen::VectorXd x = a.factor().solve(load);
  const Eigen::VectorXd y = b.factor().solve(load);
  return (x - y).cwiseAbs().maxCoeff() / y.cwiseAbs().maxCoeff();
}

double largest(const Eigen::MatrixXd& m) {
  return m.cwiseAbs().maxCoeff();
}

// Requires every particle in a bin at a cut node, and around the tips as far as J's weight reaches, to be fine.
void require_fine_where_it_counts(const Run& run) {
  const State& state = run.state;
  const Particles& p = state.particles;
  const Quarters quarters(run.scene, state.grid);
  int coarse = 0;
  for (const Bin& bin : state.bins) {
    bool counts = std::any_of(bin.record.begin(), bin.record.end(), [&](int r) { return is_cut(state.copies, r); });
    for (const Tip& tip : state.tips) {
      for (int n = 0; n < 9; ++n) {
        const Vec2 node{state.grid.x(bin.i + n % 3 - 1), state.grid.y(bin.j + n / 3 - 1)};
        counts = counts || (node - tip_position(state, tip)).norm() < run.scene.numerics.ring_cells * state.grid.h;
      }
    }
    for (int q = bin.first; q < bin.last; q += bin.stride) {
      const bool whole = quarters.whole(p, static_cast<std::size_t>(q));
      coarse += whole ? 1 : 0;
      if (counts && whole) FAIL("a particle at " << p.x[static_cast<std::size_t>(q)] << " stands for four");
    }
  }
  CHECK(coarse > 1000);
}

}  // namespace

// Requires the stiffness of the intact block, what is condensed, J and K, and the events, energies and paths of turning
// tips through a failing interface to have the digits of 4 x 4 points in all cells, with a third of the points; points
// fine wherever copies of nodes or rings are. Mutations that fail: quarters not in the stiffness, ids in another order,
// no refinement ahead of growth, beside interfaces or around tips, 2.25 cells beside surfaces.
TEST_CASE("points that are divided ahead of a turning path give the digits of 4 x 4 points everywhere") {
  for (const InterfaceLaw& law : {weak_law(0.4e6, 0.4e6), friction_law(0.3), soft_law(1e9, 1e9)}) {
    Steps few(turning(law)), all(all_fine(turning(law)));
    CHECK(few.run.state.particles.size() < 48 * 48 * 9);
    REQUIRE(all.run.state.particles.size() == 48 * 48 * 16);
    CHECK(difference(*few.statics.model.body, *all.statics.model.body) == 0.0);
    const std::size_t at_start = few.run.state.particles.size();
    for (int k = 0; k < 30; ++k) {
      few.advance(1), all.advance(1);
      require_fine_where_it_counts(few.run);
      const State &a = few.run.state, &b = all.run.state;
      REQUIRE(a.fracture().points.size() == b.fracture().points.size());
      CHECK(a.fracture().vertices.back().x == b.fracture().vertices.back().x);
      CHECK(a.time == b.time);
      for (std::size_t tip = 0; tip < 2; ++tip) {
        CHECK(a.tips[tip].J == b.tips[tip].J);
        CHECK(a.tips[tip].K_II == b.tips[tip].K_II);
      }
      CHECK(a.ledger.strain == b.ledger.strain);
      CHECK(a.ledger.friction == b.ledger.friction);
      const Eigen::MatrixXd &S = few.statics.model.condensed.S, &T = all.statics.model.condensed.S;
      REQUIRE(S.rows() == T.rows());
      CHECK((S.array() == T.array()).all());
    }
    const State& state = few.run.state;
    CHECK(state.fracture().length() > 12.0);
    CHECK(std::abs(state.tips[1].K_II) > 0.0);
    CHECK(state.particles.size() > at_start);
    CHECK(few.statics.model.body->points() == all.statics.model.body->points());
  }
}

// Requires a run that is taken up where the path has turned, its stiffness assembled from the points as they then are,
// to go on with the same digits. Mutations that fail: quarters with ids of their own, in the order in which they came.
TEST_CASE("a run that is taken up after points were divided has the same digits") {
  Steps on(turning());
  const std::size_t at_start = on.run.state.particles.size();
  on.advance(12);
  REQUIRE(on.run.state.particles.size() > at_start);
  Steps taken_up(turning());
  taken_up.run.state = on.run.state;
  taken_up.statics = {};
  start_quasistatic(taken_up.run.scene, taken_up.run.rocks, taken_up.run.state, taken_up.statics);
  CHECK(difference(*taken_up.statics.model.body, *on.statics.model.body) == 0.0);
  start_quasistatic(on.run.scene, on.run.rocks, on.run.state, on.statics);
  for (int k = 0; k < 12; ++k) {
    on.advance(1), taken_up.advance(1);
    CHECK(on.run.state.time == taken_up.run.state.time);
    CHECK(on.run.state.tips[1].J == taken_up.run.state.tips[1].J);
    CHECK(on.run.state.tips[0].K_II == taken_up.run.state.tips[0].K_II);
    CHECK(on.run.state.ledger.strain == taken_up.run.state.ledger.strain);
    CHECK(on.run.state.particles.id == taken_up.run.state.particles.id);
  }
}

// Requires the same to 1e-11 where the coordinates of quarters differ by round-off (graded cells, cells of 0.7 m),
// under hat functions, with a border of rocks through the points, and of all displacements where no edge holds the
// block. Mutations that fail: quarters' rocks those of their parents, rigid motion from particles that stand for four.
TEST_CASE("points that are divided ahead agree with 4 x 4 points everywhere on any grid") {
  Scene graded = turning();
  graded.numerics.far_cell_m = 4.0;
  graded.stop.tip_y_m = 30.0;
  Scene hats = turning();
  hats.numerics.shape = Numerics::Shape::linear;
  Scene between = turning(InterfaceLaw{}, 31.3);
  Scene free = turning();
  free.domain.sides = free.domain.top = free.domain.bottom = Edge::traction;
  Scene odd = without_lanes(block(60, 60, 0.7));
  hold_edges(odd);
  odd.numerics.mechanics = Numerics::Mechanics::quasistatic;
  odd.in_situ = {3e6, 2e6};
  odd.fracture = turning().fracture;
  odd.fluid = turning().fluid;
  for (const Scene& scene : {graded, hats, between, free, odd}) {
    const double round_off = scene.domain.holds_x() ? 0.0 : 1e-9;
    Steps few(scene), all(all_fine(scene));
    Particles &a = few.run.state.particles, &b = all.run.state.particles;
    REQUIRE(refines_ahead(scene));
    CHECK(5 * a.size() < 4 * b.size());
    CHECK(difference(*few.statics.model.body, *all.statics.model.body) == 0.0);
    double m_a = 0.0, m_b = 0.0;
    for (const double m : a.m) m_a += m;
    for (const double m : b.m) m_b += m;
    CHECK(m_a == Approx(m_b).epsilon(1e-12));
    few.advance(12), all.advance(12);
    const Eigen::MatrixXd &S = few.statics.model.condensed.S, &T = all.statics.model.condensed.S;
    REQUIRE(S.rows() == T.rows());
    CHECK(largest(S - T) == 0.0);
    CHECK(few.run.state.fracture().length() > 7.0);
    CHECK(std::abs(few.run.state.time - all.run.state.time) <= round_off * all.run.state.time);
    for (std::size_t tip = 0; tip < 2; ++tip) {
      const Tip &a_tip = few.run.state.tips[tip], &b_tip = all.run.state.tips[tip];
      CHECK(std::abs(a_tip.J - b_tip.J) <= round_off * b_tip.J);
      CHECK(std::abs(a_tip.K_II - b_tip.K_II) <= round_off * b_tip.K_I);
    }
    set_all_particles(few.run.scene, few.run.state, few.statics.model);
    set_all_particles(all.run.scene, all.run.state, all.statics.model);
    const double scale = largest_displacement(b);
    std::vector<std::size_t> at(static_cast<std::size_t>(b.next_id), b.size());
    for (std::size_t q = 0; q < b.size(); ++q) at[static_cast<std::size_t>(b.id[q])] = q;
    const Quarters quarters(few.run.scene, few.run.state.grid);
    double off = 0.0;
    for (std::size_t q = 0; q < a.size(); ++q) {
      if (quarters.whole(a, q)) continue;
      const std::size_t o = at[static_cast<std::size_t>(a.id[q])];
      REQUIRE(o < b.size());
      CHECK(a.x[q] == b.x[o]);
      CHECK(a.rock[q] == b.rock[o]);
      off = std::max(off, std::hypot(a.u_x[q] - b.u_x[o], a.u_y[q] - b.u_y[o]));
    }
    CHECK(off <= round_off * scale);
  }
}

// Requires forces at all nodes in balance, those of quarters by the stress that nodes' motion gives there, on a uniform
// grid and a graded one; and one coarse particle's strain to break it. Mutations that fail: particles that stand for
// four taken for themselves, quarters' forces once more on top, or with the other sign.
TEST_CASE("forces of quarters are in the balance of nodes") {
  for (const double far : {0.0, 4.0}) {
    Scene scene = turning();
    scene.stop.tip_y_m = 30.0;
    if (far > 0.0) scene.numerics.far_cell_m = far;
    Steps s(scene);
    State& state = s.run.state;
    const std::vector<Vec2> u = set_all_particles(s.run.scene, state, s.statics.model);
    watch_forces(s.run.scene, s.run.rocks, u, state);
    CHECK(state.monitors.force_balance > 0.0);
    CHECK(state.monitors.force_balance < 1e-9);
    const Quarters quarters(s.run.scene, state.grid);
    std::size_t coarse = 0;
    while (!quarters.whole(state.particles, coarse)) ++coarse;
    state.particles.g_yy[coarse] += 1e-4;
    watch_forces(s.run.scene, s.run.rocks, u, state);
    CHECK(state.monitors.force_balance > 1e-4);
  }
}

// Requires points to be divided ahead without inertia along paths that may turn alone, and not where each point has a
// value of its own (a loaded in-situ state, a body force), where a layer is thin or 9 or 16 points are asked for.
TEST_CASE("where points are divided ahead") {
  const auto tells = [](auto change, int across, bool ahead) {
    Scene scene = turning();
    change(scene);
    CHECK(points_across(scene) == across);
    CHECK(refines_ahead(scene) == ahead);
  };
  tells([](Scene&) {}, 2, true);
  tells([](Scene& s) { s.numerics.mechanics = Numerics::Mechanics::explicit_dynamics; }, 2, false);
  tells([](Scene& s) { s.fracture->direction = Fracture::Direction::straight; }, 2, false);
  tells([](Scene& s) { s.fracture->growth = Fracture::Growth::none; }, 2, false);
  tells([](Scene& s) { s.in_situ.initialise = InSitu::Initialise::loaded; }, 4, false);
  tells([](Scene& s) { s.body.acceleration_m_s2 = Formulas{"0", "-9.81"}; }, 4, false);
  tells([](Scene& s) { add_interface(s, soft_law(1e9, 1e9), 32.0); }, 4, false);
  tells([](Scene& s) { s.numerics.particles_per_cell = 9; }, 3, false);
  tells([](Scene& s) { s.numerics.particles_per_cell = 16; }, 4, false);
}
