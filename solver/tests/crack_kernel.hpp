// A straight crack in an infinite plane as the rock under a pressure, by Sneddon's closed form for a pressure constant
// in each cell; nothing of the solver's mechanics is in it.
#pragma once

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "flow/reynolds_flow.hpp"

namespace strata::test {

// The crack -a < x < a, loaded on cells of lengths h: those of x > 0, the others being their mirror images, or all.
// With C the mean opening of a cell for unit pressure in another one,
//   w = C (P - closing + t),  t >= 0, w >= 0, t w = 0 (the faces touch),
//   opening at x for unit pressure from s_1 to s_2: (4/(pi E')) [(s-x) G + sqrt(a^2-x^2) asin(s/a)], s = s_1 to s_2,
//   G = arccosh((a^2 - x s)/(a |x-s|)); K_I at a: (pi a)^(-1/2) [a asin(s/a) - sqrt(a^2-s^2)].
// Source: Sneddon 1946, Proc. R. Soc. Lond. A 187, 229; Tada, Paris & Irwin, The stress analysis of cracks handbook.
class CrackKernel {
 public:
  CrackKernel(double E_prime, double closing, const std::vector<double>& h, bool mirrored)
      : E_prime_(E_prime), closing_(closing), mirrored_(mirrored) {
    for (const double piece : h) a_ += mirrored ? piece : 0.5 * piece;
    edges_.push_back(mirrored ? 0.0 : -a_);
    for (const double piece : h) edges_.push_back(edges_.back() + piece);
    edges_.back() = a_;
    const Eigen::Index n = static_cast<Eigen::Index>(h.size());
    C_.resize(n, n);
    K_.resize(n);
    for (Eigen::Index j = 0; j < n; ++j) {
      K_(j) = both(j, [this](double s) { return weight(s); });
      for (Eigen::Index i = 0; i < n; ++i) C_(i, j) = mean_opening(i, j);
    }
  }

  double half_length() const { return a_; }
  const Eigen::MatrixXd& compliance() const { return C_; }  // m/Pa

  // Openings (m) at P (Pa), their change with P (m/Pa), and K_I at the tip x = a (Pa sqrt(m)).
  RockResponse operator()(const Eigen::VectorXd& P) const { return respond(P).rock; }
  // K_I of a closed tip is 0: the mean opening of its cell is what closes there, and its K a little off.
  double K_I(const Eigen::VectorXd& P) const {
    const Response r = respond(P);
    return r.rock.w(P.size() - 1) > 0.0 ? K_.dot(r.net) : 0.0;
  }

  // Opening at x (m).
  double opening(const Eigen::VectorXd& P, double x) const {
    const Eigen::VectorXd net = respond(P).net;
    double w = 0.0;
    for (Eigen::Index j = 0; j < net.size(); ++j) w += net(j) * both(j, [&](double s) { return primitive(x, s); });
    return w;
  }

 private:
  struct Response {
    RockResponse rock;
    Eigen::VectorXd net;  // P - closing + t (Pa)
  };

  double weight(double s) const {
    return (a_ * std::asin(s / a_) - std::sqrt(std::max(0.0, a_ * a_ - s * s))) / std::sqrt(std::numbers::pi * a_);
  }
  double primitive(double x, double s) const {
    const double root = std::sqrt(std::max(0.0, a_ * a_ - x * x)) * std::asin(s / a_);
    if (std::abs(s - x) < 1e-14 * a_) return 4.0 / (std::numbers::pi * E_prime_) * root;
    const double G = std::acosh(std::max(1.0, (a_ * a_ - x * s) / (a_ * std::abs(x - s))));
    return 4.0 / (std::numbers::pi * E_prime_) * ((s - x) * G + root);
  }
  // A primitive over cell j, and over its image.
  template <class F>
  double both(Eigen::Index j, const F& f) const {
    const double from = edges_[static_cast<std::size_t>(j)], to = edges_[static_cast<std::size_t>(j) + 1];
    return f(to) - f(from) + (mirrored_ ? f(-from) - f(-to) : 0.0);
  }
  double mean_opening(Eigen::Index i, Eigen::Index j) const {
    constexpr double at[4] = {-0.8611363115940526, -0.3399810435848563, 0.3399810435848563, 0.8611363115940526};
    constexpr double of[4] = {0.1739274225687269, 0.3260725774312731, 0.3260725774312731, 0.1739274225687269};
    const double from = edges_[static_cast<std::size_t>(i)], to = edges_[static_cast<std::size_t>(i) + 1];
    double mean = 0.0;
    for (int g = 0; g < 4; ++g) {
      const double x = 0.5 * (from + to) + 0.5 * (to - from) * at[g];
      mean += of[g] * both(j, [&](double s) { return primitive(x, s); });
    }
    return mean;
  }

  // The set of closed cells, changed until none pulls and none overlaps.
  Response respond(const Eigen::VectorXd& P) const {
    const Eigen::Index n = P.size();
    Response r;
    std::vector<Eigen::Index> closed;
    for (int pass = 0; pass < 100; ++pass) {
      r.net = P.array() - closing_;
      const Eigen::VectorXd free = C_ * r.net;
      r.rock.dw_dP = C_;
      if (!closed.empty()) {
        const Eigen::MatrixXd held = C_(closed, closed).inverse();
        const Eigen::VectorXd t = -held * free(closed);
        r.net(closed) += t;
        r.rock.dw_dP -= C_(Eigen::all, closed) * held * C_(closed, Eigen::all);
      }
      r.rock.w = C_ * r.net;
      std::vector<Eigen::Index> next;
      for (Eigen::Index k = 0; k < n; ++k) {
        const bool was = std::find(closed.begin(), closed.end(), k) != closed.end();
        if (was ? r.net(k) - (P(k) - closing_) > 0.0 : r.rock.w(k) < 0.0) next.push_back(k);
      }
      if (next == closed) break;
      closed = next;
    }
    for (const Eigen::Index k : closed) {
      r.rock.w(k) = 0.0;
      r.rock.dw_dP.row(k).setZero();
    }
    return r;
  }

  double E_prime_, closing_, a_ = 0.0;
  bool mirrored_;
  std::vector<double> edges_;
  Eigen::MatrixXd C_;
  Eigen::VectorXd K_;
};

}  // namespace strata::test
