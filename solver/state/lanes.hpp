// Lanes: short vectors of the compiler that hold the same quantity of neighbours, and how they come from memory and go
// back to it. What is written for a type Real of them reads the same where Real is double.
#pragma once

#include <utility>

namespace strata {

// As many doubles as the machine that the build is for has in a register.
#if defined(__AVX512F__)
constexpr int most_lanes = 8;
#elif defined(__AVX__)
constexpr int most_lanes = 4;
#else
constexpr int most_lanes = 2;
#endif

// W neighbours, a power of two.
template <int W>
struct Lanes {
  using Real [[gnu::vector_size(8 * W)]] = double;
  using Unaligned [[gnu::vector_size(8 * W), gnu::aligned(8), gnu::may_alias]] = double;

  static Real load(const double* from) { return *reinterpret_cast<const Unaligned*>(from); }
  static void store(double* to, const Real& value) { *reinterpret_cast<Unaligned*>(to) = value; }

  // to[l] += first[l], to[l + 1] += second[l], to[l + 2] += third[l].
  static void add_shifted(double* to, const Real& first, const Real& second, const Real& third) {
    store(to, load(to) + (first + moved_up<1>(second) + moved_up<2>(third)));
    const auto out = moved_up<1 - W>(second) + moved_up<2 - W>(third);
    to[W] += out[0], to[W + 1] += out[1];
  }

 private:
  // Lanes moved up by some, or down by -by; zeros where none comes from.
  template <int by>
  static Real moved_up(const Real& value) {
    constexpr auto from = [](int k) { return k >= 0 && k < W ? k : W; };
    return [&]<int... l>(std::integer_sequence<int, l...>) {
      return __builtin_shufflevector(value, Real{}, from(l - by)...);
    }
    (std::make_integer_sequence<int, W>{});
  }
};

// One: a number.
template <>
struct Lanes<1> {
  using Real = double;

  static double load(const double* from) { return *from; }
  static void store(double* to, double value) { *to = value; }
  static void add_shifted(double* to, double first, double second, double third) {
    to[0] += first, to[1] += second, to[2] += third;
  }
};

/// Calls work(Lanes<W>{}) for W = `lanes`, a power of two up to W_most.
template <int W_most = most_lanes, class Work>
void with_lanes(int lanes, Work work) {
  if constexpr (W_most > 1) {
    if (lanes < W_most) return with_lanes<W_most / 2>(lanes, work);
  }
  work(Lanes<W_most>{});
}

template <class Real>
Real larger(const Real& a, const Real& b) {
  return a > b ? a : b;
}

}  // namespace strata
