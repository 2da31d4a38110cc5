#include "advance_monitors.hpp"

#include <algorithm>
#include <cmath>

#include "mechanics/surface_law.hpp"

namespace strata {

namespace {

void watch_energies(State& state) {
  Monitors& m = state.monitors;
  const Ledger& ledger = state.ledger;
  note_largest(m.largest_open_J, std::abs(ledger.open()));
  note_largest(m.largest_made_J, -(ledger.transfer + ledger.integration));
  note_largest(m.largest_strain_J, ledger.strain + ledger.interface_strain);
}

void watch_momentum(const Scene& scene, State& state) {
  Monitors& m = state.monitors;
  const Particles& p = state.particles;
  Vec2 sum = Vec2::Zero();
  double size = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 v{p.v_x[q], p.v_y[q]};
    sum += p.m[q] * v;
    size += p.m[q] * v.norm();
  }
  if (state.step == 0) m.expected_x = sum.x(), m.expected_y = sum.y();
  note_largest(m.largest_momentum, size);
  if (!scene.domain.holds_x()) note_largest(m.largest_drift, std::abs(sum.x() - m.expected_x));
  if (!scene.domain.holds_y()) note_largest(m.largest_drift, std::abs(sum.y() - m.expected_y));
}

// Closed faces that overlap, and tension where a law carries none: a soft interface does.
void watch_contact(const Scene& scene, State& state) {
  Monitors& m = state.monitors;
  for (const Surface& surface : state.surfaces) {
    const InterfaceLaw law = surface.kind == Surface::Kind::fracture ? face_law(scene) : scene.laws[surface.law];
    const bool soft = law.kind == InterfaceLaw::Kind::soft;
    if (soft && law.compression != InterfaceLaw::Compression::contact) continue;
    for (const SurfacePoint& s : surface.points) {
      if (!s.split) continue;
      const double pressure = s.reaction.dot(s.n);
      note_largest(m.largest_penetration, -s.opening());
      note_largest(m.largest_contact_Pa, pressure);
      if (!soft) note_largest(m.largest_tension_Pa, -pressure);
    }
  }
}

}  // namespace

void expect_momentum(const Scene& scene, State& state) {
  Monitors& m = state.monitors;
  const double keep = 1.0 - scene.numerics.damping_1_s * state.dt;
  Vec2 force = Vec2::Zero();
  for (std::size_t q = 0; q < state.body.size(); ++q) force += state.particles.m[q] * state.body[q];
  m.expected_x = keep * m.expected_x + state.dt * force.x();
  m.expected_y = keep * m.expected_y + state.dt * force.y();
}

void watch_row(const Scene& scene, State& state) {
  watch_energies(state);
  if (scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics) watch_momentum(scene, state);
  watch_contact(scene, state);
}

}  // namespace strata
