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

SweepArrays arrays_of(const Uptake& uptake, State& state) {
  Particles& p = state.particles;
  const NodalMotion& by = state.motion;
  NodalSums& to = state.sums;
  SweepArrays a{};
  a.x = p.x.data(), a.y = p.y.data(), a.u_x = p.u_x.data(), a.u_y = p.u_y.data();
  a.v_x = p.v_x.data(), a.v_y = p.v_y.data(), a.g_xx = p.g_xx.data(), a.g_xy = p.g_xy.data();
  a.g_yx = p.g_yx.data(), a.g_yy = p.g_yy.data(), a.m = p.m.data(), a.V = p.V.data();
  a.half_x = p.half_x.data(), a.half_y = p.half_y.data(), a.rock = p.rock.data();
  std::ranges::copy(std::array{by.v_x.data(), by.v_y.data(), uptake.x->data(), uptake.y->data()}, a.motion);
  std::ranges::copy(std::array{to.m.data(), to.mom_x.data(), to.mom_y.data(), to.f_x.data(), to.f_y.data()}, a.sums);
  return a;
}

template <class Lanes>
BlockSpans<Lanes> spans_of(const Lanes lanes, const SpanTable& x, const SpanTable& y, const Bin& bin) {
  const auto i = static_cast<std::size_t>(bin.i) + 1, j = static_cast<std::size_t>(bin.j) + 1;
  const auto load = [&](const std::vector<double>& table) { return lanes.load(table.data() + i); };
  return {{load(x.node), load(x.per_length), {load(x.share_before), load(x.share_after)}},
          {y.node[j], y.per_length[j], {y.share_before[j], y.share_after[j]}}};
}

// Takes up a report with its energies times `share`.
template <class Real>
void add(const MotionReport<Real>& more, double share, ParticleReport& to) {
  to.before += share * sum_of_lanes(more.before), to.after += share * sum_of_lanes(more.after);
  to.step_strain += share * sum_of_lanes(more.step_strain);
  to.largest_speed2 = std::max(to.largest_speed2, largest_lane(more.largest_speed2));
  to.farthest_cells = std::max(to.farthest_cells, largest_lane(more.farthest_cells));
}

// A strip's bins, block by block; those that stand alone one by one.
template <class Shape, bool Move, bool Gather>
ParticleReport sweep_strip(const Rocks& rocks, const SweepStep& step, const State& state, const SweepArrays& arrays,
                           const Strip& strip) {
  MotionReport<Lane> of_blocks;
  ParticleReport of_bins;
  for (int b = strip.first; b < strip.last;) {
    const Bin& bin = state.bins[static_cast<std::size_t>(b)];
    fetch(&bin, bins_ahead);
    const auto sweep = [&](const auto lanes, auto& report) {
      const auto at = spans_of(lanes, state.x_spans, state.y_spans, bin);
      sweep_block<Shape, Move, Gather>(lanes, rocks, step, at, bin, arrays, report);
    };
    if (bin.stride == most_lanes) {
      sweep(AllLanes{}, of_blocks);
    } else if (bin.stride > 1) {
      sweep(FirstLanes{bin.stride}, of_blocks);
    } else {
      sweep(OneLane{}, of_bins);
    }
    b += bin.stride;
  }
  ParticleReport report;
  add(of_blocks, 0.5, report), add(of_bins, 0.5, report);
  return report;
}

template <bool Move, bool Gather>
ParticleReport sweep(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  state.reports.assign(state.strips.size(), {});
  const SweepArrays arrays = arrays_of(uptake, state);
  const SweepStep step{state.dt, uptake.keep};
  with_shape(scene.numerics.shape, [&](auto shape) {
    for_each_strip(state, Gather ? &state.sums : nullptr, [&](std::size_t k) {
      state.reports[k] = sweep_strip<decltype(shape), Move, Gather>(rocks, step, state, arrays, state.strips[k]);
    });
  });
  ParticleReport total;  // strip by strip: its digits do not depend on the number of threads
  for (const ParticleReport& of_strip : state.reports) add(of_strip, 1.0, total);
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
  const Uptake none{1.0, &state.motion.dv_x, &state.motion.dv_y};
  sweep<false, true>(scene, rocks, none, state);
  state.gathered = false;  // the caller goes on from them
}

ParticleReport grid_to_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  state.gathered = false;
  return sweep<true, false>(scene, rocks, uptake, state);
}

ParticleReport sweep_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state) {
  const ParticleReport report = sweep<true, true>(scene, rocks, uptake, state);
  state.gathered = true;
  return report;
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
  for_each_part(to.size(), [&](std::size_t /*part*/, const Part& part) {
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
