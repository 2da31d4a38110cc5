#include "state/quarter_forces.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "state/stiffness.hpp"
#include "state/quarters.hpp"

namespace strata {

namespace {

using Motion = Eigen::Matrix<double, 18, 1>;  // of a bin's nodes, (u_x, u_y) in turn

// Visits what replaces the particles of a bin that stand for four: each itself with its area taken back, and its
// quarters; visit(rock, functions, area).
template <class Visit>
void for_each_change(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state,
                     const Quarters& quarters, const Bin& bin, Visit visit) {
  const Particles& p = state.particles;
  const auto add = [&](std::size_t q, const Vec2& x, const Vec2& half, double V) {
    visit(rocks[p.rock[q]], gradients_at(scene, state.grid, bin.i, bin.j, x, half), V);
  };
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
       q += static_cast<std::size_t>(bin.stride)) {
    if (!quarters.whole(p, q)) continue;
    add(q, {p.x[q], p.y[q]}, p.half(q), -p.V[q]);
    quarters.for_each_point(p, q, [&](const Vec2& x, const Vec2& half, double V) { add(q, x, half, V); });
  }
}

// What quarters add to the stiffness of a bin.
LocalStiffness stiffness_of_quarters(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state,
                                     const Quarters& quarters, const Bin& bin) {
  LocalStiffness more = LocalStiffness::Zero();
  for_each_change(scene, rocks, state, quarters, bin,
                  [&](const Elasticity& rock, const Gradients& g, double V) { add_stiffness(rock, g, V, more); });
  return more;
}

// What they add to the forces that hold a motion of its nodes, V B^T s (N/m): a bin that is like no other needs no
// stiffness.
Motion forces_of_quarters(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state,
                          const Quarters& quarters, const Bin& bin, const Motion& moved) {
  Motion f = Motion::Zero();
  const auto add = [&](const Elasticity& rock, const Gradients& g, double V) {
    Vec2 d_x = Vec2::Zero(), d_y = Vec2::Zero();
    for (std::size_t n = 0; n < 9; ++n) {
      const Vec2 u = moved.segment<2>(static_cast<Eigen::Index>(2 * n));
      d_x += g.N_x[n] * u, d_y += g.N_y[n] * u;
    }
    const Stress s = stress_of(rock, d_x.x(), d_y.x(), d_x.y(), d_y.y());
    for (std::size_t n = 0; n < 9; ++n)
      f.segment<2>(static_cast<Eigen::Index>(2 * n)) += V * s.on({g.N_x[n], g.N_y[n]});
  };
  for_each_change(scene, rocks, state, quarters, bin, add);
  return f;
}

// Whether three spans in a row are all h, but for round-off.
template <class Span>
bool is_uniform(const Grid& g, int middle, Span span) {
  constexpr double round_off = 1e-9;
  for (int k = middle - 1; k <= middle + 1; ++k) {
    if (std::abs(span(k) - g.h) > round_off * g.h) return false;
  }
  return true;
}

// What bins are like each other by: their column, their row (-1: one among cells of width or height h, as all such) and
// their rock.
using Likeness = std::tuple<int, int, int>;

// The kind of a bin of four particles that stand for four; none where it is like no other: among cells that are neither
// of width nor of height h.
std::optional<Likeness> kind_of(const State& state, const Quarters& quarters, const Bin& bin) {
  const Particles& p = state.particles;
  const Grid& g = state.grid;
  if (bin.last - bin.first != 4 * bin.stride) return std::nullopt;
  const bool along_x = is_uniform(g, bin.i, [&](int k) { return g.span_x(k); }),
             along_y = is_uniform(g, bin.j, [&](int k) { return g.span_y(k); });
  if (!along_x && !along_y) return std::nullopt;
  const auto first = static_cast<std::size_t>(bin.first);
  for (auto q = first; q < static_cast<std::size_t>(bin.last); q += static_cast<std::size_t>(bin.stride)) {
    if (!quarters.whole(p, q) || p.rock[q] != p.rock[first]) return std::nullopt;
  }
  return Likeness{along_x ? -1 : bin.i, along_y ? -1 : bin.j, p.rock[first]};
}

bool any_whole(const State& state, const Quarters& quarters, const Bin& bin) {
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
       q += static_cast<std::size_t>(bin.stride)) {
    if (quarters.whole(state.particles, q)) return true;
  }
  return false;
}

}  // namespace

void exert_quarters(const Scene& scene, const std::vector<Elasticity>& rocks, const std::vector<Vec2>& u,
                    State& state) {
  const Quarters quarters(scene, state.grid);
  if (!quarters.in_use()) return;
  std::map<Likeness, LocalStiffness> alike;
  for (const Bin& bin : state.bins) {
    if (!any_whole(state, quarters, bin)) continue;
    Motion moved;
    for (Eigen::Index n = 0; n < 9; ++n)
      moved.segment<2>(2 * n) = u[static_cast<std::size_t>(bin.record[static_cast<std::size_t>(n)])];
    const std::optional<Likeness> kind = kind_of(state, quarters, bin);
    if (kind && !alike.contains(*kind)) alike.emplace(*kind, stiffness_of_quarters(scene, rocks, state, quarters, bin));
    const Motion f =
        kind ? Motion(alike.at(*kind) * moved) : forces_of_quarters(scene, rocks, state, quarters, bin, moved);
    for (std::size_t n = 0; n < 9; ++n) {
      const auto r = static_cast<std::size_t>(bin.record[n]);
      const auto k = static_cast<Eigen::Index>(2 * n);
      state.sums.f_x[r] -= f[k], state.sums.f_y[r] -= f[k + 1];
    }
  }
}

}  // namespace strata
