#include "state/light_copies.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <functional>
#include <numeric>

#include "state/particle_loop.hpp"

namespace strata {
namespace {

std::size_t master_of(const State& state, int record) {
  return static_cast<std::size_t>(state.masters[static_cast<std::size_t>(record)].record);
}

// int N_i ds over a surface's split points (m) of each record that they part, -1 for all others.
std::vector<double> reached_by_points(const Scene& scene, const State& state, std::size_t surface) {
  std::vector<double> reached(state.masters.size(), -1.0);
  const auto& points = state.surfaces[surface].points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const SurfaceStencil& stencil = state.point_stencils[surface][k];
    if (!points[k].split) continue;
    const Vec2 half = Vec2::Constant(0.5 * state.grid.h);
    const Gradients g = gradients_at(scene, state.grid, stencil.i, stencil.j, points[k].x, half);
    for (std::size_t n = 0; n < 9; ++n) {
      if (stencil.plus[n] == stencil.minus[n]) continue;
      for (const int record : {stencil.plus[n], stencil.minus[n]}) {
        double& sum = reached[master_of(state, record)];
        sum = std::max(sum, 0.0) + points[k].A * g.N[n];
      }
    }
  }
  return reached;
}

// sum_p V_p |grad N_i| (m) of the records r of all bins, added up at index(r); negative ones are left out. The k-th
// particle of the bins is particle(k).
template <class Index, class Particle = std::identity>
std::vector<double> worth_of_particles(const Scene& scene, const State& state, std::size_t size, Index index,
                                       Particle particle = {}) {
  std::vector<double> worth(size, 0.0);
  const Particles& p = state.particles;
  for (const Bin& bin : state.bins) {
    std::array<int, 9> at{};
    std::ranges::transform(bin.record, at.begin(), index);
    if (std::ranges::all_of(at, [](int r) { return r < 0; })) continue;
    for (const std::size_t k : bin) {
      const std::size_t q = particle(k);
      const Gradients g = gradients_at(scene, state, bin, q);
      for (std::size_t n = 0; n < 9; ++n) {
        const double slope = std::sqrt(g.N_x[n] * g.N_x[n] + g.N_y[n] * g.N_y[n]);  // |grad N_n| (1/m)
        if (at[n] >= 0) worth[static_cast<std::size_t>(at[n])] += p.V[q] * slope;
      }
    }
  }
  return worth;
}

// Whether the fracture is not along the grid where it is nearest to a node.
bool leans_at(const State& state, int node) {
  const Grid& g = state.grid;
  const Projection on = project(state.fracture(), {g.x(g.column(node)), g.y(g.row(node))}, 0.0);
  const auto& points = state.fracture().points;
  const auto after = std::find_if(points.begin(), points.end() - 1,
                                  [&](const SurfacePoint& s) { return s.arc + 0.5 * s.A >= on.arc; });
  constexpr double along_grid = 1.0 - 1e-6;
  return std::abs(after->n.x()) < along_grid && std::abs(after->n.y()) < along_grid;
}

// The corner that a small one is to be part of, or itself.
std::size_t corner_for(const CutNode& cut, const std::vector<double>& worth, std::size_t small) {
  const auto less = [&](std::size_t a, std::size_t b) {
    return std::pair(worth[a], cut.keys[a]) < std::pair(worth[b], cut.keys[b]);
  };
  std::size_t into = small;
  for (std::size_t other = 0; other < worth.size(); ++other) {
    const SideWord parted = cut.keys[small] ^ cut.keys[other];
    if (std::popcount(parted) == 1 && parted != cut.fracture && less(into, other)) into = other;
  }
  return into;
}

}  // namespace

void join_corners(const Scene& scene, const std::vector<std::size_t>& order, State& state) {
  Copies& copies = state.copies;
  std::vector<char> leans(static_cast<std::size_t>(copies.records()), 0);  // of corners' records
  for (const CutNode& cut : copies.cut) {                                  // without particles a ghost has no corner
    if (cut.fracture == 0 || cut.mask == cut.fracture || cut.keys.size() < 3) continue;
    if (!leans_at(state, copies.node(cut.records.front()))) continue;
    for (const int record : cut.records) leans[static_cast<std::size_t>(record)] = 1;
  }
  if (std::ranges::count(leans, 1) == 0) return;
  const auto index = [&](int record) { return leans[static_cast<std::size_t>(record)] != 0 ? record : -1; };
  const std::vector<double> worth_of_record =
      worth_of_particles(scene, state, leans.size(), index, [&](std::size_t k) { return order[k]; });
  std::vector<int> now(leans.size());
  std::iota(now.begin(), now.end(), 0);
  for (CutNode& cut : copies.cut) {
    if (cut.keys.empty() || index(cut.records.front()) < 0) continue;
    std::vector<double> worth;
    for (const int record : cut.records) worth.push_back(worth_of_record[static_cast<std::size_t>(record)]);
    const double all = std::accumulate(worth.begin(), worth.end(), 0.0);
    const auto keys = cut.keys;
    for (std::size_t k = 0; k < keys.size(); ++k) {
      const std::size_t into = worth[k] < least_corner * all ? corner_for(cut, worth, k) : k;
      if (into == k) continue;
      cut.joined.push_back({keys[k], keys[into]});
      now[static_cast<std::size_t>(cut.records[k])] = cut.records[into];
    }
    const auto serves = [&](SideWord key) {  // another corner as well
      return std::ranges::any_of(cut.joined, [&](const auto& pair) { return pair[1] == key; });
    };
    for (const auto& [small, into] : cut.joined) {
      if (serves(small)) continue;
      const auto at = std::ranges::find(cut.keys, small) - cut.keys.begin();
      cut.keys.erase(cut.keys.begin() + at), cut.records.erase(cut.records.begin() + at);
    }
  }
  for (Bin& bin : state.bins) {
    for (int& record : bin.record) record = now[static_cast<std::size_t>(record)];
  }
}

void join_light_copies(const Scene& scene, State& state) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const std::vector<double> reached = reached_by_points(scene, state, k);
    if (std::all_of(reached.begin(), reached.end(), [](double sum) { return sum < 0.0; })) continue;
    const std::vector<double> worth = worth_of_particles(scene, state, reached.size(), [&](int record) {
      const std::size_t master = master_of(state, record);
      return reached[master] < 0.0 ? -1 : static_cast<int>(master);
    });
    const auto is_light = [&](int record) {
      const double load = reached[master_of(state, record)];
      return load > (load < least_reach * state.grid.h ? 1.0 : most_load) * worth[master_of(state, record)];
    };
    for (auto* stencils : {&state.point_stencils[k], &state.vertex_stencils[k]}) {
      for (SurfaceStencil& stencil : *stencils) {
        for (std::size_t n = 0; n < 9; ++n) {
          if (stencil.plus[n] == stencil.minus[n]) continue;
          if (is_light(stencil.plus[n])) stencil.plus[n] = stencil.minus[n];
          if (is_light(stencil.minus[n])) stencil.minus[n] = stencil.plus[n];
        }
      }
    }
  }
}

}  // namespace strata
