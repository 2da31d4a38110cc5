// The kernel of an explicit step: motion from nodes to particles, stress, and sums of mass, momentum and internal force
// back to nodes, for one block of bins: neighbours along a row, each a lane (see Bin). Interpolation is a product of
// the two axes, a row of nodes first. On each axis the weights of three nodes sum to 1 and their derivatives to 0, so
// that only those of the outer two are formed: with E_b = r_b - r_0 (b = before, after) of the middle node's value r_0,
//   sum_a N_a r_a = r_0 + N_b E_b + N_a E_a,  sum_a dN_a r_a = dN_b E_b + dN_a E_a,
// and what particles give to the middle node is the whole less the outer two. No digits are lost: the middle node's
// weight is the largest.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <type_traits>

#include "state/copies.hpp"
#include "state/elasticity.hpp"
#include "state/lanes.hpp"
#include "state/nodal.hpp"
#include "state/particles.hpp"
#include "state/shape_functions.hpp"

namespace strata {

// The arrays that a sweep works on: of particles, of the nodes' motion (v_x, v_y and what particles' velocities take
// up, along x and y) and of their sums (m, mom_x, mom_y, f_x, f_y).
struct SweepArrays {
  double *x, *y, *u_x, *u_y, *v_x, *v_y, *g_xx, *g_xy, *g_yx, *g_yy;
  const double *m, *V, *half_x, *half_y;
  const std::uint8_t* rock;
  const double* motion[4];
  double* sums[5];
};

struct SweepStep {
  double dt = 0.0;    // s
  double keep = 1.0;  // share of their own velocity that particles keep
};

// How far ahead memory is asked for what a sweep goes through: about three blocks of 4 particles a cell. Its two dozen
// arrays are more than the hardware foresees.
constexpr std::size_t particles_ahead = std::size_t{12} * most_lanes;
constexpr std::size_t nodes_ahead = std::size_t{3} * most_lanes, bins_ahead = nodes_ahead;

// What is read and written of particles to come; displacements only where they move.
template <bool Move>
[[gnu::always_inline]] inline void fetch_particles(const SweepArrays& p, std::size_t q) {
  for (const double* array : {p.x, p.y, p.v_x, p.v_y, p.g_xx, p.g_xy, p.g_yx, p.g_yy}) fetch(array, q);
  if constexpr (Move) {
    for (const double* array : {p.u_x, p.u_y}) fetch(array, q);
  }
}

// What is read and written of nodes to come; blocks of the rows before have used all but the last row of a stencil.
template <bool Move, bool Gather>
[[gnu::always_inline]] inline void fetch_nodes(const SweepArrays& to, std::size_t record) {
  if constexpr (Move) {
    for (const double* array : to.motion) fetch(array, record);
  }
  if constexpr (Gather) {
    for (const double* array : to.sums) fetch(array, record);
  }
}

// A span of one axis: its node's coordinate (m), 1/length (1/m), and 1/(1 + length of the span beside/own length).
template <class Real>
struct Span {
  Real node, per_length;
  SpanShares<Real> share;
};

template <class Lanes>
struct BlockSpans {
  Span<typename Lanes::Real> x;
  Span<double> y;
};

// Coefficients of the nodes' motion on a bin's nine nodes: [row][column] of (before, middle, after), outer ones less
// the middle one's, along both axes.
template <class Real>
using Coefficients = Real[4][3][3];

template <class Lanes>
[[gnu::always_inline]] inline void load_coefficients(const Lanes lanes, const Bin& bin, const double* values,
                                                     typename Lanes::Real (&c)[3][3]) {
  for (std::size_t b = 0; b < 3; ++b) {
    const auto middle = lanes.load(values + bin.record[3 * b + 1]);
    c[b][0] = lanes.load(values + bin.record[3 * b]) - middle;
    c[b][1] = middle;
    c[b][2] = lanes.load(values + bin.record[3 * b + 2]) - middle;
  }
  for (std::size_t a = 0; a < 3; ++a) c[0][a] -= c[1][a], c[2][a] -= c[1][a];
}

// The same thing along both axes.
template <class Of>
struct BothAxes {
  Of x, y;
};
template <class Real>
using PlaceWeights = BothAxes<OuterWeights<Real>>;  // the outer weights of a place
template <class Real>
using ParticleSizes = BothAxes<ParticleSize<Real>>;

template <class Shape, class Spans, class Real>
[[gnu::always_inline]] inline PlaceWeights<Real> weights_at(const Spans& at, const Real& x, const Real& y,
                                                            const ParticleSizes<Real>& size) {
  const SpanShares<Real> y_share{Real{} + at.y.share.before, Real{} + at.y.share.after};
  return {Shape::outer((x - at.x.node) * at.x.per_length, at.x.share, size.x),
          Shape::outer((y - at.y.node) * at.y.per_length, y_share, size.y)};
}

template <class Real>
[[gnu::always_inline]] inline Real along_row(const Real (&c)[3], const OuterWeights<Real>& w) {
  return c[1] + w.N_before * c[0] + w.N_after * c[2];
}
template <class Real>
[[gnu::always_inline]] inline Real slope_of_row(const Real (&c)[3], const OuterWeights<Real>& w) {
  return w.dN_before * c[0] + w.dN_after * c[2];
}

// Value and slopes (per span) of a quantity at a place.
template <class Real>
struct Interpolated {
  Real value, d_x, d_y;
};

template <class Real>
[[gnu::always_inline]] inline Interpolated<Real> interpolate(const Real (&c)[3][3], const PlaceWeights<Real>& w) {
  const Real r[3] = {along_row(c[0], w.x), along_row(c[1], w.x), along_row(c[2], w.x)};
  const Real s[3] = {slope_of_row(c[0], w.x), slope_of_row(c[1], w.x), slope_of_row(c[2], w.x)};
  return {along_row(r, w.y), along_row(s, w.y), slope_of_row(r, w.y)};
}

// What a particle gives to the nodes: mass and momentum by N, and -V sigma, each component with the 1/length of the
// axis along which it meets dN.
template <class Real>
struct Given {
  PlaceWeights<Real> w;
  Real by_N[3];       // m, mom_x, mom_y
  Real s_xx, s_xy_x;  // with dN/dx into f_x and f_y
  Real s_xy_y, s_yy;  // with dN/dy
};

// Where particles are, and what moves and strains with them.
template <class Real>
struct ParticleState {
  Real x, y, v_x, v_y, g_xx, g_xy, g_yx, g_yy;
};

template <class Lanes>
[[gnu::always_inline]] inline ParticleState<typename Lanes::Real> load_particles(const Lanes lanes,
                                                                                 const SweepArrays& p, std::size_t q) {
  return {lanes.load(p.x + q),    lanes.load(p.y + q),    lanes.load(p.v_x + q),  lanes.load(p.v_y + q),
          lanes.load(p.g_xx + q), lanes.load(p.g_xy + q), lanes.load(p.g_yx + q), lanes.load(p.g_yy + q)};
}

// Moves the particles at q, which are as `is` says, by the grid's motion over a step.
template <class Lanes>
[[gnu::always_inline]] inline void move(const Lanes lanes, const SweepArrays& p, const SweepStep& step,
                                        const BlockSpans<Lanes>& at, const Coefficients<typename Lanes::Real>& c,
                                        const PlaceWeights<typename Lanes::Real>& w, const Elasticity& rock,
                                        std::size_t q, ParticleState<typename Lanes::Real>& is,
                                        MotionReport<typename Lanes::Real>& report) {
  using Real = typename Lanes::Real;
  const auto change = [&](double* array, Real& value, const Real& by) {
    value += by;
    lanes.store(array + q, value);
  };
  const auto add = [&](double* array, const Real& by) { lanes.store(array + q, lanes.load(array + q) + by); };
  const Interpolated<Real> x = interpolate(c[0], w), y = interpolate(c[1], w);
  const Real m = lanes.load(p.m + q), V = lanes.load(p.V + q);
  report.before += m * (is.v_x * is.v_x + is.v_y * is.v_y);
  is.v_x = step.keep * is.v_x + interpolate(c[2], w).value, is.v_y = step.keep * is.v_y + interpolate(c[3], w).value;
  lanes.store(p.v_x + q, is.v_x), lanes.store(p.v_y + q, is.v_y);
  const Real speed2 = is.v_x * is.v_x + is.v_y * is.v_y;
  report.after += m * speed2;
  report.largest_speed2 = larger(report.largest_speed2, lanes.used(speed2));
  change(p.x, is.x, step.dt * x.value), change(p.y, is.y, step.dt * y.value);
  add(p.u_x, step.dt * x.value), add(p.u_y, step.dt * y.value);
  const Real by_x = step.dt * at.x.per_length;
  const double by_y = step.dt * at.y.per_length;
  const Real e_xx = by_x * x.d_x, e_xy = by_y * x.d_y, e_yx = by_x * y.d_x, e_yy = by_y * y.d_y;
  change(p.g_xx, is.g_xx, e_xx), change(p.g_xy, is.g_xy, e_xy);
  change(p.g_yx, is.g_yx, e_yx), change(p.g_yy, is.g_yy, e_yy);
  const Real shear = e_xy + e_yx, trace = e_xx + e_yy;
  report.step_strain += V * (rock.lambda * trace * trace + 2.0 * rock.mu * (e_xx * e_xx + e_yy * e_yy) +
                             rock.mu * shear * shear);  // V dsigma : de
}

// What the particles at q give as they are.
template <class Lanes>
[[gnu::always_inline]] inline void give(const Lanes lanes, const SweepArrays& p, const BlockSpans<Lanes>& at,
                                        const Elasticity& rock, std::size_t q,
                                        const ParticleState<typename Lanes::Real>& is,
                                        Given<typename Lanes::Real>& to) {
  using Real = typename Lanes::Real;
  const Real m = lanes.load(p.m + q);
  to.by_N[0] = m, to.by_N[1] = m * is.v_x, to.by_N[2] = m * is.v_y;
  const Real V = lanes.load(p.V + q), V_x = -V * at.x.per_length, V_y = -V * at.y.per_length;
  const Real trace = rock.lambda * (is.g_xx + is.g_yy), s_xy = rock.mu * (is.g_xy + is.g_yx);
  to.s_xx = V_x * (trace + 2.0 * rock.mu * is.g_xx), to.s_xy_x = V_x * s_xy;
  to.s_yy = V_y * (trace + 2.0 * rock.mu * is.g_yy), to.s_xy_y = V_y * s_xy;
}

// Sums on one row of a bin's nodes.
template <class Real>
using RowSums = Real[5][3];

template <class Real>
[[gnu::always_inline]] inline void add_by_N(const OuterWeights<Real>& w, const Real& q, Real (&row)[3]) {
  row[0] += w.N_before * q, row[1] += q, row[2] += w.N_after * q;
}
template <class Real>
[[gnu::always_inline]] inline void add_by_dN(const OuterWeights<Real>& w, const Real& q, Real (&row)[3]) {
  row[0] += w.dN_before * q, row[2] += w.dN_after * q;
}

// The row's middle node has the whole less the outer two.
template <class Real>
[[gnu::always_inline]] inline void finish_row(RowSums<Real>& row) {
  for (auto& sum : row) sum[1] -= sum[0] + sum[2];
}

// The sum of all three rows, and an outer one by its weights N and dN across.
template <class Real>
[[gnu::always_inline]] inline void sum_all_rows(const Given<Real>* given, int n, RowSums<Real>& row) {
  for (int k = 0; k < n; ++k) {
    const Given<Real>& g = given[k];
    for (int of = 0; of < 3; ++of) add_by_N(g.w.x, g.by_N[of], row[of]);
    add_by_dN(g.w.x, g.s_xx, row[3]), add_by_dN(g.w.x, g.s_xy_x, row[4]);
  }
  finish_row<Real>(row);
}
template <class Real>
[[gnu::always_inline]] inline void sum_outer_row(const Given<Real>* given, int n, bool before, RowSums<Real>& row) {
  for (int k = 0; k < n; ++k) {
    const Given<Real>& g = given[k];
    const Real N = before ? g.w.y.N_before : g.w.y.N_after, dN = before ? g.w.y.dN_before : g.w.y.dN_after;
    for (int of = 0; of < 3; ++of) add_by_N<Real>(g.w.x, N * g.by_N[of], row[of]);
    add_by_N<Real>(g.w.x, dN * g.s_xy_y, row[3]), add_by_dN<Real>(g.w.x, N * g.s_xx, row[3]);
    add_by_N<Real>(g.w.x, dN * g.s_yy, row[4]), add_by_dN<Real>(g.w.x, N * g.s_xy_x, row[4]);
  }
  finish_row<Real>(row);
}

template <class Real>
[[gnu::always_inline]] inline void subtract(const RowSums<Real>& row, RowSums<Real>& from) {
  for (std::size_t of = 0; of < 5; ++of) {
    for (std::size_t a = 0; a < 3; ++a) from[of][a] -= row[of][a];
  }
}

// Adds a row's sums to the nodes, whose records are `record`. Lane l adds to the nodes l, l + 1 and l + 2 of the row:
// where their records follow each other, what lanes meet at is added up before it goes to memory; beside a cut, where
// nodes and copies take turns, it goes there one after the other.
template <class Lanes>
[[gnu::always_inline]] inline void add_row(const Lanes lanes, const int* record,
                                           const RowSums<typename Lanes::Real>& row, const SweepArrays& to) {
  const bool follow = record[1] == record[0] + 1 && record[2] == record[0] + 2;
  for (std::size_t of = 0; of < 5; ++of) {
    double* const array = to.sums[of];
    if constexpr (!std::is_same_v<Lanes, OneLane>) {
      if (follow) {
        lanes.add_shifted(array + record[0], row[of][0], row[of][1], row[of][2]);
        continue;
      }
    }
    for (std::size_t a = 0; a < 3; ++a) lanes.store(array + record[a], lanes.load(array + record[a]) + row[of][a]);
  }
}

template <class Lanes>
[[gnu::always_inline]] inline void add_given(const Lanes lanes, const Bin& bin,
                                             const Given<typename Lanes::Real>* given, int n, const SweepArrays& to) {
  using Real = typename Lanes::Real;
  RowSums<Real> before{}, middle{}, after{};
  sum_all_rows(given, n, middle);
  sum_outer_row(given, n, true, before);
  subtract<Real>(before, middle);
  add_row(lanes, bin.record.data(), before, to);
  sum_outer_row(given, n, false, after);
  subtract<Real>(after, middle);
  add_row(lanes, bin.record.data() + 6, after, to);
  add_row(lanes, bin.record.data() + 3, middle, to);
}

/// Sweeps the particles q = first, first + stride, ... below last of a block of bins whose first lane is `bin`; lanes'
/// records follow that bin's one by one. Moves them (Move) by node_v and take over a step, and adds what they then give
/// to the nodes' sums (Gather); rocks: of all particles, the same in all lanes. Throws nothing.
template <class Shape, bool Move, bool Gather, class Lanes>
void sweep_block(const Lanes lanes, const Rocks& rocks, const SweepStep& step, const BlockSpans<Lanes>& at,
                 const Bin& bin, const SweepArrays& arrays, MotionReport<typename Lanes::Real>& report) {
  using Real = typename Lanes::Real;
  constexpr int together = 4;  // particles of a lane whose weights are kept until their sums are formed
  constexpr bool block = !std::is_same_v<Lanes, OneLane>;
  if constexpr (block) fetch_nodes<Move, Gather>(arrays, static_cast<std::size_t>(bin.record[6]) + nodes_ahead);
  Coefficients<Real> c;
  if constexpr (Move) {
    for (int of = 0; of < 4; ++of) load_coefficients(lanes, bin, arrays.motion[of], c[of]);
  }
  Given<Real> given[together];
  int n = 0;
  for (int first = bin.first; first < bin.last; first += bin.stride) {
    const auto q = static_cast<std::size_t>(first);
    const Elasticity& rock = rocks[arrays.rock[q]];
    const ParticleSizes<Real> size{Shape::template size<Real>(lanes, arrays.half_x + q, at.x.per_length),
                                   Shape::template size<Real>(lanes, arrays.half_y + q, at.y.per_length)};
    if constexpr (block) fetch_particles<Move>(arrays, q + particles_ahead);
    ParticleState<Real> is = load_particles(lanes, arrays, q);
    if constexpr (Move) {
      const Real off_x = (is.x - at.x.node) * at.x.per_length, off_y = (is.y - at.y.node) * at.y.per_length;
      report.farthest_cells =
          larger(report.farthest_cells, lanes.used(larger(larger(off_x, -off_x), larger(off_y, -off_y))));
      const PlaceWeights<Real> w = weights_at<Shape>(at, is.x, is.y, size);
      move(lanes, arrays, step, at, c, w, rock, q, is, report);
    }
    if constexpr (Gather) {
      Given<Real>& to = given[n++];
      to.w = weights_at<Shape>(at, is.x, is.y, size);
      give(lanes, arrays, at, rock, q, is, to);
      if (n == together || first + bin.stride >= bin.last) add_given(lanes, bin, given, n, arrays), n = 0;
    }
  }
}

}  // namespace strata
