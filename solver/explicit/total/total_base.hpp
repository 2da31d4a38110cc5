// The base of kinematics = "total": when particles, surfaces and nodes were last of one state.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// The nodal field, by records, whose interpolation is that of the values (x, y) of the particles of some bins:
/// `passes` of v_i += (1/m_i) sum_p N_ip m_p (v_p - sum_j N_jp v_j) from nothing; of a wave of number k the n-th leaves
/// ((kh)^2/8)^n along each axis. Throws nothing but std::bad_alloc.
std::vector<Vec2> nodes_from_particles(const Scene& scene, const State& state, const std::vector<Bin>& bins,
                                       const SpreadArray& x, const SpreadArray& y, int passes);

/// Makes the particles as they are the base: masses, accelerations a_i = f_i/m_i of their stress, operator, surfaces.
/// Nodes take up state.total.velocity or, where a run starts, the velocity field that gives the particles theirs.
/// Does nothing where the base stands.
void start_base(const Scene& scene, const Rocks& rocks, State& state);

/// Brings particles (u, grad u, v = sum N_ip v_i) and surfaces (u, and the jumps of what is not split) up to date from
/// the nodes' displacements since the base, keeps the nodes' velocities in state.total.velocity and ends the base. Does
/// nothing where none stands.
void bring_up_to_date(const Scene& scene, State& state);

/// Leaves the motion of the step's end and what forces added to it in state.motion, by records, for J.
void note_motion(State& state);

/// Adds sum_p N_ip m_p b_p / m_i for the body force state.body, if any, to the nodes' accelerations.
void push_body(const Scene& scene, State& state);

// Velocities of the records of copies that an event is about to change.
struct RecordVelocities {
  Copies copies;
  std::vector<Vec2> v;  // m/s
};

/// Gives the records of new copies their velocities: those of the same node before; where it was cut, the mean of its
/// copies' by the mass of the particles that each brings. Momentum is thereby kept to round-off.
void carry_velocities(const Scene& scene, const RecordVelocities& before, State& state);

/// Ledger and nodal kinetic energy after an event: what the nodes lost (or gained) by it counts as lost in transfer.
void recount_kinetic(State& state);

/// The forces of the rock of the samples of bonded places as linear functions of the nodal displacements since the base
/// and accelerations; particles must be up to date. Throws nothing but std::bad_alloc.
std::vector<BondSensor> make_bond_sensors(const Scene& scene, const Rocks& rocks, const State& state);

/// What find_forces() gives, from the nodes (N/m). Throws nothing.
void forces_of_nodes(const State& state, std::vector<Vec2>& forces);

/// Gives the fracture's new points and vertices (those whose jump is still exactly nothing) the jump that the
/// displacements have there, w = D u: within a cell a tip grows into nodes whose sides have moved apart before. Copies
/// must be built, and all particles up to date. Changes state.sums. Throws nothing but std::bad_alloc.
void open_new_points(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
