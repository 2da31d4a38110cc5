// What a scene says as a whole: whether its parts fit each other.
#pragma once

#include "scene/faults.hpp"
#include "scene/scene.hpp"

namespace strata {

/// Adds to `faults` where cells do not divide the block, interfaces or particles do not fit the cells, the fracture
/// does not lie in the block or meets itself, and where the run could not end; each with what to do. What depends on a
/// value that is itself missing or of no use is left out. Throws nothing but std::bad_alloc.
void check_scene(const Scene& scene, const Positions& positions, Faults& faults);

/// The part of it that concerns keys which do not go together: the ways to solve, the fluid's laws and inlets, and what
/// a run may hold at most.
void check_combinations(const Scene& scene, const Positions& positions, Faults& faults);

}  // namespace strata
