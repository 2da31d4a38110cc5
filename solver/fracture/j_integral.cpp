#include "fracture/j_integral.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>

#include "state/shape_functions.hpp"

namespace strata {

namespace {

constexpr double pi = std::numbers::pi;
// numerics.ring_cells is 4 by default: rings of 3.2 to 4 cells are wide enough to leave the tip's own error inside.
// None is smaller than this, since the tip's own error would fill it. An interface that would ask for less flags the K;
// an edge nearer than 3.5 cells, or a second tip nearer than 7, does not: the ring then reaches over it.
constexpr double narrowest_ring_cells = 2.5;
constexpr double trusted_cells = 4.0;  // distance to an interface below which K is flagged
constexpr std::array<double, 3> ring_fractions{0.8, 0.9, 1.0};
constexpr double inner_fraction = 0.6;  // q is 1 inside this fraction of a ring's radius: 0.3 costs 1 % in J

struct Frame {
  Vec2 tip, e_1, e_2;
  double sign = 1.0;  // + side of the fracture above (1) or below (-1) as the tip looks ahead
  Vec2 local(const Vec2& a) const { return {a.dot(e_1), a.dot(e_2)}; }
};

// The weight q: 1 at nodes inside the inner radius, 0 beyond the outer one, a cosine between, and between nodes the
// same B-splines as the fields. An analytic q on the same particles scatters J by 3 % from ring to ring, since their
// stress is in equilibrium in the sense of the grid's functions only.
struct Ring {
  double inner = 0.0, outer = 0.0;
  double at_node(double r) const {
    if (r <= inner) return 1.0;
    if (r >= outer) return 0.0;
    return 0.5 + 0.5 * std::cos(pi * (r - inner) / (outer - inner));
  }
};

// q and its gradient in the tip's frame at a place.
struct Weight {
  double q = 0.0;
  Vec2 grad = Vec2::Zero();
};

// q at the nine nodes around a place.
using NodalWeights = std::array<double, 9>;

NodalWeights nodal_weights(const Grid& g, const Vec2& tip, const Ring& ring, int i, int j) {
  NodalWeights q{};
  for (int n = 0; n < 9; ++n) {
    const Vec2 x{g.x(i + n % 3 - 1), g.y(j + n / 3 - 1)};
    q[static_cast<std::size_t>(n)] = ring.at_node((x - tip).norm());
  }
  return q;
}

// Spans are h where q is not 0: rings lie among fine cells.
Weight weight_at(const Grid& g, const Frame& frame, const NodalWeights& nodes, int i, int j, const Vec2& x) {
  const Weights X = weights_x<QuadraticBspline>(g, i, x.x(), 0.0), Y = weights_y<QuadraticBspline>(g, j, x.y(), 0.0);
  double q = 0.0;
  Vec2 grad = Vec2::Zero();
  for (std::size_t n = 0; n < 9; ++n) {
    q += X.N[n % 3] * Y.N[n / 3] * nodes[n];
    grad += nodes[n] / g.h * Vec2{X.dN[n % 3] * Y.N[n / 3], X.N[n % 3] * Y.dN[n / 3]};
  }
  return {q, frame.local(grad)};
}

struct Sums {
  double J = 0.0;
  std::array<double, 2> I{};  // interaction with unit K_I and unit K_II
};

using Rings = std::array<Ring, ring_fractions.size()>;
using RingSums = std::array<Sums, ring_fractions.size()>;

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

struct AuxiliaryFields {
  Stress s;  // stress for unit K
  Vec2 u_1;  // derivative of displacement along the fracture
};

// Williams' field of mode I (mode = 0) or II (1) for unit K, plane strain.
AuxiliaryFields williams(const Elasticity& rock, int mode, double r, double theta) {
  const double kappa = 3.0 - 4.0 * rock.nu;
  const double c = std::cos(0.5 * theta), s = std::sin(0.5 * theta), c3 = std::cos(1.5 * theta),
               s3 = std::sin(1.5 * theta);
  const double root = 1.0 / std::sqrt(2.0 * pi * r), cos_t = std::cos(theta), sin_t = std::sin(theta);
  double g_1 = 0.0, g_2 = 0.0, d_1 = 0.0, d_2 = 0.0;  // angular parts of u and their derivatives
  AuxiliaryFields aux;
  if (mode == 0) {
    aux.s = {root * c * (1.0 - s * s3), root * c * (1.0 + s * s3), root * s * c * c3};
    g_1 = c * (kappa - cos_t), g_2 = s * (kappa - cos_t);
    d_1 = -0.5 * s * (kappa - cos_t) + c * sin_t, d_2 = 0.5 * c * (kappa - cos_t) + s * sin_t;
  } else {
    aux.s = {-root * s * (2.0 + c * c3), root * s * c * c3, root * c * (1.0 - s * s3)};
    g_1 = s * (kappa + 2.0 + cos_t), g_2 = -c * (kappa - 2.0 + cos_t);
    d_1 = 0.5 * c * (kappa + 2.0 + cos_t) - s * sin_t, d_2 = 0.5 * s * (kappa - 2.0 + cos_t) + c * sin_t;
  }
  const double scale = root / (2.0 * rock.mu);
  aux.u_1 = scale * Vec2{0.5 * g_1 * cos_t - d_1 * sin_t, 0.5 * g_2 * cos_t - d_2 * sin_t};
  return aux;
}

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
  for (std::size_t n = 0; n < 9; ++n) {
    const NodeMotion& node = state.motion[static_cast<std::size_t>(bin.record[n])];
    const double N = X.N[n % 3] * Y.N[n / 3];
    const Vec2 grad = Vec2{X.dN[n % 3] * Y.N[n / 3], X.N[n % 3] * Y.dN[n / 3]} / state.grid.h;
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
  f.theta = std::atan2(f.at.y(), f.at.x());
  // Behind a kink the straight extension and the fracture differ: the side, not the angle, tells the face.
  const bool above = ((p.sides[q] & fracture_bit) != 0) == (frame.sign > 0.0);
  if (f.at.x() < 0.0 && above && f.theta < 0.0) f.theta += 2.0 * pi;
  if (f.at.x() < 0.0 && !above && f.theta > 0.0) f.theta -= 2.0 * pi;
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

// Whether all nodes around a bin lie outside the square around a ring: then q is 0 at them.
bool out_of_reach(const Grid& g, const Vec2& tip, const Ring& ring, const Bin& bin) {
  return g.x(bin.i + 1) < tip.x() - ring.outer || g.x(bin.i - 1) > tip.x() + ring.outer ||
         g.y(bin.j + 1) < tip.y() - ring.outer || g.y(bin.j - 1) > tip.y() + ring.outer;
}

// Adds the particles of a bin to the sums of all rings; a bin that no ring weighs adds nothing.
void add_bin(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state, const Frame& frame,
             const Rings& rings, const Bin& bin, RingSums& sums) {
  if (out_of_reach(state.grid, frame.tip, rings.back(), bin)) return;
  std::array<NodalWeights, ring_fractions.size()> nodes;
  bool any = false;
  for (std::size_t k = 0; k < rings.size(); ++k) {
    nodes[k] = nodal_weights(state.grid, frame.tip, rings[k], bin.i, bin.j);
    any = any || *std::max_element(nodes[k].begin(), nodes[k].end()) > 0.0;
  }
  if (!any) return;
  std::array<Weight, ring_fractions.size()> weights;
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
       q += static_cast<std::size_t>(bin.stride)) {
    const Vec2 x{state.particles.x[q], state.particles.y[q]};
    for (std::size_t k = 0; k < rings.size(); ++k) weights[k] = weight_at(state.grid, frame, nodes[k], bin.i, bin.j, x);
    const Elasticity& own = rocks[state.particles.rock[q]];
    add_domain(own, fields_at(scene, state, own, frame, state.fracture().mask(), bin, q), weights, sums);
  }
}

// Face terms: w . d(t q)/ds of J, and of the interaction integral + t 4/E' q/sqrt(2 pi r) dr, exact for t constant on a
// piece.
void add_faces(const Elasticity& rock, const Grid& grid, const Surface& fracture, const Frame& frame, bool at_back,
               const Rings& rings, RingSums& sums) {
  const auto& points = fracture.points;
  const auto n = static_cast<std::ptrdiff_t>(points.size());
  const auto net = [&](std::ptrdiff_t k) -> Vec2 {
    const SurfacePoint& s = points[static_cast<std::size_t>(k)];
    return frame.sign * frame.local(s.P * s.n - s.in_situ + s.reaction);
  };
  for (std::ptrdiff_t k = 0; k < n; ++k) {
    const SurfacePoint& s = points[static_cast<std::size_t>(k)];
    const double from_tip = at_back ? fracture.length() - s.arc : s.arc;
    if (from_tip > 1.5 * rings.back().outer + 2.0 * grid.h) continue;
    const Vec2 w = frame.sign * frame.local(s.w), t = net(k);
    const std::ptrdiff_t ahead = std::clamp<std::ptrdiff_t>(k + (at_back ? 1 : -1), 0, n - 1),
                         behind = std::clamp<std::ptrdiff_t>(k + (at_back ? -1 : 1), 0, n - 1);
    const double span =
        std::abs(points[static_cast<std::size_t>(ahead)].arc - points[static_cast<std::size_t>(behind)].arc);
    const Vec2 dt_ds = span > 0.0 ? Vec2{(net(ahead) - net(behind)) / span} : Vec2{Vec2::Zero()};
    const double near = from_tip - 0.5 * s.A, far = from_tip + 0.5 * s.A;
    const double root =
        4.0 / rock.E_prime * 2.0 * (std::sqrt(far) - std::sqrt(std::max(near, 0.0))) / std::sqrt(2.0 * pi);
    const Vec2 forward = frame.local(at_back ? Vec2{s.n.y(), -s.n.x()} : Vec2{-s.n.y(), s.n.x()});
    for (std::size_t j = 0; j < rings.size(); ++j) {
      const int i_s = grid.column_at(s.x.x()), j_s = grid.row_at(s.x.y());
      const Weight weight = weight_at(grid, frame, nodal_weights(grid, frame.tip, rings[j], i_s, j_s), i_s, j_s, s.x);
      const double q = weight.q, dq_ds = weight.grad.dot(forward);
      sums[j].J += s.A * (w.dot(t) * dq_ds + q * w.dot(dt_ds));
      sums[j].I[0] += t.y() * q * root;
      sums[j].I[1] += t.x() * q * root;
    }
  }
}

// The farthest a ring may reach from the tip, and whether an interface limits it.
double ring_radius(const Scene& scene, const State& state, const Tip& tip, const Vec2& at, bool& near_interface) {
  const double h = state.grid.h;
  double radius = scene.numerics.ring_cells * h;
  const auto keep_off = [&](double distance) {
    radius = std::min(radius, distance - h);
  };  // a node's function reaches on
  const Stretch along_x = scene.domain.along_x(), along_y = scene.domain.along_y();
  keep_off(at.x() - along_x.from), keep_off(along_x.to - at.x());
  keep_off(at.y() - along_y.from), keep_off(along_y.to - at.y());
  for (const Tip& other : state.tips) {
    if (other.at_back != tip.at_back) keep_off(0.5 * state.fracture().length());
  }
  near_interface = false;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    const InterfacePlace& place = scene.strata.interfaces[k];
    const bool nothing_there = scene.laws[place.law].kind == InterfaceLaw::Kind::perfect &&
                               scene.strata.layers[k].rock == scene.strata.layers[k + 1].rock;
    if (nothing_there) continue;
    const double distance = std::abs((scene.strata.along == Strata::Along::y ? at.y() : at.x()) - place.at_m);
    near_interface = near_interface || distance < (trusted_cells - 1e-3) * h;
    keep_off(distance);
  }
  // Too near to an edge, the symmetry line or the other tip: the ring reaches over it, so K is flagged as well.
  near_interface = near_interface || radius < narrowest_ring_cells * h;
  return std::max(radius, narrowest_ring_cells * h);
}

// The share of the maximum-hoop kink that one increment turns by. A kink over less than about three cells is not
// resolved: particles beside it keep their sides, and K_II is read off a fracture that has hardly turned. K_II/K_I
// answers a turn with about 0.9 of it, and the kink is twice K_II/K_I: a path that takes the whole of it overshoots by
// 0.8 and comes to rest slowly; where the new point is dry it zigzags ever more. About half of the kink ends with K_II
// = 0 at once. The path of local symmetry does not depend on the share (Cotterell & Rice 1980); the length in which it
// is reached does.
double turn_taken(const Scene& scene) {
  constexpr double resolved_cells = 3.0;
  return std::min(scene.fracture->turn_share, scene.fracture->increment_m / (resolved_cells * scene.numerics.cell_m));
}

// Direction from the place a distance `back` (m) behind the tip to the tip. K is a property of the fracture as the
// rings see it: measured in the frame of the last increment alone, a kink of the size of a ring's inner part comes back
// twice too large with the opposite sign, and a path that follows it zigzags ever more.
Vec2 mean_direction(const Surface& fracture, bool at_back, double back) {
  const auto& v = fracture.vertices;
  const Vec2 tip = at_back ? v.back().x : v.front().x;
  const double arc = std::clamp(at_back ? fracture.length() - back : back, 0.0, fracture.length());
  const auto after =
      std::find_if(v.begin() + 1, v.end() - 1, [arc](const SurfacePoint& vertex) { return vertex.arc >= arc; });
  const SurfacePoint &a = *(after - 1), &b = *after;
  const Vec2 from = a.x + (b.x - a.x) * ((arc - a.arc) / (b.arc - a.arc));
  return (tip - from).normalized();
}

void finish_tip(const Scene& scene, const Elasticity& rock, const State& state, const RingSums& sums, Tip& tip) {
  double mean = 0.0, K_I = 0.0, K_II = 0.0, least = sums[0].J, most = sums[0].J;
  for (const Sums& sum : sums) {
    mean += sum.J / static_cast<double>(sums.size());
    K_I += 0.5 * rock.E_prime * sum.I[0] / static_cast<double>(sums.size());
    K_II += 0.5 * rock.E_prime * sum.I[1] / static_cast<double>(sums.size());
    least = std::min(least, sum.J), most = std::max(most, sum.J);
  }
  if (!std::isfinite(mean) || !std::isfinite(K_I) || !std::isfinite(K_II)) {
    throw NumericalFailure(
        "step " + std::to_string(state.step) +
        ": J or K is not finite at a tip; the motion has become unstable. Lower numerics.courant (now " +
        std::to_string(scene.numerics.courant) + ")");
  }
  tip.J = mean;
  tip.J_spread = mean != 0.0 ? (most - least) / std::abs(mean) : 0.0;
  const SurfacePoint& last = tip.at_back ? state.fracture().points.back() : state.fracture().points.front();
  const bool closed = last.reaction.dot(last.n) > 0.0;
  tip.K_I = closed ? 0.0 : K_I;
  tip.K_II = K_II;
  tip.kink = kink_angle(tip.K_I, tip.K_II);
}

}  // namespace

void measure_tips(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  if (!state.has_fracture) return;
  const Surface& fracture = state.fracture();
  for (Tip& tip : state.tips) {
    Frame frame;
    frame.tip = tip.at_back ? fracture.vertices.back().x : fracture.vertices.front().x;
    frame.sign = tip.at_back ? 1.0 : -1.0;
    tip.ring_m = ring_radius(scene, state, tip, frame.tip, tip.at_interface);
    frame.e_1 = mean_direction(fracture, tip.at_back, tip.ring_m);
    frame.e_2 = {-frame.e_1.y(), frame.e_1.x()};
    Rings rings;
    for (std::size_t k = 0; k < rings.size(); ++k)
      rings[k] = {inner_fraction * ring_fractions[k] * tip.ring_m, ring_fractions[k] * tip.ring_m};
    RingSums sums{};
    const Elasticity& rock = rocks[rock_at(scene, frame.tip + ahead_cells * state.grid.h * frame.e_1)];
    const double reach = tip.ring_m + 2.0 * state.grid.h;
    for (const Bin& bin : state.bins) {
      if (std::abs(state.grid.x(bin.i) - frame.tip.x()) > reach ||
          std::abs(state.grid.y(bin.j) - frame.tip.y()) > reach)
        continue;
      add_bin(scene, rocks, state, frame, rings, bin, sums);
    }
    add_faces(rock, state.grid, fracture, frame, tip.at_back, rings, sums);
    finish_tip(scene, rock, state, sums, tip);
    const Vec2 last = tip_direction(fracture, tip.at_back);
    const double lag = std::atan2(cross(last, frame.e_1), last.dot(frame.e_1));
    tip.turn = lag + turn_taken(scene) * tip.kink;
    tip.kink += lag;
  }
}

double kink_angle(double K_I, double K_II) {
  if (K_II == 0.0) return 0.0;
  return 2.0 * std::atan((K_I - std::sqrt(K_I * K_I + 8.0 * K_II * K_II)) / (4.0 * K_II));
}

}  // namespace strata
