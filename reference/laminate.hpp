// A bonded stack of layers, free of stress before it is loaded by tractions on its edges.
//
// Layers lie along x and are stacked along y. Far from the sides all have the same strain along x and the same stress
// across, and no shear; with plane strain Hooke's law and the balance of force across the whole height,
//   sigma_xx,k = E'_k e_xx + nu_k/(1 - nu_k) sigma_yy,  sum_k h_k sigma_xx,k = -p_h sum_k h_k,  sigma_yy = -p_v,
// E' = E/(1 - nu^2). (The rule of mixtures for loads along the layers: Jones 1999, Mechanics of composite materials,
// chapter 3.) The stack does not bend: it is symmetric about its lower edge, or held straight.
#pragma once

#include <vector>

#include "rock.hpp"

namespace strata::reference {

struct Ply {
  Rock rock;
  double thickness = 1.0;  // m
};

struct Laminate {
  double strain_xx = 0.0;         // of all layers, tension positive
  double stress_yy = 0.0;         // of all layers (Pa), tension positive
  std::vector<double> stress_xx;  // Pa, one a layer
  std::vector<double> strain_yy;  // the same
};

// The state of a stack under the edge pressures p_h on the sides and p_v on top (Pa, positive in compression).
// Throws std::invalid_argument for no layer, a thickness or E not positive, or nu outside [0, 0.5).
Laminate loaded_laminate(const std::vector<Ply>& plies, double p_h, double p_v);

}  // namespace strata::reference
