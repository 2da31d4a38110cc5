// Stiffness of the rock from its particles, with the same shape functions and records as every other force.
#pragma once

#include <Eigen/SparseCore>
#include <vector>

#include "state/elasticity.hpp"
#include "state/shape_functions.hpp"
#include "state/state.hpp"

namespace strata {

using LocalStiffness = Eigen::Matrix<double, 18, 18>;

/// Adds V B^T C B (N/m per metre of thickness) of one particle of area V (m^2) to K; unknowns (u_x, u_y) of the nine
/// nodes in turn. Throws nothing.
void add_stiffness(const Elasticity& rock, const Gradients& g, double V, LocalStiffness& K);

// The unknown that a record's displacement component is a multiple of: 2 record + component of its master; -1 where
// it is held.
struct Unknown {
  int index = -1;
  double factor = 0.0;
};

inline Unknown unknown_of(const std::vector<Master>& masters, int record, int component) {
  const Master& master = masters[static_cast<std::size_t>(record)];
  const double factor = master.of(component);
  return {factor == 0.0 ? -1 : 2 * master.record + component, factor};
}

/// The lower triangle of K = sum_p V_p B^T C B over the state's bins, with records tied by `masters`; unknowns that
/// nothing touches have 1 on the diagonal. Throws nothing.
Eigen::SparseMatrix<double> assemble_stiffness(const Scene& scene, const Rocks& rocks, const State& state,
                                               const std::vector<Master>& masters);

}  // namespace strata
