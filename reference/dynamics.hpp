// Elastic waves, and a crack that is pressurised at once.
#pragma once

#include "rock.hpp"

namespace strata::reference {

struct WaveSpeeds {
  double c_P = 0.0;  // m/s
  double c_S = 0.0;
  double c_R = 0.0;
};

// Speeds of the plane-strain waves and of Rayleigh's surface wave (Achenbach 1973, chapter 5):
//   c_P = sqrt((lambda + 2 mu)/rho), c_S = sqrt(mu/rho), c_R: 4 alpha_P alpha_S = (1 + alpha_S^2)^2,
//   alpha_j = sqrt(1 - c_R^2/c_j^2). density in kg/m^3.
// Throws std::invalid_argument for E or density not positive, or nu outside [0, 0.5).
WaveSpeeds wave_speeds(const Rock& rock, double density);

// K_I(t) of a semi-infinite crack whose faces are pressed apart by p from t = 0 on (Freund 1990, chapter 2):
//   K_I = 2 p sqrt(c_P t (1 - 2 nu)/pi)/(1 - nu), Pa sqrt(m); p in Pa, t in s.
// For a crack 2a the first wave from the other tip returns at 2a/c_P; until then the solution is exact.
// Throws as wave_speeds, or for t < 0.
double freund_step_pressure(const Rock& rock, double density, double p, double t);

// Frequencies of u = (A sin kx cos ky, B cos kx sin ky) cos(omega t), k = 2 pi/side, in a square on rollers, Hz:
//   dilatation A = B: f = sqrt(2) c_P/side; shear A = -B: f = sqrt(2) c_S/side (by insertion into Navier's equations).
struct StandingWaves {
  double dilatation = 0.0;
  double shear = 0.0;
};
StandingWaves standing_waves(const Rock& rock, double density, double side);

}  // namespace strata::reference
