// One-dimensional shape functions on the three nodes around the one whose span holds a place; two dimensions are their
// products. f is the position relative to that node in lengths of its span (cells, where the grid is uniform),
// |f| <= 1/2; N sums to 1 and sum_a x_a N_a = x, so that linear fields are reproduced exactly. Derivatives are per
// span: divide by its length. at() is for three equal spans; graded() takes the lengths of the spans before and after
// as multiples of the middle one, and is at() but for round-off where both are 1.
#pragma once

#include <array>
#include <cmath>
#include <stdexcept>

#include "scene/scene.hpp"
#include "state/grid.hpp"
#include "state/types.hpp"

namespace strata {

struct Weights {
  std::array<double, 3> N;
  std::array<double, 3> dN;
};

// Quadratic B-spline (Steffen, Kirby & Berzins 2008). On knots t the recursion of de Boor (A Practical Guide to
// Splines, 1978, chapter X) gives on [t_i, t_i+1]
//   N_i-1 = (t_i+1 - x)^2/((t_i+1 - t_i-1)(t_i+1 - t_i)), N_i+1 = (x - t_i)^2/((t_i+2 - t_i)(t_i+1 - t_i)),
//   N_i = 1 - N_i-1 - N_i+1;
// sum_a xi_a N_a = x with the mean of its two inner knots as a function's xi_a (Greville), which is where nodes stand.
struct QuadraticBspline {
  static Weights at(double f, double /*half*/) {
    const double a = 0.5 - f, b = 0.5 + f;
    return {{0.5 * a * a, 0.75 - f * f, 0.5 * b * b}, {-a, -2.0 * f, b}};
  }
  static Weights graded(double f, double before, double after) {
    const double a = (0.5 - f) / (1.0 + before), b = (0.5 + f) / (1.0 + after);
    const double low = a * (0.5 - f), high = b * (0.5 + f);
    return {{low, 1.0 - low - high, high}, {-2.0 * a, 2.0 * (a - b), 2.0 * b}};
  }
};

// Hat functions of the two nodes of the cell.
struct Linear {
  static Weights at(double f, double /*half*/) {
    if (f >= 0.0) return {{0.0, 1.0 - f, f}, {0.0, -1.0, 1.0}};
    return {{-f, 1.0 + f, 0.0}, {-1.0, 1.0, 0.0}};
  }
  // The nodes beside are half of both spans away.
  static Weights graded(double f, double before, double after) {
    const double d = f >= 0.0 ? 2.0 / (1.0 + after) : 2.0 / (1.0 + before);
    if (f >= 0.0) return {{0.0, 1.0 - f * d, f * d}, {0.0, -d, d}};
    return {{-f * d, 1.0 + f * d, 0.0}, {-d, d, 0.0}};
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
  // Scenes refuse it: uGIMP is for points that move, graded grids for those that do not.
  static Weights graded(double, double, double) { throw std::logic_error("uGIMP on a graded grid"); }

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

/// Weights at the coordinate x (m) of the nodes of columns i - 1, i and i + 1, where i (0 ... nx) is the one whose span
/// holds x; half: half the size of a uGIMP particle (m). Derivatives are per span: divide by grid.span_x(i).
template <class Shape>
Weights weights_x(const Grid& grid, int i, double x, double half) {
  if (grid.x_knots.empty()) return Shape::at(x / grid.h - i, half / grid.h);
  const double s = grid.span_x(i);
  return Shape::graded((x - grid.x(i)) / s, grid.span_x(i - 1) / s, grid.span_x(i + 1) / s);
}

/// The same along y, of row j.
template <class Shape>
Weights weights_y(const Grid& grid, int j, double y, double half) {
  if (grid.y_knots.empty()) return Shape::at(y / grid.h - j, half / grid.h);
  const double s = grid.span_y(j);
  return Shape::graded((y - grid.y(j)) / s, grid.span_y(j - 1) / s, grid.span_y(j + 1) / s);
}

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

// Shape functions of nine nodes, row by row from the lower left, and their derivatives (1/m).
struct Gradients {
  std::array<double, 9> N{}, N_x{}, N_y{};
};

/// Weights of the scene's shape function at x (m), of the 3 x 3 nodes around column i and row j, whose spans hold x;
/// half: half the size of a uGIMP particle (m). Throws nothing but std::logic_error for uGIMP on a graded grid.
inline Gradients gradients_at(const Scene& scene, const Grid& grid, int i, int j, const Vec2& x, double half) {
  return with_shape(scene.numerics.shape, [&](auto shape) {
    const Weights X = weights_x<decltype(shape)>(grid, i, x.x(), half);
    const Weights Y = weights_y<decltype(shape)>(grid, j, x.y(), half);
    const double s_x = grid.span_x(i), s_y = grid.span_y(j);
    Gradients out;
    for (std::size_t n = 0; n < 9; ++n) {
      out.N[n] = X.N[n % 3] * Y.N[n / 3];
      out.N_x[n] = X.dN[n % 3] * Y.N[n / 3] / s_x;
      out.N_y[n] = X.N[n % 3] * Y.dN[n / 3] / s_y;
    }
    return out;
  });
}

}  // namespace strata
