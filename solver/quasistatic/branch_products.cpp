#include "quasistatic/branch_products.hpp"

#include <algorithm>

namespace strata {

void SideBySide::put(std::span<const BranchVector* const> vectors) {
  for (const int b : blocks_) first_row_[static_cast<std::size_t>(b)] = -1;
  blocks_.clear();
  int rows = 0;
  for (const BranchVector* v : vectors) {
    for (std::size_t e = 0; e < v->block.size(); ++e) {
      int& first = first_row_[static_cast<std::size_t>(v->block[e])];
      if (first >= 0) continue;
      first = rows;
      rows += v->begin[e + 1] - v->begin[e];
      blocks_.push_back(v->block[e]);
    }
  }
  rows_.assign(static_cast<std::size_t>(rows), {Eight::Zero(), Eight::Zero()});
  for (std::size_t c = 0; c < vectors.size(); ++c) {
    const BranchVector& v = *vectors[c];
    for (std::size_t e = 0; e < v.block.size(); ++e) {
      auto row = rows_.begin() + first_row_[static_cast<std::size_t>(v.block[e])];
      for (int k = v.begin[e]; k < v.begin[e + 1]; ++k, ++row)
        (*row)[c / half][static_cast<Eigen::Index>(c % half)] = v.value[static_cast<std::size_t>(k)];
    }
  }
}

std::array<double, SideBySide::most> SideBySide::times(const BranchVector& v) const {
  Eight low = Eight::Zero(), high = Eight::Zero();
  for (std::size_t e = 0; e < v.block.size(); ++e) {
    const int first = first_row_[static_cast<std::size_t>(v.block[e])];
    if (first < 0) continue;
    const Lanes* row = &rows_[static_cast<std::size_t>(first)];
    for (int k = v.begin[e]; k < v.begin[e + 1]; ++k, ++row) {
      low += v.value[static_cast<std::size_t>(k)] * (*row)[0];
      high += v.value[static_cast<std::size_t>(k)] * (*row)[1];
    }
  }
  std::array<double, most> products{};
  Eigen::Map<Eight>(products.data()) = low;
  Eigen::Map<Eight>(products.data() + half) = high;
  return products;
}

}  // namespace strata
