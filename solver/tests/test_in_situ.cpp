// The in-situ stress by place, and what of it is refused.
#include <catch2/catch.hpp>

#include "scene/in_situ.hpp"
#include "small_scenes.hpp"

namespace strata {
namespace {

// Three layers of 10, 20 and 70 m, of 2000, 2500 and 3000 kg/m^3, stacked upwards.
Scene stack() {
  Scene scene;
  scene.domain = {50.0, 100.0};
  for (const double rho : {2000.0, 2500.0, 3000.0}) scene.rocks.push_back({"rock", 10e9, 0.2, rho});
  scene.strata.layers = {{0, 0.0, 10.0}, {1, 10.0, 30.0}, {2, 30.0, 100.0}};
  scene.laws = {InterfaceLaw{}};
  scene.strata.interfaces = {{0, 10.0}, {0, 30.0}};
  scene.in_situ = {5e6, 4e6};
  return scene;
}

InSituStress at(const Scene& scene, double x, double y) {
  return in_situ_stress(scene, {{x, y}}).front();
}

std::vector<std::string> faults(const Scene& scene) {
  std::vector<std::string> out;
  for (const auto& [key, text] : in_situ_faults(scene)) out.push_back(text);
  return out;
}

}  // namespace

TEST_CASE("a layer's own stress stands in it alone, formulas change with the place") {
  Scene scene = stack();
  scene.strata.layers[1].horizontal_Pa = 7e6;
  CHECK(at(scene, 20.0, 9.0).horizontal == 4e6);
  CHECK(at(scene, 20.0, 10.0).horizontal == 7e6);
  CHECK(at(scene, 20.0, 31.0).horizontal == 4e6);
  CHECK(at(scene, 20.0, 20.0).vertical == 5e6);
  CHECK(largest_in_situ(scene) == 7e6);
  scene.strata.layers[2].horizontal_Pa = Field("1e6 + 2e4*Y");
  scene.in_situ.vertical_Pa = Field("5e6 + 1e3*X");
  CHECK(at(scene, 20.0, 50.0).horizontal == Approx(2e6));
  CHECK(at(scene, 20.0, 20.0).horizontal == 7e6);
  CHECK(at(scene, 20.0, 50.0).vertical == Approx(5.02e6));
  CHECK(faults(scene).empty());
}

TEST_CASE("weight adds what stands above, and a formula that has it already is left as it is") {
  Scene scene = stack();
  scene.in_situ.weight = true;
  const double g = 9.80665;
  CHECK(at(scene, 1.0, 100.0).vertical == Approx(5e6));
  CHECK(at(scene, 1.0, 40.0).vertical == Approx(5e6 + g * 3000.0 * 60.0));
  CHECK(at(scene, 1.0, 5.0).vertical == Approx(5e6 + g * (3000.0 * 70.0 + 2500.0 * 20.0 + 2000.0 * 5.0)));
  CHECK(at(scene, 1.0, 5.0).horizontal == 4e6);
  CHECK(faults(scene).empty());
  for (Rock& rock : scene.rocks) rock.density_kg_m3 = 2500.0;
  scene.in_situ.vertical_Pa = Field("5e6 + 2500*9.81*(100 - Y)");  // another g
  CHECK(at(scene, 1.0, 5.0).vertical == Approx(5e6 + 2500.0 * 9.81 * 95.0));
  CHECK(faults(scene).empty());
  scene.strata.along = Strata::Along::x;
  scene.strata.layers[2].to_m = 50.0;
  scene.in_situ.vertical_Pa = 5e6;
  scene.rocks[1].density_kg_m3 = 1000.0;
  CHECK(at(scene, 20.0, 40.0).vertical == Approx(5e6 + g * 1000.0 * 60.0));
  CHECK(at(scene, 40.0, 40.0).vertical == Approx(5e6 + g * 2500.0 * 60.0));
  CHECK(faults(scene).empty());
}

// In one rock the elastic stress by edges is that of in_situ's numbers everywhere, so that loaded and uniform are one.
TEST_CASE("a loaded state in one rock is the prescribed stress, in particles and on interfaces") {
  Scene scene = test::block(8, 12);
  scene.rocks[0].density_kg_m3 = 2500.0;
  scene.in_situ = {3e6, 2e6, InSitu::Initialise::loaded};
  scene.in_situ.weight = true;
  scene.in_situ.shear_Pa = 0.2e6;
  scene.strata.layers = {{0, 0.0, 4.0}, {0, 4.0, 8.0}, {0, 8.0, 12.0}};
  scene.strata.layers[1].horizontal_Pa = 2.7e6;
  InterfaceLaw weak;
  weak.name = "weak", weak.kind = InterfaceLaw::Kind::weak;
  scene.laws = {InterfaceLaw{}, weak};
  scene.strata.interfaces = {{1, 4.0}, {1, 8.0}};
  const State state = initialise(scene, make_elasticities(scene));
  const Particles& p = state.particles;
  double off = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const InSituStress wanted = at(scene, p.x[q], p.y[q]);
    off = std::max({off, std::abs(p.in_situ[q].xx + wanted.horizontal), std::abs(p.in_situ[q].yy + wanted.vertical),
                    std::abs(p.in_situ[q].xy - 0.2e6)});
  }
  CHECK(off < 1e-9 * 3e6);
  CHECK(at(scene, 1.0, 6.0).horizontal == 2.7e6);
  REQUIRE(state.surfaces.size() == 2);
  for (const Surface& surface : state.surfaces) {
    for (const SurfacePoint& s : surface.points) {
      const double depth = 12.0 - s.x.y();
      CHECK(s.closing_stress() == Approx(3e6 + 9.80665 * 2500.0 * depth).epsilon(1e-9));
      CHECK(s.in_situ.dot(tangent_of(s.n)) * s.n.y() == Approx(-0.2e6).epsilon(1e-9));
    }
  }
}

TEST_CASE("what nothing balances is refused with its place and size") {
  Scene scene = stack();
  SECTION("along X") {
    scene.in_situ.horizontal_Pa = Field("4e6 + 1e3*X");
    CHECK_THAT(faults(scene).at(0), Catch::Contains("changes by 1000 Pa/m along X at X = "));
  }
  SECTION("in a layer alone") {
    scene.strata.layers[1].horizontal_Pa = Field("4e6 - 1e3*X");
    REQUIRE(faults(scene).size() == 1);
    CHECK_THAT(faults(scene)[0],
               Catch::StartsWith("strata.layers[1].horizontal_Pa = \"4e6 - 1e3*X\" changes by -1000 "));
  }
  SECTION("along Y without weight") {
    scene.in_situ.vertical_Pa = Field("5e6 + 25e3*(100 - Y)");
    CHECK_THAT(faults(scene).at(0),
               Catch::Contains("changes by -25000 Pa/m along Y") && Catch::Contains("weight = true"));
  }
  SECTION("along Y, not by the weight") {
    scene.in_situ.weight = true;
    for (const char* formula : {"5e6 - 25e3*(100 - Y)", "5e6 + 2*24516.6*(100 - Y)", "5e6 + 0*Y"}) {
      scene.in_situ.vertical_Pa = Field(formula);
      CHECK_THAT(faults(scene).at(0), Catch::Contains("the rock's weight asks for -"));
    }
  }
  // Mutations that fail: no place beyond a border; one half a row beyond, where the neighbour's weight counts.
  SECTION("a jump at a border of layers") {
    for (const char* formula : {"Y < 10 ? 5e6 : 6e6", "Y <= 10 ? 5e6 : 6e6", "Y < 30 ? 5e6 : 6e6"}) {
      scene.in_situ.vertical_Pa = Field(formula);
      CHECK_THAT(faults(scene).at(0),
                 Catch::Contains("Pa/m along Y at X = ") && Catch::Contains("which nothing balances"));
    }
    scene.in_situ.weight = true;
    const std::string own =
        "9.80665*(3000*70 + (Y > 30 ? 3000*(30 - Y) : 2500*(30 - Y) - (Y < 10 ? 500*(10 - Y) : 0)))";
    scene.in_situ.vertical_Pa = Field("5e6 + " + own);
    CHECK(faults(scene).empty());
    scene.in_situ.vertical_Pa = Field("(Y > 10 ? 5e6 : 4.9e6) + " + own);
    CHECK_THAT(faults(scene).at(0), Catch::Contains("the rock's weight asks for -"));
    scene.strata.along = Strata::Along::x;
    scene.strata.layers[2].to_m = scene.domain.width_m;
    scene.in_situ = {5e6, Field("X < 10 ? 5e6 : 6e6")};
    CHECK_THAT(faults(scene).at(0), Catch::Contains("Pa/m along X at X = "));
  }
  SECTION("between neighbours") {
    scene.strata.layers[1].vertical_Pa = 6e6;
    CHECK_THAT(faults(scene).at(0), Catch::Contains("neighbours press on each other with one vertical stress"));
  }
  SECTION("on a mirror") {
    scene.in_situ.shear_Pa = 1e5;
    CHECK_THAT(faults(scene).at(0), Catch::Contains("cannot act on a symmetry line"));
    scene.domain.bottom = Edge::traction;
    CHECK(faults(scene).empty());
    CHECK(at(scene, 1.0, 1.0).shear == 1e5);
  }
  SECTION("not finite") {
    scene.in_situ.horizontal_Pa = Field("1e6/(Y - 200)*sqrt(50 - Y)");
    CHECK_THAT(faults(scene).at(0), Catch::Contains("Give a formula that is finite in the block."));
  }
  SECTION("loaded by a formula") {
    scene.in_situ.initialise = InSitu::Initialise::loaded;
    scene.in_situ.horizontal_Pa = Field("4e6 + 1e3*Y");
    CHECK_THAT(faults(scene).at(0), Catch::Contains("edges are loaded by one stress each"));
  }
}

}  // namespace strata
