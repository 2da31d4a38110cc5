// kinematics = "total": particles and surfaces stay in their reference places.
#include <catch2/catch.hpp>

#include "explicit/advance.hpp"
#include "interfaces/surface_law.hpp"
#include "output/checkpoint.hpp"
#include "output/fields.hpp"
#include "output_state.hpp"
#include "result_file.hpp"
#include "small_scenes.hpp"

using namespace strata;
using namespace strata::test;

namespace {

using Compression = InterfaceLaw::Compression;
using Kinematics = Numerics::Kinematics;

// A fracture from the symmetry line of a 16 m by 16 m block under pressure 1 MPa above its closing stress.
Scene crack(Kinematics kinematics, double damping) {
  Scene scene = block(16, 16);
  hold_edges(scene);
  scene.in_situ = {3e6, 2e6, InSitu::Initialise::uniform};
  scene.numerics.damping_1_s = damping;
  scene.numerics.kinematics = kinematics;
  add_fracture(scene, {{8.0, 0.0}, {8.0, 5.0}}, 3e6);
  scene.resolved_toml = "crack";
  return scene;
}

// As that, but growing through a weak interface.
Scene growing(Kinematics kinematics) {
  Scene scene = crack(kinematics, 20.0);
  add_interface(scene, weak_law(0.3e6, 0.3e6, 0.2), 8.0);
  scene.fracture->growth = Fracture::Growth::J;
  return scene;
}

// Displacement of particles from their places in the reference state, by the particle's id.
std::vector<Vec2> places(const State& state) {
  std::vector<Vec2> x(state.particles.size());
  for (std::size_t q = 0; q < x.size(); ++q)
    x[static_cast<std::size_t>(state.particles.id[q])] = {state.particles.x[q], state.particles.y[q]};
  return x;
}

}  // namespace

// Requires that two bars in series with springs between them, on a grid line and at mid-cell, settle at the jump of the
// series, t = stretch/(L/M + 1/D), while all places stay: kinematics changes nothing that small strain knows.
// Mutations that fail: particles that move, displacement not advanced.
TEST_CASE("bars in series are exact in their reference places") {
  for (const double at : {4.0, 3.5}) {
    for (const auto shape : {Numerics::Shape::bspline2, Numerics::Shape::linear}) {
      const double D = 1e9, stretch = 1e-6;
      Scene scene = block(4, 8);
      hold_edges(scene);
      scene.numerics.shape = shape;
      scene.numerics.kinematics = Kinematics::total;
      scene.numerics.damping_1_s = 300.0;
      add_interface(scene, soft_law(D, D), at);
      Run run(scene);
      Particles& p = run.state.particles;
      for (std::size_t q = 0; q < p.size(); ++q) strain(run.state, q, {0.0, 0.0, 0.0, stretch / 8.0});
      const std::vector<Vec2> before = places(run.state);
      run.advance(800);
      const double t = stretch / (8.0 / (run.rocks[0].lambda + 2.0 * run.rocks[0].mu) + 1.0 / D);
      for (const SurfacePoint& s : run.state.surfaces[0].points) {
        CHECK(s.opening() == Approx(t / D).epsilon(2e-6));
        CHECK(s.x.y() == at);
      }
      CHECK(places(run.state) == before);
    }
  }
}

// Requires that a damped crack settles on the same K_I, opening and displacements as with moving particles, to the
// order of the strain (P/E' = 1e-4; measured below), while a particle that moves ends where its displacement says.
TEST_CASE("total and updated agree to the order of the strain") {
  Run total(crack(Kinematics::total, 200.0)), updated(crack(Kinematics::updated, 200.0));
  const std::vector<Vec2> before = places(total.state);
  total.advance(700);
  updated.advance(700);
  const double K = total.state.tips[0].K_I, w = total.state.surfaces[0].points[0].opening();
  CAPTURE(K / updated.state.tips[0].K_I - 1.0, w / updated.state.surfaces[0].points[0].opening() - 1.0);
  CHECK(K > 1e6);
  CHECK(K == Approx(updated.state.tips[0].K_I).epsilon(5e-4));
  CHECK(w == Approx(updated.state.surfaces[0].points[0].opening()).epsilon(5e-4));
  CHECK(places(total.state) == before);
  double off = 0.0, most = 0.0;
  const std::vector<Vec2> now = places(updated.state);
  for (std::size_t q = 0; q < now.size(); ++q) {
    const auto id = static_cast<std::size_t>(total.state.particles.id[q]);
    const Vec2 u{total.state.particles.u_x[q], total.state.particles.u_y[q]};
    off = std::max(off, (now[id] - before[id] - u).norm());
    most = std::max(most, u.norm());
  }
  CHECK(most > 2e-4);
  CHECK(off < 2e-3 * most);
  for (std::size_t k = 0; k < total.state.fracture().vertices.size(); ++k) {
    const SurfacePoint &s = total.state.fracture().vertices[k], &moved = updated.state.fracture().vertices[k];
    CHECK((s.x + s.u - moved.x).norm() < 2e-3 * most);
  }
}

// Requires that a growing run saved at a multiple of steps_between_bases and resumed goes on to the same digits, as
// run() does (nodal velocities included), and that new points of its fracture start with the displacement of the rock
// around them: within 20 % of the openings, which is what the tip's field varies by over a cell.
TEST_CASE("a run in reference places resumes to the same digits") {
  const TemporaryFolder folder;
  Run run(growing(Kinematics::total));
  const auto advance = [](Run& one, std::int64_t steps) {
    for (std::int64_t k = 0; k < steps; ++k)
      strata::advance(one.scene, one.rocks, one.state, growth_weighing(one.scene, one.rocks));
  };
  advance(run, steps_between_bases);
  save_checkpoint(folder.path / "checkpoint.bin", run.scene, {run.state, {}});
  Run again(growing(Kinematics::total));
  again.state = load_checkpoint(folder.path / "checkpoint.bin", run.scene).state;
  again.rebuild();
  advance(run, 150), advance(again, 150);
  CHECK(run.state.total.v_x == again.state.total.v_x);
  CHECK(run.state.total.v_y == again.state.total.v_y);
  bring_up_to_date(run.scene, run.state), bring_up_to_date(again.scene, again.state);
  CHECK(run.state.fracture().points.size() > 12);
  CHECK(run.state.particles.id == again.state.particles.id);
  CHECK(run.state.particles.u_x == again.state.particles.u_x);
  CHECK(run.state.particles.u_y == again.state.particles.u_y);
  CHECK(run.state.particles.v_x == again.state.particles.v_x);
  CHECK(run.state.ledger.dissipated() == again.state.ledger.dissipated());
  for (std::size_t k = 0; k < run.state.fracture().vertices.size(); ++k) {
    CHECK(run.state.fracture().vertices[k].u == again.state.fracture().vertices[k].u);
    CHECK(run.state.fracture().vertices[k].w == again.state.fracture().vertices[k].w);
  }
}

// Requires that written positions are where the rock now is: x + u of particles and vertices.
TEST_CASE("positions are written where the rock is") {
  const TemporaryFolder folder;
  Run run(crack(Kinematics::total, 200.0));
  run.advance(200);
  const RunFolder files{folder.path};
  make_folder(files.all_fields());
  write_fields(files, 0, run.scene, run.state);
  const auto file = hdf5::open_file(files.fields(0));
  const auto x = hdf5::read(file, "particles/00000/x_m"), u = hdf5::read(file, "particles/00000/u_x_m");
  const std::vector<Vec2> before = places(run.state);
  double most = 0.0;
  for (std::size_t q = 0; q < x.size(); ++q) {
    most = std::max(most, std::abs(u[q]));
    CHECK(x[q] == Approx(before[q].x() + u[q]).epsilon(2e-7));
  }
  CHECK(most > 1e-4);
  const auto y = hdf5::read(file, "fracture/00000/y_m");
  const SurfacePoint& tip = run.state.fracture().vertices.back();
  CHECK(tip.x.y() == 5.0);
  CHECK(std::abs(tip.u.y()) > 1e-6);
  CHECK(y.back() == tip.x.y() + tip.u.y());
}

// Requires that places which contact, stick or a spring holds are solved together: while waves run past a closed
// interface all of them stand at the jump of their law, w + r/k = rest, to 1e-9 of the largest closure, after the four
// sweeps that a step takes at least. Mutations that fail: solve_held_reactions() left out, rest 0 or doubled,
// compliance doubled, the change of the other sign.
TEST_CASE("what holds places is solved together") {
  const InterfaceLaw law =
      GENERATE(soft_law(0.5e6, 0.5e6), friction_law(50.0), soft_law(1e9, 1e9, Compression::spring));
  Scene scene = crack(Kinematics::total, 0.0);
  add_interface(scene, law, 8.0);
  Run run(scene);
  for (SurfacePoint& s : run.state.surfaces[1].points) s.split = true, s.w = Vec2::Zero();
  run.rebuild();
  run.advance(40);
  const std::int64_t sweeps = run.state.monitors.contact_sweeps;
  const bool spring = law.kind == InterfaceLaw::Kind::soft && law.compression == Compression::spring;
  const double k = spring ? 1e9 : contact_stiffness(scene.laws[1], run.rocks, run.state.grid);
  run.advance(10);
  double off = 0.0, largest = 0.0;
  for (const SurfacePoint& s : run.state.surfaces[1].points) {
    const double rest = spring ? 0.0 : s.closing_stress() / k, r = s.reaction.dot(s.n) / k;
    off = std::max(off, std::abs(s.opening() + r - rest)), largest = std::max(largest, std::abs(r));
  }
  CAPTURE(static_cast<int>(law.kind), off, largest);
  CHECK(largest > 0.0);
  CHECK(off < 1e-9 * largest);
  CHECK(run.state.monitors.contact_sweeps - sweeps == 40);
}
