// States that are no solution end the run: contact that runs out of sweeps, flow and rock that do not come together.
#include <catch2/catch.hpp>

#include <limits>

#include "explicit/reactions.hpp"
#include "quasistatic/fluid_step.hpp"
#include "quasistatic/load_steps.hpp"
#include "random_scene.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

constexpr const char* not_solved = "contact, friction and springs were not solved";

// Two blocks on an interface that fails at once and then has a coefficient of friction, through which a pressurised
// fracture runs at 45 degrees: the normal reaction of each bounds what holds the other.
Scene crossed(double coefficient) {
  Scene scene = block(12, 12);
  scene.domain.bottom = Edge::symmetry;
  scene.in_situ.vertical_Pa = 1.4e6, scene.in_situ.horizontal_Pa = 0.4e6;
  scene.rocks.push_back({"other", 6e9, 0.2, 2500.0, 1e6});
  add_interface(scene, weak_law(1e3, 1e3, coefficient), 6.0, 1);
  add_fracture(scene, {{4.0, 4.0}, {8.0, 8.0}}, 3e6);
  scene.fluid.rate_Pa_s = 1e6;
  scene.numerics.kinematics = Numerics::Kinematics::total;
  return scene;
}

// Two blocks that are split all along and stirred by 0.1 m/s, without any load, with a fracture through both.
Run stirred(double coefficient, unsigned seed) {
  Scene scene = block(12, 12);
  scene.domain.bottom = Edge::symmetry;
  add_interface(scene, friction_law(coefficient), 6.0);
  add_fracture(scene, {{3.0, 5.0}, {9.0, 7.0}});
  Run run(scene);
  for (Surface& surface : run.state.surfaces) {
    if (surface.kind != Surface::Kind::interface) continue;
    for (SurfacePoint& s : surface.points) s.split = true;
  }
  Dice dice(seed);
  Particles& p = run.state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    p.v_x[q] = dice.uniform(-0.1, 0.1);
    p.v_y[q] = dice.uniform(-0.1, 0.1);
  }
  run.rebuild();
  return run;
}

bool ends_unsolved(Run& run, int steps) {
  try {
    run.advance(steps);
    return false;
  } catch (const NumericalFailure& failure) {
    CHECK_THAT(failure.what(), Catch::Contains(not_solved));
    return true;
  }
}

// A crack from the symmetric bottom of a 12 m block, fed at a rate (m^2/s).
Scene fed(double rate) {
  Scene scene = block(12, 12);
  hold_edges(scene);
  scene.in_situ = {3e6, 2e6};
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  add_fracture(scene, {{6.0, 0.0}, {6.0, 3.0}}, 2e6);
  scene.fluid.law = Fluid::Law::reynolds;
  scene.fluid.rate_m2_s = rate;
  return scene;
}

struct Fed {
  Run run;
  Quasistatic statics;
  explicit Fed(const Scene& scene) : run(scene) { start_quasistatic(run.scene, run.rocks, run.state, statics); }
  void step(double until) { advance_quasistatic(run.scene, run.rocks, until, run.state, statics); }
};

}  // namespace

// Requires that friction of which no sweep finds the reactions ends the run with a reason and finite numbers, and that
// an ordinary coefficient does not; where points stay in place, rough friction is solved: places that hold are solved
// together, without which it ended here.
TEST_CASE("contact that is far from its laws ends the run") {
  for (const auto& [coefficient, left] : {std::pair{0.6, 0.01}, {1e6, most_left}}) {
    Run run(crossed(coefficient));
    CHECK_NOTHROW(run.advance(1000));
    CHECK(run.state.monitors.contact_left < left);
    CHECK(std::isfinite(run.state.ledger.kinetic));
  }
  int ended = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    Run smooth = stirred(0.6, seed), coarse = stirred(1e3, seed);
    CHECK_FALSE(ends_unsolved(smooth, 60));
    CHECK(smooth.state.monitors.contact_left < 0.01);
    if (!ends_unsolved(coarse, 60)) continue;
    ++ended;
    CHECK(coarse.state.monitors.contact_left > most_left);
    CHECK(std::isfinite(coarse.state.ledger.kinetic));
  }
  CHECK(ended >= 4);
}

// Requires that what the last sweep changes is held against a tenth of the largest traction, be it a reaction, the
// fluid's pressure or the in-situ stress at a split place, that a number which is none is more, and that a step which
// had sweeps left is not judged.
TEST_CASE("what sweeps may leave") {
  Scene scene = block(8, 8);
  add_interface(scene, friction_law(0.5), 4.0);
  Run run(scene);
  State& state = run.state;
  SurfacePoint& s = state.surfaces[0].points[2];
  const auto ends = [&](double change, double largest) {
    CHECK_THROWS_AS(require_settled(most_sweeps, change, largest, state), NumericalFailure);
  };
  const auto goes_on = [&](double change, double largest) {
    CHECK_NOTHROW(require_settled(most_sweeps, change, largest, state));
  };
  ends(1.1e5, 1e6), goes_on(0.9e5, 1e6);
  ends(0.11, 1e-9), goes_on(0.09, 1e-9);  // 1 Pa at least
  CHECK_NOTHROW(require_settled(most_sweeps - 1, 1e9, 1e6, state));
  ends(std::numeric_limits<double>::quiet_NaN(), 1e6);
  s.P = -2e6;
  ends(1.9e5, 1e6);  // a bonded place bears nothing that is sought
  s.split = true;
  goes_on(1.9e5, 1e6), ends(2.1e5, 1e6);
  s.in_situ = {-3e6, 4e6};
  goes_on(4.9e5, 1e6), ends(5.1e5, 1e6);
}

// Requires that a step of flow and rock that finds no solution is made shorter until one is found, and that a rate for
// which there is none ends the run with a reason, at the time from which no step led on.
TEST_CASE("flow and rock that do not come together") {
  Fed fine(fed(1e-3));
  CHECK_NOTHROW(fine.step(0.1));
  CHECK(fine.run.state.time > 0.0);
  Fed never(fed(1e16));
  CHECK_THROWS_WITH(never.step(0.1),
                    Catch::StartsWith("at t = 0 s, in any step: ") &&
                        (Catch::Contains("did not converge") || Catch::Contains("not finite")));  // digits decide
  Fed halved(fed(1e8));
  constexpr double too_long = 0.1;  // s
  State trial = halved.run.state;
  CHECK_FALSE(advance_fluid(halved.run.scene, too_long, trial, halved.statics.model).found);
  halved.run.state.dt = too_long;
  CHECK_NOTHROW(halved.step(1.0));
  CHECK(halved.run.state.time > 0.0);
  CHECK(halved.run.state.time <= 0.5 * too_long);
  CHECK(std::abs(halved.run.state.monitors.volume_balance) < 1e-9);
}
