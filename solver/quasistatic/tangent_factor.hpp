// The tangent of a state's contact, S - sum_s A_s D_s^T (dr/dw)_s D_s, factored; and changed where few places change.
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <utility>
#include <vector>

#include "interfaces/surface_law.hpp"
#include "quasistatic/tree_factor.hpp"
#include "state/types.hpp"

namespace strata {

using SparseRow = SparseVector;  // a row of a jump in terms of the jump unknowns

// A split place of a surface, or the spring behind a tip, in terms of the jump unknowns: its jump is D j - bonded.
struct ContactPlace {
  std::size_t surface = 0, point = 0;  // of the state; a tip's spring has `tie` >= 0 instead
  int tie = -1;
  InterfaceLaw law;
  double k = 0.0;  // stiffness of closed contact (Pa/m)
  double A = 0.0;  // length (m)
  Vec2 n = Vec2::Zero();
  Vec2 in_situ = Vec2::Zero();  // Pa
  Vec2 bonded = Vec2::Zero();   // jump when it split (m)
  double bound = -1.0;          // friction's bound where it is held fixed (Pa)
  LawStart start;               // of the last equilibrium
  std::array<SparseRow, 2> D;   // rows of the jump's x and y

  Vec2 t() const { return tangent_of(n); }
  Vec2 along(double normal, double tangential) const { return normal * n + tangential * t(); }
};

using Places = std::vector<ContactPlace>;
using Answers = std::vector<LawAnswer>;  // one a place
using Pieces = std::vector<LawAnswer::Piece>;

/// dr/dw of a place's piece in x and y (Pa/m). Throws nothing.
Eigen::Matrix2d tangent_matrix(const ContactPlace& place, const LawAnswer& r);

/// T = S - sum A D^T (dr/dw) D (N/m per metre of thickness). Throws nothing.
Eigen::MatrixXd tangent(const Eigen::MatrixXd& S, const Places& places, const Answers& answers);

// A tangent T_0 that was factored, and what of it has changed since. A place whose law is on another piece changes the
// derivative of its normal reaction, or of its tangential one, or both: with a column u = D^T n or D^T t and a row
// v^T = -A change(dr_n/dw or dr_t/dw) D for each of them, T = T_0 + U V^T and (Woodbury 1950)
//   T^-1 b = y - Z (I + V^T Z)^-1 V^T y,  y = T_0^-1 b,  Z = T_0^-1 U:
// a solve for each instead of a factorisation, and none for what has changed before: without this, runs with soft
// interfaces take half as long again.
class TangentFactor {
 public:
  Pieces pieces;  // of T; none where it is not to be used again

  /// Factors T as the T_0 of what follows; false where it is singular. stiffened: T is not quite that of `places` and
  /// `answers`, and nothing may follow it.
  bool factorise(const Eigen::MatrixXd& T, const Places& places, const Answers& answers, bool stiffened = false);

  /// Goes over to the tangent of other answers of the same places; false where it is not sure to keep the digits (too
  /// many places have changed, the result is nearly singular) or nothing was factored: then it has to be factorised.
  bool follow(const Places& places, const Answers& answers);

  /// Whether a tangent with so many unknowns is factored.
  bool holds(Eigen::Index unknowns) const { return scale_.size() == unknowns; }

  /// T^-1 b (m), a right-hand side (N/m) a column.
  Eigen::MatrixXd solve(const Eigen::MatrixXd& b) const;

  /// True where T is not T_0.
  bool changed() const { return !V_.empty(); }

  /// What scales T_0 to a unit diagonal from both sides.
  const Eigen::VectorXd& scale() const { return scale_; }

 private:
  // A row of a place's reaction that changed.
  struct Change {
    std::size_t place = 0;
    std::size_t component = 0;  // 0: the normal one, 1: the tangential one
    Vec2 u = Vec2::Zero();      // its direction
    Vec2 v = Vec2::Zero();      // -A times the change of its derivative (N/m)
  };

  template <class B>
  B solve_scaled(const B& b) const;
  Eigen::MatrixXd solve_first(const Eigen::MatrixXd& b) const;
  std::vector<Change> changes(const Places& places, const Answers& answers) const;
  void solve_for(const Places& places, const std::vector<Change>& fresh);
  Eigen::MatrixXd change_of(const Eigen::MatrixXd& y) const;

  bool symmetric_ = true;
  Eigen::VectorXd scale_;
  Eigen::LLT<Eigen::MatrixXd> cholesky_;
  Eigen::PartialPivLU<Eigen::MatrixXd> lu_;
  Answers first_;                          // answers of the places in T_0; none where nothing may follow it
  std::vector<std::array<int, 2>> known_;  // where a place's columns of Z stand in Z_all_; -1: not computed
  Eigen::MatrixXd Z_all_;
  std::vector<SparseRow> V_;                    // columns of V
  Eigen::MatrixXd Z_;                           // and the columns of Z of these
  Eigen::PartialPivLU<Eigen::MatrixXd> small_;  // I + V^T Z
};

}  // namespace strata
