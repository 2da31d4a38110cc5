// The plane-strain hydraulic fracture with Carter leak-off: others' values, the four vertices, its own volume by
// another integral, refinement; and the fracture without viscosity, before and after shut-in, by which it is met at
// large toughness.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "kgd_leakoff.hpp"
#include "quadrature.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {

constexpr double E_prime = 20e9 / 0.96, Q = 5e-5, mu = 0.01, K_Ic = 1e6;

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

// The toughness (Pa sqrt(m)) of a toughness number, and the time (s) of a leak-off number sigma.
double toughness_of(double number) {
  return number * K_Ic / kgd_toughness_number(E_prime, Q, mu, K_Ic);
}
double time_of(double sigma, double C_L) {
  return std::pow(sigma / (2 * C_L), 6) * 12 * mu * std::pow(Q, 3) / E_prime;
}

// Leaked by both wings until t (m^2) by a fracture that stops at `end`: 4 C' int sqrt(t - t_0) dx is by parts
// 4 C' [l sqrt(t - end) + int_0^end l/(2 sqrt(t - s)) ds], here with s = end y^3, y = 1 - z^2, in which it is smooth.
double leaked_by_length(const std::function<double(double)>& length, double C_L, double t, double end) {
  const auto f = [&](double z) {
    const double y = 1 - z * z, s = end * y * y * y;
    return length(s) * 3 * end * y * y * z / std::sqrt(t - s);
  };
  return 8 * C_L * (length(end) * std::sqrt(t - end) + integrate(f, 0, 1, {}, 1e-5).value);
}

}  // namespace

TEST_CASE("leak-off: length, opening and efficiency of the approximation of Dontsov 2017, to its half per cent") {
  struct Row {
    double C_L, length, opening, efficiency;
  };
  for (const Row& row :
       {Row{0, 19.712, 0.8695e-3, 1}, Row{1e-6, 18.406, 0.8400e-3, 0.902}, Row{1e-5, 10.865, 0.6432e-3, 0.408}}) {
    const SettledLeakoff found = kgd_leakoff(E_prime, Q, 500, mu, K_Ic, row.C_L);
    CHECK(found.state.half_length == near(row.length, 5e-3));
    CHECK(found.state.mouth_opening == near(row.opening, 5e-3));
    CHECK(found.state.efficiency == near(row.efficiency, 6e-3));
    CHECK(found.error < 5e-5);
  }
}

TEST_CASE("leak-off: without it the self-similar fracture, and near that at early times") {
  const KgdState exact = kgd_fracture(KgdShape(kgd_toughness_number(E_prime, Q, mu, K_Ic), 800), E_prime, Q, 500, mu);
  const auto matches = [&](double C_L, double within) {
    const KgdLeakoffState found = kgd_leakoff(E_prime, Q, 500, mu, K_Ic, C_L).state;
    CHECK(found.half_length == near(exact.half_length, within));
    CHECK(found.mouth_opening == near(exact.mouth_opening, within));
    CHECK(found.inlet_pressure == near(exact.inlet_pressure, within));
    return exact.half_length - found.half_length;
  };
  matches(0, 1e-5);
  CHECK(matches(2e-9, 2e-4) == near(2 * matches(1e-9, 1e-4), 0.02));  // shorter as C_L
}

TEST_CASE("leak-off: the four vertices") {
  constexpr double C_L = 1e-5, C = 2 * C_L, mu_prime = 12 * mu;
  const auto at = [&](double number, double sigma) {
    return kgd_leakoff(E_prime, Q, time_of(sigma, C_L), mu, toughness_of(number), C_L).state;
  };
  // Storage and viscosity, storage and toughness: what leaks is of the order of sigma.
  double t = time_of(1e-5, C_L);
  KgdLeakoffState found = at(0, 1e-5);
  CHECK(found.half_length ==
        near(0.6155 * std::pow(std::pow(Q, 3) * E_prime * std::pow(t, 4) / mu_prime, 1.0 / 6), 1e-3));
  CHECK(found.mouth_opening == near(1.1257 * std::pow(mu_prime * std::pow(Q, 3) * t * t / E_prime, 1.0 / 6), 1e-3));
  found = at(20, 1e-5);
  const KgdState tough = kgd_toughness(E_prime, Q, t, toughness_of(20));
  CHECK(found.half_length == near(tough.half_length, 1e-4));
  CHECK(found.mouth_opening == near(tough.mouth_opening, 1e-4));
  // All leaks off: the same length, and an opening by viscosity or by toughness. sigma = 1000 stores 1e-5 to 1e-4.
  t = time_of(1000, C_L);
  const double length = Q * std::sqrt(t) / (pi * C);
  found = at(0, 1000);
  CHECK(found.half_length == near(length, 1e-3));
  CHECK(found.mouth_opening == near(0.8165 * std::pow(mu_prime * std::pow(Q, 3) * t / (E_prime * C * C), 0.25), 1e-3));
  CHECK(found.efficiency < 2e-5);
  found = at(20, 1000);
  const double K_prime = std::sqrt(32 / pi) * toughness_of(20);
  CHECK(found.half_length == near(length, 1e-3));
  CHECK(found.mouth_opening ==
        near(0.3989 * std::pow(std::pow(K_prime, 4) * Q * Q * t / (std::pow(E_prime, 4) * C * C), 0.25), 1e-3));
}

TEST_CASE("leak-off: what its length lets leak off and what it holds are what was injected") {
  constexpr double C_L = 1e-5;
  for (const double number : {0.0, 1.2}) {
    const auto once = [&](double t) { return kgd_leakoff_once(E_prime, Q, t, mu, toughness_of(number), C_L, 60, 16); };
    const auto length = [&](double t) { return t > 0 ? once(t).half_length : 0; };
    for (const double t : {20.0, 500.0})
      CHECK(leaked_by_length(length, C_L, t, t) == near((1 - once(t).efficiency) * Q * t, 2e-4));
  }
}

TEST_CASE("leak-off: the error falls with the square of steps and knots") {
  const auto once = [&](int knots, int steps) {
    return kgd_leakoff_once(E_prime, Q, time_of(3, 1e-5), mu, K_Ic, 1e-5, knots, steps);
  };
  const auto order = [](double coarse, double middle, double fine) {
    CHECK((middle - coarse) / (fine - middle) == near(4, 0.2));
  };
  order(once(60, 64).efficiency, once(60, 128).efficiency, once(60, 256).efficiency);
  order(once(60, 16).efficiency, once(120, 16).efficiency, once(240, 16).efficiency);
  order(once(60, 16).half_length, once(120, 16).half_length, once(240, 16).half_length);
}

TEST_CASE("leak-off: at large toughness the fracture under a uniform pressure, an independent solution") {
  for (const double sigma : {0.1, 1.0, 10.0}) {
    const double t = time_of(sigma, 1e-5), K = toughness_of(20);
    const KgdLeakoffState found = kgd_leakoff(E_prime, Q, t, mu, K, 1e-5).state;
    const ShutInState uniform = shut_in_fracture(E_prime, Q, t, K, 1e-5, t);
    CHECK(found.half_length == near(uniform.half_length, 5e-5));
    CHECK(found.mouth_opening == near(uniform.mouth_opening, 1e-4));
    CHECK(found.inlet_pressure == near(uniform.inlet_pressure, 1e-4));
    CHECK(found.efficiency == near(uniform.efficiency, 1e-4));
  }
}

TEST_CASE("shut-in: the toughness vertex, volume by another integral, and the fall-off") {
  const ShutInState tight = shut_in_fracture(E_prime, Q, 500, K_Ic, 0, 800);
  const KgdState exact = kgd_toughness(E_prime, Q, 500, K_Ic);
  CHECK(tight.half_length == near(exact.half_length, 1e-9));
  CHECK(tight.inlet_pressure == near(exact.inlet_pressure, 1e-9));
  CHECK(tight.mouth_opening == near(exact.mouth_opening, 1e-9));

  constexpr double C_L = 1e-6, end = 500;
  const auto at = [&](double t) { return shut_in_fracture(E_prime, Q, end, K_Ic, C_L, t); };
  const auto length = [&](double t) { return t > 0 ? at(t).half_length : 0; };
  for (const double t : {100.0, 500.0, 700.0, 1500.0}) {
    INFO("t = " << t);
    const ShutInState found = at(t);
    const double l = found.half_length, fed = Q * std::min(t, end);
    CHECK(found.leaked == near(leaked_by_length(length, C_L, t, std::min(t, end)), 1e-5));
    CHECK(2 * pi * found.inlet_pressure * l * l / E_prime + found.leaked == near(fed, 1e-12));
    if (t <= end) CHECK(found.inlet_pressure * std::sqrt(pi * l) == near(K_Ic, 1e-5));
    if (t >= end) CHECK(l == at(end).half_length);
  }
  // Where nearly all has leaked off x goes by sqrt(t_0), and after shut-in int_0^l sqrt(t - t_0) dx is
  // (l/2) [sqrt(t - t_s) + t/sqrt(t_s) asin(sqrt(t_s/t))].
  const auto leaky = [](double t) { return shut_in_fracture(E_prime, Q, end, 1e4, 1e-4, t); };
  const double t = end + 1e-3, l = leaky(end).half_length;
  const double more =
      8e-4 * l / 2 *
      (std::sqrt(t - end) + t / std::sqrt(end) * std::asin(std::sqrt(end / t)) - std::sqrt(end) * pi / 2);
  CHECK(leaky(t).leaked - leaky(end).leaked == near(more, 2e-2));
  CHECK(shut_in_fracture(E_prime, Q, end, K_Ic, 1e-5, 5000).inlet_pressure == 0);
}

TEST_CASE("leak-off: what is refused") {
  CHECK_THROWS_AS(kgd_leakoff_once(E_prime, Q, 500, mu, K_Ic, -1e-6, 80, 24), std::invalid_argument);
  CHECK_THROWS_AS(kgd_leakoff_once(E_prime, Q, 0, mu, K_Ic, 1e-6, 80, 24), std::invalid_argument);
  CHECK_THROWS_AS(kgd_leakoff_once(E_prime, Q, 500, mu, K_Ic, 1e-6, 80, 2), std::invalid_argument);
  CHECK_THROWS_AS(shut_in_fracture(E_prime, Q, 500, 0, 1e-6, 600), std::invalid_argument);
  CHECK_THROWS_AS(shut_in_fracture(E_prime, Q, 500, K_Ic, 1e-6, 600, 9), std::invalid_argument);
}
