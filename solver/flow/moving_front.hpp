// The fluid's front, which goes through the cells that growth has added while the tip of the rock stands at their end.
//
// At a speed V, which is their length over the time since growth, the rock behind it opens by toughness and viscosity
// together (Garagash & Detournay 2000; the sum of cubes: Dontsov & Peirce 2015), x behind the front:
//   w^3 = (8 K_Ic/(E' sqrt(2 pi)))^3 x^(3/2) + 2 3^(5/2) (12 mu V/E') x^2,  q = V w,  dP/dx = 12 mu V/w^2
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "scene/scene.hpp"
#include "state/fluid_line.hpp"

namespace strata {

struct MovingFront {
  double c = 0.0;  // 8 K_Ic/(E' sqrt(2 pi)) (m^(1/2))
  double d = 0.0;  // 2 3^(5/2) 12 mu V/E' (m)

  // Of a tip at the line's last cell (at_back) or first at a time (s) after its last growth; E_prime (Pa), K_Ic
  // (Pa sqrt(m)).
  MovingFront(const Fluid& fluid, const ReynoldsLine& line, bool at_back, double E_prime, double K_Ic, double time);
  // Opening (m) at u = sqrt(x) (m^(1/2)).
  double opening(double u) const { return u * std::cbrt(c * c * c + d * u); }
};

/// What faces between cells conduct by the opening of the cell on the tip's side (m/(Pa s)), a value a face, below 0
/// where that is the cell before; 0 where the front of a tip, arguments as above, is not near. While the front goes
/// through new cells of together L, int_0^x w dx V/L passes a face at x on average. A cell stands for P at its middle,
/// the last one for the even pressure with as much K_I.
Eigen::VectorXd front_conductances(const Fluid& fluid, const ReynoldsLine& line, bool at_back, double E_prime,
                                   double K_Ic, double time);

/// Pressure and filling of the cells that growth has added, still empty, as beside: from where a step that takes the
/// front through them is sought. What they hold stays.
void guess_new_cells(ReynoldsLine& line);

/// When the front came by the middle of each cell (s): through the cells of a tip's last growth it goes evenly from
/// their start to a time (s), the present; for the tips at the first and at the last cell that are asked for.
std::vector<double> wet_times(const ReynoldsLine& line, double time, bool at_front, bool at_back);

}  // namespace strata
