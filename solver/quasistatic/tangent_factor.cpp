#include "quasistatic/tangent_factor.hpp"

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

// Where the matrix of the changes is no worse conditioned than this (an estimate in the 1-norm), none of them has let
// go what the first tangent held: contact that opens or slides leaves 1e-4 of its stiffness, some of them beside each
// other 1e-6.
constexpr double sound = 1e-7;

// Rows of reactions that changed over unknowns from which on a factorisation takes no longer: those to solve for, and
// all.
constexpr double most_fresh = 0.2;
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

}  // namespace

Eigen::Matrix2d tangent_matrix(const ContactPlace& place, const LawAnswer& r) {
  const Vec2 &n = place.n, t = place.t();
  return r.dn_dn * n * n.transpose() + r.dt_dn * t * n.transpose() + r.dt_dt * t * t.transpose();
}

Eigen::MatrixXd tangent(const Eigen::MatrixXd& S, const Places& places, const Answers& answers) {
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

// By the factor of T_0, in unknowns scaled to a unit diagonal.
template <class B>
B TangentFactor::solve_scaled(const B& b) const {
  return symmetric_ ? B(cholesky_.solve(b)) : B(lu_.solve(b));
}

bool TangentFactor::factorise(const Eigen::MatrixXd& T, const Places& places, const Answers& answers, bool stiffened) {
  symmetric_ = std::none_of(answers.begin(), answers.end(), [](const LawAnswer& r) { return r.dt_dn != 0.0; });
  first_ = stiffened ? Answers{} : answers;
  known_.assign(places.size(), {-1, -1});
  Z_all_.resize(T.rows(), 0);
  V_.clear();
  scale_ = T.diagonal().cwiseAbs().cwiseMax(1e-300).cwiseSqrt().cwiseInverse();
  if (T.rows() == 0) return true;  // a fracture so short that it splits no node
  const Eigen::MatrixXd scaled = scale_.asDiagonal() * T * scale_.asDiagonal();
  if (symmetric_ && cholesky_.compute(scaled).info() != Eigen::Success) return false;
  if (!symmetric_) lu_.compute(scaled);
  return weakest([&](const Eigen::VectorXd& x) { return solve_scaled(x); }, scale_.size()) > smallest_eigenvalue;
}

// The rows of reactions that are others now than in T_0.
std::vector<TangentFactor::Change> TangentFactor::changes(const Places& places, const Answers& answers) const {
  std::vector<Change> changes;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const LawAnswer &before = first_[k], &now = answers[k];
    const Vec2 n = places[k].n, t = places[k].t();
    const double A = places[k].A, n_n = A * (before.dn_dn - now.dn_dn), t_n = A * (before.dt_dn - now.dt_dn),
                 t_t = A * (before.dt_dt - now.dt_dt);
    if (n_n != 0.0) changes.push_back({k, 0, n, n_n * n});
    if (t_n != 0.0 || t_t != 0.0) changes.push_back({k, 1, t, t_n * n + t_t * t});
  }
  return changes;
}

// Adds the columns of Z that are not known yet.
void TangentFactor::solve_for(const Places& places, const std::vector<Change>& fresh) {
  if (fresh.empty()) return;
  Eigen::MatrixXd U = Eigen::MatrixXd::Zero(scale_.size(), static_cast<Eigen::Index>(fresh.size()));
  const Eigen::Index before = Z_all_.cols();
  for (std::size_t f = 0; f < fresh.size(); ++f) {
    const Change& change = fresh[f];
    const auto column = static_cast<Eigen::Index>(f);
    known_[change.place][change.component] = static_cast<int>(before + column);
    for (std::size_t c = 0; c < 2; ++c) {
      for (const auto& [row, value] : places[change.place].D[c])
        U(row, column) += change.u[static_cast<Eigen::Index>(c)] * value;
    }
  }
  Z_all_.conservativeResize(Eigen::NoChange, before + U.cols());
  Z_all_.rightCols(U.cols()) = solve_first(U);
}

// V^T y.
Eigen::MatrixXd TangentFactor::change_of(const Eigen::MatrixXd& y) const {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(V_.size()), y.cols());
  for (Eigen::Index column = 0; column < y.cols(); ++column) {
    for (std::size_t f = 0; f < V_.size(); ++f) {
      for (const auto& [row, value] : V_[f]) out(static_cast<Eigen::Index>(f), column) += value * y(row, column);
    }
  }
  return out;
}

bool TangentFactor::follow(const Places& places, const Answers& answers) {
  if (scale_.size() == 0 || first_.size() != places.size()) return false;
  const std::vector<Change> differ = changes(places, answers);
  std::vector<Change> fresh;
  for (const Change& change : differ) {
    if (known_[change.place][change.component] < 0) fresh.push_back(change);
  }
  const auto share = [&](const auto& of) {
    return static_cast<double>(of.size()) / static_cast<double>(scale_.size());
  };
  if (share(differ) > most_changed || share(fresh) > most_fresh) return false;
  solve_for(places, fresh);
  V_.clear();
  if (differ.empty()) return true;
  const auto columns = static_cast<Eigen::Index>(differ.size());
  Z_.resize(scale_.size(), columns);
  for (Eigen::Index f = 0; f < columns; ++f) {
    const Change& change = differ[static_cast<std::size_t>(f)];
    SparseRow& row = V_.emplace_back();
    for (std::size_t c = 0; c < 2; ++c) {
      for (const auto& [index, value] : places[change.place].D[c])
        row.emplace_back(index, change.v[static_cast<Eigen::Index>(c)] * value);
    }
    Z_.col(f) = Z_all_.col(known_[change.place][change.component]);
  }
  small_.compute(Eigen::MatrixXd::Identity(columns, columns) + change_of(Z_));
  if (small_.rcond() > sound) return true;
  const auto solve_scaled = [&](const Eigen::VectorXd& x) {
    return Eigen::VectorXd(solve(x.cwiseQuotient(scale_)).cwiseQuotient(scale_));
  };
  return weakest(solve_scaled, scale_.size()) > smallest_to_follow;
}

Eigen::MatrixXd TangentFactor::solve_first(const Eigen::MatrixXd& b) const {
  if (b.rows() == 0) return b;
  if (b.cols() == 1)  // Eigen solves for a vector by other kernels than for a matrix of one column, and faster
    return scale_.cwiseProduct(solve_scaled(Eigen::VectorXd(scale_.cwiseProduct(b.col(0)))));
  return scale_.asDiagonal() * solve_scaled(Eigen::MatrixXd(scale_.asDiagonal() * b));
}

Eigen::MatrixXd TangentFactor::solve(const Eigen::MatrixXd& b) const {
  Eigen::MatrixXd y = solve_first(b);
  if (changed()) y -= Z_ * small_.solve(change_of(y));
  return y;
}

}  // namespace strata
