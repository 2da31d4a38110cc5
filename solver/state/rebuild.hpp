// Builds everything in a State that follows from particles and surfaces: copies of nodes, bins, strips, masters and
// surface stencils. Called at the start, after growth or failure, and when particles have changed bins.
#pragma once

#include "state/state.hpp"

namespace strata {

// How far a node tells the sides of a surface apart, in cells: as far as its shape function reaches, 1.5 for the
// quadratic B-spline and 1 for hat functions. uGIMP particles reach half their size further, but there a copy would
// hold no more than the round-off of a particle that just touches it.
double support_in_cells(const Scene& scene);

/// Sorts the particles into bins and rebuilds all derived members of `state` (see state.hpp); the order of particles,
/// and with it every sum, depends on their positions, sides and ids only. Throws NumericalFailure where a particle has
/// left the block.
void rebuild_copies(const Scene& scene, State& state);

// A particle may be this far from the middle node of its bin (cells) before it is sorted anew. The polynomial pieces of
// its old bin still reproduce linear fields exactly there and differ by less than 1e-6; a lattice of 3 x 3 points,
// whose middle stands on the border of two bins, would change bins at every step without the margin.
constexpr double bin_reach_cells = 0.5 + 1e-3;

/// The side word of a place (m): the one rule side() applied to every surface but `except` (-1: to all).
SideWord sides_at(const State& state, const Vec2& x, int except);

/// The bin of each particle: index into state.bins. Throws nothing but std::bad_alloc.
std::vector<std::size_t> bins_of_particles(const State& state);

/// The side word of the rock that a tip is about to enter. Throws nothing.
SideWord sides_ahead(const State& state, const Tip& tip);

// How far surfaces are extended straight when sides are told apart (m).
inline double extension(const Grid& grid) {
  return 4.0 * grid.h;
}

}  // namespace strata
