#include "interface_springs.hpp"

#include <gsl/gsl_sf_expint.h>

#include <array>
#include <cmath>
#include <complex>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

// J_m = int_0^inf e^(-k s) k^m k/(k + c) dk for m = 0, 1, 2.
std::array<double, 3> released(double s, double c) {
  if (std::isinf(c)) return {0, 0, 0};
  const double cs = c * s;
  if (cs < 40) {
    // k^(m+1)/(k+c) divided out; the rest is e^(cs) E_1(cs), zero with c.
    const double G = cs == 0 ? 0.0 : c * gsl_sf_expint_E1_scaled(cs);
    const double J_0 = 1 / s - G;
    const double J_1 = 1 / (s * s) - c * J_0;
    return {J_0, J_1, 2 / (s * s * s) - c * J_1};
  }
  // Asymptotic series in 1/(cs): the terms fall until e^-40.
  std::array<double, 3> J{};
  for (int m = 0; m < 3; ++m) {
    double term = 1 / cs;
    for (int i = 1; i <= m + 1; ++i) term *= i / s;
    for (int i = 0; i < 40 && std::abs(term) > 1e-17 * std::abs(J[std::size_t(m)]); ++i) {
      J[std::size_t(m)] += term;
      term *= -(m + 2 + i) / cs;
    }
  }
  return J;
}

// The largest value of f over [0, to], from a scan and a golden section around its best point.
double largest(const Function& f, double to) {
  constexpr int kSteps = 2000;
  int best = 0;
  for (int i = 1; i <= kSteps; ++i)
    if (f(to * i / kSteps) > f(to * best / kSteps)) best = i;
  double low = to * std::max(best - 1, 0) / kSteps;
  double high = to * std::min(best + 1, kSteps) / kSteps;
  const double ratio = 1 / std::numbers::phi;
  while (high - low > 1e-9 * to) {
    const double left = high - ratio * (high - low);
    const double right = low + ratio * (high - low);
    (f(left) > f(right) ? high : low) = f(left) > f(right) ? right : left;
  }
  return f(0.5 * (low + high));
}

CrackKernel line_kernel(const SpringInterface& interface, double half_length, double distance, double E_prime) {
  if (!(distance > 0)) throw std::invalid_argument("distance must be positive");
  if (!(interface.normal_stiffness >= 0 && interface.shear_stiffness >= 0))
    throw std::invalid_argument("stiffnesses must not be negative");
  return [=, middle = distance + half_length](double t, double x) {
    Eigen::Matrix2d k = Eigen::Matrix2d::Zero();
    k(0, 0) = spring_kernel(interface, E_prime, middle + t, middle + x);
    return k;
  };
}

}  // namespace

double spring_kernel(const SpringInterface& interface, double E_prime, double t, double y) {
  const double s = t + y;
  const auto normal = released(s, 4 * interface.normal_stiffness / E_prime);
  const auto shear = released(s, 4 * interface.shear_stiffness / E_prime);
  return -t * normal[1] + t * y * normal[2] + 2 * shear[0] - (y + 2 * t) * shear[1] + y * t * shear[2];
}

CrackLine spring_interface_crack(const SpringInterface& interface, double half_length, double distance, double E_prime,
                                 const Function& p, int n) {
  const auto load = [&p](double x) { return Eigen::Vector2d(p(x), 0); };
  return CrackLine(half_length, E_prime, line_kernel(interface, half_length, distance, E_prime), CrackLoad(load), n);
}

CrackLine spring_interface_crack(const SpringInterface& interface, double half_length, double distance, double E_prime,
                                 const PressureKnots& p, int n) {
  return CrackLine(half_length, E_prime, line_kernel(interface, half_length, distance, E_prime), p, n);
}

double first_slip_ratio(double friction) {
  if (!(friction > 0)) throw std::invalid_argument("friction must be positive");
  const auto drive = [friction](double th) {
    const double half = 0.5 * th;
    const double s_yy = std::cos(half) * (1 - std::sin(half) * std::sin(3 * half));
    const double s_xy = std::abs(std::sin(half) * std::cos(half) * std::cos(3 * half));
    return std::sqrt(std::cos(th)) * (s_yy + s_xy / friction);
  };
  return 1 / largest(drive, 0.4999 * pi);
}

double first_slip_pressure(double half_length, double distance, double compression, double friction) {
  if (!(half_length > 0 && distance > 0 && compression > 0 && friction > 0))
    throw std::invalid_argument("half_length, distance, compression and friction must be positive");
  const double a = half_length;
  const auto drive = [&](double th) {
    // z along the crack; the interface is the line Re z = a + d, seen from the tip at th.
    const std::complex<double> z(a + distance, distance * std::tan(th));
    const std::complex<double> root = std::sqrt(z - a) * std::sqrt(z + a);
    const std::complex<double> Z = a * a / (root * (z + root));  // z/root - 1 without its cancellation far away
    const std::complex<double> dZ = -a * a / (root * root * root);
    const double along = Z.real() - z.imag() * dZ.imag();
    return along + std::abs(z.imag() * dZ.real()) / friction;
  };
  return compression / largest(drive, 0.4999 * pi);
}

}  // namespace strata::reference
