#include "fracture/growth.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <span>

#include "fracture/criterion.hpp"
#include "fracture/tip_rings.hpp"
#include "scene/derived.hpp"
#include "state/rebuild.hpp"

namespace strata {
namespace {

constexpr double edge_cells = 3.0;      // a tip nearer than this to an edge has no ring left to measure J in
constexpr double sliver_cells = 1.5;    // rock that an increment leaves before an edge: thinner, it moves freely
constexpr double arrest_rise_Pa = 5e4;  // the inlet's rise over which a tip that stays counts as arrested
constexpr double sliver = 0.25;         // no growth step is shorter than this fraction of an increment

// Length of the next `times` increments of da from `tip` along `direction`: they end on the first interface that they
// would cross or nearly reach. One whose faces are apart ends any that does not begin on it: beyond it another rock is
// to be broken.
double increment_to_interface(const Scene& scene, const State& state, const Vec2& tip, const Vec2& direction, double da,
                              double times) {
  double length = (times + sliver) * da;
  bool meets = false;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    const Layer &before = scene.strata.layers[k], &beyond = scene.strata.layers[k + 1];
    const double rate = scene.stacking(direction);
    const double distance = scene.strata.interfaces[k].at_m - scene.stacking(tip);
    if (std::abs(rate) < 1e-6) continue;
    const double to_it = distance / rate;
    const Vec2 met = tip + to_it * direction;
    const bool changes = scene.changes_at(k, scene.beside(met));
    if (!changes && before.rock == beyond.rock && before.has_stress_of(beyond)) continue;
    if (to_it <= 0.0 || to_it >= length) continue;
    const bool apart = apart_at(scene, state, k, met);
    if (to_it <= (apart ? ahead_cells * state.grid.h : sliver * da)) continue;
    length = to_it;
    meets = true;
  }
  return meets ? length : times * da;
}

// True where a tip at x is nearer than `keep` m to an edge that it heads for.
bool near_edge(const Scene& scene, const Vec2& x, const Vec2& direction, double keep) {
  const auto near = [keep](const Stretch& block, double at, double way) {
    return (at < block.from + keep && way < 0.0) || (at > block.to - keep && way > 0.0);
  };
  return near(scene.domain.along_x(), x.x(), direction.x()) || near(scene.domain.along_y(), x.y(), direction.y());
}

bool ready(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip) {
  const Elasticity& ahead = rocks[rock_ahead(scene, state, tip)];
  const double G = driving(ahead, tip);
  const bool may = scene.fracture->growth != Fracture::Growth::none && tip.growing && state.time >= tip.due_s;
  return may && G > 0.0 && G >= ahead.J_c;
}

// How many increments a tip that is ready makes, and when the next one is due. One whose next increment has become due
// in this step, since it was moved in the last, goes on from when that was, so that its speed does not depend on the
// step; any other one begins now.
double increments_due(const Scene& scene, const Elasticity& ahead, const State& state, Tip& tip) {
  constexpr double slack = 1e-9;  // of a step: times are sums of them
  const double wait = increment_of(scene, tip) / ahead.c_R;
  const bool goes_on = tip.has_grown && state.time - tip.due_s < (1.0 + slack) * state.dt;
  const double since = goes_on ? tip.due_s : state.time;
  const double due = 1.0 + std::floor((state.time - since) / wait);
  const double times = tip.criterion == Criterion::energy ? 1.0 : due;  // the next one is weighed anew
  tip.due_s = since + times * wait;
  tip.runs_until_s = tip.due_s + tip.ring_m / ahead.c_R;
  return times;
}

void record(State& state, const char* kind, const Tip& tip, double time, double pressure, bool doubtful,
            const char* by) {
  const Vec2 at = tip_position(state, tip);
  state.events.push_back({kind, time, pressure, at.x(), at.y(), doubtful, by, tip_name(state, tip)});
}

// The new vertices' pressure: nothing, or what the tip had. The front end is counted from the inlet's side.
void lengthen_fluid(const Scene& scene, State& state, bool at_back, std::size_t pieces) {
  std::vector<double>& P = state.fluid.P;
  const double tip_P = at_back ? P.back() : P.front();
  double fill = scene.fluid.new_point == Fluid::NewPoint::dry ? 0.0 : tip_P;
  if (scene.fluid.law == Fluid::Law::uniform) fill = state.fluid.inlet_Pa;
  P.insert(at_back ? P.end() : P.begin(), pieces, fill);
  if (!at_back) state.fluid.inlet += pieces;
}

// Whether growth leaves the side of a place alone whatever is nearest to it: `off` the old tip it lies behind the new
// pieces, beside the older fracture or on the outside of the kink, or beside them and what extends them straight on,
// where it is on the side that it is said to be on. Slack (m): what is nearer to a limit is not told.
bool keeps_side(const Vec2& off, const Vec2& direction, bool on_left, double slack) {
  const double ahead = off.dot(direction), left = cross(direction, off);
  return ahead < -slack || (ahead > slack && (on_left ? left > slack : left < -slack));
}

// Particles ahead of the old tip (`from`) may change sides as the path turns; those beside the older fracture keep
// theirs.
void update_particle_sides(State& state, const Tip& tip, const Vec2& from, double old_length) {
  const Surface& fracture = state.fracture();
  const Vec2 at = tip_position(state, tip), direction = tip_direction(fracture, tip.at_back);
  const double near = extension(state.grid) + fracture.length() - old_length, slack = 1e-6 * state.grid.h;
  Particles& p = state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 x{p.x[q], p.y[q]};
    if (keeps_side(x - from, direction, tip.at_back == ((p.sides[q] & fracture.mask()) != 0), slack)) continue;
    if ((x - at).norm() > 2.0 * near) continue;
    const Projection on = project(fracture, x, extension(state.grid));
    const bool ahead = tip.at_back ? on.arc >= old_length - 1e-9 : on.arc <= fracture.length() - old_length + 1e-9;
    if (!ahead) continue;
    p.sides[q] = on.distance >= 0.0 ? p.sides[q] | fracture.mask() : p.sides[q] & ~fracture.mask();
  }
}

bool on_grid_line_or_mid_cell(double x, double h) {
  const double halves = 2.0 * x / h;
  return std::abs(halves - std::round(halves)) < 0.04;  // 0.02 cells, as for nodes: surfaces follow the rock
}

bool off_grid(const SurfacePoint& s, double h) {
  if (std::abs(s.n.x()) > 1.0 - 1e-6) return !on_grid_line_or_mid_cell(s.x.x(), h);
  if (std::abs(s.n.y()) > 1.0 - 1e-6) return !on_grid_line_or_mid_cell(s.x.y(), h);
  return true;
}

// Mean of what the particles around a place say of it, of those that count and are nearer than `reach` (m): by their
// areas and hat functions of their distance.
template <class Value, class Counts, class Of>
Value mean_around(const Particles& p, const Vec2& x, const Vec2& reach, Value sum, Counts counts, Of of) {
  double weights = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const double near_x = 1.0 - std::abs(p.x[q] - x.x()) / reach.x(),
                 near_y = 1.0 - std::abs(p.y[q] - x.y()) / reach.y();
    if (near_x <= 0.0 || near_y <= 0.0 || !counts(q)) continue;
    const double weight = near_x * near_y * p.V[q];
    sum = sum + weight * of(q);
    weights += weight;
  }
  return (1.0 / weights) * sum;
}

// In-situ stress at a place: that of the particles of its rock and layer around it, which is exact where it is uniform.
Stress in_situ_at(const Scene& scene, const State& state, const Vec2& x) {
  if (scene.in_situ.initialise == InSitu::Initialise::uniform) return prescribed_stress(scene, {x})[0];
  const Particles& p = state.particles;
  const Grid& g = state.grid;
  const Vec2 spans{g.span_x(std::clamp(g.column_at(x.x()), 0, g.nx)), g.span_y(std::clamp(g.row_at(x.y()), 0, g.ny))};
  const auto& layers = scene.strata.layers;
  const auto layer_of = [&](double at_x, double at_y) -> const Layer& { return layers[layer_at(scene, {at_x, at_y})]; };
  const Layer& own = layer_of(x.x(), x.y());
  return mean_around(
      p, x, spans, Stress{},
      [&](std::size_t q) { return p.rock[q] == own.rock && layer_of(p.x[q], p.y[q]).has_stress_of(own); },
      [&](std::size_t q) { return p.in_situ[q]; });
}

// New vertices and points have moved with the rock that they now part.
void displace_new(State& state, bool at_back, std::size_t pieces) {
  const Particles& p = state.particles;
  for (auto* places : {&state.fracture().vertices, &state.fracture().points}) {
    const std::size_t first = at_back ? places->size() - pieces : 0;
    for (SurfacePoint& s : std::span(*places).subspan(first, pieces)) {
      const auto continued = [&](std::size_t q) -> Vec2 {
        const Vec2 d = s.x - Vec2{p.x[q], p.y[q]};
        return {p.u_x[q] + p.g_xx[q] * d.x() + p.g_xy[q] * d.y(), p.u_y[q] + p.g_yx[q] * d.x() + p.g_yy[q] * d.y()};
      };
      s.u = mean_around(
          p, s.x, Vec2::Constant(state.grid.h), Vec2{Vec2::Zero()}, [](std::size_t) { return true; }, continued);
    }
  }
}

// Fine particles that a piece of the fracture and what is straight ahead of it pass through (4 h) and that stay whole:
// a line of 4 x 4 points a cell has 5 at a slope of 1:2 and more along the grid and its diagonals.
constexpr int now_and_then = 2;

// Whether a particle stands within `reach` (m) of a point of the fracture, across it and beside its piece.
bool near_point(const Particles& p, std::size_t q, const SurfacePoint& s, double reach) {
  const Vec2 off = Vec2{p.x[q], p.y[q]} - s.x;
  return std::abs(off.dot(s.n)) < reach && std::abs(off.dot(tangent_of(s.n))) - 0.5 * s.A < reach;
}

bool passes_through(const Particles& p, std::size_t q, const SurfacePoint& s, double h) {
  const Vec2 off = Vec2{p.x[q], p.y[q]} - s.x;
  return std::abs(off.dot(s.n)) < 1e-3 * h && std::abs(off.dot(tangent_of(s.n))) - 0.5 * s.A <= 1.5 * h;
}

// Divides particle q into its quarters, which continue its displacement linearly. The lower left one keeps its place in
// the arrays and its id; the upper right, upper left and lower right ones follow at the arrays' end with new ids.
void split_in_four(Particles& p, std::size_t q) {
  p.m[q] *= 0.25, p.V[q] *= 0.25, p.half_x[q] *= 0.5, p.half_y[q] *= 0.5;
  const Vec2 quarter = p.half(q);
  const double x = p.x[q], y = p.y[q], u_x = p.u_x[q], u_y = p.u_y[q];
  for (int child = 3; child >= 0; --child) {
    std::size_t c = q;
    if (child > 0) {
      for_each_array(p, [q](auto& array) { array.push_back(array[q]); });
      c = p.size() - 1;
      p.id[c] = p.next_id++;
    }
    const double d_x = (child & 1) != 0 ? quarter.x() : -quarter.x(),
                 d_y = (child & 2) != 0 ? quarter.y() : -quarter.y();
    p.x[c] = x + d_x, p.y[c] = y + d_y;
    p.u_x[c] = u_x + p.g_xx[q] * d_x + p.g_xy[q] * d_y;
    p.u_y[c] = u_y + p.g_yx[q] * d_x + p.g_yy[q] * d_y;
  }
}

}  // namespace

void refine_particles(const Scene& scene, State& state, std::size_t first, std::size_t last) {
  const double h = state.grid.h, sixteenth = 1.01 * h * h / 16.0;
  Particles& p = state.particles;
  const std::size_t n = p.size();
  std::vector<std::size_t> split;
  std::vector<char> whole(last - first, 0);  // of points: whether they leave fine particles as they are
  for (std::size_t k = first; k < last && scene.numerics.mechanics == Numerics::Mechanics::quasistatic; ++k) {
    int hit = 0;
    for (std::size_t q = 0; q < n; ++q)
      hit += p.V[q] <= sixteenth && passes_through(p, q, state.fracture().points[k], h) ? 1 : 0;
    whole[k - first] = hit <= now_and_then ? 1 : 0;
  }
  for (std::size_t q = 0; q < n; ++q) {
    const bool fine = p.V[q] <= sixteenth;
    for (std::size_t k = first; k < last; ++k) {
      const SurfacePoint& s = state.fracture().points[k];
      const bool hit = passes_through(p, q, s, h) && !(fine && whole[k - first] != 0);
      if (!hit && (fine || !near_point(p, q, s, 1.5 * h) || !off_grid(s, h))) continue;
      split_in_four(p, q);
      split.insert(split.end(), {q, p.size() - 3, p.size() - 2, p.size() - 1});
      break;
    }
  }
  // A child may lie on the other side than its parent's middle, beside the new points; beside older ones sides stay.
  const Surface& fracture = state.fracture();
  const double from = fracture.vertices[first].arc, to = fracture.vertices[last].arc;
  for (const std::size_t q : split) {
    const Projection on = project(fracture, {p.x[q], p.y[q]}, extension(state.grid));
    if ((first > 0 && on.arc < from) || (last < fracture.points.size() && on.arc > to)) continue;
    p.sides[q] = on.distance >= 0.0 ? p.sides[q] | fracture.mask() : p.sides[q] & ~fracture.mask();
  }
}

void place_points(const Scene& scene, State& state, Surface& surface) {
  for (SurfacePoint& s : surface.points) {
    s.sides = sides_at(state, s.x, surface.bit);
    const bool fracture = surface.kind == Surface::Kind::fracture;
    if (fracture) s.split = true;
    if (!fracture && scene.laws[surface.law].takes_all_compression()) continue;
    if (fracture || scene.in_situ.initialise == InSitu::Initialise::uniform)
      s.in_situ = -in_situ_at(scene, state, s.x).on(s.n);
  }
  for (SurfacePoint& vertex : surface.vertices) vertex.sides = sides_at(state, vertex.x, surface.bit);
}

double extend_tip(const Scene& scene, State& state, Tip& tip, double increment, double times) {
  Surface& fracture = state.fracture();
  const Vec2 from = tip_position(state, tip);
  Vec2 direction = tip_direction(fracture, tip.at_back);
  if (scene.fracture->direction == Fracture::Direction::max_hoop) {
    const double turn = turn_over(scene, tip, times);
    direction = Vec2{std::cos(turn) * direction.x() - std::sin(turn) * direction.y(),
                     std::sin(turn) * direction.x() + std::cos(turn) * direction.y()};
  }
  const double old_length = fracture.length();
  const std::size_t old_points = fracture.points.size();
  const double length = increment_to_interface(scene, state, from, direction, increment, times);
  const Vec2 to = from + length * direction;
  for (const Point& end : legs_between_interfaces(scene, {from.x(), from.y()}, {to.x(), to.y()}))
    extend(fracture, tip.at_back, {end[0], end[1]}, surface_spacing(state.grid));
  const std::size_t pieces = fracture.points.size() - old_points;
  lengthen_fluid(scene, state, tip.at_back, pieces);
  if (scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics && scene.numerics.keeps_places())
    displace_new(state, tip.at_back, pieces);
  const std::size_t first = tip.at_back ? old_points : 0;
  update_particle_sides(state, tip, from, old_length);
  refine_particles(scene, state, first, first + pieces);
  for (Surface& surface : state.surfaces) place_points(scene, state, surface);
  return length;
}

std::size_t rock_ahead(const Scene& scene, const State& state, const Tip& tip) {
  return rock_at(scene, place_ahead(state, tip));
}

std::string what_stops(const Scene& scene, const State& state, const Tip& tip) {
  const Vec2 at = tip_position(state, tip);
  const double h = state.grid.h;
  const Vec2 direction = tip_direction(state.fracture(), tip.at_back);
  if (tip.has_grown && near_edge(scene, at, direction, edge_cells * h)) return "within 3 cells of an edge of the block";
  if (tip.has_grown && near_edge(scene, at, direction, scene.fracture->increment_m + sliver_cells * h))
    return fmt::format("an increment more would end within {} cells of an edge of the block", sliver_cells);
  const double fine_cells = scene.numerics.ring_cells + 1.0;  // its rings, and what functions there reach
  if (!state.grid.fine_around(at.x(), at.y(), fine_cells * h))
    return fmt::format("within {} cells of coarser ones; {}", fine_cells,
                       scene.numerics.far_cell_m
                           ? "move numerics.fine_left_m, fine_right_m, fine_bottom_m or fine_top_m, or leave out "
                             "far_cell_m"
                           : "they begin where the block ends: make domain.width_m or height_m larger");
  return "";
}

bool stop_at_edge(const Scene& scene, const State& state, Tip& tip) {
  if (!tip.growing) return false;
  tip.stopped_by = what_stops(scene, state, tip);
  tip.growing = tip.stopped_by.empty();
  return !tip.growing;
}

double shorten_tip(State& state, Tip& tip, double length) {
  Surface& fracture = state.fracture();
  constexpr double round_off = 1e-9;
  std::size_t pieces = 0;
  double gone = 0.0;
  const auto piece = [&](std::size_t k) {
    return tip.at_back ? fracture.points[fracture.points.size() - 1 - k].A : fracture.points[k].A;
  };
  while (pieces + 1 < fracture.points.size() && gone + piece(pieces) <= length * (1.0 + round_off))
    gone += piece(pieces++);
  const auto shorten = [&](auto& list) {
    const auto n = static_cast<std::ptrdiff_t>(pieces);
    list.erase(tip.at_back ? list.end() - n : list.begin(), tip.at_back ? list.end() : list.begin() + n);
  };
  shorten(fracture.points), shorten(fracture.vertices), shorten(state.fluid.P);
  if (!tip.at_back) state.fluid.inlet -= std::min(pieces, state.fluid.inlet);
  update_geometry(fracture);
  return gone;
}

void note_growth(State& state, Tip& tip) {
  tip.grew_by = name_of(tip.criterion);
  const char* by = tip.grew_by.c_str();
  if (!tip.has_grown) record(state, "start", tip, state.time, state.fluid.inlet_Pa, doubtful(tip), by);
  if (tip.arrested) record(state, "restart", tip, state.time, state.fluid.inlet_Pa, doubtful(tip), by);
  tip.has_grown = true;
  tip.arrested = false;
  tip.last_growth_s = state.time;
  tip.last_growth_Pa = state.fluid.inlet_Pa;
  Monitors& monitors = state.monitors;
  note_largest(monitors.largest_flow_fall, monitors.flow_fall);
  monitors.floor_share_sum += monitors.floor_share[tip.at_back ? 1 : 0];
  monitors.viscous_at_growth = monitors.viscous_tip[tip.at_back ? 1 : 0];
  if (tip.near != Obstacle::none) {
    ++monitors.growths_apart;
  } else {
    ++monitors.growths;
    monitors.J_spread_sum += tip.J_spread;
    note_largest(monitors.largest_J_spread, tip.J_spread);
  }
}

bool runs(const Tip& tip, double time) {
  return tip.growing && time >= tip.due_s && time <= tip.runs_until_s;
}

bool ready_to_grow(const Scene& scene, const Rocks& rocks, const State& state) {
  return std::ranges::any_of(state.tips, [&](const Tip& tip) { return ready(scene, rocks, state, tip); });
}

bool grow(const Scene& scene, const Rocks& rocks, State& state) {
  bool moved = false;
  for (Tip& tip : state.tips) {
    if (!ready(scene, rocks, state, tip) || stop_at_edge(scene, state, tip)) continue;
    const Elasticity& ahead = rocks[rock_ahead(scene, state, tip)];
    const double times = increments_due(scene, ahead, state, tip);
    note_growth(state, tip);
    const double surface = ahead.J_c * extend_tip(scene, state, tip, increment_of(scene, tip), times);
    state.ledger.fracture += surface, state.ledger.excess -= surface;  // the motion gives none of it
    tip.G = tip.G_trial;
    tip.G_trial = 0.0;
    moved = true;
  }
  return moved;
}

void watch_tips(const Scene& scene, State& state) {
  for (Tip& tip : state.tips) {
    for (int k = 0; const InterfacePlace& interface : scene.strata.interfaces) {
      const double distance = std::abs(scene.stacking(tip_position(state, tip)) - interface.at_m);
      const int id = k++;
      if (distance > 0.5 * state.grid.h || std::ranges::count(tip.reached, id) > 0) continue;
      tip.reached.push_back(id);
      record(state, "reach_interface", tip, state.time, state.fluid.inlet_Pa, at_interface(tip), "");
    }
    if (tip.has_grown && !tip.arrested && tip.growing && state.fluid.inlet_Pa - tip.last_growth_Pa >= arrest_rise_Pa) {
      tip.arrested = true;
      record(state, "arrest", tip, tip.last_growth_s, tip.last_growth_Pa, doubtful(tip), tip.grew_by.c_str());
    }
  }
}

}  // namespace strata
