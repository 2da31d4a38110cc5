#include "kgd.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

void require_positive(std::initializer_list<double> values) {
  for (double value : values)
    if (!(value > 0) || !std::isfinite(value))
      throw std::invalid_argument("modulus, rate, time, viscosity and toughness must be positive and finite");
}

// The crack's pressure from its values at knots x_0 = 0 .. x_(N-1), linear between, and a mean over the last interval.
PressureKnots mirrored(const Eigen::VectorXd& x, const Eigen::VectorXd& P) {
  const Eigen::Index N = x.size() - 1;
  PressureKnots knots;
  const auto add = [&knots](double at, double value) {
    knots.x.push_back(at);
    knots.p.push_back(value);
  };
  add(-1, P(N));
  add(-x(N - 1), P(N));
  for (Eigen::Index i = N - 1; i > 0; --i) add(-x(i), P(i));
  for (Eigen::Index i = 0; i < N; ++i) add(x(i), P(i));
  add(x(N - 1), P(N));
  add(1, P(N));
  return knots;
}

struct Grid {
  Eigen::VectorXd x;        // knots, xi
  Eigen::VectorXd u;        // 1 - xi, exact near the tip
  Eigen::MatrixXd opening;  // at knot i for unit pressure at knot j (j = N: the last interval), a = E' = 1
  Eigen::VectorXd K;        // K_I for the same
  int tip = 0;              // from this knot on the opening is the tip's own
};

Grid make_grid(int N) {
  Grid grid{Eigen::VectorXd(N + 1), Eigen::VectorXd(N + 1), Eigen::MatrixXd(N, N + 1), Eigen::VectorXd(N + 1), 0};
  // Fourth power: the tip's (1-xi)^(2/3) is then resolved to 1e-5 and 1 - xi stays above round-off.
  for (int i = 0; i <= N; ++i) grid.u(i) = std::pow(1 - static_cast<double>(i) / N, 4);
  grid.x = 1 - grid.u.array();
  grid.tip = N - std::max(4, N / 25);
  for (int j = 0; j <= N; ++j) {
    // The hat of knot j alone, so that a row costs a few segments; the jump at the last knot is the interval's own.
    PressureKnots hat;
    if (j == N) {
      hat = {{-1, -grid.x(N - 1), -grid.x(N - 1), grid.x(N - 1), grid.x(N - 1), 1}, {1, 1, 0, 0, 1, 1}};
    } else {
      const double to = j + 1 < N ? grid.x(j + 1) : grid.x(j);
      const double from = j > 0 ? grid.x(j - 1) : 0;
      const double foot = j > 0 ? 0.0 : 1.0;
      hat = {{-to, -grid.x(j), -from, from, grid.x(j), to}, {0, 1, foot, foot, 1, 0}};
    }
    const LinearlyPressurisedCrack crack(1, 1, hat);
    grid.K(j) = crack.K_I().plus;
    for (int i = 0; i < N; ++i) grid.opening(i, j) = crack.opening(grid.x(i));
  }
  return grid;
}

Eigen::VectorXd powers(const Eigen::VectorXd& values, double exponent) {
  return values.unaryExpr([exponent](double value) { return std::pow(value, exponent); });
}

// int from u = b to u = a of (linear between f_a at a and f_b at b) u^power du, for a > b.
double weighted_integral(double a, double b, double f_a, double f_b, double power) {
  const double zeroth = (std::pow(a, power + 1) - std::pow(b, power + 1)) / (power + 1);
  const double first = (std::pow(a, power + 2) - std::pow(b, power + 2)) / (power + 2);
  return f_a * zeroth + (f_b - f_a) * (a * zeroth - first) / (a - b);
}

// int_xi^1 V at every knot, V taken as u^(2/3) times a linear function between knots.
Eigen::VectorXd fluid_ahead(const Grid& grid, const Eigen::VectorXd& V) {
  const Eigen::Index N = V.size();
  Eigen::VectorXd ahead = Eigen::VectorXd::Zero(N + 1);
  const Eigen::VectorXd h = V.cwiseQuotient(powers(grid.u.head(N), 2.0 / 3));
  for (Eigen::Index i = N - 1; i >= 0; --i)
    ahead(i) = ahead(i + 1) + weighted_integral(grid.u(i), grid.u(i + 1), h(i), i + 1 < N ? h(i + 1) : h(i), 2.0 / 3);
  return ahead;
}

// P at the knots and its mean over the last interval from lubrication, with the constant that makes K_I vanish.
Eigen::VectorXd lubrication_pressure(const Grid& grid, const Eigen::VectorXd& V, const Eigen::VectorXd& ahead) {
  const Eigen::Index N = V.size();
  // -P' = f u^(-4/3), f smooth.
  const Eigen::VectorXd flux = ahead.head(N) + 2.0 / 3 * grid.x.head(N).cwiseProduct(V);
  const Eigen::VectorXd f = flux.cwiseQuotient(powers(V, 3)).cwiseProduct(powers(grid.u.head(N), 4.0 / 3));
  Eigen::VectorXd P = Eigen::VectorXd::Zero(N + 1);
  for (Eigen::Index i = 0; i + 1 < N; ++i)
    P(i + 1) = P(i) - weighted_integral(grid.u(i), grid.u(i + 1), f(i), f(i + 1), -4.0 / 3);
  P(N) = P(N - 1) - 1.5 * f(N - 1) * std::pow(grid.u(N - 1), -1.0 / 3);
  const double constant = grid.K.dot(P) / grid.K.sum();
  return P.array() - constant;
}

struct Solution {
  PressureKnots pressure;
  double g = 0.0;
};

Solution solve_shape(int N) {
  const Grid grid = make_grid(N);
  const double tip_factor = std::cbrt(2.0 / 3) * std::cbrt(2.0) * std::pow(3.0, 5.0 / 6);
  const Eigen::VectorXd tip = tip_factor * powers(grid.u.head(N), 2.0 / 3);
  Eigen::VectorXd V = tip;
  for (int step = 0; step < 300; ++step) {
    const Eigen::VectorXd ahead = fluid_ahead(grid, V);
    const Eigen::VectorXd P = lubrication_pressure(grid, V, ahead);
    const Eigen::VectorXd opened = grid.opening * P;
    double change = 0.0;
    for (Eigen::Index i = 0; i < grid.tip; ++i) {
      // Doubling V quarters the opening that it causes: the exponents 2/3 and 1/3 make the two cancel.
      const double next = std::pow(V(i), 2.0 / 3) * std::cbrt(std::max(opened(i), 0.1 * V(i)));
      change = std::max(change, std::abs(next / V(i) - 1));
      V(i) = next;
    }
    if (change < 1e-12) return {mirrored(grid.x, P), std::sqrt(0.5 / ahead(0))};
  }
  throw std::runtime_error("the self-similar fracture did not converge");
}

Solution checked_solution(int knots) {
  if (knots < 60 || knots > 240) throw std::invalid_argument("knots is outside [60, 240]");
  return solve_shape(knots);
}

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

KgdViscosityShape::KgdViscosityShape(int knots) : crack_(1, 1, {{-1, 1}, {0, 0}}) {
  const Solution solution = checked_solution(knots);
  pressure_ = solution.pressure;
  crack_ = LinearlyPressurisedCrack(1, 1, pressure_);
  g_ = solution.g;
}

double KgdViscosityShape::opening(double xi) const {
  return g_ * crack_.opening(xi);
}

double KgdViscosityShape::pressure(double xi) const {
  return pressure_(xi);
}

KgdState kgd_viscosity(const KgdViscosityShape& shape, double E_prime, double rate, double time, double viscosity) {
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
