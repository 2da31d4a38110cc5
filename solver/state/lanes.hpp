// Lanes: short vectors of the compiler that hold the same quantity of neighbours, and how they come from memory and go
// back to it. What is written for a type Real of them reads the same where Real is double.
#pragma once

#if defined(__AVX512F__)
#include <immintrin.h>
#endif

#include <algorithm>
#include <cstddef>
#include <type_traits>
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

typedef double Lane __attribute__((vector_size(8 * most_lanes)));
typedef double UnalignedLane __attribute__((vector_size(8 * most_lanes), aligned(8), may_alias));

// Lanes moved up by some, or down by -by; zeros where none comes from.
template <int by, std::size_t... l>
inline Lane moved_up(const Lane& value, std::index_sequence<l...>) {
  constexpr auto from = [](int k) { return k >= 0 && k < most_lanes ? k : most_lanes; };
  return __builtin_shufflevector(value, Lane{}, from(static_cast<int>(l) - by)...);
}
using EachLane = std::make_index_sequence<most_lanes>;

// All lanes.
struct AllLanes {
  using Real = Lane;

  Lane load(const double* from) const { return *reinterpret_cast<const UnalignedLane*>(from); }
  void store(double* to, const Lane& value) const { *reinterpret_cast<UnalignedLane*>(to) = value; }
  Lane used(const Lane& value) const { return value; }
  // to[l] += first[l], to[l + 1] += second[l], to[l + 2] += third[l].
  void add_shifted(double* to, const Lane& first, const Lane& second, const Lane& third) const {
    store(to, load(to) + (first + moved_up<1>(second, EachLane{}) + moved_up<2>(third, EachLane{})));
    const Lane out = moved_up<1 - most_lanes>(second, EachLane{}) + moved_up<2 - most_lanes>(third, EachLane{});
    to[most_lanes] += out[0], to[most_lanes + 1] += out[1];
  }
};

// The first of them; others are 0 where they are loaded and are not stored.
struct FirstLanes {
  using Real = Lane;
  int lanes;

#if defined(__AVX512F__)
  __mmask8 mask() const {
    return static_cast<__mmask8>((1U << lanes) - 1U);
  }
  Lane load(const double* from) const {
    return _mm512_maskz_loadu_pd(mask(), from);
  }
  void store(double* to, const Lane& value) const {
    _mm512_mask_storeu_pd(to, mask(), value);
  }
  Lane used(const Lane& value) const {
    return _mm512_maskz_mov_pd(mask(), value);
  }
#else
  Lane load(const double* from) const {
    Lane value{};
    for (int l = 0; l < lanes; ++l) value[l] = from[l];
    return value;
  }
  void store(double* to, const Lane& value) const {
    for (int l = 0; l < lanes; ++l) to[l] = value[l];
  }
  Lane used(const Lane& value) const {
    Lane kept{};
    for (int l = 0; l < lanes; ++l) kept[l] = value[l];
    return kept;
  }
#endif
  void add_shifted(double* to, const Lane& first, const Lane& second, const Lane& third) const {
    const FirstLanes reach{std::min(lanes + 2, most_lanes)};
    const Lane in = used(first) + moved_up<1>(used(second), EachLane{}) + moved_up<2>(used(third), EachLane{});
    reach.store(to, reach.load(to) + in);
    if (lanes == most_lanes - 1) to[most_lanes] += third[lanes - 1];
  }
};

// One lane: a number.
struct OneLane {
  using Real = double;

  double load(const double* from) const { return *from; }
  void store(double* to, double value) const { *to = value; }
  double used(double value) const { return value; }
};

// Asks memory for the line of array[i]. A hint: an address that is nobody's does no harm. Inlined by force, as are its
// callers: GCC leaves out calls of functions that do nothing else.
template <class T>
[[gnu::always_inline]] inline void fetch(const T* array, std::size_t i) {
  __builtin_prefetch(array + i);
}

template <class Real>
Real larger(const Real& a, const Real& b) {
  return a > b ? a : b;
}

// The sum of all lanes, halves added to halves, and the largest of them.
inline double sum_of_lanes(double value) {
  return value;
}
inline double sum_of_lanes(Lane value) {
  for (int half = most_lanes / 2; half > 0; half /= 2) {
    for (int l = 0; l < half; ++l) value[l] += value[l + half];
  }
  return value[0];
}
inline double largest_lane(double value) {
  return value;
}
inline double largest_lane(const Lane& value) {
  double largest = value[0];
  for (int l = 1; l < most_lanes; ++l) largest = std::max(largest, value[l]);
  return largest;
}

}  // namespace strata
