#include "mechanics/transfers.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "state/shape_functions.hpp"

namespace strata {

namespace {

// Short vectors of the compiler: a node record is one of them, so a record takes one instruction where the machine has
// it.
typedef double Four __attribute__((vector_size(32)));
typedef double Eight __attribute__((vector_size(64)));

template <class Vector, class Record>
Vector load(const Record& record) {
  return std::bit_cast<Vector>(record);
}

// Calls work(strip index) for all strips, one colour after the other; strips of a colour run on any number of threads.
template <class Work>
void for_each_strip(const State& state, Work work) {
  const int n = static_cast<int>(state.strips.size());
  for (int colour = 0; colour < 2; ++colour) {
#pragma omp parallel for schedule(dynamic, 1)
    for (int k = colour; k < n; k += 2) work(static_cast<std::size_t>(k));
  }
}

// Shape functions of a particle along both axes, derivatives per metre.
struct AxisWeights {
  Weights x, y;
};

template <class Shape>
inline AxisWeights axis_weights(double inverse_h, const Bin& bin, const Particles& p, std::size_t q) {
  AxisWeights w{Shape::at(p.x[q] * inverse_h - bin.i, p.half[q] * inverse_h),
                Shape::at(p.y[q] * inverse_h - bin.j, p.half[q] * inverse_h)};
  for (std::size_t a = 0; a < 3; ++a) {
    w.x.dN[a] *= inverse_h;
    w.y.dN[a] *= inverse_h;
  }
  return w;
}

// Both loops take the product of the two axes' functions one axis at a time: a row of nodes first, then its three
// nodes.
// Bodies: whether there is a body force `body`, one a particle.
template <class Shape, bool Bodies>
void gather_bin(const std::vector<Elasticity>& rocks, const Grid& grid, const Particles& p, const Vec2* body,
                const Bin& bin, std::vector<NodeSums>& sums) {
  const double inverse_h = 1.0 / grid.h;
  std::array<Eight, 9> acc{};
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last); ++q) {
    const AxisWeights w = axis_weights<Shape>(inverse_h, bin, p, q);
    const Stress s = stress_of(rocks[p.rock[q]], p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
    const double m = p.m[q], V = p.V[q];
    Eight with_N = {m, m * p.v_x[q], m * p.v_y[q], 0.0, 0.0, 0.0, 0.0, 0.0};
    if constexpr (Bodies) with_N[3] = m * body[q].x(), with_N[4] = m * body[q].y();
    const Eight with_N_x = {0.0, 0.0, 0.0, -V * s.xx, -V * s.xy, 0.0, 0.0, 0.0};
    const Eight with_N_y = {0.0, 0.0, 0.0, -V * s.xy, -V * s.yy, 0.0, 0.0, 0.0};
    for (std::size_t b = 0; b < 3; ++b) {
      const Eight along_N = w.y.N[b] * with_N + w.y.dN[b] * with_N_y;
      const Eight along_dN = w.y.N[b] * with_N_x;
      for (std::size_t a = 0; a < 3; ++a) acc[3 * b + a] += w.x.N[a] * along_N + w.x.dN[a] * along_dN;
    }
  }
  for (std::size_t n = 0; n < 9; ++n) {
    NodeSums& record = sums[static_cast<std::size_t>(bin.record[n])];
    record = std::bit_cast<NodeSums>(load<Eight>(record) + acc[n]);
  }
}

struct Advance {
  double dt, keep;
  double dt_x;  // for positions: dt, or 0 where they stay
};

template <class Shape, bool Bodies>
void move_bin(const std::vector<Elasticity>& rocks, const Grid& grid, const Bin& bin, const Advance& by,
              const std::vector<NodeMotion>& motion, const Vec2* body, Particles& p, ParticleReport& report) {
  const double inverse_h = 1.0 / grid.h, half_dt2 = 0.5 * by.dt * by.dt;
  std::array<Four, 9> record;
  for (std::size_t n = 0; n < 9; ++n) record[n] = load<Four>(motion[static_cast<std::size_t>(bin.record[n])]);
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last); ++q) {
    const AxisWeights w = axis_weights<Shape>(inverse_h, bin, p, q);
    Four v = {0.0, 0.0, 0.0, 0.0}, d_x = v, d_y = v;
    for (std::size_t b = 0; b < 3; ++b) {
      const Four row = w.x.N[0] * record[3 * b] + w.x.N[1] * record[3 * b + 1] + w.x.N[2] * record[3 * b + 2];
      const Four slope = w.x.dN[0] * record[3 * b] + w.x.dN[1] * record[3 * b + 1] + w.x.dN[2] * record[3 * b + 2];
      v += w.y.N[b] * row;
      d_x += w.y.N[b] * slope;
      d_y += w.y.dN[b] * row;
    }
    const double m = p.m[q];
    report.before += 0.5 * m * (p.v_x[q] * p.v_x[q] + p.v_y[q] * p.v_y[q]);
    p.v_x[q] = by.keep * p.v_x[q] + v[2];
    p.v_y[q] = by.keep * p.v_y[q] + v[3];
    const double speed2 = p.v_x[q] * p.v_x[q] + p.v_y[q] * p.v_y[q];
    report.after += 0.5 * m * speed2;
    report.largest_speed2 = std::max(report.largest_speed2, speed2);
    const double off_x = std::abs(p.x[q] * inverse_h - bin.i), off_y = std::abs(p.y[q] * inverse_h - bin.j);
    report.farthest_cells = std::max(report.farthest_cells, std::max(off_x, off_y));
    p.x[q] += by.dt_x * v[0], p.y[q] += by.dt_x * v[1];
    p.u_x[q] += by.dt * v[0], p.u_y[q] += by.dt * v[1];
    if constexpr (Bodies) report.body_work += m * by.dt * (body[q].x() * v[0] + body[q].y() * v[1]);
    const Stress rate = stress_of(rocks[p.rock[q]], d_x[0], d_y[0], d_x[1], d_y[1]);
    report.step_strain += half_dt2 * p.V[q] * (rate.xx * d_x[0] + rate.yy * d_y[1] + rate.xy * (d_y[0] + d_x[1]));
    p.g_xx[q] += by.dt * d_x[0], p.g_yx[q] += by.dt * d_x[1];
    p.g_xy[q] += by.dt * d_y[0], p.g_yy[q] += by.dt * d_y[1];
  }
}

template <class Shape>
void filter_bin(const Grid& grid, const Particles& p, const Bin& bin, const std::vector<Vec2>& v,
                std::vector<NodeSums>& sums) {
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last); ++q) {
    const AxisWeights w = axis_weights<Shape>(1.0 / grid.h, bin, p, q);
    const auto N = [&w](std::size_t n) { return w.x.N[n % 3] * w.y.N[n / 3]; };
    Vec2 v_p = Vec2::Zero();
    for (std::size_t n = 0; n < 9; ++n) v_p += N(n) * v[static_cast<std::size_t>(bin.record[n])];
    for (std::size_t n = 0; n < 9; ++n) {
      NodeSums& record = sums[static_cast<std::size_t>(bin.record[n])];
      record.m += N(n) * p.m[q];
      record.mom_x += N(n) * p.m[q] * v_p.x();
      record.mom_y += N(n) * p.m[q] * v_p.y();
    }
  }
}

}  // namespace

void particles_to_grid(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  std::fill(state.sums.begin(), state.sums.end(), NodeSums{});
  with_shape(scene.numerics.shape, [&](auto shape) {
    for_each_strip(state, [&](std::size_t k) {
      for (int b = state.strips[k].first; b < state.strips[k].last; ++b) {
        const Bin& bin = state.bins[static_cast<std::size_t>(b)];
        if (state.body.empty()) {
          gather_bin<decltype(shape), false>(rocks, state.grid, state.particles, nullptr, bin, state.sums);
        } else {
          gather_bin<decltype(shape), true>(rocks, state.grid, state.particles, state.body.data(), bin, state.sums);
        }
      }
    });
  });
}

std::vector<Vec2> filter_velocity(const Scene& scene, State& state, const std::vector<Vec2>& v) {
  std::vector<NodeSums> sums(v.size());
  with_shape(scene.numerics.shape, [&](auto shape) {
    for_each_strip(state, [&](std::size_t k) {
      for (int b = state.strips[k].first; b < state.strips[k].last; ++b) {
        filter_bin<decltype(shape)>(state.grid, state.particles, state.bins[static_cast<std::size_t>(b)], v, sums);
      }
    });
  });
  fold_to_masters(state, sums);
  std::vector<Vec2> filtered(v.size(), Vec2::Zero());
  for (std::size_t r = 0; r < v.size(); ++r) {
    if (sums[r].m > 0.0) filtered[r] = Vec2{sums[r].mom_x, sums[r].mom_y} / sums[r].m;
  }
  return filtered;
}

ParticleReport grid_to_particles(const Scene& scene, const std::vector<Elasticity>& rocks, State& state, double keep) {
  std::vector<ParticleReport> of_strip(state.strips.size());
  const Advance by{state.dt, keep, scene.numerics.keeps_places() ? 0.0 : state.dt};
  with_shape(scene.numerics.shape, [&](auto shape) {
    for_each_strip(state, [&](std::size_t k) {
      for (int b = state.strips[k].first; b < state.strips[k].last; ++b) {
        const Bin& bin = state.bins[static_cast<std::size_t>(b)];
        if (state.body.empty()) {
          move_bin<decltype(shape), false>(rocks, state.grid, bin, by, state.motion, nullptr, state.particles,
                                           of_strip[k]);
        } else {
          move_bin<decltype(shape), true>(rocks, state.grid, bin, by, state.motion, state.body.data(), state.particles,
                                          of_strip[k]);
        }
      }
    });
  });
  ParticleReport total;  // summed strip by strip, so that the digits do not depend on the number of threads
  for (const ParticleReport& e : of_strip) {
    total.before += e.before;
    total.after += e.after;
    total.body_work += e.body_work;
    total.step_strain += e.step_strain;
    total.largest_speed2 = std::max(total.largest_speed2, e.largest_speed2);
    total.farthest_cells = std::max(total.farthest_cells, e.farthest_cells);
  }
  return total;
}

void fold_to_masters(const State& state, std::vector<NodeSums>& sums) {
  for (const int record : state.tied) {
    const Master& master = state.masters[static_cast<std::size_t>(record)];
    NodeSums own = sums[static_cast<std::size_t>(record)];
    own.mom_x *= master.x, own.f_x *= master.x;
    own.mom_y *= master.y, own.f_y *= master.y;
    if (master.record == record) {
      sums[static_cast<std::size_t>(record)] = own;
      continue;
    }
    NodeSums& inside = sums[static_cast<std::size_t>(master.record)];
    inside.m += own.m;
    inside.mom_x += own.mom_x, inside.mom_y += own.mom_y;
    inside.f_x += own.f_x, inside.f_y += own.f_y;
    sums[static_cast<std::size_t>(record)] = NodeSums{};
  }
}

}  // namespace strata
