// Finer points where a fracture that may turn, its tips' rings or an interface need them (see state/quarters.hpp).
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Divides the particles that stand for four within 3.25 cells of the fracture's points [first, last), along x and y
/// alike, and within J's rings of its tips. A node that a surface cuts is no farther from it than functions reach, 1.5
/// cells; the particles of its bins and of the balance of bonded columns no more than 1.25 cells farther. Sides are
/// their parent's. Throws nothing.
void refine_beside(const Scene& scene, State& state, std::size_t first, std::size_t last);

/// The same at the start, beside all surfaces; and where a border of rocks passes through a particle, whose quarters
/// are of their own rocks. Throws nothing.
void refine_beside_all(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

}  // namespace strata
