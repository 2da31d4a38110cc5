// Isotropic linear elasticity in plane strain, and what follows from a rock's constants.
#pragma once

#include <cmath>
#include <vector>

#include "scene/scene.hpp"
#include "state/particles.hpp"
#include "state/types.hpp"

namespace strata {

struct Elasticity {
  double lambda = 0.0;   // Lame constants (Pa)
  double mu = 0.0;       //
  double nu = 0.0;       // Poisson's ratio
  double rho = 0.0;      // density (kg/m^3)
  double E_prime = 0.0;  // E/(1 - nu^2) (Pa)
  double c_P = 0.0;      // wave speeds (m/s): compression,
  double c_S = 0.0;      // shear
  double c_R = 0.0;      // Rayleigh
  double J_c = 0.0;      // K_Ic^2/E' (N/m)
};

using Rocks = std::vector<Elasticity>;  // of all rocks of a scene, in their order

/// Constants of all rocks of a scene in plane strain; c_R solves the Rayleigh equation
/// (2 - q)^2 - 4 sqrt(1 - q) sqrt(1 - q c_S^2/c_P^2) = 0, q = (c_R/c_S)^2, by bisection to round-off.
Rocks make_elasticities(const Scene& scene);

/// Index of the rock of the layer at a place (m).
std::size_t rock_at(const Scene& scene, const Vec2& x);

/// In-situ stress (Pa) at places (m), scene/in_situ.hpp. Under initialise = "loaded" the elastic stress by edges' loads
/// stands in place of edges_stress().
std::vector<Stress> prescribed_stress(const Scene& scene, const std::vector<Vec2>& places);

/// The uniform stress (Pa) that in_situ's numbers are. Throws nothing.
Stress edges_stress(const Scene& scene);

/// Strain energy of the change from the in-situ state, sum V_p sigma_p : e_p / 2 (J/m).
double strain_energy(const Rocks& rocks, const Particles& particles);

// s = lambda tr(e) I + 2 mu e, e = sym(g): stress of a displacement gradient g (Pa).
inline Stress stress_of(const Elasticity& rock, double g_xx, double g_xy, double g_yx, double g_yy) {
  const double trace = rock.lambda * (g_xx + g_yy);
  return {trace + 2.0 * rock.mu * g_xx, trace + 2.0 * rock.mu * g_yy, rock.mu * (g_xy + g_yx)};
}

}  // namespace strata
