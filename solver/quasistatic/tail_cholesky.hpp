// Cholesky factor of a dense symmetric matrix that outlives unknowns which come and go at its end.
#pragma once

#include <Eigen/Core>
#include <vector>

namespace strata {

// L L^T = P diag(s) T diag(s) P^T. Rows of L follow from those above them alone: where the leading rows of T stay what
// they were, so do those of L, and a change of the others costs a factorisation of these, not of the whole.
class TailCholesky {
 public:
  /// Factors T (N/m per metre of thickness), scaled from both sides, with its unknowns in this order; false where it is
  /// not positive definite.
  bool factorise(const Eigen::MatrixXd& T, const Eigen::VectorXd& scale, std::vector<int> order);

  /// Goes over to another matrix. now: what index each unknown has in it, -1 where it has gone. Entries of unknowns
  /// that have stayed with each other are what they were, scale included, but for those of two unknowns that are
  /// `touched`; these go to the end, where they are the least in the way of the next change. False where the new matrix
  /// is not positive definite: nothing is left then.
  bool change(const Eigen::MatrixXd& T, const Eigen::VectorXd& scale, const std::vector<int>& now,
              const std::vector<char>& touched);

  /// Leading rows that change() keeps: those before the first unknown that has gone or is touched. Throws nothing.
  Eigen::Index keeps(const std::vector<int>& now, const std::vector<char>& touched) const;

  /// (diag(s) T diag(s))^-1 b, a right-hand side a column. Throws nothing.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// Unknown of each row of L.
  const std::vector<int>& order() const { return order_; }

 private:
  std::vector<Eigen::Index> rows_behind(Eigen::Index kept, const std::vector<int>& now,
                                        const std::vector<char>& touched) const;
  std::vector<int> order_after(Eigen::Index kept, const std::vector<Eigen::Index>& stayed, const std::vector<int>& now,
                               Eigen::Index unknowns) const;

  std::vector<int> order_;
  Eigen::MatrixXd L_;  // its lower triangle
};

}  // namespace strata
