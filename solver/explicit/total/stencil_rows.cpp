#include "explicit/total/stencil_rows.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <unordered_map>

#include "state/stiffness.hpp"

namespace strata {

namespace {

// Places within a cell are told apart by multiples of this (cells): far above the round-off of a coordinate, far below
// what a kernel's results may differ by.
constexpr double same_place = 1.0 / (1LL << 36);

struct TokenHash {
  template <class Tokens>
  std::size_t operator()(const Tokens& tokens) const {
    std::uint64_t hash = 0xcbf29ce484222325U;  // FNV-1a by words
    for (const auto token : tokens) hash = (hash ^ static_cast<std::uint64_t>(token)) * 0x100000001b3U;
    return static_cast<std::size_t>(hash ^ (hash >> 29));
  }
};

// Numbers of things by what they are made of.
template <class Token>
using Kinds = std::unordered_map<std::vector<Token>, int, TokenHash>;

// What the particles of a bin do to the nine nodes around it.
struct BinKind {
  LocalStiffness K = LocalStiffness::Zero();
  std::array<double, 9> m{};
};

std::int64_t in_steps(double cells) {
  return std::llround(cells / same_place);
}

void describe_bin(const State& state, const Bin& bin, std::vector<std::int64_t>& tokens) {
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

BinKind make_kind(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state, const Bin& bin) {
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

BinKinds find_bin_kinds(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state) {
  BinKinds out;
  Kinds<std::int64_t> numbers;
  std::vector<std::int64_t> tokens;
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

// Those of each slot, in the order of bins.
std::vector<std::vector<Incidence>> find_incidences(const State& state, const Slots& slots) {
  std::vector<std::vector<Incidence>> of_slot(static_cast<std::size_t>(slots.size));
  for (std::size_t b = 0; b < state.bins.size(); ++b) {
    for (std::size_t n = 0; n < 9; ++n) {
      const auto record = static_cast<std::size_t>(state.bins[b].record[n]);
      auto& at = of_slot[static_cast<std::size_t>(slots.of_record[record])];
      if (at.empty()) at.reserve(9);
      at.push_back({static_cast<int>(b), static_cast<int>(n)});
    }
  }
  return of_slot;
}

const Master& master_at(const State& state, const Bin& bin, int node) {
  return state.masters[static_cast<std::size_t>(bin.record[static_cast<std::size_t>(node)])];
}

int code_of(const Master& master) {
  return 3 * (static_cast<int>(master.x) + 1) + static_cast<int>(master.y) + 1;
}

// What a row is assembled from.
struct Assembly {
  const State& state;
  const Slots& slots;
  const BinKinds& bins;
  const std::vector<std::vector<Incidence>>& incidences;

  template <class Visit>
  void visit(int slot, Visit visit_one) const {
    for (const Incidence& at : incidences[static_cast<std::size_t>(slot)]) {
      const auto b = static_cast<std::size_t>(at.bin);
      visit_one(state.bins[b], at.node, bins.of_bin[b]);
    }
  }
};

void describe_row(const Assembly& from, int slot, std::vector<std::int32_t>& tokens) {
  tokens.clear();
  from.visit(slot, [&](const Bin& bin, int node, int kind) {
    tokens.push_back(kind);
    tokens.push_back(16 * node + code_of(master_at(from.state, bin, node)));
    for (int n = 0; n < 9; ++n) {
      const int column = from.slots.of_record[static_cast<std::size_t>(bin.record[static_cast<std::size_t>(n)])];
      tokens.push_back(16 * (column - slot) + code_of(master_at(from.state, bin, n)));
    }
  });
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

double largest_of(const StencilRow& row) {
  double most = 0.0;
  for (const StencilEntry& entry : row) most = std::max(most, largest_of(entry));
  return most;
}

// Coefficients that are round-off of sums that cancel.
void drop_round_off(StencilRow& row) {
  constexpr double nothing = 1e-15;
  const double small = nothing * largest_of(row);
  for (StencilEntry& entry : row) {
    for (double* value : {&entry.xx, &entry.xy, &entry.yx, &entry.yy}) {
      if (std::abs(*value) <= small) *value = 0.0;
    }
  }
  std::erase_if(row, [](const StencilEntry& entry) { return largest_of(entry) == 0.0; });
}

// Empty where the node has no mass.
StencilRow make_row(const Assembly& from, int slot) {
  StencilRow row;
  double m = 0.0;
  from.visit(slot, [&](const Bin& bin, int node, int kind) {
    const BinKind& local = from.bins.kinds[static_cast<std::size_t>(kind)];
    const Master& own = master_at(from.state, bin, node);
    m += local.m[static_cast<std::size_t>(node)];
    for (int n = 0; n < 9; ++n) {
      const auto block = local.K.block<2, 2>(2 * node, 2 * n);
      if (block.isZero(0.0)) continue;
      const Master& other = master_at(from.state, bin, n);
      const int column = from.slots.of_record[static_cast<std::size_t>(bin.record[static_cast<std::size_t>(n)])];
      StencilEntry& entry = entry_at(row, column - slot);
      entry.xx -= own.x * other.x * block(0, 0), entry.xy -= own.x * other.y * block(0, 1);
      entry.yx -= own.y * other.x * block(1, 0), entry.yy -= own.y * other.y * block(1, 1);
    }
  });
  if (!(m > 0.0)) return {};
  for (StencilEntry& entry : row) entry.xx /= m, entry.xy /= m, entry.yx /= m, entry.yy /= m;
  drop_round_off(row);
  return row;
}

}  // namespace

Slots make_slots(const State& state) {
  const Grid& g = state.grid;
  Slots slots;
  const int width = g.nx + 1 + 2 * Slots::ring, rows = g.ny + 1 + 2 * Slots::ring;
  slots.stride = (width + 7) / 8 * 8 + 8;  // vectors that begin in a row's last slots end before the next row's first
  slots.plane = slots.stride * rows;
  int planes = 1;
  const auto place = [&](int record) {
    const int node = state.copies.node_of_record[static_cast<std::size_t>(record)];
    const int c = state.copies.cut_of_node[static_cast<std::size_t>(node)];
    int copy = 0;
    if (c >= 0) {
      const auto& records = state.copies.cut[static_cast<std::size_t>(c)].records;
      const auto at = std::find(records.begin(), records.end(), record);
      if (at != records.end()) copy = static_cast<int>(at - records.begin());
    }
    planes = std::max(planes, copy + 1);
    return copy * slots.plane + (g.row(node) + Slots::ring) * slots.stride + g.column(node) + Slots::ring;
  };
  for (const Master& master : state.masters) slots.of_record.push_back(place(master.record));
  slots.size = planes * slots.plane + 16;
  return slots;
}

StencilRows make_stencil_rows(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state,
                              const Slots& slots) {
  const BinKinds bins = find_bin_kinds(scene, rocks, state);
  const auto incidences = find_incidences(state, slots);
  const Assembly from{state, slots, bins, incidences};
  StencilRows out;
  out.row_of_slot.assign(static_cast<std::size_t>(slots.size), -1);
  Kinds<std::int32_t> numbers;
  std::vector<std::int32_t> tokens;
  for (int slot = 0; slot < slots.size; ++slot) {
    const auto s = static_cast<std::size_t>(slot);
    if (incidences[s].empty()) continue;
    describe_row(from, slot, tokens);
    const auto [number, is_new] = numbers.try_emplace(tokens, static_cast<int>(numbers.size()));
    if (is_new) out.rows.push_back(make_row(from, slot));
    if (!out.rows[static_cast<std::size_t>(number->second)].empty()) out.row_of_slot[s] = number->second;
  }
  return out;
}

int mirrored_slot(const Grid& grid, const Slots& slots, int slot) {
  const int i = column_of(slots, slot);
  if (i < 0) return slot - 2 * i;
  if (i > grid.nx) return slot - 2 * (i - grid.nx);
  return slot;
}

bool same_by_images(const Grid& grid, const Slots& slots, int slot, const StencilRow& long_row, const StencilRow& own) {
  constexpr double same = 1e-12;
  const auto held = [&](int at) {
    const int i = column_of(slots, at);
    return i == 0 || i == grid.nx;
  };
  StencilRow rest = own;
  for (const StencilEntry& entry : long_row) {
    const int reached = slot + entry.offset, inside = mirrored_slot(grid, slots, reached);
    const double sign = held(inside) ? 0.0 : (inside != reached ? -1.0 : 1.0);
    StencilEntry& left = entry_at(rest, inside - slot);
    left.xx -= sign * entry.xx, left.xy -= entry.xy;
    left.yx -= sign * entry.yx, left.yy -= entry.yy;
  }
  if (held(slot)) {
    for (StencilEntry& entry : rest) entry.xx = entry.xy = 0.0;
  }
  return largest_of(rest) <= same * largest_of(own);
}

}  // namespace strata
