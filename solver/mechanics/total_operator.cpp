#include "mechanics/total_operator.hpp"

#include <algorithm>
#include <bit>
#include <cmath>

#include "mechanics/stencil_rows.hpp"
#include "mechanics/transfers.hpp"
#include "state/shape_functions.hpp"

namespace strata {

namespace {

typedef double Eight __attribute__((vector_size(64)));
typedef double EightAnywhere __attribute__((vector_size(64), aligned(8), may_alias));

constexpr int lanes = 8;
constexpr int shortest_run = lanes;
constexpr int blocks_per_task = 2048;  // about 8,000 multiply-adds of vectors, some 2 us

Eight load(const double* from) {
  return *reinterpret_cast<const EightAnywhere*>(from);
}
void store(double* to, const Eight& value) {
  *reinterpret_cast<EightAnywhere*>(to) = value;
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
  for (const StencilEntry& entry : row) {
    if (segments.empty() || entry.offset >= segments.back().offset + lanes || entry.offset < segments.back().offset) {
      segments.emplace_back();
      segments.back().offset = entry.offset;
    }
    StencilSegment& segment = segments.back();
    const auto k = static_cast<std::size_t>(entry.offset - segment.offset);
    segment.xx[k] = entry.xx, segment.xy[k] = entry.xy, segment.yx[k] = entry.yx, segment.yy[k] = entry.yy;
  }
}

// All slots that no run has, those of the same row together.
void find_groups(const RunMaker& make) {
  std::vector<std::vector<int>> slots_of_row(make.rows.rows.size());
  for (int slot = 0; slot < make.slots.size; ++slot) {
    if (make.row(slot) >= 0 && make.taken[static_cast<std::size_t>(slot)] == 0)
      slots_of_row[static_cast<std::size_t>(make.row(slot))].push_back(slot);
  }
  StencilOperator& op = make.op;
  for (std::size_t k = 0; k < slots_of_row.size(); ++k) {
    if (slots_of_row[k].empty()) continue;
    StencilGroup group;
    group.first = static_cast<int>(op.segments.size());
    std::vector<StencilSegment> segments;
    add_segments(make.rows.rows[k], segments);
    op.segments.insert(op.segments.end(), segments.begin(), segments.end());
    group.last = static_cast<int>(op.segments.size());
    group.slot = static_cast<int>(op.grouped.size());
    group.slots = static_cast<int>(slots_of_row[k].size());
    op.grouped.insert(op.grouped.end(), slots_of_row[k].begin(), slots_of_row[k].end());
    op.groups.push_back(group);
  }
}

// Work is counted in blocks of eight slots by one coefficient block: a run's entry takes one for eight slots, a segment
// of a group, with the sum over its eight blocks, about four for a slot. Estimates: they only even out the tasks.
void find_tasks(StencilOperator& op) {
  int blocks = blocks_per_task;
  const auto add = [&](std::size_t k, int more) {
    if (blocks >= blocks_per_task) op.tasks.push_back(k), blocks = 0;
    blocks += more;
  };
  for (std::size_t k = 0; k < op.runs.size(); ++k) {
    const StencilRun& run = op.runs[k];
    add(k, (run.slots.last - run.slots.first) / 4 * (run.full + run.diagonal) / 2);
  }
  for (std::size_t k = 0; k < op.groups.size(); ++k) {
    const StencilGroup& group = op.groups[k];
    add(op.runs.size() + k, group.slots * (group.last - group.first) * 4);
  }
  op.tasks.push_back(op.runs.size() + op.groups.size());
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

// --- applying

// `count` vectors of eight slots from `at` on.
template <int count>
void apply_block(const StencilEntry* entries, const StencilRun& run, std::size_t at, TotalMotion& t) {
  Eight x[count], y[count];
  for (int k = 0; k < count; ++k) x[k] = load(&t.base_x[at] + lanes * k), y[k] = load(&t.base_y[at] + lanes * k);
  const double *u_x = t.u_x.data() + at, *u_y = t.u_y.data() + at;
  const StencilEntry *e = entries, *const full = entries + run.full, *const end = full + run.diagonal;
  for (; e != full; ++e) {
    for (int k = 0; k < count; ++k) {
      const Eight a = load(u_x + e->offset + lanes * k), b = load(u_y + e->offset + lanes * k);
      x[k] += e->xx * a;
      y[k] += e->yx * a;
      x[k] += e->xy * b;
      y[k] += e->yy * b;
    }
  }
  for (; e != end; ++e) {
    for (int k = 0; k < count; ++k) {
      x[k] += e->xx * load(u_x + e->offset + lanes * k);
      y[k] += e->yy * load(u_y + e->offset + lanes * k);
    }
  }
  for (int k = 0; k < count; ++k) store(&t.a_x[at] + lanes * k, x[k]), store(&t.a_y[at] + lanes * k, y[k]);
}

void apply_run(const StencilOperator& op, const StencilRun& run, TotalMotion& t) {
  const StencilEntry* entries = op.entries.data() + run.entry;
  auto at = static_cast<std::size_t>(run.slots.first);
  const auto last = static_cast<std::size_t>(run.slots.last);
  constexpr std::size_t four = 4 * lanes;
  for (; at + four <= last; at += four) apply_block<4>(entries, run, at, t);
  // What is left in as few vectors as hold it; they begin before it where it does not fill them.
  const std::size_t vectors = (last - at + lanes - 1) / lanes;
  if (last - static_cast<std::size_t>(run.slots.first) < vectors * lanes) {
    for (; at + lanes <= last; at += lanes) apply_block<1>(entries, run, at, t);
    if (at < last) apply_block<1>(entries, run, last - lanes, t);
    return;
  }
  if (vectors == 4) apply_block<4>(entries, run, last - four, t);
  if (vectors == 3) apply_block<3>(entries, run, last - 3 * lanes, t);
  if (vectors == 2) apply_block<2>(entries, run, last - 2 * lanes, t);
  if (vectors == 1) apply_block<1>(entries, run, last - lanes, t);
}

double sum(const Eight& v) {
  return ((v[0] + v[4]) + (v[2] + v[6])) + ((v[1] + v[5]) + (v[3] + v[7]));
}

void apply_group(const StencilOperator& op, const StencilGroup& group, TotalMotion& t) {
  for (int k = group.slot; k < group.slot + group.slots; ++k) {
    const auto slot = static_cast<std::size_t>(op.grouped[static_cast<std::size_t>(k)]);
    const double *u_x = t.u_x.data() + slot, *u_y = t.u_y.data() + slot;
    Eight x{}, y{};
    for (int s = group.first; s < group.last; ++s) {
      const StencilSegment& segment = op.segments[static_cast<std::size_t>(s)];
      const Eight a = load(u_x + segment.offset), b = load(u_y + segment.offset);
      x += std::bit_cast<Eight>(segment.xx) * a;
      y += std::bit_cast<Eight>(segment.yx) * a;
      x += std::bit_cast<Eight>(segment.xy) * b;
      y += std::bit_cast<Eight>(segment.yy) * b;
    }
    t.a_x[slot] = t.base_x[slot] + sum(x);
    t.a_y[slot] = t.base_y[slot] + sum(y);
  }
}

void apply_tasks(const StencilOperator& op, TotalMotion& t) {
  for (const SlotImage& image : op.images) {
    const auto to = static_cast<std::size_t>(image.to), from = static_cast<std::size_t>(image.from);
    t.u_x[to] = -t.u_x[from], t.u_y[to] = t.u_y[from];
  }
  const int tasks = static_cast<int>(op.tasks.size()) - 1;
#pragma omp parallel for schedule(dynamic, 1)
  for (int task = 0; task < tasks; ++task) {
    const auto k = static_cast<std::size_t>(task);
    for (std::size_t n = op.tasks[k]; n < op.tasks[k + 1]; ++n) {
      if (n < op.runs.size()) {
        apply_run(op, op.runs[n], t);
      } else {
        apply_group(op, op.groups[n - op.runs.size()], t);
      }
    }
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
    for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
         q += static_cast<std::size_t>(bin.stride)) {
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

// Calls work(range, its own totals) for all ranges in use and adds the totals in their order.
template <class Work>
NodeTotals over_ranges(const StencilOperator& op, Work work) {
  constexpr int per_task = 16;
  const int n = static_cast<int>(op.ranges.size());
  std::vector<NodeTotals> of_task(static_cast<std::size_t>((n + per_task - 1) / per_task));
#pragma omp parallel for schedule(static)
  for (int task = 0; task < static_cast<int>(of_task.size()); ++task) {
    NodeTotals& totals = of_task[static_cast<std::size_t>(task)];
    for (int k = per_task * task; k < std::min(n, per_task * (task + 1)); ++k)
      work(op.ranges[static_cast<std::size_t>(k)], totals);
  }
  NodeTotals all;
  for (const NodeTotals& totals : of_task) {
    all.kinetic += totals.kinetic;
    all.increment += totals.increment;
    all.power += totals.power;
    all.product += totals.product;
    all.largest_speed2 = std::max(all.largest_speed2, totals.largest_speed2);
  }
  return all;
}

Eight larger(const Eight& a, const Eight& b) {
  return a > b ? a : b;
}

}  // namespace

StencilOperator make_operator(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state) {
  StencilOperator op;
  op.slots = make_slots(state);
  const StencilRows rows = make_stencil_rows(scene, rocks, state, op.slots);
  RunMaker make{state.grid, op.slots, rows, op, std::vector<char>(static_cast<std::size_t>(op.slots.size), 0)};
  find_runs(make);
  find_groups(make);
  find_tasks(op);
  find_ranges(op);
  return op;
}

// Ranges are widened to whole vectors: slots between those in use have no mass and stay at rest.
NodeTotals move_nodes(double keep, State& state) {
  TotalMotion& t = state.total;
  const double dt = state.dt;
  return over_ranges(*t.op, [&](const SlotRange& range, NodeTotals& totals) {
    Eight kinetic{}, increment{}, power{}, product{}, fastest{};
    for (auto s = static_cast<std::size_t>(range.first); s < static_cast<std::size_t>(range.last); s += lanes) {
      const Eight a_x = load(&t.a_x[s]), a_y = load(&t.a_y[s]), m = load(&t.m[s]);
      const Eight before_x = load(&t.v_x[s]), before_y = load(&t.v_y[s]);
      const Eight v_x = keep * before_x + dt * a_x, v_y = keep * before_y + dt * a_y;
      store(&t.v_x[s], v_x), store(&t.v_y[s], v_y);
      store(&t.u_x[s], load(&t.u_x[s]) + dt * v_x), store(&t.u_y[s], load(&t.u_y[s]) + dt * v_y);
      const Eight speed2 = v_x * v_x + v_y * v_y;
      kinetic += m * speed2;
      increment += m * (a_x * a_x + a_y * a_y);
      power += m * (v_x * a_x + v_y * a_y);
      product += m * (before_x * v_x + before_y * v_y);
      fastest = larger(fastest, speed2);
    }
    totals.kinetic += 0.5 * sum(kinetic);
    totals.increment += 0.5 * dt * dt * sum(increment);
    totals.power += sum(power);
    totals.product += sum(product);
    for (int k = 0; k < lanes; ++k) totals.largest_speed2 = std::max(totals.largest_speed2, fastest[k]);
  });
}

double find_accelerations(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  TotalMotion& t = state.total;
  if (scene.numerics.kernels == Numerics::Kernels::fast) {
    apply_tasks(*t.op, t);
  } else {
    apply_particles(scene, rocks, state);
  }
  const NodeTotals sums = over_ranges(*t.op, [&](const SlotRange& range, NodeTotals& totals) {
    Eight power{};
    for (auto s = static_cast<std::size_t>(range.first); s < static_cast<std::size_t>(range.last); s += lanes) {
      power += load(&t.m[s]) * (load(&t.v_x[s]) * load(&t.a_x[s]) + load(&t.v_y[s]) * load(&t.a_y[s]));
    }
    totals.power += sum(power);
  });
  return sums.power;
}

}  // namespace strata
