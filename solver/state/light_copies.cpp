#include "state/light_copies.hpp"

#include <algorithm>
#include <cmath>

#include "state/shape_functions.hpp"

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
    const Gradients g = gradients_at(scene, state.grid, stencil.i, stencil.j, points[k].x, 0.5 * state.grid.h);
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

// sum_p V_p |grad N_i| (m) of each record that a surface reaches.
std::vector<double> worth_of_particles(const Scene& scene, const State& state, const std::vector<double>& reached) {
  std::vector<double> worth(state.masters.size(), 0.0);
  const Particles& p = state.particles;
  for (const Bin& bin : state.bins) {
    if (std::none_of(bin.record.begin(), bin.record.end(), [&](int r) { return reached[master_of(state, r)] >= 0.0; }))
      continue;
    for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
         q += static_cast<std::size_t>(bin.stride)) {
      const Gradients g = gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half[q]);
      for (std::size_t n = 0; n < 9; ++n)
        worth[master_of(state, bin.record[n])] += p.V[q] * std::hypot(g.N_x[n], g.N_y[n]);
    }
  }
  return worth;
}

}  // namespace

void join_light_copies(const Scene& scene, State& state) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const std::vector<double> reached = reached_by_points(scene, state, k);
    if (std::all_of(reached.begin(), reached.end(), [](double sum) { return sum < 0.0; })) continue;
    const std::vector<double> worth = worth_of_particles(scene, state, reached);
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
