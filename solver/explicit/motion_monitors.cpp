#include "explicit/motion_monitors.hpp"

#include <cmath>

namespace strata {

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

}  // namespace strata
