// The fracture of kgd.hpp in a rock that takes up fluid by Carter's law: each face loses C_L/sqrt(t - t_0(x)) (m/s),
// t_0 the time when the tip passed x. With C' = 2 C_L and psi = w + 2 C' sqrt(t - t_0), what a place has ever taken,
//   d psi/dt + dq/dx = 0,  q = -(w^3/mu') dp/dx,  q(0+) = Q_0/2,  w(l) = q(l) = 0,  K_I = K_Ic.
// In units of the time t_* = mu' Q_0^3/(E' C'^6), at which leak-off counts as much as storage, and with
// sigma = (t/t_*)^(1/6) the solution goes by sigma and the toughness number K_m alone, smoothly from sigma = 0, the
// self-similar fracture without leak-off (Adachi & Detournay 2008, Eng. Fract. Mech. 75, 4666; Dontsov 2017, Int. J.
// Fract. 205, 221):
//   l = L sigma^4,  w = L V sigma^2,  xi = x/l,  J = int_xi^1 (L V + sigma b),  b = 2 sqrt(1 - t_0/t),
//   -L^2 V^3 P' = L J + (2/3) xi L (L V + sigma b) + (sigma/6) [d(L J)/dsigma + xi (L V + sigma b) dL/dsigma].
#pragma once

#include "kgd.hpp"

namespace strata::reference {

struct KgdLeakoffState : KgdState {
  double efficiency = 1.0;  // volume of the fracture over what was injected
};

// Marches from sigma = 0 in `steps` equal steps of ln(1 + sigma), backward differences of second order, with Newton's
// method for ln V at `knots` knots and ln L. t_0 follows from L, a parabola in sigma within each step, without loss of
// digits at the tip. leakoff: C_L (m/sqrt(s)), may be 0; other arguments as kgd_fracture and kgd_toughness_number.
// Throws std::invalid_argument for arguments out of range (knots 50 to 1000, steps 4 to 1000), std::runtime_error
// without convergence.
KgdLeakoffState kgd_leakoff_once(double E_prime, double rate, double time, double viscosity, double toughness,
                                 double leakoff, int knots, int steps);

struct SettledLeakoff {
  KgdLeakoffState state;
  double error = 0.0;  // the largest relative change by a refinement that the extrapolation foresees
};

// The same extrapolated to no step and to knots without number, both errors being of second order.
SettledLeakoff kgd_leakoff(double E_prime, double rate, double time, double viscosity, double toughness,
                           double leakoff);

// A fracture with leak-off whose fluid has no viscosity, so that its net pressure p is uniform and
// V = 2 pi p l^2/E'. While it is fed it stands at K_I = K_Ic, p = K_Ic/sqrt(pi l), and
//   Q_0 t = 2 sqrt(pi) K_Ic l^(3/2)/E' + 4 C' int_0^l sqrt(t - t_0(x)) dx;
// after shut-in l stays, and V = Q_0 t_s - 4 C' int_0^l sqrt(t - t_0(x)) dx until it closes.
struct ShutInState : KgdLeakoffState {
  double leaked = 0.0;  // m^2, by both wings
};

// At a time (s). t_0 linear in x between `steps` equal steps of t^(1/3) up to shut-in, its integral exact; extrapolated
// from half as many. E_prime Pa, rate m^2/s of both wings, shut_in s, toughness
// Pa sqrt(m), leakoff m/sqrt(s), may be 0. Throws std::invalid_argument for arguments out of range.
ShutInState shut_in_fracture(double E_prime, double rate, double shut_in, double toughness, double leakoff, double time,
                             int steps = 400);

}  // namespace strata::reference
