#include "explicit/advance.hpp"

#include <algorithm>
#include <cmath>

#include "explicit/interface_laws.hpp"
#include "explicit/momentum.hpp"
#include "explicit/motion_monitors.hpp"
#include "explicit/new_openings.hpp"
#include "explicit/total/advance_total.hpp"
#include "explicit/total/total_base.hpp"
#include "explicit/transfers.hpp"
#include "flow/flow_monitors.hpp"
#include "flow/paper_flow.hpp"
#include "fracture/growth.hpp"
#include "fracture/j_integral.hpp"
#include "interfaces/failure.hpp"
#include "interfaces/monitors.hpp"
#include "interfaces/surface_tractions.hpp"
#include "interfaces/tip_ties.hpp"
#include "state/body_force.hpp"
#include "state/rebuild.hpp"

namespace strata {

namespace {

// Stored energies now, and what the transfer lost: the grid's gain in kinetic energy that the particles did not take
// up.
void close_ledger(const Scene& scene, const std::vector<Elasticity>& rocks, const GridEnergy& grid,
                  const GridEnergyAfter& after, const ParticleReport& particles, State& state) {
  Ledger& ledger = state.ledger;
  ledger.kinetic = particles.after;
  ledger.transfer += (after.kinetic - grid.mapped) - (particles.after - particles.before);
  ledger.integration += after.increment - particles.step_strain;
  ledger.interface_strain = spring_energy(scene, state);
  note_largest(state.monitors.largest_particle_velocity, std::sqrt(particles.largest_speed2));
  ledger.note_scale();
  require_stable(scene, rocks, state);
}

void advance_updated(const Scene& scene, const std::vector<Elasticity>& rocks, bool look, bool grow_now,
                     const WeighGrowth& weigh, State& state) {
  advance_pressure(scene, state);                               // P(s) from the opening at the step's start
  set_body_acceleration(scene, state.time, state);              // b(X_p, t)
  if (!state.gathered) particles_to_grid(scene, rocks, state);  // m_i, mom_i, f_i
  add_body_force(scene, state);                                 // f_i += sum N m b
  update_stencil_weights(scene, state);                         // N_i(x_s) of D
  add_net_tractions(state);                                     // f_i += D^T (P n - t_in_situ) A
  fold_to_masters(state, state.sums);                           // symmetric and fixed edges
  const GridEnergy grid = advance_momentum(scene.numerics.damping_1_s, state);  // v_i = mom_i/m_i + dt f_i/m_i
  const double friction = state.ledger.friction;
  solve_reactions(scene, rocks, state);  // contact, friction, springs at the step's end
  watch_made(grid.mapped, grid.swing - 0.5 * (state.ledger.friction - friction), state);
  const GridEnergyAfter after = grid_energy(state);
  take_damping(scene.numerics.damping_1_s, grid, state);  // as v_i at the step's start and end have it
  spread_to_tied(state);
  state.ledger.body_work += body_work(state);
  const Uptake uptake = prepare_transfer(scene, state);  // FLIP, PIC or XPIC
  // v_p, x_p, grad u_p (and with it stress), and with fast kernels the next step's m_i, mom_i, f_i
  const auto move_particles = scene.numerics.in_lanes() ? sweep_particles : grid_to_particles;
  const ParticleReport particles = move_particles(scene, rocks, uptake, state);
  follow_surfaces(state);  // w += dt D v
  state.time += state.dt;
  ++state.step;
  close_ledger(scene, rocks, grid, after, particles, state);
  expect_momentum(scene, state);
  const bool changed = bonds_fail(scene, rocks, state);
  if (changed) let_go(failing_columns(scene, state, state.bonds), state.bonds, state);
  if (look) measure_tips(scene, rocks, state);  // J, K_I, K_II with the same P
  if (look) watch_flow(scene, state);
  const bool may_grow_now = grow_now && !changed;                // interfaces answer first
  if (may_grow_now) weigh(state);                                // G where energy decides
  const bool grown = may_grow_now && grow(scene, rocks, state);  // new points ahead of the tip
  watch_tips(scene, state);
  const bool moved = state.step % steps_between_rebuilds == 0 || particles.farthest_cells > bin_reach_cells;
  if (changed || grown || moved) {
    rebuild(scene, rocks, state);
    if (grown) open_new_points(scene, rocks, state);
    state.ledger.interface_strain = spring_energy(scene, state);
  }
}

// Whether a tip runs at the end of the step that begins.
bool any_runs(const State& state) {
  return std::ranges::any_of(state.tips, [&](const Tip& tip) { return runs(tip, state.time + state.dt); });
}

}  // namespace

void advance(const Scene& scene, const std::vector<Elasticity>& rocks, State& state, const WeighGrowth& weigh,
             bool look) {
  const bool grows = state.has_fracture && scene.fracture->growth != Fracture::Growth::none;
  const bool grow_now = grows && ((state.step + 1) % scene.numerics.tip_steps == 0 || any_runs(state));
  const bool total = scene.numerics.kinematics == Numerics::Kinematics::total;
  (total ? advance_total : advance_updated)(scene, rocks, look || grow_now, grow_now, weigh, state);
  require_finite(state);
}

void complete_particles(const Scene& scene, State& state) {
  bring_up_to_date(scene, state);
}

}  // namespace strata
