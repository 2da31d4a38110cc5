// Small blocks for the tests of the solver's core, and what several of them do with a state.
#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <vector>

#include "explicit/advance.hpp"
#include "explicit/total/total_base.hpp"
#include "initialise.hpp"
#include "interfaces/tip_ties.hpp"
#include "quasistatic/resting_rock.hpp"
#include "scene/scene.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

// Whether the program is built with the thread sanitizer: GCC has a macro for it, clang a feature.
#if defined(__SANITIZE_THREAD__)
#define STRATA_TESTS_RACES 1
#elif defined(__has_feature)
#if __has_feature(thread_sanitizer)
#define STRATA_TESTS_RACES 1
#endif
#endif
#ifndef STRATA_TESTS_RACES
#define STRATA_TESTS_RACES 0
#endif

namespace strata::test {

// Blocks as small as those of the tests gain nothing by threads; there are two where races are looked for.
constexpr int threads_of_tests = STRATA_TESTS_RACES ? 2 : 1;

// A block of nx by ny cells of one rock, all edges loaded by the in-situ traction, which is zero.
inline Scene block(int nx, int ny, double h = 1.0) {
  Scene scene;
  scene.domain = {nx * h, ny * h, Edge::traction, Edge::traction, Edge::traction};
  scene.rocks.push_back({"stiff", 10e9, 0.2, 2500.0, 1.45e6});
  scene.laws.resize(1);
  scene.strata.layers = {{0, 0.0, ny * h}};
  scene.numerics.cell_m = h;
  scene.numerics.courant = 0.5;
  return scene;
}

// Edges that hold the normal displacement, all around.
inline void hold_edges(Scene& scene) {
  scene.domain.bottom = Edge::symmetry;
  scene.domain.sides = scene.domain.top = Edge::fixed;
}

// An interface at `at` (m) through the topmost layer, whose upper part is of `rock`.
inline void add_interface(Scene& scene, const InterfaceLaw& law, double at, std::size_t rock = 0) {
  scene.laws.push_back(law);
  const Layer below = scene.strata.layers.back();
  scene.strata.layers.back().to_m = at;
  scene.strata.layers.push_back({rock, at, below.to_m});
  scene.strata.interfaces.push_back({scene.laws.size() - 1, at});
}

// A fracture that does not grow, filled with uniform pressure (Pa).
inline void add_fracture(Scene& scene, const std::vector<std::array<double, 2>>& path, double pressure = 0.0) {
  scene.fracture = Fracture{};
  scene.fracture->path_m = path;
  scene.fracture->growth = Fracture::Growth::none;
  scene.fluid.law = Fluid::Law::uniform;
  scene.fluid.start_Pa = pressure;
}

// A block with a short fracture in it, so that cells are fine around its middle and coarse towards all edges.
inline Scene graded_block(int nx = 60, int ny = 50, double far = 5.0, double h = 1.0) {
  Scene scene = block(nx, ny, h);
  scene.numerics.far_cell_m = far;
  add_fracture(scene, {{20.0 * h, 24.0 * h}, {20.0 * h, 26.0 * h}});
  return scene;
}

inline InterfaceLaw soft_law(double D_n, double D_t,
                             InterfaceLaw::Compression compression = InterfaceLaw::Compression::contact) {
  InterfaceLaw law;
  law.name = "soft";
  law.kind = InterfaceLaw::Kind::soft;
  law.normal_stiffness_Pa_m = D_n;
  law.shear_stiffness_Pa_m = D_t;
  law.compression = compression;
  return law;
}

inline InterfaceLaw friction_law(double coefficient) {
  InterfaceLaw law;
  law.name = "friction";
  law.kind = InterfaceLaw::Kind::friction;
  law.coefficient = coefficient;
  return law;
}

inline InterfaceLaw weak_law(double S_c, double N_c, double residual = 0.0) {
  InterfaceLaw law;
  law.name = "weak";
  law.kind = InterfaceLaw::Kind::weak;
  law.shear_strength_Pa = S_c;
  law.tensile_strength_Pa = N_c;
  law.residual_friction = residual;
  return law;
}

// A scene with its state.
struct Run {
  Scene scene;
  Rocks rocks;
  State state;

  explicit Run(const Scene& from) : scene(from), rocks(make_elasticities(scene)), state(initialise(scene, rocks)) {
    omp_set_num_threads(threads_of_tests);
  }
  void advance(int steps) {
    const WeighGrowth weigh = [this](State& now) { growth_weighing(scene, rocks)(now); };  // keeps nothing
    for (int k = 0; k < steps; ++k) strata::advance(scene, rocks, state, weigh);
    bring_up_to_date(scene, state);
  }
  void rebuild() { strata::rebuild(scene, rocks, state); }
};

// Sets every particle's velocity to random numbers of a fixed sequence, mean + up to `scatter` (m/s) a component.
inline void stir(State& state, const Vec2& mean, double scatter, unsigned seed = 1) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> uniform(-scatter, scatter);
  Particles& p = state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    p.v_x[q] = mean.x() + uniform(random);
    p.v_y[q] = mean.y() + uniform(random);
  }
}

// Displacement gradient of all particles, g[i][j] = du_i/dx_j; displacements stay.
inline void strain(State& state, std::size_t q, const std::array<double, 4>& g) {
  Particles& p = state.particles;
  p.g_xx[q] = g[0], p.g_xy[q] = g[1], p.g_yx[q] = g[2], p.g_yy[q] = g[3];
}

// The displacement gradient (xx, xy, yx, yy; symmetric) under which a rock bears a stress (Pa) in plane strain.
inline std::array<double, 4> gradient_of(const Rock& rock, const Stress& s) {
  const double E = rock.youngs_modulus_Pa, nu = rock.poisson_ratio;
  const double xx = (1.0 + nu) / E * ((1.0 - nu) * s.xx - nu * s.yy);
  const double yy = (1.0 + nu) / E * ((1.0 - nu) * s.yy - nu * s.xx);
  const double xy = (1.0 + nu) / E * s.xy;
  return {xx, xy, xy, yy};
}

// sum m v over the particles for which chosen(q).
template <class Chosen>
Vec2 momentum(const Particles& p, Chosen chosen) {
  Vec2 sum = Vec2::Zero();
  for (std::size_t q = 0; q < p.size(); ++q) {
    if (chosen(q)) sum += p.m[q] * Vec2{p.v_x[q], p.v_y[q]};
  }
  return sum;
}

inline Vec2 momentum(const Particles& p) {
  return momentum(p, [](std::size_t) { return true; });
}

inline double kinetic_energy(const Particles& p) {
  double sum = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) sum += 0.5 * p.m[q] * (p.v_x[q] * p.v_x[q] + p.v_y[q] * p.v_y[q]);
  return sum;
}

// Largest speed of a particle (m/s).
inline double top_speed(const Particles& p) {
  double most = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) most = std::max(most, std::hypot(p.v_x[q], p.v_y[q]));
  return most;
}

inline constexpr std::array shapes{Numerics::Shape::bspline2, Numerics::Shape::linear, Numerics::Shape::gimp};
inline constexpr std::array transfers{Numerics::Transfer::flip, Numerics::Transfer::pic, Numerics::Transfer::xpic2};

/// Whether a record is a copy of a cut node.
inline bool is_cut(const Copies& copies, int record) {
  return copies.cut_of_node[static_cast<std::size_t>(copies.node_of_record[static_cast<std::size_t>(record)])] >= 0;
}

}  // namespace strata::test
