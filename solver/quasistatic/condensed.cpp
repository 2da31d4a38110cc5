#include "quasistatic/condensed.hpp"

#include <algorithm>
#include <cstring>
#include <map>
#include <numeric>
#include <span>
#include <utility>

#include "state/particle_loop.hpp"

namespace strata {
namespace {

// Mixes the bits of a particle's id and area (splitmix64), so that a sum over a set tells sets apart.
std::uint64_t fingerprint(const Particles& p, std::size_t q) {
  std::uint64_t bits = 0;
  std::memcpy(&bits, &p.V[q], sizeof bits);
  bits += 0x9e3779b97f4a7c15U * (static_cast<std::uint64_t>(p.id[q]) + 1);
  bits = (bits ^ (bits >> 30U)) * 0xbf58476d1ce4e5b9U;
  bits = (bits ^ (bits >> 27U)) * 0x94d049bb133111ebU;
  return bits ^ (bits >> 31U);
}

std::vector<std::uint64_t> fingerprints(const State& state) {
  std::vector<std::uint64_t> prints(static_cast<std::size_t>(state.copies.records()), 0);
  for (const std::size_t b : state.cut_bins) {
    const Bin& bin = state.bins[b];
    std::uint64_t sum = 0;
    for (const std::size_t q : bin) sum += fingerprint(state.particles, q);
    for (const int record : bin.record) prints[static_cast<std::size_t>(record)] += sum;
  }
  return prints;
}

// The jump unknowns: at each split node and for each component, all independent copies but one, which carries u; where
// an edge or the mirror holds u, all of them.
void number_jumps(const State& state, const IntactBody& body, Condensed& out) {
  const std::vector<std::uint64_t> prints = fingerprints(state);
  out.jump_of_record.assign(static_cast<std::size_t>(state.copies.records()), {-1, -1});
  for (const CutNode& cut : state.copies.cut) {
    if (cut.records.size() < 2) continue;
    const int node = state.copies.node(cut.records.front());
    const Master& intact = body.masters[static_cast<std::size_t>(node)];
    for (int component = 0; component < 2; ++component) {
      bool carries_u = intact.record == node && intact.of(component) != 0.0;
      for (const int record : cut.records) {
        const auto r = static_cast<std::size_t>(record);
        const Master& master = out.masters[r];
        if (master.record != record || master.of(component) == 0.0 || state.sums[r].m == 0.0) continue;
        if (carries_u) {
          carries_u = false;
          continue;
        }
        out.jump_of_record[r][static_cast<std::size_t>(component)] = static_cast<int>(out.columns.size());
        auto column = std::make_shared<JumpColumn>();
        column->key = {node, component, prints[r]};
        out.columns.push_back(std::move(column));
      }
    }
  }
}

// Takes columns and entries over from `before`; tells of each unknown whether it is new. Their entries are 0 yet.
std::vector<char> reuse_columns(const Condensed* before, Condensed& out) {
  const auto n = std::ssize(out.columns);
  out.S = Eigen::MatrixXd::Zero(n, n);
  std::vector<char> fresh(out.columns.size(), 1);
  if (before == nullptr) return fresh;
  std::map<JumpKey, std::size_t> known;
  for (std::size_t k = 0; k < before->columns.size(); ++k) known.emplace(before->columns[k]->key, k);
  std::vector<std::pair<Eigen::Index, Eigen::Index>> kept;  // now, and before
  for (std::size_t k = 0; k < fresh.size(); ++k) {
    const auto found = known.find(out.columns[k]->key);
    if (found == known.end()) continue;
    fresh[k] = 0;
    out.columns[k] = before->columns[found->second];
    kept.emplace_back(k, found->second);
  }
  for (const auto& [column, column_before] : kept) {
    for (const auto& [row, row_before] : kept) out.S(row, column) = before->S(row_before, column_before);
  }
  return fresh;
}

// Adds what one particle contributes to G of the new unknowns and to their K_jj, in the place of S.
void add_particle(const LocalStiffness& K, const Bin& bin, const IntactBody& body, const State& state,
                  const std::vector<char>& fresh, Condensed& out, std::vector<SparseVector>& G) {
  std::array<Unknown, 18> base, jump;
  for (int k = 0; k < 18; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const int record = bin.record[at / 2];
    base[at] = unknown_of(body.masters, state.copies.node(record), k % 2);
    jump[at] = jump_unknown(out, record, k % 2);
  }
  for (int b = 0; b < 18; ++b) {
    const Unknown& column = jump[static_cast<std::size_t>(b)];
    if (column.index < 0) continue;
    const bool is_new = fresh[static_cast<std::size_t>(column.index)] != 0;
    for (int a = 0; a < 18; ++a) {
      const Unknown &row = base[static_cast<std::size_t>(a)], &other = jump[static_cast<std::size_t>(a)];
      if (is_new && row.index >= 0 && K(a, b) != 0.0)
        G[static_cast<std::size_t>(column.index)].emplace_back(row.index, row.factor * column.factor * K(a, b));
      if (other.index >= 0 && (is_new || fresh[static_cast<std::size_t>(other.index)] != 0))
        out.S(other.index, column.index) += other.factor * column.factor * K(a, b);
    }
  }
}

// Assembles G and K_jj of the new unknowns. Particles come cell by cell in the order of their ids, so that sums do not
// depend on how copies group them into bins.
std::vector<SparseVector> assemble_jumps(const Scene& scene, const Rocks& rocks, const State& state,
                                         const IntactBody& body, const std::vector<char>& fresh, Condensed& out) {
  std::vector<SparseVector> G(out.columns.size());
  const Particles& p = state.particles;
  const auto touches_new = [&](const Bin& bin) {
    for (const int record : bin.record) {
      for (int component = 0; component < 2; ++component) {
        const int index = jump_unknown(out, record, component).index;
        if (index >= 0 && fresh[static_cast<std::size_t>(index)] != 0) return true;
      }
    }
    return false;
  };
  struct Member {
    std::int32_t id;
    std::size_t q;
    const Bin* bin;
  };
  std::vector<Member> members;
  const std::vector<std::size_t>& cut = state.cut_bins;  // all bins of a cell, which share its nodes, or none
  for (std::size_t b = 0; b < cut.size();) {
    members.clear();
    bool any = false;
    const Bin& first = state.bins[cut[b]];
    for (; b < cut.size() && state.bins[cut[b]].i == first.i && state.bins[cut[b]].j == first.j; ++b) {
      const Bin& bin = state.bins[cut[b]];
      any = any || touches_new(bin);
      for (const std::size_t q : bin) members.push_back({p.id[q], q, &bin});
    }
    if (!any) continue;
    std::sort(members.begin(), members.end(), [](const Member& a, const Member& c) { return a.id < c.id; });
    for (const Member& m : members) {
      if (body.halved && p.x[m.q] > 0.5 * scene.domain.width_m) continue;
      LocalStiffness K = LocalStiffness::Zero();
      const Gradients g = gradients_at(scene, state, *m.bin, m.q);
      add_stiffness(rocks[p.rock[m.q]], g, body.halved ? 2.0 * p.V[m.q] : p.V[m.q], K);
      add_particle(K, *m.bin, body, state, fresh, out, G);
    }
  }
  return G;
}

SparseVector summed(SparseVector entries) {
  std::stable_sort(entries.begin(), entries.end(), [](const auto& a, const auto& b) { return a.first < b.first; });
  SparseVector out;
  for (const auto& [index, value] : entries) {
    if (out.empty() || out.back().first != index) out.emplace_back(index, 0.0);
    out.back().second += value;
  }
  return out;
}

// G and Y of new unknowns, so many side by side, and their S = K_jj - Y^T Y against all whose Y is known.
void condense_some(const IntactBody& body, std::span<const std::size_t> some, const std::vector<char>& fresh,
                   std::vector<SparseVector>& entries, Condensed& out) {
  std::vector<SparseVector> G;
  for (const std::size_t k : some) G.push_back(summed(std::move(entries[k])));
  TreeFactor::SideBySide y;
  std::vector<SparseVector> Y = body.factor.forward(G, y);
  for (std::size_t c = 0; c < some.size(); ++c) {
    auto& column = out.columns[some[c]];
    column = std::make_shared<JumpColumn>(JumpColumn{column->key, std::move(G[c]), std::move(Y[c])});
  }
  for (std::size_t b = 0; b < out.columns.size(); ++b) {
    Eigen::RowVector<double, TreeFactor::together> product = Eigen::RowVector<double, TreeFactor::together>::Zero();
    for (const auto& [row, value] : out.columns[b]->Y) product += value * y.row(row);
    for (std::size_t c = 0; c < some.size(); ++c) {
      if (fresh[b] != 0 && b > some[c]) continue;  // its turn comes
      const auto i = static_cast<Eigen::Index>(some[c]), j = static_cast<Eigen::Index>(b);
      // K_jj is symmetric but for round-off, and which of two unknowns is new depends on what came before.
      out.S(i, j) = out.S(j, i) = 0.5 * (out.S(j, i) + out.S(i, j)) - product[static_cast<Eigen::Index>(c)];
    }
  }
}

bool holds_rigid_motion(const Scene& scene, bool halved) {
  return (halved || scene.domain.holds_x()) && scene.domain.holds_y();
}

// Takes out the mean displacement and rotation that no edge holds.
void remove_rigid_motion(const Scene& scene, const State& state, bool halved, std::vector<Vec2>& u) {
  if (holds_rigid_motion(scene, halved)) return;
  const bool x_held = halved || scene.domain.holds_x(), y_held = scene.domain.holds_y();
  // Mean over the block's area: with 0.5 (u_y,x - u_x,y) as rotation, from the particles' own fields.
  const Particles& p = state.particles;
  const Vec2 centre{0.5 * scene.domain.width_m, 0.5 * scene.domain.height_m};
  Vec2 mean = Vec2::Zero();
  double turn = 0.0, polar = 0.0, area = 0.0;
  for_each_particle(scene, state, state.bins, [&](const Bin& bin, std::size_t q, const Gradients& g) {
    const Vec2 arm = Vec2{p.x[q], p.y[q]} - centre, u_p = interpolate(g, bin, u);
    mean += p.V[q] * u_p;
    turn += p.V[q] * cross(arm, u_p);
    polar += p.V[q] * arm.squaredNorm();
    area += p.V[q];
  });
  mean /= area;
  turn = !x_held && !y_held ? turn / polar : 0.0;
  if (x_held) mean.x() = 0.0;
  if (y_held) mean.y() = 0.0;
  const Grid& grid = state.grid;
  for (std::size_t r = 0; r < u.size(); ++r) {
    const int node = state.copies.node(static_cast<int>(r));
    const Vec2 arm = Vec2{grid.x(grid.column(node)), grid.y(grid.row(node))} - centre;
    u[r] -= mean + turn * Vec2{-arm.y(), arm.x()};
  }
}

}  // namespace

Unknown jump_unknown(const Condensed& condensed, int record, int component) {
  const Master& master = condensed.masters[static_cast<std::size_t>(record)];
  const double factor = master.of(component);
  const int index =
      condensed.jump_of_record[static_cast<std::size_t>(master.record)][static_cast<std::size_t>(component)];
  return factor == 0.0 ? Unknown{} : Unknown{index, factor};
}

Condensed condense(const Scene& scene, const Rocks& rocks, const State& state, const IntactBody& body,
                   const Condensed* before) {
  Condensed out;
  out.masters = body.halved ? mirrored(state, state.masters) : state.masters;
  number_jumps(state, body, out);
  const std::vector<char> fresh = reuse_columns(before, out);
  std::vector<std::size_t> made;  // the new unknowns
  for (std::size_t k = 0; k < fresh.size(); ++k) {
    if (fresh[k] != 0) made.push_back(k);
  }
  std::vector<SparseVector> entries = assemble_jumps(scene, rocks, state, body, fresh, out);
  constexpr std::size_t most = TreeFactor::together;
  for (std::size_t from = 0; from < made.size(); from += most) {
    const auto some = std::span(made).subspan(from, std::min(most, made.size() - from));
    condense_some(body, some, fresh, entries, out);
  }
  std::vector<int> loaded;
  for (const auto& column : out.columns)
    for (const auto& [row, value] : column->G) loaded.push_back(row);
  out.loaded = body.factor.branches(loaded);
  return out;
}

Asked ask_for(const Scene& scene, const State& state, const IntactBody& body, const std::vector<std::size_t>& bins) {
  if (!holds_rigid_motion(scene, body.halved)) return ask_for_all(state, body);
  std::vector<int> records;
  for (const std::size_t b : bins)
    records.insert(records.end(), state.bins[b].record.begin(), state.bins[b].record.end());
  std::ranges::sort(records);
  records.erase(std::unique(records.begin(), records.end()), records.end());
  std::vector<int> unknowns;
  for (const int record : records) {
    const int node = state.copies.node(record);
    for (int component = 0; component < 2; ++component) {
      const Unknown from = unknown_of(body.masters, node, component);
      if (from.index >= 0) unknowns.push_back(from.index);
    }
  }
  return {std::move(records), body.factor.branches(unknowns)};
}

Asked ask_for_all(const State& state, const IntactBody& body) {
  Asked all;
  all.records.resize(static_cast<std::size_t>(state.copies.records()));
  all.blocks = body.factor.all();
  std::iota(all.records.begin(), all.records.end(), 0);
  return all;
}

std::vector<Vec2> displacements(const Scene& scene, const State& state, const IntactBody& body,
                                const Condensed& condensed, const Eigen::VectorXd& j, const Asked& asked) {
  const TreeFactor& factor = body.factor;
  const auto& loaded = condensed.load.empty() ? condensed.loaded : factor.all();  // a body force loads them all
  Eigen::VectorXd base = Eigen::VectorXd::Zero(factor.size());
  for (int k = 0; k < condensed.load.intact.size(); ++k) base[factor.row(k)] = condensed.load.intact[k];
  for (std::size_t k = 0; k < condensed.columns.size(); ++k) {
    for (const auto& [unknown, value] : condensed.columns[k]->G)
      base[factor.row(unknown)] -= value * j[static_cast<Eigen::Index>(k)];
  }
  factor.solve(loaded, asked.blocks, base);
  std::vector<Vec2> u(static_cast<std::size_t>(state.copies.records()), Vec2::Zero());
  for (const int record : asked.records) {
    const int node = state.copies.node(record);
    Vec2& u_r = u[static_cast<std::size_t>(record)];
    for (int component = 0; component < 2; ++component) {
      const Unknown from = unknown_of(body.masters, node, component), jump = jump_unknown(condensed, record, component);
      if (from.index >= 0) u_r[component] += from.factor * base[factor.row(from.index)];
      if (jump.index >= 0) u_r[component] += jump.factor * j[jump.index];
    }
  }
  remove_rigid_motion(scene, state, body.halved, u);
  return u;
}

}  // namespace strata
