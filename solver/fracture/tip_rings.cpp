#include "fracture/tip_rings.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <string>

#include "fracture/criterion.hpp"
#include "fracture/j_integral.hpp"
#include "state/shape_functions.hpp"

namespace strata {
namespace {

constexpr double pi = std::numbers::pi;

constexpr double least_cells = 2.0;     // nearer than this K is no number, nor is J
constexpr double inner_fraction = 0.6;  // q is 1 inside this fraction of a ring's radius: 0.3 costs 1 % in J

// How far a ring may reach from a tip (m), and the nearest thing that is too near.
struct Room {
  double h;
  double radius;
  double nearest = HUGE_VAL;
  Obstacle near = Obstacle::none;

  // Keeps the ring off what is so far from the tip (m), and notes it.
  void keep_off(double distance) { radius = std::min(radius, distance - h); }
  void keep_off(double distance, Obstacle what) {
    keep_off(distance);
    note(distance, what, trusted_cells);
  }
  // Notes what is nearer than so many cells.
  void note(double distance, Obstacle what, double cells) {
    constexpr double round_off = 1e-3;  // of a cell: a tip that stands so many cells off is clear
    if (distance >= std::min(nearest, (cells - round_off) * h)) return;
    nearest = distance, near = what;
  }
};

void keep_off_edges(const Scene& scene, const Vec2& at, Room& room) {
  const Stretch along_x = scene.domain.along_x(), along_y = scene.domain.along_y();
  const Obstacle below = scene.domain.bottom == Edge::symmetry ? Obstacle::symmetry_line : Obstacle::edge;
  room.keep_off(at.x() - along_x.from, Obstacle::edge);
  room.keep_off(along_x.to - at.x(), Obstacle::edge);
  room.keep_off(at.y() - along_y.from, below);
  room.keep_off(along_y.to - at.y(), Obstacle::edge);
}

// The other tip, and where the path comes back to the tip: farther along it than any that only bends on its way.
void keep_off_fracture(const State& state, const Tip& tip, const Vec2& at, Room& room) {
  const Surface& fracture = state.fracture();
  if (state.tips.size() > 1) room.keep_off(0.5 * fracture.length(), Obstacle::fracture);
  for (const SurfacePoint& s : fracture.points) {
    const double along = tip.at_back ? fracture.length() - s.arc : s.arc, distance = (s.x - at).norm();
    if (along < 2.0 * distance || along < 2.0 * trusted_cells * room.h) continue;
    room.keep_off(distance, Obstacle::fracture);
  }
}

// An interface between like rocks disturbs nothing as long as it is bonded; rings keep off it all the same, since it
// may fail at any time. One whose faces are apart is met where they are.
void keep_off_interfaces(const Scene& scene, const State& state, const Vec2& at, Room& room) {
  for (const Surface& surface : state.surfaces) {
    const double distance = std::abs(scene.stacking(at - surface.vertices.front().x));
    if (surface.kind != Surface::Kind::interface || distance > trusted_cells_at_interface * room.h) continue;
    for (const SurfacePoint& s : surface.points) {
      const double off = (s.x - at).norm() - 0.5 * s.A;
      if (s.split) room.note(std::max(distance, off), Obstacle::interface, trusted_cells_at_interface);
    }
  }
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    const InterfacePlace& place = scene.strata.interfaces[k];
    if (!scene.changes_at(k, scene.beside(at))) continue;
    const double distance = std::abs(scene.stacking(at) - place.at_m);
    room.keep_off(distance);
    if (scene.stiffness_changes_at(k)) room.note(distance, Obstacle::rock_border, trusted_cells_at_interface);
  }
}

Room ring_room(const Scene& scene, const State& state, const Tip& tip, const Vec2& at) {
  const double h = state.grid.h;
  Room room{h, scene.numerics.ring_cells * h};
  keep_off_interfaces(scene, state, at, room);  // the first that is noted stands for all as near as it
  keep_off_fracture(state, tip, at, room);
  keep_off_edges(scene, at, room);
  return room;
}

// The share of the maximum-hoop kink that a growth by `length` (m) turns by. A kink over less than about three cells is
// not resolved: K_II is then read off a fracture that has hardly turned. K_II/K_I answers a turn with about 0.9 of it,
// and the kink is twice K_II/K_I: a path that takes the whole of it overshoots, and about half ends with K_II = 0 at
// once. The path of local symmetry does not depend on the share (Cotterell & Rice 1980), only the length to reach it.
double turn_taken(const Scene& scene, double length) {
  constexpr double resolved_cells = 3.0;
  return std::min(scene.fracture->turn_share, length / (resolved_cells * scene.numerics.cell_m));
}

// Direction from the place a distance `back` (m) behind the tip to the tip: K is a property of the fracture as the
// rings see it. In the frame of the last increment alone a kink comes back twice too large, and the path zigzags ever
// more.
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

}  // namespace

double Ring::at_node(double r) const {
  if (r <= inner) return 1.0;
  if (r >= outer) return 0.0;
  return 0.5 + 0.5 * std::cos(pi * (r - inner) / (outer - inner));
}

TipGeometry tip_geometry(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip) {
  const Surface& fracture = state.fracture();
  TipGeometry at;
  at.frame.tip = tip_position(state, tip);
  at.frame.sign = tip.at_back ? 1.0 : -1.0;
  const Room room = ring_room(scene, state, tip, at.frame.tip);
  const double radius = std::max(room.radius, narrowest_ring_cells * state.grid.h);
  at.near = room.near;
  at.crossed = room.nearest < (least_cells - 1e-3) * state.grid.h;
  at.no_length = past_open_interface(scene, state, tip) == 0.0;
  at.frame.e_1 = mean_direction(fracture, tip.at_back, radius);
  at.frame.e_2 = {-at.frame.e_1.y(), at.frame.e_1.x()};
  for (std::size_t k = 0; k < at.rings.size(); ++k)
    at.rings[k] = {inner_fraction * ring_fractions[k] * radius, ring_fractions[k] * radius};
  at.rock = rocks[rock_at(scene, at.frame.tip + ahead_cells * state.grid.h * at.frame.e_1)];
  const Vec2 last = tip_direction(fracture, tip.at_back);
  at.lag = std::atan2(cross(last, at.frame.e_1), last.dot(at.frame.e_1));
  return at;
}

std::optional<RingNodes> ring_nodes(const Grid& g, const TipGeometry& at, int i, int j) {
  const Vec2& tip = at.frame.tip;
  const double reach = at.rings.back().outer;
  if (g.x(i + 1) < tip.x() - reach || g.x(i - 1) > tip.x() + reach || g.y(j + 1) < tip.y() - reach ||
      g.y(j - 1) > tip.y() + reach)
    return std::nullopt;
  RingNodes q{};
  for (std::size_t n = 0; n < 9; ++n) {
    const Vec2 x{g.x(i + static_cast<int>(n % 3) - 1), g.y(j + static_cast<int>(n / 3) - 1)};
    for (std::size_t k = 0; k < q.size(); ++k) q[k][n] = at.rings[k].at_node((x - tip).norm());
  }
  return q;
}

RingWeights ring_weights(const Grid& g, const RingNodes& nodes, int i, int j, const Vec2& x) {
  const Gradients w = gradients_of<QuadraticBspline>(g, i, j, x, Vec2::Zero());
  RingWeights out;
  for (std::size_t k = 0; k < out.size(); ++k) {
    for (std::size_t n = 0; n < 9; ++n) {
      out[k].q += w.N[n] * nodes[k][n];
      out[k].grad += nodes[k][n] * Vec2{w.N_x[n], w.N_y[n]};
    }
  }
  return out;
}

double angle_at(const Vec2& local, bool above) {
  const double theta = std::atan2(local.y(), local.x());
  if (local.x() < 0.0 && above && theta < 0.0) return theta + 2.0 * pi;
  if (local.x() < 0.0 && !above && theta > 0.0) return theta - 2.0 * pi;
  return theta;
}

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

namespace {

// Faces that touch at the tip have no K_I; what drives such a tip is their sliding alone, J = K_II^2/E'. A K_I below
// zero says the same.
void close_where_faces_touch(const Scene& scene, const State& state, const TipGeometry& at, Tip& tip) {
  constexpr double slides = 1e-6;  // of the largest jump: above the round-off of a symmetric block
  const auto& points = state.fracture().points;
  const SurfacePoint& last = tip.at_back ? points.back() : points.front();
  const bool overlap = scene.fracture->faces == Fracture::Faces::contact && !tip.crossed;
  tip.closed = last.reaction.dot(last.n) > 0.0 || (overlap && tip.K_I <= 0.0);
  if (!tip.closed) return;
  double largest = 0.0;
  for (const SurfacePoint& s : points) largest = std::max(largest, s.w.norm());
  tip.K_I = 0.0;
  if (std::abs(last.w.dot(tangent_of(last.n))) <= slides * largest) tip.K_II = 0.0;
  tip.J = tip.K_II * tip.K_II / at.rock.E_prime;
  tip.J_spread = 0.0;
}

}  // namespace

void finish_tip(const Scene& scene, const TipGeometry& at, const State& state, const TipSums& sums, Tip& tip) {
  const auto [least, most] = std::minmax_element(sums.J.begin(), sums.J.end());
  const double mean = std::accumulate(sums.J.begin(), sums.J.end(), 0.0) / static_cast<double>(sums.J.size());
  const double K_I = 0.5 * at.rock.E_prime * sums.I[0], K_II = 0.5 * at.rock.E_prime * sums.I[1];
  if (!std::isfinite(mean) || !std::isfinite(K_I) || !std::isfinite(K_II)) {
    throw NumericalFailure(
        "step " + std::to_string(state.step) +
        ": J or K is not finite at a tip; the motion has become unstable. Lower numerics.courant (now " +
        std::to_string(scene.numerics.courant) + ")");
  }
  tip.J = mean;
  tip.J_spread = mean != 0.0 ? (*most - *least) / std::abs(mean) : 0.0;
  tip.K_I = K_I, tip.K_II = K_II;
  tip.near = at.near, tip.crossed = at.crossed, tip.no_length = at.no_length;
  close_where_faces_touch(scene, state, at, tip);
  tip.kink = kink_angle(tip.K_I, tip.K_II);
  tip.turn = at.lag + turn_taken(scene, scene.fracture->increment_m) * tip.kink;
  tip.kink += at.lag;
  tip.ring_m = at.rings.back().outer;
}

double turn_over(const Scene& scene, const Tip& tip, double times) {
  if (times == 1.0) return tip.turn;
  const double da = scene.fracture->increment_m, one = turn_taken(scene, da);
  return tip.kink - (tip.kink - tip.turn) * (1.0 - turn_taken(scene, times * da)) / (1.0 - one);
}

}  // namespace strata
