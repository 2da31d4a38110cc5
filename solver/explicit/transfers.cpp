#include "explicit/transfers.hpp"

#include <array>

#include "state/lanes.hpp"
#include "state/parts.hpp"
#include "state/shape_functions.hpp"

namespace strata {

namespace {

// --- the kernel

// Motion from nodes to particles, stress, and sums of mass, momentum and internal force back to nodes, for one block of
// bins: neighbours along a row, each a lane (see Bin). Interpolation is a product of the two axes, a row of nodes
// first. On each axis the weights of three nodes sum to 1 and their derivatives to 0, so that only those of the outer
// two are formed: with E_b = r_b - r_0 (b = before, after) of the middle node's value r_0,
//   sum_a N_a r_a = r_0 + N_b E_b + N_a E_a,  sum_a dN_a r_a = dN_b E_b + dN_a E_a,
// and what particles give to the middle node is the whole less the outer two. No digits are lost: the middle node's
// weight is the largest.

// What a sweep works on: particles take up (moves) the motion of nodes (v_x, v_y and what their velocities take up,
// along x and y) over a step, nodes gather (gathers) what particles then give them (m, mom_x, mom_y, f_x, f_y), or
// both.
struct Sweep {
  double dt = 0.0;    // s
  double keep = 1.0;  // share of their own velocity that particles keep
  const Rocks& rocks;
  const SpanTable &x_spans, &y_spans;
  Particles& p;
  std::array<const double*, 4> motion;
  std::array<double*, 5> sums;
};

// Reports of particles, lane by lane.
using LaneReport = MotionReport<double[most_lanes]>;

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

// Where particles are, and what moves and strains with them.
template <class Real>
struct ParticleState {
  Real x, y, v_x, v_y, g_xx, g_xy, g_yx, g_yy;
};

// Outer weights of particles with the half sizes `half` (spans).
template <class Shape, class Real>
[[gnu::always_inline]] inline BothAxes<OuterWeights<Real>> weights_at(const BothAxes<Span<Real>>& span,
                                                                      const ParticleState<Real>& is,
                                                                      const BothAxes<Real>& half) {
  return {Shape::outer((is.x - span.x.node) * span.x.per_length, span.x.share, half.x),
          Shape::outer((is.y - span.y.node) * span.y.per_length, span.y.share, half.y)};
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
[[gnu::always_inline]] inline Real along(const std::array<Real, 3>& c, const OuterWeights<Real>& w) {
  return c[1] + w.N[0] * c[0] + w.N[1] * c[2];
}
template <class Real>
[[gnu::always_inline]] inline Real slope(const std::array<Real, 3>& c, const OuterWeights<Real>& w) {
  return w.dN[0] * c[0] + w.dN[1] * c[2];
}

template <class Real>
[[gnu::always_inline]] inline Interpolated<Real> interpolate(const Coefficients<Real>& c,
                                                             const BothAxes<OuterWeights<Real>>& w) {
  const std::array<Real, 3> rows{along(c[0], w.x), along(c[1], w.x), along(c[2], w.x)};
  const std::array<Real, 3> slopes{slope(c[0], w.x), slope(c[1], w.x), slope(c[2], w.x)};
  return {along(rows, w.y), along(slopes, w.y), slope(rows, w.y)};
}

// Moves the particles at q, which are as `is` says, by the motion c of their nodes.
template <class L, class Real = typename L::Real>
[[gnu::always_inline]] inline void move(const Sweep& sweep, const BothAxes<Span<Real>>& span,
                                        const std::array<Coefficients<Real>, 4>& c,
                                        const BothAxes<OuterWeights<Real>>& w, const Elasticity& rock, std::size_t q,
                                        ParticleState<Real>& is, MotionReport<Real>& report) {
  const auto add = [](double* to, const Real& by) { L::store(to, L::load(to) + by); };
  const auto change = [&](SpreadArray& array, Real& value, const Real& by) { L::store(&array[q], value += by); };
  Particles& p = sweep.p;
  const Real off_x = (is.x - span.x.node) * span.x.per_length, off_y = (is.y - span.y.node) * span.y.per_length;
  const Real off = larger<Real>(larger<Real>(off_x, -off_x), larger<Real>(off_y, -off_y));
  report.farthest_cells = larger<Real>(report.farthest_cells, off);
  const Interpolated<Real> x = interpolate(c[0], w), y = interpolate(c[1], w);
  const Real m = L::load(&p.m[q]), V = L::load(&p.V[q]);
  report.before += m * (is.v_x * is.v_x + is.v_y * is.v_y);
  is.v_x = sweep.keep * is.v_x + interpolate(c[2], w).value, is.v_y = sweep.keep * is.v_y + interpolate(c[3], w).value;
  L::store(&p.v_x[q], is.v_x), L::store(&p.v_y[q], is.v_y);
  const Real speed2 = is.v_x * is.v_x + is.v_y * is.v_y;
  report.after += m * speed2;
  report.largest_speed2 = larger<Real>(report.largest_speed2, speed2);
  change(p.x, is.x, sweep.dt * x.value), change(p.y, is.y, sweep.dt * y.value);
  add(&p.u_x[q], sweep.dt * x.value), add(&p.u_y[q], sweep.dt * y.value);
  const Real by_x = sweep.dt * span.x.per_length, by_y = sweep.dt * span.y.per_length;
  const Real e_xx = by_x * x.d_x, e_xy = by_y * x.d_y, e_yx = by_x * y.d_x, e_yy = by_y * y.d_y;
  change(p.g_xx, is.g_xx, e_xx), change(p.g_xy, is.g_xy, e_xy);
  change(p.g_yx, is.g_yx, e_yx), change(p.g_yy, is.g_yy, e_yy);
  const Real shear = e_xy + e_yx, trace = e_xx + e_yy;
  report.step_strain += V * (rock.lambda * trace * trace + 2.0 * rock.mu * (e_xx * e_xx + e_yy * e_yy) +
                             rock.mu * shear * shear);  // V dsigma : de
}

// What particles give to their nodes: mass and momentum by N, and -V sigma, each component with the 1/length of the
// axis along which it meets dN.
template <class Real>
struct Given {
  BothAxes<OuterWeights<Real>> w;
  Real m, mom_x, mom_y;
  Real s_xx, s_xy_x;  // with dN/dx into f_x and f_y
  Real s_xy_y, s_yy;  // with dN/dy
};

template <class L, class Real = typename L::Real>
[[gnu::always_inline]] inline void give(const Particles& p, const BothAxes<Span<Real>>& span, const Elasticity& rock,
                                        std::size_t q, const ParticleState<Real>& is, Given<Real>& to) {
  const Real m = L::load(&p.m[q]), V = L::load(&p.V[q]), V_x = -V * span.x.per_length, V_y = -V * span.y.per_length;
  const Real trace = rock.lambda * (is.g_xx + is.g_yy), s_xy = rock.mu * (is.g_xy + is.g_yx);
  to.m = m, to.mom_x = m * is.v_x, to.mom_y = m * is.v_y;
  to.s_xx = V_x * (trace + 2.0 * rock.mu * is.g_xx), to.s_xy_x = V_x * s_xy;
  to.s_yy = V_y * (trace + 2.0 * rock.mu * is.g_yy), to.s_xy_y = V_y * s_xy;
}

// Sums on one row of a bin's nodes.
template <class Real>
using RowSums = Real[5][3];

// Those of row b, or of all three rows in the place of the middle one.
template <std::size_t b, class Real>
[[gnu::always_inline]] inline void sum_row(const Given<Real>* given, int n, RowSums<Real>& row) {
  for (int k = 0; k < n; ++k) {
    const Given<Real>& g = given[k];
    const Real N = b == 1 ? Real{} + 1.0 : g.w.y.N[b / 2], dN = g.w.y.dN[b / 2];
    const Real by_N[5] = {N * g.m, N * g.mom_x, N * g.mom_y, dN * g.s_xy_y, dN * g.s_yy};
    const Real by_dN[2] = {N * g.s_xx, N * g.s_xy_x};
    for (std::size_t of = 0; of < (b == 1 ? 3 : 5); ++of) {
      for (std::size_t a = 0; a < 3; ++a) row[of][a] += a == 1 ? by_N[of] : g.w.x.N[a / 2] * by_N[of];
    }
    for (std::size_t of = 0; of < 2; ++of)
      row[3 + of][0] += g.w.x.dN[0] * by_dN[of], row[3 + of][2] += g.w.x.dN[1] * by_dN[of];
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

// How far ahead memory is asked for what a sweep goes through: about three blocks of 4 particles a cell. Its arrays are
// more than the hardware foresees. A hint: an address that is nobody's does no harm.
constexpr std::size_t particles_ahead = std::size_t{12} * most_lanes;

/// Sweeps the particles q = first, first + stride, ... below last of a block of bins whose first lane is `bin`; lanes'
/// records follow that bin's one by one, and the rock is the same in all lanes. Throws nothing.
template <class Shape, bool moves, bool gathers, class L>
void sweep_block(const Sweep& sweep, const Bin& bin, LaneReport& of) {
  using Real = typename L::Real;
  constexpr int together = 4;                 // particles of a lane whose weights are kept until their sums are formed
  __builtin_prefetch(&bin + 3 * most_lanes);  // a hint, of the first alone of each block
  const SpanTable &x = sweep.x_spans, &y = sweep.y_spans;
  const auto i = static_cast<std::size_t>(bin.i) + 1, j = static_cast<std::size_t>(bin.j) + 1;
  const BothAxes<Span<Real>> span{
      {L::load(&x.node[i]), L::load(&x.per_length[i]), {L::load(&x.share_before[i]), L::load(&x.share_after[i])}},
      {Real{} + y.node[j], Real{} + y.per_length[j], {Real{} + y.share_before[j], Real{} + y.share_after[j]}}};
  std::array<Coefficients<Real>, 4> c;
  if constexpr (moves) {
    for (std::size_t of = 0; of < 4; ++of) load_coefficients<L>(sweep.motion[of], bin, c[of]);
  }
  MotionReport<Real> report{L::load(of.before), L::load(of.after), L::load(of.step_strain), L::load(of.largest_speed2),
                            L::load(of.farthest_cells)};
  Given<Real> given[together];
  int n = 0;
  for (const std::size_t q : bin) {
    const Particles& p = sweep.p;
    const Elasticity& rock = sweep.rocks[p.rock[q]];
    for (const SpreadArray* array : {&p.x, &p.y, &p.v_x, &p.v_y, &p.g_xx, &p.g_xy, &p.g_yx, &p.g_yy})
      __builtin_prefetch(array->data() + q + particles_ahead);
    if constexpr (moves) {
      for (const SpreadArray* array : {&p.u_x, &p.u_y}) __builtin_prefetch(array->data() + q + particles_ahead);
    }
    ParticleState<Real> is{L::load(&p.x[q]),    L::load(&p.y[q]),    L::load(&p.v_x[q]),  L::load(&p.v_y[q]),
                           L::load(&p.g_xx[q]), L::load(&p.g_xy[q]), L::load(&p.g_yx[q]), L::load(&p.g_yy[q])};
    BothAxes<Real> half{};
    if constexpr (Shape::has_size)
      half = {L::load(&p.half_x[q]) * span.x.per_length, L::load(&p.half_y[q]) * span.y.per_length};
    if constexpr (moves) move<L>(sweep, span, c, weights_at<Shape>(span, is, half), rock, q, is, report);
    if constexpr (gathers) {
      given[n].w = weights_at<Shape>(span, is, half);
      give<L>(p, span, rock, q, is, given[n++]);
      const bool last = static_cast<int>(q) + bin.stride >= bin.last;
      if (n == together || last) add_given<L>(given, n, bin, sweep.sums), n = 0;
    }
  }
  L::store(of.before, report.before), L::store(of.after, report.after), L::store(of.step_strain, report.step_strain);
  L::store(of.largest_speed2, report.largest_speed2), L::store(of.farthest_cells, report.farthest_cells);
}

// --- all particles

// Sets `sums`, if any, to 0 and then calls work(strip index) for all strips, one colour after the other; strips of a
// colour run on any number of threads.
template <class Work>
void for_each_strip(const State& state, NodalSums* sums, Work work) {
  const int n = static_cast<int>(state.strips.size());
  if (sums != nullptr && sums->size() != state.masters.size()) sums->clear(state.masters.size());
#pragma omp parallel
  {
    if (sums != nullptr) {
#pragma omp for schedule(static)
      for (std::size_t k = 0; k < record_parts; ++k) {
        const Part part = part_of(sums->size(), k);
        for (auto* array : {&sums->m, &sums->mom_x, &sums->mom_y, &sums->f_x, &sums->f_y}) part.of(*array) = 0.0;
      }
    }
    for (int colour = 0; colour < 2; ++colour) {
#pragma omp for schedule(static)
      for (int k = colour; k < n; k += 2) work(static_cast<std::size_t>(k));
    }
  }
}

// A strip's bins, block by block.
template <class Shape, bool moves, bool gathers>
ParticleReport sweep_strip(const Sweep& sweep, const State& state, const Strip& strip) {
  LaneReport lanes{};
  for (int b = strip.first; b < strip.last;) {
    const Bin& bin = state.bins[static_cast<std::size_t>(b)];
    with_lanes(bin.stride, [&](auto of) { sweep_block<Shape, moves, gathers, decltype(of)>(sweep, bin, lanes); });
    b += bin.stride;
  }
  ParticleReport report;
  for (std::size_t l = 0; l < most_lanes; ++l) {
    report += {0.5 * lanes.before[l], 0.5 * lanes.after[l], 0.5 * lanes.step_strain[l], lanes.largest_speed2[l],
               lanes.farthest_cells[l]};
  }
  return report;
}

template <bool moves, bool gathers>
ParticleReport sweep(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  state.reports.assign(state.strips.size(), {});
  const NodalMotion& by = state.motion;
  NodalSums& to = state.sums;
  const Sweep sweep{state.dt,
                    uptake.keep,
                    rocks,
                    state.x_spans,
                    state.y_spans,
                    state.particles,
                    {by.v_x.data(), by.v_y.data(), uptake.x->data(), uptake.y->data()},
                    {to.m.data(), to.mom_x.data(), to.mom_y.data(), to.f_x.data(), to.f_y.data()}};
  with_shape(scene.numerics.shape, [&](auto shape) {
    for_each_strip(state, gathers ? &to : nullptr, [&](std::size_t k) {
      state.reports[k] = sweep_strip<decltype(shape), moves, gathers>(sweep, state, state.strips[k]);
    });
  });
  state.gathered = moves && gathers;  // the caller of what gathers alone goes on from the sums
  ParticleReport total;               // strip by strip: its digits do not depend on the number of threads
  for (const ParticleReport& of_strip : state.reports) total += of_strip;
  return total;
}

// Sets `sums` to 0 and then calls visit(q, N, record) for each particle q of each bin, strip by strip, with its weights
// at the bin's nine records.
template <class Visit>
void for_each_stencil(const Scene& scene, NodalSums& sums, State& state, Visit visit) {
  with_shape(scene.numerics.shape, [&](auto shape) {
    using Shape = decltype(shape);
    const Particles& p = state.particles;
    for_each_strip(state, &sums, [&](std::size_t k) {
      for (int b = state.strips[k].first; b < state.strips[k].last; ++b) {
        const Bin& bin = state.bins[static_cast<std::size_t>(b)];
        for (const std::size_t q : bin)
          visit(q, gradients_of<Shape>(state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q)).N, bin.record);
      }
    });
  });
}

}  // namespace

void particles_to_grid(const Scene& scene, const Rocks& rocks, State& state) {
  sweep<false, true>(scene, rocks, {1.0, &state.motion.dv_x, &state.motion.dv_y}, state);
}

ParticleReport grid_to_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  return sweep<true, false>(scene, rocks, uptake, state);
}

ParticleReport sweep_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  return sweep<true, true>(scene, rocks, uptake, state);
}

void add_body_force(const Scene& scene, State& state) {
  if (state.body.empty()) return;
  NodalSums& to = state.body_sums;
  const auto add_force = [&](std::size_t q, const std::array<double, 9>& N, const std::array<int, 9>& record) {
    const Vec2 f = state.particles.m[q] * state.body[q];
    for (std::size_t n = 0; n < 9; ++n) {
      const auto r = static_cast<std::size_t>(record[n]);
      to.f_x[r] += N[n] * f.x(), to.f_y[r] += N[n] * f.y();
    }
  };
  for_each_stencil(scene, to, state, add_force);
  for_each_part(to.size(), [&](const Part& part) {
    part.of(state.sums.f_x) += part.of(to.f_x), part.of(state.sums.f_y) += part.of(to.f_y);
  });
}

void filter_velocity(const Scene& scene, State& state) {
  NodalSums& to = state.filtered;
  const NodalMotion& v = state.motion;
  const auto add_filtered = [&](std::size_t q, const std::array<double, 9>& N, const std::array<int, 9>& record) {
    double v_x = 0.0, v_y = 0.0;
    for (std::size_t n = 0; n < 9; ++n) {
      const auto r = static_cast<std::size_t>(record[n]);
      v_x += N[n] * (v.v_x[r] - v.dv_x[r]), v_y += N[n] * (v.v_y[r] - v.dv_y[r]);
    }
    for (std::size_t n = 0; n < 9; ++n) {
      const auto r = static_cast<std::size_t>(record[n]);
      const double m = N[n] * state.particles.m[q];
      to.m[r] += m, to.mom_x[r] += m * v_x, to.mom_y[r] += m * v_y;
    }
  };
  for_each_stencil(scene, to, state, add_filtered);
  fold_to_masters(state, to);
}

void fold_to_masters(const State& state, NodalSums& sums) {
  for_each_tied(state, [&](std::size_t record, const Master& master) {
    const auto to = static_cast<std::size_t>(master.record);
    NodeSums own = sums[record];
    own.mom_x *= master.x, own.f_x *= master.x;
    own.mom_y *= master.y, own.f_y *= master.y;
    if (to == record) {
      sums[record] = own;
      return;
    }
    const NodalSums::Record inside = sums[to];
    inside.m += own.m;
    inside.mom_x += own.mom_x, inside.mom_y += own.mom_y;
    inside.f_x += own.f_x, inside.f_y += own.f_y;
    sums[record] = NodeSums{};
  });
}

}  // namespace strata
