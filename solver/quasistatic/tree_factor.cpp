#include "quasistatic/tree_factor.hpp"

#include <cholmod.h>
#include <omp.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <new>
#include <numeric>
#include <span>

#include "state/types.hpp"

namespace strata {
namespace {

// CHOLMOD brings threads of its own, which wait for each other at every supernode however many the run was given.
class OneThread {
 public:
  OneThread() : levels_(omp_get_max_active_levels()) { omp_set_max_active_levels(0); }
  ~OneThread() { omp_set_max_active_levels(levels_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int levels_;
};

void free_factor(cholmod_factor* L) {
  cholmod_common common{};
  cholmod_start(&common);
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
}

}  // namespace

// Columns [first, first + own.cols()) of L: their square on the diagonal, of which the lower triangle counts, and what
// is in the rows below.
struct TreeFactor::Supernode {
  using Columns = Eigen::Map<const Eigen::MatrixXd, Eigen::Unaligned, Eigen::OuterStride<>>;
  int first;
  Columns own, below;
  std::span<const int> rows;  // of `below`
};

TreeFactor::Supernode TreeFactor::supernode(int s) const {
  const auto *super = static_cast<const int*>(L_->super) + s, *rows_at = static_cast<const int*>(L_->pi) + s;
  const int columns = super[1] - super[0], rows = rows_at[1] - rows_at[0];
  const auto* values = static_cast<const double*>(L_->x) + static_cast<const int*>(L_->px)[s];
  return {super[0],
          {values, columns, columns, Eigen::OuterStride<>(rows)},
          {values + columns, rows - columns, columns, Eigen::OuterStride<>(rows)},
          {static_cast<const int*>(L_->s) + rows_at[0] + columns, static_cast<std::size_t>(rows - columns)}};
}

TreeFactor::TreeFactor(const Eigen::SparseMatrix<double>& K, const char* singular) {
  const OneThread guard;
  cholmod_common common{};
  cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse view = Eigen::viewAsCholmod(K.selfadjointView<Eigen::Lower>());
  const std::shared_ptr<cholmod_factor> L(cholmod_analyze(&view, &common), free_factor);
  cholmod_factorize(&view, L.get(), &common);
  const int status = common.status;
  cholmod_finish(&common);
  if (status == CHOLMOD_OUT_OF_MEMORY || status == CHOLMOD_TOO_LARGE) throw std::bad_alloc();
  if (status != CHOLMOD_OK) throw NumericalFailure(singular);
  L_ = L;
  place_.resize(L->n), supernode_of_row_.resize(L->n), all_.resize(L->nsuper);
  for (std::size_t k = 0; k < L->n; ++k)
    place_[static_cast<std::size_t>(static_cast<const int*>(L->Perm)[k])] = static_cast<int>(k);
  std::iota(all_.begin(), all_.end(), 0);
  for (const int s : all_) {
    const Supernode at = supernode(s);
    std::fill_n(supernode_of_row_.begin() + at.first, at.own.cols(), s);
  }
  for (const int s : all_) {
    const Supernode at = supernode(s);
    parent_.push_back(at.rows.empty() ? -1 : supernode_of_row_[static_cast<std::size_t>(at.rows[0])]);
  }
}

TreeFactor::Branches TreeFactor::branches(const std::vector<int>& unknowns) const {
  std::vector<char> on(all_.size(), 0);
  Branches branches;
  for (const int unknown : unknowns) {
    int s = supernode_of_row_[static_cast<std::size_t>(row(unknown))];
    for (; s >= 0 && on[static_cast<std::size_t>(s)] == 0; s = parent_[static_cast<std::size_t>(s)]) {
      on[static_cast<std::size_t>(s)] = 1;
      branches.push_back(s);
    }
  }
  std::sort(branches.begin(), branches.end());
  return branches;
}

// Solves for a supernode's own rows of y and takes their part from the rows below.
void TreeFactor::down(int s, Eigen::VectorXd& y) const {
  const Supernode at = supernode(s);
  auto own = y.segment(at.first, at.own.cols());
  at.own.triangularView<Eigen::Lower>().solveInPlace(own);
  const Eigen::VectorXd part = at.below * own;
  for (Eigen::Index k = 0; k < part.size(); ++k) y[at.rows[static_cast<std::size_t>(k)]] -= part[k];
}

// The same for vectors side by side, row by row: in a product of matrices the digits of a column go by where it stands
// (processors with AVX2).
void TreeFactor::down(int s, SideBySide& y) const {
  const Supernode at = supernode(s);
  using Row = Eigen::Array<double, 1, together>;
  const auto less = [&](Row row, const auto& L, Eigen::Index k, Eigen::Index columns) {
    for (Eigen::Index b = 0; b < columns; ++b) row -= L(k, b) * y.row(at.first + b).array();
    return row;
  };
  for (Eigen::Index c = 0; c < at.own.cols(); ++c)
    y.row(at.first + c) = less(y.row(at.first + c), at.own, c, c) / at.own(c, c);
  for (Eigen::Index k = 0; k < at.below.rows(); ++k) {
    const int row = at.rows[static_cast<std::size_t>(k)];
    y.row(row) = less(y.row(row), at.below, k, at.below.cols());
  }
}

// Solves for a supernode's own rows of x from those below, in the place of y.
void TreeFactor::up(int s, Eigen::VectorXd& y) const {
  const Supernode at = supernode(s);
  Eigen::VectorXd below(at.below.rows());
  for (Eigen::Index k = 0; k < below.size(); ++k) below[k] = y[at.rows[static_cast<std::size_t>(k)]];
  auto own = y.segment(at.first, at.own.cols());
  own.noalias() -= at.below.transpose() * below;
  at.own.triangularView<Eigen::Lower>().transpose().solveInPlace(own);
}

void TreeFactor::solve(const Branches& loaded, const Branches& wanted, Eigen::VectorXd& f) const {
  for (const int s : loaded) down(s, f);
  for (auto s = wanted.rbegin(); s != wanted.rend(); ++s) up(*s, f);
}

Eigen::VectorXd TreeFactor::solve(const Eigen::VectorXd& f) const {
  Eigen::VectorXd in_rows(size()), x(size());
  for (int k = 0; k < size(); ++k) in_rows[row(k)] = f[k];
  solve(all_, all_, in_rows);
  for (int k = 0; k < size(); ++k) x[k] = in_rows[row(k)];
  return x;
}

std::vector<SparseVector> TreeFactor::forward(const std::vector<SparseVector>& g, SideBySide& y) const {
  y.setZero(size(), together);
  std::vector<SparseVector> Y(g.size());
  std::vector<Branches> own;
  std::vector<char> loaded(all_.size(), 0);
  for (std::size_t c = 0; c < g.size(); ++c) {
    std::vector<int> unknowns;
    for (const auto& [unknown, value] : g[c])
      unknowns.push_back(unknown), y(row(unknown), static_cast<Eigen::Index>(c)) = value;
    for (const int s : own.emplace_back(branches(unknowns))) loaded[static_cast<std::size_t>(s)] = 1;
  }
  for (const int s : all_) {
    if (loaded[static_cast<std::size_t>(s)] != 0) down(s, y);
  }
  for (std::size_t c = 0; c < g.size(); ++c) {
    for (const int s : own[c]) {
      const Supernode at = supernode(s);
      for (int k = at.first; k < at.first + at.own.cols(); ++k)
        Y[c].emplace_back(k, y(k, static_cast<Eigen::Index>(c)));
    }
  }
  return Y;
}

}  // namespace strata
