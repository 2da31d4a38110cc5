// How far the rock is open already where a fracture has just grown to.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Gives the fracture's new points and vertices (those whose jump is still exactly nothing) the jump that the
/// displacements have there, w = D u: within a cell a tip grows into nodes that are split, whose sides have moved apart
/// before. Without it faces would meet, and J would be too small, by what had opened. Copies must be built, and all
/// particles up to date. Changes state.sums. Throws nothing but std::bad_alloc.
void open_new_points(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

}  // namespace strata
