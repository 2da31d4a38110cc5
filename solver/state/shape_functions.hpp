// One-dimensional shape functions on the three nodes around the one whose span holds a place; two dimensions are their
// products. f is the position relative to that node in lengths of its span (cells, where the grid is uniform),
// |f| <= 1/2; N sums to 1 and sum_a x_a N_a = x, so that linear fields are reproduced exactly. Derivatives are per
// span: divide by its length. outer() gives what the two nodes beside take, for a number or for lanes of them (see
// lanes.hpp); graded_weights() all three.
#pragma once

#include <array>

#include "scene/scene.hpp"
#include "state/grid.hpp"
#include "state/lanes.hpp"
#include "state/types.hpp"

namespace strata {

// Of the nodes before, between and after.
struct Weights {
  std::array<double, 3> N, dN;
};

// Of the nodes before and after.
template <class Real>
struct OuterWeights {
  std::array<Real, 2> N, dN;
};

// 1/(1 + s) of the spans before and after, of length s times the middle one: 1/2 where all are equal.
template <class Real>
struct SpanShares {
  Real before, after;
};

// Quadratic B-spline (Steffen, Kirby & Berzins 2008). On knots t the recursion of de Boor (A Practical Guide to
// Splines, 1978, chapter X) gives on [t_i, t_i+1]
//   N_i-1 = (t_i+1 - x)^2/((t_i+1 - t_i-1)(t_i+1 - t_i)), N_i+1 = (x - t_i)^2/((t_i+2 - t_i)(t_i+1 - t_i)),
//   N_i = 1 - N_i-1 - N_i+1;
// sum_a xi_a N_a = x with the mean of its two inner knots as a function's xi_a (Greville), which is where nodes stand.
struct QuadraticBspline {
  static constexpr bool has_size = false;  // functions of points
  template <class Real>
  static OuterWeights<Real> outer(const Real& f, const SpanShares<Real>& share, const Real& /*half*/) {
    const Real to_after = 0.5 - f, to_before = 0.5 + f;
    const Real low = share.before * to_after, high = share.after * to_before;
    return {{low * to_after, high * to_before}, {-2.0 * low, 2.0 * high}};
  }
};

// Hat functions of the two nodes of the cell. The nodes beside are half of both spans away.
struct Linear {
  static constexpr bool has_size = false;
  template <class Real>
  static OuterWeights<Real> outer(const Real& f, const SpanShares<Real>& share, const Real& /*half*/) {
    const Real zero{}, d_before = 2.0 * share.before, d_after = 2.0 * share.after;
    return {{f < 0.0 ? -f * d_before : zero, f < 0.0 ? zero : f * d_after},
            {f < 0.0 ? -d_before : zero, f < 0.0 ? zero : d_after}};
  }
};

// Hat functions averaged over a particle's own length 2 half (in spans), not deformed: uGIMP (Bardenhagen & Kober
// 2004), for particles that do not reach beyond the nodes beside. With the
// distances A, B that a particle's two ends go past the middle node, 0 where they do not, and d to a node beside, that
// one has N = (A^2 - B^2)/(4 half d) and |dN| = (A - B)/(2 half d), in the form that keeps its digits where N is nearly
// zero: a particle that just touches a node must not give it a mass of round-off. As long as particles' rectangles fill
// the block sum_p V_p grad N_ip is the integral of grad N_i, on graded cells too, wherever they have moved to.
struct Ugimp {
  static constexpr bool has_size = true;
  template <class Real>
  static OuterWeights<Real> outer(const Real& f, const SpanShares<Real>& share, const Real& half) {
    const Real zero{}, per_size = 0.5 / half;
    const Real before_A = larger<Real>(zero, half - f), before_B = larger<Real>(zero, -half - f);
    const Real after_A = larger<Real>(zero, f + half), after_B = larger<Real>(zero, f - half);
    const Real before = (2.0 * share.before) * ((before_A - before_B) * per_size);  // 2 share is 1/d
    const Real after = (2.0 * share.after) * ((after_A - after_B) * per_size);
    return {{0.5 * before * (before_A + before_B), 0.5 * after * (after_A + after_B)}, {-before, after}};
  }
};

/// Weights of all three nodes at f, spans before and after of `before` and `after` times the middle one; half: half the
/// size of a uGIMP particle in spans.
template <class Shape>
Weights graded_weights(double f, double before, double after, double half) {
  const auto [N, dN] = Shape::outer(f, SpanShares<double>{1.0 / (1.0 + before), 1.0 / (1.0 + after)}, half);
  return {{N[0], 1.0 - (N[0] + N[1]), N[1]}, {dN[0], -(dN[0] + dN[1]), dN[1]}};
}

/// The same on three equal spans.
template <class Shape>
Weights uniform_weights(double f, double half) {
  return graded_weights<Shape>(f, 1.0, 1.0, half);
}

/// Weights at the coordinate x (m) of the nodes i - 1, i and i + 1 of an axis with knots t (none: uniform, of cells h),
/// where i (0 ... n) is the one whose span holds x; half: half the size of a uGIMP particle (m). Derivatives are per
/// span.
template <class Shape>
Weights weights_along(const std::vector<double>& t, double h, int i, double x, double half) {
  if (t.empty()) return uniform_weights<Shape>(x / h - i, half / h);
  const auto k = static_cast<std::size_t>(i) + 1;  // t[k] is t_i
  const double s = t[k + 1] - t[k];
  return graded_weights<Shape>((x - 0.5 * (t[k] + t[k + 1])) / s, (t[k] - t[k - 1]) / s, (t[k + 2] - t[k + 1]) / s,
                               half / s);
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

/// Weights at x (m) of the 3 x 3 nodes around column i and row j, whose spans hold x; half: half the sides of a uGIMP
/// particle (m). Throws nothing.
template <class Shape>
Gradients gradients_of(const Grid& grid, int i, int j, const Vec2& x, const Vec2& half) {
  const Weights X = weights_along<Shape>(grid.x_knots, grid.h, i, x.x(), half.x());
  const Weights Y = weights_along<Shape>(grid.y_knots, grid.h, j, x.y(), half.y());
  const double s_x = grid.span_x(i), s_y = grid.span_y(j);
  Gradients out;
  for (std::size_t n = 0; n < 9; ++n) {
    out.N[n] = X.N[n % 3] * Y.N[n / 3];
    out.N_x[n] = X.dN[n % 3] * Y.N[n / 3] / s_x;
    out.N_y[n] = X.N[n % 3] * Y.dN[n / 3] / s_y;
  }
  return out;
}

/// The same with the scene's shape function.
inline Gradients gradients_at(const Scene& scene, const Grid& grid, int i, int j, const Vec2& x, const Vec2& half) {
  return with_shape(scene.numerics.shape,
                    [&](auto shape) { return gradients_of<decltype(shape)>(grid, i, j, x, half); });
}

}  // namespace strata
