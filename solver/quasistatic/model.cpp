#include "quasistatic/model.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>

#include "interfaces/surface_tractions.hpp"
#include "interfaces/tip_ties.hpp"
#include "scene/graded_cells.hpp"
#include "state/body_force.hpp"
#include "state/particle_loop.hpp"
#include "state/stiffness.hpp"

namespace strata {
namespace {

// Fields of the particles of some bins.
void set_particles(const Scene& scene, const std::vector<std::size_t>& bins, const std::vector<Vec2>& u, State& state) {
  Particles& p = state.particles;
  with_shape(scene.numerics.shape, [&](auto shape) {  // asked for once
    for (const std::size_t b : bins) {
      const Bin& bin = state.bins[b];
      std::array<Vec2, 9> u_i;
      std::ranges::transform(bin.record, u_i.begin(), [&](int r) { return u[static_cast<std::size_t>(r)]; });
      for (const std::size_t q : bin) {
        const Gradients g = gradients_of<decltype(shape)>(state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
        Vec2 u_p = Vec2::Zero(), d_x = Vec2::Zero(), d_y = Vec2::Zero();
        for (std::size_t n = 0; n < 9; ++n) u_p += g.N[n] * u_i[n], d_x += g.N_x[n] * u_i[n], d_y += g.N_y[n] * u_i[n];
        p.u_x[q] = u_p.x(), p.u_y[q] = u_p.y();
        p.g_xx[q] = d_x.x(), p.g_xy[q] = d_y.x(), p.g_yx[q] = d_x.y(), p.g_yy[q] = d_y.y();
      }
    }
  });
}

std::vector<std::size_t> all_bins(const State& state) {
  std::vector<std::size_t> bins(state.bins.size());
  std::iota(bins.begin(), bins.end(), 0U);
  return bins;
}

// Whether J's widest ring around a tip weighs a bin: a node of it lies inside.
bool weighed(const Scene& scene, const State& state, const Bin& bin) {
  const Grid& g = state.grid;
  const double reach = scene.numerics.ring_cells * g.h;
  return std::ranges::any_of(state.tips, [&](const Tip& tip) {
    const Vec2 at = tip_position(state, tip);
    for (int n = 0; n < 9; ++n) {
      const Vec2 off = Vec2{g.x(bin.i + n % 3 - 1), g.y(bin.j + n / 3 - 1)} - at;
      if (off.norm() < reach) return true;
    }
    return false;
  });
}

std::vector<std::size_t> watched_bins(const Scene& scene, const State& state, const Bonds& bonds) {
  std::vector<char> particle(state.particles.size(), 0);
  for (const BondSample& sample : bonds.samples) {
    for (const BondSample::Share& share : sample.particles) particle[share.index] = 1;
  }
  std::vector<std::size_t> watched;
  for (std::size_t b = 0; b < state.bins.size(); ++b) {
    const Bin& bin = state.bins[b];
    bool watch = weighed(scene, state, bin);
    for (const std::size_t q : bin) watch = watch || particle[q] != 0;
    if (watch) watched.push_back(b);
  }
  return watched;
}

// D of the vertices of all surfaces, one below the other.
Eigen::SparseMatrix<double, Eigen::RowMajor> jumps_at_vertices(const State& state, const Condensed& condensed) {
  std::vector<Eigen::Triplet<double>> entries;
  int row = 0;
  for (const std::vector<SurfaceStencil>& stencils : state.vertex_stencils) {
    for (const SurfaceStencil& stencil : stencils) {
      for (const SparseRow& of : jump_rows(condensed, stencil)) {
        for (const auto& [index, value] : of) entries.emplace_back(row, index, value);
        ++row;
      }
    }
  }
  Eigen::SparseMatrix<double, Eigen::RowMajor> D(row, condensed.size());
  D.setFromTriplets(entries.begin(), entries.end());
  return D;
}

// Masses of the copies of cut nodes (kg/m), which tell those that have rock; others' are not complete.
void weigh_copies(const Scene& scene, State& state) {
  state.sums.clear(state.sums.size());
  std::vector<Bin> cut;
  for (const std::size_t b : state.cut_bins) cut.push_back(state.bins[b]);
  for_each_particle(scene, state, cut, [&](const Bin& bin, std::size_t q, const Gradients& g) {
    for (std::size_t n = 0; n < 9; ++n)
      state.sums[static_cast<std::size_t>(bin.record[n])].m += g.N[n] * state.particles.m[q];
  });
}

// Corners that stand in for edges that hold nothing would have to carry what a force pushes the whole block with.
void require_balance(const Scene& scene, const State& state) {
  constexpr double balanced = 1e-9;  // of the sum of sizes: round-off leaves 1e-12 of forces that cancel
  const Particles& p = state.particles;
  const Vec2 centre{0.5 * scene.domain.width_m, 0.5 * scene.domain.height_m};
  Vec2 sum = Vec2::Zero(), size = Vec2::Zero();
  double turn = 0.0, turns = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 f = p.m[q] * state.body[q], arm = Vec2{p.x[q], p.y[q]} - centre;
    sum += f, size += f.cwiseAbs();
    turn += cross(arm, f), turns += arm.norm() * f.norm();
  }
  const bool free_x = !scene.domain.holds_x(), free_y = !scene.domain.holds_y();
  const auto refuse = [](const char* what, double value, const char* unit, const char* advice) {
    throw NumericalFailure(
        fmt::format("the body force {} the whole block with {} {} per metre, and no edge holds it. Use "
                    "{}, or a force without resultant",
                    what, value, unit, advice));
  };
  if (free_x && std::abs(sum.x()) > balanced * size.x()) refuse("pushes", sum.x(), "N", "domain.sides = \"fixed\"");
  if (free_y && std::abs(sum.y()) > balanced * size.y())
    refuse("lifts", sum.y(), "N", "domain.bottom = \"symmetry\" or top = \"fixed\"");
  if (free_x && free_y && std::abs(turn) > balanced * turns) refuse("turns", turn, "N m", "domain.sides = \"fixed\"");
}

// Loads the condensed block with the body force at a time (s): state.body, and condensed.load for it. With f_u on the
// unknowns of the intact block and f_j on the jumps, K u + G j = f_u and G^T u + K_jj j = f_j + D^T t A, so that
//   S j = D^T t A + f_j - G^T u_0,  u_0 = K^-1 f_u,  u = u_0 - K^-1 G j.
// Does nothing where the scene has no body force, or where that time's is there already. Throws NumericalFailure where
// a formula is not finite, or where the force has a resultant along a motion of the whole block that no edge holds.
void load_body(const Scene& scene, double time, const IntactBody& body, State& state, Condensed& condensed) {
  BodyLoad& load = condensed.load;
  if (!scene.body.acceleration_m_s2 || (!load.empty() && load.time == time)) return;
  set_body_acceleration(scene, time, state);
  require_balance(scene, state);
  const Particles& p = state.particles;
  load.time = time;
  load.intact = Eigen::VectorXd::Zero(body.unknowns());
  load.jumps = Eigen::VectorXd::Zero(condensed.size());
  for_each_particle(scene, state, state.bins, [&](const Bin& bin, std::size_t q, const Gradients& g) {
    for (std::size_t n = 0; n < 9; ++n) {
      const int node = state.copies.node(bin.record[n]);
      for (int component = 0; component < 2; ++component) {
        const double f = g.N[n] * p.m[q] * state.body[q][component];
        const Unknown base = unknown_of(body.masters, node, component);
        const Unknown jump = jump_unknown(condensed, bin.record[n], component);
        if (base.index >= 0) load.intact[base.index] += base.factor * f;
        if (jump.index >= 0) load.jumps[jump.index] += jump.factor * f;
      }
    }
  });
  const Eigen::VectorXd u_0 = body.factor.solve(load.intact);
  for (std::size_t k = 0; k < condensed.columns.size(); ++k) {
    for (const auto& [unknown, value] : condensed.columns[k]->G)
      load.jumps[static_cast<Eigen::Index>(k)] -= value * u_0[unknown];
  }
  load.strain = 0.5 * load.intact.dot(u_0);
}

// Plastic slip of a place since friction's memory (m): the tangential jump less what the stick spring gives way.
double plastic_slip(const ContactPlace& place, const LawAnswer& r, const Vec2& w) {
  if (!place.law.slides() || r.shear() == LawAnswer::Shear::sticks) return 0.0;
  return w.dot(place.t()) - place.start.w_t + (r.t - place.start.r_t) / place.k;
}

}  // namespace

void update_model(const Scene& scene, const Rocks& rocks, State& state, QuasistaticModel& model, bool halve) {
  update_equations(scene, rocks, state, model, halve);
  model.bonds = find_bonds(scene, state);
  model.watched = scene.body.acceleration_m_s2 ? all_bins(state) : watched_bins(scene, state, model.bonds);
  model.asked = ask_for(scene, state, *model.body, model.watched);
  model.vertex_jumps = jumps_at_vertices(state, model.condensed);
}

void update_equations(const Scene& scene, const Rocks& rocks, State& state, QuasistaticModel& model, bool halve) {
  rebuild(scene, rocks, state);
  weigh_copies(scene, state);
  update_stencil_weights(scene, state);
  const bool halved = halve && mirror_symmetric(scene);
  const bool same_body = model.body && model.body->points == state.particles.next_id;
  if (!same_body) {
    model.body.reset();  // two are not to be held at a time
    model.body = std::make_shared<const IntactBody>(scene, rocks, state, halved);
  }
  model.condensed = condense(scene, rocks, state, *model.body, same_body ? &model.condensed : nullptr);
  forget_solution(scene, rocks, state, model);
}

void forget_solution(const Scene& scene, const Rocks& rocks, const State& state, QuasistaticModel& model) {
  model.places = contact_places(scene, rocks, state, model.condensed);
  model.factor = TangentFactor{};
  model.j.resize(0);
  model.dw_dP.resize(0, 0);
}

Equilibrium find_equilibrium(const Scene& scene, double time, State& state, QuasistaticModel& model) {
  load_body(scene, time, *model.body, state, model.condensed);
  Equilibrium found = solve_equilibrium(state, model.condensed, model.places, model.j, model.factor);
  model.j = found.j;
  return found;
}

void set_all_particles(const Scene& scene, State& state, const QuasistaticModel& model) {
  const Asked all = ask_for_all(state, *model.body);
  const std::vector<Vec2> u = displacements(scene, state, *model.body, model.condensed, model.shown, all);
  set_particles(scene, all_bins(state), u, state);
}

void set_fields(const Scene& scene, State& state, QuasistaticModel& model, const Equilibrium& equilibrium) {
  model.shown = equilibrium.j;
  set_particles(scene, model.watched,
                displacements(scene, state, *model.body, model.condensed, model.shown, model.asked), state);
  for (std::size_t k = 0; k < model.places.size(); ++k) {
    const ContactPlace& place = model.places[k];
    const LawAnswer& r = equilibrium.answers[k];
    SurfacePoint& s = point_of(state, place);
    s.w = equilibrium.w[k];
    s.reaction = place.along(r.n, r.t);
  }
  const Eigen::VectorXd w = model.vertex_jumps * equilibrium.j;
  Eigen::Index row = 0;
  for (Surface& surface : state.surfaces) {
    for (SurfacePoint& vertex : surface.vertices) vertex.w = w.segment<2>(row), row += 2;
  }
}

void remember(State& state, QuasistaticModel& model, const Equilibrium& equilibrium) {
  for (std::size_t k = 0; k < model.places.size(); ++k) {
    ContactPlace& place = model.places[k];
    InterfaceLaw::Memory& memory = point_of(state, place).memory;
    const double w_n = equilibrium.w[k].dot(place.n), w_t = equilibrium.w[k].dot(place.t());
    remember(place.law, w_n, w_t - place.start.w_t, memory);
    place.start = {w_t, equilibrium.answers[k].t, memory, equilibrium.answers[k].n};
  }
}

double stored_in_surfaces(const QuasistaticModel& model, const Equilibrium& equilibrium) {
  double energy = 0.0;
  for (std::size_t k = 0; k < model.places.size(); ++k) {
    const ContactPlace& place = model.places[k];
    const LawAnswer& r = equilibrium.answers[k];
    const bool shears = place.law.slides() && r.shear() != LawAnswer::Shear::free;
    const double before = shears ? place.start.r_t * place.start.r_t / (2.0 * place.k) : 0.0;
    energy += place.A * (r.energy + before);  // which counts the spring of faces that stick from the start on
  }
  return energy;
}

double dissipated_by_friction(const QuasistaticModel& model, const Equilibrium& equilibrium, bool with_load) {
  double mean = 0.0, least = 0.0, most = 0.0;
  for (std::size_t k = 0; k < model.places.size(); ++k) {
    const ContactPlace& place = model.places[k];
    const LawAnswer& r = equilibrium.answers[k];
    const double slip = plastic_slip(place, r, equilibrium.w[k]);
    if (slip == 0.0) continue;
    const double against = slip > 0.0 ? -1.0 : 1.0, last = against * r.t, work = place.A * std::abs(slip);
    const double bound = with_load ? place.law.friction() * std::max(0.0, place.start.r_n) : last;
    mean += work * 0.5 * ((with_load ? against * place.start.r_t : last) + last);
    least += work * std::min(bound, last);
    most += work * std::max(bound, last);
  }
  return std::clamp(mean, least, most);
}

}  // namespace strata
