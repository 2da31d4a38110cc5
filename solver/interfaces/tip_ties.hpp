// Where the tip lies within a cell. A node is split once its projection lies behind the tip, so the tip of the discrete
// fracture jumps by whole cells; springs between the two copies of nodes less than a cell behind the tip fade the last
// row in instead, and K no longer depends on where in a cell the tip lies.
#pragma once

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Rebuilds state.ties for the present tips: for a node pair a distance xi h behind the tip (0 < xi < 1) a spring
///   k = c E' (1 - xi)/xi N(d/h)   (Pa per metre of thickness, both components)
/// with d the node's distance across the fracture and N the quadratic B-spline, so that a row shares one spring
/// whatever its number of nodes. c is measured, not derived: see tip_tie_coefficient. Node pairs that stay keep their
/// jump; energy in springs that vanish goes to the ledger's excess. Call after rebuild_copies().
void update_tip_ties(const Scene& scene, const Rocks& rocks, State& state);

/// All that follows from particles and surfaces: rebuild_copies(), then the springs of the present tips and, of runs
/// with inertia, the bonded places of interfaces. Throws NumericalFailure as rebuild_copies() does.
void rebuild(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
