#include "laminate.hpp"

#include <stdexcept>

namespace strata::reference {

Laminate loaded_laminate(const std::vector<Ply>& plies, double p_h, double p_v) {
  double height = 0, stiffness = 0, across = 0;
  for (const Ply& ply : plies) {
    const double nu = ply.rock.poisson_ratio;
    if (!(ply.thickness > 0) || !(ply.rock.youngs_modulus > 0) || !(nu >= 0 && nu < 0.5))
      throw std::invalid_argument("a layer needs thickness > 0, E > 0 and nu in [0, 0.5)");
    height += ply.thickness;
    stiffness += ply.thickness * ply.rock.E_prime();
    across += ply.thickness * nu / (1 - nu);
  }
  if (plies.empty()) throw std::invalid_argument("a stack has at least one layer");
  Laminate state;
  state.stress_yy = -p_v;
  state.strain_xx = (-p_h * height - across * state.stress_yy) / stiffness;
  for (const Ply& ply : plies) {
    const double E = ply.rock.youngs_modulus, nu = ply.rock.poisson_ratio;
    const double stress_xx = ply.rock.E_prime() * state.strain_xx + nu / (1 - nu) * state.stress_yy;
    state.stress_xx.push_back(stress_xx);
    state.strain_yy.push_back((1 + nu) / E * ((1 - nu) * state.stress_yy - nu * stress_xx));
  }
  return state;
}

}  // namespace strata::reference
