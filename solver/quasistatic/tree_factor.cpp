#include "quasistatic/tree_factor.hpp"

#include <cholmod.h>
#include <omp.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <new>
#include <numeric>
#include <utility>

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

}  // namespace

TreeFactor::TreeFactor(const Eigen::SparseMatrix<double>& K, const char* singular) {
  const OneThread guard;
  cholmod_common common{};
  cholmod_start(&common);
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  cholmod_sparse view = Eigen::viewAsCholmod(K.selfadjointView<Eigen::Lower>());
  cholmod_factor* L = cholmod_analyze(&view, &common);
  cholmod_factorize(&view, L, &common);
  const bool sound = common.status == CHOLMOD_OK;
  const bool out_of_memory = common.status == CHOLMOD_OUT_OF_MEMORY || common.status == CHOLMOD_TOO_LARGE;
  if (sound) {
    const auto *super = static_cast<const int*>(L->super), *rows_at = static_cast<const int*>(L->pi),
               *values_at = static_cast<const int*>(L->px), *rows = static_cast<const int*>(L->s),
               *order = static_cast<const int*>(L->Perm);
    place_.resize(L->n);
    for (std::size_t k = 0; k < L->n; ++k) place_[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
    block_of_row_.resize(L->n);
    std::size_t blocks = 0, most_rows = 0;
    for (std::size_t s = 0; s < L->nsuper; ++s) {
      const auto of_it = static_cast<std::size_t>((super[s + 1] - super[s] + width - 1) / width);
      blocks += of_it, most_rows += of_it * static_cast<std::size_t>(rows_at[s + 1] - rows_at[s]);
    }
    blocks_.reserve(blocks), row_.reserve(most_rows), values_.reserve(most_rows + width * blocks);
    for (std::size_t s = 0; s < L->nsuper; ++s) {
      const auto stride = static_cast<std::size_t>(rows_at[s + 1] - rows_at[s]);
      for (int first = super[s]; first < super[s + 1]; first += width) {
        const auto skipped = static_cast<std::size_t>(first - super[s]);
        add_block(first, std::min(width, super[s + 1] - first),
                  static_cast<const double*>(L->x) + values_at[s] + skipped * stride + skipped, stride,
                  rows + rows_at[s] + skipped, stride - skipped);
      }
    }
    for (Block& block : blocks_) {
      if (block.rows < block.last_row) block.parent = block_of_row_[static_cast<std::size_t>(row_[block.rows])];
    }
    all_.resize(blocks_.size());
    std::iota(all_.begin(), all_.end(), 0);
  }
  cholmod_free_factor(&L, &common);
  cholmod_finish(&common);
  if (out_of_memory) throw std::bad_alloc();
  if (!sound) throw NumericalFailure(singular);
}

// A block from its columns of a supernode, `stride` values apart; rows: `count` of them, its own first.
void TreeFactor::add_block(int first, int columns, const double* values, std::size_t stride, const int* rows,
                           std::size_t count) {
  Block block{first, columns, -1, row_.size(), 0, values_.size()};
  for (int c = 0; c < width; ++c) {
    Eight& row = values_.emplace_back(Eight::Zero());
    if (c >= columns) row[c] = 1.0;
    for (int b = 0; b <= c && c < columns; ++b)
      row[b] = values[static_cast<std::size_t>(b) * stride + static_cast<std::size_t>(c)];
  }
  for (std::size_t r = static_cast<std::size_t>(columns); r < count; ++r) {
    row_.push_back(rows[r]);
    Eight& row = values_.emplace_back(Eight::Zero());
    for (int b = 0; b < columns; ++b) row[b] = values[static_cast<std::size_t>(b) * stride + r];
  }
  block.last_row = row_.size();
  for (int c = 0; c < columns; ++c)
    block_of_row_[static_cast<std::size_t>(first + c)] = static_cast<int>(blocks_.size());
  blocks_.push_back(block);
}

TreeFactor::Branches TreeFactor::branches(const std::vector<int>& unknowns) const {
  std::vector<char> on(blocks_.size(), 0);
  Branches blocks;
  for (const int unknown : unknowns) {
    int b = block_of_row_[static_cast<std::size_t>(row(unknown))];
    for (; b >= 0 && on[static_cast<std::size_t>(b)] == 0; b = blocks_[static_cast<std::size_t>(b)].parent) {
      on[static_cast<std::size_t>(b)] = 1;
      blocks.push_back(b);
    }
  }
  std::sort(blocks.begin(), blocks.end());
  return blocks;
}

// Solves for a block's own rows of y, of one right-hand side or several, and takes their part from the rows below.
template <class Row, class Rows>
void TreeFactor::down(const Block& block, const Row& zero, Rows& y) const {
  const Eight* L = &values_[block.values];
  std::array<Row, width> own;
  own.fill(zero);
  for (int c = 0; c < block.columns; ++c) {
    Row value = y[block.first + c];
    for (int b = 0; b < c; ++b) value -= L[c][b] * own[static_cast<std::size_t>(b)];
    y[block.first + c] = own[static_cast<std::size_t>(c)] = value / L[c][c];
  }
  L += width;
  for (std::size_t r = block.rows; r < block.last_row; ++r, ++L) {
    Row& below = y[row_[r]];
    Row value = below;
    for (int b = 0; b < width; ++b) value -= (*L)[b] * own[static_cast<std::size_t>(b)];
    below = value;
  }
}

// Solves for a block's own rows of x from those below, in the place of y.
void TreeFactor::up(const Block& block, Eigen::VectorXd& y) const {
  const Eight* L = &values_[block.values + width];
  Eight even = Eight::Zero(), odd = Eight::Zero();  // two sums: one alone waits for itself
  std::size_t r = block.rows;
  for (; r + 2 <= block.last_row; r += 2, L += 2) {
    even += y[row_[r]] * L[0];
    odd += y[row_[r + 1]] * L[1];
  }
  if (r < block.last_row) even += y[row_[r]] * L[0];
  const Eight below = even + odd;
  L = &values_[block.values];
  for (int c = block.columns - 1; c >= 0; --c) {
    double value = y[block.first + c] - below[c];
    for (int b = c + 1; b < block.columns; ++b) value -= L[b][c] * y[block.first + b];
    y[block.first + c] = value / L[c][c];
  }
}

void TreeFactor::solve(const Branches& loaded, const Branches& wanted, Eigen::VectorXd& f) const {
  for (const int b : loaded) down(blocks_[static_cast<std::size_t>(b)], 0.0, f);
  for (auto b = wanted.rbegin(); b != wanted.rend(); ++b) up(blocks_[static_cast<std::size_t>(*b)], f);
}

Eigen::VectorXd TreeFactor::solve(const Eigen::VectorXd& f) const {
  Eigen::VectorXd in_rows(size()), x(size());
  for (int k = 0; k < size(); ++k) in_rows[row(k)] = f[k];
  solve(all_, all_, in_rows);
  for (int k = 0; k < size(); ++k) x[k] = in_rows[row(k)];
  return x;
}

TreeFactor::SideBySide::SideBySide(const TreeFactor& factor, Branches branches)
    : branches_(std::move(branches)), place_(static_cast<std::size_t>(factor.size()), 0), values_(1, Row::Zero()) {
  for (const int b : branches_) {
    const Block& block = factor.blocks_[static_cast<std::size_t>(b)];
    for (int k = block.first; k < block.first + block.columns; ++k) {
      place_[static_cast<std::size_t>(k)] = static_cast<std::uint32_t>(values_.size());
      values_.emplace_back(Row::Zero());
    }
  }
}

void TreeFactor::forward(SideBySide& g) const {
  const SideBySide::Row zero = SideBySide::Row::Zero();
  for (const int b : g.branches()) down(blocks_[static_cast<std::size_t>(b)], zero, g);
}

SparseVector TreeFactor::on_branches(const Branches& branches, SideBySide& y, std::size_t which) const {
  SparseVector out;
  for (const int b : branches) {
    const Block& block = blocks_[static_cast<std::size_t>(b)];
    for (int k = block.first; k < block.first + block.columns; ++k)
      out.index.push_back(k), out.value.push_back(y[k][static_cast<Eigen::Index>(which)]);
  }
  return out;
}

}  // namespace strata
