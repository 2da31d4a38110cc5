#include "benchmarks/shop.hpp"

#include <fmt/format.h>

namespace strata::bench {

void add_calibration(Shop& shop) {
  for (const int threads : {1, 2}) {
    add(fmt::format("calibration/threads{}", threads), 1, [&shop, threads](benchmark::State& bench) {
      time_work(bench, shop, {fmt::format("threads={}", threads), threads, 1.0, 0.0, 0.0},
                [&] { shop.rates(threads); });
    });
  }
}

}  // namespace strata::bench
