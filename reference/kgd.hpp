// Plane-strain hydraulic fracture (Khristianovic, Geertsma, de Klerk) fed at its middle at a constant rate, no
// leak-off.
//
// Opening w, pressure p (net), half-length l, rate Q_0 of both wings together (m^2/s), mu' = 12 mu:
//   dw/dt + dq/dx = 0,  q = -(w^3/mu') dp/dx,  q(0+) = Q_0/2,  w(l) = q(l) = 0,  w from p by Griffith's crack.
// Two limits are self-similar (Adachi & Detournay 2002; Detournay 2004, Int. J. Geomech. 4, 35):
//   toughness: p uniform, K_I = K_Ic, 2 pi p l^2/E' = Q_0 t;
//   viscosity: K_I = 0, l = g (Q_0^3 E' t^4/mu')^(1/6), w = W(xi) (mu' Q_0^3 t^2/E')^(1/6), p = P(xi) (mu'
//   E'^2/t)^(1/3).
// The number K_m = 4 sqrt(2/pi) K_Ic/(mu' Q_0 E'^3)^(1/4) tells them apart: viscosity below 1, toughness above 4.
#pragma once

#include <vector>

#include "griffith.hpp"

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

// Self-similar shape of the viscosity-dominated fracture, solved once on construction with xi = x/l. With V = W/g
//   -V^3 P' = int_xi^1 V + (2/3) xi V,  V = Griffith's opening of P for a = E' = 1,  K_I = 0,  2 g^2 int_0^1 V = 1,
// by fixed point on knots that crowd to the tip, where V -> beta (2/3)^(1/3) (1-xi)^(2/3),
// beta = 2^(1/3) 3^(5/6) (Spence & Sharp 1985; Desroches et al. 1994).
class KgdViscosityShape {
 public:
  // knots: number of intervals, 60 to 240. Throws std::invalid_argument outside, std::runtime_error without
  // convergence.
  explicit KgdViscosityShape(int knots = 200);

  double length_factor() const { return g_; }  // g, 0.615
  double opening(double xi) const;             // W(xi), 1
  double pressure(double xi) const;            // P(xi), 1; -infinity at the tip, here its mean over the last interval

 private:
  PressureKnots pressure_;
  LinearlyPressurisedCrack crack_;
  double g_ = 0.0;
};

// Viscosity-dominated fracture at a time; arguments as above, viscosity mu in Pa s. Throws as kgd_toughness.
KgdState kgd_viscosity(const KgdViscosityShape& shape, double E_prime, double rate, double time, double viscosity);

}  // namespace strata::reference
