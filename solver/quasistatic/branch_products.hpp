// Products of vectors on branches of a factor.
#pragma once

#include <Eigen/Core>
#include <array>
#include <span>
#include <vector>

#include "quasistatic/tree_factor.hpp"

namespace strata {

// Vectors side by side, to multiply others by: two of the longest vectors of the processor a row.
class SideBySide {
 public:
  static constexpr std::size_t most = 16;

  /// Room for `most` vectors on branches of a factor. Throws nothing.
  explicit SideBySide(const TreeFactor& factor) : first_row_(static_cast<std::size_t>(factor.blocks()), -1) {}

  /// Puts these vectors there, no more than `most`, in the place of others. Throws nothing.
  void put(std::span<const BranchVector* const> vectors);

  /// v . each of them, sums over the rows of v in their order less terms that are 0: the digits are the same whichever
  /// of two vectors is v. Throws nothing.
  std::array<double, most> times(const BranchVector& v) const;

 private:
  static constexpr std::size_t half = most / 2;
  using Eight = Eigen::Array<double, half, 1>;
  using Lanes = std::array<Eight, 2>;

  std::vector<int> first_row_;  // in rows_, of each block of the factor; -1: none of the vectors has values there
  std::vector<int> blocks_;     // that some have values on
  std::vector<Lanes> rows_;
};

}  // namespace strata
