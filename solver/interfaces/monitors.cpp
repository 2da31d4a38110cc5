#include "interfaces/monitors.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>

#include "interfaces/surface_law.hpp"

namespace strata {
namespace {

void watch_energies(State& state) {
  Monitors& m = state.monitors;
  const Ledger& ledger = state.ledger;
  note_largest(m.largest_open_J, std::abs(ledger.open()));
  note_largest(m.largest_strain_J, ledger.strain + ledger.interface_strain);
  note_largest(m.largest_kinetic_J, ledger.kinetic);
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

// Closed faces that overlap, and tension where a law carries none.
void watch_contact(const Scene& scene, State& state) {
  Monitors& m = state.monitors;
  for (const Surface& surface : state.surfaces) {
    const InterfaceLaw law = law_of(scene, surface);
    if (law.takes_all_compression()) continue;
    for (const SurfacePoint& s : surface.points) {
      if (!s.split) continue;
      const double pressure = s.reaction.dot(s.n);
      note_largest(m.largest_penetration, -s.opening());
      note_largest(m.largest_contact_Pa, pressure);
      if (!law.pulls()) note_largest(m.largest_tension_Pa, -pressure);
    }
  }
}

// How far the fluid's pressure exceeds the closing stress: what opens the fracture.
void watch_net_pressure(const Scene& scene, State& state) {
  Monitors& m = state.monitors;
  for (const SurfacePoint& s : state.fracture().points) {
    const double closing = s.in_situ.dot(s.n);
    if (state.step == 0 && !scene.fluid.rate_m2_s) note_largest(m.net_at_start_Pa, scene.fluid.start_Pa - closing);
    note_largest(m.largest_net_Pa, s.P - closing);
  }
  note_largest(m.largest_net_Pa, m.net_at_start_Pa);
}

}  // namespace

void watch_deformation(State& state) {
  Monitors& m = state.monitors;
  const Particles& p = state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const double mean = 0.5 * (p.g_xx[q] + p.g_yy[q]), half = 0.5 * (p.g_xx[q] - p.g_yy[q]);
    note_largest(m.largest_strain, std::abs(mean) + std::hypot(half, 0.5 * (p.g_xy[q] + p.g_yx[q])));
    note_largest(m.largest_rotation, 0.5 * std::abs(p.g_yx[q] - p.g_xy[q]));
  }
  for (const Surface& surface : state.surfaces) {
    for (const SurfacePoint& s : surface.points) {
      if (s.split) note_largest(m.largest_jump, s.w.norm());
    }
  }
}

void require_finite(const State& state) {
  if (state.ledger.finite()) return;
  std::string which;
  for (const auto& [name, value, description] : ledger_energies) {
    if (!std::isfinite(state.ledger.*value)) which += (which.empty() ? "" : ", ") + std::string(name);
  }
  throw NumericalFailure(
      fmt::format("step {}, t = {:.6g} s: energies of the ledger are no finite numbers: {}. Check the "
                  "sizes of the scene's loads and stiffnesses",
                  state.step, state.time, which));
}

void watch_row(const Scene& scene, State& state) {
  watch_energies(state);
  if (scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics) watch_momentum(scene, state);
  watch_contact(scene, state);
  if (state.has_fracture) watch_net_pressure(scene, state);
}

}  // namespace strata
