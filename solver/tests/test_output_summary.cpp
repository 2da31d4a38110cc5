#include <catch2/catch.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <numbers>

#include "output/progress.hpp"
#include "output/run_folder.hpp"
#include "output/summary.hpp"
#include "output_state.hpp"

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
  CHECK(t.at("growing") == false);
  CHECK(t.at("stopped_by") == "an interface");
  CHECK(t.at("ring_m") == tip.ring_m);

  REQUIRE(json.at("events").size() == 2);
  const auto& e = json.at("events")[1];
  CHECK(e.at("kind") == "arrest");
  CHECK(e.at("time_s") == state.events[1].time_s);
  CHECK(e.at("inlet_Pa") == state.events[1].inlet_Pa);
  CHECK(e.at("tip_x_m") == state.events[1].tip_x_m);
  CHECK(e.at("tip_y_m") == state.events[1].tip_y_m);
  CHECK(e.at("at_interface") == true);

  const auto& monitors = json.at("monitors");
  CHECK(monitors.at("largest_courant") == state.monitors.largest_courant);
  CHECK(monitors.at("largest_penetration_m") == state.monitors.largest_penetration);
  CHECK(monitors.at("contact_sweeps") == 77);
  CHECK(monitors.at("contact_unconverged") == 3);
  CHECK(monitors.at("largest_particle_velocity_m_s") == state.monitors.largest_particle_velocity);
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
  write_summary(file, made_scene(), made_state(), record);
  CHECK(nlohmann::json::parse(content_of(file)).at("scene") == "exp1");
  const auto listing = std::filesystem::directory_iterator(folder.path);
  CHECK(std::distance(begin(listing), end(listing)) == 1);  // nothing is left beside it
  std::filesystem::create_directories(folder.path / "taken" / "inside");
  CHECK_THROWS_WITH(atomic_write(folder.path / "taken", "x"), Catch::Contains("taken: cannot be replaced"));
  CHECK_FALSE(std::filesystem::exists(folder.path / "taken.tmp"));
  CHECK_THROWS_WITH(atomic_write(folder.path / "none" / "a.json", "x"),
                    Catch::Contains("a.json.tmp: cannot be written"));
}

TEST_CASE("a run's folder is freed of an earlier run's files and of nothing else") {
  const TemporaryFolder temporary;
  const auto path = temporary.path / "runs" / "exp1";
  const RunFolder folder = create_run_folder(path);
  for (const auto& file : {folder.scene(), folder.summary(), folder.history(), folder.result(), folder.xdmf(),
                           folder.checkpoint(), path / "notes.txt"}) {
    atomic_write(file, "text");
  }
  create_run_folder(path);
  const auto listing = std::filesystem::directory_iterator(path);
  CHECK(std::distance(begin(listing), end(listing)) == 1);
  CHECK(content_of(path / "notes.txt") == "text");
  CHECK_THROWS_WITH(create_run_folder(path / "notes.txt" / "a"), Catch::Contains("cannot be made"));
  CHECK_THROWS_WITH(create_run_folder(path / "notes.txt"), Catch::Contains("notes.txt"));
}

TEST_CASE("the fraction done is that of the stop nearest by") {
  Scene scene = made_scene();
  State state = made_state();
  state.time = 2.5;
  state.fluid.inlet_Pa = 17e6;
  CHECK(fraction_done(scene, state) == Approx(0.25));
  scene.stop.inlet_Pa = 18e6;  // from 16
  CHECK(fraction_done(scene, state) == Approx(0.5));
  scene.stop.tip_y_m = 2.5;  // from 2
  CHECK(fraction_done(scene, state) == Approx(0.5));
  state.fracture().vertices[2].x.y() = 2.4;
  CHECK(fraction_done(scene, state) == Approx(0.8));
  state.time = 11.0;
  CHECK(fraction_done(scene, state) == 1.0);
  scene.stop = {.tip_y_m = {}, .inlet_Pa = {}, .time_s = 0.0};
  CHECK(fraction_done(scene, state) == 1.0);
}

TEST_CASE("progress is told in words that a reader knows") {
  State state = made_state();
  state.time = 0.25;
  state.fluid.inlet_Pa = 17.5e6;
  CHECK(progress_text(state, 0.4299, 250.0) == " 42 %  t = 0.25 s  P = 17.500 MPa  tip at 2.00 m  left 4 min 10 s");
  CHECK(duration_text(11900.0) == "3 h 18 min");
  CHECK(duration_text(12.4) == "12 s");
  CHECK(duration_text(std::numeric_limits<double>::quiet_NaN()) == "?");
  CHECK(duration_text(-1.0) == "?");
}
