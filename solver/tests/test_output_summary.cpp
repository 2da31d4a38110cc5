#include <algorithm>
#include <array>
#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>
#include <string>
#include <vector>

#include "output/history.hpp"
#include "output/run_folder.hpp"
#include "output/summary.hpp"
#include "output/suspect.hpp"
#include "output/terminal.hpp"
#include "output_state.hpp"
#include "scene/derived.hpp"

using namespace strata;
using namespace strata::test;

namespace {

const RunRecord record{"exp1", "completed", "the tip reached 40 m", 4.0, 2, 1e6};

}  // namespace

TEST_CASE("the summary holds the keys of the contract with the values of the state") {
  const State state = made_state();
  const auto json = nlohmann::json::parse(summary_json(made_scene(), state, record));
  CHECK(json.at("scene") == "exp1");
  CHECK(json.at("variant") == "soft");
  CHECK(json.at("status") == "completed");
  CHECK(json.at("reason") == "the tip reached 40 m");
  CHECK(json.at("mechanics") == "explicit");
  CHECK(json.at("cells") == 72);
  CHECK(json.at("particles") == 13);
  CHECK(json.at("steps") == 123456789012);
  CHECK(json.at("time_s") == state.time);
  CHECK(json.at("inlet_Pa") == state.fluid.inlet_Pa);
  CHECK(json.at("wall_s") == 4.0);
  CHECK(json.at("particle_steps_per_s") == 250000.0);
  CHECK(json.at("peak_memory_MB").get<double>() > 1.0);
  CHECK(json.at("peak_memory_MB").get<double>() < 4000.0);
  CHECK(json.at("version") == version());
  CHECK(json.at("threads") == 2);
  CHECK(json.at("mouth_opening_m") == state.fracture().vertices[0].opening());
  CHECK(json.at("fracture_volume_m2").is_number());

  const auto& energy = json.at("energy");
  const Ledger& l = state.ledger;
  CHECK(energy.at("kinetic_J") == l.kinetic);
  CHECK(energy.at("strain_J") == l.strain);
  CHECK(energy.at("interface_strain_J") == l.interface_strain);
  CHECK(energy.at("fluid_work_J") == l.fluid_work);
  CHECK(energy.at("in_situ_work_J") == l.in_situ_work);
  CHECK(energy.at("edge_work_J") == l.edge_work);
  CHECK(energy.at("body_work_J") == l.body_work);
  CHECK(energy.at("initial_kinetic_J") == l.initial_kinetic);
  CHECK(energy.at("damping_J") == l.damping);
  CHECK(energy.at("transfer_J") == l.transfer);
  CHECK(energy.at("integration_J") == l.integration);
  CHECK(energy.at("friction_J") == l.friction);
  CHECK(energy.at("fracture_J") == l.fracture);
  CHECK(energy.at("closure") == l.closure());

  const Tip& tip = state.tips[0];
  REQUIRE(json.at("tips").size() == 1);
  const auto& t = json.at("tips")[0];
  CHECK(t.at("x_m") == 4.0);
  CHECK(t.at("y_m") == 2.0);
  CHECK(t.at("K_I_Pa_sqrt_m") == tip.K_I);
  CHECK(t.at("K_II_Pa_sqrt_m") == tip.K_II);
  CHECK(t.at("J_N_m") == tip.J);
  CHECK(t.at("J_spread") == tip.J_spread);
  CHECK(t.at("kink_deg").get<double>() == Approx(tip.kink * 180.0 / std::numbers::pi).epsilon(1e-14));
  CHECK(t.at("at_interface") == true);
  CHECK(t.at("near") == "rock border");
  CHECK(t.at("reason") == "");
  CHECK(t.at("growing") == false);
  CHECK(t.at("stopped_by") == "an interface");
  CHECK(t.at("ring_m") == tip.ring_m);
  CHECK(t.at("tip") == "");

  REQUIRE(json.at("events").size() == 2);
  const auto& e = json.at("events")[1];
  CHECK(e.at("kind") == "arrest");
  CHECK(e.at("time_s") == state.events[1].time_s);
  CHECK(e.at("inlet_Pa") == state.events[1].inlet_Pa);
  CHECK(e.at("tip_x_m") == state.events[1].tip_x_m);
  CHECK(e.at("tip_y_m") == state.events[1].tip_y_m);
  CHECK(e.at("at_interface") == true);
  CHECK(e.at("tip") == "lower");

  const auto& monitors = json.at("monitors");
  CHECK(monitors.at("largest_courant") == state.monitors.largest_courant);
  CHECK(monitors.at("largest_penetration_m") == state.monitors.largest_penetration);
  CHECK(monitors.at("contact_sweeps") == 77);
  CHECK(monitors.at("contact_unconverged") == 3);
  CHECK(monitors.at("largest_particle_velocity_m_s") == state.monitors.largest_particle_velocity);
  CHECK(monitors.at("growths") == 14);
  CHECK(monitors.at("growths_at_interfaces") == 5);
  CHECK(monitors.at("J_spread_mean").get<double>() == Approx(state.monitors.J_spread_sum / 14.0).epsilon(1e-14));
}

// Requires that what is no number of a tip is null, with the reason beside it: all of J and K where the rings cross
// something, each by its name; the kink of a closed tip, whose K_I and J are numbers; J below zero of an open tip
// without inertia, and no other. Mutation that fails: numbers kept where the rings cross something.
TEST_CASE("numbers of a tip that are none are null, with the reason") {
  State state = made_state();
  Scene scene = made_scene();
  Tip& tip = state.tips[0];
  const auto told = [&] { return nlohmann::json::parse(summary_json(scene, state, record)).at("tips")[0]; };
  const std::array keys{"K_I_Pa_sqrt_m", "K_II_Pa_sqrt_m", "J_N_m", "J_spread", "kink_deg"};
  tip.crossed = true;
  for (const auto& [what, name] : {std::pair{Obstacle::interface, "interface"}, std::pair{Obstacle::edge, "edge"},
                                   std::pair{Obstacle::rock_border, "rock"}, std::pair{Obstacle::fracture, "fracture"},
                                   std::pair{Obstacle::symmetry_line, "symmetry line"}}) {
    tip.near = what;
    for (const char* key : keys) CHECK(told().at(key).is_null());
    CHECK(told().at("reason").get<std::string>().find(name) != std::string::npos);
    CHECK(told().at("at_interface") == (what == Obstacle::interface || what == Obstacle::rock_border));
    CHECK(std::isnan(of(history_row(scene, state), "J_N_m")));
  }
  tip.closed = true, tip.J = tip.K_I = tip.K_II = 0.0;  // whatever the rings cross
  CHECK(told().at("K_I_Pa_sqrt_m") == 0.0);
  CHECK(told().at("J_N_m") == 0.0);
  CHECK(told().at("kink_deg").is_null());
  CHECK(told().at("reason").get<std::string>().find("closed") != std::string::npos);
  CHECK(std::isnan(of(history_row(scene, state), "kink_deg")));
  tip.closed = tip.crossed = false, tip.K_I = 1e6;
  for (const double J : {20.0, -20.0}) {
    for (const bool inertia : {false, true}) {
      scene.numerics.mechanics = inertia ? Numerics::Mechanics::explicit_dynamics : Numerics::Mechanics::quasistatic;
      tip.J = J;
      const bool none = J < 0.0 && !inertia;
      CHECK(told().at("J_N_m").is_null() == none);
      CHECK(told().at("J_spread").is_null() == none);
      CHECK(told().at("K_I_Pa_sqrt_m") == 1e6);
      CHECK(told().at("reason").get<std::string>().empty() != none);
    }
  }
}

TEST_CASE("what is not finite is null, and text that is no UTF-8 does not break the summary") {
  State state = made_state();
  state.tips[0].J = std::numeric_limits<double>::quiet_NaN();
  state.tips[0].K_I = std::numeric_limits<double>::infinity();
  state.ledger.strain = -std::numeric_limits<double>::infinity();
  RunRecord failed = record;
  failed.reason = "bad \xff byte";
  failed.wall_s = 0.0;
  const std::string text = summary_json(made_scene(), state, failed);
  CHECK(text.find("nan") == std::string::npos);
  const auto json = nlohmann::json::parse(text);
  CHECK(json.at("tips")[0].at("J_N_m").is_null());
  CHECK(json.at("tips")[0].at("K_I_Pa_sqrt_m").is_null());
  CHECK(json.at("energy").at("strain_J").is_null());
  CHECK(json.at("energy").at("closure").is_null());
  CHECK(json.at("particle_steps_per_s").is_null());
}

TEST_CASE("a summary without fracture has no tips") {
  State state = made_state();
  state.has_fracture = false;
  state.surfaces.erase(state.surfaces.begin());
  state.tips.clear();
  const auto json = nlohmann::json::parse(summary_json(made_scene(), state, record));
  CHECK(json.at("tips").empty());
  CHECK(json.at("tips").is_array());
  CHECK(json.at("inlet_Pa") == 0.0);
}

TEST_CASE("a file is written in one piece or not at all") {
  const TemporaryFolder folder;
  const auto file = folder.path / "summary.json";
  atomic_write(file, "old");
  atomic_write(file, summary_json(made_scene(), made_state(), record));
  CHECK(nlohmann::json::parse(content_of(file)).at("scene") == "exp1");
  const auto listing = std::filesystem::directory_iterator(folder.path);
  CHECK(std::distance(begin(listing), end(listing)) == 1);  // nothing is left beside it
  std::filesystem::create_directories(folder.path / "taken" / "inside");
  CHECK_THROWS_WITH(atomic_write(folder.path / "taken", "x"), Catch::Contains("taken: cannot be replaced"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "taken.tmp"));
  CHECK_THROWS_WITH(atomic_write(folder.path / "none" / "a.json", "x"),
                    Catch::Contains("a.json.tmp: cannot be written"));
}

TEST_CASE("progress is told in words that a reader knows") {
  State state = made_state();
  state.time = 0.25;
  state.fluid.inlet_Pa = 17.5e6;
  CHECK(progress_text(state, 0.4299, 250.0) == " 42 %  t = 0.25 s  P = 17.500 MPa  tip at 2.00 m  left 4 min 10 s");
  Numbers number{500};
  state.tips.push_back(made_tip(false, number));
  state.fracture().vertices.front().x.y() = -1.0;
  CHECK_THAT(progress_text(state, 0.4299, 250.0), Catch::Contains("MPa  tips at -1.00 and 2.00 m  left"));
  state.fracture().vertices.front().x = {7.0, 2.0};
  CHECK_THAT(progress_text(state, 0.4299, 250.0), Catch::Contains("MPa  tips at x = 4.00 and 7.00 m  left"));
  CHECK(duration_text(11900.0) == "3 h 18 min");
  CHECK(duration_text(12.4) == "12 s");
  CHECK(duration_text(std::numeric_limits<double>::quiet_NaN()) == "?");
  CHECK(duration_text(-1.0) == "?");
}

namespace {

const double nan_value = std::numeric_limits<double>::quiet_NaN();

// A run of which nothing is to be said: a ledger that closes, a step within its limit, particles in their cells.
State sound_state() {
  State state = made_state();
  std::fill(state.particles.u_x.begin(), state.particles.u_x.end(), 0.0);
  std::fill(state.particles.u_y.begin(), state.particles.u_y.end(), 0.0);
  std::fill(state.particles.V.begin(), state.particles.V.end(), 64.0 / 13.0);  // of the block
  state.ledger = Ledger{};
  state.ledger.fluid_work = state.ledger.strain = 100.0, state.ledger.largest = 1000.0;
  state.monitors = Monitors{};
  state.monitors.largest_courant = 0.5;
  state.monitors.largest_strain_J = 100.0, state.monitors.largest_momentum = 1e4;
  state.monitors.largest_contact_Pa = 1e6;
  state.monitors.growths = 10;
  for (Tip& tip : state.tips) tip.stopped_by.clear();
  return state;
}

Scene scene_of(Numerics::Mechanics mechanics, Fluid::Law law) {
  Scene scene = made_scene();
  scene.numerics.mechanics = mechanics;
  scene.fluid.law = law;
  scene.domain.sides = Edge::traction;  // so that momentum counts
  return scene;
}

std::vector<std::string> marks(const Scene& scene, const State& state) {
  std::vector<std::string> names;
  for (const Watched& mark : suspicions(scene, state)) names.push_back(mark.monitor);
  return names;
}

using Names = std::vector<std::string>;
constexpr auto inertia = Numerics::Mechanics::explicit_dynamics, rest = Numerics::Mechanics::quasistatic;

}  // namespace

TEST_CASE("rock so nearly incompressible that the shape's functions lock marks the run") {
  const auto [shape, below, above] =
      GENERATE(table<Numerics::Shape, double, double>({{Numerics::Shape::bspline2, 0.495, 0.496},
                                                       {Numerics::Shape::linear, 0.45, 0.451},
                                                       {Numerics::Shape::gimp, 0.45, 0.451}}));
  Scene scene = scene_of(inertia, Fluid::Law::uniform);
  scene.numerics.shape = shape;
  if (shape == Numerics::Shape::linear) scene.numerics.kinematics = Numerics::Kinematics::total;  // no cells to cross
  scene.rocks.front().poisson_ratio = below;
  CHECK(marks(scene, sound_state()).empty());
  scene.rocks.front().poisson_ratio = above;
  CHECK(marks(scene, sound_state()) == Names{"incompressibility"});
  scene.rocks.insert(scene.rocks.begin(), scene.rocks.front());  // whichever rock it is
  scene.rocks.front().poisson_ratio = 0.2;
  CHECK(marks(scene, sound_state()) == Names{"incompressibility"});
}

// Requires a tip that an edge holds to mark the run from 1.1 K_Ic on, whichever tip it is, and one that is free not to;
// where none may grow, only a run that has gone on since. Mutations that fail: time not looked at; never where none
// may.
TEST_CASE("a tip that is held with more than its toughness marks the run") {
  Scene scene = scene_of(rest, Fluid::Law::uniform);
  scene.strata.interfaces.clear();
  const double K_Ic = scene.rocks[scene.strata.layers[0].rock].toughness_Pa_sqrt_m = 2e6;
  for (Rock& rock : scene.rocks) rock.toughness_Pa_sqrt_m = K_Ic;
  State state = sound_state();
  state.tips.resize(2, state.tips.front());
  for (const std::size_t k : {std::size_t{0}, std::size_t{1}}) {
    for (Tip& tip : state.tips) {
      tip.stopped_by.clear(), tip.growing = true, tip.K_I = 20.0 * K_Ic;
      tip.last_growth_s = 0.0, tip.runs_until_s = -1.0;
    }
    CHECK(marks(scene, state).empty());
    state.tips[k].stopped_by = "within 3 cells of an edge of the block";
    state.tips[k].growing = false;
    CHECK(marks(scene, state) == Names{"held_tip"});
    state.tips[k].K_I = 1.09 * K_Ic;
    CHECK(marks(scene, state).empty());
    state.tips[k].K_I = 1.11 * K_Ic;
    CHECK(marks(scene, state) == Names{"held_tip"});
    for (Tip& tip : state.tips) tip.growing = false;  // the run has gone on since the last growth
    CHECK(marks(scene, state) == Names{"held_tip"});
    state.tips[k].last_growth_s = state.time;
    CHECK(marks(scene, state).empty());
    state.tips[k].last_growth_s = 0.0, state.tips[k].runs_until_s = state.time;  // with inertia K still answers to it
    CHECK(marks(scene, state).empty());
  }
}

TEST_CASE("bonded rocks of stiffnesses too far apart mark the run") {
  Scene scene = scene_of(inertia, Fluid::Law::uniform);
  const double factor = GENERATE(30.5, 1.0 / 30.5);
  scene.laws.resize(1);
  scene.laws[0].kind = InterfaceLaw::Kind::perfect;
  scene.rocks.front().youngs_modulus_Pa = 10e9;
  scene.rocks = {scene.rocks.front(), scene.rocks.front()};
  scene.strata.layers = {{0, 0.0, 1.0}, {1, 1.0, 2.0}};
  scene.strata.interfaces = {{0, 1.0}};
  CHECK(marks(scene, sound_state()).empty());
  scene.rocks[1].youngs_modulus_Pa *= factor;
  CHECK(marks(scene, sound_state()) == Names{"stiffness_contrast"});
  scene.strata.layers.push_back({1, 2.0, 3.0});  // whichever border it is
  scene.strata.interfaces.push_back({0, 2.0});
  CHECK(marks(scene, sound_state()) == Names{"stiffness_contrast"});
  scene.laws.push_back(InterfaceLaw{"cut", InterfaceLaw::Kind::friction});
  scene.strata.interfaces[0].law = 1;  // not bonded: the strain may jump there
  CHECK(marks(scene, sound_state()).empty());
  scene.strata.interfaces[0].law = 0;
  scene.numerics.shape = Numerics::Shape::linear;
  scene.numerics.kinematics = Numerics::Kinematics::total;  // no cells to cross
  CHECK(marks(scene, sound_state()).empty());
}

TEST_CASE("each monitor marks the run beyond its threshold and not below") {
  struct Case {
    const char* monitor;
    Numerics::Mechanics mechanics;
    double Monitors::*member;
    double below, above;  // thresholds are positive; a few have the scale of sound_state()
  };
  const auto c = GENERATE(values<Case>({{"energy_closure", inertia, &Monitors::largest_open_J, 9.9, 10.1},
                                        {"energy_closure", rest, &Monitors::largest_open_J, 9.9, 10.1},
                                        {"energy_made", inertia, &Monitors::largest_made_J, 9.9, 10.1},
                                        {"kinetic_share", inertia, &Monitors::largest_kinetic_J, 99.0, 101.0},
                                        {"largest_courant", inertia, &Monitors::largest_courant, 1.70, 1.72},
                                        {"momentum", inertia, &Monitors::largest_drift, 0.9e-4, 1.1e-4},
                                        {"contact_residual", rest, &Monitors::contact_residual, 0.9e-8, 1.1e-8},
                                        {"force_balance", rest, &Monitors::force_balance, 0.9e-6, 1.1e-6},
                                        {"fluid_imbalance", rest, &Monitors::largest_imbalance, 0.9e-8, 1.1e-8},
                                        {"fluid_imbalance", rest, &Monitors::volume_balance, -0.9e-8, -1.1e-8},
                                        {"floor_share", rest, &Monitors::floor_share_sum, 0.99, 1.01},
                                        {"viscous_tip", rest, &Monitors::viscous_at_growth, 0.299, 0.301},
                                        {"J_spread_mean", rest, &Monitors::J_spread_sum, 0.99, 1.01},
                                        {"J_spread_mean", inertia, &Monitors::J_spread_sum, 0.99, 1.01},
                                        {"tension_share", rest, &Monitors::largest_tension_Pa, 0.9e-3, 1.1e-3},
                                        {"largest_strain", rest, &Monitors::largest_strain, 0.0099, 0.0101},
                                        {"largest_strain", inertia, &Monitors::largest_strain, 0.099, 0.101},
                                        {"largest_rotation", rest, &Monitors::largest_rotation, 0.0099, 0.0101},
                                        {"largest_rotation", inertia, &Monitors::largest_rotation, 0.0099, 0.0101},
                                        {"jump_share", rest, &Monitors::largest_jump, 0.49, 0.51},
                                        {"contact_left", inertia, &Monitors::contact_left, 0.009, 0.011}}));
  CAPTURE(c.monitor, c.below, c.above);
  const Scene scene = scene_of(c.mechanics, Fluid::Law::reynolds);
  State state = sound_state();
  CHECK(marks(scene, state).empty());
  state.monitors.*c.member = c.below;
  CHECK(marks(scene, state).empty());
  state.monitors.*c.member = c.above;
  CHECK(marks(scene, state) == Names{c.monitor});
  const auto json = nlohmann::json::parse(summary_json(scene, state, record));
  REQUIRE(json.at("suspect").size() == 1);
  const auto& mark = json.at("suspect")[0];
  CHECK(mark.at("monitor") == c.monitor);
  CHECK(mark.at("value").get<double>() > mark.at("threshold").get<double>());
  CHECK(mark.at("value") == json.at("monitors").at(c.monitor));
  CHECK(mark.at("why").get<std::string>().size() > 20);
  state.monitors.*c.member = nan_value;  // no comparison hides it
  CHECK(marks(scene, state) == Names{c.monitor});
  CHECK(suspicions(scene, state)[0].why == std::string(c.monitor) + " is not a finite number");
  CHECK(nlohmann::json::parse(summary_json(scene, state, record)).at("suspect")[0].at("value").is_null());
}

TEST_CASE("a ledger that is no number marks the run even if no row has seen it") {
  State state = sound_state();
  state.ledger.strain = nan_value;
  CHECK(marks(scene_of(rest, Fluid::Law::uniform), state) == Names{"energy_closure"});
  state.ledger.strain = 100.0 + 10.1;  // open by that at the end alone
  CHECK(marks(scene_of(inertia, Fluid::Law::uniform), state) == Names{"energy_closure"});
}

TEST_CASE("faces that overlap mark the run by what a cell deforms under their pressure") {
  State state = sound_state();
  const Scene scene = scene_of(inertia, Fluid::Law::uniform);
  const double cell = 1e6 * state.grid.h * (1.0 - 0.25 * 0.25) / 40e9;  // m, of the stiffer rock
  state.monitors.largest_penetration = 0.0099 * cell;
  CHECK(marks(scene, state).empty());
  state.monitors.largest_penetration = 0.0101 * cell;
  CHECK(marks(scene, state) == Names{"penetration_share"});
  state.monitors = Monitors{};
  state.monitors.largest_penetration = 1e-9;  // with nothing that presses
  CHECK(marks(scene, state) == Names{"penetration_share"});
}

// Requires a run in which nothing happens but round-off, 1e-13 of the scene's stresses, to be marked by no share of
// that round-off, and a ten-thousandth of the stresses to be. By hand: stresses of 16 MPa in an 8 m x 8 m block of
// which the softer rock has E' = 8e9/0.99 Pa and c_S = 1257 m/s. Mutations that fail: any of the floors left out, or as
// an absolute number that does not go with the stresses.
TEST_CASE("shares of round-off mark nothing") {
  Scene scene = scene_of(inertia, Fluid::Law::uniform);
  State state = sound_state();
  const double scale = GENERATE(1.0, 1e-3);
  scene.fluid.start_Pa *= scale, state.fluid.inlet_Pa *= scale;
  const double s = 16e6 * scale, energy = 0.5 * s * s * 64.0 * 0.99 / 8e9, momentum = s * 64.0 / 1257.0;
  const auto fill = [&](double share) {
    state.ledger = Ledger{};
    state.monitors = Monitors{};
    state.ledger.largest = state.monitors.largest_open_J = state.monitors.largest_made_J = share * energy;
    state.monitors.largest_kinetic_J = share * share * energy;
    state.monitors.largest_drift = state.monitors.largest_momentum = share * momentum;
    state.monitors.largest_tension_Pa = share * s;
    state.monitors.largest_penetration = share * s * state.grid.h / 42e9;
    state.monitors.largest_contact_Pa = 0.1 * share * s;
  };
  fill(1e-13);
  CHECK(marks(scene, state) == Names{});
  fill(1e-4);
  CHECK(marks(scene, state) ==
        Names{"energy_closure", "energy_made", "kinetic_share", "momentum", "penetration_share", "tension_share"});
}

// Requires loads that do not come slowly to be marked: 0.4 MPa/s and a wave's 8 m at c_S = 1257 m/s of the softer rock
// are 2.546 kPa, and damping of pi^2 c_S/L doubles them; a pressure above the closing stress at time 0, until damping
// has brought it below a tenth: 1 MPa of 2 by exp(-d t/2) at d = 40 1/s after 0.0805 s, at the first growth or the end.
// Mutations that fail: the stiffer rock's wave, c_P, damping left out or growing with itself for ever.
TEST_CASE("loads faster than waves or at once mark an explicit run") {
  Scene scene = scene_of(inertia, Fluid::Law::uniform);
  State state = sound_state();
  state.time = 10.0, state.events.clear();
  state.monitors.largest_net_Pa = 25.5e3;
  CHECK(marks(scene, state) == Names{});
  state.monitors.largest_net_Pa = 25.4e3;
  CHECK(marks(scene, state) == Names{"loading_share"});
  scene.numerics.damping_1_s = 9.8696 * 1257.0 / 8.0;
  state.monitors.largest_net_Pa = 51.1e3;
  CHECK(marks(scene, state) == Names{});
  state.monitors.largest_net_Pa = 50.7e3;
  CHECK(marks(scene, state) == Names{"loading_share"});
  scene.numerics.mechanics = rest;
  CHECK(marks(scene, state) == Names{});
  scene = scene_of(inertia, Fluid::Law::uniform);
  state.monitors.largest_net_Pa = 2e6, state.monitors.net_at_start_Pa = 1e6;
  CHECK(marks(scene, state) == Names{"shock_share"});
  scene.numerics.damping_1_s = 40.0;
  CHECK(marks(scene, state) == Names{});
  state.time = 0.080;
  CHECK(marks(scene, state) == Names{"shock_share"});
  state.time = 0.081;
  CHECK(marks(scene, state) == Names{});
  state.time = 10.0, state.events = {{"start", 0.080, 1e6, 4.0, 2.0, false, "J"}};
  CHECK(marks(scene, state) == Names{"shock_share"});
  scene.fracture->growth = Fracture::Growth::none, state.events.clear();
  scene.numerics.damping_1_s = 0.0, state.time = 0.0127;  // before waves are back from the edges: about them
  CHECK(marks(scene, state) == Names{});
  state.time = 0.0128;
  CHECK(marks(scene, state) == Names{"shock_share"});
}

// Requires values of another unit to mark the run by their keys, and those of rock not to.
TEST_CASE("values that no rock has mark the run") {
  struct Typed {
    const char* key;
    void (*type)(Scene&);
  };
  const auto c = GENERATE(values<Typed>({
      {"rock.stiff.youngs_modulus_Pa = 40", [](Scene& s) { s.rocks[0].youngs_modulus_Pa = 40.0; }},
      {"rock.soft.youngs_modulus_Pa = 8e+18", [](Scene& s) { s.rocks[1].youngs_modulus_Pa = 8e18; }},
      {"rock.soft.density_kg_m3 = 2.3", [](Scene& s) { s.rocks[1].density_kg_m3 = 2.3; }},
      {"rock.stiff.toughness_Pa_sqrt_m = 1.45", [](Scene& s) { s.rocks[0].toughness_Pa_sqrt_m = 1.45; }},
      {"in_situ.vertical_Pa = -3", [](Scene& s) { s.in_situ.vertical_Pa = -3.0; }},
      {"in_situ.horizontal_Pa = 2", [](Scene& s) { s.in_situ.horizontal_Pa = 2.0; }},
      {"strata.layers[0].horizontal_Pa = 30", [](Scene& s) { s.strata.layers[0].horizontal_Pa = 30.0; }},
      {"fluid.inlet.start_Pa = 16", [](Scene& s) { s.fluid.start_Pa = 16.0; }},
      {"stop.inlet_Pa = 18", [](Scene& s) { s.stop.inlet_Pa = 18.0; }},
      {"fluid.bulk_modulus_Pa = 2.2", [](Scene& s) { s.fluid.bulk_modulus_Pa = 2.2; }},
      {"fluid.viscosity_Pa_s = 1e-07", [](Scene& s) { s.fluid.viscosity_Pa_s = 1e-7; }},
  }));
  Scene scene = scene_of(rest, Fluid::Law::reynolds);
  scene.strata.interfaces.clear();  // no contrast
  CHECK(marks(scene, sound_state()) == Names{});
  c.type(scene);
  const std::vector<Watched> found = suspicions(scene, sound_state());
  REQUIRE(found.size() == 1);
  CHECK(std::pair(found[0].monitor, found[0].value) == std::pair(std::string("implausible_inputs"), 1.0));
  CHECK_THAT(found[0].why, Catch::StartsWith(std::string(c.key) + " is "));
  CHECK_THAT(announce(scene), Catch::Contains("; implausible: " + std::string(c.key) + " is "));
  scene = scene_of(rest, Fluid::Law::uniform);
  scene.rocks[0].toughness_Pa_sqrt_m = scene.fluid.start_Pa = 0.0, scene.fluid.bulk_modulus_Pa = 1.0;
  CHECK(marks(scene, sound_state()) == Names{});  // none, and what the law does not use
}

TEST_CASE("what does not apply to a run is not said of it") {
  State state = sound_state();
  state.monitors.largest_drift = 1.0;
  Scene scene = scene_of(inertia, Fluid::Law::uniform);
  scene.domain.sides = Edge::fixed;  // the bottom holds the other axis
  CHECK(marks(scene, state).empty());
  state = sound_state();
  state.monitors.largest_kinetic_J = 1e3;
  scene.initial.velocity_m_s = Formulas{"1", "0"};
  CHECK(marks(scene, state).empty());  // a scene that throws its block
  state = sound_state();
  scene.fluid.law = Fluid::Law::paper, state.monitors.delivered_m2 = 0.25 * fracture_volume(state);
  const auto json = nlohmann::json::parse(summary_json(scene, state, record));
  CHECK(json.at("suspect") == nlohmann::json::array());
  CHECK_FALSE(json.at("monitors").contains("momentum"));
}
