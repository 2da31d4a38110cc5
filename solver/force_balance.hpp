// An equilibrium held against the loops over particles of runs with inertia.
#pragma once

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Balance of forces at every node of an equilibrium, by the loops over particles that runs with inertia use and the
/// condensed block does not: f_i = -sum V sigma grad N_i of the particles' stress against D^T (P n - t_in_situ + r) A
/// of surfaces, springs of tips and the body force. Notes the largest force left over the largest load. All particles
/// must be up to date. Throws nothing.
void watch_forces(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
