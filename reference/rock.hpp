// An isotropic elastic rock in plane strain.
#pragma once

namespace strata::reference {

struct Rock {
  double youngs_modulus = 10e9;  // E, Pa
  double poisson_ratio = 0.2;    // nu

  // Shear modulus mu = E/(2(1+nu)), Pa.
  double shear_modulus() const { return youngs_modulus / (2 * (1 + poisson_ratio)); }
  // Plane-strain modulus E' = E/(1-nu^2), Pa.
  double E_prime() const { return youngs_modulus / (1 - poisson_ratio * poisson_ratio); }
  // Kolosov's constant in plane strain, kappa = 3 - 4 nu.
  double kappa() const { return 3 - 4 * poisson_ratio; }
};

}  // namespace strata::reference
