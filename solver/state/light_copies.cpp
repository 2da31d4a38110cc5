#include "state/light_copies.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <bit>
#include <cmath>

#include "state/shape_functions.hpp"

namespace strata {

namespace {

std::size_t master_of(const State& state, int record) {
  return static_cast<std::size_t>(state.masters[static_cast<std::size_t>(record)].record);
}

// |grad N_n| (1/m).
double slope(const Gradients& g, std::size_t n) {
  return std::sqrt(g.N_x[n] * g.N_x[n] + g.N_y[n] * g.N_y[n]);
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

// sum_p V_p |grad N_i| (m) of each record that a surface reaches.
std::vector<double> worth_of_particles(const Scene& scene, const State& state, const std::vector<double>& reached) {
  std::vector<double> worth(state.masters.size(), 0.0);
  const Particles& p = state.particles;
  for (const std::size_t b : state.cut_bins) {
    const Bin& bin = state.bins[b];
    if (std::none_of(bin.record.begin(), bin.record.end(), [&](int r) { return reached[master_of(state, r)] >= 0.0; }))
      continue;
    for (const std::size_t q : bin) {
      const Gradients g = gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
      for (std::size_t n = 0; n < 9; ++n) worth[master_of(state, bin.record[n])] += p.V[q] * slope(g, n);
    }
  }
  return worth;
}

// Cut nodes that a fracture and an interface part: the only ones with corners.
bool has_corners(const CutNode& cut) {
  return cut.fracture != 0 && cut.mask != cut.fracture;
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

struct Corner {
  SideWord key = 0;
  double worth = 0.0;
};

bool larger(const Corner& a, const Corner& b) {
  return a.worth > b.worth || (a.worth == b.worth && a.key > b.key);
}

using Corners = std::vector<Corner>;  // of a cut node

// The cut nodes with corners that a leaning fracture makes, and the rock whose particles reach them.
struct LeaningCorners {
  std::vector<char> at;  // of each cut node: whether it is one
  Eigen::AlignedBox2d rock;
};

LeaningCorners leaning_corners(const State& state) {
  const Grid& g = state.grid;
  LeaningCorners leaning{std::vector<char>(state.copies.cut.size(), 0), {}};
  for (int node = 0; node < g.nodes(); ++node) {
    const int c = state.copies.cut_of_node[static_cast<std::size_t>(node)];
    if (c < 0 || !has_corners(state.copies.cut[static_cast<std::size_t>(c)]) || !leans_at(state, node)) continue;
    leaning.at[static_cast<std::size_t>(c)] = 1;
    const int i = g.column(node), j = g.row(node);
    leaning.rock.extend(Vec2{g.x(std::max(i - 2, -1)), g.y(std::max(j - 2, -1))});
    leaning.rock.extend(Vec2{g.x(std::min(i + 2, g.nx + 1)), g.y(std::min(j + 2, g.ny + 1))});
  }
  return leaning;
}

// sum_p V_p |grad N_i| of each corner of each cut node that has some.
std::vector<Corners> corners_of(const Scene& scene, const State& state, const LeaningCorners& leaning) {
  std::vector<Corners> corners(state.copies.cut.size());
  const Particles& p = state.particles;
  const Grid& grid = state.grid;
  for (std::size_t q = 0; q < p.size(); ++q) {
    if (!leaning.rock.contains(Vec2{p.x[q], p.y[q]})) continue;
    const int i = grid.column_at(p.x[q]), j = grid.row_at(p.y[q]);
    if (i < 0 || i > grid.nx || j < 0 || j > grid.ny) continue;
    std::array<int, 9> cut = grid.around(i, j);
    for (int& c : cut) {
      c = state.copies.cut_of_node[static_cast<std::size_t>(c)];
      if (c >= 0 && leaning.at[static_cast<std::size_t>(c)] == 0) c = -1;
    }
    if (std::ranges::count(cut, -1) == 9) continue;
    const Gradients g = gradients_at(scene, grid, i, j, {p.x[q], p.y[q]}, p.half(q));
    for (std::size_t n = 0; n < 9; ++n) {
      if (cut[n] < 0) continue;
      const auto c = static_cast<std::size_t>(cut[n]);
      const SideWord key = state.copies.cut[c].key(p.sides[q]);
      auto at = std::ranges::find(corners[c], key, &Corner::key);
      if (at == corners[c].end()) at = corners[c].insert(at, Corner{key});
      at->worth += p.V[q] * slope(g, n);
    }
  }
  return corners;
}

}  // namespace

void join_corners(const Scene& scene, State& state) {
  auto& cuts = state.copies.cut;
  const LeaningCorners leaning = leaning_corners(state);
  if (leaning.rock.isEmpty()) return;
  const std::vector<Corners> corners = corners_of(scene, state, leaning);
  for (std::size_t c = 0; c < cuts.size(); ++c) {
    const Corners& own = corners[c];
    if (own.size() < 3) continue;
    double all = 0.0;
    for (const Corner& corner : own) all += corner.worth;
    for (const Corner& small : own) {
      if (small.worth >= least_corner * all) continue;
      const Corner* into = nullptr;
      for (const Corner& other : own) {
        const SideWord parted = small.key ^ other.key;
        const bool beside = std::popcount(parted) == 1 && parted != cuts[c].fracture;
        if (beside && larger(other, into == nullptr ? small : *into)) into = &other;
      }
      if (into != nullptr) cuts[c].joined.push_back({small.key, into->key});
    }
  }
}

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
