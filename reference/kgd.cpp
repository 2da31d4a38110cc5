#include "kgd.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

// Below this K_m the zone near the tip where toughness shows is smaller than round-off, and Newton's method would not
// converge; the shape changes by 1e-8 from here to K_m = 0.
constexpr double kLeastToughness = 0.01;

void require_positive(std::initializer_list<double> values) {
  for (double value : values)
    if (!(value > 0) || !std::isfinite(value))
      throw std::invalid_argument("modulus, rate, time, viscosity and toughness must be positive and finite");
}

// Nodes and weights of the 10-point Gauss-Legendre rule on [0, 1].
struct GaussPoint {
  double at, weight;
};
const std::array<GaussPoint, 10>& gauss_rule() {
  static const std::array<GaussPoint, 10> rule = [] {
    std::array<GaussPoint, 10> points{};
    const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> table(
        gsl_integration_glfixed_table_alloc(points.size()), gsl_integration_glfixed_table_free);
    for (std::size_t i = 0; i < points.size(); ++i)
      gsl_integration_glfixed_point(0, 1, i, &points[i].at, &points[i].weight, table.get());
    return points;
  }();
  return rule;
}

// sqrt(1 - xi^2) of xi = 1 - u.
double root_of(double u) {
  return std::sqrt(u * (2 - u));
}

// ln|(r(u) + r(v))/(r(u) - r(v))| without cancellation near the tip: r(u)^2 - r(v)^2 = (u - v)(2 - u - v).
double symmetric_kernel(double u, double v) {
  const double r = root_of(u), s = root_of(v);
  const double sum = r + s;
  const double difference = std::abs((u - v) * (2 - u - v)) / sum;
  return difference == 0 ? 0.0 : std::log1p(2 * std::min(r, s) / difference);
}

// int from v = low to v = high of weight(v) {1, (ln v - ln low)/(ln high - ln low)} dv by Gauss's rule; with v^4 in
// place of v about `singular`, the place of a logarithm in the weight, if that lies in the interval or near it.
template <typename Weight>
std::array<double, 2> hat_moments(double low, double high, double singular, const Weight& weight) {
  std::array<double, 2> moments{0, 0};
  const double span = low > 0 ? std::log(high / low) : 1.0;
  const auto add = [&](double v, double dv) {
    const double value = weight(v) * dv;
    moments[0] += value;
    if (low > 0) moments[1] += value * std::log(v / low) / span;
  };
  const double width = high - low;
  if (singular < low - 0.5 * width || singular > high + 0.5 * width) {
    for (const GaussPoint& point : gauss_rule()) add(low + width * point.at, width * point.weight);
    return moments;
  }
  const double pole = std::clamp(singular, low, high);
  for (const double end : {low, high})
    for (const GaussPoint& point : gauss_rule()) {
      const double cube = point.at * point.at * point.at;
      add(pole + (end - pole) * cube * point.at, 4 * cube * std::abs(end - pole) * point.weight);
    }
  return moments;
}

// The functional int_0^1 P weight of P's values at the knots (linear in ln u) and of its mean beyond the last knot.
template <typename Weight>
VectorXd functional(const VectorXd& u, double singular, const Weight& weight) {
  const Index N = u.size();
  VectorXd row = VectorXd::Zero(N + 1);
  for (Index j = 0; j + 1 < N; ++j) {
    const auto moments = hat_moments(u(j + 1), u(j), singular, weight);
    row(j) += moments[1];
    row(j + 1) += moments[0] - moments[1];
  }
  row(N) = hat_moments(0, u(N - 1), singular, weight)[0];
  return row;
}

// V at xi = 1 - u as a functional of P.
VectorXd opening_functional(const VectorXd& knots, double u) {
  return 4 / pi * functional(knots, u, [u](double v) { return symmetric_kernel(u, v); });
}

// K_I as a functional of P: (2/sqrt(pi)) int_0^1 P/sqrt(1 - s^2) ds.
VectorXd toughness_functional(const VectorXd& knots) {
  VectorXd row = 2 / std::sqrt(pi) * functional(knots, 2, [](double v) { return 1 / root_of(v); });
  row(knots.size()) = 2 / std::sqrt(pi) * std::acos(1 - knots(knots.size() - 1));
  return row;
}

// Knots u = 1 - xi from 1 down to e^-kDepth: ln u by a cubic of the index, evenly spaced xi at the inlet.
VectorXd make_knots(int N) {
  constexpr double kDepth = 46, kInlet = 2.5;
  VectorXd u(N);
  for (int i = 0; i < N; ++i) {
    const double t = static_cast<double>(i) / (N - 1);
    u(i) = std::exp(-kInlet * t - (kDepth - kInlet) * t * t * t);
  }
  return u;
}

// int from u = b to u = a of u^(1/2) times the linear function that is f_a at a and f_b at b, as weights of (f_a, f_b).
std::array<double, 2> root_weights(double a, double b) {
  const double zeroth = (a * std::sqrt(a) - b * std::sqrt(b)) / 1.5;
  const double first = (a * a * std::sqrt(a) - b * b * std::sqrt(b)) / 2.5;
  const double at_b = (a * zeroth - first) / (a - b);
  return {zeroth - at_b, at_b};
}

// The matrix of int_xi^1 V at every knot, V taken as u^(1/2) times a linear function between knots.
MatrixXd volume_matrix(const VectorXd& u) {
  const Index N = u.size();
  MatrixXd ahead = MatrixXd::Zero(N, N);
  ahead(N - 1, N - 1) = u(N - 1) / 1.5;
  for (Index i = N - 2; i >= 0; --i) {
    const auto weights = root_weights(u(i), u(i + 1));
    ahead.row(i) = ahead.row(i + 1);
    ahead(i, i) += weights[0] / std::sqrt(u(i));
    ahead(i, i + 1) += weights[1] / std::sqrt(u(i + 1));
  }
  return ahead;
}

// The discrete equations of one toughness number, in v = V/s and q = P/s with s = (1 + c K_m)^(4/3), so that all is of
// the order of one for any K_m:  -v^3 q' = s^-3 [int v + (2/3) xi v],  K_I[q] = c K_m (2 s int_0^1 v)^(1/4)/s.
class ShapeEquations {
 public:
  ShapeEquations(const VectorXd& knots, double toughness_number)
      : u_(knots),
        N_(knots.size()),
        factor_(toughness_number * std::sqrt(pi / 32)),
        scale_(std::pow(1 + factor_, 4.0 / 3)),
        opening_(N_, N_ + 1),
        K_(toughness_functional(knots)),
        ahead_(volume_matrix(knots)) {
    for (Index i = 0; i < N_; ++i) opening_.row(i) = opening_functional(u_, u_(i));
    flux_ = ahead_;
    flux_.diagonal() += 2.0 / 3 * (1 - u_.array()).matrix();
  }

  double scale() const { return scale_; }
  // int_0^1 v.
  double volume(const VectorXd& v) const { return ahead_.row(0).dot(v); }
  // -dq/d ln u at the knots.
  VectorXd slope(const VectorXd& v) const {
    return (flux_ * v).cwiseProduct(u_).cwiseQuotient(v.array().cube().matrix()) / std::pow(scale_, 3);
  }

  // About the wider of an elliptic crack and one that is a viscous tip everywhere.
  VectorXd guess() const {
    const double ellipse = 4 / std::sqrt(pi) * factor_ / (1 + factor_);
    const double tip = std::cbrt(4.0 / 3) * std::pow(3.0, 5.0 / 6) / scale_;
    return u_.unaryExpr(
        [&](double u) { return std::cbrt(std::pow(ellipse * root_of(u), 3) + std::pow(tip, 3) * u * u); });
  }

  // q from v; with `step` also Newton's step of ln v.
  VectorXd pressure(const VectorXd& v, VectorXd* step = nullptr) const {
    const VectorXd f = slope(v);
    const double K = factor_ * std::pow(2 * scale_ * volume(v), 0.25) / scale_;
    VectorXd q = integrated(f);
    const double constant = (K - K_.dot(q)) / K_.sum();
    q.array() += constant;
    if (step == nullptr) return q;

    // Derivatives with respect to ln v, column by column.
    MatrixXd df = flux_ * v.asDiagonal();
    df.array().colwise() *= u_.array() / v.array().cube() / std::pow(scale_, 3);
    df.diagonal() -= 3 * f;
    MatrixXd dq(N_ + 1, N_);
    dq.row(0).setZero();
    for (Index i = 0; i + 1 < N_; ++i)
      dq.row(i + 1) = dq.row(i) - 0.5 * std::log(u_(i) / u_(i + 1)) * (df.row(i) + df.row(i + 1));
    dq.row(N_) = dq.row(N_ - 1) - df.row(N_ - 1);
    const Eigen::RowVectorXd dK = 0.25 * K / volume(v) * ahead_.row(0).cwiseProduct(v.transpose());
    dq.rowwise() += (dK - K_.transpose() * dq) / K_.sum();

    const VectorXd opened = opening_ * q;
    MatrixXd jacobian = opening_ * dq;
    jacobian.array().colwise() /= v.array();
    jacobian.diagonal() -= VectorXd::Ones(N_);
    *step = jacobian.partialPivLu().solve((v - opened).cwiseQuotient(v));
    return q;
  }

 private:
  // q from its slope, 0 at the inlet; the last value is the mean of q + f ln(u/u_last) beyond the last knot.
  VectorXd integrated(const VectorXd& f) const {
    VectorXd q = VectorXd::Zero(N_ + 1);
    for (Index i = 0; i + 1 < N_; ++i) q(i + 1) = q(i) - 0.5 * std::log(u_(i) / u_(i + 1)) * (f(i) + f(i + 1));
    q(N_) = q(N_ - 1) - f(N_ - 1);
    return q;
  }

  VectorXd u_;
  Index N_;
  double factor_, scale_;
  MatrixXd opening_;
  VectorXd K_;
  MatrixXd ahead_, flux_;
};

}  // namespace

KgdState kgd_toughness(double E_prime, double rate, double time, double toughness) {
  require_positive({E_prime, rate, time, toughness});
  KgdState state;
  state.half_length = std::pow(E_prime * rate * time / (2 * std::sqrt(pi) * toughness), 2.0 / 3);
  state.inlet_pressure = toughness / std::sqrt(pi * state.half_length);
  state.mouth_opening = 4 * state.inlet_pressure * state.half_length / E_prime;
  return state;
}

double kgd_toughness_number(double E_prime, double rate, double viscosity, double toughness) {
  require_positive({E_prime, rate, viscosity});
  return 4 * std::sqrt(2 / pi) * toughness / std::pow(12 * viscosity * rate * std::pow(E_prime, 3), 0.25);
}

KgdShape::KgdShape(double toughness_number, int knots) {
  if (knots < 50 || knots > 1000) throw std::invalid_argument("knots is outside [50, 1000]");
  if (!(toughness_number >= 0) || !std::isfinite(toughness_number))
    throw std::invalid_argument("the toughness number must not be negative, and finite");
  u_ = make_knots(knots);
  solve(toughness_number);
}

void KgdShape::solve(double toughness_number) {
  constexpr int kSteps = 100;
  constexpr double kLongest = 0.7;  // of a step in ln v
  const ShapeEquations equations(u_, std::max(toughness_number, kLeastToughness));
  VectorXd v = equations.guess();
  for (int i = 0; i < kSteps; ++i) {
    VectorXd step;
    equations.pressure(v, &step);
    if (!step.allFinite()) break;
    const double size = step.cwiseAbs().maxCoeff();
    v = v.cwiseProduct((step * std::min(1.0, kLongest / size)).array().exp().matrix());
    if (size < 1e-10) {
      P_ = equations.scale() * equations.pressure(v);
      tip_slope_ = equations.scale() * equations.slope(v)(u_.size() - 1);
      g_ = std::sqrt(0.5 / (equations.scale() * equations.volume(v)));
      return;
    }
  }
  throw std::runtime_error("the self-similar fracture did not converge");
}

double KgdShape::opening(double xi) const {
  const double u = 1 - std::abs(xi);
  return u > 0 ? g_ * opening_functional(u_, u).dot(P_) : 0.0;
}

double KgdShape::pressure(double xi) const {
  const double u = 1 - std::abs(xi);
  if (!(u > 0)) throw std::invalid_argument("the pressure is wanted at or beyond the tip");
  const Index last = u_.size() - 1;
  if (u < u_(last)) return P_(last) + tip_slope_ * std::log(u / u_(last));
  Index j = 0;
  while (j + 1 < last && u < u_(j + 1)) ++j;
  return P_(j) + (P_(j + 1) - P_(j)) * std::log(u_(j) / u) / std::log(u_(j) / u_(j + 1));
}

KgdState kgd_fracture(const KgdShape& shape, double E_prime, double rate, double time, double viscosity) {
  require_positive({E_prime, rate, time, viscosity});
  const double mu = 12 * viscosity;
  const double Q_3 = rate * rate * rate;
  KgdState state;
  state.half_length = shape.length_factor() * std::pow(Q_3 * E_prime * std::pow(time, 4) / mu, 1.0 / 6);
  state.mouth_opening = shape.opening(0) * std::pow(mu * Q_3 * time * time / E_prime, 1.0 / 6);
  state.inlet_pressure = shape.pressure(0) * std::cbrt(mu * E_prime * E_prime / time);
  return state;
}

}  // namespace strata::reference
