#include "kgd.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

void require_positive(std::initializer_list<double> values) {
  for (double value : values)
    if (!(value > 0) || !std::isfinite(value))
      throw std::invalid_argument("modulus, rate, time, viscosity and toughness must be positive and finite");
}

// The discrete equations of one toughness number, in v = V/s and q = P/s with s = (1 + c K_m)^(4/3), so that all is of
// the order of one for any K_m:  -v^3 q' = s^-3 [int v + (2/3) xi v],  K_I[q] = c K_m (2 s int_0^1 v)^(1/4)/s.
struct ShapeEquations {
  ShapeEquations(const CrackTipKnots& knots, double toughness_number)
      : line(knots), factor(toughness_number * std::sqrt(pi / 32)), scale(std::pow(1 + factor, 4.0 / 3)) {
    flux = line.ahead;
    flux.diagonal() += 2.0 / 3 * (1 - line.u.array()).matrix();
    flux /= std::pow(scale, 3);
  }

  // int_0^1 v.
  double volume(const VectorXd& v) const { return line.ahead.row(0).dot(v); }

  // About the wider of an elliptic crack and one that is a viscous tip everywhere.
  VectorXd guess() const {
    const double ellipse = 4 / std::sqrt(pi) * factor / (1 + factor);
    const double tip = std::cbrt(4.0 / 3) * std::pow(3.0, 5.0 / 6) / scale;
    return line.u.unaryExpr(
        [&](double u) { return std::cbrt(std::pow(ellipse * std::sqrt(u * (2 - u)), 3) + std::pow(tip, 3) * u * u); });
  }

  TipFlow flow(const VectorXd& v) const {
    const double K = factor * std::pow(2 * scale * volume(v), 0.25) / scale;
    const Eigen::RowVectorXd dK = 0.25 * K / volume(v) * line.ahead.row(0).cwiseProduct(v.transpose());
    return line.flow(v, flux, VectorXd::Zero(line.N), K, dK);
  }

  const CrackTipKnots& line;
  double factor, scale;
  MatrixXd flux;
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

KgdShape::KgdShape(double toughness_number, int knots) : line_(std::clamp(knots, 50, 1000)) {
  if (knots < 50 || knots > 1000) throw std::invalid_argument("knots is outside [50, 1000]");
  if (!(toughness_number >= 0) || !std::isfinite(toughness_number))
    throw std::invalid_argument("the toughness number must not be negative, and finite");
  solve(toughness_number);
}

void KgdShape::solve(double toughness_number) {
  constexpr int kSteps = 100;
  constexpr double kLongest = 0.7;  // of a step in ln v
  const ShapeEquations equations(line_, std::max(toughness_number, least_toughness));
  VectorXd v = equations.guess();
  for (int i = 0; i < kSteps; ++i) {
    const TipFlow flow = equations.flow(v);
    const VectorXd step = flow.jacobian.partialPivLu().solve(-flow.residual);
    if (!step.allFinite()) break;
    const double size = step.cwiseAbs().maxCoeff();
    v = v.cwiseProduct((step * std::min(1.0, kLongest / size)).array().exp().matrix());
    if (size < 1e-10) {
      P_ = equations.scale * equations.flow(v).q;
      g_ = std::sqrt(0.5 / (equations.scale * equations.volume(v)));
      return;
    }
  }
  throw std::runtime_error("the self-similar fracture did not converge");
}

double KgdShape::opening(double xi) const {
  const double u = 1 - std::abs(xi);
  return u > 0 ? g_ * line_.opening_at(u).dot(P_) : 0.0;
}

double KgdShape::pressure(double xi) const {
  const double u = 1 - std::abs(xi);
  if (!(u > 0)) throw std::invalid_argument("the pressure is wanted at or beyond the tip");
  const VectorXd& knots = line_.u;
  const Index last = line_.N - 1;  // from there on the slope dP/d ln u stays, and the mean is less by as much
  if (u < knots(last)) return P_(last) + (P_(last) - P_(last + 1)) * std::log(u / knots(last));
  Index j = 0;
  while (j + 1 < last && u < knots(j + 1)) ++j;
  return P_(j) + (P_(j + 1) - P_(j)) * std::log(knots(j) / u) / std::log(knots(j) / knots(j + 1));
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
