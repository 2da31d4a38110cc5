#include "mechanics/equilibrium.hpp"

#include <Eigen/CholmodSupport>

#include "state/rebuild.hpp"
#include "state/shape_functions.hpp"

namespace strata {

namespace {

using SparseMatrix = Eigen::SparseMatrix<double>;

struct Gradients {
  std::array<double, 9> N{}, N_x{}, N_y{};
};

Gradients gradients_at(const Scene& scene, const Grid& g, const Bin& bin, const Vec2& x, double half) {
  return with_shape(scene.numerics.shape, [&](auto shape) {
    const Weights X = shape.at(x.x() / g.h - bin.i, half / g.h), Y = shape.at(x.y() / g.h - bin.j, half / g.h);
    Gradients out;
    for (std::size_t n = 0; n < 9; ++n) {
      out.N[n] = X.N[n % 3] * Y.N[n / 3];
      out.N_x[n] = X.dN[n % 3] * Y.N[n / 3] / g.h;
      out.N_y[n] = X.N[n % 3] * Y.dN[n / 3] / g.h;
    }
    return out;
  });
}

using LocalStiffness = Eigen::Matrix<double, 18, 18>;

// V B^T C B of one particle, unknowns (u_x, u_y) of the nine nodes in turn.
void add_stiffness(const Elasticity& rock, const Gradients& g, double V, LocalStiffness& K) {
  Eigen::Matrix<double, 3, 18> B = Eigen::Matrix<double, 3, 18>::Zero();
  for (int n = 0; n < 9; ++n) {
    const auto k = static_cast<std::size_t>(n);
    B(0, 2 * n) = g.N_x[k], B(1, 2 * n + 1) = g.N_y[k];
    B(2, 2 * n) = g.N_y[k], B(2, 2 * n + 1) = g.N_x[k];  // engineering shear
  }
  Eigen::Matrix3d C;
  C << rock.lambda + 2.0 * rock.mu, rock.lambda, 0.0, rock.lambda, rock.lambda + 2.0 * rock.mu, 0.0, 0.0, 0.0, rock.mu;
  K += V * B.transpose() * C * B;
}

// Unknown of a record's component and the factor that ties it; -1 where it is held.
struct Unknown {
  int index = -1;
  double factor = 0.0;
};

Unknown unknown_of(const State& state, int record, int component) {
  const Master& master = state.masters[static_cast<std::size_t>(record)];
  const double factor = component == 0 ? master.x : master.y;
  return {factor == 0.0 ? -1 : 2 * master.record + component, factor};
}

SparseMatrix assemble(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(state.bins.size() * 324);
  const Particles& p = state.particles;
  std::vector<char> used(2 * state.masters.size(), 0);
  for (const Bin& bin : state.bins) {
    LocalStiffness K = LocalStiffness::Zero();
    for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last); ++q) {
      add_stiffness(rocks[p.rock[q]], gradients_at(scene, state.grid, bin, {p.x[q], p.y[q]}, p.half[q]), p.V[q], K);
    }
    for (int r = 0; r < 18; ++r) {
      const Unknown row = unknown_of(state, bin.record[static_cast<std::size_t>(r / 2)], r % 2);
      if (row.index < 0) continue;
      for (int c = 0; c < 18; ++c) {
        const Unknown column = unknown_of(state, bin.record[static_cast<std::size_t>(c / 2)], c % 2);
        if (column.index >= 0 && K(r, c) != 0.0)
          entries.emplace_back(row.index, column.index, row.factor * column.factor * K(r, c));
      }
      if (K(r, r) != 0.0) used[static_cast<std::size_t>(row.index)] = 1;
    }
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (used[k] == 0) entries.emplace_back(static_cast<int>(k), static_cast<int>(k), 1.0);  // no stiffness, no load
  }
  const auto n = static_cast<int>(used.size());
  SparseMatrix K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
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
    const Gradients weights = gradients_at(scene, g, bin, x, 1e-6 * g.h);
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
  SparseMatrix K = assemble(loaded, rocks, state);
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
      const Gradients g = gradients_at(loaded, state.grid, bin, {p.x[q], p.y[q]}, p.half[q]);
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
