#include "mechanics/explicit_step.hpp"

#include "mechanics/transfers.hpp"

namespace strata {

GridEnergy advance_momentum(double damping, State& state) {
  GridEnergy energy;
  const double keep = 1.0 - damping * state.dt;
  const auto n = static_cast<std::size_t>(state.copies.records());
  for (std::size_t r = 0; r < n; ++r) {
    const NodeSums& sum = state.sums[r];
    NodeMotion& node = state.motion[r];
    if (!(sum.m > 0.0)) {
      node = NodeMotion{};
      continue;
    }
    const double v_x = sum.mom_x / sum.m, v_y = sum.mom_y / sum.m;
    const double mapped = 0.5 * sum.m * (v_x * v_x + v_y * v_y);
    energy.mapped += mapped;
    energy.damped += keep * keep * mapped;
    node.dv_x = state.dt * sum.f_x / sum.m, node.dv_y = state.dt * sum.f_y / sum.m;
    node.v_x = keep * v_x + node.dv_x, node.v_y = keep * v_y + node.dv_y;
  }
  state.ledger.damping += energy.mapped - energy.damped;
  return energy;
}

GridEnergyAfter grid_energy(const State& state) {
  GridEnergyAfter energy;
  for (std::size_t r = 0; r < state.sums.size(); ++r) {
    const NodeMotion& node = state.motion[r];
    const double half_m = 0.5 * state.sums[r].m;
    energy.kinetic += half_m * (node.v_x * node.v_x + node.v_y * node.v_y);
    energy.increment += half_m * (node.dv_x * node.dv_x + node.dv_y * node.dv_y);
  }
  return energy;
}

void spread_to_tied(State& state) {
  for (const int record : state.tied) {
    const Master& master = state.masters[static_cast<std::size_t>(record)];
    const NodeMotion& from = state.motion[static_cast<std::size_t>(master.record)];
    state.motion[static_cast<std::size_t>(record)] = {master.x * from.v_x, master.y * from.v_y, master.x * from.dv_x,
                                                      master.y * from.dv_y};
  }
}

double prepare_transfer(const Scene& scene, State& state) {
  using Transfer = Numerics::Transfer;
  const double keep = 1.0 - scene.numerics.damping_1_s * state.dt;
  if (scene.numerics.transfer == Transfer::flip) return keep;
  if (scene.numerics.transfer == Transfer::pic) {
    for (NodeMotion& node : state.motion) node.dv_x = node.v_x, node.dv_y = node.v_y;
    return 0.0;
  }
  // XPIC(2): v_p = S (2 v - v**) + S dv, with v the mapped velocity and v** = S^+ S v.
  std::vector<Vec2> v(state.motion.size());
  for (std::size_t r = 0; r < v.size(); ++r) {
    const NodeMotion& node = state.motion[r];
    v[r] = Vec2{node.v_x - node.dv_x, node.v_y - node.dv_y};
  }
  const std::vector<Vec2> filtered = filter_velocity(scene, state, v);
  for (std::size_t r = 0; r < v.size(); ++r) {
    NodeMotion& node = state.motion[r];
    node.dv_x = node.v_x + v[r].x() - filtered[r].x();
    node.dv_y = node.v_y + v[r].y() - filtered[r].y();
  }
  for (const int record : state.tied) {  // filtered velocities came back at the masters
    const Master& master = state.masters[static_cast<std::size_t>(record)];
    const NodeMotion& from = state.motion[static_cast<std::size_t>(master.record)];
    NodeMotion& node = state.motion[static_cast<std::size_t>(record)];
    node.dv_x = master.x * from.dv_x, node.dv_y = master.y * from.dv_y;
  }
  return 0.0;
}

double time_step(const Scene& scene, double fastest) {
  return scene.numerics.courant * scene.numerics.cell_m / fastest;
}

}  // namespace strata
