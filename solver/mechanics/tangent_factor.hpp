// The tangent of a state's contact, S - sum_s A_s D_s^T (dr/dw)_s D_s, factored; and changed where few places change.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <utility>
#include <vector>

#include "mechanics/surface_law.hpp"
#include "state/types.hpp"

namespace strata {

// A row of a jump in terms of the jump unknowns: their indices and weights.
using SparseRow = std::vector<std::pair<int, double>>;

// A split place of a surface, or the spring behind a tip, in terms of the jump unknowns: its jump is D j - bonded.
struct ContactPlace {
  std::size_t surface = 0, point = 0;  // of the state; a tip's spring has `tie` >= 0 instead
  int tie = -1;
  InterfaceLaw law;
  double k = 0.0;  // stiffness of closed contact (Pa/m)
  double A = 0.0;  // length (m)
  Vec2 n = Vec2::Zero();
  Vec2 in_situ = Vec2::Zero();              // Pa
  Vec2 bonded = Vec2::Zero();               // jump when it split (m)
  double bound = -1.0;                      // friction's bound where it is held fixed (Pa)
  double w_t_start = 0.0, r_t_start = 0.0;  // what friction remembers
  std::array<SparseRow, 2> D;               // rows of the jump's x and y
};

using Pieces = std::vector<LawAnswer::Piece>;

/// dr/dw of a place's piece in x and y (Pa/m). Throws nothing.
Eigen::Matrix2d tangent_matrix(const ContactPlace& place, const LawAnswer& r);

/// T = S - sum A D^T (dr/dw) D (N/m per metre of thickness). Throws nothing.
Eigen::MatrixXd tangent(const Eigen::MatrixXd& S, const std::vector<ContactPlace>& places,
                        const std::vector<LawAnswer>& answers);

// A tangent T_0 that was factored, and what of it has changed since. With U = [D_s^T] of the places whose dr/dw is
// another now and M = blocks of their -A change(dr/dw), T = T_0 + U M U^T, and (Woodbury 1950)
//   T^-1 b = y - Z (I + M U^T Z)^-1 M U^T y,  y = T_0^-1 b,  Z = T_0^-1 U:
// two solves a changed place instead of a factorisation, and none for a place that has changed before.
class TangentFactor {
 public:
  Pieces pieces;  // of T; none where it is not to be used again

  /// Factors T as the T_0 of what follows; false where it is singular. stiffened: T is not quite that of `places` and
  /// `answers`, and nothing may follow it.
  bool factorise(const Eigen::MatrixXd& T, const std::vector<ContactPlace>& places,
                 const std::vector<LawAnswer>& answers, bool stiffened = false);

  /// Goes over to the tangent of other answers of the same places; false where it is not sure to keep the digits (too
  /// many places have changed, the result is nearly singular) or nothing was factored: then it has to be factorised.
  bool follow(const std::vector<ContactPlace>& places, const std::vector<LawAnswer>& answers);

  /// T^-1 b (m), a right-hand side (N/m) a column.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// True where T is not T_0.
  bool changed() const { return !changed_.empty(); }

  /// What scales T_0 to a unit diagonal from both sides.
  const Eigen::VectorXd& scale() const { return scale_; }

 private:
  Eigen::MatrixXd solve_first(const Eigen::MatrixXd& b) const;
  std::vector<std::size_t> places_that_differ(const std::vector<Eigen::Matrix2d>& R) const;
  void solve_for(const std::vector<ContactPlace>& places, const std::vector<std::size_t>& fresh);
  Eigen::MatrixXd change_of(const Eigen::MatrixXd& y) const;

  bool symmetric_ = true, stiffened_ = false;
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> llt_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  std::vector<Eigen::Matrix2d> R_;  // A dr/dw of each place in T_0 (N/m)
  std::vector<int> known_;          // where a place's two columns of Z stand in Z_all_; -1: not computed
  Eigen::MatrixXd Z_all_;
  std::vector<std::size_t> changed_;
  std::vector<SparseRow> U_;                    // columns of U, of changed places alone
  Eigen::MatrixXd Z_;                           // and of Z
  std::vector<Eigen::Matrix2d> M_;              // blocks
  Eigen::PartialPivLU<Eigen::MatrixXd> small_;  // I + M U^T Z
};

}  // namespace strata
