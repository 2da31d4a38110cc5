// Growth of the fracture: when a tip moves, where to, and what is told about it.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Moves every tip whose J has reached J_c = K_Ic^2/E' of the rock ahead by one increment, along its own direction or
/// that of maximum hoop stress. A tip moves no faster than the Rayleigh speed of that rock: the next increment waits
/// for increment/c_R. An increment that would end just short of an interface, or cross it, ends on it; one that starts
/// on it goes on. A tip within 3 cells of an edge stops for good and says so. Returns true if any tip moved: the copies
/// must then be rebuilt.
bool grow(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

/// Appends the events reach_interface and arrest as they become true; start and restart come with grow().
void watch_tips(const Scene& scene, State& state);

/// Splits particles within 1.5 cells of the fracture's points [first, last) into four where a cell has fewer than 16
/// and the fracture lies neither on a grid line nor at mid-cell, or where it passes through a particle: 2 x 2 points a
/// cell do not resolve the sides of such a fracture.
void refine_particles(State& state, std::size_t first, std::size_t last);

/// Position of a tip (m).
inline Vec2 tip_position(const State& state, const Tip& tip) {
  return tip.at_back ? state.fracture().vertices.back().x : state.fracture().vertices.front().x;
}

/// Spacing of the points of surfaces (m): two a cell.
inline double surface_spacing(const Grid& grid) {
  return 0.5 * grid.h;
}

/// Sets the sides, the in-situ traction and, for the fracture, the split of points from `state` and the uniform in-situ
/// stress of the scene or the particles' own, averaged near the point.
void place_points(const Scene& scene, State& state, Surface& surface);

}  // namespace strata
