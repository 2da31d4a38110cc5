// How many points stand across a cell at the start, as the block is filled and as its memory is estimated.
#pragma once

#include "scene/scene.hpp"

namespace strata {

/// Whether a fracture's path may leave its straight line: it grows, and by the direction of the largest hoop stress.
/// Throws nothing.
bool may_turn(const Scene& scene);

/// Points across a cell at the start: the root of numerics.particles_per_cell, or four where that is two and a layer is
/// too thin for it or, without inertia, the path may turn. Throws nothing.
int points_across(const Scene& scene);

}  // namespace strata
