#include "interfaces/surface_tractions.hpp"

#include <catch2/catch.hpp>

#include "explicit/momentum.hpp"
#include "explicit/transfers.hpp"
#include "small_scenes.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// Fractures on a grid line, at mid-cell, inclined, kinked, and through a soft interface.
std::vector<Scene> cut_scenes() {
  std::vector<Scene> scenes;
  for (const auto& path : std::vector<std::vector<std::array<double, 2>>>{{{5.0, 2.0}, {5.0, 7.0}},
                                                                          {{4.5, 2.2}, {4.5, 7.4}},
                                                                          {{3.1, 2.3}, {6.7, 7.2}},
                                                                          {{3.0, 3.0}, {5.1, 5.0}, {7.0, 5.5}}}) {
    scenes.push_back(block(10, 10));
    add_fracture(scenes.back(), path);
  }
  for (const double at : {5.0, 4.5}) {
    scenes.push_back(block(10, 10));
    add_interface(scenes.back(), soft_law(1e9, 1e9), at);
    add_fracture(scenes.back(), {{5.0, 2.0}, {5.0, 7.0}});
  }
  return scenes;
}

void prepare(Run& run) {
  particles_to_grid(run.scene, run.rocks, run.state);
  update_stencil_weights(run.scene, run.state);
}

double power(const State& state, const NodalSums& forces) {
  double sum = 0.0;
  for (std::size_t r = 0; r < forces.size(); ++r)
    sum += forces[r].f_x * state.motion[r].v_x + forces[r].f_y * state.motion[r].v_y;
  return sum;
}

// Volume of the fracture, sum A w n (m^2).
double volume(const Surface& fracture) {
  double sum = 0.0;
  for (const SurfacePoint& s : fracture.points) sum += s.A * s.opening();
  return sum;
}

// A fracture through the middle of a 12 m block under in-situ stress, filled with pressure.
Scene pressed(double x, double pressure, double horizontal, Numerics::Shape shape = Numerics::Shape::bspline2) {
  Scene scene = block(12, 12);
  hold_edges(scene);
  scene.in_situ.horizontal_Pa = horizontal;
  scene.in_situ.vertical_Pa = 3e6;
  scene.numerics.shape = shape;
  add_fracture(scene, {{x, 0.0}, {x, 6.0}}, pressure);
  return scene;
}

}  // namespace

// Requires that D and D^T are the same operator: t A . D v = D^T t A . v for random node velocities and tractions, of
// every surface, to round-off (measured below 1e-15 of the sum of magnitudes). Mutations that fail: N left out of, or
// squared in, one of the two; the minus side with the plus sign.
TEST_CASE("the jump operator and the force of tractions are adjoint") {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  for (Scene& scene : cut_scenes()) {
    for (const auto shape : shapes) {
      scene.numerics.shape = shape;
      Run run(scene);
      prepare(run);
      State& state = run.state;
      for (std::size_t r = 0; r < state.motion.size(); ++r) {
        const double v_x = uniform(random), v_y = uniform(random);
        state.motion[r] = NodeMotion{v_x, v_y, 0.0, 0.0};
      }
      NodalSums forces(state.sums.size());
      double by_jump = 0.0, scale = 0.0;
      for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
        for (std::size_t q = 0; q < state.surfaces[k].points.size(); ++q) {
          const Vec2 t{1e6 * uniform(random), 1e6 * uniform(random)};
          const double A = state.surfaces[k].points[q].A;
          add_traction(state.point_stencils[k][q], t, A, forces);
          const double work = A * t.dot(jump(state.point_stencils[k][q], state.motion));
          by_jump += work, scale += std::abs(work);
        }
      }
      CHECK(scale > 1e4);
      CHECK(std::abs(by_jump) > 1e-3 * scale);
      CHECK(std::abs(power(state, forces) - by_jump) < 1e-13 * scale);
    }
  }
}

// Requires by hand: where the + copies move at a and the - copies at b, the jump well behind the tips is a - b, the
// mean velocity (a + b)/2, and a unit traction over a length A gives the + copies A t and the - copies -A t.
TEST_CASE("jump, mean velocity and traction of a parted block") {
  const Vec2 a{2.0, -3.0}, b{-1.0, 0.5};
  for (const auto shape : shapes) {
    for (const double x : {5.0, 4.5}) {
      Scene scene = block(10, 10);
      scene.numerics.shape = shape;
      add_fracture(scene, {{x, 1.0}, {x, 9.0}});
      Run run(scene);
      prepare(run);
      State& state = run.state;
      for (int r = 0; r < state.copies.records(); ++r) {
        const int node = state.copies.node_of_record[static_cast<std::size_t>(r)];
        const int c = state.copies.cut_of_node[static_cast<std::size_t>(node)];
        bool plus = state.grid.column(node) * 1.0 <= x;  // the normal of an upward path points to -x
        if (c >= 0) {
          const CutNode& cut = state.copies.cut[static_cast<std::size_t>(c)];
          const auto at = std::find(cut.records.begin(), cut.records.end(), r) - cut.records.begin();
          plus = cut.keys[static_cast<std::size_t>(at)] != 0;
        }
        const Vec2& v = plus ? a : b;
        state.motion[static_cast<std::size_t>(r)] = {v.x(), v.y(), 0.0, 0.0};
      }
      const std::size_t middle = state.fracture().points.size() / 2;
      const SurfaceStencil& stencil = state.point_stencils[0][middle];
      CHECK((jump(stencil, state.motion) - (a - b)).norm() < 1e-13);
      CHECK((mean_velocity(stencil, state.motion) - 0.5 * (a + b)).norm() < 1e-13);
      NodalSums forces(state.sums.size());
      add_traction(stencil, {3.0, 4.0}, 0.5, forces);
      Vec2 up = Vec2::Zero(), down = Vec2::Zero();
      for (std::size_t r = 0; r < forces.size(); ++r) {
        const Vec2 f{forces[r].f_x, forces[r].f_y};
        (f.x() > 0.0 ? up : down) += f;
        if (f.x() > 0.0) CHECK(state.motion[r].v_x == a.x());
      }
      CHECK((up - Vec2{1.5, 2.0}).norm() < 1e-13);
      CHECK((down + Vec2{1.5, 2.0}).norm() < 1e-13);
    }
  }
}

// Requires that the work that the fluid's forces do on the nodes in a step is P dV to 1e-10, over 100 steps of an
// opening fracture, and that the ledger says the same. (V changes by dw alone: lengths and normals change by 1e-4 of
// it.) Mutations that fail: pressure on one face, twice, or pulling; in the ledger, the other sign or P w for
// P dw.
TEST_CASE("the fluid's work is P dV") {
  for (const double x : {6.0, 6.5}) {
    Run run(pressed(x, 1e6, 0.0));
    State& state = run.state;
    double by_nodes = 0.0, by_volume = 0.0;
    for (int step = 0; step < 100; ++step) {
      State before = state;
      particles_to_grid(run.scene, run.rocks, before);
      update_stencil_weights(run.scene, before);
      NodalSums forces(before.sums.size());
      for (std::size_t q = 0; q < before.fracture().points.size(); ++q) {
        const SurfacePoint& s = before.fracture().points[q];
        add_traction(before.point_stencils[0][q], 1e6 * s.n, s.A, forces);
      }
      run.advance(1);
      if (forces.size() == state.motion.size()) by_nodes += state.dt * power(state, forces);
      for (std::size_t q = 0; q < before.fracture().points.size(); ++q) {
        const SurfacePoint &s = before.fracture().points[q], &now = state.fracture().points[q];
        by_volume += 1e6 * s.A * s.n.dot(now.w - s.w);
      }
    }
    CHECK(by_volume > 100.0);
    CHECK(by_volume == Approx(1e6 * volume(state.fracture())).epsilon(1e-3));
    CHECK(by_nodes == Approx(by_volume).epsilon(1e-10));
    CHECK(state.ledger.fluid_work == Approx(by_volume).epsilon(1e-10));
  }
}

// Requires that nothing moves where the pressure is the closing stress, on a grid line and at mid-cell, with every
// shape: no particle gets any velocity and J and K are zero, in 100 steps. 1 Pa more opens the fracture, so zero is no
// insensitivity. Mutations that fail: the in-situ traction left out, doubled, of the other sign.
TEST_CASE("pressure equal to the closing stress moves nothing") {
  for (const double x : {6.0, 6.5}) {
    for (const auto shape : shapes) {
      Run still(pressed(x, 2e6, 2e6, shape));
      still.advance(100);
      CHECK(top_speed(still.state.particles) == 0.0);
      CHECK(still.state.tips[0].J == 0.0);
      CHECK(still.state.tips[0].K_I == 0.0);
      CHECK(still.state.tips[0].K_II == 0.0);
      Run open(pressed(x, 2e6 + 1.0, 2e6, shape));
      open.advance(100);
      CHECK(volume(open.state.fracture()) > 1e-9);
      CHECK(open.state.tips[0].J > 0.0);
    }
  }
}

// Requires the same of an inclined fracture under equal stresses, to round-off of the stress: speeds below 1e-12 of
// those that the pressure alone would give.
TEST_CASE("pressure equal to the closing stress moves nothing, inclined") {
  Scene scene = block(12, 12);
  hold_edges(scene);
  scene.in_situ.horizontal_Pa = scene.in_situ.vertical_Pa = 2e6;
  add_fracture(scene, {{3.2, 3.1}, {8.3, 7.9}}, 2e6);
  Run still(scene);
  still.advance(50);
  scene.in_situ.horizontal_Pa = scene.in_situ.vertical_Pa = 0.0;
  Run open(scene);
  open.advance(50);
  CHECK(top_speed(open.state.particles) > 1e-3);
  CHECK(top_speed(still.state.particles) < 1e-12 * top_speed(open.state.particles));
}

// Requires that a soft interface bears the in-situ stress from the start, in contact or by springs, on a grid line and
// at mid-cell: nothing moves, to round-off of a step's speed under that stress (0.1 m/s).
TEST_CASE("a soft interface under in-situ stress moves nothing") {
  using Compression = InterfaceLaw::Compression;
  for (const auto compression : {Compression::contact, Compression::spring}) {
    for (const double at : {8.0, 8.5}) {
      Scene scene = pressed(6.0, 2e6, 2e6);
      scene.strata.layers = {{0, 0.0, 12.0}};
      add_interface(scene, soft_law(1e9, 1e9, compression), at);
      Run run(scene);
      run.advance(100);
      CAPTURE(at, compression == Compression::spring);
      CHECK(top_speed(run.state.particles) < 1e-9);
      CHECK(run.state.tips[0].J < 1e-12);
    }
  }
}

// Requires that a fracture whose pressure is below the closing stress stays shut: contact takes the difference, by hand
// 0.5 MPa on the whole, and the rock stays where it was.
TEST_CASE("a closed fracture rests on contact") {
  for (const double x : {6.0, 6.5}) {
    Run run(pressed(x, 1.5e6, 2e6));
    run.advance(100);
    double carried = 0.0, length = 0.0;
    for (const SurfacePoint& s : run.state.fracture().points) {
      carried += s.A * s.reaction.dot(s.n);
      length += s.A;
      CHECK(std::abs(s.opening()) < 1e-12);
    }
    CHECK(carried / length == Approx(0.5e6).epsilon(1e-9));
    CHECK(run.state.tips[0].K_I == 0.0);
    CHECK(top_speed(run.state.particles) < 1e-9);
  }
}
