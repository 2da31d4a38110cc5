#include "explicit/total/total_operator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>

#include "explicit/transfers.hpp"
#include "state/lanes.hpp"
#include "state/particle_loop.hpp"
#include "state/parts.hpp"
#include "state/stiffness.hpp"

namespace strata {

namespace {

using L = Lanes<most_lanes>;
using Lane = L::Real;

// --- rows

// Places within a cell are told apart by multiples of this (cells): far above the round-off of a coordinate, far below
// what a kernel's results may differ by.
constexpr double same_place = 1.0 / (1LL << 36);

// What a thing is made of, as bytes, and numbers of things by it.
using Tokens = std::string;
using Kinds = std::unordered_map<Tokens, int>;

void note(std::int64_t token, Tokens& tokens) {
  tokens.append(reinterpret_cast<const char*>(&token), sizeof(token));
}

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
    note(g.x_knots.empty() ? 0 : in_steps(g.span_x(bin.i + k) / g.h), tokens);
    note(g.y_knots.empty() ? 0 : in_steps(g.span_y(bin.j + k) / g.h), tokens);
  }
  for (const std::size_t q : bin) {
    note(in_steps((p.x[q] - g.x(bin.i)) / g.h), tokens);
    note(in_steps((p.y[q] - g.y(bin.j)) / g.h), tokens);
    note(in_steps(p.V[q] / (g.h * g.h)), tokens);
    note(p.rock[q], tokens);
  }
}

BinKind make_kind(const Scene& scene, const Rocks& rocks, const State& state, const Bin& bin) {
  const Particles& p = state.particles;
  BinKind kind;
  for (const std::size_t q : bin) {
    const Gradients g = gradients_at(scene, state, bin, q);
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
    note(bins.of_bin[static_cast<std::size_t>(bin)], tokens);
    note(16 * node + code_of(master_at(state, bin, node)), tokens);
    for (int n = 0; n < 9; ++n) {
      const Master& other = master_at(state, bin, n);
      note(16 * (other.record - record) + code_of(other), tokens);
    }
  }
}

// A row of -M^-1 K: its blocks (1/s^2) by the offset of their record. None where the node has no mass.
std::map<int, Eigen::Matrix2d> make_row(const State& state, const BinKinds& bins, const std::vector<Incidence>& around,
                                        int record) {
  std::map<int, Eigen::Matrix2d> row;
  double m = 0.0;
  for (const auto& [bin, node] : around) {
    const BinKind& local = bins.kinds[static_cast<std::size_t>(bins.of_bin[static_cast<std::size_t>(bin)])];
    const Master& own = master_at(state, bin, node);
    m += local.m[static_cast<std::size_t>(node)];
    for (int n = 0; n < 9; ++n) {
      const auto block = local.K.block<2, 2>(2 * node, 2 * n);
      if (block.isZero(0.0)) continue;
      const Master& other = master_at(state, bin, n);
      row.try_emplace(other.record - record, Eigen::Matrix2d::Zero()).first->second -=
          Vec2{own.x, own.y}.asDiagonal() * block * Vec2{other.x, other.y}.asDiagonal();
    }
  }
  if (!(m > 0.0)) return {};
  for (auto& [offset, block] : row) block /= m;
  return row;
}

// Adds a row to an operator, without coefficients that are round-off of sums that cancel.
void add_row(const std::map<int, Eigen::Matrix2d>& blocks, StencilOperator& op) {
  constexpr double nothing = 1e-15;
  double most = 0.0;
  for (const auto& [offset, block] : blocks) most = std::max(most, block.cwiseAbs().maxCoeff());
  const auto kept = [&](double value) { return std::abs(value) <= nothing * most ? 0.0 : value; };
  StencilRow row{.entry = op.entries.size(), .segment = op.segments.size()};
  for (const bool diagonal : {false, true}) {
    for (const auto& [offset, block] : blocks) {
      const Eigen::Matrix2d b = block.unaryExpr(kept);
      if (b.isZero(0.0) || (b(0, 1) == 0.0 && b(1, 0) == 0.0) != diagonal) continue;
      op.entries.push_back({offset, b(0, 0), b(0, 1), b(1, 0), b(1, 1)});
      ++(diagonal ? row.diagonal : row.full);
    }
  }
  for (const auto& [offset, block] : blocks) {
    const Eigen::Matrix2d b = block.unaryExpr(kept);
    if (b.isZero(0.0)) continue;
    if (row.segments == 0 || offset >= op.segments.back().offset + most_lanes)
      op.segments.emplace_back().offset = offset, ++row.segments;
    StencilSegment& s = op.segments.back();
    const auto k = static_cast<std::size_t>(offset - s.offset);
    s.xx[k] = b(0, 0), s.xy[k] = b(0, 1), s.yx[k] = b(1, 0), s.yy[k] = b(1, 1);
  }
  op.rows.push_back(row);
}

// --- applying

// `count` vectors of records from `at` on.
template <int count>
void apply_block(const StencilOperator& op, const StencilRow& row, std::size_t at, TotalMotion& t) {
  constexpr std::ptrdiff_t W = most_lanes;
  Lane x[count], y[count];
  for (std::ptrdiff_t k = 0; k < count; ++k)
    x[k] = L::load(&t.base_x[at] + W * k), y[k] = L::load(&t.base_y[at] + W * k);
  const double *u_x = t.u_x.data() + at, *u_y = t.u_y.data() + at;
  const StencilEntry *e = &op.entries[row.entry], *const full = e + row.full, *const end = full + row.diagonal;
  for (; e != full; ++e) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      const Lane a = L::load(u_x + e->offset + W * k), b = L::load(u_y + e->offset + W * k);
      x[k] += e->xx * a;
      y[k] += e->yx * a;
      x[k] += e->xy * b;
      y[k] += e->yy * b;
    }
  }
  for (; e != end; ++e) {
    for (std::ptrdiff_t k = 0; k < count; ++k) {
      x[k] += e->xx * L::load(u_x + e->offset + W * k);
      y[k] += e->yy * L::load(u_y + e->offset + W * k);
    }
  }
  for (std::ptrdiff_t k = 0; k < count; ++k) L::store(&t.a_x[at] + W * k, x[k]), L::store(&t.a_y[at] + W * k, y[k]);
}

// Halves added to halves.
double sum_of_lanes(Lane value) {
  for (int half = most_lanes / 2; half > 0; half /= 2) {
    for (int l = 0; l < half; ++l) value[l] += value[l + half];
  }
  return value[0];
}

// One record, by the vectors of its row.
void apply_record(const StencilOperator& op, const StencilRow& row, std::size_t r, TotalMotion& t) {
  const double *u_x = t.u_x.data() + r, *u_y = t.u_y.data() + r;
  Lane x{}, y{};
  for (std::size_t k = row.segment; k < row.segment + row.segments; ++k) {
    const StencilSegment& s = op.segments[k];
    const Lane a = L::load(u_x + s.offset), b = L::load(u_y + s.offset);
    x += L::load(s.xx.data()) * a;
    y += L::load(s.yx.data()) * a;
    x += L::load(s.xy.data()) * b;
    y += L::load(s.yy.data()) * b;
  }
  t.a_x[r] = t.base_x[r] + sum_of_lanes(x);
  t.a_y[r] = t.base_y[r] + sum_of_lanes(y);
}

// The last vectors of a run begin before what is left where it does not fill them.
void apply_run(const StencilOperator& op, const StencilRun& run, TotalMotion& t) {
  constexpr std::size_t one = most_lanes, two = 2 * one, four = 4 * one;
  const StencilRow& row = op.rows[run.row];
  const std::size_t n = run.last - run.first;
  std::size_t at = run.first;
  for (; at + four <= run.last; at += four) apply_block<4>(op, row, at, t);
  const std::size_t left = run.last - at;
  if (n < one) {
    for (; at < run.last; ++at) apply_record(op, row, at, t);
  } else if (n < four) {
    for (; at + one <= run.last; at += one) apply_block<1>(op, row, at, t);
    if (at < run.last) apply_block<1>(op, row, run.last - one, t);
  } else if (left > two) {
    apply_block<4>(op, row, run.last - four, t);
  } else if (left > 0) {
    apply_block<2>(op, row, run.last - two, t);
  }
}

// A thread has the same runs in each step, so that nodes stay in its cache.
void apply_stencils(TotalMotion& t) {
  const StencilOperator& op = *t.op;
#pragma omp parallel for schedule(static) if (t.m.size() > worth_threads)
  for (const StencilRun& run : op.runs) apply_run(op, run, t);
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
      const Gradients g = gradients_at(scene, state, bin, q);
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

}  // namespace

// Rows of -M^-1 K with K = sum_p V_p B^T C B (add_stiffness()) and lumped masses, rows and columns folded to masters.
// Surroundings count as the same where they agree to 1.5e-11 of a cell.
StencilOperator make_operator(const Scene& scene, const Rocks& rocks, const State& state) {
  const BinKinds bins = find_bin_kinds(scene, rocks, state);
  const auto incidences = find_incidences(state);
  StencilOperator op;
  Kinds numbers;
  Tokens tokens;
  for (std::size_t r = 0; r < incidences.size(); ++r) {
    if (incidences[r].empty()) continue;
    const auto record = static_cast<int>(r);
    describe_row(state, bins, incidences[r], record, tokens);
    const auto [number, is_new] = numbers.try_emplace(tokens, static_cast<int>(numbers.size()));
    if (is_new) add_row(make_row(state, bins, incidences[r], record), op);
    const auto row = static_cast<std::size_t>(number->second);
    if (op.rows[row].full + op.rows[row].diagonal == 0) continue;
    if (op.runs.empty() || op.runs.back().last != r || op.runs.back().row != row) op.runs.push_back({r, r, row});
    op.runs.back().last = r + 1;
  }
  return op;
}

NodeTotals move_nodes(double keep, State& state) {
  TotalMotion& t = state.total;
  const double dt = state.dt;
  return sum_over_parts<NodeTotals>(state.masters.size(), [&](const Part& part) {
    Lane kinetic{}, increment{}, power{}, product{}, fastest{};
    for (std::size_t r = part.first; r < part.last; r += most_lanes) {
      const Lane m = L::load(&t.m[r]), a_x = L::load(&t.a_x[r]), a_y = L::load(&t.a_y[r]);
      const Lane from_x = L::load(&t.v_x[r]), v_x = keep * from_x + dt * a_x;
      const Lane from_y = L::load(&t.v_y[r]), v_y = keep * from_y + dt * a_y;
      L::store(&t.v_x[r], v_x), L::store(&t.u_x[r], L::load(&t.u_x[r]) + dt * v_x);
      L::store(&t.v_y[r], v_y), L::store(&t.u_y[r], L::load(&t.u_y[r]) + dt * v_y);
      const Lane speed2 = v_x * v_x + v_y * v_y;
      kinetic += m * speed2, increment += m * (a_x * a_x + a_y * a_y);
      power += m * (v_x * a_x + v_y * a_y), product += m * (from_x * v_x + from_y * v_y);
      fastest = larger<Lane>(fastest, speed2);
    }
    NodeTotals total{0.5 * sum_of_lanes(kinetic), 0.5 * dt * dt * sum_of_lanes(increment), sum_of_lanes(power),
                     sum_of_lanes(product)};
    for (int l = 0; l < most_lanes; ++l) total.largest_speed2 = std::max(total.largest_speed2, fastest[l]);
    return total;
  });
}

double find_accelerations(const Scene& scene, const Rocks& rocks, State& state) {
  const bool fast = scene.numerics.kernels == Numerics::Kernels::fast;
  fast ? apply_stencils(state.total) : apply_particles(scene, rocks, state);
  const TotalMotion& t = state.total;
  return sum_over_parts<double>(state.masters.size(), [&](const Part& part) {
    return (part.of(t.m) * (part.of(t.v_x) * part.of(t.a_x) + part.of(t.v_y) * part.of(t.a_y))).sum();
  });
}

}  // namespace strata
