// The kernel of an explicit step: motion from nodes to particles, stress, and sums of mass, momentum and internal force
// back to nodes, for one block of bins: neighbours along a row, each a lane (see Bin). Interpolation is a product of
// the two axes, a row of nodes first. On each axis the weights of three nodes sum to 1 and their derivatives to 0, so
// that only those of the outer two are formed: with E_b = r_b - r_0 (b = before, after) of the middle node's value r_0,
//   sum_a N_a r_a = r_0 + N_b E_b + N_a E_a,  sum_a dN_a r_a = dN_b E_b + dN_a E_a,
// and what particles give to the middle node is the whole less the outer two. No digits are lost: the middle node's
// weight is the largest.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "state/copies.hpp"
#include "state/elasticity.hpp"
#include "state/lanes.hpp"
#include "state/particles.hpp"
#include "state/shape_functions.hpp"

namespace strata {

// What a sweep does and works on: particles take up the motion of nodes (v_x, v_y and what their velocities take up,
// along x and y) over a step, nodes gather what particles then give them (m, mom_x, mom_y, f_x, f_y), or both.
struct Sweep {
  bool moves = false, gathers = false;
  double dt = 0.0;    // s
  double keep = 1.0;  // share of their own velocity that particles keep
  const Rocks& rocks;
  Particles& p;
  std::array<const double*, 4> motion;
  std::array<double*, 5> sums;
};

// Reports of particles, lane by lane.
using LaneReport = MotionReport<std::array<double, most_lanes>>;

// A span of an axis: its node's coordinate (m), 1/length (1/m).
template <class Real>
struct Span {
  Real node, per_length;
  SpanShares<Real> share;
};

// The same thing along both axes.
template <class Of>
struct BothAxes {
  Of x, y;
};

/// Outer weights of the particles at q.
template <class Shape, class L, class Real = typename L::Real>
[[gnu::always_inline]] inline BothAxes<AxisWeights<Real>> weights_at(const BothAxes<Span<Real>>& span,
                                                                     const Particles& p, std::size_t q) {
  const auto along = [&](const Span<Real>& s, const SpreadArray& x, const SpreadArray& half) {
    const Real f = (L::load(&x[q]) - s.node) * s.per_length;
    return Shape::outer(f, s.share, Shape::has_size ? Real{L::load(&half[q]) * s.per_length} : Real{});
  };
  return {along(span.x, p.x, p.half_x), along(span.y, p.y, p.half_y)};
}

// Value and slopes (per span) of a quantity at a place.
template <class Real>
struct Interpolated {
  Real value, d_x, d_y;
};

// A quantity on a bin's nine nodes, row by row: outer ones less the middle one's, along both axes.
template <class Real>
using Coefficients = std::array<std::array<Real, 3>, 3>;

template <class L, class Real = typename L::Real>
[[gnu::always_inline]] inline void load_coefficients(const double* values, const Bin& bin, Coefficients<Real>& c) {
  for (std::size_t n = 0; n < 9; ++n) c[n / 3][n % 3] = L::load(values + bin.record[n]);
  for (auto& row : c) row[0] -= row[1], row[2] -= row[1];
  for (std::size_t a = 0; a < 3; ++a) c[0][a] -= c[1][a], c[2][a] -= c[1][a];
}

template <class Real>
[[gnu::always_inline]] inline Real along(const std::array<Real, 3>& c, const AxisWeights<Real>& w) {
  return c[1] + w.N[0] * c[0] + w.N[2] * c[2];
}
template <class Real>
[[gnu::always_inline]] inline Real slope(const std::array<Real, 3>& c, const AxisWeights<Real>& w) {
  return w.dN[0] * c[0] + w.dN[2] * c[2];
}

template <class Real>
[[gnu::always_inline]] inline Interpolated<Real> interpolate(const Coefficients<Real>& c,
                                                             const BothAxes<AxisWeights<Real>>& w) {
  const std::array<Real, 3> rows{along(c[0], w.x), along(c[1], w.x), along(c[2], w.x)};
  const std::array<Real, 3> slopes{slope(c[0], w.x), slope(c[1], w.x), slope(c[2], w.x)};
  return {along(rows, w.y), along(slopes, w.y), slope(rows, w.y)};
}

/// Moves the particles at q, whose rock is `rock`, by the motion c of their nodes.
template <class L, class Real = typename L::Real>
[[gnu::always_inline]] inline void move(const Sweep& sweep, const BothAxes<Span<Real>>& span,
                                        const std::array<Coefficients<Real>, 4>& c,
                                        const BothAxes<AxisWeights<Real>>& w, const Elasticity& rock, std::size_t q,
                                        LaneReport& report) {
  const auto add = [](double* to, const Real& by) { L::store(to, L::load(to) + by); };
  const auto note = [](auto& largest, const Real& value) {
    L::store(largest.data(), larger<Real>(L::load(largest.data()), value));
  };
  Particles& p = sweep.p;
  const Real off_x = (L::load(&p.x[q]) - span.x.node) * span.x.per_length;
  const Real off_y = (L::load(&p.y[q]) - span.y.node) * span.y.per_length;
  note(report.farthest_cells, larger<Real>(larger<Real>(off_x, -off_x), larger<Real>(off_y, -off_y)));
  const Interpolated<Real> x = interpolate(c[0], w), y = interpolate(c[1], w);
  const Real m = L::load(&p.m[q]), V = L::load(&p.V[q]), v_x = L::load(&p.v_x[q]), v_y = L::load(&p.v_y[q]);
  const Real new_x = sweep.keep * v_x + interpolate(c[2], w).value, new_y = sweep.keep * v_y + interpolate(c[3], w).value;
  const Real speed2 = new_x * new_x + new_y * new_y;
  add(report.before.data(), m * (v_x * v_x + v_y * v_y)), add(report.after.data(), m * speed2);
  note(report.largest_speed2, speed2);
  L::store(&p.v_x[q], new_x), L::store(&p.v_y[q], new_y);
  add(&p.x[q], sweep.dt * x.value), add(&p.y[q], sweep.dt * y.value);
  add(&p.u_x[q], sweep.dt * x.value), add(&p.u_y[q], sweep.dt * y.value);
  const Real by_x = sweep.dt * span.x.per_length, by_y = sweep.dt * span.y.per_length;
  const Real e_xx = by_x * x.d_x, e_xy = by_y * x.d_y, e_yx = by_x * y.d_x, e_yy = by_y * y.d_y;
  add(&p.g_xx[q], e_xx), add(&p.g_xy[q], e_xy), add(&p.g_yx[q], e_yx), add(&p.g_yy[q], e_yy);
  const Real shear = e_xy + e_yx, trace = e_xx + e_yy;
  add(report.step_strain.data(), V * (rock.lambda * trace * trace + 2.0 * rock.mu * (e_xx * e_xx + e_yy * e_yy) +
                                      rock.mu * shear * shear));  // V dsigma : de
}

// What particles give to their nodes: mass and momentum by N, and -V sigma, each component with the 1/length of the
// axis along which it meets dN.
template <class Real>
struct Given {
  BothAxes<AxisWeights<Real>> w;
  Real m, mom_x, mom_y;
  Real s_xx, s_xy_x;  // with dN/dx into f_x and f_y
  Real s_xy_y, s_yy;  // with dN/dy
};

template <class L, class Real = typename L::Real>
[[gnu::always_inline]] inline void give(const Particles& p, const BothAxes<Span<Real>>& span, const Elasticity& rock,
                                        std::size_t q, Given<Real>& to) {
  const Real m = L::load(&p.m[q]), V = L::load(&p.V[q]), V_x = -V * span.x.per_length, V_y = -V * span.y.per_length;
  const Real g_xx = L::load(&p.g_xx[q]), g_yy = L::load(&p.g_yy[q]);
  const Real trace = rock.lambda * (g_xx + g_yy), s_xy = rock.mu * (L::load(&p.g_xy[q]) + L::load(&p.g_yx[q]));
  to.m = m, to.mom_x = m * L::load(&p.v_x[q]), to.mom_y = m * L::load(&p.v_y[q]);
  to.s_xx = V_x * (trace + 2.0 * rock.mu * g_xx), to.s_xy_x = V_x * s_xy;
  to.s_yy = V_y * (trace + 2.0 * rock.mu * g_yy), to.s_xy_y = V_y * s_xy;
}

// Sums on one row of a bin's nodes.
template <class Real>
using RowSums = Real[5][3];

// Those of row b, or of all three rows in the place of the middle one.
template <std::size_t b, class Real>
[[gnu::always_inline]] inline void sum_row(const Given<Real>* given, int n, RowSums<Real>& row) {
  for (int k = 0; k < n; ++k) {
    const Given<Real>& g = given[k];
    const Real N = g.w.y.N[b], dN = g.w.y.dN[b];
    const Real by_N[5] = {N * g.m, N * g.mom_x, N * g.mom_y, dN * g.s_xy_y, dN * g.s_yy};
    const Real by_dN[2] = {N * g.s_xx, N * g.s_xy_x};
    for (std::size_t of = 0; of < (b == 1 ? 3 : 5); ++of) {
      for (std::size_t a = 0; a < 3; ++a) row[of][a] += g.w.x.N[a] * by_N[of];
    }
    for (std::size_t of = 0; of < 2; ++of)
      row[3 + of][0] += g.w.x.dN[0] * by_dN[of], row[3 + of][2] += g.w.x.dN[2] * by_dN[of];
  }
  for (auto& sum : row) sum[1] -= sum[0] + sum[2];
}

// Adds a row's sums to the nodes, whose records are `record`. Lane l adds to the nodes l, l + 1 and l + 2 of the row:
// where their records follow each other, what lanes meet at is added up before it goes to memory; beside a cut, where
// nodes and copies take turns, it goes there one after the other.
template <class L, class Real = typename L::Real>
[[gnu::always_inline]] inline void add_row(const int* record, const RowSums<Real>& row,
                                           const std::array<double*, 5>& sums) {
  const bool follow = record[1] == record[0] + 1 && record[2] == record[0] + 2;
  for (std::size_t of = 0; of < 5; ++of) {
    if (follow) {
      L::add_shifted(sums[of] + record[0], row[of][0], row[of][1], row[of][2]);
      continue;
    }
    for (std::size_t a = 0; a < 3; ++a) L::store(sums[of] + record[a], L::load(sums[of] + record[a]) + row[of][a]);
  }
}

/// Adds what some particles give to the sums of their bin's nodes.
template <class L, class Real = typename L::Real>
[[gnu::always_inline]] inline void add_given(const Given<Real>* given, int n, const Bin& bin,
                                             const std::array<double*, 5>& sums) {
  RowSums<Real> before{}, middle{}, after{};
  const int* const record = bin.record.data();
  sum_row<1>(given, n, middle);
  sum_row<0>(given, n, before);
  add_row<L>(record, before, sums);
  sum_row<2>(given, n, after);
  add_row<L>(record + 6, after, sums);
  for (std::size_t of = 0; of < 5; ++of) {
    for (std::size_t a = 0; a < 3; ++a) middle[of][a] -= before[of][a] + after[of][a];
  }
  add_row<L>(record + 3, middle, sums);
}

/// Sweeps the particles q = first, first + stride, ... below last of a block of bins whose first lane is `bin`; lanes'
/// records follow that bin's one by one, and the rock is the same in all lanes. Throws nothing.
template <class Shape, class L>
void sweep_block(const Sweep& sweep, const BothAxes<Span<typename L::Real>>& span, const Bin& bin, LaneReport& report) {
  using Real = typename L::Real;
  constexpr int together = 4;  // particles of a lane whose weights are kept until their sums are formed
  std::array<Coefficients<Real>, 4> c;
  if (sweep.moves) {
    for (std::size_t of = 0; of < 4; ++of) load_coefficients<L>(sweep.motion[of], bin, c[of]);
  }
  Given<Real> given[together];
  int n = 0;
  for (const std::size_t q : bin) {
    const Elasticity& rock = sweep.rocks[sweep.p.rock[q]];
    if (sweep.moves) move<L>(sweep, span, c, weights_at<Shape, L>(span, sweep.p, q), rock, q, report);
    if (!sweep.gathers) continue;
    given[n].w = weights_at<Shape, L>(span, sweep.p, q);
    give<L>(sweep.p, span, rock, q, given[n++]);
    const bool last = static_cast<int>(q) + bin.stride >= bin.last;
    if (n == together || last) add_given<L>(given, n, bin, sweep.sums), n = 0;
  }
}

}  // namespace strata
