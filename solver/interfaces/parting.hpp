// Interfaces that part by energy: what of them may part next.
#pragma once

#include <vector>

#include "interfaces/failure.hpp"

namespace strata {

// Columns that part at once from an edge of what is bonded, or at both ends of what parts in mirror images.
struct Parting {
  Columns columns;
  SideWord mask = 0, sides = 0;  // of the fracture, where it parts on one side alone: places with these sides
  std::vector<Vec2> from;        // the edges (m)
  double length = 0.0;           // of what parts (m)
  double J_c = 0.0;              // what that takes per length, K^2 (1/E'_1 + 1/E'_2)/2 by the rocks on both sides (N/m)
};

/// What interfaces that have a toughness may part next: from each place where they are bonded no further, since they
/// have parted there or the fracture passes or ends, over fracture.crossing_increment_m or what is left; in a scene
/// that is mirror-symmetric with its mirror image. Throws nothing.
std::vector<Parting> next_partings(const Scene& scene, const Rocks& rocks, const State& state, const Bonds& bonds);

}  // namespace strata
