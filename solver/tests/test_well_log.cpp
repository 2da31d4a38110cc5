// A well log becomes the scene that it describes, or all that is wrong with it is said at once.
#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <cmath>

#include "scene/keys.hpp"
#include "scene/toml_reader.hpp"
#include "scene/well_log.hpp"

using namespace strata;

namespace {

const std::string header = "top_m,rock,youngs_modulus_Pa,poisson_ratio,toughness_Pa_sqrt_m,horizontal_Pa,interface\n";

// Three layers of 6, 2 and 4 m between depths of 100 and 112 m.
const std::string three = header +
                          "# depths below ground\r\n"
                          "100, shale, 18e9, 0.28, 1.4e6, 3.0e6,\r\n"
                          "106, sand, 30e9, 0.2, 1.2e6, 2.0e6, perfect\r\n"
                          "\r\n"
                          "108, shale, , , , 2.5e6, soft\r\n"
                          "112,,,,,,\r\n";

Scene scene_of(const std::string& csv) {
  const Found log = scene_of_log(csv, "well.csv");
  CAPTURE(csv, log.lines);
  REQUIRE(log.errors.empty());
  ReadResult read = read_scene_text(log.lines[0], "well.toml", "", {});
  CAPTURE(read.errors);
  REQUIRE(read.scene);
  return *read.scene;
}

std::vector<std::string> errors_of(const std::string& csv) {
  const Found log = scene_of_log(csv, "well.csv");
  CHECK(log.lines.empty());
  return log.errors;
}

// Layers of such thicknesses below 1000 m.
std::string layers(const std::vector<double>& thicknesses) {
  std::string text = header;
  double depth = 1000.0;
  for (const double thickness : thicknesses) {
    text += fmt::format("{},,20e9,0.2,1e6,2e6,\n", depth);
    depth += thickness;
  }
  return fmt::format("{}{}\n", text, depth);
}

}  // namespace

TEST_CASE("A log is stacked upwards, with equal rocks once and a fracture in the layer of least stress") {
  const Scene scene = scene_of(three);
  REQUIRE(scene.strata.layers.size() == 3);
  const double to_m[] = {4.0, 6.0, 12.0}, stress[] = {2.5e6, 2.0e6, 3.0e6}, modulus[] = {18e9, 30e9, 18e9};
  for (std::size_t k = 0; k < 3; ++k) {
    const Layer& layer = scene.strata.layers[k];
    CHECK(layer.to_m == to_m[k]);
    CHECK(layer.horizontal_Pa->number == stress[k]);
    CHECK(scene.rocks[layer.rock].youngs_modulus_Pa == modulus[k]);
  }
  CHECK(scene.rocks.size() == 2);
  CHECK(scene.laws[scene.strata.interfaces[0].law].kind == InterfaceLaw::Kind::soft);
  CHECK(scene.laws[scene.strata.interfaces[1].law].kind == InterfaceLaw::Kind::perfect);
  CHECK(scene.domain.height_m == 12.0);
  CHECK(scene.numerics.cell_m == 0.5);  // a quarter of the thinnest layer
  CHECK(scene.fracture->path_m.front()[1] == 4.5);
  CHECK(scene.fracture->path_m.back()[1] == 5.5);
  CHECK(scene.fluid.start_Pa == 2.0e6);
  CHECK(scene.in_situ.vertical_Pa.number == 25e3 * 106.0);
  CHECK((scene.stop.tip_y_m == 9.5 && scene.stop.lower_tip_y_m == 2.5));  // 5 cells from either end
  CHECK(*scene.stop.inlet_Pa == Approx(1.01 * 3.0e6 + 1.4e6 / std::sqrt(3.14159265 * 0.5)).epsilon(1e-4));
}

TEST_CASE("A rock that changes keeps its name with a number, and takes what it leaves out from the one above") {
  const Scene scene = scene_of(header +
                               "0,shale,18e9,0.28,1.4e6,2e6,\n4,shale,20e9,,,2e6,\n8,shale,18e9,,,2e6,\n"
                               "12,,18e9,0.28,1.4e6,2e6,\n16\n");
  REQUIRE(scene.rocks.size() == 3);
  const auto name = [&](std::size_t layer) { return scene.rocks[scene.strata.layers[layer].rock].name; };
  CHECK((name(3) == "shale" && name(2) == "shale_2" && name(1) == "shale" && name(0) == "rock"));
  CHECK(scene.rocks[scene.strata.layers[2].rock].poisson_ratio == 0.28);
}

TEST_CASE("Cells divide every layer, the thinnest into four at least") {
  CHECK(scene_of(layers({3.0, 4.5, 10.5})).numerics.cell_m == 0.75);
  CHECK(scene_of(layers({20.0, 30.0})).numerics.cell_m == 5.0);
  CHECK(scene_of(layers({0.1524, 0.3048, 1.524})).numerics.cell_m == Approx(0.0381).epsilon(1e-12));
  CHECK(scene_of(layers({7.0})).numerics.cell_m == 1.75);
  CHECK(
      errors_of(layers({3.01, 4.52, 10.5})) ==
      std::vector<std::string>{"well.csv:1:1: top_m: cells that divide all layers have 0.01 m, and the thinnest layer "
                               "3.01 m. Round depths to 0.1 m."});
}

TEST_CASE("A log with leak-off is fed by a law that conserves the fluid") {
  std::string csv = layers({6.0, 4.0});
  csv = "leakoff_m_sqrt_s," + csv;
  for (std::size_t at = csv.find("\n1"); at != csv.npos; at = csv.find("\n1", at + 2)) csv.insert(at + 1, "2e-5,");
  csv.replace(csv.rfind("2e-5,"), 4, "");  // the bottom
  const Scene scene = scene_of(csv);
  CHECK((scene.rocks.size() == 1 && scene.rocks[0].leakoff_m_sqrt_s == 2e-5));
  CHECK((scene.fluid.law == Fluid::Law::reynolds && scene.stop.time_s && !scene.stop.inlet_Pa));
}

TEST_CASE("Of layers of one stress the thickest has the fracture") {
  const auto path = scene_of(layers({8.0, 4.0, 12.0, 4.0})).fracture->path_m;  // from the bottom 4 to 16 m
  CHECK((path.front()[1] == 7.0 && path.back()[1] == 13.0));
}

// Requires that a run ends before a tip is held at an end of the log, but for a tip that begins within 5 cells of it.
// Mutations that fail: stops at the ends themselves, both left out where one tip begins there.
TEST_CASE("A log's run ends 5 cells before the log does") {
  const std::string below = header + "0,a,20e9,0.2,1e6,3e6,\n8,b,20e9,0.2,1e6,2e6,\n12\n",
                    above = header + "0,a,20e9,0.2,1e6,2e6,\n4,b,20e9,0.2,1e6,3e6,\n12\n";
  const Stop bottom = scene_of(below).stop, top = scene_of(above).stop, both = scene_of(layers({8.0, 8.0, 8.0})).stop;
  CHECK((bottom.tip_y_m == 7.0 && !bottom.lower_tip_y_m));  // from 1 to 3 m, in cells of 1 m
  CHECK((!top.tip_y_m && top.lower_tip_y_m == 5.0));
  CHECK((both.tip_y_m == 14.0 && !both.lower_tip_y_m));
}

TEST_CASE("All mistakes of a log are said in one pass, each with its place") {
  const auto said = errors_of(
      "top_m,rok,rock,youngs_modulus_Pa,poisson_ratio,horizontal_Pa,interface\n"
      "-5,,sa nd,30 GPa,0.5,2e6,soft\n"
      "# comment\n"
      "10,,shale,18e9,0.2,,wek\n"
      "8,,,0,1e999,nan,,7\n"
      "12,,,,,2e6\n"
      "#13\n");
  // NOLINTBEGIN(bugprone-suspicious-missing-comma): long messages go over lines
  const std::vector<std::string> wanted = {
      "well.csv:1:1: the column toughness_Pa_sqrt_m is missing. A log needs top_m, youngs_modulus_Pa, poisson_ratio, "
      "toughness_Pa_sqrt_m, horizontal_Pa.",
      "well.csv:1:7: rok is no column of a well log, which has top_m, rock, horizontal_Pa, interface, "
      "youngs_modulus_Pa, poisson_ratio, density_kg_m3, toughness_Pa_sqrt_m, leakoff_m_sqrt_s, with commas between. "
      "Did you mean rock?",
      "well.csv:2:1: top_m = -5.0 is outside [0, 100000]. Depths grow downwards from the ground.",
      "well.csv:2:5: rock = sa nd: a name is made of letters, digits, _ and -, at most 60.",
      "well.csv:2:11: youngs_modulus_Pa = 30 GPa is not a number. Write digits as in 1.5e6, without a unit.",
      "well.csv:2:18: poisson_ratio = 0.5 is outside [0, 0.5). In plane strain the stiffness is infinite at 0.5; 0.49 "
      "is nearly incompressible.",
      "well.csv:2:26: interface: no layer lies above the first. Leave it out.",
      "well.csv:4:20: horizontal_Pa is missing. Give it, or the name of a rock above that has it.",
      "well.csv:4:21: interface = \"wek\" is not allowed. Use one of \"friction\", \"weak\", \"soft\", \"perfect\". "
      "Did "
      "you mean weak?",
      "well.csv:5:1: top_m = 8 is not below the row above, at 10 m. Sort rows by depth.",
      "well.csv:5:5: youngs_modulus_Pa = 0.0 is outside (0, inf).",
      "well.csv:5:7: poisson_ratio = 1e999 is not a number. Write digits as in 1.5e6, without a unit.",
      "well.csv:5:13: horizontal_Pa = nan is not finite. Write a finite number.",
      "well.csv:5:18: the row has more cells than the header. Remove them.",
      "well.csv:6:8: horizontal_Pa = 2e6: the last row holds the depth where the last layer ends, alone. Add it."};
  // NOLINTEND(bugprone-suspicious-missing-comma)
  CHECK(said == wanted);
}

TEST_CASE("A log's values have the bounds of the scene's keys") {
  std::vector<const Key*> keys;
  for (const Key& key : scene_keys())
    if (key.table() == "rock.NAME.") keys.push_back(&key);
  REQUIRE(keys.size() >= 4);
  for (const Key* tried : keys) {
    for (const double value : {-1.0, 0.0, 0.3, 0.5, 1e12}) {
      std::string names = "top_m,horizontal_Pa", values = "0,2e6";
      for (const Key* key : keys) {
        names += fmt::format(",{}", key->name());
        values += fmt::format(",{}", key == tried ? value : 0.3);  // within all bounds
      }
      CAPTURE(tried->path, value);
      const auto errors = scene_of_log(names + '\n' + values + "\n4\n", "well.csv").errors;
      CHECK(errors.empty() == tried->bounds.contain(value));
    }
  }
}

TEST_CASE("What is no log is told what a log is") {
  for (const char* text : {"", "# nothing\n", "top_m,rock\n1,sand\n"}) {
    const auto said = errors_of(text);
    REQUIRE(said.size() == 1);
    CHECK_THAT(said[0], Catch::StartsWith("well.csv:1:1: this is no well log: a row a layer, from the top"));
  }
  CHECK_THAT(errors_of("top_m;rock\n1;sand\n2;sand\n")[0], Catch::Contains("with commas between"));
  CHECK(scene_of("\xEF\xBB\xBF" + three).rocks.size() == 2);
}
