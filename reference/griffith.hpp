// Pressurised straight crack -a < x < a in an infinite elastic plane (Griffith 1921, Sneddon 1946).
//
// Solves the singular integral equation of the crack, with w the opening (distance between the faces) and p the net
// pressure (fluid pressure minus closing stress, Pa, positive opening):
//   (E'/4 pi) PV int_{-a}^{a} w'(t)/(t - x) dt = -p(x),   w(-a) = w(a) = 0.
// Source: Sneddon & Lowengrub 1969, Crack problems in the classical theory of elasticity; Tada, Paris & Irwin 2000.
// Valid for plane strain, linear elasticity, and a solution that is open everywhere: where w < 0 the faces would
// overlap and the formulas below say so by their sign only.
#pragma once

#include <vector>

#include "quadrature.hpp"

namespace strata::reference {

// Mode I stress intensity at x = -a and x = +a, Pa sqrt(m).
struct TipIntensities {
  double minus = 0.0;
  double plus = 0.0;
};

// One line of a piecewise-linear pressure, over from < x < to, m: p = at_0 + slope x, Pa.
struct PressureSegment {
  double from, to;
  double at_0;   // Pa, at x = 0 on the segment's line extended
  double slope;  // Pa/m
};

// Pressure given by values at knots, linear between them and zero outside: x_m ascending (m), value Pa, same length.
// Two knots at the same place make a jump.
struct PressureKnots {
  std::vector<double> x;
  std::vector<double> p;

  // Throws std::invalid_argument unless there are at least two knots, as many values, all finite, x ascending.
  void validate() const;
  // Pressure at x (m), Pa; at a jump the mean of its two sides.
  double operator()(double at) const;
  // The lines between the knots, jumps left out, cut off at |x| = a (m). Over less than 1e-8 a the pressure is taken at
  // its mean: the line's two terms would cancel there.
  std::vector<PressureSegment> segments(double a) const;
};

// A crack in an infinite plane under any p(x), by quadrature.
class PressurisedCrack {
 public:
  // half_length a (m) > 0; E_prime (Pa) > 0; p(x) in Pa on [-a, a]; kinks: places (m) where p is not smooth.
  // Throws std::invalid_argument for a half-length or modulus that is not positive.
  PressurisedCrack(double half_length, double E_prime, Function p, const std::vector<double>& kinks = {});

  // K(+-a) = (pi a)^(-1/2) int p(s) sqrt((a +- s)/(a -+ s)) ds, Pa sqrt(m) (Tada et al.).
  TipIntensities K_I() const;
  // w(x) = (4/(pi E')) int p(s) arccosh[(a^2 - x s)/(a |x - s|)] ds, m; x in m, zero outside the crack.
  double opening(double x) const;
  // V = int w dx = (4/E') int p(s) sqrt(a^2 - s^2) ds, m^2 (by reciprocity with the uniformly pressurised crack).
  double volume() const;
  // U = (1/2) int p w dx, the elastic energy, J/m.
  double energy() const;

 private:
  double a_;
  double E_prime_;
  Function p_;
  std::vector<double> angles_;  // asin(kink/a): the integrals run over theta, s = a sin(theta)
};

// The same crack under piecewise-linear pressure in closed form: nothing is integrated numerically but the energy.
class LinearlyPressurisedCrack {
 public:
  // As PressurisedCrack; knots outside [-a, a] are cut off. Throws std::invalid_argument as PressureKnots::validate.
  LinearlyPressurisedCrack(double half_length, double E_prime, const PressureKnots& knots);

  TipIntensities K_I() const;
  double opening(double x) const;
  double volume() const;
  double energy() const;

 private:
  double a_;
  double E_prime_;
  std::vector<PressureSegment> segments_;
};

// Relative error of the closed form for the opening and K: round-off 1e-12, more where p changes steeply, by
// |dp/dx| a/p_max 1e-15; for a rise over w < 1e-8 a, taken at its mean, 1e-8, or near a tip, at distance g from it,
// 0.2 sqrt(w/a) min(1, (w/g)^(3/2)) (K's weight sqrt(2a/u) over the rise against its mean). a in m.
double profile_error(const PressureKnots& knots, double half_length);

// Energy release rate J = K_I^2/E', J/m^2 (Irwin 1957), for K_I in Pa sqrt(m) and E' in Pa.
double energy_release_rate(double K_I, double E_prime);

// Net uniform pressure that gives K_I = K_Ic: p = K_Ic/sqrt(pi a), Pa (Griffith), for a in m and K_Ic in Pa sqrt(m).
double griffith_critical_pressure(double half_length, double K_Ic);

}  // namespace strata::reference
