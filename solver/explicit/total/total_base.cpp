#include "explicit/total/total_base.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "explicit/momentum.hpp"
#include "explicit/reactions.hpp"
#include "explicit/total/total_operator.hpp"
#include "explicit/transfers.hpp"
#include "interfaces/failure.hpp"
#include "interfaces/surface_tractions.hpp"
#include "state/particle_loop.hpp"
#include "state/parts.hpp"
#include "state/rebuild.hpp"

namespace strata {

namespace {

// The mean of values by the masses that brought them.
void add_mass(double m, const Vec2& value, const NodalSums::Record& sum) {
  sum.m += m, sum.mom_x += m * value.x(), sum.mom_y += m * value.y();
}
Vec2 mean_of(const NodeSums& sum) {
  return Vec2{sum.mom_x, sum.mom_y} / sum.m;
}

// Displacements in the place of velocities.
NodalMotion as_motion(const std::vector<Vec2>& u) {
  NodalMotion motion(u.size());
  for (std::size_t r = 0; r < u.size(); ++r) motion[r] = NodeMotion{u[r].x(), u[r].y(), 0.0, 0.0};
  return motion;
}

void fill_nodes(State& state) {
  TotalMotion& t = state.total;
  for (auto* array : {&t.m, &t.base_x, &t.base_y, &t.v_x, &t.v_y, &t.u_x, &t.u_y})
    array->assign(state.masters.size() + most_lanes, 0.0);  // vectors read beyond the last
  for (std::size_t r = 0; r < state.masters.size(); ++r) {
    const NodeSums& sum = state.sums[r];
    if (state.masters[r].record != static_cast<int>(r) || !(sum.m > 0.0)) continue;
    t.m[r] = sum.m;
    t.base_x[r] = sum.f_x / sum.m, t.base_y[r] = sum.f_y / sum.m;
    t.v_x[r] = state.masters[r].x * t.velocity[r].x(), t.v_y[r] = state.masters[r].y * t.velocity[r].y();
  }
  t.a_x = t.base_x, t.a_y = t.base_y;
}

}  // namespace

std::vector<Vec2> nodes_from_particles(const Scene& scene, const State& state, const std::vector<Bin>& bins,
                                       const SpreadArray& x, const SpreadArray& y, int passes) {
  std::vector<Vec2> v(state.masters.size(), Vec2::Zero());
  NodalSums sums;
  for (int pass = 0; pass < passes; ++pass) {
    sums.clear(v.size());
    for_each_particle(scene, state, bins, [&](const Bin& bin, std::size_t q, const Gradients& g) {
      const Vec2 lacks = Vec2{x[q], y[q]} - interpolate(g, bin, v);
      for (std::size_t n = 0; n < 9; ++n)
        add_mass(g.N[n] * state.particles.m[q], lacks, sums[static_cast<std::size_t>(bin.record[n])]);
    });
    fold_to_masters(state, sums);
    for (std::size_t r = 0; r < v.size(); ++r) {
      if (sums.m[r] > 0.0) v[r] += mean_of(sums[r]);
    }
    for_each_tied(state, [&](std::size_t record, const Master& master) {
      const Vec2 from = v[static_cast<std::size_t>(master.record)];
      v[record] = {master.x * from.x(), master.y * from.y()};
    });
  }
  return v;
}

void start_base(const Scene& scene, const Rocks& rocks, State& state) {
  TotalMotion& t = state.total;
  if (t.based) return;
  particles_to_grid(scene, rocks, state);
  update_stencil_weights(scene, state);
  fold_to_masters(state, state.sums);
  if (!t.op) t.op = std::make_shared<const StencilOperator>(make_operator(scene, rocks, state));
  const bool starts = t.velocity.empty();
  if (starts) t.velocity = nodes_from_particles(scene, state, state.bins, state.particles.v_x, state.particles.v_y, 3);
  fill_nodes(state);
  find_split_places(scene, rocks, state);
  t.bonds = make_bond_sensors(scene, rocks, state);
  t.based = true;
  if (starts) recount_kinetic(state);
}

void bring_up_to_date(const Scene& scene, State& state) {
  TotalMotion& t = state.total;
  if (!t.based) return;
  std::vector<Vec2> u;
  t.velocity.clear();
  for (int record = 0; record < state.copies.records(); ++record)
    u.push_back(total_displacement(state, record)), t.velocity.push_back(total_velocity(state, record));
  const NodalMotion since = as_motion(u);
  Particles& p = state.particles;
  for_each_particle(scene, state, state.bins, [&](const Bin& bin, std::size_t q, const Gradients& g) {
    const Vec2 du = interpolate(g, bin, u), v = interpolate(g, bin, t.velocity);
    Vec2 u_1 = Vec2::Zero(), u_2 = Vec2::Zero();
    for (std::size_t n = 0; n < 9; ++n) {
      const Vec2& u_n = u[static_cast<std::size_t>(bin.record[n])];
      u_1 += g.N_x[n] * u_n, u_2 += g.N_y[n] * u_n;
    }
    p.u_x[q] += du.x(), p.u_y[q] += du.y();
    p.v_x[q] = v.x(), p.v_y[q] = v.y();
    p.g_xx[q] += u_1.x(), p.g_xy[q] += u_2.x(), p.g_yx[q] += u_1.y(), p.g_yy[q] += u_2.y();
  });
  const auto move = [&](std::vector<SurfacePoint>& places, const std::vector<SurfaceStencil>& stencils) {
    for (std::size_t k = 0; k < places.size(); ++k) {
      places[k].u += mean_velocity(stencils[k], since);
      if (!places[k].split) places[k].w += jump(stencils[k], since);  // vertices and what is whole
    }
  };
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    move(state.surfaces[k].points, state.point_stencils[k]);
    move(state.surfaces[k].vertices, state.vertex_stencils[k]);
  }
  t.based = false;
}

void note_motion(State& state) {
  const TotalMotion& t = state.total;
  for (std::size_t r = 0; r < state.motion.size(); ++r) {
    const Vec2 v = total_velocity(state, static_cast<int>(r)), a = of_master(state, static_cast<int>(r), t.a_x, t.a_y);
    state.motion[r] = {v.x(), v.y(), state.dt * a.x(), state.dt * a.y()};
  }
}

void push_body(const Scene& scene, State& state) {
  if (state.body.empty()) return;
  TotalMotion& t = state.total;
  add_body_force(scene, state);
  fold_to_masters(state, state.body_sums);
  for (std::size_t r = 0; r < state.masters.size(); ++r) {
    if (t.m[r] > 0.0) t.a_x[r] += state.body_sums.f_x[r] / t.m[r], t.a_y[r] += state.body_sums.f_y[r] / t.m[r];
  }
}

void carry_velocities(const Scene& scene, const RecordVelocities& before, State& state) {
  std::vector<Vec2>& v = state.total.velocity;
  v.clear();
  for (const int node : state.copies.node_of_record) v.push_back(before.v[static_cast<std::size_t>(node)]);
  const auto was_cut = [&](int record) {
    const int node = state.copies.node(record);
    return before.copies.cut_at(node) != nullptr;
  };
  std::vector<Bin> near;
  std::ranges::copy_if(state.bins, std::back_inserter(near),
                       [&](const Bin& bin) { return std::ranges::any_of(bin.record, was_cut); });
  NodalSums sums(v.size());
  for_each_particle(scene, state, near, [&](const Bin& bin, std::size_t q, const Gradients& g) {
    for (std::size_t n = 0; n < 9; ++n) {
      const int record = bin.record[n];
      if (!was_cut(record)) continue;
      const int node = state.copies.node(record);
      const int old = record_of(before.copies, node, state.particles.sides[q]);
      add_mass(state.particles.m[q] * g.N[n], before.v[static_cast<std::size_t>(old >= 0 ? old : node)],
               sums[static_cast<std::size_t>(record)]);
    }
  });
  for (std::size_t r = 0; r < v.size(); ++r) {
    if (sums.m[r] > 0.0) v[r] = mean_of(sums[r]);
  }
}

void recount_kinetic(State& state) {
  const TotalMotion& t = state.total;
  double kinetic = 0.0;
  for (std::size_t s = 0; s < t.m.size(); ++s) kinetic += 0.5 * t.m[s] * (t.v_x[s] * t.v_x[s] + t.v_y[s] * t.v_y[s]);
  state.ledger.transfer += state.ledger.kinetic - kinetic;
  state.ledger.kinetic = kinetic;
}

// --- bonded interfaces

namespace {

BondSensor::Entry& entry_at(BondSensor& sensor, const Master& master) {
  const auto r = static_cast<std::size_t>(master.record);
  const auto at = std::ranges::find(sensor.entries, r, &BondSensor::Entry::master);
  return at != sensor.entries.end() ? *at : sensor.entries.emplace_back(BondSensor::Entry{r});
}

}  // namespace

std::vector<BondSensor> make_bond_sensors(const Scene& scene, const Rocks& rocks, const State& state) {
  std::vector<BondSensor> sensors;
  const Particles& p = state.particles;
  const std::vector<std::size_t> bin_of = bins_of_particles(state);
  for (const BondSample& sample : state.bonds.samples) {
    BondSensor& sensor = sensors.emplace_back();
    for (const auto& [q, weight, Phi] : sample.particles) {
      const Bin& bin = state.bins[bin_of[q]];
      const Elasticity& rock = rocks[p.rock[q]];
      const Gradients g = gradients_at(scene, state, bin, q);
      for (std::size_t k = 0; k < 9; ++k) {
        const Master& master = state.masters[static_cast<std::size_t>(bin.record[k])];
        Eigen::Matrix2d& T = entry_at(sensor, master).T;
        T.col(0) += master.x * stress_of(rock, g.N_x[k], g.N_y[k], 0.0, 0.0).on(weight);
        T.col(1) += master.y * stress_of(rock, 0.0, 0.0, g.N_x[k], g.N_y[k]).on(weight);
      }
    }
    for (const BondSample::Mass& mass : sample.inertia)
      entry_at(sensor, state.masters[static_cast<std::size_t>(mass.record)]).m += mass.m;
  }
  Bonds still = state.bonds;
  for (BondSample& sample : still.samples) sample.inertia.clear();
  find_forces(rocks, state, still);
  for (std::size_t k = 0; k < sensors.size(); ++k) sensors[k].base = still.forces[k];
  return sensors;
}

void forces_of_nodes(const State& state, std::vector<Vec2>& forces) {
  const TotalMotion& t = state.total;
  forces.clear();
  for (const BondSensor& sensor : t.bonds) {
    Vec2& force = forces.emplace_back(sensor.base);
    for (const auto& [r, T, m] : sensor.entries) force += T * Vec2{t.u_x[r], t.u_y[r]} + m * Vec2{t.a_x[r], t.a_y[r]};
  }
}

// --- new points of a fracture

namespace {

// What parts a point on which nothing has been noted yet.
bool is_new(const SurfacePoint& s) {
  return s.w == Vec2::Zero();
}

// Bins around the new points: a nodal field follows from the particles of a few cells around.
std::vector<Bin> bins_around(const State& state) {
  constexpr double around_cells = 6.0;
  Vec2 low = Vec2::Constant(HUGE_VAL), high = Vec2::Constant(-HUGE_VAL);
  for (const auto* places : {&state.fracture().points, &state.fracture().vertices}) {
    for (const SurfacePoint& s : *places) {
      if (is_new(s)) low = low.cwiseMin(s.x), high = high.cwiseMax(s.x);
    }
  }
  const double reach = around_cells * state.grid.h;
  std::vector<Bin> bins;
  std::ranges::copy_if(state.bins, std::back_inserter(bins), [&](const Bin& bin) {
    const double x = state.grid.x(bin.i), y = state.grid.y(bin.j);
    return x > low.x() - reach && x < high.x() + reach && y > low.y() - reach && y < high.y() + reach;
  });
  return bins;
}

}  // namespace

void open_new_points(const Scene& scene, const Rocks& rocks, State& state) {
  // Where a fracture has grown over four cells by a fifth of one at a time, its volume is 0.5 % off by 8 passes, and
  // 0.07 % by 24.
  constexpr int passes = 24;
  const Particles& p = state.particles;
  const NodalMotion field = as_motion(nodes_from_particles(scene, state, bins_around(state), p.u_x, p.u_y, passes));
  particles_to_grid(scene, rocks, state);  // masses
  update_stencil_weights(scene, state);
  const auto open = [&](std::vector<SurfacePoint>& points, const std::vector<SurfaceStencil>& stencils) {
    for (std::size_t q = 0; q < points.size(); ++q) {
      SurfacePoint& s = points[q];
      if (!is_new(s)) continue;
      s.w = jump(stencils[q], field);
      s.w -= std::min(0.0, s.opening()) * s.n;  // of what was whole a moment ago no overlap is to be pushed back
    }
  };
  open(state.fracture().points, state.point_stencils.front());
  open(state.fracture().vertices, state.vertex_stencils.front());
}

}  // namespace strata
