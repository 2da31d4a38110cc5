#include "explicit/total/advance_total.hpp"

#include <cmath>

#include "explicit/interface_laws.hpp"
#include "explicit/momentum.hpp"
#include "explicit/motion_monitors.hpp"
#include "explicit/new_openings.hpp"
#include "explicit/total/total_base.hpp"
#include "explicit/total/total_operator.hpp"
#include "explicit/total/total_surfaces.hpp"
#include "flow/flow_monitors.hpp"
#include "flow/paper_flow.hpp"
#include "fracture/growth.hpp"
#include "fracture/j_integral.hpp"
#include "interfaces/failure.hpp"
#include "interfaces/tip_ties.hpp"
#include "state/body_force.hpp"

namespace strata {

namespace {

// The motion of the step's end and what forces added to it, by records: J takes its accelerations from it.
void note_motion(State& state) {
  const TotalMotion& t = state.total;
  for (std::size_t r = 0; r < state.motion.size(); ++r) {
    const auto slot = static_cast<std::size_t>(t.op->slots.of_record[r]);
    const Master& master = state.masters[r];
    state.motion[r] = {master.x * t.v_x[slot], master.y * t.v_y[slot], master.x * state.dt * t.a_x[slot],
                       master.y * state.dt * t.a_y[slot]};
  }
}

// Of all forces but the rock's own and those of springs, whose step is implicit and takes but what they store.
double work_of_loads(const Ledger& ledger) {
  return ledger.fluid_work + ledger.in_situ_work + ledger.body_work - ledger.friction;
}

// Energies at the step's end. external: power sum m v . a of all forces but the rock's own; elastic: of the rock's at
// the step's end; loads: what loads did in the step, of which the next will do as much as they do not jump (J/m). What
// the rock stores and what its force of the step's start does differ by v K v dt^2/2, which follows from the change of
// that force.
void close_ledger(const Scene& scene, const std::vector<Elasticity>& rocks, const NodeTotals& moved, double external,
                  double elastic, double loads, State& state) {
  Ledger& ledger = state.ledger;
  const double keep = 1.0 - scene.numerics.damping_1_s * state.dt;
  const double damped = (1.0 - keep) * (ledger.kinetic + 0.5 * moved.product);  // as take_damping() has it
  ledger.damping += damped;
  ledger.integration += (1.0 - keep * keep) * ledger.kinetic - damped;
  ledger.kinetic = moved.kinetic;
  ledger.integration += moved.increment - 0.5 * state.dt * (moved.power - external - elastic);
  ledger.interface_strain = spring_energy(scene, state);
  note_largest(state.monitors.largest_particle_velocity, std::sqrt(moved.largest_speed2));
  ledger.note_scale();
  watch_made(ledger.kinetic, 0.5 * (state.dt * elastic + loads), state);
  require_stable(scene, rocks, state);
}

// Copies after an event. Nodes go on with the velocities they had.
void rebuild_total(const Scene& scene, const std::vector<Elasticity>& rocks, bool grown, State& state) {
  RecordVelocities before{state.copies, state.total.velocity};
  rebuild(scene, rocks, state);
  if (grown) open_new_points(scene, rocks, state);
  carry_velocities(scene, before, state);
  start_base(scene, rocks, state);
  recount_kinetic(state);
  state.ledger.interface_strain = spring_energy(scene, state);
}

}  // namespace

void advance_total(const Scene& scene, const std::vector<Elasticity>& rocks, bool look, bool grow_now,
                   const WeighGrowth& weigh, State& state) {
  const double keep = 1.0 - scene.numerics.damping_1_s * state.dt;
  start_base(scene, rocks, state);                  // after events: a_i of the particles' stress
  advance_pressure(scene, state);                   // P(s) from the opening at the step's start
  set_body_acceleration(scene, state.time, state);  // b(X_p, t)
  const double before = work_of_loads(state.ledger);
  const BodyPush body = push_body(scene, state);     // a_i += sum N_ip m_p b_p / m_i
  double external = step_surfaces(keep, state);      // a_i += tractions, contact, friction, springs; w
  const NodeTotals moved = move_nodes(keep, state);  // v_i, u_i
  external += note_body_work(body, state);
  state.time += state.dt;
  ++state.step;
  if (look) note_motion(state);
  const bool changed = bonds_fail(scene, rocks, state);
  const double elastic = find_accelerations(scene, rocks, state);  // a_i = -(M^-1 K u)_i + ...
  close_ledger(scene, rocks, moved, external, elastic, work_of_loads(state.ledger) - before, state);
  expect_momentum(scene, state);
  if (changed) {  // bonded places let go
    bring_up_to_date(scene, state);
    let_go(failing_columns(scene, state, state.bonds), state.bonds, state);
  }
  if (look) measure_tips(scene, rocks, state);  // J, K_I, K_II with the same P
  if (look) watch_flow(scene, state);
  grow_now = grow_now && !changed;  // interfaces answer first
  if (grow_now) weigh(state);
  bool grown = false;
  if (grow_now && ready_to_grow(scene, rocks, state)) {
    bring_up_to_date(scene, state);
    grown = grow(scene, rocks, state);  // new points ahead of the tip
  }
  watch_tips(scene, state);
  if (changed || grown) rebuild_total(scene, rocks, grown, state);
  if (state.step % steps_between_bases == 0) bring_up_to_date(scene, state);
}

}  // namespace strata
