#include "arc_crack.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {

CrackLine::Intensities arc_crack(double radius, double half_angle, const ArcLoad& load) {
  using std::numbers::pi;
  if (!(radius > 0) || !(half_angle > 0 && half_angle < pi))
    throw std::invalid_argument("radius must be positive, half_angle between 0 and pi");
  const double s = std::sin(half_angle / 2), c = std::cos(half_angle / 2);
  const double D = 0.5 * (load.s_yy - load.s_xx);
  const double all_round = load.pressure + 0.5 * (load.s_yy + load.s_xx) - D * s * s * c * c;
  const double unit = std::sqrt(pi * radius * std::sin(half_angle));
  return {unit * (all_round * c / (1 + s * s) + D * std::cos(1.5 * half_angle)),
          -unit * (all_round * s / (1 + s * s) + D * std::sin(1.5 * half_angle))};
}

}  // namespace strata::reference
