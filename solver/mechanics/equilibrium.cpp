#include "mechanics/equilibrium.hpp"

#include <Eigen/CholmodSupport>

#include "mechanics/stiffness.hpp"
#include "state/rebuild.hpp"

namespace strata {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

Unknown unknown_of(const State& state, int record, int component) {
  return strata::unknown_of(state.masters, record, component);
}

// Adds the force of a uniform traction t (Pa) on the straight edge from a to b to f; two points a cell.
void load_edge(const Scene& scene, const State& state, const Vec2& a, const Vec2& b, const Vec2& t,
               Eigen::VectorXd& f) {
  const Grid& g = state.grid;
  const int n = static_cast<int>(std::lround(2.0 * (b - a).norm() / g.h));
  for (int k = 0; k < n; ++k) {
    const Vec2 x = a + (b - a) * ((k + 0.5) / n);
    Bin bin;
    bin.i = std::min(g.nearest(x.x()), g.nx), bin.j = std::min(g.nearest(x.y()), g.ny);
    const Gradients weights = gradients_at(scene, g, bin.i, bin.j, x, 1e-6 * g.h);
    for (std::size_t node = 0; node < 9; ++node) {
      const int record = g.node(bin.i + static_cast<int>(node % 3) - 1, bin.j + static_cast<int>(node / 3) - 1);
      for (int component = 0; component < 2; ++component) {
        const Unknown at = unknown_of(state, record, component);
        if (at.index >= 0) f[at.index] += at.factor * weights.N[node] * t[component] * (b - a).norm() / n;
      }
    }
  }
}

// The loads are in balance, so holding as many unknowns as there are rigid motions costs no reaction.
void hold_rigid_motion(const Scene& scene, const State& state, SparseMatrix& K, Eigen::VectorXd& f) {
  std::vector<int> held{2 * state.grid.node(0, 0)};
  if (scene.domain.bottom == Edge::traction) {
    held.push_back(2 * state.grid.node(0, 0) + 1);
    held.push_back(2 * state.grid.node(state.grid.nx, 0) + 1);
  }
  for (const int k : held) {
    K.prune([k](Eigen::Index row, Eigen::Index column, double) { return (row != k && column != k) || row == column; });
    f[k] = 0.0;
  }
}

}  // namespace

void load_in_situ(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  Scene loaded = scene;
  loaded.domain.sides = Edge::traction;
  loaded.domain.top = Edge::traction;
  rebuild_copies(loaded, state);
  SparseMatrix K = assemble_stiffness(loaded, rocks, state, state.masters);
  Eigen::VectorXd f = Eigen::VectorXd::Zero(K.rows());
  const double W = scene.domain.width_m, H = scene.domain.height_m;
  load_edge(loaded, state, {0.0, 0.0}, {0.0, H}, {scene.in_situ.horizontal_Pa, 0.0}, f);
  load_edge(loaded, state, {W, 0.0}, {W, H}, {-scene.in_situ.horizontal_Pa, 0.0}, f);
  load_edge(loaded, state, {0.0, H}, {W, H}, {0.0, -scene.in_situ.vertical_Pa}, f);
  if (scene.domain.bottom == Edge::traction)
    load_edge(loaded, state, {0.0, 0.0}, {W, 0.0}, {0.0, scene.in_situ.vertical_Pa}, f);
  hold_rigid_motion(loaded, state, K, f);
  const Eigen::CholmodSupernodalLLT<SparseMatrix> factor(K);
  if (factor.info() != Eigen::Success)
    throw NumericalFailure("the loaded in-situ state cannot be found: the stiffness of the bonded block is singular");
  const Eigen::VectorXd u = factor.solve(f);
  Particles& p = state.particles;
  for (const Bin& bin : state.bins) {
    for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last); ++q) {
      const Gradients g = gradients_at(loaded, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half[q]);
      double e[2][2] = {};
      for (std::size_t n = 0; n < 9; ++n) {
        for (int component = 0; component < 2; ++component) {
          const Unknown at = unknown_of(state, bin.record[n], component);
          const double value = at.index < 0 ? 0.0 : at.factor * u[at.index];
          e[component][0] += value * g.N_x[n], e[component][1] += value * g.N_y[n];
        }
      }
      p.in_situ[q] = stress_of(rocks[p.rock[q]], e[0][0], e[0][1], e[1][0], e[1][1]);
    }
  }
}

}  // namespace strata
