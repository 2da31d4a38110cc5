// The path that a crack takes under fluid pressure and in-situ stress, grown in increments.
//
// J = (K_I^2 + K_II^2)/E' = J_c = K_Ic^2/E' drives it, maximum hoop stress turns it. K is affine in the pressure, so
// the pressure that gives J = J_c is the root of a quadratic. Two rules of turning:
//   forward:   the next increment takes the direction of maximum hoop stress at the present tip;
//   corrected: the next increment is turned until K_II of the crack with it is zero (secant on K_II/K_I), the rule to
//              which every path of maximum hoop stress tends as increments shrink (Goldstein & Salganik 1974, Int. J.
//              Fract. 10, 507; Cotterell & Rice 1980, Int. J. Fract. 16, 155).
// Increments matter. Experiment 5 (the path is stable): corrected paths of 1, 0.5 and 0.25 m agree to 1 mm over 20 m;
// forward ones zigzag, each turn overshooting the last (a short kink of angle w adds w K_I/2 to K_II, its own turn
// undoes -2 K_II/K_I, and the older kinks still shear the tip): growing at 1 m, for 10 m of growth at 0.5 m, within 2 m
// at 0.25 m. Experiment 6 (unstable under a stress parallel to the crack larger by T = 1 MPa than that across it: it
// turns over K_I^2/(8 T^2) = 0.26 m) converges only at first order in the increment, forward paths from above and
// corrected ones from below: height at x = 1 m 7.36, 6.78, 6.45, 6.29, 6.20 m forward at 0.5 to 0.03125
// m; 5.65, 5.85, 5.98 corrected at 0.25 to 0.0625 m. At 0.5 and 1 m the corrector finds the other direction without
// K_II, away from the soft rock: use forward turning there. Valid as CurvedCrack; growth past the interface is not
// modelled.
#pragma once

#include <string>
#include <vector>

#include "curved_crack.hpp"

namespace strata::reference {

struct InSituStress {
  double xx = -2e6;  // Pa, tension positive
  double yy = -3e6;
};

struct GrowthRule {
  double toughness = 1.45e6;    // K_Ic, Pa sqrt(m)
  double increment = 0.25;      // m
  bool corrected = true;        // else forward
  bool hold_pressure = true;    // at what starts the growth; else at each increment what gives J = J_c
  bool linear_profile = false;  // pressure falls linearly from the path's start to nothing at its tip; else uniform
  double stop_height = 25.0;    // m, tip's y
  double stop_growth = 20.0;    // m of new path
  double stop_distance = 0.5;   // m, of the tip from the interface
};

struct PathStep {
  Point tip;                 // m
  double direction = 0.0;    // of the last increment, rad
  CrackLine::Intensities K;  // Pa sqrt(m)
  double pressure = 0.0;     // at the path's start, Pa
  double turn = 0.0;         // direction of maximum hoop stress from the tip's own, rad
};

struct GrownPath {
  std::vector<PathStep> steps;  // the first is the initial crack at the start of growth
  std::string stopped;          // "height", "growth", "interface", or "arrest": J < J_c at the held pressure
};

// Grows the crack `start` (its last point) in `plane`. All SI.
// Throws std::invalid_argument as CurvedCrack and for a toughness or an increment that is not positive,
// std::runtime_error where no pressure opens the tip, or a turn with K_II = 0 is not found.
GrownPath grow_path(const std::vector<Point>& start, const CrackPlane& plane, const InSituStress& stress,
                    const GrowthRule& rule);

// Largest distance (m) of the points of `path` from the polyline `other`; points past its last point are left out.
double path_distance(const std::vector<Point>& path, const std::vector<Point>& other);

}  // namespace strata::reference
