// Parts of the records, for loops over nodes: always the same ranges, so that sums formed part by part have the same
// digits with any number of threads. A thread has the same parts in each loop, about those of its strips of particles:
// what it left in its cache it finds there. Between processors that share no cache nodes that change hands cost more
// than the loop itself.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>

#include "state/lanes.hpp"
#include "state/state.hpp"

namespace strata {

constexpr std::size_t record_parts = 32;  // enough to even out the work of a few threads
// Loops over fewer records are one thread's, since others would wait longer than they work. Of blocks of
// 80 x 80 cells, 6561, two threads gain.
constexpr std::size_t worth_threads = 2048;

struct Part {
  std::size_t first = 0, last = 0;  // records [first, last)
};

// The part-th of n records; all begin at whole lanes.
inline Part part_of(std::size_t n, std::size_t part) {
  constexpr std::size_t W = most_lanes;
  const std::size_t length = (n + W * record_parts - 1) / (W * record_parts) * W;
  return {std::min(n, part * length), std::min(n, (part + 1) * length)};
}

/// Calls work(part, its range) for all parts of n records, on any number of threads.
template <class Work>
void for_each_part(std::size_t n, Work work) {
#pragma omp parallel for schedule(static) if (n > worth_threads)
  for (std::size_t part = 0; part < record_parts; ++part) work(part, part_of(n, part));
}

/// Calls work(lanes, r, sum) for all of n records, some lanes from r on at a time, and returns the sum, part by part,
/// so that its digits do not depend on the number of threads. Allocates nothing.
template <class Sum, class Work>
Sum sum_over_records(std::size_t n, Work work) {
  std::array<Sum, record_parts> sums{};
  for_each_part(n, [&](std::size_t part, const Part& of) {
    constexpr std::size_t W = most_lanes;
    Sum sum{};
    std::size_t r = of.first;
    for (; r + W <= of.last; r += W) work(AllLanes{}, r, sum);
    if (r < of.last) work(FirstLanes{static_cast<int>(of.last - r)}, r, sum);
    sums[part] = sum;
  });
  Sum total{};
  for (const Sum& sum : sums) total += sum;
  return total;
}

/// Calls work(record, its master) for all tied records, on any number of threads: those of one master one after the
/// other on the same.
template <class Work>
void for_each_tied(const State& state, Work work) {
  for_each_part(state.masters.size(), [&](std::size_t part, const Part&) {
    for (std::size_t k = state.tied_of_part[part]; k < state.tied_of_part[part + 1]; ++k) {
      const auto record = static_cast<std::size_t>(state.tied[k]);
      work(record, state.masters[record]);
    }
  });
}

}  // namespace strata
