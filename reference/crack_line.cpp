#include "crack_line.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

constexpr int kMaxNodes = 512;

// Angle of node j = 0 .. n-1, t = a cos(angle).
double node_angle(int j, int n) {
  return (2 * j + 1) * pi / (2 * n);
}

Eigen::VectorXd node_places(double a, int n) {
  Eigen::VectorXd nodes(n);
  for (int j = 0; j < n; ++j) nodes(j) = a * std::cos(node_angle(j, n));
  return nodes;
}

void check_line(double half_length, double E_prime) {
  if (!(half_length > 0 && E_prime > 0) || !std::isfinite(half_length) || !std::isfinite(E_prime))
    throw std::invalid_argument("half_length and E_prime must be positive and finite");
}

// int_0^pi p(a cos th) sin(m th) sin(th) d(th) for m = 0 .. n-1.
Eigen::VectorXd sine_moments(double a, const PressureKnots& p, int n) {
  Eigen::VectorXd moments = Eigen::VectorXd::Zero(n);
  const auto cosine_integral = [](int j, double from, double to) {  // of cos(j th)
    return j == 0 ? to - from : (std::sin(j * to) - std::sin(j * from)) / j;
  };
  for (const PressureSegment& segment : p.segments(a)) {
    const double from = std::acos(segment.to / a), to = std::acos(segment.from / a);
    for (int m = 1; m < n; ++m) {
      const double constant = 0.5 * (cosine_integral(m - 1, from, to) - cosine_integral(m + 1, from, to));
      const double linear = 0.25 * a * (cosine_integral(std::abs(m - 2), from, to) - cosine_integral(m + 2, from, to));
      moments(m) += segment.at_0 * constant + segment.slope * linear;
    }
  }
  return moments;
}

// Strengths of n point dislocations with the moments of the infinite plane's opening under p.
Eigen::VectorXd plane_strengths(double a, double E_prime, const PressureKnots& p, int n) {
  const Eigen::VectorXd moments = -4 * a / E_prime * sine_moments(a, p, n);
  Eigen::VectorXd strengths = Eigen::VectorXd::Zero(n);
  for (int j = 0; j < n; ++j)
    for (int m = 1; m < n; ++m) strengths(j) += 2.0 / n * moments(m) * std::cos(m * node_angle(j, n));
  return strengths;
}

}  // namespace

CrackLine::CrackLine(double half_length, double E_prime, const CrackKernel& kernel, const CrackLoad& load, int n)
    : a_(half_length), E_prime_(E_prime) {
  check_line(half_length, E_prime);
  settle(
      kernel, [&load](int) { return load; }, n);
  rest_ = strengths_;
}

CrackLine::CrackLine(double half_length, double E_prime, const CrackKernel& kernel, const PressureKnots& p, int n)
    : a_(half_length), E_prime_(E_prime) {
  check_line(half_length, E_prime);
  plane_ = LinearlyPressurisedCrack(half_length, E_prime, p);
  // The rest answers the traction that the plane's part sends back to the crack.
  const auto returned = [&](int count) -> CrackLoad {
    return [&kernel, nodes = node_places(a_, count), given = plane_strengths(a_, E_prime_, p, count),
            unit = E_prime_ / (4 * pi)](double x) {
      Eigen::Vector2d traction = Eigen::Vector2d::Zero();
      for (Eigen::Index j = 0; j < nodes.size(); ++j) traction += kernel(nodes(j), x).col(0) * given(j);
      return Eigen::Vector2d(unit * traction);
    };
  };
  settle(kernel, returned, n);
  rest_ = strengths_;
  strengths_.row(0) += plane_strengths(a_, E_prime_, p, static_cast<int>(nodes_.size())).transpose();
}

void CrackLine::settle(const CrackKernel& kernel, const std::function<CrackLoad(int)>& load_of, int n) {
  const TipIntensities plane = plane_ ? plane_->K_I() : TipIntensities{};
  const auto solve_with = [&](int count) {
    solve(kernel, load_of(count), count);
    plus_.K_I += plane.plus;
    minus_.K_I += plane.minus;
  };
  if (n > 0) return solve_with(n);
  Intensities plus, minus;
  for (n = 32; n <= kMaxNodes; n *= 2) {
    solve_with(n);
    const double size = std::max({std::hypot(plus_.K_I, plus_.K_II), std::hypot(minus_.K_I, minus_.K_II), 1e-300});
    error_ = std::max(std::hypot(plus_.K_I - plus.K_I, plus_.K_II - plus.K_II),
                      std::hypot(minus_.K_I - minus.K_I, minus_.K_II - minus.K_II)) /
             size;
    if (error_ < 1e-11) return;
    plus = plus_;
    minus = minus_;
  }
}

void CrackLine::solve(const CrackKernel& kernel, const CrackLoad& load, int n) {
  nodes_ = node_places(a_, n);

  // Unknowns: the strengths s_j of n point dislocations, opening and slip.
  Eigen::MatrixXd A(2 * n, 2 * n);
  Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * n);
  for (int k = 1; k < n; ++k) {
    const double x = a_ * std::cos(k * pi / n);
    for (int j = 0; j < n; ++j)
      A.block<2, 2>(2 * (k - 1), 2 * j) = Eigen::Matrix2d::Identity() / (nodes_(j) - x) + kernel(nodes_(j), x);
    b.segment<2>(2 * (k - 1)) = -4 * pi / E_prime_ * load(x);
  }
  for (int j = 0; j < n; ++j) A.block<2, 2>(2 * (n - 1), 2 * j) = Eigen::Matrix2d::Identity() / a_;

  const Eigen::VectorXd s = A.partialPivLu().solve(b);
  if (!s.allFinite()) throw std::runtime_error("the crack's integral equation has no finite solution");
  strengths_ = Eigen::Map<const Eigen::Matrix2Xd>(s.data(), 2, n);

  // Krenk's interpolation of g to the ends; strengths are g pi/n.
  Eigen::Vector2d g_plus = Eigen::Vector2d::Zero();
  Eigen::Vector2d g_minus = Eigen::Vector2d::Zero();
  for (int j = 0; j < n; ++j) {
    const double half = 0.5 * node_angle(j, n);
    const double weight = std::sin((2 * n - 1) * half) / (std::sin(half) * pi);
    g_plus += weight * strengths_.col(j);
    g_minus += weight * strengths_.col(n - 1 - j);
  }
  const double scale = 0.25 * E_prime_ * std::sqrt(pi / a_);
  plus_ = {-scale * g_plus(0), -scale * g_plus(1)};
  minus_ = {scale * g_minus(0), scale * g_minus(1)};
}

Eigen::Vector2d CrackLine::jump(double x) const {
  if (std::abs(x) >= a_) return Eigen::Vector2d::Zero();
  const int n = static_cast<int>(nodes_.size());
  const double angle = std::acos(x / a_);
  // g = sum B_m T_m integrates to -sum B_m sin(m angle)/m.
  Eigen::Vector2d sum(plane_ ? plane_->opening(x) : 0.0, 0.0);
  for (int m = 1; m < n; ++m) {
    Eigen::Vector2d B = Eigen::Vector2d::Zero();
    for (int j = 0; j < n; ++j) B += rest_.col(j) * std::cos(m * node_angle(j, n));
    sum -= 2 / pi * B * std::sin(m * angle) / m;
  }
  return sum;
}

double CrackLine::volume() const {
  return -strengths_.row(0).dot(nodes_);
}

double max_hoop_angle(double K_I, double K_II) {
  if (K_II == 0) return 0.0;
  // The same root without its cancellation for small K_II.
  const double root = std::sqrt(K_I * K_I + 8 * K_II * K_II);
  return K_I > 0 ? 2 * std::atan(-2 * K_II / (K_I + root)) : 2 * std::atan((K_I - root) / (4 * K_II));
}

}  // namespace strata::reference
