#include "explicit/interface_laws.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "interfaces/failure.hpp"
#include "interfaces/surface_law.hpp"
#include "explicit/total/total_surfaces.hpp"

namespace strata {

namespace {

using Kind = InterfaceLaw::Kind;

// r = r_rest - D w with w = w_free + per r, in the form that keeps its digits for any D > 0.
double spring(double D, double r_rest, double w_free, double per) {
  return D > 0.0 ? (r_rest / D - w_free) / (1.0 / D + per) : 0.0;
}

// Both branches fall as the jump grows, so that the larger answer is that of the larger branch.
Reaction react_soft(const InterfaceLaw& law, double k, const FreeJump& w) {
  double n = spring(law.normal_stiffness_Pa_m, 0.0, w.n, w.per_n);
  if (law.compression == InterfaceLaw::Compression::contact) n = std::max(n, spring(k, w.n_rest, w.n, w.per_n));
  return {n, spring(law.shear_stiffness_Pa_m, 0.0, w.t, w.per_t)};
}

// Places share nodes with about six neighbours, so plain Gauss-Seidel (1) is slow: 327 sweeps a step in Experiment 1
// soft, to a tolerance of 1e-9, where 1.5 with today's tolerance takes 52. 1.5 was not tuned further.
constexpr double over_relaxation = 1.5;

void add_entry(SplitPlace& place, const Master& master, double weight) {
  int k = 0;
  while (k < place.n && place.record[static_cast<std::size_t>(k)] != master.record) ++k;
  if (k == place.n) place.record[static_cast<std::size_t>(place.n++)] = master.record;
  place.c_x[static_cast<std::size_t>(k)] += weight * master.x;
  place.c_y[static_cast<std::size_t>(k)] += weight * master.y;
}

SplitPlace make_place(const State& state, const SurfaceStencil& stencil, SurfacePoint& s, const InterfaceLaw& law,
                      double k) {
  SplitPlace place;
  place.s = &s;
  place.law = &law;
  place.k = k;
  place.r_t_start = s.reaction.dot(tangent_of(s.n));
  for (std::size_t n = 0; n < 9; ++n) {
    if (stencil.plus[n] == stencil.minus[n]) continue;
    add_entry(place, state.masters[static_cast<std::size_t>(stencil.plus[n])], stencil.N[n]);
    add_entry(place, state.masters[static_cast<std::size_t>(stencil.minus[n])], -stencil.N[n]);
  }
  double a_x = 0.0, a_y = 0.0;
  for (std::size_t e = 0; e < static_cast<std::size_t>(place.n); ++e) {
    const double per_mass = state.dt * s.A / state.sums[static_cast<std::size_t>(place.record[e])].m;
    place.d_x[e] = per_mass * place.c_x[e];
    place.d_y[e] = per_mass * place.c_y[e];
    a_x += state.dt * place.c_x[e] * place.d_x[e];
    a_y += state.dt * place.c_y[e] * place.d_y[e];
  }
  place.per_n = s.n.x() * s.n.x() * a_x + s.n.y() * s.n.y() * a_y;
  place.per_t = s.n.y() * s.n.y() * a_x + s.n.x() * s.n.x() * a_y;
  return place;
}

void push(const SplitPlace& place, const Vec2& r, NodalMotion& motion) {
  for (std::size_t k = 0; k < static_cast<std::size_t>(place.n); ++k) {
    const NodalMotion::Record node = motion[static_cast<std::size_t>(place.record[k])];
    node.v_x += place.d_x[k] * r.x(), node.dv_x += place.d_x[k] * r.x();
    node.v_y += place.d_y[k] * r.y(), node.dv_y += place.d_y[k] * r.y();
  }
}

Vec2 jump_rate(const SplitPlace& place, const NodalMotion& motion) {
  Vec2 v = Vec2::Zero();
  for (std::size_t k = 0; k < static_cast<std::size_t>(place.n); ++k) {
    const NodeMotion node = motion[static_cast<std::size_t>(place.record[k])];
    v.x() += place.c_x[k] * node.v_x;
    v.y() += place.c_y[k] * node.v_y;
  }
  return v;
}

// One visit of successive over-relaxation: past the law's reaction given all others, but never out of what the law
// allows; returns how much the reaction changed (Pa).
double relax(const SplitPlace& place, double dt, NodalMotion& motion) {
  SurfacePoint& s = *place.s;
  const Vec2 tangent = tangent_of(s.n);
  const Vec2 w = s.w + dt * jump_rate(place, motion);
  const FreeJump free{w.dot(s.n) - place.per_n * s.reaction.dot(s.n),
                      w.dot(tangent) - place.per_t * s.reaction.dot(tangent),
                      s.w.dot(tangent),
                      place.r_t_start,
                      place.per_n,
                      place.per_t,
                      s.closing_stress() - s.P};
  const Reaction over = over_relax(*place.law, place.k, free, {s.reaction.dot(s.n), s.reaction.dot(tangent)});
  const Vec2 change = over.n * s.n + over.t * tangent - s.reaction;
  push(place, change, motion);
  s.reaction += change;
  return change.norm();
}

SurfaceStencil tie_stencil(const TipTie& tie) {
  SurfaceStencil stencil;  // other entries stay plus = minus = 0: no jump
  stencil.plus[0] = tie.plus, stencil.minus[0] = tie.minus;
  stencil.N[0] = 1.0;
  return stencil;
}

void find_split_places(const Scene& scene, const std::vector<Elasticity>& rocks, const InterfaceLaw& faces,
                       State& state) {
  std::vector<SplitPlace>& places = state.places;
  places.clear(), state.tie_laws.clear();
  for (const TipTie& tie : state.ties) state.tie_laws.push_back(tie_law(tie));
  const auto mass = [&](int record) {
    return state.sums[static_cast<std::size_t>(state.masters[static_cast<std::size_t>(record)].record)].m;
  };
  for (std::size_t k = 0; k < state.ties.size(); ++k) {
    if (mass(state.ties[k].plus) == 0.0 || mass(state.ties[k].minus) == 0.0) continue;
    places.push_back(make_place(state, tie_stencil(state.ties[k]), state.ties[k].s, state.tie_laws[k], 0.0));
  }
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    Surface& surface = state.surfaces[k];
    const InterfaceLaw& law = surface.kind == Surface::Kind::fracture ? faces : scene.laws[surface.law];
    const double stiffness = contact_stiffness(law, rocks, state.grid);
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      if (!surface.points[q].split) continue;
      const SplitPlace place = make_place(state, state.point_stencils[k][q], surface.points[q], law, stiffness);
      if (place.n > 0) places.push_back(place);
    }
  }
}

}  // namespace

Reaction react(const InterfaceLaw& law, double k, const FreeJump& w) {
  if (law.kind == Kind::perfect) return {};
  if (law.kind == Kind::soft) return react_soft(law, k, w);
  const double n = std::max(0.0, spring(k, w.n_rest, w.n, w.per_n));
  const double bound = n * (law.kind == Kind::weak ? law.residual_friction : law.coefficient);
  return {n, std::clamp(spring(k, w.r_t_start, w.t - w.t_start, w.per_t), -bound, bound)};
}

Reaction admissible(const InterfaceLaw& law, const Reaction& r) {
  if (law.kind == Kind::soft) return r;
  const double n = std::max(0.0, r.n), mu = law.kind == Kind::weak ? law.residual_friction : law.coefficient;
  return {n, std::clamp(r.t, -mu * n, mu * n)};
}

Reaction over_relax(const InterfaceLaw& law, double k, const FreeJump& w, const Reaction& now) {
  const Reaction r = react(law, k, w);
  return admissible(law, {now.n + over_relaxation * (r.n - now.n), now.t + over_relaxation * (r.t - now.t)});
}

InterfaceLaw tie_law(const TipTie& tie) {
  InterfaceLaw law;
  law.kind = Kind::soft;
  law.compression = InterfaceLaw::Compression::spring;
  law.normal_stiffness_Pa_m = law.shear_stiffness_Pa_m = tie.stiffness;
  return law;
}

// Closed contact and stick hold r^2/(2k), some 1e-4 of what the rock beside them does: that is left in the ledger's
// friction, which is then negative by as much while load comes on. All of it is counted, so the ledger closes.
double spring_energy_at(const InterfaceLaw& law, const SurfacePoint& s) {
  if (law.kind != Kind::soft || !s.split) return 0.0;
  const double w_n = s.opening(), w_t = s.w.dot(tangent_of(s.n));
  const bool closed = law.compression == InterfaceLaw::Compression::contact && w_n < 0.0;
  return 0.5 * s.A * ((closed ? 0.0 : law.normal_stiffness_Pa_m * w_n * w_n) + law.shear_stiffness_Pa_m * w_t * w_t);
}

void note_jump(const InterfaceLaw& law, const Vec2& dw, SurfacePoint& s, State& state) {
  SurfacePoint after = s;
  after.w += dw;
  const double stored = spring_energy_at(law, after) - spring_energy_at(law, s);
  state.ledger.friction -= s.A * s.reaction.dot(dw) + stored;
  if (law.kind != Kind::soft) s.slip += std::abs(dw.dot(tangent_of(s.n)));
  const bool closes = law.kind != Kind::soft || law.compression == InterfaceLaw::Compression::contact;
  if (!closes) return;
  note_largest(state.monitors.largest_penetration, -after.opening());
  note_largest(state.monitors.largest_contact_Pa, s.reaction.dot(s.n));
}

void note_sweeps(int sweeps, double change, double largest, Monitors& monitors) {
  monitors.contact_sweeps += sweeps;
  if (sweeps < most_sweeps) return;
  ++monitors.contact_unconverged;
  note_largest(monitors.contact_left, change / std::max(largest, 1.0));
}

void require_settled(int sweeps, double change, double largest, const State& state) {
  if (sweeps < most_sweeps) return;
  double traction = std::max(largest, 1.0);
  for (const Surface& surface : state.surfaces) {
    for (const SurfacePoint& s : surface.points) {
      if (s.split) traction = std::max({traction, std::abs(s.P), s.in_situ.norm()});
    }
  }
  if (change <= most_left * traction) return;
  throw NumericalFailure(
      fmt::format("step {}: contact, friction and springs were not solved: after {} sweeps a reaction still changed by "
                  "{:.3g} Pa, the largest traction being {:.3g} Pa. Use a smaller coefficient of friction",
                  state.step, sweeps, change, traction));
}

bool bonds_fail(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  Bonds& bonds = state.bonds;
  if (bonds.places.empty() || state.step % looks_at_bonds != 0) return false;
  state.total.based ? forces_of_nodes(state, bonds.forces) : find_forces(rocks, state, bonds);
  judge_bonds(scene, state, bonds);
  if (std::isnan(bonds.worst)) throw NumericalFailure("the load of a bonded interface is not finite");
  return bonds.worst >= 1.0;
}

void solve_reactions(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  const InterfaceLaw faces = face_law(scene);
  find_split_places(scene, rocks, faces, state);
  const std::vector<SplitPlace>& places = state.places;
  for (const SplitPlace& place : places) push(place, place.s->reaction, state.motion);
  int sweeps = 0;
  double change = 1.0, largest = 0.0;
  for (; sweeps < most_sweeps && !places.empty() && change > reaction_tolerance * std::max(largest, 1.0); ++sweeps) {
    change = largest = 0.0;
    for (const SplitPlace& place : places) {
      change = std::max(change, relax(place, state.dt, state.motion));
      largest = std::max(largest, place.s->reaction.norm());
    }
  }
  note_sweeps(sweeps, change, largest, state.monitors);
  require_settled(sweeps, change, largest, state);
  for (const SplitPlace& place : places)
    note_jump(*place.law, state.dt * jump_rate(place, state.motion), *place.s, state);
  state.places.clear();  // they point into the surfaces
}

double spring_energy(const Scene& scene, const State& state) {
  double energy = 0.0;
  for (const TipTie& tie : state.ties) energy += spring_energy_at(tie_law(tie), tie.s);
  for (const Surface& surface : state.surfaces) {
    if (surface.kind != Surface::Kind::interface) continue;
    for (const SurfacePoint& s : surface.points) energy += spring_energy_at(scene.laws[surface.law], s);
  }
  return energy;
}

}  // namespace strata
