// The ramped channel: values, the two forms of the series against each other, limits, and the equation itself.
// Changes that were made to the solution and fail here: a sign in the steady part, half the sum, the images' sign, the
// elliptic layer's second term left out, doubled or turned, the layer used up to ten times its reach.
#include <gsl/gsl_sf_legendre.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <utility>

#include "channel_flow.hpp"

using namespace strata::reference;

namespace {

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

const Channel narrow;              // the study's fluid, w = 0.1 mm, L = 5 m
const Channel ellipse{5.0, 2e-4};  // the same, w0 = 0.2 mm
constexpr FarEnd kEnds[] = {FarEnd::no_flux, FarEnd::zero_pressure};

}  // namespace

TEST_CASE("known values") {
  CHECK(narrow.diffusivity() == near(1e9 * 1e-8 / 1.2, 1e-14));
  CHECK(ramped_channel(narrow, FarEnd::no_flux, 2.5, 2) == near(380203.53, 1e-8));
  CHECK(ramped_ellipse(ellipse, 2.5, 0.5) == near(94516.06, 1e-7));
  CHECK(i2erfc(0) == near(0.25, 1e-15));
}

TEST_CASE("modes and images are the same solution") {
  for (FarEnd end : kEnds)
    for (double tau : {0.03, 0.1, 0.3, 1.0})
      for (double x : {0.0, 0.7, 2.5, 4.9, 5.0}) {
        const double t = tau * 25 / narrow.diffusivity();
        const double modes = ramped_channel_by_modes(narrow, end, x, t);
        const double images = ramped_channel_by_images(narrow, end, x, t);
        CHECK(std::abs(modes - images) < 1e-12 * narrow.rate * t);
        CHECK(ramped_channel(narrow, end, x, t) == Approx(modes).epsilon(0).margin(1e-12 * narrow.rate * t));
      }
}

TEST_CASE("inlet, far end and the limits of long and short times") {
  for (FarEnd end : kEnds) {
    for (double t : {1e-12, 1e-3, 1.0, 100.0}) CHECK(ramped_channel(narrow, end, 0, t) == near(narrow.rate * t, 1e-12));
    CHECK(ramped_channel(narrow, end, 2, 0) == 0);
  }
  CHECK(std::abs(ramped_channel(narrow, FarEnd::zero_pressure, 5, 3)) < 1e-12 * narrow.rate * 3);
  const double kappa = narrow.diffusivity();
  // Long: the whole channel rises at r, behind by (r/kappa)(L x - x^2/2); or a straight line to the open end.
  CHECK(ramped_channel(narrow, FarEnd::no_flux, 5, 100) == near(0.35e6 * (100 - 12.5 / kappa), 1e-12));
  CHECK(ramped_channel(narrow, FarEnd::zero_pressure, 2.5, 1e4) == near(0.35e6 * 1e4 / 2, 1e-3));
  // Short: the half-space, to the last digit; a tiny time too.
  for (double t : {1e-12, 1e-4}) {
    const double x = std::sqrt(kappa * t);
    CHECK(ramped_channel(narrow, FarEnd::no_flux, x, t) == near(4 * 0.35e6 * t * i2erfc(0.5), 1e-12));
  }
}

TEST_CASE("the pressure solves dP/dt = kappa d2P/dx2 and no flux leaves a closed end") {
  const double kappa = narrow.diffusivity(), h = 2e-3;
  for (FarEnd end : kEnds)
    for (double t : {0.2, 2.0}) {
      const auto P = [&](double x, double time) { return ramped_channel(narrow, end, x, time); };
      const double rate = (P(1.3, t + h) - P(1.3, t - h)) / (2 * h);
      const double bend = (P(1.3 + h, t) - 2 * P(1.3, t) + P(1.3 - h, t)) / (h * h);
      CHECK(rate == near(kappa * bend, 5e-5));
      CHECK(rate > 0.02 * narrow.rate);
    }
  const double slope_end =
      (ramped_channel(narrow, FarEnd::no_flux, 5, 2) - ramped_channel(narrow, FarEnd::no_flux, 4.999, 2)) / 1e-3;
  const double slope_inlet = (ramped_channel(narrow, FarEnd::no_flux, 1e-3, 2) - 0.7e6) / 1e-3;
  CHECK(slope_inlet < -1e5);
  CHECK(std::abs(slope_end) < 2e-4 * std::abs(slope_inlet));
}

TEST_CASE("the equation holds from tiny to huge times") {
  const double kappa = narrow.diffusivity();
  for (FarEnd end : kEnds)
    for (double tau : {1e-8, 1e-4, 0.09, 0.11, 2.0, 1e5}) {
      // At a point of the boundary layer, or of the middle; differences over a share of the layer and of the time.
      const double t = tau * 25 / kappa, reach = std::min(std::sqrt(kappa * t), 2.5), x = 0.8 * reach;
      const double h = 1e-2 * reach, dt = 1e-2 * std::min(t, 25 / kappa);
      const auto P = [&](double at, double time) { return ramped_channel(narrow, end, at, time); };
      const double rate = (P(x, t + dt) - P(x, t - dt)) / (2 * dt);
      const double bend = (P(x + h, t) - 2 * P(x, t) + P(x - h, t)) / (h * h);
      CHECK(rate > 0.01 * narrow.rate);
      CHECK(std::abs(rate - kappa * bend) < 1e-4 * rate + 1e-14 * P(x, t) * (1 / dt + 4 * kappa / (h * h)));
    }
  const double per_time = ellipse.diffusivity() / 25;
  for (double tau : {1e-8, 9.9e-6, 1.01e-5, 1e-4, 10.0}) {
    const double t = tau / per_time, reach = std::min(std::sqrt(tau), 0.5), xi = 0.8 * reach;
    const double h = 1e-2 * reach, dt = 1e-2 * std::min(t, 1 / per_time);
    const auto P = [&](double at, double time) { return ramped_ellipse(ellipse, 5 * at, time); };
    const double rate = (P(xi, t + dt) - P(xi, t - dt)) / (2 * dt);
    const double flux = ((1 - std::pow(xi + h / 2, 2)) * (P(xi + h, t) - P(xi, t)) -
                         (1 - std::pow(xi - h / 2, 2)) * (P(xi, t) - P(xi - h, t))) /
                        (h * h);
    CHECK(rate > 0.01 * ellipse.rate);
    CHECK(std::abs(rate - per_time * flux) < 1e-4 * rate + 1e-13 * P(xi, t) * (1 / dt + 4 * per_time / (h * h)));
  }
}

TEST_CASE("elliptic opening: the pressure solves Legendre's equation") {
  const double rate_of = ellipse.diffusivity() / 25, h = 1e-3;
  for (double t : {0.05, 0.5, 3.0}) {
    const auto P = [&](double xi, double time) { return ramped_ellipse(ellipse, 5 * xi, time); };
    for (double xi : {0.2, 0.6}) {
      const double rate = (P(xi, t + h / 10) - P(xi, t - h / 10)) / (h / 5);
      const double flux = ((1 - std::pow(xi + h / 2, 2)) * (P(xi + h, t) - P(xi, t)) -
                           (1 - std::pow(xi - h / 2, 2)) * (P(xi, t) - P(xi - h, t))) /
                          (h * h);
      CHECK(rate == near(rate_of * flux, 2e-4));
      CHECK(rate > 1e-3 * ellipse.rate);
    }
    CHECK(P(0, t) == near(ellipse.rate * t, 1e-12));
  }
  // Long times: behind by (r a^2/kappa0) ln(1 + xi).
  CHECK(ramped_ellipse(ellipse, 5, 50) == near(0.35e6 * (50 - std::log(2.0) / rate_of), 1e-12));
}

TEST_CASE("elliptic opening at short times") {
  // Near the inlet the channel is a half-space up to a relative sqrt(tau) theta.
  const double tau = 1e-9;
  const double t = tau * 25 / ellipse.diffusivity();
  const double x = 5 * std::sqrt(tau);
  CHECK(ramped_ellipse(ellipse, x, t) == near(4 * 0.35e6 * t * i2erfc(0.5), 1e-7));
  // P/(r t) at fixed x/sqrt(t), on either side of tau = 1e-5, where the two forms meet: the series with 40 digits.
  const auto scaled = [&](double at) {
    const double time = at * 25 / ellipse.diffusivity();
    return ramped_ellipse(ellipse, 5 * std::sin(std::sqrt(at)), time) / (0.35e6 * time);
  };
  const std::pair<double, double> values[] = {{1.1e-7, 0.2798589062636332},
                                              {1e-6, 0.279859007002985},
                                              {9.9e-6, 0.2798600144010478},
                                              {1.1e-5, 0.2798601389114945},
                                              {5e-5, 0.2798645534543509}};
  for (const auto& [at, value] : values) CHECK(std::abs(scaled(at) - value) < 1e-11);
  CHECK(scaled(1e-6) == near(4 * i2erfc(0.5), 1e-5));
  // Beyond it Legendre's series, as far as it reaches, with functions of GSL: P/(r t) = 1 - (ln(1 + xi) - sum)/tau,
  // sum over odd l of (2l+1) P_(l-1)(0) P_l(xi) e^(-l(l+1) tau)/(l (l+1)^2).
  for (double at : {1e-5, 1e-4, 1e-3, 1e-2}) {
    const double xi = std::sin(std::sqrt(at));
    double sum = 0;
    for (int l = 1; l * (l + 1.0) * at < 40; l += 2)
      sum += (2 * l + 1) * gsl_sf_legendre_Pl(l - 1, 0) * gsl_sf_legendre_Pl(l, xi) * std::exp(-l * (l + 1.0) * at) /
             (l * (l + 1.0) * (l + 1.0));
    CHECK(scaled(at) == near(1 - (std::log1p(xi) - sum) / at, 1e-14 / at + 1e-11));
  }
}

TEST_CASE("arguments out of range are refused") {
  CHECK_THROWS_AS(ramped_channel(narrow, FarEnd::no_flux, 5.1, 1), std::invalid_argument);
  CHECK_THROWS_AS(ramped_channel(narrow, FarEnd::no_flux, 1, -1), std::invalid_argument);
  CHECK_THROWS_AS(ramped_ellipse(Channel{5, 0}, 1, 1), std::invalid_argument);
}
