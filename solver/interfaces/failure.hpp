// What bonded places of interfaces carry, told by the balance of columns of nodes across, and when they let go.
#pragma once

#include <set>
#include <utility>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// How near a bonded place is to failure under normal and tangential reaction n (compression positive) and t (Pa): 1
/// where it fails. weak: sqrt((S/Sc)^2 + (N/Nc)^2), N in tension only (the study's eq. 5); friction: |t|/(mu n),
/// infinite in tension; other laws: 0.
double failure_index(const InterfaceLaw& law, double n, double t);

/// The bonded places of a state's weak and friction interfaces, with their samples; its copies must be built. Throws
/// nothing.
Bonds find_bonds(const Scene& scene, const State& state);

/// Forces of the samples' rock, sum_p V_p sigma_p grad Phi + sum_i m_i a_i (N/m), from the particles' present strain
/// and, in runs with inertia, the accelerations that forces gave the nodes. Throws nothing.
void find_forces(const Rocks& rocks, const State& state, Bonds& bonds);

/// What bonded places carry under these forces, the body force and the present tractions on the fracture, and how near
/// each is to failure. A place is judged on the mean traction over failure_length() of bonded
/// interface from it on, to either side, where so much of it is bonded: stress grows without bound towards the edge of
/// what has let go and towards a tip, so that the value at a point would be the cell's. Where less is bonded between
/// two edges, on the mean over all of it. Throws nothing.
void judge_bonds(const Scene& scene, const State& state, Bonds& bonds);

// Columns of nodes, told by their surface, along an interface.
using Columns = std::set<std::pair<std::size_t, int>>;

/// Those that let go now. Without inertia: of the worst places under a weak law, and those as bad but for round-off,
/// since each changes what the others carry; of all that slide under friction, which give nothing up by it. With
/// inertia: of all places, since waves pass on what each gives up, and sweeps over contact leave the two sides of a
/// symmetric block less alike than round-off. Throws nothing.
Columns failing_columns(const Scene& scene, const State& state, const Bonds& bonds);

/// Lets the bonded places in some columns go. The law takes over from what they carried: compression, and shear as what
/// friction remembers, which the law then bounds. The copies must then be rebuilt. mask: of other surfaces, of whose
/// sides places must have `sides`. Throws nothing.
void let_go(const Columns& columns, const Bonds& bonds, State& state, SideWord mask = 0, SideWord sides = 0);

/// Gives the points of interfaces what the bonded block of the in-situ state `loaded` hands over there, as tractions
/// whose forces on the columns are those of the rock on the - side:
///   sum_s A_s Phi_c(x_s) t(x_s) = -sum_p V_p (sigma_p - sigma) grad Phi_c,  t(x) = sum_c Phi_c(x) t_c,
/// and -sigma n on top, with sigma the stress that balances the edges' tractions (Pa). A mean of the particles around
/// is up to 10 % off between unlike rocks, whose strain the splines make continuous. Springs that take compression keep
/// what they have. Throws NumericalFailure where the columns cannot be told apart.
void hand_over_in_situ(const Scene& scene, State& state);

}  // namespace strata
