// The fluid along the fracture.
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace strata {

// Fluid pressure at the fracture's vertices (Pa), from its first vertex to its last.
struct FluidLine {
  std::vector<double> P;
  std::size_t inlet = 0;  // the vertex at which the pressure is prescribed
  double inlet_Pa = 0.0;
  std::vector<double> w_rate;  // of the opening (m/s), a value a point, over the last step without inertia; or none
};

// The fluid in the fracture, a value a cell from the first vertex to the last.
struct ReynoldsLine {
  std::vector<double> length;   // A (m)
  std::vector<double> P;        // absolute pressure (Pa)
  std::vector<double> phi;      // filled part of the opening
  std::vector<double> content;  // theta w A: volume of the fluid at the cavitation pressure (m^2)
  std::vector<double> w;        // opening at the end of the last step (m)
  std::vector<double> w_rate;   // over the last step (m/s), for the estimate of its error
  std::vector<double> wet_s;    // when the tip came by (s), infinite in initial cells that the fluid has not come to
  std::vector<double> leaked;   // what both faces have lost to the rock since then (m^2)
  bool rates_known = false;     // false before the first step and after growth
  std::size_t inlet = 0;        // vertex at which the fluid enters
  double inlet_Pa = 0.0;        // pressure there

  std::size_t size() const { return length.size(); }
  bool is_dry(std::size_t cell) const { return wet_s[cell] > std::numeric_limits<double>::max(); }
  /// Cells at an end that are dry.
  std::size_t dry_cells(bool at_back) const {
    std::size_t n = 0;
    while (n < size() && is_dry(at_back ? size() - 1 - n : n)) ++n;
    return n;
  }
};

// Fluid counted in and found there, as volume at the cavitation pressure (m^2).
struct FluidBalance {
  double stored_at_start = 0.0;
  double injected = 0.0;  // integral of theta q dt through the inlet
  double stored = 0.0;    // sum of theta w A over the cells, from P, phi and the rock's w
  double leaked = 0.0;    // lost to the rock
  double largest = 0.0;   // of |injected| so far

  // What is missing, relative to what was injected (or stored, where that is more).
  double closure() const {
    const double scale = largest > stored_at_start ? largest : stored_at_start;
    return scale > 0.0 ? (stored - stored_at_start - injected + leaked) / scale : 0.0;
  }
};

// The fluid just after the last growth, from which steps begin until the next one: steps from one to the other would
// let the pressure even out behind a tip that stands, where in truth it goes on. Without cells: none.
struct GrownFluid {
  double time = 0.0;  // s
  double took = 0.0;  // the growth before (s)
  ReynoldsLine line;
  FluidBalance balance;
};

}  // namespace strata
