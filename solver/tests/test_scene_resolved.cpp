#include "initialise.hpp"
#include "scene/derived.hpp"
#include "scene/graded_cells.hpp"
#include "scene/keys.hpp"
#include "scene_text.hpp"

using namespace strata;
using namespace scene_test;

namespace {

// Reading the resolved text gives the same scene, and the same text again.
void check_round_trip(const Scene& scene) {
  CAPTURE(scene.resolved_toml);
  const ReadResult again = read_scene_text(scene.resolved_toml, "runs/x/scene.toml", "", {});
  CAPTURE(again.errors);
  REQUIRE(again.scene.has_value());
  CHECK(*again.scene == scene);
}

}  // namespace

TEST_CASE("A resolved scene reads as the same scene") {
  check_round_trip(good(layered));
  check_round_trip(good(layered + "time_s = 3\ntip_y_m = 70\n[output]\nfields_every_s = 0.01\n"));
  check_round_trip(good(layered + "[variants.v]\nnumerics.cell_m = 0.5\n", "v", {"interface.joint.law=soft"}));
  check_round_trip(good(layered, "", {"numerics.kernels=plain"}));
  check_round_trip(good(with(layered, "[[40, 0], [40, 5]]", "[[41.3, 7.7], [40.1, 2.2], [40, 0]]")));
}

TEST_CASE("A resolved scene without a fracture has none") {
  std::string text = with(layered, "[fracture]\npath_m = [[40, 0], [40, 5]]\n", "");
  text = with(text, "inlet_Pa = 4e6", "time_s = 1");
  const Scene scene = good(text);
  CHECK(scene.resolved_toml.find("[fracture]") == std::string::npos);
  check_round_trip(scene);
}

TEST_CASE("Doubles survive to the last digit") {
  const Scene scene =
      good(layered, "",
           {"in_situ.vertical_Pa=3000000.0000000005", "numerics.damping_1_s=0.1", "fluid.minimum_opening_m=5e-324",
            "rock.soft.density_kg_m3=1.7976931348623157e308", "in_situ.horizontal_Pa=0.30000000000000004"});
  CHECK(scene.in_situ.horizontal_Pa == 0.1 + 0.2);
  check_round_trip(scene);
}

TEST_CASE("Layers at multiples of a cell that is no binary fraction survive") {
  for (const char* cell : {"0.1", "0.7", "0.9876543209876543"}) {
    const std::string set = std::string("numerics.cell_m=") + cell;
    const double h = std::stod(cell);
    const std::string extent = number_text(90 * h);
    std::string layers = "[";
    for (int k = 1; k < 5; ++k) layers += "{rock = \"soft\", thickness_m = " + number_text(3.5 * k * h) + "}, ";
    const Scene scene = good(layered, "",
                             {set, "domain.width_m=" + extent, "domain.height_m=" + extent,
                              "fracture.path_m=[[" + number_text(45 * h) + ", 0], [" + number_text(45 * h) + ", " +
                                  number_text(2 * h) + "]]",
                              "strata.interfaces=[\"joint\", \"joint\", \"joint\", \"joint\"]",
                              "strata.layers=" + layers + "{rock = \"stiff\"}]"});
    check_round_trip(scene);
  }
}

TEST_CASE("Titles with quotes and other letters survive") {
  check_round_trip(good(layered, "", {"title=\"say \\\"w\\u00f6rd\\\" \\\\ and\\nnext line\\t'\""}));
}

TEST_CASE("A resolved scene holds every key that is in force, and no variants") {
  const Scene scene = good(layered + "[variants.v]\nnumerics.cell_m = 0.5\n", "v");
  for (const Key& key : scene_keys()) {
    const bool absent = !key.required && key.kind != Key::Kind::list && default_text(key).empty();
    if (key.path == "fluid.inlet.table" || key.path == "fluid.inlet.of") continue;  // the inlet has none
    if (key.in_list() || absent || (!key.law.empty() && key.law != "friction")) continue;
    CAPTURE(key.path, scene.resolved_toml);
    CHECK(scene.resolved_toml.find(std::string(key.name()) + " = ") != std::string::npos);
  }
  CHECK(scene.resolved_toml.find("[variants") == std::string::npos);
  CHECK(scene.resolved_toml.find("variant = \"v\"") != std::string::npos);
}

TEST_CASE("Claims are kept with all their keys") {
  const Scene scene = good(layered +
                           "[[claim]]\nid = \"1a\"\ntext = \"it's so\"\nobservable = \"height\"\n"
                           "low = 0.1\nbetween = [\"weak\", \"perfect\"]\nat = {inlet_Pa = 3e6}\n"
                           "[[claim]]\nid = \"1b\"\ntext = \"t\"\nobservable = \"o\"\n");
  check_round_trip(scene);
  for (const char* part : {"id = \"1a\"", "\"it's so\"", "low = 0.1", "weak", "inlet_Pa = 3000000.0", "id = \"1b\""}) {
    CHECK_THAT(scene.resolved_toml, Catch::Contains(part));
  }
}

TEST_CASE("Distance of segments by hand") {
  CHECK(segment_distance({0, 0}, {2, 2}, {0, 2}, {2, 0}) == 0.0);
  CHECK(segment_distance({0, 0}, {2, 0}, {0, 1}, {2, 1}) == 1.0);
  CHECK(segment_distance({0, 0}, {1, 0}, {4, 4}, {4, 5}) == 5.0);
  CHECK(segment_distance({0, 0}, {2, 0}, {1, 0}, {1, 3}) == 0.0);
}

TEST_CASE("A path that meets itself is found, one that comes near is not") {
  CHECK_FALSE(self_contact({{0, 0}, {0, 2}, {2, 2}, {2, 1}, {0.1, 1}}, 1e-9));
  CHECK(self_contact({{0, 0}, {0, 2}, {2, 2}, {2, 1}, {0, 1}}, 1e-9) == std::pair<std::size_t, std::size_t>(0, 3));
  CHECK(self_contact({{0, 0}, {0, 2}, {0, 1}}, 1e-9) == std::pair<std::size_t, std::size_t>(0, 1));
  CHECK(self_contact({{0, 0}, {0, 2}, {0, -1}}, 1e-9) == std::pair<std::size_t, std::size_t>(0, 1));
  CHECK_FALSE(self_contact({{0, 0}, {0, 2}, {0, 3}}, 1e-9));
}

TEST_CASE("The inlet's table takes the place of pressure or rate, and reads as the same scene") {
  const std::string steps = with(layered, "inlet_Pa = 4e6", "inlet_Pa = 4e6\ntime_s = 9");
  const std::string pressure = with(steps, "{start_Pa = 2e6, rate_Pa_s = 0.35e6}",
                                    "{table = [[0, 2e6], [1, 2.5e6], [1.5, 0]], of = \"pressure_Pa\"}");
  const std::string rate =
      with(pressure, "[fluid]\ninlet = {table = [[0, 2e6], [1, 2.5e6], [1.5, 0]], of = \"pressure_Pa\"}",
           "[fluid]\nlaw = \"reynolds\"\ninlet = {table = [[0, 0], [2.5, 1e-4]], of = \"rate_m2_s\"}");
  const std::string fed = with(rate, "cell_m = 1", "cell_m = 1\nmechanics = \"quasistatic\"");
  const Scene by_pressure = good(pressure), by_rate = good(fed);
  check_round_trip(by_pressure);
  check_round_trip(by_rate);
  CHECK(by_pressure.fluid.start_Pa == 2e6);
  CHECK_FALSE(by_pressure.fluid.rate_m2_s.has_value());
  CHECK(by_rate.fluid.rate_m2_s == 0.0);
  for (const char* key : {"start_Pa", "rate_Pa_s", "rate_m2_s = "})
    CHECK(by_pressure.resolved_toml.find(key) == std::string::npos);
  // What a variant or --set lays above the scene counts.
  const Scene again = good(pressure, "", {"fluid.inlet.start_Pa=1e6"});
  CHECK(again.fluid.table.empty());
  CHECK(again.fluid.start_Pa == 1e6);
  const Scene table = good(steps, "", {"fluid.inlet.table=[[0, 1e6], [1, 2e6]]", "fluid.inlet.of=pressure_Pa"});
  CHECK((table.fluid.table.size() == 2 && table.fluid.start_Pa == 1e6 && table.fluid.rate_Pa_s == 0.0));
  check_round_trip(table);
}

TEST_CASE("A scene without inertia, fed at a rate and on a graded grid reads as the same scene") {
  std::string text = with(layered, "{start_Pa = 2e6, rate_Pa_s = 0.35e6}", "{rate_m2_s = 1e-4}\nlaw = \"reynolds\"");
  text = with(text, "inlet_Pa = 4e6", "tip_y_m = 70\ntime_s = 0");
  text = with(text, "cell_m = 1", "cell_m = 1\nfar_cell_m = 5\nmechanics = \"quasistatic\"");
  text = with(text, "width_m = 80\n", "width_m = 80\nbeyond_m = 300\n");
  check_round_trip(good(with(text, "[fracture]\n", "[fracture]\ncrossing_increment_m = 0.5\n")));
}

// Requires memory to be that of points with inertia, and of states, a factor and dense matrices of jumps where
// equilibria are solved. Mutations that fail: a term left out or taken where it is not, the half of a mirrored block
// forgotten.
TEST_CASE("Memory needed grows with the particles, more so with a factor, and less where cells are graded or halved") {
  constexpr double process = 21e6, along = 80.0;  // cells along the path and along the interface
  Scene scene = good(layered);
  const double points = 4.0 * along * along;
  CHECK(points_of(scene) == points);
  const auto equilibria = [&](double columns, double jumps) {
    const double n = 2.0 * (columns + 1.0) * 81.0;
    return 800.0 * points_of(scene) + 500.0 * n * std::log2(n) + 56.0 * jumps * jumps;
  };
  CHECK(memory_need(scene) == Approx(process + 1250.0 * points + equilibria(80.0, 6.0 * along)));  // of crossings
  scene.fracture->crossing = Fracture::Crossing::J;
  CHECK(memory_need(scene) == Approx(process + 1250.0 * points));
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  CHECK(memory_need(scene) == Approx(process + equilibria(40.0, 3.0 * along)));  // the interface is bonded
  scene.fracture->path_m = {{30.0, 0.0}, {30.0, 5.0}};
  CHECK(memory_need(scene) == Approx(process + equilibria(80.0, 6.0 * along)));
  CHECK_FALSE(too_large(scene, memory_need(scene)).has_value());
  CHECK_THAT(too_large(scene, 0.5 * memory_need(scene)).value(),
             Catch::Contains("need about 0.144 GB, and 0.0721 GB are available"));
  scene.fracture->direction = Fracture::Direction::max_hoop;
  CHECK(memory_need(scene) == Approx(process + equilibria(80.0, 6.0 * along)));
  scene.laws[scene.strata.interfaces[0].law].kind = InterfaceLaw::Kind::soft;
  CHECK(memory_need(scene) == Approx(process + equilibria(80.0, 6.0 * 2.0 * along)));
  CHECK(available_memory() > 1e6);
}

// Requires memory to go with the length of the fracture and the ways of its tips, wherever it is and however it leans,
// in a block of 4 km: 56 bytes for each pair of its six jumps a cell. Mutations that fail: the tip's height for its
// length, one tip's way for both, the way counted along y.
TEST_CASE("Fractures need what their length asks for") {
  Scene scene = good(layered);
  scene.domain = {4000.0, 4000.0, Edge::traction, Edge::traction, Edge::traction};
  scene.strata = {Strata::Along::y, {{0, 0.0, 4000.0}}, {}};
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  scene.numerics.far_cell_m = 100.0;
  scene.stop.inlet_Pa = {};
  scene.fracture->growth = Fracture::Growth::none;
  const auto jumps = [&](const std::vector<std::array<double, 2>>& path) {
    scene.fracture->path_m = path;
    const auto cells = [&](std::size_t axis) { return static_cast<double>(scene_knots(scene, axis).size()) - 4.0; };
    const double n = 2.0 * (cells(0) + 1.0) * (cells(1) + 1.0);
    return std::sqrt((memory_need(scene) - 21e6 - 3200.0 * cells(0) * cells(1) - 500.0 * n * std::log2(n)) / 56.0);
  };
  CHECK(jumps({{2000.0, 1995.0}, {2000.0, 2005.0}}) == Approx(60.0).epsilon(1e-6));
  CHECK(jumps({{2000.0, 2000.0}, {2010.0, 2000.0}}) == Approx(60.0).epsilon(1e-6));
  CHECK(jumps({{100.0, 3900.0}, {106.0, 3892.0}}) == Approx(60.0).epsilon(1e-6));
  CHECK(jumps({{100.0, 100.0}, {106.0, 108.0}, {106.0, 118.0}}) == Approx(120.0).epsilon(1e-6));
  CHECK(memory_need(scene) < 0.4e9);
  scene.fracture->growth = Fracture::Growth::J;
  scene.stop.tip_y_m = 2025.0;
  CHECK(jumps({{2000.0, 1995.0}, {2000.0, 2005.0}}) == Approx(6.0 * 50.0).epsilon(1e-6));  // 20 m up and 20 m down
  scene.stop.tip_y_m = 2013.0;
  CHECK(jumps({{2000.0, 2000.0}, {2006.0, 2008.0}}) == Approx(6.0 * 22.5).epsilon(1e-6));  // 5 m up leaning are 6.25 m
  scene.stop = {.tip_y_m = {}, .lower_tip_y_m = {}, .inlet_Pa = 4e6, .time_s = {}};
  CHECK(jumps({{3000.0, 3990.0}, {3010.0, 3990.0}}) == Approx(6.0 * 4000.0).epsilon(1e-6));  // to both sides
  scene.stop.time_s = 0.0;                                                                   // one equilibrium
  CHECK(jumps({{2000.0, 1995.0}, {2000.0, 2005.0}}) == Approx(60.0).epsilon(1e-6));
}

// Requires the estimate to count the points that a block is then filled with: 4 a cell, 16 where the path may turn
// without inertia, 9 where asked for, 16 in thin layers. Mutations that fail: 4 where paths turn, 16 with inertia or
// where nothing grows, thin layers forgotten.
TEST_CASE("Points are counted as blocks are filled with them") {
  Scene scene = good(layered);
  const auto check = [&](double per_cell) {
    CHECK(points_of(scene) == 80.0 * 80.0 * per_cell);
    CHECK(initialise(scene, make_elasticities(scene)).particles.size() == static_cast<std::size_t>(points_of(scene)));
  };
  check(4.0);
  scene.fracture->direction = Fracture::Direction::max_hoop;
  check(4.0);  // with inertia finer as the path comes by
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  check(16.0);
  scene.numerics.particles_per_cell = 9;
  check(9.0);
  scene.fracture->growth = Fracture::Growth::none;
  scene.numerics.particles_per_cell = 4;
  check(4.0);
  scene.strata.layers.front().to_m = scene.strata.layers.back().from_m = scene.strata.interfaces.back().at_m = 79.0;
  scene.domain.top = Edge::traction;
  check(16.0);
}

// Requires four points across a cell just where a layer of less than 1.5 cells has a law, or an edge that moves freely,
// on either side of it, with functions that reach over two rows. Mutations that fail: either edge left out, that of the
// other way of stacking taken, rock beyond the block forgotten, one side enough, layers of 2 cells or not those of 1,
// hat functions too.
TEST_CASE("Thin layers between what parts them have more points") {
  Scene scene = good(layered);
  scene.fracture.reset();
  scene.laws.resize(1);
  const auto stack = [&](std::vector<double> at, Strata::Along along) {
    scene.laws.resize(1);
    scene.laws.push_back(InterfaceLaw{"cut", InterfaceLaw::Kind::friction});
    scene.strata = {along, {}, {}};
    at.insert(at.begin(), 0.0);
    at.push_back(80.0);
    for (std::size_t k = 0; k + 1 < at.size(); ++k) scene.strata.layers.push_back({0, at[k], at[k + 1]});
    for (std::size_t k = 1; k + 1 < at.size(); ++k) scene.strata.interfaces.push_back({1, at[k]});
  };
  const auto edges = [&](Edge bottom, Edge sides, Edge top) {
    scene.domain.bottom = bottom, scene.domain.sides = sides, scene.domain.top = top;
  };
  edges(Edge::symmetry, Edge::fixed, Edge::fixed);
  for (const auto along : {Strata::Along::y, Strata::Along::x}) {
    stack({40.0, 41.0}, along);
    CHECK(points_across(scene) == 4);
    scene.numerics.shape = Numerics::Shape::linear;
    CHECK(points_across(scene) == 2);
    scene.numerics.shape = Numerics::Shape::bspline2;
    scene.strata.interfaces[1].law = 0;  // bonded
    CHECK(points_across(scene) == 2);
    for (const double thick : {1.5, 2.0}) {
      stack({40.0, 40.0 + thick}, along);
      CHECK(points_across(scene) == 2);
    }
  }
  const auto across = [&](double at, Strata::Along along) {
    stack({at}, along);
    return points_across(scene);
  };
  using enum Strata::Along;
  CHECK((across(1.0, y) == 2 && across(79.0, y) == 2 && across(1.0, x) == 2 && across(79.0, x) == 2));
  edges(Edge::traction, Edge::fixed, Edge::fixed);
  CHECK((across(1.0, y) == 4 && across(79.0, y) == 2 && across(1.0, x) == 2 && across(79.0, x) == 2));
  edges(Edge::symmetry, Edge::traction, Edge::fixed);
  CHECK((across(1.0, y) == 2 && across(79.0, y) == 2 && across(1.0, x) == 4 && across(79.0, x) == 4));
  edges(Edge::symmetry, Edge::fixed, Edge::traction);
  CHECK((across(1.0, y) == 2 && across(79.0, y) == 4 && across(1.0, x) == 2 && across(79.0, x) == 2));
  scene.domain.beyond_m = 10.0;
  CHECK(across(79.0, y) == 2);
}

TEST_CASE("Points are counted as cells are graded, and as the rock goes on beyond the block") {
  Scene scene = good(layered);
  const auto cells = [&](std::size_t axis) { return static_cast<double>(scene_knots(scene, axis).size()) - 4.0; };
  scene.numerics.far_cell_m = 5.0;
  scene.stop.tip_y_m = 20.0;
  CHECK(points_of(scene) < 0.5 * 4.0 * 80.0 * 80.0);
  CHECK(points_of(scene) == 4.0 * cells(0) * cells(1));
  scene.numerics.far_cell_m = 1.0;
  scene.domain.beyond_m = 300.0;
  CHECK(points_of(scene) == 4.0 * cells(0) * cells(1));
  scene.domain.beyond_m = 0.0;
  scene.numerics.far_cell_m.reset();
  scene.numerics.cell_m = 1e-6;  // too many to be made
  CHECK(points_of(scene) == Approx(4.0 * 80e6 * 80e6));
}

TEST_CASE("A run is expected to end at its time or at the inlet's last pressure") {
  Scene scene = good(layered);  // to 4 MPa from 2 at 0.35 MPa/s
  CHECK(expected_duration(scene).value() == Approx(2.0 / 0.35));
  scene.stop.time_s = 1.0;
  CHECK(expected_duration(scene).value() == 1.0);
  scene.stop = {.tip_y_m = 40.0, .lower_tip_y_m = {}, .inlet_Pa = {}, .time_s = {}};
  CHECK_FALSE(expected_duration(scene).has_value());  // nobody knows when the tip gets there
}
