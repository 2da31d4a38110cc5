// Sparse Cholesky factor for solves with few loads of which few displacements are asked for.
//
// L L^T = P K P^T. Columns of L with the same rows below them form supernodes, here cut into blocks of up to eight
// columns. A block passes its load on to its parent in the elimination tree, which holds the first row below it, and to
// others further up the same branch (Liu, SIAM J. Matrix Anal. Appl. 11, 1990): L y = P f fills y on the branches from
// the loaded rows to the root alone, and L^T x = y needs, for a few entries of x, no rows but those on their branches.
// Both sums are those of the whole solve less terms that are 0, so they give the same digits.
#pragma once

#include <Eigen/Core>
#include <Eigen/SparseCore>
#include <cstdint>
#include <vector>

namespace strata {

// Entries of a vector, their indices rising.
struct SparseVector {
  std::vector<int> index;
  std::vector<double> value;
};

class TreeFactor {
 public:
  /// Blocks of the factor, rising, with each block its parents up to the root.
  using Branches = std::vector<int>;

  TreeFactor() = default;

  /// Factors a symmetric positive definite matrix of which the lower triangle counts (CHOLMOD, supernodal). Throws
  /// NumericalFailure with `singular` as its text where a pivot is not positive.
  TreeFactor(const Eigen::SparseMatrix<double>& K, const char* singular);

  /// The branches on which the given unknowns lie. Throws nothing.
  Branches branches(const std::vector<int>& unknowns) const;

  /// All blocks.
  const Branches& all() const { return all_; }

  /// The row of an unknown.
  int row(int unknown) const { return place_[static_cast<std::size_t>(unknown)]; }

  /// Puts x = K^-1 f in the place of f, both in rows of the factor: f is 0 off the branches `loaded`, x is good on
  /// `wanted`. Units follow K and f. Throws nothing.
  void solve(const Branches& loaded, const Branches& wanted, Eigen::VectorXd& f) const;

  /// x = K^-1 f by unknowns, whole. Throws nothing.
  Eigen::VectorXd solve(const Eigen::VectorXd& f) const;

  // Up to 16 vectors side by side in rows of the factor, with room for those on some branches; all others are 0.
  class SideBySide {
   public:
    static constexpr std::size_t most = 16;
    using Row = Eigen::Array<double, most, 1>;
    SideBySide(const TreeFactor& factor, Branches branches);
    Row& operator[](int row) { return values_[place_[static_cast<std::size_t>(row)]]; }
    const Branches& branches() const { return branches_; }

   private:
    Branches branches_;
    std::vector<std::uint32_t> place_;  // of each row among the values; 0: the one of all without room
    std::vector<Row> values_;
  };

  /// Puts Y = L^-1 P g in the place of each g, given in rows of the factor; the digits of one do not depend on the
  /// others. Throws nothing.
  void forward(SideBySide& g) const;

  /// One of them on some branches of its own. Throws nothing.
  SparseVector on_branches(const Branches& branches, SideBySide& y, std::size_t which) const;

  int size() const { return static_cast<int>(place_.size()); }

 private:
  static constexpr int width = 8;  // columns of a block: a vector of the processor
  using Eight = Eigen::Array<double, width, 1>;

  // Columns [first, first + columns) and the rows below them.
  struct Block {
    int first = 0, columns = 0;
    int parent = -1;           // -1: a root
    std::size_t rows = 0;      // where its rows below begin in row_
    std::size_t last_row = 0;  // and end
    std::size_t values = 0;    // where its values begin in values_: of its own rows, unit ones to make eight, then of
                               // those below; one Eight a row, a value a column
  };

  void add_block(int first, int columns, const double* values, std::size_t stride, const int* rows, std::size_t count);
  void up(const Block& block, Eigen::VectorXd& y) const;
  template <class Row, class Rows>
  void down(const Block& block, const Row& zero, Rows& y) const;

  std::vector<int> place_;  // row of an unknown
  std::vector<Block> blocks_;
  std::vector<int> block_of_row_;
  std::vector<int> row_;
  std::vector<Eight> values_;
  Branches all_;
};

}  // namespace strata
