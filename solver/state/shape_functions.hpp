// One-dimensional shape functions on the three nodes around the nearest one; two dimensions are their products.
// f is the position relative to the middle node in cells, |f| <= 1/2; N sums to 1 and sum_a (a - 1) N_a = f, so that
// linear fields are reproduced exactly. Derivatives are per cell: divide by h.
#pragma once

#include <array>
#include <cmath>

#include "scene/scene.hpp"

namespace strata {

struct Weights {
  std::array<double, 3> N;
  std::array<double, 3> dN;
};

// Quadratic B-spline (Steffen, Kirby & Berzins 2008).
struct QuadraticBspline {
  static Weights at(double f, double /*half*/) {
    const double a = 0.5 - f, b = 0.5 + f;
    return {{0.5 * a * a, 0.75 - f * f, 0.5 * b * b}, {-a, -2.0 * f, b}};
  }
};

// Hat functions of the two nodes of the cell.
struct Linear {
  static Weights at(double f, double /*half*/) {
    if (f >= 0.0) return {{0.0, 1.0 - f, f}, {0.0, -1.0, 1.0}};
    return {{-f, 1.0 + f, 0.0}, {-1.0, 1.0, 0.0}};
  }
};

// Hat functions averaged over a particle's own length 2 half (in cells), not deformed: uGIMP (Bardenhagen & Kober
// 2004).
struct Ugimp {
  static Weights at(double f, double half) {
    Weights w{};
    for (int a = 0; a < 3; ++a) {
      const double lo = f - (a - 1) - half, hi = f - (a - 1) + half;
      w.N[static_cast<std::size_t>(a)] = hat_integral(lo, hi) / (2.0 * half);
      w.dN[static_cast<std::size_t>(a)] = (hat(hi) - hat(lo)) / (2.0 * half);
    }
    return w;
  }

 private:
  static double hat(double x) { return std::fmax(0.0, 1.0 - std::fabs(x)); }
  // Integral of the hat function from lo to hi, in the form that keeps its digits where it is nearly zero: a particle
  // that just touches a node must not give it a mass of round-off.
  static double hat_integral(double lo, double hi) {
    if (lo >= 0.0) return 0.5 * (hat(lo) + hat(hi)) * (hat(lo) - hat(hi));
    if (hi <= 0.0) return 0.5 * (hat(hi) + hat(lo)) * (hat(hi) - hat(lo));
    return 1.0 - 0.5 * (hat(lo) * hat(lo) + hat(hi) * hat(hi));
  }
};

/// Calls f with the type of the scene's shape function, so that loops are compiled for each of them.
template <class F>
auto with_shape(Numerics::Shape shape, F f) {
  switch (shape) {
    case Numerics::Shape::linear:
      return f(Linear{});
    case Numerics::Shape::gimp:
      return f(Ugimp{});
    case Numerics::Shape::bspline2:
      break;
  }
  return f(QuadraticBspline{});
}

}  // namespace strata
