#include "explicit/total/total_operator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "explicit/transfers.hpp"
#include "state/lanes.hpp"
#include "state/parts.hpp"
#include "state/shape_functions.hpp"
#include "state/stiffness.hpp"

namespace strata {

namespace {

constexpr int lanes = most_lanes;
constexpr AllLanes all;
constexpr int shortest_run = 8;  // records: below, a run needs more beside its sums than sharing them saves

// --- rows

// A row of -M^-1 K: its blocks by ascending offset.
using StencilRow = std::vector<StencilEntry>;

// The rows of all masters. Records whose surroundings are the same (particles, weights and copies around them) share
// one.
struct StencilRows {
  std::vector<StencilRow> rows;
  std::vector<int> of_record;  // -1: no master of a mass
};

// Places within a cell are told apart by multiples of this (cells): far above the round-off of a coordinate, far below
// what a kernel's results may differ by.
constexpr double same_place = 1.0 / (1LL << 36);

using Tokens = std::vector<std::int64_t>;

struct TokenHash {
  std::size_t operator()(const Tokens& tokens) const {
    std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a by words
    for (const std::int64_t token : tokens) hash = (hash ^ static_cast<std::uint64_t>(token)) * 0x100000001b3U;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

// Numbers of things by what they are made of.
using Kinds = std::unordered_map<Tokens, int, TokenHash>;

// What the particles of a bin do to the nine nodes around it.
struct BinKind {
  LocalStiffness K = LocalStiffness::Zero();
  std::array<double, 9> m{};
};

std::int64_t in_steps(double cells) {
  return std::llround(cells / same_place);
}

void describe_bin(const State& state, const Bin& bin, Tokens& tokens) {
  const Grid& g = state.grid;
  const Particles& p = state.particles;
  tokens.clear();
  for (const int k : {-1, 0, 1}) {
    tokens.push_back(g.x_knots.empty() ? 0 : in_steps(g.span_x(bin.i + k) / g.h));
    tokens.push_back(g.y_knots.empty() ? 0 : in_steps(g.span_y(bin.j + k) / g.h));
  }
  for (const std::size_t q : bin) {
    tokens.push_back(in_steps((p.x[q] - g.x(bin.i)) / g.h));
    tokens.push_back(in_steps((p.y[q] - g.y(bin.j)) / g.h));
    tokens.push_back(in_steps(p.V[q] / (g.h * g.h)));
    tokens.push_back(p.rock[q]);
  }
}

BinKind make_kind(const Scene& scene, const Rocks& rocks, const State& state, const Bin& bin) {
  const Particles& p = state.particles;
  BinKind kind;
  for (const std::size_t q : bin) {
    const Gradients g = gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
    add_stiffness(rocks[p.rock[q]], g, p.V[q], kind.K);
    for (std::size_t n = 0; n < 9; ++n) kind.m[n] += g.N[n] * p.m[q];
  }
  return kind;
}

struct BinKinds {
  std::vector<BinKind> kinds;
  std::vector<int> of_bin;
};

BinKinds find_bin_kinds(const Scene& scene, const Rocks& rocks, const State& state) {
  BinKinds out;
  Kinds numbers;
  Tokens tokens;
  for (const Bin& bin : state.bins) {
    describe_bin(state, bin, tokens);
    const auto [number, is_new] = numbers.try_emplace(tokens, static_cast<int>(numbers.size()));
    if (is_new) out.kinds.push_back(make_kind(scene, rocks, state, bin));
    out.of_bin.push_back(number->second);
  }
  return out;
}

// That a node of a bin's nine is, or is tied to, a master.
struct Incidence {
  int bin = 0;
  int node = 0;
};

// Those of each master, in the order of bins.
std::vector<std::vector<Incidence>> find_incidences(const State& state) {
  std::vector<std::vector<Incidence>> of_master(state.masters.size());
  for (std::size_t b = 0; b < state.bins.size(); ++b) {
    for (std::size_t n = 0; n < 9; ++n) {
      const auto record = static_cast<std::size_t>(state.bins[b].record[n]);
      auto& at = of_master[static_cast<std::size_t>(state.masters[record].record)];
      at.push_back({static_cast<int>(b), static_cast<int>(n)});
    }
  }
  return of_master;
}

const Master& master_at(const State& state, int bin, int node) {
  const Bin& of = state.bins[static_cast<std::size_t>(bin)];
  return state.masters[static_cast<std::size_t>(of.record[static_cast<std::size_t>(node)])];
}

// What the row of a master is made of.
void describe_row(const State& state, const BinKinds& bins, const std::vector<Incidence>& around, int record,
                  Tokens& tokens) {
  const auto code_of = [](const Master& m) { return 3 * static_cast<int>(m.x) + static_cast<int>(m.y) + 4; };
  tokens.clear();
  for (const auto& [bin, node] : around) {
    tokens.push_back(bins.of_bin[static_cast<std::size_t>(bin)]);
    tokens.push_back(16 * node + code_of(master_at(state, bin, node)));
    for (int n = 0; n < 9; ++n) {
      const Master& other = master_at(state, bin, n);
      tokens.push_back(16 * (other.record - record) + code_of(other));
    }
  }
}

StencilEntry& entry_at(StencilRow& row, int offset) {
  const auto at = std::lower_bound(row.begin(), row.end(), offset,
                                   [](const StencilEntry& entry, int value) { return entry.offset < value; });
  if (at != row.end() && at->offset == offset) return *at;
  return *row.insert(at, {offset, 0.0, 0.0, 0.0, 0.0});
}

double largest_of(const StencilEntry& e) {
  return std::max({std::abs(e.xx), std::abs(e.xy), std::abs(e.yx), std::abs(e.yy)});
}

// Coefficients that are round-off of sums that cancel.
void drop_round_off(StencilRow& row) {
  constexpr double nothing = 1e-15;
  double most = 0.0;
  for (const StencilEntry& entry : row) most = std::max(most, largest_of(entry));
  for (StencilEntry& entry : row) {
    for (double* value : {&entry.xx, &entry.xy, &entry.yx, &entry.yy}) {
      if (std::abs(*value) <= nothing * most) *value = 0.0;
    }
  }
  std::erase_if(row, [](const StencilEntry& entry) { return largest_of(entry) == 0.0; });
}

// Empty where the node has no mass.
StencilRow make_row(const State& state, const BinKinds& bins, const std::vector<Incidence>& around, int record) {
  StencilRow row;
  double m = 0.0;
  for (const auto& [bin, node] : around) {
    const BinKind& local = bins.kinds[static_cast<std::size_t>(bins.of_bin[static_cast<std::size_t>(bin)])];
    const Master& own = master_at(state, bin, node);
    m += local.m[static_cast<std::size_t>(node)];
    for (int n = 0; n < 9; ++n) {
      const auto block = local.K.block<2, 2>(2 * node, 2 * n);
      if (block.isZero(0.0)) continue;
      const Master& other = master_at(state, bin, n);
      StencilEntry& entry = entry_at(row, other.record - record);
      entry.xx -= own.x * other.x * block(0, 0), entry.xy -= own.x * other.y * block(0, 1);
      entry.yx -= own.y * other.x * block(1, 0), entry.yy -= own.y * other.y * block(1, 1);
    }
  }
  if (!(m > 0.0)) return {};
  for (StencilEntry& entry : row) entry.xx /= m, entry.xy /= m, entry.yx /= m, entry.yy /= m;
  drop_round_off(row);
  return row;
}

// Rows of -M^-1 K with K = sum_p V_p B^T C B (add_stiffness()) and lumped masses, rows and columns folded to masters.
// Surroundings count as the same where they agree to 1.5e-11 of a cell.
StencilRows make_stencil_rows(const Scene& scene, const Rocks& rocks, const State& state) {
  const BinKinds bins = find_bin_kinds(scene, rocks, state);
  const auto incidences = find_incidences(state);
  StencilRows out;
  out.of_record.assign(state.masters.size(), -1);
  Kinds numbers;
  Tokens tokens;
  for (std::size_t r = 0; r < incidences.size(); ++r) {
    if (incidences[r].empty()) continue;
    const auto record = static_cast<int>(r);
    describe_row(state, bins, incidences[r], record, tokens);
    const auto [number, is_new] = numbers.try_emplace(tokens, static_cast<int>(numbers.size()));
    if (is_new) out.rows.push_back(make_row(state, bins, incidences[r], record));
    if (!out.rows[static_cast<std::size_t>(number->second)].empty()) out.of_record[r] = number->second;
  }
  return out;
}

// --- building

StencilRun make_run(int first, int last, const StencilRow& row, std::vector<StencilEntry>& entries) {
  StencilRun run{first, last, static_cast<int>(entries.size())};
  for (const bool diagonal : {false, true}) {
    for (const StencilEntry& entry : row) {
      if ((entry.xy == 0.0 && entry.yx == 0.0) != diagonal) continue;
      entries.push_back(entry);
      ++(diagonal ? run.diagonal : run.full);
    }
  }
  return run;
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

// --- applying

// `count` vectors of records from `at` on.
template <int count>
void apply_block(const StencilEntry* entries, const StencilRun& run, std::size_t at, TotalMotion& t) {
  constexpr std::ptrdiff_t W = lanes;
  Lane x[count], y[count];
  for (std::ptrdiff_t k = 0; k < count; ++k)
    x[k] = all.load(&t.base_x[at] + W * k), y[k] = all.load(&t.base_y[at] + W * k);
  const double *u_x = t.u_x.data() + at, *u_y = t.u_y.data() + at;
  const StencilEntry *e = entries, *const full = entries + run.full, *const end = full + run.diagonal;
  for (; e != full; ++e) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const Lane a = all.load(u_x + e->offset + W * k), b = all.load(u_y + e->offset + W * k);
      x[k] += e->xx * a;
      y[k] += e->yx * a;
      x[k] += e->xy * b;
      y[k] += e->yy * b;
    }
  }
  for (; e != end; ++e) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      x[k] += e->xx * all.load(u_x + e->offset + W * k);
      y[k] += e->yy * all.load(u_y + e->offset + W * k);
    }
  }
  for (std::ptrdiff_t k = 0; k < count; ++k) all.store(&t.a_x[at] + W * k, x[k]), all.store(&t.a_y[at] + W * k, y[k]);
}

void apply_run(const StencilOperator& op, const StencilRun& run, TotalMotion& t) {
  const StencilEntry* entries = op.entries.data() + run.entry;
  auto at = static_cast<std::size_t>(run.first);
  const auto last = static_cast<std::size_t>(run.last);
  constexpr std::size_t W = lanes, four = 4 * W;
  for (; at + four <= last; at += four) apply_block<4>(entries, run, at, t);
  // What is left in as few vectors as hold it; they begin before it where it does not fill them.
  const std::size_t vectors = (last - at + lanes - 1) / lanes;
  if (last - static_cast<std::size_t>(run.first) < vectors * lanes) {
    for (; at + lanes <= last; at += lanes) apply_block<1>(entries, run, at, t);
    if (at < last) apply_block<1>(entries, run, last - lanes, t);
    return;
  }
  if (vectors == 4) apply_block<4>(entries, run, last - four, t);
  if (vectors == 3) apply_block<3>(entries, run, last - 3 * W, t);
  if (vectors == 2) apply_block<2>(entries, run, last - 2 * W, t);
  if (vectors == 1) apply_block<1>(entries, run, last - lanes, t);
}

void apply_single(const StencilOperator& op, const SingleRecord& single, TotalMotion& t) {
  const auto r = static_cast<std::size_t>(single.record);
  const double *u_x = t.u_x.data() + r, *u_y = t.u_y.data() + r;
  Lane x{}, y{};
  for (int s = single.first; s < single.last; ++s) {
    const StencilSegment& segment = op.segments[static_cast<std::size_t>(s)];
    const Lane a = all.load(u_x + segment.offset), b = all.load(u_y + segment.offset);
    x += all.load(segment.xx.data()) * a;
    y += all.load(segment.yx.data()) * a;
    x += all.load(segment.xy.data()) * b;
    y += all.load(segment.yy.data()) * b;
  }
  t.a_x[r] = t.base_x[r] + sum_of_lanes(x);
  t.a_y[r] = t.base_y[r] + sum_of_lanes(y);
}

// A thread has the same runs and records in each step, so that nodes stay in its cache.
void apply_stencils(TotalMotion& t) {
  const StencilOperator& op = *t.op;
#pragma omp parallel if (t.m.size() > worth_threads)
  {
#pragma omp for schedule(static) nowait
    for (const StencilRun& run : op.runs) apply_run(op, run, t);
#pragma omp for schedule(static)
    for (const SingleRecord& single : op.singles) apply_single(op, single, t);
  }
}

// The same by particles: f_i = -sum_p V_p sigma(grad u) grad N_ip, folded to masters.
void apply_particles(const Scene& scene, const Rocks& rocks, State& state) {
  TotalMotion& t = state.total;
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
    if (!(t.m[r] > 0.0)) continue;
    t.a_x[r] = t.base_x[r] + sums[r].f_x / t.m[r];
    t.a_y[r] = t.base_y[r] + sums[r].f_y / t.m[r];
  }
}

// Of lanes: see NodeTotals.
struct LaneTotals {
  Lane kinetic{}, increment{}, power{}, product{}, fastest{};
  LaneTotals& operator+=(const LaneTotals& other) {
    kinetic += other.kinetic, increment += other.increment, power += other.power, product += other.product;
    fastest = larger(fastest, other.fastest);
    return *this;
  }
};

}  // namespace

StencilOperator make_operator(const Scene& scene, const Rocks& rocks, const State& state) {
  const StencilRows rows = make_stencil_rows(scene, rocks, state);
  StencilOperator op;
  std::vector<int> segment{0};  // where those of each row begin and the last end
  for (const StencilRow& row : rows.rows) {
    add_segments(row, op.segments);
    segment.push_back(static_cast<int>(op.segments.size()));
  }
  const std::vector<int>& of = rows.of_record;
  for (std::size_t first = 0, last = 0; first < of.size(); first = last) {
    for (last = first + 1; last < of.size() && of[last] == of[first];) ++last;
    if (of[first] < 0) continue;
    const auto row = static_cast<std::size_t>(of[first]);
    const int from = static_cast<int>(first), to = static_cast<int>(last);
    if (to - from >= shortest_run) {
      op.runs.push_back(make_run(from, to, rows.rows[row], op.entries));
    } else {
      for (int record = from; record < to; ++record) op.singles.push_back({record, segment[row], segment[row + 1]});
    }
  }
  return op;
}

NodeTotals move_nodes(double keep, State& state) {
  TotalMotion& t = state.total;
  const double dt = state.dt;
  const auto sum = sum_over_records<LaneTotals>(state.masters.size(), [&](auto lane, std::size_t s, LaneTotals& to) {
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

double find_accelerations(const Scene& scene, const Rocks& rocks, State& state) {
  const bool fast = scene.numerics.kernels == Numerics::Kernels::fast;
  fast ? apply_stencils(state.total) : apply_particles(scene, rocks, state);
  const TotalMotion& t = state.total;
  return sum_of_lanes(sum_over_records<Lane>(state.masters.size(), [&](auto lane, std::size_t s, Lane& power) {
    const Lane v_a = lane.load(&t.v_x[s]) * lane.load(&t.a_x[s]) + lane.load(&t.v_y[s]) * lane.load(&t.a_y[s]);
    power += lane.load(&t.m[s]) * v_a;
  }));
}

}  // namespace strata
