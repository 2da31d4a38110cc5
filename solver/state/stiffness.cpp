#include "state/stiffness.hpp"

#include "state/particle_loop.hpp"

namespace strata {

void add_stiffness(const Elasticity& rock, const Gradients& g, double V, LocalStiffness& K) {
  // Rows of V C B, with engineering shear: stress times area for each unknown.
  Eigen::Matrix<double, 18, 1> xx, yy, xy;
  for (int n = 0; n < 9; ++n) {
    const auto k = static_cast<std::size_t>(n);
    const double V_x = V * g.N_x[k], V_y = V * g.N_y[k];
    xx[2 * n] = (rock.lambda + 2.0 * rock.mu) * V_x, xx[2 * n + 1] = rock.lambda * V_y;
    yy[2 * n] = rock.lambda * V_x, yy[2 * n + 1] = (rock.lambda + 2.0 * rock.mu) * V_y;
    xy[2 * n] = rock.mu * V_y, xy[2 * n + 1] = rock.mu * V_x;
  }
  for (int n = 0; n < 9; ++n) {
    const auto k = static_cast<std::size_t>(n);
    K.col(2 * n) += g.N_x[k] * xx + g.N_y[k] * xy;
    K.col(2 * n + 1) += g.N_y[k] * yy + g.N_x[k] * xy;
  }
}

Eigen::SparseMatrix<double> assemble_stiffness(const Scene& scene, const Rocks& rocks, const State& state,
                                               const std::vector<Master>& masters) {
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(state.bins.size() * 171 + 2 * masters.size());
  const Particles& p = state.particles;
  std::vector<char> used(2 * masters.size(), 0);
  for (const Bin& bin : state.bins) {
    LocalStiffness K = LocalStiffness::Zero();
    for (const std::size_t q : bin) {
      const Gradients g = gradients_at(scene, state, bin, q);
      add_stiffness(rocks[p.rock[q]], g, p.V[q], K);
    }
    for (int r = 0; r < 18; ++r) {
      const Unknown row = unknown_of(masters, bin.record[static_cast<std::size_t>(r / 2)], r % 2);
      if (row.index < 0) continue;
      for (int c = 0; c < 18; ++c) {
        const Unknown column = unknown_of(masters, bin.record[static_cast<std::size_t>(c / 2)], c % 2);
        if (column.index >= 0 && column.index <= row.index && K(r, c) != 0.0)
          entries.emplace_back(row.index, column.index, row.factor * column.factor * K(r, c));
      }
      if (K(r, r) != 0.0) used[static_cast<std::size_t>(row.index)] = 1;
    }
  }
  for (std::size_t k = 0; k < used.size(); ++k) {
    if (used[k] == 0) entries.emplace_back(static_cast<int>(k), static_cast<int>(k), 1.0);  // no stiffness, no load
  }
  const auto n = static_cast<int>(used.size());
  Eigen::SparseMatrix<double> K(n, n);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

}  // namespace strata
