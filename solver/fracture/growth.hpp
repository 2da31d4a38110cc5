// Growth of the fracture: when a tip moves, where to, and what is told about it.
#pragma once

#include <string>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Moves every tip whose driving() has reached J_c of the rock ahead by an increment, along its own direction or that
/// of maximum hoop stress, no faster than the Rayleigh speed of that rock: increments due since the last step come at
/// once, but for those that energy decides about. What would cross an interface, or end less than a quarter of an
/// increment short of it, ends on it; what starts on it, or so near to a bonded one, goes on. A tip that has no room
/// (what_stops()) stops for good. Returns true if any tip moved: the copies must then be rebuilt. Throws nothing.
bool grow(const Scene& scene, const Rocks& rocks, State& state);

/// Whether grow() would look at any tip more closely now: it has reached J_c and its wait is over. Throws nothing.
bool ready_to_grow(const Scene& scene, const Rocks& rocks, const State& state);

/// Whether a tip runs at a time (s), so that it is looked at in every step: its next increment is due, and waves of its
/// last one have not yet crossed the rings that J is measured in. Throws nothing.
bool runs(const Tip& tip, double time);

/// Index of the rock that a tip is about to enter. Throws nothing.
std::size_t rock_ahead(const Scene& scene, const State& state, const Tip& tip);

/// What leaves a tip no room to grow or to measure J in, "" where nothing does: an edge that it heads for, nearer than
/// 3 cells or than 1.5 after the next increment, once it has grown; the coarse cells of a graded grid, nearer than a
/// cell beyond its rings. Throws nothing but std::bad_alloc.
std::string what_stops(const Scene& scene, const State& state, const Tip& tip);

/// Stops a tip for good, with the reason, where something stops it so; whether it did. Throws nothing but
/// std::bad_alloc.
bool stop_at_edge(const Scene& scene, const State& state, Tip& tip);

/// Lengthens the fracture at a tip by `times` increments of `increment` (m), less where an interface stops it (see
/// grow()); returns by how much (m). The copies must then be rebuilt. Throws nothing.
double extend_tip(const Scene& scene, State& state, Tip& tip, double increment, double times = 1.0);

/// Takes away the last pieces of the fracture at a tip, as many as lie within `length` (m) of it, but for one; returns
/// how much (m). The copies must then be rebuilt. Throws nothing.
double shorten_tip(State& state, Tip& tip, double length);

/// Notes that a tip grows now: events start and restart, time and pressure of its last growth, and what decided it.
void note_growth(State& state, Tip& tip);

/// Appends the events reach_interface and arrest as they become true; start and restart come with grow().
void watch_tips(const Scene& scene, State& state);

/// Splits particles in four: within 1.5 cells of the fracture's points [first, last) where a cell has fewer than 16 and
/// the fracture lies neither on a grid line nor at mid-cell, since 2 x 2 do not resolve its sides; and where it passes
/// through one. Without inertia a sixteenth of a cell that it passes through stays whole, on the + side, unless a piece
/// has more than two: the intact block keeps the stiffness that was factored.
void refine_particles(const Scene& scene, State& state, std::size_t first, std::size_t last);

/// Spacing of the points of surfaces (m): two a cell.
inline double surface_spacing(const Grid& grid) {
  return 0.5 * grid.h;
}

/// Sets the sides of a surface's points and vertices and, at the points, the in-situ traction -sigma_0 n (Pa) from the
/// scene's uniform in-situ stress or that of the particles of the same rock around; the fracture's points are split.
/// Throws nothing.
void place_points(const Scene& scene, State& state, Surface& surface);

}  // namespace strata
