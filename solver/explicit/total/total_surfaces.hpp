// Surfaces under kinematics = "total": what each step does at them, set up once for all steps between two events.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// The point of a surface, or the spring of a tip, that a place is.
template <class AnyState>
auto& point_of(AnyState& state, const TotalPlace& place) {
  const auto k = static_cast<std::size_t>(place.point);
  if (place.surface < 0) return state.ties[k].s;
  return state.surfaces[static_cast<std::size_t>(place.surface)].points[k];
}

/// Adds `change` (Pa, on the + face) to the reaction of a place, whose point is s, and what it does in a step to the
/// rates of the jumps of all places that share nodes with it.
void add_reaction(const TotalPlace& place, const Vec2& change, SurfacePoint& s, TotalSurfaces& surfaces);

/// The split places of a state and what they reach, over slots. Weights of stencils must be known
/// (update_stencil_weights()), and state.total.m.
TotalSurfaces make_total_surfaces(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state);

/// One step of all split places: net tractions (add_net_tractions()), reactions (solve_reactions()) and jumps
/// (follow_surfaces()), with their shares of the ledger and the monitors. What they exert is added to the accelerations
/// of the nodes, state.total.a_x and a_y. Returns its power sum m v . a at the velocities of the step's end (W/m).
/// keep: share of its velocity that a node keeps.
double step_surfaces(double keep, State& state);

/// The forces of the rock of the samples of bonded places as linear functions of the nodal displacements since the base
/// and accelerations; particles must be up to date. Throws nothing but std::bad_alloc.
std::vector<BondSensor> make_bond_sensors(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state);

/// What find_forces() gives, from the nodes (N/m). Throws nothing.
void forces_of_nodes(const State& state, std::vector<Vec2>& forces);

}  // namespace strata
