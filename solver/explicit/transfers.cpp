#include "explicit/transfers.hpp"

#include <algorithm>
#include <array>

#include "explicit/sweep.hpp"
#include "state/parts.hpp"

namespace strata {

namespace {

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
        sums->clear(part.first, part.last);
      }
    }
    for (int colour = 0; colour < 2; ++colour) {
#pragma omp for schedule(static)
      for (int k = colour; k < n; k += 2) work(static_cast<std::size_t>(k));
    }
  }
}

// The spans of a block of bins, along y the same in all lanes.
template <class L, class Real = typename L::Real>
BothAxes<Span<Real>> spans_of(const State& state, const Bin& bin) {
  const SpanTable &x = state.x_spans, &y = state.y_spans;
  const auto i = static_cast<std::size_t>(bin.i) + 1, j = static_cast<std::size_t>(bin.j) + 1;
  return {{L::load(&x.node[i]), L::load(&x.per_length[i]), {L::load(&x.share_before[i]), L::load(&x.share_after[i])}},
          {Real{} + y.node[j], Real{} + y.per_length[j], {Real{} + y.share_before[j], Real{} + y.share_after[j]}}};
}

// A strip's bins, block by block.
template <class Shape>
ParticleReport sweep_strip(const Sweep& sweep, const State& state, const Strip& strip) {
  LaneReport lanes{};
  for (int b = strip.first; b < strip.last;) {
    const Bin& bin = state.bins[static_cast<std::size_t>(b)];
    with_lanes(bin.stride, [&](auto of) {
      using L = decltype(of);
      sweep_block<Shape, L>(sweep, spans_of<L>(state, bin), bin, lanes);
    });
    b += bin.stride;
  }
  ParticleReport report;
  for (std::size_t l = 0; l < most_lanes; ++l) {
    report += {0.5 * lanes.before[l], 0.5 * lanes.after[l], 0.5 * lanes.step_strain[l], lanes.largest_speed2[l],
               lanes.farthest_cells[l]};
  }
  return report;
}

ParticleReport sweep(const Scene& scene, const Rocks& rocks, const Uptake& uptake, bool moves, bool gathers,
                     State& state) {
  state.reports.assign(state.strips.size(), {});
  const NodalMotion& by = state.motion;
  NodalSums& to = state.sums;
  const Sweep sweep{moves,
                    gathers,
                    state.dt,
                    uptake.keep,
                    rocks,
                    state.particles,
                    {by.v_x.data(), by.v_y.data(), uptake.x->data(), uptake.y->data()},
                    {to.m.data(), to.mom_x.data(), to.mom_y.data(), to.f_x.data(), to.f_y.data()}};
  with_shape(scene.numerics.shape, [&](auto shape) {
    for_each_strip(state, gathers ? &to : nullptr, [&](std::size_t k) {
      state.reports[k] = sweep_strip<decltype(shape)>(sweep, state, state.strips[k]);
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
  sweep(scene, rocks, {1.0, &state.motion.dv_x, &state.motion.dv_y}, false, true, state);
}

ParticleReport grid_to_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  return sweep(scene, rocks, uptake, true, false, state);
}

ParticleReport sweep_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  return sweep(scene, rocks, uptake, true, true, state);
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
    for (std::size_t r = part.first; r < part.last; ++r) state.sums.f_x[r] += to.f_x[r], state.sums.f_y[r] += to.f_y[r];
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
