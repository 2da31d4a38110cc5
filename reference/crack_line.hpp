// A straight crack as a line of dislocations: Gauss-Chebyshev solution of its singular integral equations.
//
// With delta(t) = (opening, slip) the jump of displacement over the crack -a < t < a, left of it minus right of it,
//   (E'/4 pi) int delta'(t) [ I/(t - x) + k(t, x) ] dt = -(p(x), q(x)),   int delta' dt = 0,
// where k, 1/m, is what the surroundings (an interface) send back, smooth as long as the crack does not touch them.
// delta' = g/sqrt(a^2 - t^2): nodes t_j = a cos((2j-1) pi/2n), equations at x_k = a cos(k pi/n).
// Source: Erdogan & Gupta 1972, Q. Appl. Math. 29, 525; tip values by Krenk 1975, Q. Appl. Math. 32, 479.
#pragma once

#include <Eigen/Dense>
#include <functional>
#include <optional>

#include "griffith.hpp"

namespace strata::reference {

// k(t, x) in 1/m; rows: normal, shear traction at x; columns: opening, slip at t; both in m from the crack's middle.
using CrackKernel = std::function<Eigen::Matrix2d(double t, double x)>;
// (p, q) at x, Pa: net pressure, and the shear traction that the crack relieves.
using CrackLoad = std::function<Eigen::Vector2d(double x)>;

class CrackLine {
 public:
  struct Intensities {
    double K_I = 0.0;
    double K_II = 0.0;
  };

  // Solves with n nodes; n = 0 doubles from 32 until K settles to 1e-11 of its size or 512 are reached.
  // half_length a in m, E_prime in Pa of the rock around the crack.
  // Throws std::invalid_argument unless both are positive, std::runtime_error if the solution is not finite.
  CrackLine(double half_length, double E_prime, const CrackKernel& kernel, const CrackLoad& load, int n = 0);
  // The same under piecewise-linear net pressure, whose kinks and jumps the nodes need not resolve: delta' is that of
  // the infinite plane, in closed form, and a smooth rest. The former acts through k by its moments
  //   int delta_0' T_m(t/a) dt = -(4 a/E') int_0^pi p(a cos th) sin(m th) sin(th) d(th)   (by reciprocity).
  CrackLine(double half_length, double E_prime, const CrackKernel& kernel, const PressureKnots& p, int n = 0);

  // K at the tip +a or -a, Pa sqrt(m): K_I + .. = -+ (E'/4) sqrt(pi/a) g(+-a). K_II > 0 turns the tip clockwise.
  Intensities at_plus() const { return plus_; }
  Intensities at_minus() const { return minus_; }
  // Opening and slip at x, m; zero outside.
  Eigen::Vector2d jump(double x) const;
  // int opening dx, m^2.
  double volume() const;
  // Change of K from half the nodes over |K| (0 where n was given).
  double error() const { return error_; }

  // Nodes t_j (m) and strengths delta'(t_j) sqrt(a^2 - t_j^2) pi/n (m) of the equivalent point dislocations.
  const Eigen::VectorXd& nodes() const { return nodes_; }
  const Eigen::Matrix2Xd& strengths() const { return strengths_; }

 private:
  // Solves with n nodes, or with as many as settle K; load_of(n) is the load for n nodes.
  void settle(const CrackKernel& kernel, const std::function<CrackLoad(int)>& load_of, int n);
  void solve(const CrackKernel& kernel, const CrackLoad& load, int n);

  double a_;
  double E_prime_;
  double error_ = 0.0;
  Intensities plus_, minus_;
  Eigen::VectorXd nodes_;
  Eigen::Matrix2Xd strengths_;
  std::optional<LinearlyPressurisedCrack> plane_;  // the part in closed form,
  Eigen::Matrix2Xd rest_;                          // and the strengths of the rest
};

// Direction of maximum hoop stress from the tip's own, rad, anticlockwise positive (Erdogan & Sih 1963):
//   tan(th/2) = (K_I - sqrt(K_I^2 + 8 K_II^2))/(4 K_II), 0 for K_II = 0.
double max_hoop_angle(double K_I, double K_II);

}  // namespace strata::reference
