// A symmetric crack |x| < 1 of two wings under a pressure known at knots that crowd to its tip: what the solutions of
// fractures fed with a viscous fluid share (a = E' = 1, net pressure q, opening v, u = 1 - |x|).
//
// q is linear in ln u between knots, with its mean in place of it from the last knot to the tip; integrals of an
// opening take it as u^(1/2) times a linear function of u. Griffith's crack:
//   v(x) = (4/pi) int_0^1 q(s) ln|(r(x) + r(s))/(r(x) - r(s))| ds,  K_I = (2/sqrt(pi)) int_0^1 q/r ds,  r =
//   sqrt(1-s^2).
// Knots reach u = 1e-20; errors fall with the square of their number.
#pragma once

#include <Eigen/Dense>

namespace strata::reference {

// A fracture in which q' = -(G v + g)/v^3: its pressure, the residual (what q opens)/v - 1 at the knots, and the
// residual's derivatives by ln v.
struct TipFlow {
  Eigen::VectorXd q;  // N + 1, the mean beyond the last knot last
  Eigen::VectorXd residual;
  Eigen::MatrixXd jacobian;
};

struct CrackTipKnots {
  explicit CrackTipKnots(int knots);

  Eigen::Index N;
  Eigen::VectorXd u;        // at the knots, from 1 down
  Eigen::MatrixXd opening;  // N x (N + 1): v at the knots from q
  Eigen::VectorXd K;        // N + 1: K_I from q
  Eigen::MatrixXd ahead;    // N x N: int_x^1 v at the knots from v

  // v at u as a functional of q.
  Eigen::VectorXd opening_at(double at) const;

  // q whose K_I is K_I and whose slope dq/d ln u at the knots is f, which stays beyond the last one.
  Eigen::VectorXd pressure(const Eigen::VectorXd& f, double K_I) const;

  // The flow at v with K_I, whose derivatives by ln v are dK; G is N x N.
  TipFlow flow(const Eigen::VectorXd& v, const Eigen::MatrixXd& G, const Eigen::VectorXd& g, double K_I,
               const Eigen::RowVectorXd& dK) const;
};

}  // namespace strata::reference
