// What bonded interfaces carry under kinematics = "total", straight from the nodes.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// The forces of the rock of the samples of bonded places as linear functions of the nodal displacements since the base
/// and accelerations; particles must be up to date. Throws nothing but std::bad_alloc.
std::vector<BondSensor> make_bond_sensors(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state);

/// What find_forces() gives, from the nodes (N/m). Throws nothing.
void forces_of_nodes(const State& state, std::vector<Vec2>& forces);

}  // namespace strata
