// The two loops over particles: sums of mass, momentum and internal force to the nodes, and motion back to particles.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// What the particles say of a step: their kinetic energy (J/m) before and after they took up the grid's motion, the
// square of their largest speed (m^2/s^2), and how far any is from the middle node of its bin (cells, along x or y).
struct ParticleReport {
  double before = 0.0;
  double after = 0.0;
  double body_work = 0.0;    // of the body force in the step, sum m b . du (J/m)
  double step_strain = 0.0;  // energy of the step's own strain, sum V dsigma : de/2 (J/m)
  double largest_speed2 = 0.0;
  double farthest_cells = 0.0;
};

/// Particles to grid: m_i = sum_p N_ip m_p, mom_i = sum_p N_ip m_p v_p, f_i = sum_p N_ip m_p b_p - V_p sigma_p grad
/// N_ip, where sigma_p is the change of stress from the in-situ state and b_p the body force per mass of state.body, if
/// any. Overwrites state.sums; ghosts are not folded yet.
void particles_to_grid(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

/// Second filter pass of XPIC(2) (Hammerquist & Nairn 2017): returns v**_i = (1/m_i) sum_p N_ip m_p sum_j N_jp v_j for
/// the node velocities `v` (m/s, one a record), ghosts folded.
std::vector<Vec2> filter_velocity(const Scene& scene, State& state, const std::vector<Vec2>& v);

/// Grid to particles over state.dt: v_p = keep v_p + sum_i N_ip dv_i, x_p and u_p += dt sum_i N_ip v_i,
/// g_p += dt sum_i v_i grad N_ip. FLIP keeps v_p (keep = 1 without damping) and adds increments; PIC and XPIC keep
/// nothing and find the whole velocity in dv. Under kinematics = "total" x_p stays.
ParticleReport grid_to_particles(const Scene& scene, const std::vector<Elasticity>& rocks, State& state, double keep);

/// Adds what tied records gathered to their masters (see Master), component by component, and clears the records
/// outside symmetric and fixed edges.
void fold_to_masters(const State& state, std::vector<NodeSums>& sums);

}  // namespace strata
