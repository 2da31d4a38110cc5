// Sparse Cholesky factor for solves with few loads of which few displacements are asked for.
//
// L L^T = P K P^T. Columns of L with the same rows below them form supernodes. A supernode passes its load on to its
// parent in the elimination tree, which holds the first row below it, and to others further up the same branch (Liu,
// SIAM J. Matrix Anal. Appl. 11, 1990): L y = P f fills y on the branches from the loaded rows to the root alone, and
// L^T x = y needs, for a few entries of x, no rows but those on their branches. Both sums are those of the whole solve
// less terms that are 0, so they give the same digits.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <memory>
#include <utility>
#include <vector>

struct cholmod_factor_struct;

namespace strata {

// Indices and values of a vector's entries.
using SparseVector = std::vector<std::pair<int, double>>;

class TreeFactor {
 public:
  /// Supernodes of the factor, rising, with each its parents up to the root.
  using Branches = std::vector<int>;

  // Some vectors in rows of the factor, always so many: the digits of one do not depend on the others.
  static constexpr std::size_t together = 16;
  using SideBySide = Eigen::Matrix<double, Eigen::Dynamic, together, Eigen::RowMajor>;

  TreeFactor() = default;

  /// Factors a symmetric positive definite matrix of which the lower triangle counts (CHOLMOD, supernodal). Throws
  /// NumericalFailure with `singular` as its text where a pivot is not positive.
  TreeFactor(const Eigen::SparseMatrix<double>& K, const char* singular);

  /// The branches on which the given unknowns lie. Throws nothing.
  Branches branches(const std::vector<int>& unknowns) const;

  /// All supernodes.
  const Branches& all() const { return all_; }

  /// The row of an unknown.
  int row(int unknown) const { return place_[static_cast<std::size_t>(unknown)]; }

  /// Puts x = K^-1 f in the place of f, both in rows of the factor: f is 0 off the branches `loaded`, x is good on
  /// `wanted`. Units follow K and f. Throws nothing.
  void solve(const Branches& loaded, const Branches& wanted, Eigen::VectorXd& f) const;

  /// x = K^-1 f by unknowns, whole. Throws nothing.
  Eigen::VectorXd solve(const Eigen::VectorXd& f) const;

  /// Y = L^-1 P g in rows of the factor of up to `together` g, which are given by unknowns: side by side in y, and each
  /// on its own branches. Throws nothing.
  std::vector<SparseVector> forward(const std::vector<SparseVector>& g, SideBySide& y) const;

  int size() const { return static_cast<int>(place_.size()); }

 private:
  struct Supernode;

  Supernode supernode(int s) const;
  void down(int s, Eigen::VectorXd& y) const;
  void down(int s, SideBySide& y) const;
  void up(int s, Eigen::VectorXd& y) const;

  std::shared_ptr<const cholmod_factor_struct> L_;
  std::vector<int> place_;  // row of an unknown
  std::vector<int> supernode_of_row_;
  std::vector<int> parent_;  // of a supernode; -1: a root
  Branches all_;
};

}  // namespace strata
