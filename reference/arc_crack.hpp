// Crack along an arc of a circle in the infinite plane, in closed form.
//
// Radius R, half-angle alpha, symmetric about y, the chord along x (middle of the arc on top). Under net pressure p and
// remote stress s_xx, s_yy (tension positive), with c = cos, s = sin of alpha/2 and a = R sin(alpha):
//   K_I  = sqrt(pi a) [ (S - D s^2 c^2) c/(1 + s^2) + D cos(3 alpha/2) ],
//   K_II = -+ sqrt(pi a) [ (S - D s^2 c^2) s/(1 + s^2) + D sin(3 alpha/2) ]  at the tips x = +-a,
//   S = p + (s_yy + s_xx)/2,  D = (s_yy - s_xx)/2.
// Source: Muskhelishvili 1953, Some basic problems of the mathematical theory of elasticity, par. 124; Cotterell & Rice
// 1980, Int. J. Fract. 16, 155, eq. (26); Tada, Paris & Irwin 2000. K_II > 0 turns the tip clockwise, as in CrackLine.
#pragma once

#include "crack_line.hpp"

namespace strata::reference {

struct ArcLoad {
  double pressure = 0.0;  // Pa
  double s_xx = 0.0;      // Pa
  double s_yy = 0.0;      // Pa
};

// K at the right tip (x = +a), Pa sqrt(m); radius in m, half_angle in rad.
// Throws std::invalid_argument unless radius > 0 and 0 < half_angle < pi.
CrackLine::Intensities arc_crack(double radius, double half_angle, const ArcLoad& load);

}  // namespace strata::reference
