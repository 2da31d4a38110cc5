// The traction that a solved line of dislocations makes on its own crack, at any point, for putting it into its
// equation.
#pragma once

#include <cmath>
#include <numbers>

#include "crack_line.hpp"

namespace strata::reference {

// (E'/4 pi) [PV int delta'(t)/(t - x) dt + int k(t, x) delta'(t) dt], Pa, at x inside the crack: the principal value
// term by term, PV int T_m(t/a)/(sqrt(a^2 - t^2) (t - x)) dt = pi U_(m-1)(x/a)/a, and k by the nodes. It must be -(p,
// q).
inline Eigen::Vector2d line_traction(const CrackLine& line, const CrackKernel& kernel, double a, double E_prime,
                                     double x) {
  const double pi = std::numbers::pi;
  const auto n = static_cast<int>(line.nodes().size());
  const double angle = std::acos(x / a);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int m = 1; m < n; ++m) {
    Eigen::Vector2d B = Eigen::Vector2d::Zero();
    for (int j = 0; j < n; ++j) B += 2 / pi * line.strengths().col(j) * std::cos(m * std::acos(line.nodes()(j) / a));
    sum += B * pi / a * std::sin(m * angle) / std::sin(angle);
  }
  for (int j = 0; j < n; ++j) sum += kernel(line.nodes()(j), x) * line.strengths().col(j);
  return E_prime / (4 * pi) * sum;
}

}  // namespace strata::reference
