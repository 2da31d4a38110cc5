// The fixed operator of kinematics = "total": composed stencils against the particles they are made of, and what events
// do to the nodes.
#include <catch2/catch.hpp>

#include "explicit/total/total_operator.hpp"
#include "random_scene.hpp"
#include "small_scenes.hpp"
#include "state/lanes.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// A random block as an explicit one in its reference places, wider than high, so that rows of the grid hold runs of any
// length that vectors may leave over.
Run random_block(unsigned seed) {
  Scene scene = random_scene(seed);
  Dice dice(seed + 1000);
  scene.numerics.mechanics = Numerics::Mechanics::explicit_dynamics;
  scene.numerics.kinematics = Numerics::Kinematics::total;
  scene.numerics.shape = dice.chance(0.7) ? Numerics::Shape::bspline2 : Numerics::Shape::linear;
  scene.numerics.particles_per_cell = dice.chance(0.6) ? 4 : 16;
  if (scene.fracture) scene.fracture->growth = Fracture::Growth::none;
  if (scene.strata.along == Strata::Along::y) scene.domain.width_m += 2 * dice.below(35);
  return Run(scene);
}

// Gives the masters random displacements and velocities, none where an edge holds them.
void stir_nodes(State& state, unsigned seed) {
  TotalMotion& t = state.total;
  Dice dice(seed);
  for (std::size_t r = 0; r < state.masters.size(); ++r) {
    if (!(t.m[r] > 0.0)) continue;
    t.u_x[r] = state.masters[r].x * dice.uniform(-1e-3, 1e-3);
    t.u_y[r] = state.masters[r].y * dice.uniform(-1e-3, 1e-3);
    t.v_x[r] = state.masters[r].x * dice.uniform(-1.0, 1.0);
    t.v_y[r] = state.masters[r].y * dice.uniform(-1.0, 1.0);
  }
}

double largest_of(const SpreadArray& values) {
  double most = 0.0;
  for (const double value : values) most = std::max(most, std::abs(value));
  return most;
}

double largest_difference(const SpreadArray& a, const SpreadArray& b) {
  double most = 0.0;
  for (std::size_t k = 0; k < a.size(); ++k) most = std::max(most, std::abs(a[k] - b[k]));
  return most;
}

// How many records are in runs that vectors go through, or in shorter ones.
double of_records(const StencilOperator& op, bool by_vectors) {
  std::size_t count = 0;
  for (const StencilRun& run : op.runs) {
    const std::size_t n = run.last - run.first;
    if ((n >= most_lanes) == by_vectors) count += n;
  }
  return static_cast<double>(count);
}

// sum m v over the nodes.
Vec2 nodal_momentum(const State& state) {
  const TotalMotion& t = state.total;
  Vec2 sum = Vec2::Zero();
  for (std::size_t s = 0; s < t.m.size(); ++s) sum += t.m[s] * Vec2{t.v_x[s], t.v_y[s]};
  return sum;
}

}  // namespace

// Requires that the composed stencils give random nodal displacements the forces that the particles give them, to 1e-11
// of the largest, in 150 random blocks with cracks at any angle, interfaces and contrasts, layers of either direction,
// edges of every kind: both by vectors and one by one. Mutations that fail: the last vectors of a run left out, the
// base left out of runs, K_xy of the other sign, single records twice.
TEST_CASE("composed stencils are the particles' operator") {
  double in_vectors = 0.0, alone = 0.0, worst = 0.0;
  for (unsigned seed = 0; seed < 150; ++seed) {
    Run run = random_block(seed);
    State& state = run.state;
    start_base(run.scene, run.rocks, state);
    stir_nodes(state, seed);
    TotalMotion& t = state.total;
    run.scene.numerics.kernels = Numerics::Kernels::fast;
    const double fast_power = find_accelerations(run.scene, run.rocks, state);
    const auto a_x = t.a_x, a_y = t.a_y;
    run.scene.numerics.kernels = Numerics::Kernels::plain;
    const double plain_power = find_accelerations(run.scene, run.rocks, state);
    const double most = std::max(largest_of(t.a_x), largest_of(t.a_y));
    const double off = std::max(largest_difference(a_x, t.a_x), largest_difference(a_y, t.a_y));
    CAPTURE(seed, off / most, fast_power / plain_power - 1.0);
    CHECK(most > 0.0);
    CHECK(off < 1e-11 * most);
    CHECK(fast_power == Approx(plain_power).epsilon(1e-9));
    worst = std::max(worst, off / most);
    in_vectors += of_records(*t.op, true), alone += of_records(*t.op, false);
  }
  CAPTURE(worst, in_vectors, alone);
  CHECK(in_vectors > 5000.0);
  CHECK(alone > (most_lanes > 2 ? 5000.0 : 500.0));
}

// Requires that a block moving as a whole keeps doing so: velocities that particles start with come to the nodes
// exactly where they are uniform, no force arises, and particles have moved by v t.
TEST_CASE("a block in rigid motion stays in it") {
  for (const auto shape : {Numerics::Shape::bspline2, Numerics::Shape::linear}) {
    Scene scene = block(12, 10);
    scene.numerics.kinematics = Numerics::Kinematics::total;
    scene.numerics.shape = shape;
    scene.initial.velocity_m_s = Formulas{"0.3", "-0.2"};
    Run run(scene);
    run.advance(40);
    const double time = run.state.time;
    for (std::size_t q = 0; q < run.state.particles.size(); ++q) {
      CHECK(run.state.particles.v_x[q] == Approx(0.3).epsilon(1e-12));
      CHECK(run.state.particles.u_y[q] == Approx(-0.2 * time).epsilon(1e-12));
    }
    CHECK(run.state.ledger.kinetic == Approx(run.state.ledger.initial_kinetic).epsilon(1e-12));
  }
}

// Requires that growth keeps the nodes' momentum where it splits masses along a straight path, to round-off, and that
// their kinetic energy goes on: what the ledger counts as lost in transfer is none.
TEST_CASE("nodes keep their momentum as a fracture grows") {
  Scene scene = block(16, 20);
  scene.in_situ = {3e6, 2e6, InSitu::Initialise::uniform};
  scene.numerics.kinematics = Numerics::Kinematics::total;
  add_fracture(scene, {{8.0, 7.0}, {8.0, 13.0}}, 3.2e6);
  scene.fracture->growth = Fracture::Growth::J;
  scene.rocks[0].toughness_Pa_sqrt_m = 2e6;
  scene.initial.velocity_m_s = Formulas{"0.01*sin(X/3)", "0.02+0.01*cos(Y/4)"};
  Run run(scene);
  int grown = 0;
  double lost = 0.0;  // as the particles' velocities came to the nodes
  for (int step = 0; step < 200; ++step) {
    const std::size_t points = run.state.fracture().points.size();
    // Free edges and pressure on both faces: nothing pushes the block as a whole.
    const Vec2 before = step > 0 ? nodal_momentum(run.state) : Vec2{Vec2::Zero()};
    strata::advance(run.scene, run.rocks, run.state, growth_weighing(run.scene, run.rocks));
    const Vec2 after = nodal_momentum(run.state);
    if (step == 0) lost = run.state.ledger.transfer;
    if (step == 0) continue;
    const double scale = 16.0 * 20.0 * 2500.0 * 0.01;
    CHECK((after - before).norm() < 1e-11 * scale);
    if (run.state.fracture().points.size() > points) ++grown;
  }
  CHECK(grown >= 2);
  CHECK(std::abs(nodal_momentum(run.state).y()) > 16.0 * 20.0 * 2500.0 * 0.01);
  CHECK(std::abs(run.state.ledger.transfer - lost) < 1e-12 * run.state.ledger.initial_kinetic);
  CHECK(std::abs(lost) < 0.01 * run.state.ledger.initial_kinetic);
}

// Requires that one step by plain kernels and one by fast ones agree to 1e-10 from any state of a growing run, and that
// whole runs grow at the same steps.
TEST_CASE("plain and fast kernels tell the same story") {
  Scene scene = block(16, 20);
  hold_edges(scene);
  scene.in_situ = {3e6, 2e6, InSitu::Initialise::uniform};
  scene.numerics.damping_1_s = 20.0;
  scene.numerics.kinematics = Numerics::Kinematics::total;
  add_interface(scene, weak_law(0.3e6, 0.3e6, 0.2), 8.0);
  add_fracture(scene, {{8.0, 0.0}, {8.0, 5.0}}, 2e6);
  scene.fracture->growth = Fracture::Growth::J;
  scene.fluid.law = Fluid::Law::paper;
  scene.fluid.rate_Pa_s = 40e6;
  Scene plain_scene = scene;
  plain_scene.numerics.kernels = Numerics::Kernels::plain;
  Run fast(scene), plain(plain_scene);
  std::vector<std::int64_t> grown_fast, grown_plain;
  const auto step = [](Run& run, std::vector<std::int64_t>& grown) {
    const std::size_t points = run.state.fracture().points.size();
    strata::advance(run.scene, run.rocks, run.state, growth_weighing(run.scene, run.rocks));
    if (run.state.fracture().points.size() > points) grown.push_back(run.state.step);
  };
  for (int k = 0; k < 400; ++k) {
    if (k % 50 == 0) {  // one step from the same state
      State other = fast.state;
      strata::advance(plain.scene, plain.rocks, other, growth_weighing(plain.scene, plain.rocks));
      State own = fast.state;
      strata::advance(fast.scene, fast.rocks, own, growth_weighing(fast.scene, fast.rocks));
      const double most = largest_of(own.total.v_x);
      CHECK(largest_difference(own.total.v_x, other.total.v_x) <= 1e-10 * most);
      CHECK(largest_difference(own.total.a_y, other.total.a_y) <= 1e-10 * largest_of(own.total.a_y));
    }
    step(fast, grown_fast), step(plain, grown_plain);
  }
  CHECK(grown_fast == grown_plain);
  CHECK(grown_fast.size() >= 3);
  CHECK(fast.state.tips[0].J == Approx(plain.state.tips[0].J).epsilon(1e-6));
  const auto& points = fast.state.surfaces[1].points;
  CHECK(std::any_of(points.begin(), points.end(), [](const SurfacePoint& s) { return s.split; }));
}
