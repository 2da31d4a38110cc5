#include "mechanics/tangent_factor.hpp"

#include <algorithm>
#include <cmath>

namespace strata {

namespace {

// What stands still: the tangent scaled to a unit diagonal has no eigenvalue below this where nothing moves freely.
// Round-off leaves some 1e-15 of a free motion; a soft interface of 1e3 Pa/m, the softest offered for, some 1e-8.
// (Pivots do not tell them apart: the last one is the eigenvalue over the square of its unknown's share in the motion.)
constexpr double smallest_eigenvalue = 1e-12;

// A tangent that has followed changes has lost digits: what is as weak as this is factorised to be sure of it.
constexpr double smallest_to_follow = 1e-9;

// Columns of changed places over unknowns from which on a factorisation takes no longer: those to solve for, and all.
constexpr double most_fresh = 0.15;
constexpr double most_changed = 0.35;

// The smallest eigenvalue of a scaled tangent in size, by two inverse iterations.
template <class Solve>
double weakest(Solve solve, Eigen::Index n) {
  Eigen::VectorXd x(n);
  for (Eigen::Index k = 0; k < n; ++k) x[k] = std::sin(1.0 + static_cast<double>(k));
  double eigenvalue = 0.0;
  for (int iteration = 0; iteration < 2; ++iteration) {
    x /= x.norm();
    x = solve(x);
    eigenvalue = x.allFinite() ? 1.0 / x.norm() : 0.0;
  }
  return eigenvalue;
}

std::vector<Eigen::Matrix2d> reaction_tangents(const std::vector<ContactPlace>& places,
                                               const std::vector<LawAnswer>& answers) {
  std::vector<Eigen::Matrix2d> R;
  for (std::size_t k = 0; k < places.size(); ++k) R.push_back(places[k].A * tangent_matrix(places[k], answers[k]));
  return R;
}

}  // namespace

Eigen::Matrix2d tangent_matrix(const ContactPlace& place, const LawAnswer& r) {
  const Vec2 t = tangent_of(place.n);
  return r.dn_dn * place.n * place.n.transpose() + r.dt_dn * t * place.n.transpose() + r.dt_dt * t * t.transpose();
}

Eigen::MatrixXd tangent(const Eigen::MatrixXd& S, const std::vector<ContactPlace>& places,
                        const std::vector<LawAnswer>& answers) {
  Eigen::MatrixXd T = S;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    const Eigen::Matrix2d R = place.A * tangent_matrix(place, answers[k]);
    for (Eigen::Index a = 0; a < 2; ++a) {
      for (Eigen::Index b = 0; b < 2; ++b) {
        if (R(a, b) == 0.0) continue;
        for (const auto& [row, w_row] : place.D[static_cast<std::size_t>(a)]) {
          for (const auto& [column, w_column] : place.D[static_cast<std::size_t>(b)])
            T(row, column) -= R(a, b) * w_row * w_column;
        }
      }
    }
  }
  return T;
}

bool TangentFactor::factorise(const Eigen::MatrixXd& T, const std::vector<ContactPlace>& places,
                              const std::vector<LawAnswer>& answers, bool stiffened) {
  stiffened_ = stiffened;
  symmetric_ = std::none_of(answers.begin(), answers.end(), [](const LawAnswer& r) { return r.dt_dn != 0.0; });
  R_ = reaction_tangents(places, answers);
  known_.assign(places.size(), -1);
  Z_all_.resize(T.rows(), 0);
  changed_.clear();
  scale_.resize(0);
  if (T.rows() == 0) return true;  // a fracture so short that it splits no node
  scale_ = T.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  const Eigen::MatrixXd scaled = scale_.asDiagonal() * T * scale_.asDiagonal();
  if (symmetric_) {
    llt_.compute(scaled);
    return llt_.info() == Eigen::Success &&
           weakest([&](const auto& x) { return Eigen::VectorXd(llt_.solve(x)); }, T.rows()) > smallest_eigenvalue;
  }
  lu_.compute(scaled);
  return weakest([&](const auto& x) { return Eigen::VectorXd(lu_.solve(x)); }, T.rows()) > smallest_eigenvalue;
}

std::vector<std::size_t> TangentFactor::places_that_differ(const std::vector<Eigen::Matrix2d>& R) const {
  std::vector<std::size_t> differ;
  for (std::size_t k = 0; k < R.size(); ++k) {
    if (R[k] != R_[k]) differ.push_back(k);
  }
  return differ;
}

// Adds the columns of Z of places that do not have them yet.
void TangentFactor::solve_for(const std::vector<ContactPlace>& places, const std::vector<std::size_t>& fresh) {
  if (fresh.empty()) return;
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(scale_.size(), 2 * static_cast<Eigen::Index>(fresh.size()));
  const Eigen::Index before = Z_all_.cols();
  for (std::size_t f = 0; f < fresh.size(); ++f) {
    known_[fresh[f]] = static_cast<int>(before + 2 * static_cast<Eigen::Index>(f));
    for (std::size_t c = 0; c < 2; ++c) {
      for (const auto& [row, value] : places[fresh[f]].D[c]) U(row, static_cast<Eigen::Index>(2 * f + c)) += value;
    }
  }
  Z_all_.conservativeResize(Eigen::NoChange, before + U.cols());
  Z_all_.rightCols(U.cols()) = solve_first(U);
}

// M U^T y.
Eigen::MatrixXd TangentFactor::change_of(const Eigen::MatrixXd& y) const {
  Eigen::MatrixXd out(static_cast<Eigen::Index>(U_.size()), y.cols());
  for (Eigen::Index column = 0; column < y.cols(); ++column) {
    for (std::size_t f = 0; f < M_.size(); ++f) {
      Vec2 jump = Vec2::Zero();
      for (std::size_t c = 0; c < 2; ++c) {
        for (const auto& [row, value] : U_[2 * f + c]) jump[static_cast<Eigen::Index>(c)] += value * y(row, column);
      }
      out.col(column).segment<2>(2 * static_cast<Eigen::Index>(f)) = M_[f] * jump;
    }
  }
  return out;
}

bool TangentFactor::follow(const std::vector<ContactPlace>& places, const std::vector<LawAnswer>& answers) {
  if (stiffened_ || scale_.size() == 0 || R_.size() != places.size()) return false;
  const std::vector<Eigen::Matrix2d> R = reaction_tangents(places, answers);
  std::vector<std::size_t> differ = places_that_differ(R);
  std::vector<std::size_t> fresh;
  for (const std::size_t k : differ) {
    if (known_[k] < 0) fresh.push_back(k);
  }
  const auto share = [&](const auto& of) {
    return 2.0 * static_cast<double>(of.size()) / static_cast<double>(scale_.size());
  };
  if (share(differ) > most_changed || share(fresh) > most_fresh) return false;
  solve_for(places, fresh);
  changed_ = std::move(differ);
  if (changed_.empty()) return true;
  const auto columns = 2 * static_cast<Eigen::Index>(changed_.size());
  U_.clear();
  Z_.resize(scale_.size(), columns);
  M_.clear();
  for (std::size_t f = 0; f < changed_.size(); ++f) {
    const std::size_t k = changed_[f];
    U_.insert(U_.end(), places[k].D.begin(), places[k].D.end());
    Z_.middleCols(2 * static_cast<Eigen::Index>(f), 2) = Z_all_.middleCols(known_[k], 2);
    M_.push_back(R_[k] - R[k]);
  }
  small_.compute(Eigen::MatrixXd::Identity(columns, columns) + change_of(Z_));
  const auto solve_scaled = [&](const Eigen::VectorXd& x) {
    return Eigen::VectorXd(solve(x.cwiseQuotient(scale_)).cwiseQuotient(scale_));
  };
  return weakest(solve_scaled, scale_.size()) > smallest_to_follow;
}

Eigen::MatrixXd TangentFactor::solve_first(const Eigen::MatrixXd& b) const {
  if (b.rows() == 0) return b;
  if (b.cols() == 1) {  // Eigen solves for a vector by other kernels than for a matrix of one column, and faster
    const Eigen::VectorXd one = scale_.cwiseProduct(b.col(0));
    const Eigen::VectorXd x = symmetric_ ? Eigen::VectorXd(llt_.solve(one)) : Eigen::VectorXd(lu_.solve(one));
    return scale_.cwiseProduct(x);
  }
  const Eigen::MatrixXd scaled = scale_.asDiagonal() * b;
  if (symmetric_) return scale_.asDiagonal() * llt_.solve(scaled);
  return scale_.asDiagonal() * lu_.solve(scaled);
}

Eigen::MatrixXd TangentFactor::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd y = solve_first(b);
  if (!changed_.empty()) y -= Z_ * small_.solve(change_of(y));
  return y;
}

}  // namespace strata
