// Straight pressurised crack in one rock beside a bonded interface to another: any distance, any inclination.
//
// Rock 1 fills y > 0 and holds the crack, rock 2 fills y < 0. A dislocation in rock 1 with potentials phi_0, omega_0 in
// the infinite plane (omega = z phi' + psi) has in the two rocks
//   phi_1 = phi_0 + Pi omega_0bar,  omega_1 = omega_0 + La phi_0bar,  fbar(z) = conj f(conj z),
//   phi_2 = (1 + La) phi_0,         omega_2 = (1 + Pi) omega_0,
//   Pi = (m-1)/(1 + kappa_1 m),  La = (kappa_1 m - kappa_2)/(kappa_2 + m),  m = mu_2/mu_1,
// (Suo 1989, Int. J. Solids Struct. 25, 1133), and the crack is a line of dislocations (crack_line.hpp). A crack normal
// to the interface has the kernel of Cook & Erdogan 1972, Int. J. Engng Sci. 10, 677.
// Valid while the crack is open everywhere and clear of the interface; accuracy falls as distance/a falls below 1e-3.
#pragma once

#include <complex>
#include <functional>

#include "crack_line.hpp"
#include "quadrature.hpp"
#include "rock.hpp"

namespace strata::reference {

// Pi and La above: how the interface mirrors the field; both 0 for equal rocks, -1 for a free surface (rock 2 of E =
// 0).
struct BondedMirror {
  double Pi = 0.0;
  double La = 0.0;
};
BondedMirror bonded_mirror(const Rock& rock_1, const Rock& rock_2);

class BondedCrack {
 public:
  struct Geometry {
    double half_length = 5.0;      // a, m
    double centre_distance = 6.0;  // of the crack's middle from the interface, m
    double inclination = 0.0;      // of the crack to the interface, rad: 0 parallel, pi/2 normal with -a the near tip
  };

  // Solves for net pressure p(s), Pa, s in m from the middle; n nodes as in CrackLine.
  // Throws std::invalid_argument for rocks with E_1 <= 0, E_2 < 0 or nu outside [0, 0.5), or a crack that reaches the
  // interface.
  BondedCrack(const Geometry& geometry, const Rock& rock_1, const Rock& rock_2, const Function& p, int n = 0);
  // The same for piecewise-linear p, whose kinks and jumps then cost no accuracy.
  BondedCrack(const Geometry& geometry, const Rock& rock_1, const Rock& rock_2, const PressureKnots& p, int n = 0);

  const CrackLine& line() const { return line_; }

  struct Field {
    double s_xx, s_yy, s_xy;  // Pa
    double u_x, u_y;          // m, up to a rigid motion common to both rocks
  };
  // Stress and displacement at (x, y), m, off the crack; the point's rock follows from the sign of y (0 is rock 1).
  Field field(double x, double y) const;
  // As field(), for y = 0 seen from rock 2.
  Field field_in_rock_2(double x, double y) const;

  // The traction that a unit dislocation at t sends back to x by way of the interface, in units of E'/(4 pi); see
  // CrackKernel.
  static Eigen::Matrix2d kernel(const Geometry& geometry, const BondedMirror& mirror, double t, double x);

 private:
  using LineSolver = std::function<CrackLine(const CrackKernel&)>;
  BondedCrack(const Geometry& geometry, const Rock& rock_1, const Rock& rock_2, const LineSolver& line);
  Field evaluate(std::complex<double> z, bool in_rock_1) const;

  Geometry geometry_;
  Rock rock_1_, rock_2_;
  BondedMirror mirror_;
  CrackLine line_;
};

// Exponent lambda of the stress r^-lambda at the tip of a crack in rock 1 that ends at the interface, normal to it: the
// root in (0, 1) of cos(pi lambda) + 2 Pi (1-lambda)^2 - (La + Pi)/2 = 0 (Zak & Williams 1963, J. Appl. Mech. 30, 142).
// Throws std::invalid_argument as BondedCrack, or if rock 2 has E = 0 (nothing is singular then).
double bonded_tip_exponent(const Rock& rock_1, const Rock& rock_2);

}  // namespace strata::reference
