// Straight crack elements beside a bonded interface: the traction that a jump of displacement on one sends anywhere.
//
// An element runs from `start` a length L along `direction`; on it the jump is (opening, slip) = sum_k c_k b_k(t/L),
//   inner element: b_k(s) = s^k,   tip element (the tip at its start): b_k(s) = s^(k+1/2),   k = 0, 1, 2.
// The jump is a distribution of dislocations, whose potentials near the interface are those of bimaterial.hpp (Suo
// 1989); integrated over the element in closed form: with H(w) = int_0^1 b(s)/(w - s) ds the sums of b'/(w - s)^n are
//   F_1 = H',  F_2 = -H'',  F_3 = H'''/2,
// H = w^k log(w/(w-1)) - .. for inner and w^(k+1/2) log((w^(1/2)+1)/(w^(1/2)-1)) - .. for tip elements; finite parts on
// the element itself. Frame: the interface is y = 0, the elements lie in y > 0.
#pragma once

#include <Eigen/Dense>
#include <array>
#include <complex>

#include "bimaterial.hpp"

namespace strata::reference {

inline constexpr int kElementModes = 3;

struct CrackElement {
  std::complex<double> start;  // m
  double direction = 0.0;      // rad, anticlockwise from x
  double length = 1.0;         // m
  bool at_tip = false;         // the crack's tip is at `start`

  std::complex<double> at(double t) const { return start + std::polar(t, direction); }
};

// F_1, F_2, F_3 of one mode, per unit length of the element.
struct ElementSums {
  std::complex<double> F_1, F_2, F_3;
};
// The sums of all modes at w = (z - start) e^(-i direction)/L; `on_element` takes the finite part for w in (0, 1).
std::array<ElementSums, kElementModes> element_sums(bool at_tip, std::complex<double> w, bool on_element);

// Traction at z across a line of direction `across` (rad) from unit modes, in units of E'/(4 pi), 1/m: row normal,
// shear; columns opening of modes 0..2, slip of modes 0..2. `on_element`: z lies on the element, `across` its
// direction.
using ElementTraction = Eigen::Matrix<double, 2, 2 * kElementModes>;
ElementTraction element_traction(const CrackElement& element, const BondedMirror& mirror, std::complex<double> z,
                                 double across, bool on_element);

}  // namespace strata::reference
