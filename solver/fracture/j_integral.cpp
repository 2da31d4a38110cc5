#include "fracture/j_integral.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "state/shape_functions.hpp"

namespace strata {
namespace {

constexpr auto rings = ring_fractions.size();

template <class Value, class Of>
Value mean_over_rings(const Value& none, Of of) {
  Value sum = none;
  for (std::size_t k = 0; k < rings; ++k) sum += of(k);
  return sum / static_cast<double>(rings);
}

// What the interaction with one of Williams' fields takes of a particle's displacement gradient:
//   [s_ij a_i,1 + s^a_ij u_i,1 - s^a : g e_j] Q_j = (C : sym(a_1 Q) + (s^a Q) e - (e . Q) s^a) : g,  Q = V grad q.
std::array<double, 4> interaction(const Elasticity& rock, const Frame& frame, const Stress& aux, const Vec2& a,
                                  const Vec2& Q) {
  const Vec2 &e = frame.e_1, &f = frame.e_2;
  const Vec2 local = aux.on(frame.local(Q));
  const Vec2 on = local.x() * e + local.y() * f;  // s^a Q
  const auto turned = [&](Eigen::Index i, Eigen::Index j) {
    return aux.xx * e[i] * e[j] + aux.yy * f[i] * f[j] + aux.xy * (e[i] * f[j] + f[i] * e[j]);
  };
  const Stress own = stress_of(rock, a.x() * Q.x(), a.x() * Q.y(), a.y() * Q.x(), a.y() * Q.y());
  const double along = e.dot(Q);
  return {own.xx + on.x() * e.x() - along * turned(0, 0), own.xy + on.x() * e.y() - along * turned(0, 1),
          own.xy + on.y() * e.x() - along * turned(1, 0), own.yy + on.y() * e.y() - along * turned(1, 1)};
}

RingParticle ring_particle(const Elasticity& rock, const State& state, const Frame& frame, const RingWeights& weights,
                           std::size_t bin, std::size_t q) {
  const Particles& p = state.particles;
  RingParticle of{q, bin, {}, {}, {}};
  for (std::size_t k = 0; k < rings; ++k) of.V[k] = {p.V[q] * weights[k].q, p.V[q] * weights[k].grad};
  const Vec2 Q = mean_over_rings(Vec2{Vec2::Zero()}, [&](std::size_t k) { return of.V[k].grad; });
  const double V_q = mean_over_rings(0.0, [&](std::size_t k) { return of.V[k].q; });
  const Vec2 at = frame.local(Vec2{p.x[q], p.y[q]} - frame.tip);
  const double theta = angle_at(at, ((p.sides[q] & state.fracture().mask()) != 0) == (frame.sign > 0.0));
  for (std::size_t mode = 0; mode < 2; ++mode) {
    const AuxiliaryFields aux = williams(rock, static_cast<int>(mode), at.norm(), theta);
    const Vec2 a = aux.u_1.x() * frame.e_1 + aux.u_1.y() * frame.e_2;
    of.c[mode] = interaction(rock, frame, aux.s, a, Q);
    of.V_q_u_1[mode] = V_q * a;
  }
  return of;
}

// Calls visit(RingParticle) for the particles of all bins that count: at rest those where q is 1 all around do not.
template <class Visit>
void weigh_particles(const Scene& scene, const Rocks& rocks, const State& state, const TipGeometry& at, Visit visit) {
  const bool at_rest = scene.numerics.mechanics == Numerics::Mechanics::quasistatic && !scene.body.acceleration_m_s2;
  const auto flat = [](const std::array<double, 9>& q, double value) { return std::ranges::count(q, value) == 9; };
  const Particles& p = state.particles;
  for (std::size_t b = 0; b < state.bins.size(); ++b) {
    const Bin& bin = state.bins[b];
    const auto nodes = ring_nodes(state.grid, at, bin.i, bin.j);
    if (!nodes || std::ranges::all_of(*nodes, [&](const auto& q) { return flat(q, 0.0); })) continue;
    if (at_rest && std::ranges::all_of(*nodes, [&](const auto& q) { return flat(q, 1.0) || flat(q, 0.0); })) continue;
    for (const std::size_t q : bin) {
      const RingWeights weights = ring_weights(state.grid, *nodes, bin.i, bin.j, {p.x[q], p.y[q]});
      visit(ring_particle(rocks[p.rock[q]], state, at.frame, weights, b, q));
    }
  }
}

// Calls visit(RingFace) for the points of the fracture that rings may weigh.
template <class Visit>
void weigh_faces(const State& state, const TipGeometry& at, bool at_back, Visit visit) {
  const Grid& grid = state.grid;
  const Surface& fracture = state.fracture();
  for (std::size_t point = 0; point < fracture.points.size(); ++point) {
    const SurfacePoint& s = fracture.points[point];
    const double from_tip = at_back ? fracture.length() - s.arc : s.arc;
    const int i = grid.column_at(s.x.x()), j = grid.row_at(s.x.y());
    const auto nodes = ring_nodes(grid, at, i, j);
    if (!nodes || from_tip > 1.5 * at.rings.back().outer + 2.0 * grid.h) continue;
    const std::size_t after = std::min(point + 1, fracture.points.size() - 1),
                      before = point - std::min<std::size_t>(point, 1);
    RingFace face{point, at_back ? after : before, at_back ? before : after};
    face.span = std::abs(fracture.points[after].arc - fracture.points[before].arc);
    const RingWeights weights = ring_weights(grid, *nodes, i, j, s.x);
    for (std::size_t k = 0; k < rings; ++k)
      face.q[k] = weights[k].q, face.dq_ds[k] = at.frame.sign * weights[k].grad.dot(tangent_of(s.n));
    const double near = std::max(from_tip - 0.5 * s.A, 0.0), far = from_tip + 0.5 * s.A;
    face.I = mean_over_rings(0.0, [&](std::size_t k) { return face.q[k]; }) * 4.0 / at.rock.E_prime * 2.0 *
             (std::sqrt(far) - std::sqrt(near)) / std::sqrt(2.0 * std::numbers::pi);
    visit(face);
  }
}

// Reactions (Pa) of faces that rub, as nodes carry them; none of others. Shear that single points have too much or too
// little of would be a K_II even of faces that stick.
std::vector<Vec2> rubbing_reactions(const Scene& scene, const State& state) {
  if (!state.has_fracture || !scene.fracture || scene.fracture->friction == 0.0) return {};
  return nodal_reactions(state.fracture(), state.point_stencils.front());
}

// w . d(t q)/ds of J, and the interaction's term; r: reactions of rubbing_reactions().
void sum_face(const Surface& fracture, const std::vector<Vec2>& r, const Frame& frame, const RingFace& face,
              TipSums& sums) {
  const auto net = [&](std::size_t k) -> Vec2 {
    const SurfacePoint& s = fracture.points[k];
    return s.P * s.n - s.in_situ + (r.empty() ? s.reaction : r[k]);
  };
  const SurfacePoint& s = fracture.points[face.point];
  const Vec2 t = net(face.point);
  const double w_t = s.w.dot(t), w_dt = face.span > 0.0 ? s.w.dot(net(face.ahead) - net(face.behind)) / face.span : 0.0;
  for (std::size_t k = 0; k < rings; ++k) sums.J[k] += s.A * (w_t * face.dq_ds[k] + face.q[k] * w_dt);
  sums.I[0] += frame.sign * frame.e_2.dot(t) * face.I;
  sums.I[1] += frame.sign * frame.e_1.dot(t) * face.I;
}

// Displacement gradient and velocity of a particle now, what forces other than the body's accelerate it by, and the
// derivative of its velocity along e.
struct ParticleFields {
  Eigen::Matrix2d g;
  Vec2 v = Vec2::Zero(), a = Vec2::Zero(), v_1 = Vec2::Zero();
};

ParticleFields fields_at(const Scene& scene, const State& state, const Vec2& e, std::size_t b, std::size_t q) {
  const Particles& p = state.particles;
  ParticleFields f;
  f.g << p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q];
  if (!state.body.empty()) f.a = -state.body[q];
  if (scene.numerics.mechanics == Numerics::Mechanics::quasistatic) return f;  // nothing moves
  const Bin& bin = state.bins[b];
  const Vec2 x{p.x[q], p.y[q]};
  f.v = {p.v_x[q], p.v_y[q]};
  // Interpolated with B-splines whatever the scene's shape: these only enter here.
  const Gradients smooth = gradients_of<QuadraticBspline>(state.grid, bin.i, bin.j, x, Vec2::Zero());
  for (std::size_t n = 0; n < 9; ++n) {
    const NodeMotion& node = state.motion[static_cast<std::size_t>(bin.record[n])];
    f.a += smooth.N[n] * Vec2{node.dv_x, node.dv_y} / state.dt;
    f.v_1 += (smooth.N_x[n] * e.x() + smooth.N_y[n] * e.y()) * Vec2{node.v_x, node.v_y};
  }
  if (!state.total.based) return f;
  // Nodes keep the motion (kinematics = "total"): what a particle has of its own is as old as the base.
  const Gradients w = gradients_at(scene, state.grid, bin.i, bin.j, x, p.half(q));
  f.v.setZero();
  for (std::size_t n = 0; n < 9; ++n) {
    const NodeMotion& node = state.motion[static_cast<std::size_t>(bin.record[n])];
    f.g += total_displacement(state, bin.record[n]) * Vec2{w.N_x[n], w.N_y[n]}.transpose();
    f.v += w.N[n] * Vec2{node.v_x, node.v_y};
  }
  return f;
}

void sum_particle(const Scene& scene, const Rocks& rocks, const State& state, const Vec2& e, const RingParticle& of,
                  TipSums& sums) {
  const Elasticity& rock = rocks[state.particles.rock[of.particle]];
  const ParticleFields f = fields_at(scene, state, e, of.bin, of.particle);
  const double g_xx = f.g(0, 0), g_xy = f.g(0, 1), g_yx = f.g(1, 0), g_yy = f.g(1, 1);
  const Stress s = stress_of(rock, g_xx, g_xy, g_yx, g_yy);
  const Vec2 u_1 = f.g * e;
  const double W = 0.5 * (s.xx * g_xx + s.yy * g_yy + s.xy * (g_xy + g_yx)), T = 0.5 * rock.rho * f.v.squaredNorm();
  const Vec2 flux = s.on(u_1) - (W + T) * e;
  const double inertia = rock.rho * (f.a.dot(u_1) - f.v.dot(f.v_1));
  for (std::size_t k = 0; k < rings; ++k) sums.J[k] += flux.dot(of.V[k].grad) + inertia * of.V[k].q;
  for (std::size_t mode = 0; mode < 2; ++mode) {
    const auto& c = of.c[mode];
    sums.I[mode] += c[0] * g_xx + c[1] * g_xy + c[2] * g_yx + c[3] * g_yy + rock.rho * f.a.dot(of.V_q_u_1[mode]);
  }
}

}  // namespace

std::vector<TipRule> make_tip_rules(const Scene& scene, const Rocks& rocks, const State& state) {
  std::vector<TipRule> rules;
  for (const Tip& tip : state.tips) {
    TipRule& rule = rules.emplace_back();
    rule.at = tip_geometry(scene, rocks, state, tip);
    weigh_particles(scene, rocks, state, rule.at, [&](const RingParticle& of) { rule.particles.push_back(of); });
    weigh_faces(state, rule.at, tip.at_back, [&](const RingFace& face) { rule.faces.push_back(face); });
  }
  return rules;
}

void measure_tips(const Scene& scene, const Rocks& rocks, const std::vector<TipRule>& rules, State& state) {
  const std::vector<Vec2> r = rubbing_reactions(scene, state);
  for (std::size_t t = 0; t < rules.size(); ++t) {
    const Frame& frame = rules[t].at.frame;
    TipSums sums;
    for (const RingParticle& of : rules[t].particles) sum_particle(scene, rocks, state, frame.e_1, of, sums);
    for (const RingFace& face : rules[t].faces) sum_face(state.fracture(), r, frame, face, sums);
    finish_tip(scene, rules[t].at, state, sums, state.tips[t]);
  }
}

// Without rules, which would take memory in each step.
void measure_tips(const Scene& scene, const Rocks& rocks, State& state) {
  const std::vector<Vec2> r = rubbing_reactions(scene, state);
  for (Tip& tip : state.tips) {
    const TipGeometry at = tip_geometry(scene, rocks, state, tip);
    TipSums sums;
    weigh_particles(scene, rocks, state, at,
                    [&](const RingParticle& of) { sum_particle(scene, rocks, state, at.frame.e_1, of, sums); });
    weigh_faces(state, at, tip.at_back,
                [&](const RingFace& face) { sum_face(state.fracture(), r, at.frame, face, sums); });
    finish_tip(scene, at, state, sums, tip);
  }
}

double kink_angle(double K_I, double K_II) {
  if (K_II == 0.0) return 0.0;
  return 2.0 * std::atan((K_I - std::sqrt(K_I * K_I + 8.0 * K_II * K_II)) / (4.0 * K_II));
}

}  // namespace strata
