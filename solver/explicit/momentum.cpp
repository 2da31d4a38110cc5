#include "explicit/momentum.hpp"

#include <fmt/format.h>

#include <cfloat>
#include <cmath>

#include "state/lanes.hpp"
#include "state/parts.hpp"

namespace strata {

NodeTotals advance_momentum(double damping, State& state) {
  const double keep = 1.0 - damping * state.dt, dt = state.dt;
  const NodalSums& sums = state.sums;
  NodalMotion& motion = state.motion;
  return sum_over_parts<NodeTotals>(sums.size(), [&](const Part& part) {
    const auto m = part.of(sums.m), f_x = part.of(sums.f_x), f_y = part.of(sums.f_y);
    auto v_x = part.of(motion.v_x), v_y = part.of(motion.v_y), dv_x = part.of(motion.dv_x), dv_y = part.of(motion.dv_y);
    dv_x = 1.0 / m.max(DBL_MIN);  // for now: without mass there is no momentum nor force
    v_x = dv_x * part.of(sums.mom_x), v_y = dv_x * part.of(sums.mom_y);
    NodeTotals total;
    total.kinetic = 0.5 * (m * (v_x * v_x + v_y * v_y)).sum();
    total.power = (v_x * f_x + v_y * f_y).sum();
    dv_y = dt * dv_x * f_y, dv_x = dt * dv_x * f_x;
    v_x = keep * v_x + dv_x, v_y = keep * v_y + dv_y;
    return total;
  });
}

NodeTotals grid_energy(const State& state) {
  const NodalSums& sums = state.sums;
  const NodalMotion& motion = state.motion;
  return sum_over_parts<NodeTotals>(sums.size(), [&](const Part& part) {
    const auto m = part.of(sums.m), v_x = part.of(motion.v_x), v_y = part.of(motion.v_y);
    NodeTotals total;
    total.kinetic = 0.5 * (m * (v_x * v_x + v_y * v_y)).sum();
    total.increment = 0.5 * (m * (part.of(motion.dv_x).square() + part.of(motion.dv_y).square())).sum();
    total.product = (part.of(sums.mom_x) * v_x + part.of(sums.mom_y) * v_y).sum();
    return total;
  });
}

void take_damping(double keep, double kinetic, double product, Ledger& ledger) {
  const double taken = (1.0 - keep) * (kinetic + 0.5 * product);
  ledger.damping += taken;
  ledger.integration += (1.0 - keep * keep) * kinetic - taken;
}

void spread_to_tied(State& state) {
  for_each_tied(state, [&](std::size_t record, const Master& master) {
    const NodeMotion from = state.motion[static_cast<std::size_t>(master.record)];
    state.motion[record] =
        NodeMotion{master.x * from.v_x, master.y * from.v_y, master.x * from.dv_x, master.y * from.dv_y};
  });
}

double body_work(const State& state) {
  if (state.body.empty()) return 0.0;
  double power = 0.0;
  for (std::size_t r = 0; r < state.motion.size(); ++r)
    power += state.body_sums.f_x[r] * state.motion.v_x[r] + state.body_sums.f_y[r] * state.motion.v_y[r];
  return state.dt * power;
}

Uptake prepare_transfer(const Scene& scene, State& state) {
  using Transfer = Numerics::Transfer;
  const NodalMotion& motion = state.motion;
  const double keep = 1.0 - scene.numerics.damping_1_s * state.dt;
  if (scene.numerics.transfer == Transfer::flip) return {keep, &motion.dv_x, &motion.dv_y};
  if (scene.numerics.transfer == Transfer::pic) return {0.0, &motion.v_x, &motion.v_y};
  // XPIC(2): v_p = S (2 v - v**) + S dv, with v the mapped velocity and v** = S^+ S v.
  filter_velocity(scene, state);
  const NodalSums& filtered = state.filtered;
  state.take_x.resize(motion.size()), state.take_y.resize(motion.size());
  for_each_part(motion.size(), [&](const Part& part) {
    for (std::size_t r = part.first; r < part.last; ++r) {
      const double per_m = filtered.m[r] > 0.0 ? 1.0 / filtered.m[r] : 0.0;
      state.take_x[r] = 2.0 * motion.v_x[r] - motion.dv_x[r] - per_m * filtered.mom_x[r];
      state.take_y[r] = 2.0 * motion.v_y[r] - motion.dv_y[r] - per_m * filtered.mom_y[r];
    }
  });
  for_each_tied(state, [&](std::size_t r, const Master& master) {  // filtered velocities came back at the masters
    const auto from = static_cast<std::size_t>(master.record);
    state.take_x[r] = master.x * state.take_x[from], state.take_y[r] = master.y * state.take_y[from];
  });
  return {0.0, &state.take_x, &state.take_y};
}

void require_stable(const Scene& scene, const Rocks& rocks, const State& state) {
  constexpr double times_supplied = 10.0;  // 1/(1 - (omega dt/2)^2) at 0.95 of the largest stable step
  constexpr double rounding = 1e-10;       // of the speed of sound
  const Ledger& ledger = state.ledger;
  const double supplied = std::abs(ledger.fluid_work) + std::abs(ledger.in_situ_work) + std::abs(ledger.edge_work) +
                          std::abs(ledger.body_work) + std::abs(ledger.initial_kinetic);
  const double created = -(ledger.integration + ledger.transfer);  // by the step, and not released from what was stored
  const bool finite = std::isfinite(ledger.kinetic);
  if (finite && (ledger.kinetic <= times_supplied * supplied || created <= 0.5 * ledger.kinetic)) return;
  const Particles& p = state.particles;
  double floor = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) floor += p.m[q] * std::pow(rounding * rocks[p.rock[q]].c_P, 2);
  if (finite && ledger.kinetic <= floor) return;
  throw NumericalFailure(
      fmt::format("step {}: the motion has become unstable: its kinetic energy, {:.3g} J/m, is more than {:g} times "
                  "all that was put in, {:.3g} J/m. Lower numerics.courant (now {})",
                  state.step, ledger.kinetic, times_supplied, supplied, scene.numerics.courant));
}

void watch_made(double kinetic, double swing, State& state) {
  const Ledger& ledger = state.ledger;
  note_largest(state.monitors.largest_made_J, swing - (ledger.transfer + ledger.integration));
  note_largest(state.monitors.largest_made_J, -(kinetic + swing) - ledger.largest);
}

void expect_momentum(const Scene& scene, State& state) {
  Monitors& m = state.monitors;
  const double keep = 1.0 - scene.numerics.damping_1_s * state.dt;
  Vec2 force = Vec2::Zero();
  for (std::size_t q = 0; q < state.body.size(); ++q) force += state.particles.m[q] * state.body[q];
  m.expected_x = keep * m.expected_x + state.dt * force.x();
  m.expected_y = keep * m.expected_y + state.dt * force.y();
}

double time_step(const Scene& scene, double fastest) {
  return scene.numerics.courant * scene.numerics.cell_m / fastest;
}

}  // namespace strata
