#include "scene/formula.hpp"

#include <cmath>
#include <numbers>

#include "scene_text.hpp"

using namespace strata;
using namespace scene_test;

namespace {

const std::vector<std::string> names{"X", "Y", "t"};

double value(const std::string& text, double x, double y, double time) {
  const std::vector<double> X{x}, Y{y}, t{time};
  CAPTURE(text);
  REQUIRE_FALSE(fault_in_formula(text, names));
  const std::vector<double> values = evaluate_formula(text, {{"X", X}, {"Y", Y}, {"t", t}});
  REQUIRE(values.size() == 1);
  return values[0];
}

std::string fault(const std::string& text) {
  const auto found = fault_in_formula(text, names);
  CAPTURE(text);
  REQUIRE(found);
  return *found;
}

// The scene above without inertia, fracture or inlet, with the given lines at its end.
std::string block(const std::string& lines) {
  std::string text = with(
      layered, "[fracture]\npath_m = [[40, 0], [40, 5]]\n[fluid]\ninlet = {start_Pa = 2e6, rate_Pa_s = 0.35e6}\n", "");
  return with(text, "inlet_Pa = 4e6", "time_s = 1") + lines;
}

}  // namespace

// Requires values by hand, at every place its own. Mutations that fail: X and Y exchanged, the first value for all.
TEST_CASE("A formula has the value of its variables") {
  CHECK(value("2", 1, 2, 3) == 2.0);
  CHECK(value("X + 10*Y + 100*t", 1, 2, 3) == 321.0);
  CHECK(value("-X^2", 3, 0, 0) == -9.0);
  CHECK(value("2^3^2", 0, 0, 0) == 512.0);
  CHECK(value("6/2*3 - 4 - 1", 0, 0, 0) == 4.0);
  CHECK(value("1e-3*X", 4, 0, 0) == 0.004);
  CHECK(value("X <= 1 ? 5 : 7", 1, 0, 0) == 5.0);
  CHECK(value("X == 1 && Y != 1 ? 5 : 7", 1, 1, 0) == 7.0);
  CHECK(value("sin(pi*X)*cos(pi/3)", 0.5, 0, 0) == Approx(0.5).epsilon(1e-15));
  CHECK(value("exp(-ln(Y)) + sqrt(X) + abs(-t) + min(X, Y) + max(X, Y)", 4, 2, 3) == Approx(0.5 + 2 + 3 + 2 + 4));
  CHECK(std::isnan(value("sqrt(X)", -1, 0, 0)));
  CHECK(std::isinf(value("1/X", 0, 0, 0)));
  const std::vector<double> X{1, 2, 3}, Y{4, 5, 6};
  CHECK(evaluate_formula("X*Y", {{"X", X}, {"Y", Y}}) == std::vector<double>{4, 10, 18});
  CHECK(evaluate_formula("7", {{"X", X}, {"Y", Y}}) == std::vector<double>{7, 7, 7});
}

TEST_CASE("What is wrong with a formula is said with its place") {
  CHECK_THAT(fault("sin(x)"), Catch::Contains("there is no x at character 5. A formula may use X, Y, t, pi,"));
  CHECK_THAT(fault("sin(x)"), Catch::EndsWith("Did you mean X?"));
  CHECK_THAT(fault("2*sinn(X)"), Catch::Contains("there is no sinn at character 3") && Catch::EndsWith("mean sin?"));
  CHECK_THAT(fault("_pi*X"), Catch::Contains("there is no _pi at character 1"));
  CHECK_THAT(fault("X +"), Catch::Contains("at character 4: ") || Catch::Contains("Unexpected end"));
  CHECK_THAT(fault("(X"), Catch::Contains("arenthesis") || Catch::Contains("parens"));
  CHECK_THAT(fault("2 X"), Catch::Contains("at character 3"));
  CHECK_THAT(fault("X = 3"), Catch::Contains("at character 3: Unexpected operator \"=\" found. Use == to compare."));
  CHECK_THAT(fault("X, Y"), Catch::Contains("it has 2 values"));
  CHECK_THAT(fault(""), Catch::Contains("it is empty"));
  CHECK_THAT(fault("  "), Catch::Contains("it is empty"));
  CHECK_THAT(fault("\"X\""), Catch::Contains("at character") || Catch::Contains("string"));
  CHECK(fault_in_formula("t", {"X", "Y"}));
  CHECK_FALSE(fault_in_formula("1/(X - 0.5)", names));
}

TEST_CASE("Formulas that are never checked are a bug") {
  const std::vector<double> X{1};
  CHECK_THROWS_AS(evaluate_formula("Z", {{"X", X}}), std::logic_error);
}

TEST_CASE("Formulas of a scene are read, numbers among them, and resolved") {
  CHECK_FALSE(good(block("")).body.acceleration_m_s2);
  CHECK_FALSE(good(block("")).initial.velocity_m_s);
  CHECK(good(block("")).resolved_toml.find("acceleration") == std::string::npos);
  const std::string lines =
      "[body]\nacceleration_m_s2 = [\"X*sin(pi*Y)\", -9.81]\n[initial]\nvelocity_m_s = [1, \"Y\"]\n";
  const Scene scene = good(block(lines));
  CHECK(scene.body.acceleration_m_s2 == Formulas{"X*sin(pi*Y)", "-9.81"});
  CHECK(scene.initial.velocity_m_s == Formulas{"1.0", "Y"});
  const ReadResult again = read_scene_text(scene.resolved_toml, "runs/x/scene.toml", "", {});
  CAPTURE(again.errors, scene.resolved_toml);
  REQUIRE(again.scene);
  CHECK(*again.scene == scene);
  CHECK(good(block(lines), "", {"body.acceleration_m_s2=[\"t\", \"0\"]"}).body.acceleration_m_s2 == Formulas{"t", "0"});
}

TEST_CASE("Faults of formulas are scene errors with their places, all in one pass") {
  const std::string text =
      errors(block("[body]\nacceleration_m_s2 = [\"sin(x)\", \"Y +\"]\n[initial]\nvelocity_m_s = [\"t\", true]\n"));
  CHECK_THAT(text, Catch::Contains(
                       ":22: body.acceleration_m_s2[0] = \"sin(x)\" is not a formula: there is no x at character 5"));
  CHECK_THAT(text, Catch::Contains("body.acceleration_m_s2[1] = \"Y +\" is not a formula: "));
  CHECK_THAT(text, Catch::Contains("initial.velocity_m_s[0] = \"t\" is not a formula: there is no t at character 1"));
  CHECK_THAT(text, Catch::Contains("initial.velocity_m_s[1] = true is not a formula. Put it in quotes."));
  CHECK_THAT(errors(block("[body]\nacceleration_m_s2 = \"X\"\n")), Catch::Contains("is not a pair of formulas"));
  CHECK_THAT(errors(block("[body]\nacceleration_m_s2 = [\"X\"]\n")), Catch::Contains("is not a pair of formulas"));
  CHECK_THAT(errors(block("[body]\nacceleration_m_s2 = [1, inf]\n")), Catch::Contains("is not finite"));
  CHECK_THAT(errors(block("[initial]\nvelocity_m_s = [\"X\", \"Y\"]\n"), "", {"numerics.mechanics=quasistatic"}),
             Catch::Contains("needs inertia, but mechanics = \"quasistatic\""));
}
