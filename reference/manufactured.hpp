// Motions chosen beforehand, with the body force that makes them solutions: standing waves of small strain, stretching
// along the axes and a vortex of finite strain. All in plane strain; places are those of the unstrained rock.
#pragma once

#include <Eigen/Dense>

#include "rock.hpp"

namespace strata::reference {

// What is known of a material point: displacement (m), velocity (m/s), acceleration (m/s^2), deformation gradient,
// Cauchy stress (Pa), and the body force per mass that the motion needs (m/s^2).
struct MotionAt {
  Eigen::Vector2d u = Eigen::Vector2d::Zero();
  Eigen::Vector2d v = Eigen::Vector2d::Zero();
  Eigen::Vector2d a = Eigen::Vector2d::Zero();
  Eigen::Matrix2d F = Eigen::Matrix2d::Identity();
  Eigen::Matrix2d sigma = Eigen::Matrix2d::Zero();
  Eigen::Vector2d b = Eigen::Vector2d::Zero();
};

// u = (A sin kx cos ky, B cos kx sin ky) T(t), k = 2 pi waves/side, T = cos wt or sin wt: small strain, in a square
// 0 <= x, y <= side on rollers (no normal displacement and no shear on its four sides). Insertion into Navier's
// equations gives the body force
//   rho b_x = [-rho w^2 A + k^2 ((lambda + 3 mu) A + (lambda + mu) B)] sin kx cos ky T,
// and b_y with A and B, sin and cos exchanged. w = 0 with the cosine is a static state.
struct StandingMotion {
  Rock rock;
  double density = 2500;                  // kg/m^3
  double side = 1;                        // m
  int waves = 1;                          // wave lengths along a side
  Eigen::Vector2d amplitude{1e-3, 1e-3};  // A, B, m
  double angular_frequency = 0;           // w, 1/s
  bool sine = false;                      // T = sin wt, else cos wt

  // Throws std::invalid_argument for E, density, side or waves not positive, or nu outside [0, 0.5).
  MotionAt at(const Eigen::Vector2d& place, double time) const;
  // The factors of sin kx cos ky T in b_x and of cos kx sin ky T in b_y, m/s^2. Throws as at().
  Eigen::Vector2d body_amplitude() const;
};

// How stress follows from finite strain; lambda and mu are those of the rock.
enum class FiniteLaw {
  hencky,      // Kirchhoff stress J sigma = lambda ln(det F) I + 2 mu ln V, V^2 = F F^T
  neo_hookean  // J sigma = lambda ln(det F) I + mu (F F^T - I)
};

// u_x = A sin(n pi X/side) sin(w t), u_y = A sin(n pi Y/side) sin(w t + phase) at the material point (X, Y): every line
// along an axis is stretched along itself, nothing rotates, rollers all round (Kamojjala et al. 2015, axis-aligned
// displacement, there neo-Hookean). With P_x = J sigma_xx/F_xx, the body force per mass is b = u_tt - DIV P/rho_0:
//   hencky:      dP_x/dX = dF_xx/dX (lambda + 2 mu - J sigma_xx)/F_xx^2
//   neo-Hookean: dP_x/dX = dF_xx/dX [lambda (1 - ln det F)/F_xx^2 + mu (1 + 1/F_xx^2)]
struct AxisMotion {
  Rock rock;
  FiniteLaw law = FiniteLaw::hencky;
  double density = 2500;         // rho_0, of the unstrained rock, kg/m^3
  double side = 1;               // m
  int halves = 2;                // n, half wave lengths along a side
  double amplitude = 0.01;       // A, m
  double angular_frequency = 0;  // w, 1/s
  double phase = 0;              // of u_y, radians

  // Throws std::invalid_argument for E, density, side or halves not positive, nu outside [0, 0.5), or a motion that
  // turns the rock inside out: n pi |A|/side >= 1.
  MotionAt at(const Eigen::Vector2d& place, double time) const;
};

// A ring inner < R < outer whose circles turn about the origin by alpha(R, t) = G h(R) sin(w t), h = (1 - q^2)^2,
// q = (2 R - inner - outer)/(outer - inner): rest outside, no stress on both borders (the generalised vortex of
// Kamojjala et al. 2015). F = Q (I + g e_T e_R^T) with the turn Q and g = R dalpha/dR, so det F = 1, and with
// sigma = mu (F F^T - I), in polar coordinates of the turned point:
//   b_r = -R alpha_t^2 + mu R alpha_R^2/rho,  b_t = R alpha_tt - mu (3 alpha_R + R alpha_RR)/rho.
struct VortexMotion {
  Rock rock;
  double density = 2500;         // kg/m^3
  double inner = 0.75;           // m
  double outer = 1.25;           // m
  double turn = 1;               // G, radians
  double angular_frequency = 0;  // w, 1/s

  // Throws std::invalid_argument for E or density not positive, nu outside [0, 0.5), or not 0 < inner < outer.
  MotionAt at(const Eigen::Vector2d& place, double time) const;
};

}  // namespace strata::reference
