// Parts of the records, for loops over nodes: always the same ranges, so that sums formed part by part have the same
// digits with any number of threads. A thread has the same parts in each loop, about those of its strips of particles:
// what it left in its cache it finds there.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <type_traits>

#include "state/state.hpp"

namespace strata {

constexpr std::size_t record_parts = 32;  // enough to even out the work of a few threads
// Loops over fewer records are one thread's, since others would wait longer than they work. Of blocks of
// 80 x 80 cells, 6561, two threads gain.
constexpr std::size_t worth_threads = 2048;
// A loop of several passes goes through a part by pieces of so many, whose arrays stay in the nearest cache.
constexpr std::size_t cached_records = 512;

struct Part {
  std::size_t first = 0, last = 0;  // records [first, last)

  // Those records of an array.
  template <class Array>
  auto of(Array& array) const {
    using Map = Eigen::Map<std::conditional_t<std::is_const_v<Array>, const Eigen::ArrayXd, Eigen::ArrayXd>>;
    return Map(array.data() + first, static_cast<Eigen::Index>(last - first));
  }
};

// The part-th of n records; all begin at whole lines of memory.
inline Part part_of(std::size_t n, std::size_t part) {
  constexpr std::size_t line = line_bytes / sizeof(double);
  const std::size_t length = (n + line * record_parts - 1) / (line * record_parts) * line;
  return {std::min(n, part * length), std::min(n, (part + 1) * length)};
}

/// Calls work(part) for all parts of n records that are not empty, on any number of threads.
template <class Work>
void for_each_part(std::size_t n, Work work) {
#pragma omp parallel for schedule(static) if (n > worth_threads)
  for (std::size_t k = 0; k < record_parts; ++k) {
    if (const Part part = part_of(n, k); part.first < part.last) work(part);
  }
}

/// The sum of what work(piece) returns for all pieces of parts, in their order. Allocates nothing.
template <class Sum, class Work>
Sum sum_over_parts(std::size_t n, Work work) {
  std::array<Sum, record_parts> sums{};
  for_each_part(n, [&](const Part& part) {
    Sum& sum = sums[part.first / part_of(n, 0).last];
    for (Part piece = part; piece.first < part.last; piece.first = piece.last) {
      piece.last = std::min(piece.first + cached_records, part.last);
      sum += work(piece);
    }
  });
  Sum total{};
  for (const Sum& sum : sums) total += sum;
  return total;
}

/// Calls work(record, its master) for all tied records, few beside the others.
template <class Work>
void for_each_tied(const State& state, Work work) {
  for (const int record : state.tied) {
    const auto r = static_cast<std::size_t>(record);
    work(r, state.masters[r]);
  }
}

}  // namespace strata
