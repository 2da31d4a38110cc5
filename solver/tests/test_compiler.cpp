// What the compiler itself must not get wrong with the flags of this build; see CMakeLists.txt.
#include <catch2/catch.hpp>
#include <numeric>
#include <vector>

namespace {

// Not inlined: the list has to reach the vector through memory, as it does in use.
__attribute__((noinline)) double sum_of(const std::vector<double>& values) {
  return std::accumulate(values.begin(), values.end(), 0.0);
}

}  // namespace

// Fails with GCC 12.2 at -O3 -march=native on a machine with AVX-512 without -mmove-max=128 -mstore-max=128.
TEST_CASE("constant lists that end in zeros keep them") {
  CHECK(sum_of({7.5, 7.5, 0, 0}) == 15.0);
  CHECK(sum_of({7.5, 7.5, 7.5, 0}) == 22.5);
  CHECK(sum_of({7.5, 7.5, 7.5, 7.5, 0, 0, 0, 0}) == 30.0);
}
