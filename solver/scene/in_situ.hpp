// The in-situ stress of a scene by place: by layer, by formula, with the rock's weight.
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "scene/derived.hpp"

namespace strata {

// Stress at a place (Pa), positive in compression; shear is sigma_xy, so that positive shear on the face towards +x
// acts towards +y.
struct InSituStress {
  double horizontal = 0.0, vertical = 0.0, shear = 0.0;
};

/// In-situ stress at places (m): what the layer there says of its own, else in_situ; with in_situ.weight vertical
/// stress is that at the block's top and g int_Y^H rho dY below it, unless its formula has Y. Under initialise =
/// "loaded" what this differs by from in_situ's numbers adds to the elastic stress. Throws std::logic_error where a
/// formula was not checked.
std::vector<InSituStress> in_situ_stress(const Scene& scene, const std::vector<Point>& places);

/// The largest of it (Pa, without sign) at the ends of the layers. Throws as in_situ_stress().
double largest_in_situ(const Scene& scene);

/// What is not in equilibrium, d sigma_xx/dX = 0 and d sigma_yy/dY = rho g, cannot be symmetric, or is not finite: the
/// key and a sentence with the place. Looks at 65 places along a layer and 9 across it, and just beyond its borders.
/// Throws as in_situ_stress().
std::vector<std::pair<std::string, std::string>> in_situ_faults(const Scene& scene);

}  // namespace strata
