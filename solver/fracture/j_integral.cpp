#include "fracture/j_integral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include "fracture/tip_rings.hpp"
#include "state/shape_functions.hpp"

namespace strata {

namespace {

// Fields at a particle in the tip's frame.
struct LocalFields {
  double r = 0.0, theta = 0.0;
  Vec2 at;              // position relative to the tip
  double H[2][2] = {};  // displacement gradient, H[i][j] = u_i,j
  Stress s;             // change of stress
  Vec2 v, a;            // velocity, acceleration that forces gave but for the body force
  Vec2 v_1;             // derivative of the velocity along the fracture
  double V = 0.0;
};

void add_domain(const Elasticity& rock, const LocalFields& p, std::span<const Weight> weights, RingSums& sums) {
  const Vec2 u_1{p.H[0][0], p.H[1][0]};
  const double e_12 = 0.5 * (p.H[0][1] + p.H[1][0]);
  const double W = 0.5 * (p.s.xx * p.H[0][0] + p.s.yy * p.H[1][1] + 2.0 * p.s.xy * e_12);
  const double T = 0.5 * rock.rho * p.v.squaredNorm();
  const Vec2 flux{p.s.on({1.0, 0.0}).dot(u_1) - W - T, p.s.on({0.0, 1.0}).dot(u_1)};
  const double inertia = rock.rho * (p.a.dot(u_1) - p.v.dot(p.v_1));
  const std::array<AuxiliaryFields, 2> aux{williams(rock, 0, p.r, p.theta), williams(rock, 1, p.r, p.theta)};
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const double q = weights[k].q;
    const Vec2& grad_q = weights[k].grad;
    sums[k].J += p.V * (flux.dot(grad_q) + inertia * q);
    for (std::size_t mode = 0; mode < 2; ++mode) {
      const AuxiliaryFields& A = aux[mode];
      const double mixed = A.s.xx * p.H[0][0] + A.s.yy * p.H[1][1] + 2.0 * A.s.xy * e_12;
      const Vec2 I{p.s.on({1.0, 0.0}).dot(A.u_1) + A.s.on({1.0, 0.0}).dot(u_1) - mixed,
                   p.s.on({0.0, 1.0}).dot(A.u_1) + A.s.on({0.0, 1.0}).dot(u_1)};
      sums[k].I[mode] += p.V * (I.dot(grad_q) + rock.rho * p.a.dot(A.u_1) * q);
    }
  }
}

// Displacement gradient and velocity of a particle now: where nodes keep the motion (kinematics = "total"), what it has
// of its own is as old as the base.
struct ParticleFields {
  double g[2][2] = {};
  Vec2 v = Vec2::Zero();
};

ParticleFields particle_fields(const Scene& scene, const State& state, const Bin& bin, std::size_t q) {
  const Particles& p = state.particles;
  ParticleFields f{{{p.g_xx[q], p.g_xy[q]}, {p.g_yx[q], p.g_yy[q]}}, {p.v_x[q], p.v_y[q]}};
  if (!state.total.based) return f;
  const Gradients w = gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
  f.v.setZero();
  for (std::size_t n = 0; n < 9; ++n) {
    const Vec2 u = total_displacement(state, bin.record[n]);
    const NodeMotion& node = state.motion[static_cast<std::size_t>(bin.record[n])];
    for (int i = 0; i < 2; ++i) f.g[i][0] += w.N_x[n] * u[i], f.g[i][1] += w.N_y[n] * u[i];
    f.v += w.N[n] * Vec2{node.v_x, node.v_y};
  }
  return f;
}

// What forces accelerate a particle by, and the derivative of its velocity along the fracture.
struct ParticleMotion {
  Vec2 a = Vec2::Zero(), v_1 = Vec2::Zero();
};

// Interpolated with B-splines whatever the scene's shape: they only enter here. Without inertia nothing moves.
ParticleMotion motion_at(const Scene& scene, const State& state, const Frame& frame, const Bin& bin, std::size_t q) {
  ParticleMotion m;
  if (scene.numerics.mechanics == Numerics::Mechanics::quasistatic) return m;
  const Particles& p = state.particles;
  const Weights X = weights_x<QuadraticBspline>(state.grid, bin.i, p.x[q], 0.0),
                Y = weights_y<QuadraticBspline>(state.grid, bin.j, p.y[q], 0.0);
  const double s_x = state.grid.span_x(bin.i), s_y = state.grid.span_y(bin.j);
  for (std::size_t n = 0; n < 9; ++n) {
    const NodeMotion& node = state.motion[static_cast<std::size_t>(bin.record[n])];
    const double N = X.N[n % 3] * Y.N[n / 3];
    const Vec2 grad{X.dN[n % 3] * Y.N[n / 3] / s_x, X.N[n % 3] * Y.dN[n / 3] / s_y};
    m.a += N * Vec2{node.dv_x, node.dv_y} / state.dt;
    m.v_1 += grad.dot(frame.e_1) * Vec2{node.v_x, node.v_y};
  }
  return m;
}

LocalFields fields_at(const Scene& scene, const State& state, const Elasticity& rock, const Frame& frame,
                      SideWord fracture_bit, const Bin& bin, std::size_t q) {
  const Particles& p = state.particles;
  LocalFields f;
  f.at = frame.local(Vec2{p.x[q], p.y[q]} - frame.tip);
  f.r = f.at.norm();
  f.theta = angle_at(f.at, ((p.sides[q] & fracture_bit) != 0) == (frame.sign > 0.0));
  const ParticleFields own = particle_fields(scene, state, bin, q);
  const Vec2 e[2] = {frame.e_1, frame.e_2};
  for (int i = 0; i < 2; ++i) {
    for (int j = 0; j < 2; ++j) {
      for (int k = 0; k < 2; ++k) {
        for (int l = 0; l < 2; ++l) f.H[i][j] += e[i][k] * own.g[k][l] * e[j][l];
      }
    }
  }
  f.s = stress_of(rock, f.H[0][0], f.H[0][1], f.H[1][0], f.H[1][1]);
  f.V = p.V[q];
  f.v = frame.local(own.v);
  auto [a, v_1] = motion_at(scene, state, frame, bin, q);
  if (!state.body.empty()) a -= state.body[q];
  f.a = frame.local(a);
  f.v_1 = frame.local(v_1);
  return f;
}

// Adds the particles of a bin to the sums of all rings; a bin that no ring weighs adds nothing.
void add_bin(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state, const TipGeometry& at,
             const Bin& bin, RingSums& sums) {
  std::array<NodalWeights, ring_fractions.size()> nodes;
  if (!weigh_bin(state.grid, at, bin, nodes)) return;
  std::array<Weight, ring_fractions.size()> weights;
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
       q += static_cast<std::size_t>(bin.stride)) {
    const Vec2 x{state.particles.x[q], state.particles.y[q]};
    for (std::size_t k = 0; k < weights.size(); ++k)
      weights[k] = weight_at(state.grid, at.frame, nodes[k], bin.i, bin.j, x);
    const Elasticity& own = rocks[state.particles.rock[q]];
    add_domain(own, fields_at(scene, state, own, at.frame, state.fracture().mask(), bin, q), weights, sums);
  }
}

}  // namespace

void measure_tips(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  if (!state.has_fracture) return;
  for (Tip& tip : state.tips) {
    const TipGeometry at = tip_geometry(scene, rocks, state, tip);
    RingSums sums{};
    for (const Bin& bin : state.bins) add_bin(scene, rocks, state, at, bin, sums);
    for (std::size_t k = 0; k < state.fracture().points.size(); ++k) {
      if (const auto place = face_place(state, at, tip.at_back, k)) add_face(state.fracture(), at.frame, *place, sums);
    }
    finish_tip(scene, at, state, sums, tip);
  }
}

double kink_angle(double K_I, double K_II) {
  if (K_II == 0.0) return 0.0;
  return 2.0 * std::atan((K_I - std::sqrt(K_I * K_I + 8.0 * K_II * K_II)) / (4.0 * K_II));
}

}  // namespace strata
