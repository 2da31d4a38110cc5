#include "griffith.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

constexpr double kShortest = 1e-8;  // of half_length: a piece of a profile that is steep but not a jump

void check_crack(double half_length, double E_prime) {
  if (!(half_length > 0) || !std::isfinite(half_length)) throw std::invalid_argument("half_length must be positive");
  if (!(E_prime > 0) || !std::isfinite(E_prime)) throw std::invalid_argument("E_prime must be positive");
}

// G of the opening integral with s = a sin(theta), x = a sin(phi), free of cancellation:
// arccosh[(a^2 - x s)/(a |x - s|)] = ln |cos((theta + phi)/2) / sin((theta - phi)/2)|.
double opening_kernel(double theta, double phi) {
  return std::log(std::abs(std::cos(0.5 * (theta + phi)) / std::sin(0.5 * (theta - phi))));
}

// Antiderivatives over s of G and of (s - x) G at s, for x inside the crack.
struct KernelMoments {
  double zeroth;
  double first;
};

KernelMoments kernel_moments(double s, double x, double a) {
  const double theta = std::asin(std::clamp(s / a, -1.0, 1.0));
  const double phi = std::asin(x / a);
  const double distance = s - x;
  // (s - x) G -> 0 at the singular point and at the tips, where the logarithm itself is not finite or is 0.
  const bool vanishes = distance == 0 || std::abs(s) >= a;
  const double distance_G = vanishes ? 0.0 : distance * opening_kernel(theta, phi);
  const double root = a * std::cos(phi);
  return {distance_G + root * theta, 0.5 * distance * distance_G - 0.5 * root * (a * std::cos(theta) + x * theta)};
}

}  // namespace

void PressureKnots::validate() const {
  if (x.size() < 2 || x.size() != p.size())
    throw std::invalid_argument("a pressure profile needs two knots or more and a value for each");
  for (std::size_t i = 0; i < x.size(); ++i) {
    if (!std::isfinite(x[i]) || !std::isfinite(p[i])) throw std::invalid_argument("a pressure knot is not finite");
    if (i > 0 && x[i] < x[i - 1]) throw std::invalid_argument("pressure knots must ascend");
  }
}

double PressureKnots::operator()(double at) const {
  double sum = 0.0;
  int sides = 0;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    if (at < x[i] || at > x[i + 1] || x[i] == x[i + 1]) continue;
    sum += p[i] + (p[i + 1] - p[i]) * (at - x[i]) / (x[i + 1] - x[i]);
    ++sides;
  }
  return sides == 0 ? 0.0 : sum / sides;
}

std::vector<PressureSegment> PressureKnots::segments(double a) const {
  std::vector<PressureSegment> all;
  for (std::size_t i = 0; i + 1 < x.size(); ++i) {
    const double from = std::max(x[i], -a), to = std::min(x[i + 1], a);
    if (!(from < to)) continue;
    const double width = x[i + 1] - x[i], rise = p[i + 1] - p[i];
    if (width < kShortest * a) {
      all.push_back({from, to, p[i] + rise * (0.5 * (from - x[i] + to - x[i]) / width), 0.0});
    } else {
      const double slope = rise / width;
      all.push_back({from, to, p[i] - slope * x[i], slope});
    }
  }
  return all;
}

PressurisedCrack::PressurisedCrack(double half_length, double E_prime, Function p, const std::vector<double>& kinks)
    : a_(half_length), E_prime_(E_prime), p_(std::move(p)) {
  check_crack(half_length, E_prime);
  for (double kink : kinks)
    if (std::abs(kink) < a_) angles_.push_back(std::asin(kink / a_));
}

TipIntensities PressurisedCrack::K_I() const {
  // With s = a sin(theta) the weight sqrt((a+s)/(a-s)) ds becomes a (1 + sin(theta)) d(theta): no singularity is left.
  const double scale = std::sqrt(a_ / pi);
  const auto at_tip = [&](double sign) {
    const auto f = [&](double theta) { return p_(a_ * std::sin(theta)) * (1 + sign * std::sin(theta)); };
    return scale * integrate(f, -pi / 2, pi / 2, angles_).value;
  };
  return {at_tip(-1), at_tip(+1)};
}

double PressurisedCrack::opening(double x) const {
  if (std::abs(x) >= a_) return 0.0;
  const double phi = std::asin(x / a_);
  auto breaks = angles_;
  breaks.push_back(phi);
  const auto f = [&](double theta) {
    if (theta == phi) return 0.0;  // an integrable logarithm: the point has no weight
    return p_(a_ * std::sin(theta)) * opening_kernel(theta, phi) * std::cos(theta);
  };
  return 4 * a_ / (pi * E_prime_) * integrate(f, -pi / 2, pi / 2, breaks).value;
}

double PressurisedCrack::volume() const {
  const auto f = [&](double theta) { return p_(a_ * std::sin(theta)) * std::cos(theta) * std::cos(theta); };
  return 4 * a_ * a_ / E_prime_ * integrate(f, -pi / 2, pi / 2, angles_).value;
}

double PressurisedCrack::energy() const {
  const auto f = [&](double theta) {
    const double x = a_ * std::sin(theta);
    return 0.5 * p_(x) * opening(x) * a_ * std::cos(theta);
  };
  return integrate(f, -pi / 2, pi / 2, angles_, 1e-10).value;
}

LinearlyPressurisedCrack::LinearlyPressurisedCrack(double half_length, double E_prime, const PressureKnots& knots)
    : a_(half_length), E_prime_(E_prime) {
  check_crack(half_length, E_prime);
  knots.validate();
  segments_ = knots.segments(a_);
}

TipIntensities LinearlyPressurisedCrack::K_I() const {
  TipIntensities K;
  for (const PressureSegment& segment : segments_) {
    // int (c0 + c1 a sin(theta)) (1 + sign sin(theta)) d(theta), split into its even and odd part.
    const auto even = [&](double theta) { return segment.at_0 * theta - segment.slope * a_ * std::cos(theta); };
    const auto odd = [&](double theta) {
      return -segment.at_0 * std::cos(theta) + segment.slope * a_ * (0.5 * theta - 0.25 * std::sin(2 * theta));
    };
    const double from = std::asin(segment.from / a_);
    const double to = std::asin(segment.to / a_);
    K.plus += even(to) - even(from) + odd(to) - odd(from);
    K.minus += even(to) - even(from) - odd(to) + odd(from);
  }
  K.plus *= std::sqrt(a_ / pi);
  K.minus *= std::sqrt(a_ / pi);
  return K;
}

double LinearlyPressurisedCrack::opening(double x) const {
  if (std::abs(x) >= a_) return 0.0;
  double sum = 0.0;
  for (const PressureSegment& segment : segments_) {
    const KernelMoments to = kernel_moments(segment.to, x, a_);
    const KernelMoments from = kernel_moments(segment.from, x, a_);
    sum += (segment.at_0 + segment.slope * x) * (to.zeroth - from.zeroth) + segment.slope * (to.first - from.first);
  }
  return 4 / (pi * E_prime_) * sum;
}

double LinearlyPressurisedCrack::volume() const {
  double sum = 0.0;
  for (const PressureSegment& segment : segments_) {
    const auto f = [&](double theta) {
      const double c = std::cos(theta);
      return segment.at_0 * (0.5 * theta + 0.25 * std::sin(2 * theta)) - segment.slope * a_ * c * c * c / 3;
    };
    sum += f(std::asin(segment.to / a_)) - f(std::asin(segment.from / a_));
  }
  return 4 * a_ * a_ / E_prime_ * sum;
}

double LinearlyPressurisedCrack::energy() const {
  double sum = 0.0;
  for (const PressureSegment& segment : segments_) {
    const auto f = [&](double theta) {
      const double x = a_ * std::sin(theta);
      return 0.5 * (segment.at_0 + segment.slope * x) * opening(x) * a_ * std::cos(theta);
    };
    // Round-off of a steep profile is 1e-8 of the opening (see profile_error).
    sum += integrate(f, std::asin(segment.from / a_), std::asin(segment.to / a_), {}, 1e-11).value;
  }
  return sum;
}

double profile_error(const PressureKnots& knots, double half_length) {
  double largest = 0.0, steepest = 0.0, error = 1e-12;
  for (std::size_t i = 0; i < knots.x.size(); ++i) {
    largest = std::max(largest, std::abs(knots.p[i]));
    if (i == 0 || knots.x[i] == knots.x[i - 1] || knots.p[i] == knots.p[i - 1]) continue;
    const double from = knots.x[i - 1], to = knots.x[i];
    if (to <= -half_length || from >= half_length) continue;
    if (to - from >= kShortest * half_length) {
      steepest = std::max(steepest, std::abs(knots.p[i] - knots.p[i - 1]) / (to - from));
      continue;
    }
    const double gap = std::max(0.0, half_length - std::max(std::abs(from), std::abs(to)));
    const double near_tip = gap > to - from ? std::pow((to - from) / gap, 1.5) : 1.0;
    error = std::max({error, kShortest, 0.2 * std::sqrt((to - from) / half_length) * near_tip});
  }
  return largest == 0.0 ? 1e-12 : std::max(error, 1e-15 * steepest * half_length / largest);
}

double energy_release_rate(double K_I, double E_prime) {
  return K_I * K_I / E_prime;
}

double griffith_critical_pressure(double half_length, double K_Ic) {
  return K_Ic / std::sqrt(pi * half_length);
}

}  // namespace strata::reference
