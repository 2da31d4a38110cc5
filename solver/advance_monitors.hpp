// What the monitors take up beside the steps (see state/monitors.hpp).
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Expected momentum after one step of inertia: sum m v of its start, less what damping took, plus dt sum m b of the
/// body force (kg/s per metre of thickness). Tractions on the two faces of a surface cancel, in-situ ones at edges are
/// in balance with the in-situ state. Throws nothing.
void expect_momentum(const Scene& scene, State& state);

/// Energies, momentum and contact as they now are, at a row of the history: the ledger's strain and the particles must
/// be up to date. At step 0 the momentum found is the one expected from there on. Throws nothing.
void watch_row(const Scene& scene, State& state);

/// Balance of forces at every node of an equilibrium, by the loops over particles that runs with inertia use and the
/// condensed block does not: f_i = -sum V sigma grad N_i of the particles' stress against D^T (P n - t_in_situ + r) A
/// of surfaces, springs of tips and the body force. Notes the largest force left over the largest load. All particles
/// must be up to date. Throws nothing.
void watch_forces(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

}  // namespace strata
