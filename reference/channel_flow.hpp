// Pressure diffusing down a channel from an inlet whose pressure is ramped, p(0, t) = r t, from rest.
//
// The study's flow law with the opening w(x) given:
//   dP/dt = (M/mu) d/dx [ (w^2/12) dP/dx ],  kappa = M w^2/(12 mu), m^2/s.
// Constant w: the heat equation on 0 < x < L, with no flux or zero pressure at x = L (Carslaw & Jaeger 1959, Conduction
// of heat in solids, chapters 3 and 12).
// Elliptic opening w = w0 sqrt(1 - (x/a)^2) on 0 < x < a: Legendre's equation (eigenfunctions P_l, l odd, eigenvalues
// l(l+1)); nothing flows at the tip, where w = 0. Derived here.
// Valid for any t >= 0. Own error: about 1e-13 of r t, 1e-11 under the elliptic opening while kappa t < 1e-4 a^2.
#pragma once

namespace strata::reference {

struct Channel {
  double length = 5.0;        // L or a, m
  double opening = 1e-4;      // w, or w0 at the inlet, m
  double viscosity = 0.1;     // mu, Pa s
  double bulk_modulus = 1e9;  // M, Pa
  double rate = 0.35e6;       // r, Pa/s

  // kappa = M w^2/(12 mu), m^2/s.
  double diffusivity() const { return bulk_modulus * opening * opening / (12 * viscosity); }
};

// What the far end of a channel of constant opening does.
enum class FarEnd { no_flux, zero_pressure };

// Pressure at x (m, 0 to L) and t (s), Pa, in the channel of constant opening. Two forms of the same solution are used:
//   long times: no flux:       r t - (r/kappa)(L x - x^2/2) + (2 r/(kappa L)) sum sin(k_n x) k_n^-3 e^(-kappa k_n^2 t),
//               zero pressure: r t (1 - x/L) + (r/kappa)(x^2/2 - x^3/(6 L) - L x/3) + the same sum,
//               k_n = (n + 1/2) pi/L (n >= 0), k_n = n pi/L (n >= 1);
//   short times: images, 4 r t sum_m (+-1)^m [ i2erfc((2 m L + x)/b) +- i2erfc((2 (m+1) L - x)/b) ], b = 2 sqrt(kappa
//   t).
// Throws std::invalid_argument for a channel, x or t out of range.
double ramped_channel(const Channel& channel, FarEnd end, double x, double t);

// The two forms by themselves, for checking one against the other; arguments and errors as ramped_channel.
double ramped_channel_by_modes(const Channel& channel, FarEnd end, double x, double t);
double ramped_channel_by_images(const Channel& channel, FarEnd end, double x, double t);

// Pressure at x (m, 0 to a) and t (s), Pa, under the elliptic opening: with xi = x/a, tau = kappa0 t/a^2,
//   P = r t - (r a^2/kappa0) [ ln(1 + xi) - sum_(l odd) c_l P_l(xi) e^(-l(l+1) tau) ],
//   c_l = (2l+1) int_0^1 ln(1+s) P_l(s) ds = (2l+1) P_(l-1)(0)/(l (l+1)^2).
// Below tau = 1e-5, where the terms cancel, the boundary layer's expansion with relative error tau^2 is used instead.
// Throws std::invalid_argument as ramped_channel.
double ramped_ellipse(const Channel& channel, double x, double t);

// Second repeated integral of the complementary error function, i2erfc(z) = (1/4)[(1 + 2 z^2) erfc z - (2/sqrt(pi)) z
// e^(-z^2)], so that 4 t i2erfc(x/(2 sqrt(kappa t))) is the ramp's answer in a half-space (Carslaw & Jaeger, app. II).
double i2erfc(double z);

}  // namespace strata::reference
