#include "finite_plate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

constexpr int kMaxTerms = 96;

// Value and two derivatives of a function of Z.
struct Jet {
  Complex f, d, dd;
};

Jet operator*(const Jet& a, const Jet& b) {
  return {a.f * b.f, a.d * b.f + a.f * b.d, a.dd * b.f + 2.0 * a.d * b.d + a.f * b.dd};
}

// sqrt(Z^2 - a^2) with its cut along the crack, and its derivatives.
Jet crack_root(Complex Z, double a) {
  const Complex r = std::sqrt(Z - a) * std::sqrt(Z + a);
  return {r, Z / r, -a * a / (r * r * r)};
}

// The first `count` Chebyshev polynomials of the ellipse through the block, monic over capacity^n, so that all are of
// the order of one on its edges: q_(n+1) = (Z/c) q_n - beta q_(n-1), q_0 = 1, q_1 = Z/c, q_2 = (Z/c)^2 - 2 beta.
std::vector<Jet> polynomials(Complex Z, int count, double capacity, double beta) {
  const Jet z{Z / capacity, 1 / capacity, 0};
  std::vector<Jet> q{{1, 0, 0}, z};
  while (static_cast<int>(q.size()) < count) {
    const Jet& last = q[q.size() - 1];
    const Jet& before = q[q.size() - 2];
    const double b = q.size() == 2 ? 2 * beta : beta;
    Jet next = z * last;
    next.f -= b * before.f;
    next.d -= b * before.d;
    next.dd -= b * before.dd;
    q.push_back(next);
  }
  return q;
}

// Stress and displacement of one pair of potentials phi = f + g, omega = f - g at Z, turned to the block's axes (Y is
// its x). Real coefficients give omega(conj Z) = conj(omega(Z)).
BlockCrack::Field field_of(const Jet& f, const Jet& g, Complex Z, double kappa) {
  const Complex Phi = f.d + g.d;
  const Complex two_iY = Z - std::conj(Z);
  const Complex normal = Phi + std::conj(f.d - g.d) + two_iY * std::conj(f.dd + g.dd);
  const Complex u = kappa * (f.f + g.f) - std::conj(f.f - g.f) - two_iY * std::conj(Phi);
  const double s_YY = normal.real();
  return {s_YY, 4 * Phi.real() - s_YY, -normal.imag(), u.imag(), u.real()};
}

// The two residuals of an edge: across the crack's axis (side, Y constant) or along it (top, X constant).
struct EdgePoint {
  Complex Z;
  bool side;
  bool fixed;
  double weight;
};

std::array<double, 2> edge_conditions(const BlockCrack::Field& s, const EdgePoint& point, double length) {
  const double normal_stress = point.side ? s.s_xx : s.s_yy;
  const double normal_displacement = point.side ? s.u_x : s.u_y;
  return {point.fixed ? normal_displacement / length : normal_stress, s.s_xy};
}

// Points of the first quadrant's two edges, `count` on each, denser towards the corner.
std::vector<EdgePoint> edge_points(const Block& block, int count) {
  std::vector<EdgePoint> points;
  for (int i = 0; i < count; ++i) {
    const double angle = (i + 0.5) * pi / (2 * count);
    const double s = std::sin(angle);
    const double weight = std::sqrt(std::cos(angle));
    points.push_back({{s * block.half_height, block.width / 2}, true, block.sides == EdgeHold::fixed, weight});
    points.push_back({{block.half_height, s * block.width / 2}, false, block.top == EdgeHold::fixed, weight});
  }
  return points;
}

void check_block(const Block& block) {
  const bool finite = std::isfinite(block.width) && std::isfinite(block.half_height) && std::isfinite(block.half_crack);
  if (!finite || block.width <= 0 || block.half_height <= 0 || block.half_crack <= 0)
    throw std::invalid_argument("width, half_height and half_crack must be positive and finite");
  if (block.half_crack > 0.9 * block.half_height)
    throw std::invalid_argument("half_crack must not exceed 0.9 half_height");
  if (block.width < 0.5 * block.half_crack) throw std::invalid_argument("width must be at least half of half_crack");
  if (!(block.poisson_ratio >= 0 && block.poisson_ratio < 0.5))
    throw std::invalid_argument("poisson_ratio is outside [0, 0.5)");
}

// The block with ends drawn in that the crack does not feel; see the header.
Block drawn_in(Block block) {
  constexpr double kFar = 2.0;
  if (block.sides == EdgeHold::traction) block.width = std::min(block.width, 2 * kFar * 2 * block.half_height);
  if (block.sides == EdgeHold::traction || block.top == EdgeHold::traction)
    block.half_height = std::min(block.half_height, block.half_crack + kFar * block.width);
  return block;
}

// theta of s = a sin(theta) for the points that lie on the crack.
std::vector<double> to_angles(const std::vector<double>& points, double a) {
  std::vector<double> angles;
  for (double s : points)
    if (std::abs(s) < a) angles.push_back(std::asin(s / a));
  return angles;
}

}  // namespace

BlockCrack::BlockCrack(const Block& block, int terms) : block_(block), kappa_(3 - 4 * block.poisson_ratio) {
  check_block(block);
  block_ = drawn_in(block);
  const double along = block_.half_height;
  const double across = block_.width / 2;
  capacity_ = 0.5 * (along + across);
  beta_ = (along * along - across * across) / (4 * capacity_ * capacity_);
  if (terms > 0) {
    solve(terms);
    return;
  }
  const double floor = block_.width < block.width || block_.half_height < block.half_height ? 1e-7 : 0.0;
  double previous = 0.0;
  for (int n = 12; n <= kMaxTerms; n *= 2) {
    solve(n);
    const double change = std::abs(F() - previous);
    F_error_ = std::max(change, floor);
    if (change < 1e-9) return;
    previous = F();
  }
}

void BlockCrack::solve(int terms) {
  const auto points = edge_points(block_, 3 * terms);
  const auto rows = static_cast<Eigen::Index>(2 * points.size());
  Eigen::MatrixXd A(rows, 2 * terms);
  Eigen::VectorXd b(rows);
  Eigen::Index row = 0;
  for (const EdgePoint& point : points) {
    const auto q = polynomials(point.Z, 2 * terms, capacity_, beta_);
    const Jet root = crack_root(point.Z, block_.half_crack);
    const auto put = [&](const Field& s, auto&& target) {
      const auto residual = edge_conditions(s, point, capacity_);
      target(row) = point.weight * residual[0];
      target(row + 1) = point.weight * residual[1];
    };
    for (int k = 0; k < terms; ++k) {
      const Jet even = q[static_cast<std::size_t>(2 * k)] * root;
      const Jet odd = q[static_cast<std::size_t>(2 * k + 1)];
      put(field_of(even, {}, point.Z, kappa_), A.col(k));
      put(field_of({}, odd, point.Z, kappa_), A.col(terms + k));
    }
    put(field_of({-0.5 * point.Z, -0.5, 0}, {}, point.Z, kappa_), b);
    row += 2;
  }
  const Eigen::VectorXd scale = A.colwise().norm().cwiseInverse().transpose();
  const Eigen::VectorXd x = scale.cwiseProduct((A * scale.asDiagonal()).colPivHouseholderQr().solve(-b));
  even_.assign(x.data(), x.data() + terms);
  odd_.assign(x.data() + terms, x.data() + 2 * terms);
}

double BlockCrack::F() const {
  return K_I(1.0) / std::sqrt(pi * block_.half_crack);
}

double BlockCrack::amplitude(double s) const {
  const auto q = polynomials(s, 2 * terms(), capacity_, beta_);
  double E = 0.0;
  for (std::size_t k = 0; k < even_.size(); ++k) E += even_[k] * q[2 * k].f.real();
  return E;
}

double BlockCrack::K_I(double p) const {
  return 2 * amplitude(block_.half_crack) * p * std::sqrt(pi * block_.half_crack);
}

double BlockCrack::opening(double s, double p, double E_prime) const {
  const double a = block_.half_crack;
  return std::abs(s) < a ? 8 * p / E_prime * amplitude(s) * std::sqrt((a - s) * (a + s)) : 0.0;
}

double BlockCrack::volume(double p, double E_prime) const {
  // Gauss-Chebyshev rule of the second kind, exact for polynomials times sqrt(a^2 - s^2) up to degree 2n - 1.
  const int n = 2 * terms();
  const double a = block_.half_crack;
  double sum = 0.0;
  for (int j = 1; j <= n; ++j) {
    const double angle = j * pi / (n + 1);
    sum += opening(a * std::cos(angle), p, E_prime) * std::sin(angle);
  }
  return a * pi / (n + 1) * sum;
}

double BlockCrack::critical_pressure(double K_Ic) const {
  return K_Ic / K_I(1.0);
}

BlockCrack::Field BlockCrack::field(double x, double y) const {
  const Complex Z(y, x);
  if (std::abs(x) > block_.width / 2 || std::abs(y) > block_.half_height) return {0, 0, 0, 0, 0};
  const auto q = polynomials(Z, 2 * terms(), capacity_, beta_);
  const Jet root = crack_root(Z, block_.half_crack);
  Jet f{-0.5 * Z, -0.5, 0};
  Jet g{};
  for (std::size_t k = 0; k < even_.size(); ++k) {
    const Jet even = q[2 * k] * root;
    const Jet& odd = q[2 * k + 1];
    f = {f.f + even_[k] * even.f, f.d + even_[k] * even.d, f.dd + even_[k] * even.dd};
    g = {g.f + odd_[k] * odd.f, g.d + odd_[k] * odd.d, g.dd + odd_[k] * odd.dd};
  }
  return field_of(f, g, Z, kappa_);
}

double BlockCrack::edge_residual() const {
  double worst = 0.0;
  constexpr int kPoints = 200;
  for (int i = 0; i < kPoints; ++i) {
    const double s = (i + 0.5) / kPoints;
    const EdgePoint side{{s * block_.half_height, block_.width / 2}, true, block_.sides == EdgeHold::fixed, 1};
    const EdgePoint top{{block_.half_height, s * block_.width / 2}, false, block_.top == EdgeHold::fixed, 1};
    for (const EdgePoint& point : {side, top}) {
      const auto residual = edge_conditions(field(point.Z.imag(), point.Z.real()), point, capacity_);
      worst = std::max({worst, std::abs(residual[0]), std::abs(residual[1])});
    }
  }
  return worst;
}

double block_K_I(const Block& block, const Function& p, const std::vector<double>& kinks) {
  const double a = block.half_crack;
  // The solution is smooth in a, so a wide difference of fourth order (own error 1e-8) keeps the round-off of E small.
  const double da = 1e-2 * a;
  const BlockCrack centre(block);
  const auto neighbour = [&](int steps) {
    Block other = block;
    other.half_crack = a + steps * da;
    return BlockCrack(other, centre.terms());
  };
  const std::array<BlockCrack, 4> around{neighbour(-2), neighbour(-1), neighbour(1), neighbour(2)};
  // E' w_1 = 8 E(s, a) sqrt(a^2 - s^2): the root, which carries the tip, is differentiated by hand. s = a sin(theta).
  const auto integrand = [&](double theta) {
    const double s = a * std::sin(theta);
    const double root = a * std::cos(theta);
    const double slope =
        (around[0].amplitude(s) - 8 * around[1].amplitude(s) + 8 * around[2].amplitude(s) - around[3].amplitude(s)) /
        (12 * da);
    return 4 * p(s) * (centre.amplitude(s) * a + slope * root * root);
  };
  return integrate(integrand, 0, pi / 2, to_angles(kinks, a), 1e-9).value / centre.K_I(1);
}

double block_volume(const Block& block, double E_prime, const Function& p, const std::vector<double>& kinks) {
  const BlockCrack crack(block);
  const double a = block.half_crack;
  const auto integrand = [&](double theta) {
    const double s = a * std::sin(theta);
    return p(s) * crack.opening(s, 1, E_prime) * a * std::cos(theta);
  };
  return 2 * integrate(integrand, 0, pi / 2, to_angles(kinks, a)).value;
}

}  // namespace strata::reference
