#include "explicit/total/total_operator.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

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

// The segments of the rows that slots have without being in a run, by row.
std::vector<IndexRange> find_segments(const RunMaker& make) {
  std::vector<char> wanted(make.rows.rows.size(), 0);
  for (int slot = 0; slot < make.slots.size; ++slot) {
    if (make.is_single(slot)) wanted[static_cast<std::size_t>(make.row(slot))] = 1;
  }
  std::vector<IndexRange> of_row(make.rows.rows.size());
  for (std::size_t row = 0; row < of_row.size(); ++row) {
    if (wanted[row] == 0) continue;
    std::vector<StencilSegment> segments;
    add_segments(make.rows.rows[row], segments);
    const std::size_t first = make.op.segments.size();
    make.op.segments.insert(make.op.segments.end(), segments.begin(), segments.end());
    of_row[row] = {first, make.op.segments.size()};
  }
  return of_row;
}

// The slots at which parts begin, and the end. Work is counted in products of a vector of slots and a coefficient
// block: a run's entry takes one a vector, a segment of a group, with the sum over its lanes, about four a slot, and
// what is done once for each node about eight a vector. Estimates: they only even out the parts.
std::vector<int> find_borders(const RunMaker& make, const std::vector<IndexRange>& segments) {
  const int stride = make.slots.stride;
  std::vector<std::size_t> work(static_cast<std::size_t>(make.slots.size / stride + 1), 0);
  const auto add = [&](int slot, std::size_t more) { work[static_cast<std::size_t>(slot / stride)] += more; };
  for (const StencilRun& run : make.op.runs)
    add(run.slots.first,
        static_cast<std::size_t>((run.slots.last - run.slots.first) * (run.full + run.diagonal) / lanes));
  for (int slot = 0; slot < make.slots.size; ++slot) {
    if (!make.is_single(slot)) continue;
    const IndexRange& of_row = segments[static_cast<std::size_t>(make.row(slot))];
    add(slot, 4 * (of_row.last - of_row.first));
  }
  for (const SlotRange& range : make.op.ranges)
    add(range.first, static_cast<std::size_t>(8 * (range.last - range.first) / lanes));
  const std::size_t all = std::accumulate(work.begin(), work.end(), std::size_t{0});
  std::vector<int> borders{0};
  std::size_t done = 0;
  for (std::size_t row = 0; row < work.size(); ++row) {
    while (borders.size() < record_parts && done * record_parts >= all * borders.size())
      borders.push_back(static_cast<int>(row) * stride);
    done += work[row];
  }
  borders.resize(record_parts, make.slots.size);
  borders.push_back(make.slots.size);
  return borders;
}

// All slots that no run has, those of the same row together, part by part.
void find_groups(const RunMaker& make, const std::vector<IndexRange>& segments, const std::vector<int>& borders) {
  StencilOperator& op = make.op;
  for (std::size_t part = 0; part < record_parts; ++part) {
    std::vector<std::pair<int, int>> singles;  // row, slot
    for (int slot = borders[part]; slot < borders[part + 1]; ++slot) {
      if (make.is_single(slot)) singles.emplace_back(make.row(slot), slot);
    }
    std::sort(singles.begin(), singles.end());
    op.parts[part].groups.first = op.groups.size();
    for (std::size_t k = 0; k < singles.size(); ++k) {
      if (k == 0 || singles[k].first != singles[k - 1].first) {
        const IndexRange& of_row = segments[static_cast<std::size_t>(singles[k].first)];
        op.groups.push_back(
            {static_cast<int>(of_row.first), static_cast<int>(of_row.last), static_cast<int>(op.grouped.size()), 0});
      }
      op.grouped.push_back(singles[k].second);
      ++op.groups.back().slots;
    }
    op.parts[part].groups.last = op.groups.size();
  }
}

// Those of a list, by ascending slots, that each part has.
template <class List, class SlotOf>
void deal(const List& list, const std::vector<int>& borders, SlotOf slot_of, IndexRange StencilPart::*of_part,
          std::vector<StencilPart>& parts) {
  std::size_t k = 0;
  for (std::size_t part = 0; part < record_parts; ++part) {
    const std::size_t first = k;
    while (k < list.size() && slot_of(list[k]) < borders[part + 1]) ++k;
    parts[part].*of_part = {first, k};
  }
}

void find_parts(const RunMaker& make) {
  StencilOperator& op = make.op;
  op.parts.resize(record_parts);
  const std::vector<IndexRange> segments = find_segments(make);
  const std::vector<int> borders = find_borders(make, segments);
  find_groups(make, segments, borders);
  std::sort(op.held_x.begin(), op.held_x.end());
  const auto first = [](const auto& of_slots) { return of_slots.first; };
  deal(
      op.images, borders, [](const SlotImage& image) { return image.to; }, &StencilPart::images, op.parts);
  deal(
      op.runs, borders, [](const StencilRun& run) { return run.slots.first; }, &StencilPart::runs, op.parts);
  deal(
      op.held_x, borders, [](int slot) { return slot; }, &StencilPart::held_x, op.parts);
  deal(op.ranges, borders, first, &StencilPart::ranges, op.parts);
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

void apply_group(const StencilOperator& op, const StencilGroup& group, TotalMotion& t) {
  for (int k = group.slot; k < group.slot + group.slots; ++k) {
    const auto slot = static_cast<std::size_t>(op.grouped[static_cast<std::size_t>(k)]);
    const double *u_x = t.u_x.data() + slot, *u_y = t.u_y.data() + slot;
    Lane x{}, y{};
    for (int s = group.first; s < group.last; ++s) {
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
}

void mirror(const StencilOperator& op, const StencilPart& part, TotalMotion& t) {
  for (std::size_t k = part.images.first; k < part.images.last; ++k) {
    const auto to = static_cast<std::size_t>(op.images[k].to), from = static_cast<std::size_t>(op.images[k].from);
    t.u_x[to] = -t.u_x[from], t.u_y[to] = t.u_y[from];
  }
}

void apply(const StencilOperator& op, const StencilPart& part, TotalMotion& t) {
  for (std::size_t k = part.runs.first; k < part.runs.last; ++k) apply_run(op, op.runs[k], t);
  for (std::size_t k = part.groups.first; k < part.groups.last; ++k) apply_group(op, op.groups[k], t);
  for (std::size_t k = part.held_x.first; k < part.held_x.last; ++k)
    t.a_x[static_cast<std::size_t>(op.held_x[k])] = 0.0;
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

double power(const StencilOperator& op, const StencilPart& part, const TotalMotion& t) {
  Lane sum_m_v_a{};
  for (std::size_t k = part.ranges.first; k < part.ranges.last; ++k) {
    for (auto s = static_cast<std::size_t>(op.ranges[k].first); s < static_cast<std::size_t>(op.ranges[k].last);
         s += lanes) {
      sum_m_v_a += load(&t.m[s]) * (load(&t.v_x[s]) * load(&t.a_x[s]) + load(&t.v_y[s]) * load(&t.a_y[s]));
    }
  }
  return sum_of_lanes(sum_m_v_a);
}

NodeTotals move_part(const StencilOperator& op, const StencilPart& part, double keep, double dt, TotalMotion& t) {
  Lane kinetic{}, increment{}, power{}, product{}, fastest{};
  for (std::size_t k = part.ranges.first; k < part.ranges.last; ++k) {
    for (auto s = static_cast<std::size_t>(op.ranges[k].first); s < static_cast<std::size_t>(op.ranges[k].last);
         s += lanes) {
      const Lane a_x = load(&t.a_x[s]), a_y = load(&t.a_y[s]), m = load(&t.m[s]);
      const Lane before_x = load(&t.v_x[s]), before_y = load(&t.v_y[s]);
      const Lane v_x = keep * before_x + dt * a_x, v_y = keep * before_y + dt * a_y;
      store(&t.v_x[s], v_x), store(&t.v_y[s], v_y);
      store(&t.u_x[s], load(&t.u_x[s]) + dt * v_x), store(&t.u_y[s], load(&t.u_y[s]) + dt * v_y);
      const Lane speed2 = v_x * v_x + v_y * v_y;
      kinetic += m * speed2;
      increment += m * (a_x * a_x + a_y * a_y);
      power += m * (v_x * a_x + v_y * a_y);
      product += m * (before_x * v_x + before_y * v_y);
      fastest = larger(fastest, speed2);
    }
  }
  return {0.5 * sum_of_lanes(kinetic), 0.5 * dt * dt * sum_of_lanes(increment), sum_of_lanes(power),
          sum_of_lanes(product), largest_lane(fastest)};
}

}  // namespace

StencilOperator make_operator(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state) {
  StencilOperator op;
  op.slots = make_slots(state);
  const StencilRows rows = make_stencil_rows(scene, rocks, state, op.slots);
  RunMaker make{state.grid, op.slots, rows, op, std::vector<char>(static_cast<std::size_t>(op.slots.size), 0)};
  find_runs(make);
  find_ranges(op);
  find_parts(make);
  return op;
}

// Ranges are widened to whole vectors: slots between those in use have no mass and stay at rest.
NodeTotals move_nodes(double keep, State& state) {
  TotalMotion& t = state.total;
  const StencilOperator& op = *t.op;
  std::array<NodeTotals, record_parts> of_part;
#pragma omp parallel for schedule(static) if (t.m.size() > worth_threads)
  for (std::size_t part = 0; part < record_parts; ++part)
    of_part[part] = move_part(op, op.parts[part], keep, state.dt, t);
  NodeTotals all;
  for (const NodeTotals& totals : of_part) {
    all.kinetic += totals.kinetic;
    all.increment += totals.increment;
    all.power += totals.power;
    all.product += totals.product;
    all.largest_speed2 = std::max(all.largest_speed2, totals.largest_speed2);
  }
  return all;
}

double find_accelerations(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  TotalMotion& t = state.total;
  const StencilOperator& op = *t.op;
  const bool fast = scene.numerics.kernels == Numerics::Kernels::fast;
  if (!fast) apply_particles(scene, rocks, state);
  std::array<double, record_parts> of_part{};
#pragma omp parallel if (t.m.size() > worth_threads)
  {
    if (fast) {
#pragma omp for schedule(static)
      for (std::size_t part = 0; part < record_parts; ++part) mirror(op, op.parts[part], t);
    }
#pragma omp for schedule(static)
    for (std::size_t part = 0; part < record_parts; ++part) {
      if (fast) apply(op, op.parts[part], t);
      of_part[part] = power(op, op.parts[part], t);
    }
  }
  return std::accumulate(of_part.begin(), of_part.end(), 0.0);
}

}  // namespace strata
