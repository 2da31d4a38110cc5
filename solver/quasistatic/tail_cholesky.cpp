#include "quasistatic/tail_cholesky.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <utility>

namespace strata {

namespace {

bool factor_in_place(Eigen::Ref<Eigen::MatrixXd> A) {
  return Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>>(A).info() == Eigen::Success;
}

}  // namespace

bool TailCholesky::factorise(const Eigen::MatrixXd& T, const Eigen::VectorXd& scale, std::vector<int> order) {
  order_ = std::move(order);
  L_ = (scale.asDiagonal() * T * scale.asDiagonal())(order_, order_);
  return factor_in_place(L_);
}

Eigen::Index TailCholesky::keeps(const std::vector<int>& now, const std::vector<char>& touched) const {
  const auto ends = [&](int k) {
    return now[static_cast<std::size_t>(k)] < 0 || touched[static_cast<std::size_t>(k)] != 0;
  };
  return std::find_if(order_.begin(), order_.end(), ends) - order_.begin();
}

// Rows behind the first `kept` ones that stay, those of touched unknowns last.
std::vector<Eigen::Index> TailCholesky::rows_behind(Eigen::Index kept, const std::vector<int>& now,
                                                    const std::vector<char>& touched) const {
  std::vector<Eigen::Index> rows;
  for (const bool last : {false, true}) {
    for (Eigen::Index row = kept; row < L_.rows(); ++row) {
      const auto unknown = static_cast<std::size_t>(order_[static_cast<std::size_t>(row)]);
      if (now[unknown] >= 0 && (touched[unknown] != 0) == last) rows.push_back(row);
    }
  }
  return rows;
}

// The order of the new unknowns: of those that stay that of their rows, then new ones.
std::vector<int> TailCholesky::order_after(Eigen::Index kept, const std::vector<Eigen::Index>& stayed,
                                           const std::vector<int>& now, Eigen::Index unknowns) const {
  std::vector<int> order;
  std::vector<char> is_new(static_cast<std::size_t>(unknowns), 1);
  const auto append = [&](Eigen::Index row) {
    order.push_back(now[static_cast<std::size_t>(order_[static_cast<std::size_t>(row)])]);
    is_new[static_cast<std::size_t>(order.back())] = 0;
  };
  for (Eigen::Index row = 0; row < kept; ++row) append(row);
  for (const Eigen::Index row : stayed) append(row);
  for (std::size_t k = 0; k < is_new.size(); ++k) {
    if (is_new[k] != 0) order.push_back(static_cast<int>(k));
  }
  return order;
}

bool TailCholesky::change(const Eigen::MatrixXd& T, const Eigen::VectorXd& scale, const std::vector<int>& now,
                          const std::vector<char>& touched) {
  const Eigen::Index n = T.rows(), kept = keeps(now, touched);
  const std::vector<Eigen::Index> stayed = rows_behind(kept, now, touched);
  order_ = order_after(kept, stayed, now, n);
  const auto known = kept + static_cast<Eigen::Index>(stayed.size()), fresh = n - known, behind = n - kept;
  const auto entry = [&](Eigen::Index row, Eigen::Index column) {
    const int i = order_[static_cast<std::size_t>(row)], j = order_[static_cast<std::size_t>(column)];
    return scale[i] * T(i, j) * scale[j];
  };
  Eigen::MatrixXd L(n, n);
  for (Eigen::Index column = 0; column < kept; ++column) {
    L.col(column).segment(column, kept - column) = L_.col(column).segment(column, kept - column);
    for (Eigen::Index row = kept; row < known; ++row)
      L(row, column) = L_(stayed[static_cast<std::size_t>(row - kept)], column);
    for (Eigen::Index row = known; row < n; ++row) L(row, column) = entry(row, column);
  }
  for (Eigen::Index column = kept; column < n; ++column) {
    for (Eigen::Index row = column; row < n; ++row) L(row, column) = entry(row, column);
  }
  L_ = std::move(L);
  auto tail = L_.bottomRightCorner(behind, behind);
  if (kept > 0 && fresh > 0) {
    const auto leading = L_.topLeftCorner(kept, kept).triangularView<Eigen::Lower>();
    auto added = L_.block(known, 0, fresh, kept);
    leading.transpose().solveInPlace<Eigen::OnTheRight>(added);
  }
  if (kept > 0 && behind > 0) tail.selfadjointView<Eigen::Lower>().rankUpdate(L_.bottomLeftCorner(behind, kept), -1.0);
  return behind == 0 || factor_in_place(tail);
}

Eigen::MatrixXd TailCholesky::solve(const Eigen::MatrixXd& b) const {
  const auto L = L_.triangularView<Eigen::Lower>();
  const auto sorted = [&](Eigen::Index column) {
    Eigen::VectorXd y(L_.rows());
    for (Eigen::Index row = 0; row < y.size(); ++row) y[row] = b(order_[static_cast<std::size_t>(row)], column);
    return y;
  };
  Eigen::MatrixXd x(b.rows(), b.cols());
  const auto put_back = [&](const auto& y, Eigen::Index column) {
    for (Eigen::Index row = 0; row < y.size(); ++row) x(order_[static_cast<std::size_t>(row)], column) = y[row];
  };
  if (b.cols() == 1) {  // Eigen solves for a vector by other kernels than for a matrix of one column, and faster
    Eigen::VectorXd y = sorted(0);
    L.solveInPlace(y);
    L.transpose().solveInPlace(y);
    put_back(y, 0);
    return x;
  }
  Eigen::MatrixXd y(b.rows(), b.cols());
  for (Eigen::Index column = 0; column < b.cols(); ++column) y.col(column) = sorted(column);
  L.solveInPlace(y);
  L.transpose().solveInPlace(y);
  for (Eigen::Index column = 0; column < b.cols(); ++column) put_back(y.col(column), column);
  return x;
}

}  // namespace strata
