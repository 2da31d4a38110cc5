// Plane waves along a column of layers, bonded or joined by springs, after a pulse of velocity.
#pragma once

#include <functional>
#include <vector>

namespace strata::reference {

struct WaveLayer {
  double thickness = 1;   // m
  double modulus = 1e9;   // M of stress = M du/dy, Pa: lambda + 2 mu of a plane wave, E' of a thin bar with free sides
  double density = 2500;  // kg/m^3
  // Radius r of what moves across with u_y, m: 0 of a plane wave, nu/(1 - nu) width/sqrt(12) of a bar with free sides.
  double lateral_radius = 0;

  double speed() const;      // sqrt(M/rho), m/s
  double impedance() const;  // sqrt(M rho), Pa s/m
};

enum class WaveEnd { held, free };

// v_0(y): V exp(-((y - middle)/half_width)^2), or V cos^2(pi (y - middle)/(2 half_width)) within half_width and 0
// beyond.
struct VelocityPulse {
  enum class Form { gaussian, cosine_squared };
  Form form = Form::gaussian;
  double middle = 0;      // m
  double half_width = 1;  // m
  double velocity = 1;    // V, m/s

  double operator()(double y) const;
  double reach() const;  // beyond this distance from the middle it is below 1e-17 V, m
};

struct WaveAt {
  double u = 0;       // m
  double v = 0;       // m/s
  double stress = 0;  // Pa, tension positive
};

// u(y, t) of rho u_tt = s_y, s = M u_y in layers from y = 0 upwards, u = 0 and u_t = v_0 at t = 0; across border j s is
// continuous and the jump of u is s/D_j (Pa/m; 0: no bond at all; 1e30 and above: bonded).
// A bar of one layer may have lateral inertia (Rayleigh; Love 1927, article 278): rho (u_tt - r^2 u_yytt) = M u_yy with
// v_x = -nu/(1 - nu) x dv_0/dy at t = 0; then w_n = c k_n/sqrt(1 + r^2 k_n^2) and stress is the mean over the width.
// Method: sum over normal modes, u = sum_n c_n sin(w_n t)/w_n phi_n, c_n = int rho v_0 phi_n dy/int rho phi_n^2 dy.
// (Z w phi, s) turns with y by the angle w/c per metre and keeps its quadrant where Z changes and through a spring, so
// the angle at the top grows with w and passes each multiple of pi/2 once: every mode is found and none is missed
// (Pruefer's angle; Courant & Hilbert 1953, chapter VI). c_n in closed form, of a gaussian by Gauss's rule.
class LayeredWave {
 public:
  // springs: one a border, Pa/m. Throws std::invalid_argument for no layers, values not positive, a negative spring,
  // a number of springs other than layers - 1, or lateral inertia in more than one layer.
  LayeredWave(std::vector<WaveLayer> layers, std::vector<double> springs, WaveEnd bottom, WaveEnd top,
              const VelocityPulse& pulse);

  // At y (m, of the column; on a border the upper layer's side) and t >= 0 (s). Throws std::invalid_argument otherwise.
  WaveAt at(double y, double time) const;

  double height() const { return tops_.back(); }
  double travel_time() const;                // of the first wave through all layers, s
  double energy() const { return energy_; }  // int rho v_0^2/2 dy, J/m^2
  const std::vector<double>& angular_frequencies() const { return frequencies_; }  // rigid modes as 0
  // What the upper half of the frequencies adds to v or to stress/Z at most, and round-off through weak springs, as a
  // share of V; never below 1e-12.
  double error() const { return error_; }

 private:
  struct Part {  // layers that hang together, first..last
    std::size_t first, last;
    WaveEnd bottom, top;
  };
  struct Mode {
    double w = 0;
    std::size_t first = 0;            // layer of the values below
    std::vector<double> phi, stress;  // at the bottom of each layer
    double coefficient = 0;           // c_n
  };
  struct Knot {
    double y, weighted;  // place, and weight times v_0
  };

  double angle(const Part& part, double w) const;
  double frequency(const Part& part, double target, double above) const;
  Mode mode(const Part& part, double w) const;
  Mode rigid(const Part& part) const;
  double amplitude(const Mode& mode, std::size_t layer) const;
  double coefficient(const Mode& mode) const;
  double momentum(const Mode& mode, std::size_t layer) const;
  void add_modes(const Part& part, double highest);
  void place_knots(double highest);

  std::vector<WaveLayer> layers_;
  std::vector<double> springs_, bottoms_, tops_;
  VelocityPulse pulse_;
  std::vector<std::vector<Knot>> knots_;  // a list a layer, of a gaussian
  std::vector<Mode> modes_;
  std::vector<double> frequencies_;
  double energy_ = 0, error_ = 0;
};

}  // namespace strata::reference
