// Plane-strain hydraulic fracture (Khristianovic, Geertsma, de Klerk) fed at its middle at a constant rate, no
// leak-off.
//
// Opening w, pressure p (net), half-length l, rate Q_0 of both wings together (m^2/s), mu' = 12 mu:
//   dw/dt + dq/dx = 0,  q = -(w^3/mu') dp/dx,  q(0+) = Q_0/2,  w(l) = q(l) = 0,  w from p by Griffith's crack,
//   K_I = K_Ic.
// The fracture is self-similar for any toughness, because the number that weighs toughness against viscosity,
//   K_m = 4 sqrt(2/pi) K_Ic/(mu' Q_0 E'^3)^(1/4),
// is free of time (Spence & Sharp 1985; Adachi & Detournay 2002; Detournay 2004, Int. J. Geomech. 4, 35):
//   l = g (Q_0^3 E' t^4/mu')^(1/6),  w = W(xi) (mu' Q_0^3 t^2/E')^(1/6),  p = P(xi) (mu' E'^2/t)^(1/3),  xi = x/l.
// Its ends are the viscosity vertex K_m = 0 (good below 1) and the toughness vertex (good above 4): p uniform,
// K_I = K_Ic, 2 pi p l^2/E' = Q_0 t.
#pragma once

#include <Eigen/Dense>

#include "crack_tip_knots.hpp"

namespace strata::reference {

struct KgdState {
  double half_length = 0.0;     // m
  double mouth_opening = 0.0;   // m, face to face
  double inlet_pressure = 0.0;  // net, Pa
};

// Toughness-dominated fracture: l = (E' Q_0 t/(2 sqrt(pi) K_Ic))^(2/3), p = K_Ic/sqrt(pi l), w_0 = 4 p l/E'.
// E_prime Pa, rate m^2/s, time s, toughness Pa sqrt(m); throws std::invalid_argument unless all are positive.
KgdState kgd_toughness(double E_prime, double rate, double time, double toughness);

// Toughness number K_m above, viscosity mu in Pa s; throws as kgd_toughness (toughness may be 0).
double kgd_toughness_number(double E_prime, double rate, double viscosity, double toughness);

// Self-similar shape of the fracture of one K_m, solved once on construction. With V = W/g and Griffith's crack
// a = E' = 1
//   -V^3 P' = int_xi^1 V + (2/3) xi V,  V = (4/pi) int_0^1 P(s) ln|(r(xi) + r(s))/(r(xi) - r(s))| ds, r = sqrt(1-s^2),
//   K_I[P] = K_m sqrt(pi/32)/sqrt(g),  2 g^2 int_0^1 V = 1
// by Newton's method on ln V at knots that crowd exponentially to the tip: 1 - xi reaches 1e-20, so that the zone of
// size K_m^6 in which V turns from (1-xi)^(1/2) to (1-xi)^(2/3) is resolved wherever it matters. P is linear in
// ln(1-xi) between knots; the error falls with the square of their number. Below K_m = 0.01 the shape is that of 0.01,
// from which it differs by K_m^3.17 (Garagash & Detournay 2005), 1e-8 at most.
class KgdShape {
 public:
  // A smaller toughness number than this is taken for it: the zone near the tip where toughness shows is then smaller
  // than round-off.
  static constexpr double least_toughness = 0.01;

  // knots: number of intervals, 50 to 1000. Throws std::invalid_argument outside or for K_m negative or not finite,
  // std::runtime_error without convergence.
  explicit KgdShape(double toughness_number = 0.0, int knots = 400);

  const CrackTipKnots& knots() const { return line_; }
  Eigen::VectorXd openings() const { return line_.opening * P_ * g_; }  // W at the knots, without round-off at the tip
  double length_factor() const { return g_; }                           // g: 0.615 at K_m = 0
  double opening(double xi) const;                                      // W(xi), 1; 0 from the tip on
  double pressure(double xi) const;  // P(xi), 1, for |xi| < 1; it has no lower bound at the tip

 private:
  void solve(double toughness_number);

  double g_ = 0.0;
  CrackTipKnots line_;
  Eigen::VectorXd P_;  // at the knots; the last: mean from the last knot to the tip
};

// The fracture of a shape at a time; arguments as above, viscosity mu in Pa s. Throws as kgd_toughness.
KgdState kgd_fracture(const KgdShape& shape, double E_prime, double rate, double time, double viscosity);

}  // namespace strata::reference
