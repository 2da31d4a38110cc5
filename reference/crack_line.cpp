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

}  // namespace

CrackLine::CrackLine(double half_length, double E_prime, const CrackKernel& kernel, const CrackLoad& load, int n)
    : a_(half_length), E_prime_(E_prime) {
  if (!(a_ > 0 && E_prime_ > 0) || !std::isfinite(a_) || !std::isfinite(E_prime_))
    throw std::invalid_argument("half_length and E_prime must be positive and finite");
  if (n > 0) {
    solve(kernel, load, n);
    return;
  }
  Intensities plus, minus;
  for (n = 32; n <= kMaxNodes; n *= 2) {
    solve(kernel, load, n);
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
  nodes_.resize(n);
  for (int j = 0; j < n; ++j) nodes_(j) = a_ * std::cos(node_angle(j, n));

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
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (int m = 1; m < n; ++m) {
    Eigen::Vector2d B = Eigen::Vector2d::Zero();
    for (int j = 0; j < n; ++j) B += strengths_.col(j) * std::cos(m * node_angle(j, n));
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
