// The two self-similar limits of the plane-strain hydraulic fracture: hand numbers, and the equations they solve.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "kgd.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {
Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}
constexpr double E_prime = 1e10 / 0.96, Q = 1e-3, mu = 0.1;
}  // namespace

TEST_CASE("toughness: K_I = K_Ic and the fluid fills the crack") {
  for (double t : {1.0, 50.0}) {
    const KgdState state = kgd_toughness(E_prime, Q, t, 1.45e6);
    CHECK(state.inlet_pressure * std::sqrt(pi * state.half_length) == near(1.45e6, 1e-13));
    CHECK(2 * pi * state.inlet_pressure * std::pow(state.half_length, 2) / E_prime == near(Q * t, 1e-13));
    CHECK(pi / 2 * state.mouth_opening * state.half_length == near(Q * t, 1e-13));
  }
  CHECK(kgd_toughness(1, 2 * std::sqrt(pi), 8, 1).half_length == near(4, 1e-13));
}

TEST_CASE("viscosity: the shape's three numbers settle with the knots") {
  const KgdViscosityShape shape, coarse(100);
  CHECK(shape.length_factor() == near(0.6155, 1e-3));
  CHECK(shape.opening(0) == near(1.1257, 1e-3));
  CHECK(shape.pressure(0) == near(0.5448, 1e-3));
  CHECK(shape.length_factor() == near(coarse.length_factor(), 3e-4));
  CHECK(shape.opening(0) == near(coarse.opening(0), 3e-4));
  CHECK(shape.pressure(0) == near(coarse.pressure(0), 3e-4));
}

TEST_CASE("viscosity: the fracture conserves mass, here and in all, and its tip is closed without toughness") {
  const KgdViscosityShape shape;
  const auto length = [&](double t) { return kgd_viscosity(shape, E_prime, Q, t, mu).half_length; };
  const auto w = [&](double x, double t) {
    return shape.opening(x / length(t)) * std::pow(12 * mu * Q * Q * Q * t * t / E_prime, 1.0 / 6);
  };
  const auto p = [&](double x, double t) {
    return shape.pressure(x / length(t)) * std::cbrt(12 * mu * E_prime * E_prime / t);
  };
  const double t = 10, l = length(t);
  const double volume = integrate([&](double x) { return w(x, t); }, -l, l, {0}, 1e-8).value;
  CHECK(volume == near(Q * t, 1e-4));
  // What enters a wing and is not stored before x passes x; q by a central difference over several knots.
  for (double xi : {0.3, 0.5, 0.7}) {
    const double x = xi * l, h = 0.15 * (l - x);
    const auto stored = [&](double time) {
      return integrate([&](double s) { return w(s, time); }, 0, x, {}, 1e-7).value;
    };
    const double passed = 0.5 * Q - (stored(t + 0.1) - stored(t - 0.1)) / 0.2;
    CHECK(passed > 0.05 * Q);
    CHECK(-std::pow(w(x, t), 3) / (12 * mu) * (p(x + h / 2, t) - p(x - h / 2, t)) / h == near(passed, 1e-2));
  }
  // Near the tip w = beta (mu' c/E')^(1/3) (l-x)^(2/3), beta = 2^(1/3) 3^(5/6), c the tip's speed.
  const double c = 2 * l / (3 * t), gap = 1e-3 * l;
  const double beta = std::cbrt(2.0) * std::pow(3.0, 5.0 / 6);
  CHECK(w(l - gap, t) == near(beta * std::cbrt(12 * mu * c / E_prime) * std::pow(gap, 2.0 / 3), 1e-2));
}

TEST_CASE("the toughness number, and what is refused") {
  CHECK(kgd_toughness_number(1, 1, 1.0 / 12, 1) == near(4 * std::sqrt(2 / pi), 1e-14));
  CHECK_THROWS_AS(kgd_toughness(1, 0, 1, 1), std::invalid_argument);
  CHECK_THROWS_AS(kgd_viscosity(KgdViscosityShape(60), 1, 1, -1, 1), std::invalid_argument);
  CHECK_THROWS_AS(KgdViscosityShape(20), std::invalid_argument);
}
