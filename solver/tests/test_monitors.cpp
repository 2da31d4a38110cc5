#include "force_balance.hpp"
#include "interfaces/monitors.hpp"

#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "explicit/reactions.hpp"
#include "fracture/growth.hpp"
#include "output/suspect.hpp"
#include "quasistatic/load_steps.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

std::vector<std::string> marks(const Run& run) {
  std::vector<std::string> names;
  for (const Watched& mark : suspicions(run.scene, run.state)) names.push_back(mark.monitor);
  return names;
}
using Names = std::vector<std::string>;

// Of a load that is fast on purpose.
Names marks_but_loading(const Run& run) {
  Names names = marks(run);
  std::erase(names, "loading_share");
  return names;
}

// A block free along both axes, whose points move at random.
Scene adrift(Numerics::Kinematics kinematics, double damping) {
  Scene scene = block(10, 8);
  scene.numerics.kinematics = kinematics;
  scene.numerics.damping_1_s = damping;
  add_fracture(scene, {{5.0, 2.0}, {5.0, 6.0}}, 1e6);
  return scene;
}

// Courant number that blocks whose edges are all held stand and free edges do not.
double beyond_free_edges(Numerics::Kinematics kinematics) {
  return kinematics == Numerics::Kinematics::total ? 1.2 : 0.92;
}

void look(Run& run) {
  bring_up_to_date(run.scene, run.state);
  run.state.ledger.strain = strain_energy(run.rocks, run.state.particles);
  watch_row(run.scene, run.state);
}

// A crack from the symmetric bottom under pressure, in equilibrium.
Scene pressed() {
  Scene scene = block(16, 14);
  hold_edges(scene);
  scene.in_situ = {3e6, 2e6, InSitu::Initialise::uniform};
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  add_fracture(scene, {{8.0, 0.0}, {8.0, 5.0}}, 2.5e6);
  return scene;
}

struct AtRest {
  Run run;
  Quasistatic statics;
  explicit AtRest(const Scene& scene) : run(without_lanes(scene)) {
    start_quasistatic(run.scene, run.rocks, run.state, statics);
    set_all_particles(run.scene, run.state, statics.model);
  }
};

}  // namespace

// Requires momentum kept to round-off along free axes, by both kinematics, with damping, body force and a fracture
// under pressure; and one push by hand of 1e-6 of it to mark the run. Mutations that fail: damping left out of the
// expected momentum, the body force left out or twice.
TEST_CASE("momentum is what the start and the body force give") {
  const auto kinematics = GENERATE(Numerics::Kinematics::updated, Numerics::Kinematics::total);
  const double damping = GENERATE(0.0, 30.0);
  Scene scene = adrift(kinematics, damping);
  scene.initial.velocity_m_s = Formulas{"2 + 0.1*X", "-1"};
  scene.body.acceleration_m_s2 = Formulas{"30", "-9.81"};
  Run run(scene);
  look(run);
  run.advance(60);
  look(run);
  CAPTURE(damping, run.state.monitors.largest_drift, run.state.monitors.largest_momentum);
  CHECK(run.state.monitors.largest_momentum > 1.0);
  CHECK(run.state.monitors.largest_drift < 1e-11 * run.state.monitors.largest_momentum);
  CHECK(marks(run).empty());
  for (double& v : run.state.particles.v_x) v *= 1.0 + 1e-6;
  watch_row(run.scene, run.state);
  CHECK(marks(run) == Names{"momentum"});
}

// Requires a step of 1.75 h/c_P, which no block stands, to be marked by itself; one a few per cent beyond what this
// block with free edges stands (1.16, under FLIP 0.86) by the energy that it makes, before the step gives up; and 0.5
// to be sound.
TEST_CASE("a time step beyond its limit is marked") {
  const auto kinematics = GENERATE(Numerics::Kinematics::updated, Numerics::Kinematics::total);
  Scene scene = block(12, 10);
  scene.numerics.kinematics = kinematics;
  add_fracture(scene, {{6.0, 3.0}, {6.0, 7.0}});
  scene.fluid.rate_Pa_s = 2e7;  // 1 MPa in eight crossings of the block by a P wave
  Run sound(scene);
  look(sound);
  for (int k = 0; k < 40; ++k) {
    sound.advance(5);
    look(sound);
  }
  CAPTURE(sound.state.monitors.largest_made_J, sound.state.ledger.largest);
  CHECK(marks_but_loading(sound) == Names{});
  scene.numerics.courant = 1.75;
  Run beyond(scene);
  look(beyond);
  CHECK(marks_but_loading(beyond) == Names{"largest_courant"});
  scene.numerics.courant = beyond_free_edges(kinematics);
  Run wild(scene);
  look(wild);
  CHECK(marks_but_loading(wild) == Names{});
  for (int k = 0; k < 40 && marks_but_loading(wild).empty(); ++k) {
    wild.advance(1);
    look(wild);
  }
  CAPTURE(wild.state.step, wild.state.ledger.kinetic, wild.state.monitors.largest_made_J);
  CHECK(marks_but_loading(wild) == Names{"energy_made"});
}

// Requires a block that swings freely, in several modes at once and about a body force that came on at once, to have
// made nothing to round-off where nodes keep their velocities and next to nothing under FLIP, though kinetic and strain
// energy, half a step apart, swing by several per cent; with a step beyond what its free edges stand the product of
// velocities a step apart tells before the run ends. Mutations that fail: no swing, twice the swing, its other sign;
// and (with courant 1.3) the product left out.
TEST_CASE("a block that swings freely makes no energy") {
  const auto kinematics = GENERATE(Numerics::Kinematics::updated, Numerics::Kinematics::total);
  Scene scene = block(12, 10);
  scene.domain.bottom = Edge::symmetry;
  scene.numerics.kinematics = kinematics;
  scene.body.acceleration_m_s2 = Formulas{"X < 5 ? 40 : -25", "Y > 7 ? 60 : X > 8 ? -30 : 10"};
  Run sound(scene);
  for (auto* v : {&sound.state.particles.v_x, &sound.state.particles.v_y}) v->assign(v->size(), 0.0);
  look(sound);
  double least = 0.0, most = 0.0;
  for (int k = 0; k < 300; ++k) {
    sound.advance(1);
    least = std::min(least, sound.state.ledger.integration), most = std::max(most, sound.state.ledger.integration);
  }
  look(sound);
  const Monitors& m = sound.state.monitors;
  const double made = m.largest_made_J / sound.state.ledger.largest;
  CAPTURE(least, most, made, sound.state.ledger.largest, m.largest_strain_J, sound.state.ledger.transfer,
          sound.state.ledger.integration);
  CHECK(most - least > 0.01 * sound.state.ledger.largest);
  CHECK(made < (kinematics == Numerics::Kinematics::total ? 1e-12 : 1e-4));
  CHECK(marks(sound) == Names{});
  scene.numerics.courant = beyond_free_edges(kinematics);
  Run wild(scene);
  look(wild);
  while (wild.state.step < 400 && marks(wild).empty()) wild.advance(1), look(wild);
  CAPTURE(wild.state.step, wild.state.ledger.kinetic, wild.state.ledger.supplied());
  CHECK(marks(wild) == Names{"energy_made"});
}

// Requires sweeps that run out to be counted with what they leave, those that do not to be counted alone, and a change
// that is no number to stay.
TEST_CASE("contact that runs out of sweeps is marked by what it leaves") {
  Scene scene = block(4, 4);
  Run run(scene);
  Monitors& m = run.state.monitors;
  note_sweeps(most_sweeps - 1, 5e5, 1e6, m);
  CHECK(m.contact_unconverged == 0);
  CHECK(marks(run).empty());
  note_sweeps(most_sweeps, 9e3, 1e6, m);
  CHECK(m.contact_unconverged == 1);
  CHECK(m.contact_left == Approx(9e-3));
  CHECK(marks(run).empty());
  note_sweeps(most_sweeps, 2e4, 1e6, m);
  CHECK(m.contact_sweeps == 3 * most_sweeps - 1);
  CHECK(marks(run) == Names{"contact_left"});
  note_sweeps(most_sweeps, std::numeric_limits<double>::quiet_NaN(), 1e6, m);
  note_sweeps(most_sweeps, 1e3, 1e6, m);
  CHECK(std::isnan(m.contact_left));
  CHECK(marks(run) == Names{"contact_left"});
}

// Requires forces at the nodes of an equilibrium in balance to round-off, and a thousandth more of pressure, contact
// pulled off or one particle's strain to mark the run.
TEST_CASE("an equilibrium balances forces at every node") {
  AtRest rest(pressed());
  State& state = rest.run.state;
  watch_forces(rest.run.scene, rest.run.rocks, state);
  CAPTURE(state.monitors.force_balance);
  CHECK(state.monitors.force_balance < 1e-9);
  CHECK(state.monitors.force_balance > 0.0);
  CHECK(marks(rest.run).empty());
  const State before = state;
  for (SurfacePoint& s : state.fracture().points) s.P *= 1.001;
  watch_forces(rest.run.scene, rest.run.rocks, state);
  CHECK(state.monitors.force_balance > 1e-3);
  CHECK(marks(rest.run) == Names{"force_balance"});
  state = before;
  state.particles.g_yy[state.particles.size() / 2] += 1e-4;
  watch_forces(rest.run.scene, rest.run.rocks, state);
  CHECK(marks(rest.run) == Names{"force_balance"});
}

// Requires forces in balance to round-off with a body force and a crack that leans, so that springs of tips carry some.
// Mutations that fail: the body force or the springs left out, or with the other sign.
TEST_CASE("body force and springs of tips are in the balance of nodes") {
  Scene scene = pressed();
  scene.fracture->path_m = {{4.0, 5.0}, {10.0, 9.0}};
  scene.in_situ = {3e6, 1e6, InSitu::Initialise::uniform};
  scene.fluid.start_Pa = 4e6;
  scene.body.acceleration_m_s2 = Formulas{"20*sin(X)", "-9.81"};
  AtRest rest(scene);
  double carried = 0.0;
  for (const TipTie& tie : rest.run.state.ties) carried = std::max(carried, tie.s.reaction.norm());
  REQUIRE(carried > 1e3);
  watch_forces(rest.run.scene, rest.run.rocks, rest.run.state);
  CHECK(rest.run.state.monitors.force_balance > 0.0);
  CHECK(rest.run.state.monitors.force_balance < 1e-9);
}

// Requires of soft interfaces that tension is theirs to carry, that overlap counts where faces meet and not where a
// spring acts both ways, and that what their springs store is strain. Mutations that fail: any of the three turned
// round.
TEST_CASE("soft interfaces may pull, and overlap where a spring acts both ways") {
  for (const auto compression : {InterfaceLaw::Compression::contact, InterfaceLaw::Compression::spring}) {
    Scene scene = block(6, 8);
    scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
    add_interface(scene, soft_law(1e9, 1e9, compression), 4.0);
    Run run(scene);
    Monitors& m = run.state.monitors;
    SurfacePoint& s = run.state.surfaces[0].points[3];
    s.reaction = -1e3 * s.n;
    watch_row(run.scene, run.state);
    CHECK(m.largest_tension_Pa == 0.0);
    s.reaction = 1e3 * s.n, s.w = -1e-5 * s.n;
    watch_row(run.scene, run.state);
    const bool meets = compression == InterfaceLaw::Compression::contact;
    CHECK(m.largest_penetration == (meets ? Approx(1e-5) : Approx(0.0)));
    CHECK(m.largest_contact_Pa == (meets ? Approx(1e3) : Approx(0.0)));
    run.state.ledger.strain = 2.0, run.state.ledger.interface_strain = 3.0;
    watch_row(run.scene, run.state);
    CHECK(m.largest_strain_J == 5.0);
  }
}

// Requires the overlap and the tension of places to be found where the law does not allow them, and only there.
TEST_CASE("overlap and tension are found without inertia, too") {
  AtRest rest(pressed());
  State& state = rest.run.state;
  for (SurfacePoint& s : state.fracture().points) s.P = 1e6;  // below the closing stress: closed
  rest.statics.equilibrium = find_equilibrium(rest.run.scene, 0.0, state, rest.statics.model);
  set_fields(rest.run.scene, state, rest.statics.model, rest.statics.equilibrium);
  set_all_particles(rest.run.scene, state, rest.statics.model);
  watch_forces(rest.run.scene, rest.run.rocks, state);
  CHECK(state.monitors.force_balance < 1e-9);  // of what the fluid and the in-situ stress load, not of the nothing left
  watch_row(rest.run.scene, state);
  CHECK(state.monitors.largest_contact_Pa == Approx(1e6).epsilon(0.2));
  CHECK(state.monitors.largest_penetration < 1e-12);  // what the in-situ contact carried is no overlap
  CHECK(state.monitors.largest_tension_Pa == 0.0);
  state.ledger = Ledger{};  // that no step closed
  state.monitors.largest_open_J = 0.0;
  CHECK(marks(rest.run).empty());
  state.fracture().points[2].reaction = -1e3 * state.fracture().points[2].n;
  watch_row(rest.run.scene, state);
  CHECK(marks(rest.run) == Names{"tension_share"});
  state.monitors.largest_tension_Pa = 0.0;
  state.fracture().points[2].reaction = Vec2::Zero();
  state.fracture().points[1].w = -1e-5 * state.fracture().points[1].n;
  watch_row(rest.run.scene, state);
  CHECK(marks(rest.run) == Names{"penetration_share"});
}

// Requires an energy that is no number to end the run, by its name, whatever the mechanics, and to stay visible in the
// ledger. Mutations that fail: the check left out of either mechanics.
TEST_CASE("a ledger that is not finite ends the run") {
  const std::array entries{std::pair{"body_work", &Ledger::body_work}, std::pair{"fluid_work", &Ledger::fluid_work},
                           std::pair{"friction", &Ledger::friction}, std::pair{"damping", &Ledger::damping},
                           std::pair{"fracture", &Ledger::fracture}};
  for (const auto& [name, entry] : entries) {
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
      for (const auto kinematics : {Numerics::Kinematics::updated, Numerics::Kinematics::total}) {
        Run run(adrift(kinematics, 30.0));
        run.advance(1);
        run.state.ledger.*entry = bad;
        CHECK_THROWS_WITH(run.advance(1), Catch::Contains(std::string("no finite numbers: ") + name + "."));
      }
      AtRest rest(pressed());
      rest.run.state.ledger.*entry = bad;
      CHECK_THROWS_WITH(advance_quasistatic(rest.run.scene, rest.run.rocks, 0.1, rest.run.state, rest.statics),
                        Catch::Contains(std::string("no finite numbers: ") + name + "."));
      CHECK_FALSE(std::isfinite(rest.run.state.ledger.closure()));
    }
  }
  Ledger ledger;
  ledger.body_work = std::numeric_limits<double>::quiet_NaN();
  ledger.note_scale();
  ledger.body_work = 1.0;  // nothing that comes later hides it
  ledger.note_scale();
  CHECK(std::isnan(ledger.largest));
  CHECK(std::isnan(ledger.closure()));
  CHECK_FALSE(ledger.finite());
}

// Requires strain, rotation and jumps to be the largest of all points, by hand: a stretch of 0.03 turned by 45 degrees
// with a rotation of 0.02; and net pressures those above the closing stress, at the start and later. Mutations that
// fail: a component for a principal strain, shear in it twice, the rotation of both signs summed, the bonded counted.
TEST_CASE("what is to be small is found, and what loads") {
  AtRest rest(pressed());
  State& state = rest.run.state;
  Monitors& m = state.monitors;
  watch_row(rest.run.scene, state);
  CHECK(m.net_at_start_Pa == Approx(0.5e6));
  CHECK(m.largest_net_Pa == Approx(0.5e6));
  state.step = 1;
  rest.run.scene.fluid.start_Pa = 9e6;  // looked at once
  state.fracture().points[1].P = 2.7e6;
  watch_row(rest.run.scene, state);
  CHECK(m.net_at_start_Pa == Approx(0.5e6));
  CHECK(m.largest_net_Pa == Approx(0.7e6));
  m.largest_strain = m.largest_rotation = m.largest_jump = 0.0;
  strain(state, 7, {0.015, 0.015 - 0.02, 0.015 + 0.02, 0.015});
  strain(state, 8, {0.0, 0.01, -0.01, 0.0});
  state.fracture().points[2].w = {0.03, -0.04};
  watch_deformation(state);
  CHECK(m.largest_strain == Approx(0.03));
  CHECK(m.largest_rotation == Approx(0.02));
  CHECK(m.largest_jump == Approx(0.05));
  CHECK(marks(rest.run) == Names{"largest_strain", "largest_rotation"});
}

// Requires J's spread to be taken at each growth, apart where an interface is near.
TEST_CASE("the spread of J is that at growth") {
  AtRest rest(pressed());
  State& state = rest.run.state;
  Tip& tip = state.tips.front();
  const auto grow_with = [&](double spread, bool at_interface) {
    tip.J_spread = spread, tip.near = at_interface ? Obstacle::interface : Obstacle::none;
    note_growth(state, tip);
  };
  grow_with(0.05, false);
  grow_with(0.11, false);
  grow_with(3.0, true);
  CHECK(state.monitors.growths == 2);
  CHECK(state.monitors.growths_apart == 1);
  CHECK(state.monitors.J_spread_sum == Approx(0.16));
  CHECK(state.monitors.largest_J_spread == 0.11);
  CHECK(marks(rest.run).empty());
  grow_with(0.2, false);
  CHECK(marks(rest.run) == Names{"J_spread_mean"});
}
