#include "benchmarks/calibration.hpp"

#include <omp.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>

namespace strata::bench {

namespace {

constexpr std::size_t chains = 12;
constexpr double window_s = 0.01, trip_window_s = 0.001;

// Vectors of the widths that the processor has.
typedef double Two __attribute__((vector_size(16)));
typedef double Four __attribute__((vector_size(32)));
typedef double Eight __attribute__((vector_size(64)));
#if defined(__AVX512F__)
using Wide = Eight;
using Narrow = Four;
#elif defined(__AVX__)
using Wide = Four;
using Narrow = Four;
#else
using Wide = Two;
using Narrow = Two;
#endif

// `rounds` times a = a b + c on each chain; the sum is returned so that nothing is left out.
template <class Vector>
double multiply_add(long rounds) {
  std::array<Vector, chains> a;
  for (std::size_t k = 0; k < chains; ++k) a[k] = Vector{} + static_cast<double>(k);
  Vector b = Vector{} + 0.999999, c = Vector{} + 1e-9;
  for (long n = 0; n < rounds; ++n) {
    for (std::size_t k = 0; k < chains; ++k) a[k] = a[k] * b + c;
      // Neither is known from one round to the next, so the rounds cannot be done at once.
#if defined(__x86_64__)
    asm volatile("" : "+x"(b), "+x"(c));
#else
    asm volatile("" : "+m"(b), "+m"(c));
#endif
  }
  Vector sum = Vector{};
  for (const Vector& chain : a) sum += chain;
  return sum[0];
}

template <class Vector>
double chain_rate(int threads, long rounds) {
  double sum = 0.0;
  const Clock::time_point start = Clock::now();
#pragma omp parallel num_threads(threads) reduction(+ : sum)
  sum += multiply_add<Vector>(rounds);
  const double seconds = seconds_since(start);
  constexpr std::size_t doubles = sizeof(Vector) / sizeof(double);
  const double flop = 2.0 * static_cast<double>(doubles * chains) * static_cast<double>(rounds) * threads;
  return sum > 0.0 ? flop / seconds : 0.0;
}

}  // namespace

Calibration::Calibration(int threads) : threads_(threads) {
  constexpr long trial = 200000;
  const double by_wide = std::max(chain_rate<Wide>(1, trial), chain_rate<Wide>(1, trial));
  const double by_narrow = std::max(chain_rate<Narrow>(1, trial), chain_rate<Narrow>(1, trial));
  widest_ = by_wide > by_narrow;
  const std::size_t doubles = (widest_ ? sizeof(Wide) : sizeof(Narrow)) / sizeof(double);
  rounds_ = static_cast<long>(window_s * std::max(by_wide, by_narrow) / (2.0 * static_cast<double>(doubles * chains)));
  const long cache = std::max(0L, sysconf(_SC_LEVEL3_CACHE_SIZE));
  elements_ = static_cast<std::size_t>(std::max(128L << 20, 4 * cache)) / (2 * sizeof(double));
  a_ = std::make_unique_for_overwrite<double[]>(elements_);
  b_ = std::make_unique_for_overwrite<double[]>(elements_);
#pragma omp parallel for schedule(static) num_threads(threads_)
  for (std::size_t k = 0; k < elements_; ++k) a_[k] = 1.0, b_[k] = 2.0;
}

double Calibration::flop_s() const {
  return widest_ ? chain_rate<Wide>(threads_, rounds_) : chain_rate<Narrow>(threads_, rounds_);
}

double Calibration::byte_s() const {
  double *a = a_.get(), *b = b_.get();
  int passes = 0;
  const Clock::time_point start = Clock::now();
  do {
#pragma omp parallel for schedule(static) num_threads(threads_)
    for (std::size_t k = 0; k < elements_; ++k) a[k] = 0.5 * a[k] + b[k];
    ++passes;
  } while (seconds_since(start) < window_s);
  return 3.0 * sizeof(double) * static_cast<double>(elements_) * passes / seconds_since(start);
}

double Calibration::round_trip_s() const {
  if (threads_ < 2) return 0.0;
  enum : int { here, there, done };
  alignas(128) std::atomic<int> ball{here};
  long trips = 0;
  double seconds = 0.0;
#pragma omp parallel num_threads(threads_)
  {
    const int last = omp_get_num_threads() - 1, own = omp_get_thread_num();
    if (own == 0 && last > 0) {
      const Clock::time_point start = Clock::now();
      while (seconds < trip_window_s) {
        for (int k = 0; k < 100; ++k) {
          ball.store(there, std::memory_order_release);
          while (ball.load(std::memory_order_acquire) == there) {
          }
        }
        trips += 100, seconds = seconds_since(start);
      }
      ball.store(done, std::memory_order_release);
    } else if (own == last && last > 0) {
      for (int at = here; at != done; at = ball.load(std::memory_order_acquire)) {
        if (at == there) ball.store(here, std::memory_order_release);
      }
    }
  }
  return trips > 0 ? seconds / static_cast<double>(trips) : 0.0;
}

Rates Calibration::measure() const {
  return {flop_s(), byte_s(), round_trip_s()};
}

}  // namespace strata::bench
