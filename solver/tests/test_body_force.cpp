// Body forces and initial velocities, with inertia and without.
#include "state/body_force.hpp"

#include <catch2/catch.hpp>

#include "explicit/transfers.hpp"
#include "interfaces/failure.hpp"
#include "interfaces/surface_tractions.hpp"
#include "output/checkpoint.hpp"
#include "output_state.hpp"
#include "quasistatic/load_steps.hpp"
#include "state/rebuild.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

using Kinematics = Numerics::Kinematics;

// Largest stress of a particle (Pa).
double top_stress(const Run& run) {
  const Particles& p = run.state.particles;
  double most = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Stress s = stress_of(run.rocks[p.rock[q]], p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
    most = std::max({most, std::abs(s.xx), std::abs(s.yy), std::abs(s.xy)});
  }
  return most;
}

double unexplained(const Run& run) {
  Ledger ledger = run.state.ledger;
  ledger.strain = strain_energy(run.rocks, run.state.particles);
  return ledger.closure();
}

// Uniform motion under b = 1000 cos(omega t): error of the displacement, (1 - cos(omega t)) 1000/omega^2, after some
// steps.
double error_of_driven_motion(double courant, int steps) {
  Scene scene = block(4, 4);
  scene.numerics.courant = courant;
  scene.body.acceleration_m_s2 = Formulas{"1000*cos(300*t)", "0"};
  Run run(scene);
  run.advance(steps);
  return run.state.particles.u_x[0] - 1000.0 * (1.0 - std::cos(300.0 * run.state.time)) / (300.0 * 300.0);
}

// A crack in a block on rollers, pulled open by a body force that grows with time.
Scene pulled() {
  Scene scene = block(20, 20);
  hold_edges(scene);
  scene.domain.top = Edge::traction;
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  add_fracture(scene, {{10.0, 0.0}, {10.0, 6.0}}, 0.1e6);
  scene.body.acceleration_m_s2 = Formulas{"40*(1 + t)*(X - 10)", "-10 - Y"};
  return scene;
}

}  // namespace

// Requires u = v_0 t + b t^2/2 to round-off under every transfer and shape, moving points or not, without stress, and
// a ledger that closes with the work m b . u of the body force. Mutations that fail: no half step at the start, b
// doubled, work left out of the ledger or by V for m.
TEST_CASE("free fall is exact") {
  for (const auto shape : shapes) {
    for (const auto transfer : transfers) {
      for (const auto kinematics : {Kinematics::updated, Kinematics::total}) {
        if (shape == Numerics::Shape::gimp && kinematics == Kinematics::total) continue;
        Scene scene = block(4, 6);
        scene.numerics.shape = shape;
        scene.numerics.transfer = transfer;
        scene.numerics.kinematics = kinematics;
        scene.body.acceleration_m_s2 = Formulas{"1.5", "-9.81"};
        scene.initial.velocity_m_s = Formulas{"0.2", "0.3"};
        Run run(scene);
        run.advance(150);
        const Particles& p = run.state.particles;
        const double t = run.state.time, u_x = 0.2 * t + 0.75 * t * t, u_y = 0.3 * t - 4.905 * t * t;
        double mass = 0.0;
        for (std::size_t q = 0; q < p.size(); ++q) {
          mass += p.m[q];
          CHECK(p.u_x[q] == Approx(u_x).epsilon(1e-11));
          CHECK(p.u_y[q] == Approx(u_y).epsilon(1e-11));
        }
        CHECK(top_stress(run) < 1e-5);  // Pa; strains of round-off
        CHECK(run.state.ledger.body_work == Approx(mass * (1.5 * u_x - 9.81 * u_y)).epsilon(1e-11));
        CHECK(std::abs(unexplained(run)) < 1e-11);
      }
    }
  }
}

// Requires the second order in time. Mutations that fail: b taken at the step's middle or end, no half step at the
// start (order 1).
TEST_CASE("a load that changes with time is followed to second order") {
  const double coarse = error_of_driven_motion(0.8, 50), fine = error_of_driven_motion(0.4, 100);
  CAPTURE(coarse, fine);
  CHECK(std::abs(coarse) > 1e-8);
  CHECK(std::abs(fine) < std::abs(coarse) / 3.8);
}

// Requires sum f_i = sum m b and sum x_i f_i = sum x_p m b for b linear in X and Y, by the shape functions of the sums
// of mass, which is the P2G of any field. Mutations that fail: V for m, X and Y exchanged.
TEST_CASE("forces on nodes have the resultant and the moments of the body force") {
  for (const auto shape : shapes) {
    Scene scene = block(5, 4);
    scene.numerics.shape = shape;
    scene.body.acceleration_m_s2 = Formulas{"3 + 2*X - Y + 4*t", "X*Y"};
    Run run(scene);
    State& state = run.state;
    set_body_acceleration(run.scene, 0.5, state);
    particles_to_grid(run.scene, run.rocks, state);
    add_body_force(run.scene, state);
    Vec2 f = Vec2::Zero(), expected = f, along_x = f, along_y = f, expected_x = f, expected_y = f;
    for (std::size_t r = 0; r < state.sums.size(); ++r) {
      const int node = state.copies.node_of_record[r];
      const Vec2 f_i{state.sums[r].f_x, state.sums[r].f_y};
      f += f_i, along_x += state.grid.x(state.grid.column(node)) * f_i;
      along_y += state.grid.y(state.grid.row(node)) * f_i;
    }
    const Particles& p = state.particles;
    for (std::size_t q = 0; q < p.size(); ++q) {
      const Vec2 b = p.m[q] * Vec2{5.0 + 2.0 * p.x[q] - p.y[q], p.x[q] * p.y[q]};
      expected += b, expected_x += p.x[q] * b, expected_y += p.y[q] * b;
    }
    CHECK((f - expected).norm() < 1e-12 * expected.norm());
    CHECK((along_x - expected_x).norm() < 1e-12 * expected_x.norm());
    CHECK((along_y - expected_y).norm() < 1e-12 * expected_y.norm());
  }
}

// Requires that X and Y stay those of the start while points move: a force that is a step at X = 2 keeps its particles.
// Mutations that fail: b taken of x instead of X, X and Y exchanged.
TEST_CASE("formulas are of the places where particles start") {
  Scene scene = block(4, 4);
  scene.body.acceleration_m_s2 = Formulas{"0", "X < 2 ? 1 : 2"};
  scene.initial.velocity_m_s = Formulas{"20 + 0*X", "0"};
  Run run(scene);
  run.advance(60);
  set_body_acceleration(run.scene, run.state.time, run.state);
  const Particles& p = run.state.particles;
  double moved = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    moved = std::max(moved, p.u_x[q]);
    CHECK(run.state.body[q].y() == ((p.id[q] % 8) < 4 ? 1.0 : 2.0));  // ids run along x, 8 a row
  }
  CHECK(moved > 0.25);
}

// Requires that the ledger explains all the work where waves, damping and rollers take it up.
TEST_CASE("the ledger closes under a body force and an initial velocity") {
  for (const double damping : {0.0, 30.0}) {
    Scene scene = block(8, 8);
    hold_edges(scene);
    scene.numerics.damping_1_s = damping;
    scene.body.acceleration_m_s2 = Formulas{"100*sin(pi*X/8)*cos(500*t)", "-30*Y"};
    scene.initial.velocity_m_s = Formulas{"0.1*sin(pi*X/8)", "0"};
    Run run(scene);
    run.advance(200);
    CHECK(run.state.ledger.initial_kinetic > 100.0);
    CHECK(std::abs(run.state.ledger.body_work) > 100.0);
    CHECK(std::abs(unexplained(run)) < 1e-10);
  }
}

TEST_CASE("a run under a body force resumes to the same digits, on any number of threads") {
  const TemporaryFolder folder;
  Scene scene = block(8, 24);
  hold_edges(scene);
  scene.domain.top = Edge::traction;
  scene.body.acceleration_m_s2 = Formulas{"100*sin(X)*cos(500*t)", "-30*Y"};
  scene.initial.velocity_m_s = Formulas{"0.1*sin(pi*X/8)", "0"};
  scene.resolved_toml = "body";
  Run run(scene);
  run.advance(32);
  save_checkpoint(folder.path / "checkpoint.bin", run.scene, {run.state, {}});
  Run again(scene);
  again.state = load_checkpoint(folder.path / "checkpoint.bin", run.scene).state;
  again.rebuild();
  run.advance(70);
  omp_set_num_threads(2);
  again.advance(70);
  omp_set_num_threads(1);
  CHECK(run.state.particles.u_x == again.state.particles.u_x);
  CHECK(run.state.particles.v_y == again.state.particles.v_y);
  CHECK(run.state.ledger.body_work == again.state.ledger.body_work);
}

TEST_CASE("formulas that are not finite end the run with the place") {
  Scene scene = block(4, 4);
  scene.body.acceleration_m_s2 = Formulas{"0", "1/(X - 0.25)"};
  CHECK_THROWS_WITH(Run(scene), Catch::Contains("body.acceleration_m_s2[1] = \"1/(X - 0.25)\" is inf at X = 0.25 m"));
  scene.body.acceleration_m_s2.reset();
  scene.initial.velocity_m_s = Formulas{"sqrt(X - 1)", "0"};
  CHECK_THROWS_AS(Run(scene), NumericalFailure);
  scene.initial.velocity_m_s.reset();
  scene.body.acceleration_m_s2 = Formulas{"t < 1e-3 ? 0 : 1/0", "0"};
  Run run(scene);
  CHECK_THROWS_WITH(run.advance(100), Catch::Contains("t = 0.00"));
}

// Requires force balance at every free node, by the sums that an explicit step makes: internal force, body force and
// the fluid's pressure, with a fracture and two rocks. Mutations that fail: no share of the jumps (f_j or G^T u_0 left
// out), the load not put into displacements().
TEST_CASE("equilibrium under a body force is where an explicit step finds no force") {
  Scene scene = pulled();
  scene.rocks.push_back({"soft", 5e9, 0.3, 2200.0, 1e6});
  scene.laws.resize(2);
  scene.strata.layers = {{0, 0.0, 12.0}, {1, 12.0, 20.0}};
  scene.strata.interfaces = {{0, 12.0}};
  Statics s(scene);
  CHECK_FALSE(s.model.body->halved);
  s.solve();
  State& state = s.state();
  CHECK(state.fracture().points.front().opening() > 1e-5);
  particles_to_grid(s.run.scene, s.run.rocks, state);
  add_body_force(s.run.scene, state);
  double load = 0.0;
  for (std::size_t q = 0; q < state.particles.size(); ++q)
    load = std::max(load, state.particles.m[q] * state.body[q].norm());
  update_stencil_weights(s.run.scene, state);
  add_net_tractions(state);
  for (const TipTie& tie : state.ties) {
    CHECK(tie.s.reaction.norm() < 1e-300);  // the tip is on a grid line: no spring
  }
  fold_to_masters(state, state.sums);
  double off = 0.0;
  for (std::size_t r = 0; r < state.sums.size(); ++r)
    off = std::max({off, std::abs(state.sums.f_x[r]), std::abs(state.sums.f_y[r])});
  CAPTURE(off, load);
  CHECK(load > 1e4);
  CHECK(off < 1e-8 * load);
}

// Requires the weight above it in a spring interface, t = rho g H, and the same carried by a bonded one. Mutations that
// fail: no f_j, no term m b Phi in what a column carries.
TEST_CASE("an interface carries the weight of what lies on it") {
  const double weight = 4000.0 * 10.0 * 5.0;  // Pa
  for (const bool bonded : {false, true}) {
    Scene scene = block(6, 8);
    scene.domain.bottom = Edge::symmetry;
    scene.domain.sides = Edge::fixed;
    scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
    scene.body.acceleration_m_s2 = Formulas{"0", "-10"};
    scene.rocks.push_back({"heavy", 10e9, 0.2, 4000.0, 1e6});  // a mean over both sides would hide equal densities
    add_interface(scene, bonded ? weak_law(1e9, 1e9) : soft_law(1e8, 1e8, InterfaceLaw::Compression::spring), 3.0, 1);
    Statics s(scene);
    s.solve();
    if (!bonded) {
      for (const SurfacePoint& point : s.state().surfaces[0].points)
        CHECK(point.opening() == Approx(-weight / 1e8).epsilon(1e-9));
      continue;
    }
    find_forces(s.run.rocks, s.state(), s.model.bonds);
    judge_bonds(s.run.scene, s.state(), s.model.bonds);
    REQUIRE_FALSE(s.model.bonds.places.empty());
    for (const BondedPlace& place : s.model.bonds.places) {
      CHECK(place.carried.y() == Approx(weight).epsilon(1e-9));
      const double x = s.state().surfaces[0].points[place.point].x.x();
      if (x > 1.5 && x < 4.5) CHECK(std::abs(place.carried.x()) < 1e-9 * weight);  // the sides' reaction is not counted
    }
  }
}

// Requires that a spring so soft that the half above sinks by metres is told from no spring at all. Mutation that
// fails: balance to 1e-9 of the load alone, which round-off of the sinking exceeds.
TEST_CASE("the softest springs are no mechanism, no spring is one") {
  for (const double D : {1e3, 0.0}) {
    Scene scene = block(20, 40, 0.2);
    scene.domain.bottom = Edge::symmetry;
    scene.domain.sides = Edge::fixed;
    scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
    scene.body.acceleration_m_s2 = Formulas{"0", "-1"};
    add_interface(scene, soft_law(D, 1e9, InterfaceLaw::Compression::spring), 3.9);
    Statics s(scene);
    if (D == 0.0) {
      CHECK_THROWS_WITH(s.solve(), Catch::Contains("mechanism"));
      continue;
    }
    s.solve();
    for (const SurfacePoint& point : s.state().surfaces[0].points)
      CHECK(point.opening() == Approx(-2500.0 * 4.1 / D).epsilon(1e-6));
  }
}

// Requires that J does not depend on its ring where a body force acts within it. Mutation that fails: J without b.
TEST_CASE("J is the same on small and large rings under a body force") {
  std::vector<double> J;
  for (const double ring : {3.0, 5.0}) {
    Scene scene = block(40, 40, 0.5);
    hold_edges(scene);
    scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
    scene.numerics.ring_cells = ring;
    add_fracture(scene, {{10.0, 0.0}, {10.0, 6.0}}, 0.1e6);
    scene.body.acceleration_m_s2 = Formulas{"0", "2000*sin(pi*X/10)"};
    Statics s(scene);
    s.solve();
    CHECK(s.state().tips[0].ring_m == Approx(ring * 0.5));
    J.push_back(s.state().tips[0].J);
  }
  CAPTURE(J);
  CHECK(J[0] > 0.1);
  CHECK(J[1] == Approx(J[0]).epsilon(0.02));
}

// Requires the ledger to close from load to load: the body force works on all that moves. Mutations that fail: no work
// of the body force, b of the step's end alone.
TEST_CASE("the ledger closes without inertia") {
  Scene scene = pulled();
  Run run(scene);
  Quasistatic statics;
  start_quasistatic(run.scene, run.rocks, run.state, statics);
  CHECK(std::abs(run.state.ledger.closure()) < 1e-9);
  const double at_start = run.state.ledger.body_work;
  for (const double until : {0.5, 1.0, 3.0}) {
    advance_quasistatic(run.scene, run.rocks, until, run.state, statics);
    CHECK(std::abs(run.state.ledger.closure()) < 1e-9);
  }
  CHECK(run.state.ledger.body_work > 2.0 * at_start);
}

TEST_CASE("a body force that no edge holds is refused") {
  Scene scene = block(6, 6);
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  const auto refusal = [&](const char* x, const char* y) {
    scene.body.acceleration_m_s2 = Formulas{x, y};
    Statics s(scene);
    try {
      s.solve();
    } catch (const NumericalFailure& failure) {
      return std::string(failure.what());
    }
    return std::string();
  };
  CHECK_THAT(refusal("1", "0"), Catch::Contains("pushes the whole block"));
  CHECK_THAT(refusal("0", "-9.81"), Catch::Contains("lifts the whole block"));
  CHECK_THAT(refusal("Y - 3", "0"), Catch::Contains("turns the whole block"));
  CHECK(refusal("X - 3", "Y - 3").empty());
  scene.domain.sides = Edge::fixed;
  CHECK(refusal("1", "0").empty());
}
