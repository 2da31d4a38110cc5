#include "scene_text.hpp"

using namespace strata;
using namespace scene_test;

TEST_CASE("A scene is read to the last key, with defaults for what it leaves out") {
  const Scene scene = good(layered);
  CHECK(scene.title == "two layers");
  CHECK(scene.name == "scene");
  CHECK(scene.variant.empty());
  CHECK(scene.domain.width_m == 80.0);
  CHECK(scene.domain.bottom == Edge::symmetry);
  CHECK(scene.in_situ.horizontal_Pa == 2e6);
  REQUIRE(scene.rocks.size() == 2);
  CHECK(scene.rocks[0].name == "soft");
  CHECK(scene.rocks[0].toughness_Pa_sqrt_m == 1.25e6);
  CHECK(scene.rocks[1].poisson_ratio == Rock{}.poisson_ratio);
  REQUIRE(scene.laws.size() == 2);
  CHECK(scene.laws[0] == InterfaceLaw{});
  CHECK(scene.laws[1].kind == InterfaceLaw::Kind::friction);
  CHECK(scene.laws[1].coefficient == 0.4);
  CHECK(scene.strata.layers == std::vector<Layer>{{1, 0.0, 10.0}, {0, 10.0, 80.0}});
  CHECK(scene.strata.interfaces == std::vector<InterfacePlace>{{1, 10.0}});
  REQUIRE(scene.fracture.has_value());
  CHECK(scene.fracture->path_m == std::vector<std::array<double, 2>>{{40.0, 0.0}, {40.0, 5.0}});
  CHECK(scene.fluid.rate_Pa_s == 0.35e6);
  CHECK(scene.numerics == [] {
    Numerics numerics;
    numerics.cell_m = 1.0;
    return numerics;
  }());
  CHECK(scene.stop.inlet_Pa == 4e6);
  CHECK_FALSE(scene.stop.time_s.has_value());
}

TEST_CASE("A block of rock needs neither fracture nor fluid nor interfaces") {
  const Scene scene = good(
      "[domain]\nwidth_m = 4\nheight_m = 2\n[rock.a]\nyoungs_modulus_Pa = 1e9\n[strata]\nlayers = [{rock = \"a\"}]\n"
      "[numerics]\ncell_m = 0.5\n[stop]\ntime_s = 1\n");
  CHECK_FALSE(scene.fracture.has_value());
  CHECK(scene.strata.layers == std::vector<Layer>{{0, 0.0, 2.0}});
  CHECK(scene.strata.interfaces.empty());
}

TEST_CASE("Interfaces left out are perfect") {
  const Scene scene = good(with(layered, "interfaces = [\"joint\"]\n", ""));
  CHECK(scene.strata.interfaces == std::vector<InterfacePlace>{{0, 10.0}});
}

TEST_CASE("A fracture typed towards the symmetry line is turned to start there") {
  CHECK(good(with(layered, "[[40, 0], [40, 5]]", "[[40, 5], [40, 0]]")).fracture->path_m.front()[1] == 0.0);
  const Scene inside = good(with(layered, "[[40, 0], [40, 5]]", "[[40, 7], [40, 5]]"));
  CHECK(inside.fracture->path_m.front()[1] == 7.0);
}

TEST_CASE("Layers stacked from left to right are measured along x") {
  std::string text = with(layered, "[strata]\n", "[strata]\nalong = \"x\"\n");
  text = with(text, "width_m = 80", "width_m = 60");
  const Scene scene = good(with(text, "thickness_m = 10", "thickness_m = 45.5"));
  CHECK(scene.strata.layers.back().to_m == 60.0);
  CHECK(scene.strata.interfaces[0].at_m == 45.5);
}

TEST_CASE("Sums of thicknesses land on the grid without round-off") {
  std::string text = with(layered, "cell_m = 1", "cell_m = 0.1");
  text = with(text, "{rock = \"stiff\", thickness_m = 10}",
              "{rock = \"stiff\", thickness_m = 0.7}, {rock = \"stiff\", thickness_m = 0.1}");
  const Scene scene = good(with(text, "[\"joint\"]", "[\"joint\", \"joint\"]"));
  CHECK(0.7 + 0.1 < 0.8);
  CHECK(scene.strata.interfaces[1].at_m == 0.8);
}

TEST_CASE("The last thickness may be given if it adds up") {
  CHECK(good(with(layered, "{rock = \"soft\"}", "{rock = \"soft\", thickness_m = 70}")).strata.layers[1].to_m == 80.0);
  CHECK_THAT(errors(with(layered, "{rock = \"soft\"}", "{rock = \"soft\", thickness_m = 71}")),
             Catch::Contains("scene.toml:17:47: strata.layers add up to 81 m, but the block has 80 m."));
}

TEST_CASE("What depends on a value of no use is left out") {
  std::string text = with(layered, "{rock = \"soft\"}", "{rock = \"soft\", thickness_m = 70}");
  CHECK(read(with(text, "thickness_m = 10}", "thickness_m = -10}")).errors.size() == 1);  // not what they add up to
  CHECK(read(with(layered, "width_m = 80", "width_m = 80 m")).errors.size() == 1);        // nor what lies outside
  CHECK(read(with(layered, "law = \"friction\"", "law = friction")).errors.size() == 1);  // nor keys of another law
}

TEST_CASE("Integers are numbers, whatever the size; other types are not") {
  CHECK(good(with(layered, "vertical_Pa = 3e6", "vertical_Pa = 3000000")).in_situ.vertical_Pa == 3e6);
  CHECK_THAT(errors(with(layered, "width_m = 80", "width_m = \"80\"")), Catch::Contains("is not a number"));
  CHECK_THAT(errors(with(layered, "width_m = 80", "width_m = [80]")), Catch::Contains("is not a number"));
  CHECK_THAT(errors(with(layered, "vertical_Pa = 3e6", "vertical_Pa = -inf")), Catch::Contains("is not finite"));
}

TEST_CASE("A stress is a number or a formula, a truth is neither") {
  CHECK(good(with(layered, "horizontal_Pa = 2e6", "horizontal_Pa = \"2e6 + 1e4*Y\"")).in_situ.horizontal_Pa ==
        Field("2e6 + 1e4*Y"));
  CHECK(good(with(layered, "thickness_m = 10}", "thickness_m = 10, horizontal_Pa = 3e6}"))
            .strata.layers[0]
            .horizontal_Pa == Field(3e6));
  CHECK(good(with(layered, "vertical_Pa = 3e6", "vertical_Pa = 3e6\nweight = true")).in_situ.weight);
  CHECK_THAT(errors(with(layered, "vertical_Pa = 3e6", "vertical_Pa = [3e6]")),
             Catch::Contains("neither a number nor a formula in quotes"));
  CHECK_THAT(errors(with(layered, "horizontal_Pa = 2e6", "horizontal_Pa = \"2 MPa\"")),
             Catch::Contains("is not a formula: "));
  CHECK_THAT(errors(with(layered, "vertical_Pa = 3e6", "vertical_Pa = 3e6\nweight = 1")),
             Catch::Contains("in_situ.weight = 1 is neither true nor false."));
}

TEST_CASE("An interface that ends stands where its list has a table") {
  const auto end = [](const std::string& table) {
    return with(layered, "interfaces = [\"joint\"]", "interfaces = [" + table + "]");
  };
  const InterfacePlace place = good(end("{name = \"joint\", from_m = 15, to_m = 65}")).strata.interfaces[0];
  CHECK((place.law == 1 && place.from_m == 15.0 && place.to_m == 65.0));
  CHECK_FALSE(good(end("{name = \"joint\", to_m = 65}")).strata.interfaces[0].from_m);
  CHECK_THAT(errors(end("{from_m = 15}")), Catch::Contains("strata.interfaces[0].name is missing."));
  CHECK_THAT(errors(end("{name = \"jont\"}")),
             Catch::Contains("there is no [interface.jont]") && Catch::Contains("joint"));
  CHECK_THAT(errors(end("{name = \"joint\", from_m = 15.3}")),
             Catch::Contains("is not on a grid line of cells of 1 m. The nearest: 15 m."));
  CHECK_THAT(errors(end("{name = \"joint\", to_m = 90}")), Catch::Contains("is outside the rock, from 0 to 80 m."));
  CHECK_THAT(errors(end("{name = \"joint\", from_m = 30, to_m = 20}")), Catch::Contains("less than 4 cells"));
  CHECK_THAT(errors(end("7")), Catch::Contains("is not a name"));
}

TEST_CASE("Bounds are open or closed as declared") {
  const auto poisson = [](const char* value) {
    return with(layered, "youngs_modulus_Pa = 10e9", std::string("youngs_modulus_Pa = 10e9\npoisson_ratio = ") + value);
  };
  CHECK(good(poisson("0")).rocks[1].poisson_ratio == 0.0);
  CHECK(good(poisson("0.499")).rocks[1].poisson_ratio == 0.499);
  CHECK_THAT(errors(poisson("0.5")),
             Catch::StartsWith("scene.toml:10:1: rock.stiff.poisson_ratio = 0.5 is outside [0, 0.5)."));
  const auto courant = [](const char* value) {
    return with(layered, "cell_m = 1", std::string("cell_m = 1\ncourant = ") + value);
  };
  CHECK(good(courant("1")).numerics.courant == 1.0);
  CHECK_THAT(errors(courant("0")), Catch::Contains("courant = 0 is outside (0, 2]"));
}

TEST_CASE("All mistakes are reported at once, in the order of the file") {
  std::string text = with(layered, "width_m = 80", "widht_m = 80");
  text = with(text, "law = \"friction\"", "law = \"frction\"");
  text = with(text, "cell_m = 1", "cell_m = -1\nmechanics = \"static\"");
  const ReadResult result = read(text);
  REQUIRE(result.errors.size() == 5);
  CHECK_THAT(result.errors[0], Catch::StartsWith("scene.toml:2:2: domain.width_m is missing"));
  CHECK_THAT(result.errors[1], Catch::StartsWith("scene.toml:3:1: unknown key domain.widht_m. Did you mean width_m?"));
  CHECK_THAT(result.errors[2], Catch::Contains("Did you mean friction?"));
  CHECK_THAT(result.errors[3], Catch::Contains("numerics.cell_m = -1 is outside (0, inf)"));
  CHECK_THAT(
      result.errors[4],
      Catch::Contains("numerics.mechanics = \"static\" is not allowed. Use one of \"explicit\", \"quasistatic\"."));
}

TEST_CASE("Half-cell interfaces are allowed, others name the nearest place") {
  CHECK(good(with(layered, "thickness_m = 10", "thickness_m = 10.5")).strata.interfaces[0].at_m == 10.5);
  CHECK_THAT(errors(with(layered, "thickness_m = 10", "thickness_m = 10.7")),
             Catch::Contains("nearest place for the interface: 10.5 m"));
}

TEST_CASE("What is not TOML is said with its place; a file that is not there by its name") {
  CHECK_THAT(errors("[domain\n"), Catch::StartsWith("scene.toml:1:8: this is not TOML"));
  const ReadResult missing = read_scene("no/such.toml", "", {});
  REQUIRE(missing.errors.size() == 1);
  CHECK_THAT(missing.errors[0], Catch::StartsWith("no/such.toml: there is no such file"));
  CHECK_THAT(read_scene(".", "", {}).errors.at(0), Catch::Contains("is a folder"));
  CHECK_THAT(errors(""), Catch::Contains("domain.width_m is missing"));
}

TEST_CASE("A run that could not end is refused, one that ends by time is not") {
  const std::string constant = with(layered, ", rate_Pa_s = 0.35e6", "");
  CHECK_THAT(errors(constant), Catch::Contains("the run could never end"));
  CHECK(good(constant + "time_s = 1\n").stop.time_s == 1.0);
  CHECK(good(with(constant, "inlet_Pa = 4e6", "time_s = 2")).fluid.rate_Pa_s == 0.0);
  const std::string still = with(layered, "[fracture]\n", "[fracture]\ngrowth = \"none\"\n");
  CHECK(good(still).fracture->growth == Fracture::Growth::none);
  CHECK_THAT(errors(with(still, "inlet_Pa = 4e6", "tip_y_m = 70")), Catch::Contains("the fracture does not grow"));
}

namespace {

// The layered scene without inertia, fed at a rate.
std::string fed_at_a_rate() {
  std::string text = with(layered, "{start_Pa = 2e6, rate_Pa_s = 0.35e6}", "{rate_m2_s = 1e-4}\nlaw = \"reynolds\"");
  text = with(text, "inlet_Pa = 4e6", "tip_y_m = 70");
  return with(text, "cell_m = 1", "cell_m = 1\nmechanics = \"quasistatic\"");
}

}  // namespace

TEST_CASE("Crossing left out is energy, with inertia and without") {
  const std::string quasistatic = with(layered, "cell_m = 1", "cell_m = 1\nmechanics = \"quasistatic\"");
  for (const std::string& text : {layered, quasistatic}) {
    CHECK(good(text).fracture->crossing == Fracture::Crossing::energy);
    CHECK(good(text, "", {"fracture.crossing=J"}).fracture->crossing == Fracture::Crossing::J);
  }
}

TEST_CASE("What explicit runs cannot do is refused where it is typed") {
  std::string text = with(layered, "cell_m = 1", "cell_m = 1\nfar_cell_m = 5\nmechanics = \"quasistatic\"");
  text = with(text, "[fracture]\n", "[fracture]\ngrowth = \"energy\"\n");
  CHECK(good(text).numerics.far_cell_m == 5.0);
  CHECK(good(text, "", {"numerics.mechanics=explicit", "fracture.growth=J"}).numerics.far_cell_m == 5.0);
  CHECK_THAT(errors(with(text, "quasistatic", "explicit"), "", {}),
             Catch::Contains("fracture.growth = \"energy\" compares equilibria"));
}

TEST_CASE("Every explicit run takes a graded grid that is asked for with it") {
  const std::string text = with(layered, "cell_m = 1", "cell_m = 1\nfar_cell_m = 5\nmechanics = \"explicit\"");
  for (const char* kinematics : {"updated", "total"}) {
    for (const char* shape : {"bspline2", "linear", "gimp"}) {
      if (std::string_view{kinematics} == "total" && std::string_view{shape} == "gimp") continue;
      const Scene scene = good(text, "",
                               {"numerics.kinematics=" + std::string{kinematics}, "domain.beyond_m=400",
                                "numerics.shape=" + std::string{shape}});
      CHECK(scene.numerics.far_cell_m == 5.0);
      CHECK(scene.domain.beyond_m == 400.0);
    }
  }
  CHECK(good(text, "", {"numerics.mechanics=explicit", "numerics.far_cell_m=4"}).numerics.far_cell_m == 4.0);
}

TEST_CASE("What only explicit runs use stays allowed without inertia") {
  const Scene scene = good(with(layered, "cell_m = 1",
                                "cell_m = 1\nmechanics = \"quasistatic\"\ntransfer = \"pic\"\nkinematics = "
                                "\"total\"\ncourant = 0.3\ndamping_1_s = 2"));
  CHECK(scene.numerics.mechanics == Numerics::Mechanics::quasistatic);
  CHECK(good(layered + "time_s = 0\n", "", {"numerics.mechanics=quasistatic"}).stop.time_s == 0.0);
}

TEST_CASE("Fast kernels are the default, plain ones a choice") {
  CHECK(good(layered).numerics.kernels == Numerics::Kernels::fast);
  CHECK(good(layered, "", {"numerics.kernels=plain"}).numerics.kernels == Numerics::Kernels::plain);
}

TEST_CASE("A misspelt key of the inlet, and a word that is near one of another meaning, are told once") {
  CHECK(errors(with(fed_at_a_rate(), "rate_m2_s", "rate_m3_s")) ==
        "scene.toml:22:10: unknown key fluid.inlet.rate_m3_s. Did you mean rate_m2_s?\n");
  CHECK(errors(layered, "", {"numerics.mechanics=implicit"}) ==
        "--set numerics.mechanics=implicit: numerics.mechanics = \"implicit\" is not allowed. Use one of "
        "\"explicit\", \"quasistatic\".\n");
  CHECK_THAT(errors(layered, "", {"numerics.mechanics=quasi-static"}), Catch::Contains("Did you mean quasistatic?"));
}

TEST_CASE("The inlet's pressure or its rate is given, and the upper of the two counts") {
  const Scene fed = good(fed_at_a_rate());
  CHECK(fed.fluid.rate_m2_s == 1e-4);
  CHECK_THAT(fed.resolved_toml, !Catch::Contains("start_Pa"));
  const Scene pressed = good(fed_at_a_rate(), "", {"fluid.inlet.start_Pa=2e6", "fluid.inlet.rate_Pa_s=1e6"});
  CHECK_FALSE(pressed.fluid.rate_m2_s.has_value());
  CHECK(pressed.fluid.start_Pa == 2e6);
  const Scene again = good(with(fed_at_a_rate(), "rate_m2_s = 1e-4", "start_Pa = 2e6, rate_Pa_s = 1e6"), "",
                           {"fluid.inlet.rate_m2_s=1e-3"});
  CHECK(again.fluid.rate_m2_s == 1e-3);
  CHECK(again.fluid.start_Pa == 0.0);
  CHECK(again.fluid.rate_Pa_s == 0.0);
}

TEST_CASE("A fracture fed at a rate ends at a tip if it grows, at a pressure if it does not") {
  const auto stop_at = [](const char* stop) { return with(fed_at_a_rate(), "tip_y_m = 70", stop); };
  const auto still = [](const std::string& text) {
    return with(text, "[fracture]\n", "[fracture]\ngrowth = \"none\"\n");
  };
  CHECK(good(fed_at_a_rate()).stop.tip_y_m == 70.0);
  CHECK(good(stop_at("tip_y_m = 70\ninlet_Pa = 9e6")).stop.inlet_Pa == 9e6);
  CHECK(good(still(stop_at("inlet_Pa = 9e6"))).stop.inlet_Pa == 9e6);
  CHECK_THAT(errors(stop_at("inlet_Pa = 9e6")), Catch::Contains("falls as it grows"));
  CHECK_THAT(errors(still(fed_at_a_rate())), Catch::Contains("the fracture does not grow"));
}
