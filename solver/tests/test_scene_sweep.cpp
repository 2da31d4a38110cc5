// The runs of a sweep: the latin hypercube's strata, and what a text gives. verification/tests/test_sweep.py has the
// rest.
#include <catch2/catch.hpp>
#include <cmath>
#include <set>

#include "scene/sweep.hpp"
#include "scene/toml_reader.hpp"

using namespace strata;

TEST_CASE("A latin hypercube has one point in each stratum of each axis", "[sweep]") {
  for (const std::size_t count : {1u, 2u, 7u, 100u, 1000u}) {
    for (const std::uint64_t seed : {0u, 1u, 12345u}) {
      const auto points = latin_hypercube(count, 3, seed);
      for (std::size_t axis = 0; axis < 3; ++axis) {
        std::set<double> strata;
        for (const auto& point : points) strata.insert(std::floor(point[axis] * static_cast<double>(count)));
        CHECK(strata.size() == count);
        CHECK(*strata.begin() == 0.0);
        CHECK(*strata.rbegin() == static_cast<double>(count - 1));
      }
    }
  }
}

TEST_CASE("A latin hypercube pairs the strata of its axes at random, and fills each evenly", "[sweep]") {
  constexpr std::size_t count = 2000;
  const auto points = latin_hypercube(count, 2, 3), others = latin_hypercube(count, 2, 4);
  CHECK(points == latin_hypercube(count, 2, 3));
  CHECK(points != others);
  // Independent axes: the mean of (x - 1/2)(y - 1/2) is 0 with a deviation of 1/(12 sqrt(n)), that of the place within
  // a stratum 1/2 with one of 1/sqrt(12 n), that of its square from there 1/12 with one of 1/sqrt(180 n). Four
  // deviations are asked for.
  double product = 0.0, within = 0.0, square = 0.0;
  for (const auto& point : points) {
    product += (point[0] - 0.5) * (point[1] - 0.5) / count;
    const double place = point[0] * count - std::floor(point[0] * count);
    within += place / count;
    square += (place - 0.5) * (place - 0.5) / count;
  }
  CHECK(std::abs(product) < 4.0 / (12.0 * std::sqrt(count)));
  CHECK(std::abs(within - 0.5) < 4.0 / std::sqrt(12.0 * count));
  CHECK(std::abs(square - 1.0 / 12.0) < 4.0 / std::sqrt(180.0 * count));
}

TEST_CASE("A scene without a sweep has no runs, and one with a sweep is read as its base", "[sweep]") {
  const std::string base = R"(
domain = {width_m = 8, height_m = 8}
rock.stiff.youngs_modulus_Pa = 10e9
strata.layers = [{rock = "stiff"}]
numerics = {mechanics = "quasistatic", cell_m = 1}
stop.time_s = 0
)";
  CHECK(list_sweep(base, "a.toml").lines.empty());
  CHECK(list_sweep(base, "a.toml").errors.empty());
  const std::string swept = base + "[sweep]\nrock.stiff.youngs_modulus_Pa = [1e9, 2e9]\nnumerics.cell_m = [1, 2]\n";
  const Found list = list_sweep(swept, "a.toml");
  REQUIRE(list.errors.empty());
  REQUIRE(list.lines.size() == 4);
  CHECK(list.lines[1].find("\"2000000000_1\"") == std::string::npos);  // the last axis changes fastest
  CHECK(list.lines[1].find("\"1000000000_2\"") != std::string::npos);
  CHECK(read_scene_text(swept, "a.toml", "", {}).scene == read_scene_text(base, "a.toml", "", {}).scene);
  const Found refused = list_sweep(swept + "domain.width_m = [8, 9]\n", "a.toml");
  REQUIRE(refused.errors.size() == 1);
  CHECK(refused.errors[0].starts_with("a.toml:9:23: numerics.cell_m = 2 does not divide"));
}

// Requires an element of a list to be swept under its name in quotes, and one without them to be told how. Mutation
// that fails: the table taken for a range, of which "from" is missing.
TEST_CASE("A sweep reaches an element of a list by its name in quotes", "[sweep]") {
  const std::string base = R"(
domain = {width_m = 8, height_m = 8}
rock.stiff.youngs_modulus_Pa = 10e9
strata.layers = [{rock = "stiff", horizontal_Pa = 1e6}]
numerics = {mechanics = "quasistatic", cell_m = 1}
stop.time_s = 0
[sweep]
)";
  const Found list = list_sweep(base + "\"strata.layers[0].horizontal_Pa\" = [2e6, 3e6]\n", "a.toml");
  REQUIRE(list.errors.empty());
  REQUIRE(list.lines.size() == 2);
  CHECK_THAT(list.lines[1], Catch::Contains("strata.layers[0].horizontal_Pa=3000000.0"));
  const Found bare = list_sweep(base + "strata.layers.0.horizontal_Pa = {from = 1e6, to = 2e6, count = 2}\n", "a.toml");
  REQUIRE(bare.errors.size() == 1);
  CHECK_THAT(bare.errors[0],
             Catch::Contains("counted from 0, in quotes: \"strata.layers[0].horizontal_Pa\" = [values]"));
}
