#include "channel_flow.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

// kappa t/L^2 where the two forms take turns: either needs fewer than ten terms there.
constexpr double kSwitch = 0.1;
// kappa0 t/a^2 below which the elliptic channel is a boundary layer. Of r t, the layer leaves out 0.02 tau^2 and the
// series loses up to 5e-17/tau by round-off.
constexpr double kLayer = 1e-5;
// exp(-kNegligible) is below the last digit of anything it is added to.
constexpr double kNegligible = 45.0;

void check(const Channel& channel, double x, double t) {
  for (double value : {channel.length, channel.opening, channel.viscosity, channel.bulk_modulus})
    if (!(value > 0) || !std::isfinite(value))
      throw std::invalid_argument("length, opening, viscosity and bulk_modulus must be positive and finite");
  if (!std::isfinite(channel.rate)) throw std::invalid_argument("rate must be finite");
  if (!(x >= 0 && x <= channel.length)) throw std::invalid_argument("x is outside [0, length]");
  if (!(t >= 0) || !std::isfinite(t)) throw std::invalid_argument("t must not be negative");
}

// Third repeated integral of erfc: i3erfc(z) = (i1erfc(z) - 2 z i2erfc(z))/6 (Carslaw & Jaeger, app. II).
double i3erfc(double z) {
  const double i1 = std::exp(-z * z) / std::sqrt(pi) - z * std::erfc(z);
  return (i1 - 2 * z * i2erfc(z)) / 6;
}

// Boundary layer of the elliptic channel for tau -> 0, over r a^2/kappa0. With xi = sin(theta) and P = v/sqrt(cos
// theta) Legendre's equation is v_tau = v'' + V v, V = 1/2 + tan^2(theta)/4; with V = 1/2 frozen, to first order in it,
// v = 4 tau i2erfc(z) + (theta/4) (4 tau)^(3/2) i3erfc(z), z = theta/(2 sqrt(tau)).
double ellipse_layer(double xi, double tau) {
  if (xi >= 1) return 0.0;
  const double theta = std::asin(xi);
  const double z = theta / (2 * std::sqrt(tau));
  const double four_tau = 4 * tau;
  return (four_tau * i2erfc(z) + 0.25 * theta * four_tau * std::sqrt(four_tau) * i3erfc(z)) /
         std::sqrt(std::cos(theta));
}

}  // namespace

double i2erfc(double z) {
  return 0.25 * ((1 + 2 * z * z) * std::erfc(z) - 2 / std::sqrt(pi) * z * std::exp(-z * z));
}

double ramped_channel_by_modes(const Channel& channel, FarEnd end, double x, double t) {
  check(channel, x, t);
  const double L = channel.length;
  const double kappa = channel.diffusivity();
  const double shift = end == FarEnd::no_flux ? 0.5 : 1.0;
  double sum = 0.0;
  // At t = 0 the series still converges as n^-3; a million terms leave 1e-13 of it.
  for (int n = 0; n < 1000000; ++n) {
    const double k = (n + shift) * pi / L;
    const double decay = kappa * k * k * t;
    if (decay > kNegligible) break;
    sum += std::sin(k * x) / (k * k * k) * std::exp(-decay);
  }
  const double steady = end == FarEnd::no_flux
                            ? t - (L * x - 0.5 * x * x) / kappa
                            : t * (1 - x / L) + (0.5 * x * x - x * x * x / (6 * L) - L * x / 3) / kappa;
  return channel.rate * (steady + 2 / (kappa * L) * sum);
}

double ramped_channel_by_images(const Channel& channel, FarEnd end, double x, double t) {
  check(channel, x, t);
  if (t == 0) return 0.0;
  const double L = channel.length;
  const double b = 2 * std::sqrt(channel.diffusivity() * t);
  const double mirror = end == FarEnd::no_flux ? 1.0 : -1.0;
  double sum = 0.0;
  double sign = 1.0;
  for (int m = 0;; ++m) {
    const double near = (2 * m * L + x) / b;
    const double far = (2 * (m + 1) * L - x) / b;
    if (near * near > kNegligible) break;
    sum += sign * (i2erfc(near) + mirror * i2erfc(far));
    // A no-flux end reflects with the sign kept and the inlet with it turned; a zero-pressure end turns it as well.
    if (end == FarEnd::no_flux) sign = -sign;
  }
  return 4 * channel.rate * t * sum;
}

double ramped_channel(const Channel& channel, FarEnd end, double x, double t) {
  const double tau = channel.diffusivity() * t / (channel.length * channel.length);
  return tau > kSwitch ? ramped_channel_by_modes(channel, end, x, t) : ramped_channel_by_images(channel, end, x, t);
}

double ramped_ellipse(const Channel& channel, double x, double t) {
  check(channel, x, t);
  if (t == 0) return 0.0;
  const double scale = channel.rate * channel.length * channel.length / channel.diffusivity();
  const double tau = channel.diffusivity() * t / (channel.length * channel.length);
  const double xi = x / channel.length;
  const double reach = std::asin(std::min(xi, 1.0)) / (2 * std::sqrt(tau));
  if (tau < kLayer || reach * reach > kNegligible) return scale * ellipse_layer(xi, tau);

  double sum = 0.0;
  double P_before = 1.0;       // P_(l-1)(xi)
  double P = xi;               // P_l(xi)
  double P_before_at_0 = 1.0;  // P_(l-1)(0), l odd
  for (int l = 1; l * (l + 1.0) * tau < kNegligible; l += 2) {
    const double degree = l;
    sum += (2 * degree + 1) * P_before_at_0 / (degree * (degree + 1) * (degree + 1)) * P *
           std::exp(-degree * (degree + 1) * tau);
    P_before_at_0 *= -degree / (degree + 1);
    const double P_even = ((2 * degree + 1) * xi * P - degree * P_before) / (degree + 1);
    const double P_odd = ((2 * degree + 3) * xi * P_even - (degree + 1) * P) / (degree + 2);
    P_before = P_even;
    P = P_odd;
  }
  return scale * (tau - (std::log1p(xi) - sum));
}

}  // namespace strata::reference
