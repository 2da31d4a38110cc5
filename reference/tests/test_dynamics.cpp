// Wave speeds, the suddenly pressurised crack and standing waves.
// Changes that were made to the solution and fail here: 1 - nu for 1 - 2 nu in Freund's constant, half of it, a sign in
// Rayleigh's function, the two standing waves exchanged.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "dynamics.hpp"
#include "quadrature.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {
Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}
const Rock stiff;
}  // namespace

TEST_CASE("wave speeds of the stiff rock") {
  const WaveSpeeds c = wave_speeds(stiff, 2500);
  CHECK(c.c_P == near(2108.185, 1e-6));
  CHECK(c.c_S == near(1290.994, 1e-6));
  CHECK(c.c_R == near(1176.091, 1e-6));
  CHECK(2500 * c.c_P * c.c_P == near(10e9 * 0.8 / (1.2 * 0.6), 1e-14));
  for (double nu : {0.0, 0.25, 0.49}) {
    const WaveSpeeds s = wave_speeds({10e9, nu}, 2500);
    const double alpha_S = std::sqrt(1 - std::pow(s.c_R / s.c_S, 2)),
                 alpha_P = std::sqrt(1 - std::pow(s.c_R / s.c_P, 2));
    CHECK(4 * alpha_P * alpha_S == near(std::pow(1 + alpha_S * alpha_S, 2), 1e-12));
  }
  // nu = 1/4: (c_R/c_S)^2 = 2 - 2/sqrt(3).
  const WaveSpeeds quarter = wave_speeds({10e9, 0.25}, 2500);
  CHECK(quarter.c_R / quarter.c_S == near(std::sqrt(2 - 2 / std::sqrt(3.0)), 1e-13));
}

TEST_CASE("Freund's step pressure") {
  CHECK(freund_step_pressure(stiff, 2500, 1e6, 1e-4) == near(0.501643e6, 1e-6));
  CHECK(freund_step_pressure(stiff, 2500, 1e6, 4e-4) == near(2 * 0.501643e6, 1e-6));
  CHECK(freund_step_pressure(stiff, 2500, 1e6, 0) == 0);
}

TEST_CASE("Freund's constant from the Wiener-Hopf factor of the half-plane") {
  // K_I = 2 p sqrt(2 t/pi) sqrt(a)/(c S+), a = 1/c_P, b = 1/c_S, c = 1/c_R,
  // ln S+ = -(1/pi) int_a^b atan[4 h^2 sqrt((h^2-a^2)(b^2-h^2))/(b^2-2h^2)^2] dh/h (Freund 1990, chapter 2).
  for (double nu : {0.1, 0.2, 0.35}) {
    const WaveSpeeds s = wave_speeds({10e9, nu}, 2500);
    const double a = 1 / s.c_P, b = 1 / s.c_S, c = 1 / s.c_R;
    const auto f = [&](double h) {
      const double root = std::sqrt(std::max(0.0, (h * h - a * a) * (b * b - h * h)));
      return std::atan2(4 * h * h * root, std::pow(b * b - 2 * h * h, 2)) / h;
    };
    const double S = std::exp(-integrate(f, a, b, {b / std::sqrt(2.0)}, 1e-10).value / pi);
    const double K = 2 * std::sqrt(2 * 1e-4 / pi) * std::sqrt(a) / (c * S);
    CHECK(freund_step_pressure({10e9, nu}, 2500, 1, 1e-4) == near(K, 1e-8));
  }
}

TEST_CASE("standing waves solve Navier's equations") {
  const StandingWaves f = standing_waves(stiff, 2500, 1);
  CHECK(f.dilatation == near(2981.424, 1e-6));
  CHECK(f.shear == near(1825.742, 1e-6));
  CHECK(standing_waves(stiff, 2500, 2).shear == near(1825.742 / 2, 1e-6));
  // rho w^2 A = k^2 ((lambda + 3 mu) A + (lambda + mu) B) from the body force that such a motion would need.
  const double k = 2 * pi, mu = stiff.shear_modulus(), lambda = 2 * mu * 0.2 / 0.6;
  for (double B : {1.0, -1.0}) {
    const double w = 2 * pi * (B > 0 ? f.dilatation : f.shear);
    CHECK(2500 * w * w == near(k * k * (lambda + 3 * mu + (lambda + mu) * B), 1e-12));
  }
}

TEST_CASE("the standing wave itself, differenced, balances momentum, and slides along the walls") {
  const double rho = 2500, mu = stiff.shear_modulus(), lambda = 2 * mu * 0.2 / 0.6, h = 2e-3;
  const StandingWaves f = standing_waves(stiff, rho, 1);
  for (double B : {1.0, -1.0}) {
    const double omega = 2 * pi * (B > 0 ? f.dilatation : f.shear), k = 2 * pi;
    const auto u = [&](double x, double y, double t) {
      return std::pair{std::sin(k * x) * std::cos(k * y) * std::cos(omega * t),
                       B * std::cos(k * x) * std::sin(k * y) * std::cos(omega * t)};
    };
    const double x = 0.31, y = 0.17, t = 0.1 / omega, dt = h / omega;
    const auto centre = u(x, y, t), left = u(x - h, y, t), right = u(x + h, y, t), below = u(x, y - h, t),
               above = u(x, y + h, t);
    const double u_xx = (right.first - 2 * centre.first + left.first) / (h * h);
    const double u_yy = (above.first - 2 * centre.first + below.first) / (h * h);
    const double v_xy = (u(x + h, y + h, t).second - u(x + h, y - h, t).second - u(x - h, y + h, t).second +
                         u(x - h, y - h, t).second) /
                        (4 * h * h);
    const double u_tt = (u(x, y, t + dt).first - 2 * centre.first + u(x, y, t - dt).first) / (dt * dt);
    CHECK(rho * u_tt == near((lambda + 2 * mu) * u_xx + mu * u_yy + (lambda + mu) * v_xy, 1e-4));
    CHECK(std::abs(u_tt) > 0.1 * omega * omega * std::abs(centre.first));
    CHECK(std::abs(u(1, y, t).first) < 1e-12);
    CHECK(std::abs((u(1, y + h, t).first - u(1, y - h, t).first) + (u(1 + h, y, t).second - u(1 - h, y, t).second)) <
          1e-12);
  }
}

TEST_CASE("rocks that cannot be meant are refused") {
  CHECK_THROWS_AS(wave_speeds({0, 0.2}, 2500), std::invalid_argument);
  CHECK_THROWS_AS(wave_speeds({1e9, 0.5}, 2500), std::invalid_argument);
  CHECK_THROWS_AS(freund_step_pressure(stiff, 2500, 1, -1), std::invalid_argument);
}
