#include "dynamics.hpp"

#include <gsl/gsl_roots.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

// Rayleigh's function over (c/c_S)^2 - free of its double root at c = 0 - at squared speed ratio x = (c/c_S)^2, with
// data = (c_S/c_P)^2: [(2 - x)^2 - 4 sqrt(1-x) sqrt(1 - q x)]/x.
double rayleigh(double x, void* data) {
  const double q = *static_cast<double*>(data);
  return ((2 - x) * (2 - x) - 4 * std::sqrt((1 - x) * (1 - q * x))) / x;
}

}  // namespace

WaveSpeeds wave_speeds(const Rock& rock, double density) {
  if (!(rock.youngs_modulus > 0 && density > 0)) throw std::invalid_argument("E and density must be positive");
  if (!(rock.poisson_ratio >= 0 && rock.poisson_ratio < 0.5))
    throw std::invalid_argument("poisson_ratio is outside [0, 0.5)");
  const double nu = rock.poisson_ratio;
  const double mu = rock.shear_modulus();
  double q = (1 - 2 * nu) / (2 * (1 - nu));  // (c_S/c_P)^2
  gsl_function function{&rayleigh, &q};
  const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  // c_R/c_S lies between 0.87 and 0.96 for every nu in [0, 0.5); the function is negative below it and 1 at c_S.
  gsl_root_fsolver_set(solver.get(), &function, 0.5, 1.0);
  for (int i = 0; i < 100; ++i) gsl_root_fsolver_iterate(solver.get());
  WaveSpeeds speeds;
  speeds.c_S = std::sqrt(mu / density);
  speeds.c_P = speeds.c_S / std::sqrt(q);
  speeds.c_R = speeds.c_S * std::sqrt(gsl_root_fsolver_root(solver.get()));
  return speeds;
}

double freund_step_pressure(const Rock& rock, double density, double p, double t) {
  if (!(t >= 0)) throw std::invalid_argument("t must not be negative");
  const double nu = rock.poisson_ratio;
  return 2 * p * std::sqrt(wave_speeds(rock, density).c_P * t * (1 - 2 * nu) / pi) / (1 - nu);
}

StandingWaves standing_waves(const Rock& rock, double density, double side) {
  if (!(side > 0)) throw std::invalid_argument("side must be positive");
  const WaveSpeeds speeds = wave_speeds(rock, density);
  return {std::numbers::sqrt2 * speeds.c_P / side, std::numbers::sqrt2 * speeds.c_S / side};
}

}  // namespace strata::reference
