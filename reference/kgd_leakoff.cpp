#include "kgd_leakoff.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <vector>

namespace strata::reference {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;

void require(bool sound, const char* what) {
  if (!sound) throw std::invalid_argument(what);
}

// The length L(sigma) at the ends of the steps so far, and when the tip was where.
class LengthHistory {
 public:
  explicit LengthHistory(double L) : sigma_{0.0}, log_L_{std::log(L)}, slope_{0.0}, bend_{0.0} {}

  // Adds, or with `again` replaces, the end of a step; ln L is then ln L_k + slope (s - sigma_k) + bend (s - sigma_k)^2
  // back to the end before.
  void set(double sigma, double log_L, bool again) {
    if (again) sigma_.pop_back(), log_L_.pop_back(), slope_.pop_back(), bend_.pop_back();
    const std::size_t k = sigma_.size();
    const double d1 = sigma - sigma_[k - 1], first = (log_L - log_L_[k - 1]) / d1;
    double bend = 0.0;
    if (k > 1) {
      const double d2 = sigma_[k - 1] - sigma_[k - 2], second = (log_L_[k - 1] - log_L_[k - 2]) / d2;
      bend = (first - second) / (d1 + d2);
    }
    sigma_.push_back(sigma), log_L_.push_back(log_L), slope_.push_back(first + bend * d1), bend_.push_back(bend);
  }

  // 1 - t_0/t where the tip was at a length of 1 - u of the last one, u in (0, 1].
  double age(double u) const {
    if (u >= 1.0) return 1.0;
    const std::size_t n = sigma_.size() - 1;
    std::size_t k = n;
    double target = std::log1p(-u);  // ln of the length over that at the end k
    for (; k > 1; --k) {
      const double fall = 4.0 * std::log(sigma_[k - 1] / sigma_[k]) + log_L_[k - 1] - log_L_[k];
      if (target >= fall) break;
      target -= fall;
    }
    double z = target / 4.0;  // ln of sigma over that at the end k
    for (int i = 0; i < 50; ++i) {
      const double back = sigma_[k] * std::expm1(z);
      const double off = 4.0 * z + slope_[k] * back + bend_[k] * back * back - target;
      const double change = off / (4.0 + (slope_[k] + 2.0 * bend_[k] * back) * (back + sigma_[k]));
      z -= change;
      if (std::abs(change) <= 1e-14 * std::abs(z)) break;
    }
    return -std::expm1(6.0 * (z + std::log(sigma_[k] / sigma_[n])));
  }

 private:
  std::vector<double> sigma_, log_L_, slope_, bend_;
};

// A fracture of one toughness number on its way in sigma. Unknown: ln V at the knots, and behind them ln L.
class LeakoffMarch {
 public:
  LeakoffMarch(double toughness_number, int knots)
      : shape_(toughness_number, knots),
        line_(shape_.knots()),
        toughness_(std::max(toughness_number, KgdShape::least_toughness) * std::sqrt(pi / 32)),
        xi_(1.0 - line_.u.array()),
        history_(shape_.length_factor()) {
    x_.resize(line_.N + 1);
    x_ << (shape_.openings() / shape_.length_factor()).array().log(), std::log(shape_.length_factor());
    stored_.push_back(at(0.0, x_).contents);
    before_ = x_;
  }

  // `steps` steps to sigma.
  void to(double sigma, int steps) {
    const double h = std::log1p(sigma) / steps;
    for (int k = 1; k <= steps; ++k) step(std::expm1(k * h), h, k == 1);
  }

  double L() const { return std::exp(x_(line_.N)); }
  double V_at_mouth() const { return std::exp(x_(0)); }
  double P_at_mouth() const { return P_at_mouth_; }
  double efficiency() const { return 2.0 * L() * L() * line_.ahead.row(0).dot(V(x_)); }

 private:
  VectorXd V(const VectorXd& x) const { return x.head(line_.N).array().exp(); }

  struct Contents {
    double L;
    VectorXd V, b;      // at the knots
    VectorXd contents;  // L J
  };
  Contents at(double sigma, const VectorXd& x) {
    Contents c{std::exp(x(line_.N)), V(x), VectorXd::Zero(line_.N), {}};
    if (sigma > 0.0) {
      history_.set(sigma, x(line_.N), started_);
      started_ = true;
      c.b = line_.u.unaryExpr([&](double u) { return 2.0 * std::sqrt(history_.age(u)); });
    }
    c.contents = c.L * (line_.ahead * (c.L * c.V + sigma * c.b));
    return c;
  }

  struct Equations {
    VectorXd residual;  // of the knots, and of the whole volume
    MatrixXd jacobian;  // but for its last column
    double P_at_mouth;
  };
  // d/dsigma = rate (c0 now - old), old: L J and L of the steps before.
  Equations equations(double sigma, double c0, const VectorXd& old, double old_L, const VectorXd& x) {
    const Index N = line_.N;
    const Contents c = at(sigma, x);
    const double L = c.L, share = sigma / 6.0, dL = c0 * L - old_L;
    const VectorXd leaked = sigma * c.b / L, into = xi_ * (2.0 / 3.0 + share * dL / L);
    MatrixXd G = (1.0 + share * c0) * line_.ahead;
    const VectorXd g = G * leaked + into.cwiseProduct(leaked) - share / (L * L) * old;
    G.diagonal() += into;
    const TipFlow flow = line_.flow(c.V, G, g, toughness_ / std::sqrt(L), Eigen::RowVectorXd::Zero(N));
    Equations e{VectorXd(N + 1), MatrixXd::Zero(N + 1, N + 1), flow.q(0)};
    e.residual << flow.residual, c.contents(0) - 0.5;
    e.jacobian.topLeftCorner(N, N) = flow.jacobian;
    e.jacobian.row(N).head(N) = L * L * line_.ahead.row(0).cwiseProduct(c.V.transpose());
    return e;
  }

  void step(double sigma, double h, bool first) {
    constexpr int kSteps = 60;
    constexpr double kLongest = 0.7, kSmall = 1e-7;  // of a step, and the one that tells a slope
    const std::size_t n = stored_.size();
    const double dy = 1.0 / ((1.0 + sigma) * h), c0 = (first ? 1.0 : 1.5) * dy;
    const double L_1 = std::exp(x_(line_.N)), L_2 = std::exp(before_(line_.N));
    const VectorXd old =
        first ? VectorXd(dy * stored_[n - 1]) : VectorXd(dy * (2.0 * stored_[n - 1] - 0.5 * stored_[n - 2]));
    const double old_L = first ? dy * L_1 : dy * (2.0 * L_1 - 0.5 * L_2);
    VectorXd x = 2.0 * x_ - before_;
    started_ = false;
    for (int i = 0; i < kSteps; ++i) {
      VectorXd aside = x;
      aside(line_.N) += kSmall;
      const VectorXd beside = equations(sigma, c0, old, old_L, aside).residual;
      Equations e = equations(sigma, c0, old, old_L, x);
      e.jacobian.col(line_.N) = (beside - e.residual) / kSmall;
      const VectorXd change = e.jacobian.partialPivLu().solve(-e.residual);
      if (!change.allFinite()) break;
      const double size = change.cwiseAbs().maxCoeff();
      x += std::min(1.0, kLongest / size) * change;
      if (size < 1e-9) {
        stored_.push_back(at(sigma, x).contents);
        before_ = x_;
        x_ = x;
        P_at_mouth_ = e.P_at_mouth;
        return;
      }
    }
    throw std::runtime_error("the fracture with leak-off did not converge");
  }

  KgdShape shape_;
  const CrackTipKnots& line_;
  double toughness_;  // K_I sqrt(L)
  VectorXd xi_;
  LengthHistory history_;
  bool started_ = false;          // the history has an end for the present step
  std::vector<VectorXd> stored_;  // L J at the ends of the steps
  VectorXd x_, before_;           // at the last two
  double P_at_mouth_ = shape_.pressure(0);
};

// l of a fracture without viscosity at equal steps of t^(1/3), t_0 linear in x in between.
class UniformFracture {
 public:
  UniformFracture(double E_prime, double rate, double toughness, double leakoff, double end, int steps)
      : stiffness_(2.0 * std::sqrt(pi) * toughness / E_prime), leakoff_(leakoff) {
    for (int j = 1; j <= steps; ++j) {
      const double t = end * std::pow(static_cast<double>(j) / steps, 3);
      const double taken = leaked(t), l = x_.back(), dt = t - t_.back();
      // V + taken + (16/3) C_L (x - l) sqrt(dt) = Q_0 t rises with x: Newton's method from above comes down to it.
      double x = std::pow(rate * t / stiffness_, 2.0 / 3.0);
      for (int i = 0; i < 100; ++i) {
        const double slope = 1.5 * stiffness_ * std::sqrt(x) + 16.0 / 3.0 * leakoff * std::sqrt(dt);
        const double off = volume(x) + taken + 16.0 / 3.0 * leakoff * (x - l) * std::sqrt(dt) - rate * t;
        x -= off / slope;
        if (std::abs(off) <= 1e-15 * rate * t) break;
      }
      x_.push_back(x), t_.push_back(t);
    }
  }

  double length() const { return x_.back(); }
  double volume(double l) const { return stiffness_ * l * std::sqrt(l); }

  // 4 C' int_0^l sqrt(t - t_0(x)) dx, C' = 2 C_L (m^2).
  double leaked(double t) const {
    double sum = 0.0;
    for (std::size_t j = 1; j < x_.size(); ++j) {
      const double early = t - t_[j - 1], late = std::max(0.0, t - t_[j]), a = std::sqrt(early), b = std::sqrt(late);
      sum += (x_[j] - x_[j - 1]) * (early + a * b + late) / (a + b);  // (early^1.5 - late^1.5)/(early - late)
    }
    return 16.0 / 3.0 * leakoff_ * sum;
  }

 private:
  double stiffness_, leakoff_;
  std::vector<double> x_{0.0}, t_{0.0};
};

}  // namespace

KgdLeakoffState kgd_leakoff_once(double E_prime, double rate, double time, double viscosity, double toughness,
                                 double leakoff, int knots, int steps) {
  require(leakoff >= 0 && std::isfinite(leakoff), "leak-off must not be negative, and finite");
  require(time > 0 && std::isfinite(time), "the time must be positive and finite");
  require(steps >= 4 && steps <= 1000, "steps is outside [4, 1000]");
  const double C = 2.0 * leakoff, mu = 12.0 * viscosity, Q_3 = std::pow(rate, 3);
  LeakoffMarch march(kgd_toughness_number(E_prime, rate, viscosity, toughness), knots);
  const double sigma = C * std::pow(E_prime * time / (mu * Q_3), 1.0 / 6);
  if (sigma > 0.0) march.to(sigma, steps);
  KgdLeakoffState state;
  state.half_length = march.L() * std::pow(Q_3 * E_prime * std::pow(time, 4) / mu, 1.0 / 6);
  state.mouth_opening = march.L() * march.V_at_mouth() * std::pow(mu * Q_3 * time * time / E_prime, 1.0 / 6);
  state.inlet_pressure = march.P_at_mouth() * std::cbrt(mu * E_prime * E_prime / time);
  state.efficiency = march.efficiency();
  return state;
}

SettledLeakoff kgd_leakoff(double E_prime, double rate, double time, double viscosity, double toughness,
                           double leakoff) {
  constexpr int kKnots = 160, kSteps = 48;
  const auto once = [&](int knots, int steps) {
    return kgd_leakoff_once(E_prime, rate, time, viscosity, toughness, leakoff, knots, steps);
  };
  const KgdLeakoffState fine = once(kKnots, kSteps), by_knots = once(kKnots / 2, kSteps),
                        by_steps = once(kKnots, kSteps / 2);
  SettledLeakoff settled{fine, 1e-9};
  using Value = double KgdLeakoffState::*;
  for (const Value value : {Value(&KgdState::half_length), Value(&KgdState::mouth_opening),
                            Value(&KgdState::inlet_pressure), &KgdLeakoffState::efficiency}) {
    const double knots = (fine.*value - by_knots.*value) / 3.0, steps = (fine.*value - by_steps.*value) / 3.0;
    settled.state.*value += knots + steps;
    settled.error = std::max(settled.error, (std::abs(knots) + std::abs(steps)) / std::abs(settled.state.*value));
  }
  return settled;
}

ShutInState shut_in_fracture(double E_prime, double rate, double shut_in, double toughness, double leakoff, double time,
                             int steps) {
  for (const double value : {E_prime, rate, shut_in, toughness, time})
    require(value > 0 && std::isfinite(value), "modulus, rate, times and toughness must be positive and finite");
  require(leakoff >= 0 && std::isfinite(leakoff), "leak-off must not be negative, and finite");
  require(steps >= 8 && steps % 2 == 0 && steps <= 100000, "steps is odd or outside [8, 100000]");
  const double end = std::min(time, shut_in);
  const UniformFracture half(E_prime, rate, toughness, leakoff, end, steps / 2);
  const UniformFracture whole(E_prime, rate, toughness, leakoff, end, steps);
  const auto extrapolated = [](double coarse, double fine) { return fine + (fine - coarse) / 3.0; };
  ShutInState state;
  state.half_length = extrapolated(half.length(), whole.length());
  state.leaked = std::min(rate * end, extrapolated(half.leaked(time), whole.leaked(time)));
  const double volume = rate * end - state.leaked, l = state.half_length;
  state.inlet_pressure = volume * E_prime / (2.0 * pi * l * l);
  state.mouth_opening = 4.0 * state.inlet_pressure * l / E_prime;
  state.efficiency = volume / (rate * end);
  return state;
}

}  // namespace strata::reference
