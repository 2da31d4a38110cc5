#include "output/terminal.hpp"

#include <catch2/catch.hpp>
#include <fstream>
#include <sstream>

#include "output/fields.hpp"
#include "output/recorder.hpp"
#include "output_state.hpp"
#include "scene_text.hpp"

using namespace strata;
using namespace strata::test;

namespace {

std::vector<std::string> lines_of(const Scene& scene, const State& state, const RunRecord& record,
                                  const std::filesystem::path& folder) {
  std::istringstream text(closing_lines(scene, state, record, folder));
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) lines.push_back(line);
  return lines;
}

const RunRecord record{"exp1", "completed", "tip reached y = 40 m", 65.0, 2, 1e6};

// A state that no monitor marks.
State sound_state() {
  State state = made_state();
  state.monitors = {};
  state.ledger = {};
  state.ledger.largest = state.monitors.largest_strain_J = 1.0;  // J/m, so that shares of them are 0
  return state;
}

}  // namespace

TEST_CASE("a run ends with how, growth, tip, worst monitor and where") {
  const TemporaryFolder folder;
  for (const char* file : {"summary.json", "result.h5"}) std::ofstream(folder.path / file) << "x";
  State state = sound_state();
  state.step = 413, state.time = 1.25;
  state.fluid.inlet_Pa = 2.468e6;
  state.events = {{"start", 0.5, 2.1e6, 4.0, 1.0, false, "J"},
                  {"reach_interface", 0.6, 2.2e6, 4.0, 2.0, false, "J"},
                  {"arrest", 0.6, 2.25e6, 4.0, 2.0, true, "J"},
                  {"restart", 0.7, 3.5e6, 4.0, 2.0, true, "energy"}};
  Tip& tip = state.tips[0];
  tip.K_I = 1.45e6, tip.K_II = -1e-11, tip.J = 205.25;
  tip.near = Obstacle::none, tip.crossed = tip.closed = false;
  tip.stopped_by.clear();
  state.monitors.largest_courant = 0.9;
  const auto lines = lines_of(made_scene(), state, record, folder.path);
  REQUIRE(lines.size() == 5);
  CHECK(lines[0] == "completed at step 413, t = 1.25 s, after 1 min 05 s: tip reached y = 40 m");
  CHECK(lines[1] ==
        "growth: start 2.1 MPa at y = 1.00 m; arrest 2.25 MPa at y = 2.00 m; restart 3.5 MPa at y = 2.00 m");
  CHECK(lines[2] == "tip: x = 4.00 m, y = 2.00 m, K_I 1.450 and K_II 0.000 MPa sqrt(m), J 205.2 N/m; inlet 2.468 MPa");
  tip.stopped_by = "within 3 cells of an edge of the block";
  CHECK_THAT(
      lines_of(made_scene(), state, record, folder.path).at(2),
      Catch::EndsWith("J 205.2 N/m (may not grow: it is within 3 cells of an edge of the block); inlet 2.468 MPa"));
  CHECK(lines[3] == "monitors: none suspect");
  CHECK(lines[4] == "results in " + folder.path.string() + ": summary.json, result.h5");
}

// Requires the last lines to say which tip of two each event and each number belongs to, by the axis on which they lie
// apart. Mutation that fails: names left out.
TEST_CASE("the last lines tell two tips apart") {
  const TemporaryFolder folder;
  State state = sound_state();
  state.tips.resize(2, state.tips[0]);
  for (Tip& tip : state.tips) tip.near = Obstacle::none, tip.crossed = tip.closed = false, tip.stopped_by.clear();
  state.tips[1].at_back = false;
  state.tips[0].K_I = 1.25e6, state.tips[1].K_I = 1.5e6;
  state.events = {{"start", 0.5, 2.1e6, 4.0, 0.0, false, "J", "lower"},
                  {"arrest", 0.6, 2.25e6, 3.0, 2.0, true, "J", "right"}};
  const auto lines = lines_of(made_scene(), state, record, folder.path);
  CHECK(lines.at(1) == "growth: lower tip start 2.1 MPa at y = 0.00 m; right tip arrest 2.25 MPa at x = 3.00 m");
  CHECK_THAT(lines.at(2), Catch::StartsWith("tips: upper tip x = 4.00 m, y = 2.00 m, K_I 1.250 and ") &&
                              Catch::Contains("; and lower tip x = 4.00 m, y = 0.00 m, K_I 1.500 and "));
}

TEST_CASE("all monitors that mark a run are named in its last lines, with value, threshold and reason") {
  const TemporaryFolder folder;
  State state = sound_state();
  state.monitors.largest_courant = 2.0;
  state.monitors.largest_kinetic_J = 3.0, state.monitors.largest_strain_J = 2.0;
  const auto lines = lines_of(made_scene(), state, record, folder.path);
  CHECK_THAT(lines.at(3), Catch::StartsWith("SUSPECT: kinetic_share = 1.5, above 1: the largest kinetic energy") &&
                              Catch::Contains("; largest_courant = 2, above 1.71: no block"));
}

TEST_CASE("what a run does not have is left out of its last lines or said to be none") {
  const TemporaryFolder folder;
  State state = sound_state();
  state.events.clear();
  state.tips[0].near = Obstacle::interface, state.tips[0].crossed = true, state.tips[0].closed = false;
  const auto still = lines_of(made_scene(), state, record, folder.path);
  CHECK(still.at(1) == "growth: none");
  CHECK_THAT(still.at(2), Catch::Contains("K_I none and K_II none MPa sqrt(m), J none N/m (the rings on which J and K "
                                          "are measured cross an interface"));
  for (int k = 0; k < 9; ++k) state.events.push_back({"restart", 0.1, 1e6, 4.0, 2.0, false, "J"});
  CHECK_THAT(lines_of(made_scene(), state, record, folder.path).at(1), Catch::EndsWith("; 3 more in summary.json"));
  const State none;
  state.has_fracture = false;
  const auto block = lines_of(made_scene(), state, record, folder.path);
  REQUIRE(block.size() == 3);
  CHECK_THAT(block[1], Catch::StartsWith("monitors: none suspect"));
  CHECK(lines_of(made_scene(), none, record, folder.path).size() == 2);
}

TEST_CASE("a folder's scene that is not the run's is refused with the keys that differ and what to type") {
  const TemporaryFolder path;
  const RunFolder folder{path.path};
  const Scene scene = scene_test::good(scene_test::layered);
  CHECK_NOTHROW(require_unchanged_scene(folder, scene));  // there is no result yet
  {
    Recorder recorder(folder);
    CHECK_NOTHROW(require_unchanged_scene(folder, scene));  // and nothing in it
    Scene of_state = made_scene();
    of_state.resolved_toml = scene.resolved_toml;
    recorder.output(of_state, made_state());
  }
  CHECK(made_with(folder).version == version());
  CHECK_NOTHROW(require_unchanged_scene(folder, scene));
  CHECK_NOTHROW(require_unchanged_scene(folder, scene_test::good("# a comment\n" + scene_test::layered)));
  const auto refused = [&](const std::string& what, const std::string& by) {
    const Scene changed = scene_test::good(scene_test::with(scene_test::layered, what, by));
    try {
      require_unchanged_scene(folder, changed);
    } catch (const OutputFailure& failure) {
      return std::string(failure.what());
    }
    return std::string("not refused");
  };
  CHECK_THAT(refused("inlet_Pa = 4e6", "inlet_Pa = 5e6"),
             Catch::Contains("was changed after the run began: it says stop.inlet_Pa = 5000000.0; the run has "
                             "stop.inlet_Pa = 4000000.0.") &&
                 Catch::Contains("scene.toml --out DIR`") && Catch::Contains("--replace`"));
  CHECK_THAT(refused("inlet_Pa = 4e6", "inlet_Pa = 4e6\ntime_s = 9"),
             Catch::Contains("began: it says stop.time_s = 9.0; the run has nothing."));
  CHECK_THAT(
      refused("coefficient = 0.4", "coefficient = 0.5"),
      Catch::Contains("it says interface.joint.coefficient = 0.5; the run has interface.joint.coefficient = 0.4."));
  CHECK_THAT(refused("thickness_m = 10", "thickness_m = 20"), Catch::Contains("thickness_m = 20"));
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
  scene.stop = {.tip_y_m = {}, .lower_tip_y_m = {}, .inlet_Pa = {}, .time_s = 0.0};
  CHECK(fraction_done(scene, state) == 1.0);
  scene.stop = {.tip_y_m = {}, .lower_tip_y_m = -2.0, .inlet_Pa = {}, .time_s = {}};  // from 0
  state.tips.push_back(state.tips[0]);
  state.tips[1].at_back = false;
  state.fracture().vertices[0].x.y() = -0.5;
  CHECK(fraction_done(scene, state) == Approx(0.25));
}
