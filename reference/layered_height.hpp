// Height of a straight crack along y in one rock whose closing stress and toughness differ from layer to layer: the
// height-growth curve of fracture design (Simonson, Abou-Sayed & Clifton 1978, SPE J. 18, 27).
//
// A crack from b to t under the fluid's pressure P at y = 0, P - w y elsewhere, and the closing stress s(y) has
//   K(t) = P sqrt(pi a) - S(t),  S(+-a) = (pi a)^(-1/2) int (s(y) + w y) sqrt((a +- x)/(a -+ x)) dx,  a = (t - b)/2,
// with x = y - (b + t)/2 (griffith.hpp), and the like at b. A tip is critical at P_c = (K_Ic + S)/sqrt(pi a), with K_Ic
// of the rock that it would break next. The pressure rises slowly: while it is above P_c of a tip, the tip with the
// lower P_c grows; the crack comes to rest where it is below both. It does not close: where S exceeds what the faces
// bear, K is that of faces that overlap.
#pragma once

#include <vector>

namespace strata::reference {

// Layers from below to above; the lowest and the highest have no end. SI, stress positive in compression.
struct StressLayers {
  std::vector<double> border;     // between layers, m, ascending; one fewer than layers
  std::vector<double> stress;     // closing stress of each layer at y = 0 on its line extended, Pa
  std::vector<double> toughness;  // K_Ic of each layer, Pa sqrt(m), >= 0
  double stress_slope = 0.0;      // ds/dy of all layers, Pa/m
  double fluid_weight = 0.0;      // w, Pa/m: density times gravity

  // Throws std::invalid_argument unless the lengths fit, all is finite, borders ascend and no toughness is negative.
  void validate() const;
};

struct CrackEnds {
  double bottom = 0.0;  // b, m
  double top = 0.0;     // t, m
};

// Pressures at which the tips of a crack are critical, Pa.
struct CriticalPressures {
  double bottom = 0.0;
  double top = 0.0;
};

// P_c of both tips of a crack, bottom < top (m). Throws std::invalid_argument otherwise and as validate().
CriticalPressures critical_pressures(const StressLayers& layers, const CrackEnds& crack);

// Where a crack that starts from `start` rests when the pressure has risen to `pressure` (Pa at y = 0). A tip stops at
// `limits` (m), for a crack that nothing holds has no end. Tips move in pieces of 1/200 of the height, each to rest by
// bisection: 1e-12 of the height, and 1e-7 where both move and one unloads the other (pieces of 1/2000 tell). Throws as
// critical_pressures, and unless limits enclose start.
CrackEnds grown_to_rest(const StressLayers& layers, const CrackEnds& start, double pressure, const CrackEnds& limits);

// Least pressure (Pa at y = 0) at which the top tip passes y = `height` (m, above start.top, within limits).
// Throws as grown_to_rest.
double pressure_to_pass(const StressLayers& layers, const CrackEnds& start, double height, const CrackEnds& limits);

}  // namespace strata::reference
