#include "explicit/total/total_operator.hpp"

#include <algorithm>
#include <cmath>

#include "explicit/total/stencil_rows.hpp"
#include "explicit/transfers.hpp"
#include "state/lanes.hpp"
#include "state/parts.hpp"
#include "state/shape_functions.hpp"

namespace strata {

namespace {

constexpr int lanes = most_lanes;
constexpr int shortest_run = 8;  // slots: below, what a run needs beside its sums is more than sharing them saves

Lane load(const double* from) {
  return AllLanes{}.load(from);
}
void store(double* to, const Lane& value) {
  AllLanes{}.store(to, value);
}

// --- building

// Runs of slots with the same row, longest first extended to the block's sides by images.
struct RunMaker {
  const Grid& grid;
  const Slots& slots;
  const StencilRows& rows;
  StencilOperator& op;
  std::vector<char> taken;

  int row(int slot) const { return rows.row_of_slot[static_cast<std::size_t>(slot)]; }
  const StencilRow& of(int slot) const { return rows.rows[static_cast<std::size_t>(row(slot))]; }
  bool is_single(int slot) const { return row(slot) >= 0 && taken[static_cast<std::size_t>(slot)] == 0; }
  bool extends(int run_row, int slot) const {
    if (slot < 0 || slot >= slots.size || row(slot) < 0 || taken[static_cast<std::size_t>(slot)] != 0) return false;
    return same_by_images(grid, slots, slot, rows.rows[static_cast<std::size_t>(run_row)], of(slot));
  }
};

// Mirrored slots that the row reads at a slot near a side, and the component that the side holds.
void note_images(RunMaker& make, const StencilRow& row, int slot) {
  const int i = column_of(make.slots, slot);
  if (i == 0 || i == make.grid.nx) make.op.held_x.push_back(slot);
  for (const StencilEntry& entry : row) {
    const int reached = slot + entry.offset, inside = mirrored_slot(make.grid, make.slots, reached);
    if (inside != reached) make.op.images.push_back({reached, inside});
  }
}

void add_run(RunMaker& make, SlotRange range) {
  const int number = make.row(range.first);
  const StencilRow& row = make.rows.rows[static_cast<std::size_t>(number)];
  for (int slot = range.first; make.extends(number, slot - 1); --slot) --range.first;
  for (int slot = range.last; make.extends(number, slot); ++slot) ++range.last;
  for (int slot = range.first; slot < range.last; ++slot) {
    make.taken[static_cast<std::size_t>(slot)] = 1;
    const int i = column_of(make.slots, slot);
    if (make.row(slot) != number || i <= 0 || i >= make.grid.nx) note_images(make, row, slot);
  }
  StencilRun run;
  run.slots = range;
  run.entry = static_cast<int>(make.op.entries.size());
  for (const bool diagonal : {false, true}) {
    for (const StencilEntry& entry : row) {
      if ((entry.xy == 0.0 && entry.yx == 0.0) != diagonal) continue;
      make.op.entries.push_back(entry);
      ++(diagonal ? run.diagonal : run.full);
    }
  }
  make.op.runs.push_back(run);
}

void find_runs(RunMaker& make) {
  for (int slot = 0; slot < make.slots.size;) {
    SlotRange range{slot, slot + 1};
    if (make.row(slot) >= 0) {
      while (range.last < make.slots.size && make.row(range.last) == make.row(slot)) ++range.last;
      if (range.last - range.first >= shortest_run) add_run(make, range);
    }
    slot = std::max(range.last, slot + 1);
  }
  auto& images = make.op.images;
  std::sort(images.begin(), images.end(), [](const SlotImage& a, const SlotImage& b) { return a.to < b.to; });
  images.erase(
      std::unique(images.begin(), images.end(), [](const SlotImage& a, const SlotImage& b) { return a.to == b.to; }),
      images.end());
}

void add_segments(const StencilRow& row, std::vector<StencilSegment>& segments) {
  const std::size_t first = segments.size();
  for (const StencilEntry& entry : row) {
    if (segments.size() == first || entry.offset >= segments.back().offset + lanes) {
      segments.emplace_back();
      segments.back().offset = entry.offset;
    }
    StencilSegment& segment = segments.back();
    const auto k = static_cast<std::size_t>(entry.offset - segment.offset);
    segment.xx[k] = entry.xx, segment.xy[k] = entry.xy, segment.yx[k] = entry.yx, segment.yy[k] = entry.yy;
  }
}

// A row of a plane each, from its first slot in use to its last.
void find_ranges(StencilOperator& op) {
  std::vector<int> used = op.slots.of_record;
  std::sort(used.begin(), used.end());
  for (const int slot : used) {
    const bool same = !op.ranges.empty() && slot / op.slots.stride == op.ranges.back().first / op.slots.stride;
    if (!same) op.ranges.push_back({slot, slot + 1});
    op.ranges.back().last = std::max(op.ranges.back().last, slot + 1);
  }
}

// All slots that no run has, with the segments of their rows.
void find_singles(const RunMaker& make) {
  std::vector<SlotRange> segments;
  for (const StencilRow& row : make.rows.rows) {
    const auto first = static_cast<int>(make.op.segments.size());
    add_segments(row, make.op.segments);
    segments.push_back({first, static_cast<int>(make.op.segments.size())});
  }
  for (int slot = 0; slot < make.slots.size; ++slot) {
    if (!make.is_single(slot)) continue;
    const SlotRange& of_row = segments[static_cast<std::size_t>(make.row(slot))];
    make.op.singles.push_back({slot, of_row.first, of_row.last});
  }
}

// --- applying

// `count` vectors of slots from `at` on.
template <int count>
void apply_block(const StencilEntry* entries, const StencilRun& run, std::size_t at, TotalMotion& t) {
  constexpr std::ptrdiff_t W = lanes;
  Lane x[count], y[count];
  for (std::ptrdiff_t k = 0; k < count; ++k) x[k] = load(&t.base_x[at] + W * k), y[k] = load(&t.base_y[at] + W * k);
  const double *u_x = t.u_x.data() + at, *u_y = t.u_y.data() + at;
  const StencilEntry *e = entries, *const full = entries + run.full, *const end = full + run.diagonal;
  for (; e != full; ++e) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const Lane a = load(u_x + e->offset + W * k), b = load(u_y + e->offset + W * k);
      x[k] += e->xx * a;
      y[k] += e->yx * a;
      x[k] += e->xy * b;
      y[k] += e->yy * b;
    }
  }
  for (; e != end; ++e) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      x[k] += e->xx * load(u_x + e->offset + W * k);
      y[k] += e->yy * load(u_y + e->offset + W * k);
    }
  }
  for (std::ptrdiff_t k = 0; k < count; ++k) store(&t.a_x[at] + W * k, x[k]), store(&t.a_y[at] + W * k, y[k]);
}

void apply_run(const StencilOperator& op, const StencilRun& run, TotalMotion& t) {
  const StencilEntry* entries = op.entries.data() + run.entry;
  auto at = static_cast<std::size_t>(run.slots.first);
  const auto last = static_cast<std::size_t>(run.slots.last);
  constexpr std::size_t W = lanes, four = 4 * W;
  for (; at + four <= last; at += four) apply_block<4>(entries, run, at, t);
  // What is left in as few vectors as hold it; they begin before it where it does not fill them.
  const std::size_t vectors = (last - at + lanes - 1) / lanes;
  if (last - static_cast<std::size_t>(run.slots.first) < vectors * lanes) {
    for (; at + lanes <= last; at += lanes) apply_block<1>(entries, run, at, t);
    if (at < last) apply_block<1>(entries, run, last - lanes, t);
    return;
  }
  if (vectors == 4) apply_block<4>(entries, run, last - four, t);
  if (vectors == 3) apply_block<3>(entries, run, last - 3 * W, t);
  if (vectors == 2) apply_block<2>(entries, run, last - 2 * W, t);
  if (vectors == 1) apply_block<1>(entries, run, last - lanes, t);
}

void apply_single(const StencilOperator& op, const SingleSlot& single, TotalMotion& t) {
  const auto slot = static_cast<std::size_t>(single.slot);
  const double *u_x = t.u_x.data() + slot, *u_y = t.u_y.data() + slot;
  Lane x{}, y{};
  for (int s = single.first; s < single.last; ++s) {
    const StencilSegment& segment = op.segments[static_cast<std::size_t>(s)];
    const Lane a = load(u_x + segment.offset), b = load(u_y + segment.offset);
    x += load(segment.xx.data()) * a;
    y += load(segment.yx.data()) * a;
    x += load(segment.xy.data()) * b;
    y += load(segment.yy.data()) * b;
  }
  t.a_x[slot] = t.base_x[slot] + sum_of_lanes(x);
  t.a_y[slot] = t.base_y[slot] + sum_of_lanes(y);
}

// A thread has the same runs and slots in each step, so that nodes stay in its cache.
void apply_stencils(TotalMotion& t) {
  const StencilOperator& op = *t.op;
#pragma omp parallel if (t.m.size() > worth_threads)
  {
#pragma omp for schedule(static)
    for (const SlotImage& image : op.images) {
      const auto to = static_cast<std::size_t>(image.to), from = static_cast<std::size_t>(image.from);
      t.u_x[to] = -t.u_x[from], t.u_y[to] = t.u_y[from];
    }
#pragma omp for schedule(static) nowait
    for (const StencilRun& run : op.runs) apply_run(op, run, t);
#pragma omp for schedule(static)
    for (const SingleSlot& single : op.singles) apply_single(op, single, t);
  }
  for (const int slot : op.held_x) t.a_x[static_cast<std::size_t>(slot)] = 0.0;
}

// The same by particles: f_i = -sum_p V_p sigma(grad u) grad N_ip, folded to masters.
void apply_particles(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  TotalMotion& t = state.total;
  const Slots& slots = t.op->slots;
  NodalSums sums(state.masters.size());
  const Particles& p = state.particles;
  for (const Bin& bin : state.bins) {
    std::array<Vec2, 9> u;
    for (std::size_t n = 0; n < 9; ++n) u[n] = total_displacement(state, bin.record[n]);
    for (const std::size_t q : bin) {
      const Gradients g = gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
      Vec2 u_1 = Vec2::Zero(), u_2 = Vec2::Zero();
      for (std::size_t n = 0; n < 9; ++n) u_1 += g.N_x[n] * u[n], u_2 += g.N_y[n] * u[n];
      const Stress s = stress_of(rocks[p.rock[q]], u_1.x(), u_2.x(), u_1.y(), u_2.y());
      for (std::size_t n = 0; n < 9; ++n) {
        const auto record = sums[static_cast<std::size_t>(bin.record[n])];
        record.f_x -= p.V[q] * (s.xx * g.N_x[n] + s.xy * g.N_y[n]);
        record.f_y -= p.V[q] * (s.xy * g.N_x[n] + s.yy * g.N_y[n]);
      }
    }
  }
  fold_to_masters(state, sums);
  for (std::size_t r = 0; r < sums.size(); ++r) {
    const auto slot = static_cast<std::size_t>(slots.of_record[r]);
    if (state.masters[r].record != static_cast<int>(r) || !(t.m[slot] > 0.0)) continue;
    t.a_x[slot] = t.base_x[slot] + sums[r].f_x / t.m[slot];
    t.a_y[slot] = t.base_y[slot] + sums[r].f_y / t.m[slot];
  }
}

// The sum over the slots in use.
template <class Sum, class Work>
Sum over_slots(const TotalMotion& t, Work work) {
  const std::vector<SlotRange>& ranges = t.op->ranges;
  const auto range = [&](std::size_t k) {
    return Part{static_cast<std::size_t>(ranges[k].first), static_cast<std::size_t>(ranges[k].last)};
  };
  return sum_by_lanes<Sum>(ranges.size(), t.m.size(), range, work);
}

// Of vectors of slots: see NodeTotals.
struct LaneTotals {
  Lane kinetic{}, increment{}, power{}, product{}, fastest{};
  LaneTotals& operator+=(const LaneTotals& other) {
    kinetic += other.kinetic, increment += other.increment, power += other.power, product += other.product;
    fastest = larger(fastest, other.fastest);
    return *this;
  }
};

}  // namespace

StencilOperator make_operator(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state) {
  StencilOperator op;
  op.slots = make_slots(state);
  const StencilRows rows = make_stencil_rows(scene, rocks, state, op.slots);
  RunMaker make{state.grid, op.slots, rows, op, std::vector<char>(static_cast<std::size_t>(op.slots.size), 0)};
  find_runs(make);
  find_singles(make);
  find_ranges(op);
  return op;
}

NodeTotals move_nodes(double keep, State& state) {
  TotalMotion& t = state.total;
  const double dt = state.dt;
  const auto sum = over_slots<LaneTotals>(t, [&](auto lane, std::size_t s, LaneTotals& to) {
    const Lane a_x = lane.load(&t.a_x[s]), a_y = lane.load(&t.a_y[s]), m = lane.load(&t.m[s]);
    const Lane before_x = lane.load(&t.v_x[s]), before_y = lane.load(&t.v_y[s]);
    const Lane v_x = keep * before_x + dt * a_x, v_y = keep * before_y + dt * a_y;
    lane.store(&t.v_x[s], v_x), lane.store(&t.v_y[s], v_y);
    lane.store(&t.u_x[s], lane.load(&t.u_x[s]) + dt * v_x), lane.store(&t.u_y[s], lane.load(&t.u_y[s]) + dt * v_y);
    const Lane speed2 = v_x * v_x + v_y * v_y;
    to.kinetic += m * speed2;
    to.increment += m * (a_x * a_x + a_y * a_y);
    to.power += m * (v_x * a_x + v_y * a_y);
    to.product += m * (before_x * v_x + before_y * v_y);
    to.fastest = larger(to.fastest, speed2);
  });
  return {0.5 * sum_of_lanes(sum.kinetic), 0.5 * dt * dt * sum_of_lanes(sum.increment), sum_of_lanes(sum.power),
          sum_of_lanes(sum.product), largest_lane(sum.fastest)};
}

double find_accelerations(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  const bool fast = scene.numerics.kernels == Numerics::Kernels::fast;
  fast ? apply_stencils(state.total) : apply_particles(scene, rocks, state);
  const TotalMotion& t = state.total;
  return sum_of_lanes(over_slots<Lane>(t, [&](auto lane, std::size_t s, Lane& power) {
    const Lane v_a = lane.load(&t.v_x[s]) * lane.load(&t.a_x[s]) + lane.load(&t.v_y[s]) * lane.load(&t.a_y[s]);
    power += lane.load(&t.m[s]) * v_a;
  }));
}

}  // namespace strata
