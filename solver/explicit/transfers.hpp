// The loops over particles: sums of mass, momentum and internal force to the nodes, and motion back to particles.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// What the velocities of particles take up: v_p = keep v_p + sum_i N_ip (x_i, y_i), x and y with a number (m/s) for
// each record.
struct Uptake {
  double keep = 1.0;
  const SpreadArray *x = nullptr, *y = nullptr;
};

/// Particles to grid: m_i = sum_p N_ip m_p, mom_i = sum_p N_ip m_p v_p, f_i = - sum_p V_p sigma_p grad N_ip, where
/// sigma_p is the change of stress from the in-situ state. Overwrites state.sums; ghosts are not folded yet.
void particles_to_grid(const Scene& scene, const Rocks& rocks, State& state);

/// Adds f_i += sum_p N_ip m_p b_p of the body force per mass state.body, if any, and keeps it in state.body_sums.
void add_body_force(const Scene& scene, State& state);

/// Second filter pass of XPIC(2) (Hammerquist & Nairn 2017): (m_i, mom_i) = sum_p N_ip m_p (1, sum_j N_jp v_j) for the
/// mapped velocities v = v_i - dv_i of state.motion, ghosts folded, into state.filtered.
void filter_velocity(const Scene& scene, State& state);

/// Grid to particles over state.dt: v_p = keep v_p + sum_i N_ip take_i, x_p and u_p += dt sum_i N_ip v_i, g_p += dt
/// sum_i v_i grad N_ip. FLIP keeps v_p (keep = 1 without damping) and adds increments; PIC and XPIC keep nothing and
/// take up the whole velocity.
ParticleReport grid_to_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state);

/// grid_to_particles() and then particles_to_grid() of where that leaves them, in one sweep over the particles:
/// state.sums are then those of the next step.
ParticleReport sweep_particles(const Scene& scene, const Rocks& rocks, const Uptake& uptake, State& state);

/// Adds what tied records gathered to their masters (see Master), component by component, and clears the records
/// outside symmetric and fixed edges.
void fold_to_masters(const State& state, NodalSums& sums);

}  // namespace strata
