// A scene with its equilibrium without inertia, for the tests of the quasi-static mechanics.
#pragma once

#include "fracture/j_integral.hpp"
#include "quasistatic/model.hpp"
#include "small_scenes.hpp"

namespace strata::test {

// As a run without inertia has it, bins of one place follow each other: no lanes.
inline Scene without_lanes(Scene scene) {
  scene.numerics.kernels = Numerics::Kernels::plain;
  return scene;
}

struct Statics {
  Run run;
  QuasistaticModel model;
  Equilibrium at;

  explicit Statics(const Scene& scene, bool halve = true) : run(without_lanes(scene)) { update(halve); }
  State& state() { return run.state; }
  void update(bool halve = true) { update_model(run.scene, run.rocks, run.state, model, halve); }
  void solve() {
    at = find_equilibrium(run.scene, run.state.time, run.state, model);
    set_fields(run.scene, run.state, model, at);
    set_all_particles(run.scene, run.state, model);
    if (run.state.has_fracture) measure_tips(run.scene, run.rocks, run.state);
  }
};

// Lets all places of all interfaces go, as if they had failed without having carried anything.
inline void fail_all(State& state) {
  for (Surface& surface : state.surfaces) {
    for (SurfacePoint& s : surface.points) s.split = true;
  }
}

// Fluid pressure (Pa) at all points of all surfaces of a kind.
inline void press(State& state, Surface::Kind kind, double P) {
  for (Surface& surface : state.surfaces) {
    for (SurfacePoint& s : surface.points) s.P = surface.kind == kind ? P : s.P;
  }
}

inline double largest_displacement(const Particles& p) {
  double most = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) most = std::max(most, std::hypot(p.u_x[q], p.u_y[q]));
  return most;
}

// Largest difference of the displacements of particles with the same id (m).
inline double largest_difference(const Particles& p, const Particles& other) {
  std::vector<std::size_t> at(p.size());
  for (std::size_t q = 0; q < other.size(); ++q) at[static_cast<std::size_t>(other.id[q])] = q;
  double most = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const std::size_t o = at[static_cast<std::size_t>(p.id[q])];
    most = std::max(most, std::hypot(p.u_x[q] - other.u_x[o], p.u_y[q] - other.u_y[o]));
  }
  return most;
}

}  // namespace strata::test
