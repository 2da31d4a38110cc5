#include "explicit/advance.hpp"

#include <algorithm>
#include <cmath>

#include "explicit/momentum.hpp"
#include "explicit/reactions.hpp"
#include "explicit/total/total_base.hpp"
#include "explicit/total/total_operator.hpp"
#include "explicit/transfers.hpp"
#include "flow/flow_monitors.hpp"
#include "flow/paper_flow.hpp"
#include "fracture/growth.hpp"
#include "fracture/j_integral.hpp"
#include "interfaces/failure.hpp"
#include "interfaces/monitors.hpp"
#include "interfaces/surface_law.hpp"
#include "interfaces/surface_tractions.hpp"
#include "interfaces/tip_ties.hpp"
#include "state/body_force.hpp"
#include "state/rebuild.hpp"

namespace strata {

namespace {

// What a step of motion leaves: whether bonded places fail, and whether particles have left their bins behind.
struct Moved {
  bool bonds_fail = false, bins_left = false;
};

// Springs, the largest speed and the scale of energies at the step's end.
void note_energies(const Scene& scene, double largest_speed2, State& state) {
  state.ledger.interface_strain = spring_energy(scene, state);
  note_largest(state.monitors.largest_particle_velocity, std::sqrt(largest_speed2));
  state.ledger.note_scale();
}

// The motion of particles over the grid, kinematics = "updated".
Moved move_particles(const Scene& scene, const Rocks& rocks, State& state) {
  Ledger& ledger = state.ledger;
  if (!state.gathered) particles_to_grid(scene, rocks, state);                  // m_i, mom_i, f_i
  add_body_force(scene, state);                                                 // f_i += sum N m b
  update_stencil_weights(scene, state);                                         // N_i(x_s) of D
  add_net_tractions(state);                                                     // f_i += D^T (P n - t_in_situ) A
  fold_to_masters(state, state.sums);                                           // symmetric and fixed edges
  const NodeTotals grid = advance_momentum(scene.numerics.damping_1_s, state);  // v_i = mom_i/m_i + dt f_i/m_i
  const double friction = ledger.friction;
  solve_reactions(scene, rocks, state);  // contact, friction, springs at the step's end; w += dt D v
  watch_made(grid.kinetic, 0.5 * (state.dt * grid.power - (ledger.friction - friction)), state);
  const NodeTotals after = grid_energy(state);
  take_damping(1.0 - scene.numerics.damping_1_s * state.dt, grid.kinetic, after.product, ledger);
  spread_to_tied(state);
  ledger.body_work += body_work(state);
  const Uptake uptake = prepare_transfer(scene, state);  // FLIP, PIC or XPIC
  // v_p, x_p, grad u_p (and with it stress), and with fast kernels the next step's m_i, mom_i, f_i
  const auto to_particles = scene.numerics.in_lanes() ? sweep_particles : grid_to_particles;
  const ParticleReport particles = to_particles(scene, rocks, uptake, state);
  follow_surfaces(state);
  state.time += state.dt;
  ++state.step;
  ledger.kinetic = particles.after;
  ledger.transfer += (after.kinetic - grid.kinetic) - (particles.after - particles.before);
  ledger.integration += after.increment - particles.step_strain;
  note_energies(scene, particles.largest_speed2, state);
  require_stable(scene, rocks, state);
  const bool bins_left = particles.farthest_cells > bin_reach_cells || state.step % steps_between_rebuilds == 0;
  return {bonds_fail(scene, rocks, state), bins_left};
}

// Of all forces but the rock's own and those of springs, whose step is implicit and takes but what they store.
double work_of_loads(const Ledger& ledger) {
  return ledger.fluid_work + ledger.in_situ_work + ledger.body_work - ledger.friction;
}

// The motion of nodes that keep their particles, kinematics = "total". Between events all that a step needs is fixed,
// and particles stand still at the last base. look: leave what J needs in state.motion.
Moved move_base(const Scene& scene, const Rocks& rocks, bool look, State& state) {
  Ledger& ledger = state.ledger;
  const double keep = 1.0 - scene.numerics.damping_1_s * state.dt, loads = work_of_loads(ledger);
  push_body(scene, state);                           // a_i += sum N_ip m_p b_p / m_i
  double external = push_split_places(keep, state);  // a_i += tractions, contact, friction, springs; w += dt D v
  const NodeTotals moved = move_nodes(keep, state);  // v_i, u_i
  if (look || !state.body.empty()) note_motion(state);
  const double body = body_work(state);
  ledger.body_work += body;
  external += body / state.dt;
  state.time += state.dt;
  ++state.step;
  const bool fail = bonds_fail(scene, rocks, state);
  const double elastic = find_accelerations(scene, rocks, state);  // a_i = -(M^-1 K u)_i + ...
  take_damping(keep, ledger.kinetic, moved.product, ledger);
  ledger.kinetic = moved.kinetic;
  // What the rock stores and what its force of the step's start does differ by v K v dt^2/2, which follows from the
  // change of that force.
  ledger.integration += moved.increment - 0.5 * state.dt * (moved.power - external - elastic);
  note_energies(scene, moved.largest_speed2, state);
  // What loads did in the step the next will do as well, as much as they do not jump.
  watch_made(ledger.kinetic, 0.5 * (state.dt * elastic + (work_of_loads(ledger) - loads)), state);
  require_stable(scene, rocks, state);
  return {fail, false};
}

// Copies after an event. Under kinematics = "total" nodes go on with the velocities they had.
void follow_event(const Scene& scene, const Rocks& rocks, bool grown, State& state) {
  const bool total = scene.numerics.kinematics == Numerics::Kinematics::total;
  const RecordVelocities before = total ? RecordVelocities{state.copies, state.total.velocity} : RecordVelocities{};
  rebuild(scene, rocks, state);
  if (grown) open_new_points(scene, rocks, state);
  if (total) {
    carry_velocities(scene, before, state);
    start_base(scene, rocks, state);
    recount_kinetic(state);
  }
  state.ledger.interface_strain = spring_energy(scene, state);
}

// Whether a tip runs at the end of the step that begins.
bool any_runs(const State& state) {
  return std::ranges::any_of(state.tips, [&](const Tip& tip) { return runs(tip, state.time + state.dt); });
}

}  // namespace

void advance(const Scene& scene, const Rocks& rocks, State& state, const WeighGrowth& weigh, bool look) {
  const bool total = scene.numerics.kinematics == Numerics::Kinematics::total;
  const bool grows = state.has_fracture && scene.fracture->growth != Fracture::Growth::none;
  const bool grow_now = grows && ((state.step + 1) % scene.numerics.tip_steps == 0 || any_runs(state));
  look = look || grow_now;
  if (total) start_base(scene, rocks, state);       // after events: a_i of the particles' stress
  advance_pressure(scene, state);                   // P(s) from the opening at the step's start
  set_body_acceleration(scene, state.time, state);  // b(X_p, t)
  const Moved moved = total ? move_base(scene, rocks, look, state) : move_particles(scene, rocks, state);
  expect_momentum(scene, state);
  if (moved.bonds_fail) {
    bring_up_to_date(scene, state);
    let_go(failing_columns(scene, state, state.bonds), state.bonds, state);
  }
  if (look) measure_tips(scene, rocks, state);  // J, K_I, K_II with the same P
  if (look) watch_flow(scene, state);
  bool grown = false;
  if (grow_now && !moved.bonds_fail) {  // interfaces answer first
    weigh(state);                       // G where energy decides
    if (!total || ready_to_grow(scene, rocks, state)) {
      bring_up_to_date(scene, state);
      grown = grow(scene, rocks, state);  // new points ahead of the tip
    }
  }
  watch_tips(scene, state);
  if (moved.bonds_fail || grown || moved.bins_left) follow_event(scene, rocks, grown, state);
  if (total && state.step % steps_between_bases == 0) bring_up_to_date(scene, state);
  require_finite(state);
}

bool bonds_fail(const Scene& scene, const Rocks& rocks, State& state) {
  // At a Courant number of 0.5 a front of failure, which goes by a column a look, is then as fast as a P wave.
  constexpr std::int64_t steps_between_looks = 2;
  Bonds& bonds = state.bonds;
  if (bonds.places.empty() || state.step % steps_between_looks != 0) return false;
  state.total.based ? forces_of_nodes(state, bonds.forces) : find_forces(rocks, state, bonds);
  judge_bonds(scene, state, bonds);
  if (std::isnan(bonds.worst)) throw NumericalFailure("the load of a bonded interface is not finite");
  return bonds.worst >= 1.0;
}

}  // namespace strata
