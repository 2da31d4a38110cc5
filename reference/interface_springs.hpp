// Pressurised crack normal to an interface between equal rocks that is soft (springs), closed and frictionless, or
// free.
//
// Interface y = 0, crack on x = 0, d < y < d + 2a. The interface's jump of wave number k lowers the interface's own
// traction T_0 of the perfect rock by (E'/4) k jump, so with T = D jump it passes T_0 (1 - R), R = k/(k + 4 D/E'); what
// the released part R T_0 does back on the crack (y at the receiver, t at the dislocation) gives the kernel
//   1/(t-y) + int_0^inf e^(-k(y+t)) { -t k (1-ky) R_n + (2-ky)(1-kt) R_t } dk,
// in closed form by e^(c s) E_1(c s), s = y + t, c = 4 D/E'. R = 1 is a free surface (Cook & Erdogan's kernel for
// Pi = La = -1), R = 0 no interface at all; closed and frictionless is R_n = 0, R_t = 1.
// Source: own derivation; checked here against a displacement discontinuity solution and against both limits.
// Valid while the crack is open; springs act alike in tension and compression.
#pragma once

#include "crack_line.hpp"
#include "quadrature.hpp"

namespace strata::reference {

// Interface stiffness, Pa/m: 0 passes nothing, infinity is perfect.
struct SpringInterface {
  double normal_stiffness = 0.5e6;  // D_n
  double shear_stiffness = 0.5e6;   // D_t
};

// The interface's part of the kernel, 1/m, for positions t, y > 0 in m from the interface and E' in Pa.
double spring_kernel(const SpringInterface& interface, double E_prime, double t, double y);

// Solves the crack: half_length a (m), distance d (m) from the interface to the near tip (its -a), net pressure p(s) in
// Pa over s in [-a, a] from the middle; n as in CrackLine.
// Throws std::invalid_argument for a length, distance or modulus that is not positive or a negative stiffness.
CrackLine spring_interface_crack(const SpringInterface& interface, double half_length, double distance, double E_prime,
                                 const Function& p, int n = 0);
// The same for piecewise-linear p, whose kinks and jumps then cost no accuracy.
CrackLine spring_interface_crack(const SpringInterface& interface, double half_length, double distance, double E_prime,
                                 const PressureKnots& p, int n = 0);

// K/(s_n sqrt(2 pi d)) at which a Coulomb interface at distance d ahead of the tip first slips, d << a: with the tip's
// own field s_yy = K/sqrt(2 pi r) cos(th/2)(1 - sin(th/2) sin(3th/2)), s_xy = K/sqrt(2 pi r) sin(th/2) cos(th/2)
// cos(3th/2), r = d/cos(th), it is 1/max over th of [sqrt(cos th) (s_xy/mu + s_yy) sqrt(2 pi r)/K]. Opening comes at 1.
// friction mu > 0, else std::invalid_argument.
double first_slip_ratio(double friction);

// Net uniform pressure (Pa) at which a Coulomb interface under compression s_n (Pa), at distance d (m) from the tip of
// a Griffith crack of half-length a (m) normal to it, first slips: s_n/max over x of [(s_yy + |s_xy|/mu)/p], stress by
// Westergaard's function Z = p (z/sqrt(z^2 - a^2) - 1).
// Throws std::invalid_argument unless all are positive.
double first_slip_pressure(double half_length, double distance, double compression, double friction);

}  // namespace strata::reference
