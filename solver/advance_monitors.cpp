#include "advance_monitors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "mechanics/quarter_forces.hpp"
#include "mechanics/surface_law.hpp"
#include "mechanics/surface_tractions.hpp"
#include "mechanics/transfers.hpp"
#include "state/round_off.hpp"

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

// D^T r A of split places and of the springs of tips.
void add_reactions(State& state) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const std::vector<SurfacePoint>& points = state.surfaces[k].points;
    for (std::size_t q = 0; q < points.size(); ++q) {
      if (points[q].split) add_traction(state.point_stencils[k][q], points[q].reaction, points[q].A, state.sums);
    }
  }
  for (const TipTie& tie : state.ties) {
    SurfaceStencil stencil;  // one node's two copies
    stencil.plus[0] = tie.plus, stencil.minus[0] = tie.minus, stencil.N[0] = 1.0;
    add_traction(stencil, tie.s.reaction, 1.0, state.sums);
  }
}

}  // namespace

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

void watch_forces(const Scene& scene, const std::vector<Elasticity>& rocks, const std::vector<Vec2>& u, State& state) {
  const NodalSums kept = state.sums;
  particles_to_grid(scene, rocks, state);
  exert_quarters(scene, rocks, u, state);
  update_stencil_weights(scene, state);
  NodalSums rock = state.sums;
  for (std::size_t r = 0; r < rock.size(); ++r) state.sums[r].f_x = state.sums[r].f_y = 0.0;
  add_body_force(scene, state);
  add_net_tractions(state);
  NodalSums given = state.sums;  // the scale: with reactions nothing is left of the load on faces that stay closed
  add_reactions(state);
  fold_to_masters(state, rock);
  fold_to_masters(state, given);
  fold_to_masters(state, state.sums);
  double left = 0.0, load = 0.0;
  for (std::size_t r = 0; r < rock.size(); ++r) {
    const Master& master = state.masters[r];
    if (master.record != static_cast<int>(r) || !(rock[r].m > 0.0)) continue;
    const Vec2 free{std::abs(master.x), std::abs(master.y)};  // what an edge holds takes any force
    const Vec2 of_rock{rock[r].f_x, rock[r].f_y}, on_it{state.sums[r].f_x, state.sums[r].f_y};
    note_largest(left, free.cwiseProduct(of_rock + on_it).norm());
    note_largest(load, free.cwiseProduct(Vec2{given[r].f_x, given[r].f_y}).norm());
  }
  state.sums = kept;
  const double nothing = round_off(scene, state).stress * state.grid.h;  // of a cell's face
  if (load > nothing || !(left <= nothing)) note_largest(state.monitors.force_balance, left / load);
}

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
  const Ledger& l = state.ledger;
  if (l.finite()) return;
  std::string which;
  for (const auto& [name, energy] : {std::pair{"kinetic", l.kinetic},
                                     {"strain", l.strain},
                                     {"interface_strain", l.interface_strain},
                                     {"fluid_work", l.fluid_work},
                                     {"in_situ_work", l.in_situ_work},
                                     {"body_work", l.body_work},
                                     {"damping", l.damping},
                                     {"transfer", l.transfer},
                                     {"integration", l.integration},
                                     {"friction", l.friction},
                                     {"failure", l.failure},
                                     {"fracture", l.fracture},
                                     {"excess", l.excess}}) {
    if (!std::isfinite(energy)) which += (which.empty() ? "" : ", ") + std::string(name);
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
