// Crack in the middle of a finite rectangular block: the pressurised crack of the study before any interface acts.
//
// Geometry: block |x| < width/2, |y| < half_height; crack x = 0, |y| < a, under uniform net pressure p. The block's
// lower half is the mirror image of the upper one, so this is also the upper half alone with a symmetry line at y = 0.
// Method: Muskhelishvili's potentials with the crack faces satisfied exactly (local axis X along the crack, Z = X +
// iY):
//   phi(Z) = E(Z) sqrt(Z^2 - a^2) + O(Z) - p Z/2,   omega(Z) = E(Z) sqrt(Z^2 - a^2) - O(Z) - p Z/2,
//   s_YY - i s_XY = Phi(Z) + Omega(conj Z) + (Z - conj Z) conj(Phi'(Z)),  Phi = phi', Omega = omega',
//   2 mu (u_X + i u_Y) = kappa phi(Z) - omega(conj Z) - (Z - conj Z) conj(Phi(Z)),
// with real polynomials E even and O odd; their coefficients follow from the conditions on the edges by least squares.
// Then K_I = 2 E(a) sqrt(pi a) and the opening is (8/E') E(x) sqrt(a^2 - x^2).
// Ends so far from the crack that their effect, e^(-2 x 2.1 x distance/half the block's breadth) or less
// (Saint-Venant), is below 1e-7 are drawn in: a block far longer than wide (not with sides and top both fixed, where a
// uniform stress comes back) or far wider than long (sides not fixed). Source: Muskhelishvili 1953, Some basic
// problems, chapters 18 and 19; the collocation is in the manner of Isida 1971, Int. J. Fract. Mech. 7, 301. No table
// or fit enters.
#pragma once

#include <complex>
#include <vector>

#include "quadrature.hpp"

namespace strata::reference {

// What holds an edge: tractions (no net traction), or no normal displacement and no shear.
enum class EdgeHold { traction, fixed };

struct Block {
  double width = 80.0;        // across the crack, m
  double half_height = 80.0;  // from the crack's middle to the top edge, m
  double half_crack = 5.0;    // a, m
  EdgeHold sides = EdgeHold::traction;
  EdgeHold top = EdgeHold::traction;
  double poisson_ratio = 0.2;  // plays a part only where sides and top are both fixed
};

// The block's crack under unit net pressure; answers are linear in the pressure.
class BlockCrack {
 public:
  // Solves with `terms` coefficients in each of E and O; 0 doubles them until F settles to 1e-9 or 96 are reached.
  // Throws std::invalid_argument for sizes that are not positive or finite, a crack longer than 0.9 half_height,
  // an edge nearer than a quarter of the half-crack, or a Poisson ratio outside [0, 0.5).
  explicit BlockCrack(const Block& block, int terms = 0);

  // F = K_I/(p sqrt(pi a)), the correction to the infinite plane.
  double F() const;
  // Change of F from half the terms, 1e-7 or more if ends were drawn in: the error estimate (0 where `terms` was
  // given).
  double F_error() const { return F_error_; }
  // K_I = F p sqrt(pi a), Pa sqrt(m), p in Pa.
  double K_I(double p) const;
  // w(s) = (8/E') E(s) sqrt(a^2 - s^2), m; s along the crack from its middle (m), p in Pa, E_prime in Pa.
  double opening(double s, double p, double E_prime) const;
  // V = int w ds over the whole crack 2a, m^2.
  double volume(double p, double E_prime) const;
  // Net pressure for K_I = K_Ic, Pa; K_Ic in Pa sqrt(m).
  double critical_pressure(double K_Ic) const;

  // E(s) of the opening over p: a polynomial, so defined beyond the tip as well; 1/2 in the infinite plane. s in m.
  double amplitude(double s) const;

  // Stresses over p in the block's axes (x across, y along the crack) at (x, y) in m, not on the crack;
  // u_x and u_y are displacements times 2 mu/p, m. Beyond an end that was drawn in all stress is 0 and so are u_x, u_y.
  struct Field {
    double s_xx, s_yy, s_xy;
    double u_x, u_y;
  };
  Field field(double x, double y) const;
  // Largest residual of the edge conditions over p at 200 points of each edge between the ones that were fitted.
  double edge_residual() const;
  int terms() const { return static_cast<int>(even_.size()); }

 private:
  void solve(int terms);

  Block block_;  // with its far ends drawn in
  double kappa_;
  double capacity_;  // length that scales the polynomials, m
  double beta_;      // of their recurrence
  double F_error_ = 0.0;
  std::vector<double> even_;  // coefficients of E
  std::vector<double> odd_;   // coefficients of O
};

// K_I of the block's crack under a symmetric pressure p(s) >= 0 of any shape, by the weight function of its own uniform
// solution (Bueckner 1970, Rice 1972): K_I = (E'/(2 K_1)) int_0^a p(s) dw_1(s, a)/da ds, index 1 for unit pressure.
// p in Pa over s in [0, a] m; kinks: where p is not smooth. dw/da is a central difference over a (+-2 %).
// Throws as BlockCrack.
double block_K_I(const Block& block, const Function& p, const std::vector<double>& kinks = {});

// Volume (m^2, whole crack) under the same p(s): V = 2 int_0^a p w_1 ds with unit pressure's opening (reciprocity).
double block_volume(const Block& block, double E_prime, const Function& p, const std::vector<double>& kinks = {});

}  // namespace strata::reference
