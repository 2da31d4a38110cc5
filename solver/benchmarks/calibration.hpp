// Kernels that tell how fast the machine is while something else is timed.
#pragma once

#include <chrono>
#include <cstddef>
#include <memory>

namespace strata::bench {

using Clock = std::chrono::steady_clock;

inline double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// What the machine gives so many threads together.
struct Rates {
  double flop_s = 0.0;  // double-precision fused multiply-adds, each two flop (flop/s)
  double byte_s = 0.0;  // to and from memory, far beyond the caches (B/s)
  // A line of memory from the first thread to the last and back (s): 1e-8 to 1e-7 where their processors share a cache,
  // three times as much and more where they do not. 0 of one thread.
  double round_trip_s = 0.0;
};

class Calibration {
 public:
  /// Sets up arrays of at least 128 MB and four times the last cache together, touched by `threads` threads as they
  /// will use them, and finds the width of vector that multiplies and adds fastest.
  explicit Calibration(int threads);

  /// Measures the first two for a hundredth of a second each, the third for a thousandth. flop_s: twelve independent
  /// chains a = a b + c a thread, enough to hide a latency of six cycles at two a cycle. byte_s: a = a/2 + b, which
  /// reads two arrays and writes one of them, 24 B an element (after McCalpin's STREAM, 1995, but without a write that
  /// first reads). Throws nothing.
  Rates measure() const;

  int threads() const { return threads_; }

 private:
  double flop_s() const;
  double byte_s() const;
  double round_trip_s() const;
  int threads_ = 1;
  bool widest_ = true;  // 512-bit vectors rather than 256-bit ones, where the processor has both
  long rounds_ = 0;     // of the chains, for a hundredth of a second
  std::size_t elements_ = 0;
  std::unique_ptr<double[]> a_, b_;
};

}  // namespace strata::bench
