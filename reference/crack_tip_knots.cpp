#include "crack_tip_knots.hpp"

#include <gsl/gsl_integration.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <numbers>

namespace strata::reference {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

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

// q from its slope for each column of f (N x m), 0 at the inlet.
MatrixXd integrated(const VectorXd& u, const MatrixXd& f) {
  const Index N = u.size();
  MatrixXd q(N + 1, f.cols());
  q.row(0).setZero();
  for (Index i = 0; i + 1 < N; ++i)
    q.row(i + 1) = q.row(i) - 0.5 * std::log(u(i) / u(i + 1)) * (f.row(i) + f.row(i + 1));
  q.row(N) = q.row(N - 1) - f.row(N - 1);  // the mean of ln(u/u_last) is -1
  return q;
}

}  // namespace

CrackTipKnots::CrackTipKnots(int knots)
    : N(knots), u(make_knots(knots)), opening(N, N + 1), K(toughness_functional(u)), ahead(volume_matrix(u)) {
  for (Index i = 0; i < N; ++i) opening.row(i) = opening_functional(u, u(i));
}

VectorXd CrackTipKnots::opening_at(double at) const {
  return opening_functional(u, at);
}

VectorXd CrackTipKnots::pressure(const VectorXd& f, double K_I) const {
  VectorXd q = integrated(u, f);
  q.array() += (K_I - K.dot(q)) / K.sum();
  return q;
}

TipFlow CrackTipKnots::flow(const VectorXd& v, const MatrixXd& G, const VectorXd& g, double K_I,
                            const Eigen::RowVectorXd& dK) const {
  const VectorXd u_v3 = u.array() / v.array().cube();
  const VectorXd f = (G * v + g).cwiseProduct(u_v3);
  TipFlow flow{pressure(f, K_I), {}, {}};
  flow.residual = (opening * flow.q).cwiseQuotient(v) - VectorXd::Ones(N);
  MatrixXd df = u_v3.asDiagonal() * G * v.asDiagonal();
  df.diagonal() -= 3 * f;
  MatrixXd dq = integrated(u, df);
  dq.rowwise() += (dK - K.transpose() * dq) / K.sum();
  flow.jacobian = v.cwiseInverse().asDiagonal() * (opening * dq);
  flow.jacobian.diagonal() -= flow.residual + VectorXd::Ones(N);
  return flow;
}

}  // namespace strata::reference
