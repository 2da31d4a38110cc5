// Paths of growing cracks: first turn, symmetry, pressures, what increments and rules of turning do.
//
// Mutations run against these checks: turn with the opposite sign (first turn), smaller root of the quadratic
// (pressure), in-situ stresses exchanged (Experiments 5 and 6), no corrector (no shear left).
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "bimaterial.hpp"
#include "crack_path.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {

constexpr double kDegrees = 180 / pi;
const Rock stiff{10e9, 0.2};
const Rock soft{5e9, 0.2};
const std::vector<Point> start{0, Point(0, 5)};
const CrackPlane exp5{soft, stiff, 5, true};
const CrackPlane exp6{stiff, soft, 5, true};
const InSituStress stress5{-2e6, -3e6};
const InSituStress stress6{-2e6, -1e6};

GrowthRule rule(double toughness, double increment, double growth, bool corrected = true) {
  GrowthRule r;
  r.toughness = toughness;
  r.increment = increment;
  r.stop_growth = growth;
  r.corrected = corrected;
  return r;
}

std::vector<Point> tips(const GrownPath& grown) {
  std::vector<Point> points;
  for (const PathStep& step : grown.steps) points.push_back(step.tip);
  return points;
}

// x where the path crosses height y.
double x_at(const GrownPath& grown, double y) {
  for (std::size_t i = 1; i < grown.steps.size(); ++i) {
    const Point a = grown.steps[i - 1].tip, b = grown.steps[i].tip;
    if (b.imag() >= y) return a.real() + (y - a.imag()) / (b.imag() - a.imag()) * (b.real() - a.real());
  }
  FAIL("the path does not reach the height");
  return 0;
}

}  // namespace

TEST_CASE("Experiments 5 and 6 start as the parallel crack does") {
  const Function p = [](double) { return 1.0; };
  const auto check = [&](const CrackPlane& plane, const InSituStress& stress, double toughness, double degrees) {
    const auto first = grow_path(start, plane, stress, rule(toughness, 1, 1)).steps.front();
    CHECK(first.turn * kDegrees == Approx(degrees).margin(0.005));
    const auto K = BondedCrack({5, 5, 0}, plane.rock, *plane.beyond, p).line().at_plus();
    CHECK(first.pressure == Approx(2e6 + toughness / std::hypot(K.K_I, K.K_II)).epsilon(1e-5));
    CHECK(std::hypot(first.K.K_I, first.K.K_II) == Approx(toughness).epsilon(1e-9));
  };
  check(exp5, stress5, 1.25e6, 2.82);
  check(exp6, stress6, 1.45e6, -3.31);
}

TEST_CASE("without an interface a path stays straight, and pressures are Griffith's") {
  GrowthRule straight = rule(1.45e6, 1, 10, false);
  straight.hold_pressure = false;
  const GrownPath grown = grow_path(start, {stiff, {}, 0, true}, stress5, straight);
  CHECK(grown.stopped == "growth");
  REQUIRE(grown.steps.size() == 11);
  for (const PathStep& step : grown.steps) {
    CHECK(std::abs(step.tip.real()) < 1e-6);
    CHECK(step.pressure == Approx(2e6 + 1.45e6 / std::sqrt(pi * step.tip.imag())).epsilon(1e-5));
  }
  // A profile that falls to nothing at the tip: K = P (1 - 2/pi) sqrt(pi a) - 2 MPa sqrt(pi a).
  straight.linear_profile = true;
  const double a = 5, least = (1.45e6 / std::sqrt(pi * a) + 2e6) / (1 - 2 / pi);
  CHECK(grow_path(start, {stiff, {}, 0, true}, stress5, straight).steps.front().pressure ==
        Approx(least).epsilon(3e-4));  // the profile's kink at y = 0 is not resolved further
}

TEST_CASE("the interface on the other side mirrors the path") {
  const auto right = tips(grow_path(start, exp6, stress6, rule(1.45e6, 0.5, 4)));
  const auto left = tips(grow_path(start, {stiff, soft, -5, true}, stress6, rule(1.45e6, 0.5, 4)));
  REQUIRE(left.size() == right.size());
  for (std::size_t i = 0; i < left.size(); ++i) CHECK(std::abs(left[i] + std::conj(right[i])) < 1e-6);
}

TEST_CASE("Experiment 5: the corrected path converges, the forward one zigzags unless increments are small") {
  const GrownPath coarse = grow_path(start, exp5, stress5, rule(1.25e6, 1, 8));
  const GrownPath fine = grow_path(start, exp5, stress5, rule(1.25e6, 0.5, 8));
  CHECK(path_distance(tips(coarse), tips(fine)) < 2e-3);
  for (std::size_t i = 1; i < fine.steps.size(); ++i)
    CHECK(std::abs(fine.steps[i].K.K_II) < 1e-5 * fine.steps[i].K.K_I);
  CHECK(x_at(fine, 12.9) == Approx(-0.1694).epsilon(5e-3));
  // Growth away from the stiff rock, ever faster than straight at the held pressure.
  for (std::size_t i = 1; i < fine.steps.size(); ++i) {
    CHECK(fine.steps[i].tip.real() < fine.steps[i - 1].tip.real());
    CHECK(fine.steps[i].K.K_I > fine.steps[i - 1].K.K_I);
  }
  const auto turns_back = [](const GrownPath& grown) {
    int count = 0;
    for (std::size_t i = 1; i < grown.steps.size(); ++i) count += grown.steps[i].turn * grown.steps[i - 1].turn < 0;
    return count;
  };
  const GrownPath forward = grow_path(start, exp5, stress5, rule(1.25e6, 1, 8, false));
  CHECK(turns_back(forward) == 8);
  CHECK(std::abs(forward.steps[4].turn) > 2 * std::abs(forward.steps[1].turn));  // and grows
}

TEST_CASE("Experiment 6: the path turns to the soft rock and lies down") {
  const GrownPath grown = grow_path(start, exp6, stress6, rule(1.45e6, 0.25, 20, false));
  CHECK(grown.stopped == "interface");
  CHECK(grown.steps.back().tip.real() > 4);
  CHECK(grown.steps.back().direction * kDegrees < 20);
}

TEST_CASE("distance between paths, and what is refused") {
  CHECK(path_distance({Point(1, 1), Point(2, 3)}, {0, Point(0, 4)}) == Approx(2));
  CHECK(path_distance({Point(1, 1), Point(2, 5)}, {0, Point(0, 4)}) == Approx(1));  // past its end
  CHECK_THROWS_AS(path_distance({}, {0, 1}), std::invalid_argument);
  CHECK_THROWS_AS(grow_path(start, exp5, stress5, rule(-1, 1, 1)), std::invalid_argument);
  CHECK_THROWS_AS(grow_path(start, exp5, stress5, rule(1e6, 0, 1)), std::invalid_argument);
  CHECK_THROWS_AS(grow_path(start, {soft, stiff, 0, true}, stress5, rule(1e6, 1, 1)), std::invalid_argument);
}
