// Values that the solver can compute with but that no rock, stress or fluid has: most are given in another unit.
#pragma once

#include <string>
#include <vector>

#include "scene/scene.hpp"

namespace strata {

/// A sentence for each value of the scene that is so far from all rocks and fluids that its unit is the likely reason;
/// the bounds' reasons are in the source. Such a scene runs, and its run is marked. Throws nothing but std::bad_alloc.
std::vector<std::string> implausible(const Scene& scene);

}  // namespace strata
