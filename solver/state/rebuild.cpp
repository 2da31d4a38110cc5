#include "state/rebuild.hpp"

#include <algorithm>
#include <cmath>
#include <compare>
#include <map>
#include <numeric>
#include <tuple>
#include <type_traits>
#include <utility>

#include "state/blocks.hpp"
#include "state/light_copies.hpp"

namespace strata {
namespace {

// Surfaces follow the rock by fractions of a millimetre; places nearer than this to a threshold stand on it.
constexpr double slack_cells = 0.02;
// Rows of bins to a strip: two strips of one colour never share a record if this is at least 2.
constexpr int rows_per_strip = 4;

bool segment_meets_box(const Vec2& a, const Vec2& b, const Vec2& centre, double half) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double d = b[axis] - a[axis];
    double lo = (centre[axis] - half - a[axis]), hi = (centre[axis] + half - a[axis]);
    if (d == 0.0) {
      if (lo > 0.0 || hi < 0.0) return false;
      continue;
    }
    lo /= d, hi /= d;
    from = std::max(from, std::min(lo, hi));
    to = std::min(to, std::max(lo, hi));
  }
  return from < to;
}

// Calls visit(index of node, its place) for the nodes around which the segment from a to b meets a square of side
// 2 half, less than two cells.
template <class Visit>
void for_each_node_near(const Grid& g, const Vec2& a, const Vec2& b, double half, Visit visit) {
  const Vec2 low = a.cwiseMin(b), high = a.cwiseMax(b);
  const int i0 = std::max(-1, g.column_at(low.x()) - 2), i1 = std::min(g.nx + 1, g.column_at(high.x()) + 2);
  const int j0 = std::max(-1, g.row_at(low.y()) - 2), j1 = std::min(g.ny + 1, g.row_at(high.y()) + 2);
  for (int j = j0; j <= j1; ++j) {
    for (int i = i0; i <= i1; ++i) {
      const Vec2 x{g.x(i), g.y(j)};
      if (segment_meets_box(a, b, x, half)) visit(static_cast<std::size_t>(g.node(i, j)), x);
    }
  }
}

// How far from a surface nodes are split (m): a number of cells, since all cells beside a surface are of h across it.
double split_reach(const Scene& scene, const Grid& g) {
  return (support_in_cells(scene) - slack_cells) * g.h;
}

// The tip rule: the fracture splits a node within reach whose projection lies strictly behind the tip.
void mark_fracture(const Scene& scene, const State& state, std::vector<SideWord>& mask) {
  const Surface& s = state.fracture();
  const double reach = extension(state.grid), slack = slack_cells * state.grid.h;
  double from = -HUGE_VAL, to = HUGE_VAL;
  for (const Tip& tip : state.tips) (tip.at_back ? to : from) = tip.at_back ? s.length() - slack : slack;
  for (std::size_t k = 0; k + 1 < s.vertices.size(); ++k) {
    for_each_node_near(state.grid, s.vertices[k].x, s.vertices[k + 1].x, split_reach(scene, state.grid),
                       [&](std::size_t node, const Vec2& x) {
                         if ((mask[node] & s.mask()) != 0) return;
                         const double arc = project(s, x, reach).arc;
                         if (arc > from && arc < to) mask[node] |= s.mask();
                       });
  }
}

// An interface splits the nodes of a grid column (along y: row) whose points have split.
void mark_interface(const Scene& scene, const State& state, const Surface& s, std::vector<SideWord>& mask) {
  const Grid& g = state.grid;
  const bool along_x = scene.strata.upwards();  // layers stacked along y: the interface runs along x
  const int n = along_x ? g.nx : g.ny;
  std::vector<char> split(static_cast<std::size_t>(n) + 1, 0);
  for (const SurfacePoint& point : s.points) {
    if (point.split) split[static_cast<std::size_t>(point.column)] = 1;
  }
  const double half = split_reach(scene, g);
  const double at = along_x ? s.vertices[0].x.y() : s.vertices[0].x.x();
  const int middle = along_x ? g.row_at(at) : g.column_at(at);
  const int last = std::min(middle + 2, (along_x ? g.ny : g.nx) + 1);
  for (int across = std::max(middle - 2, -1); across <= last; ++across) {
    if (std::abs((along_x ? g.y(across) : g.x(across)) - at) > half) continue;
    for (int k = -1; k <= n + 1; ++k) {
      const int column = k < 0 ? 1 : (k > n ? n - 1 : k);  // a ghost as the node inside
      if (split[static_cast<std::size_t>(column)] == 0) continue;
      const int node = along_x ? g.node(k, across) : g.node(across, k);
      mask[static_cast<std::size_t>(node)] |= s.mask();
    }
  }
}

// The node inside that a ghost outside symmetric or fixed edges mirrors, any other node itself, and what the edges make
// of its displacement: -1 mirrored, 0 held.
Master mirror_of(const Scene& scene, const Grid& g, int node) {
  const auto mirrors = [](Edge edge) { return edge != Edge::traction; };
  const auto fold = [](bool low, bool high, int n, int& k) {
    const int at = k;
    if (low && k < 0) k = 1;
    if (high && k > n) k = n - 1;
    if ((low && k == 0) || (high && k == n)) return 0.0;
    return k == at ? 1.0 : -1.0;
  };
  int i = g.column(node), j = g.row(node);
  const bool sides = mirrors(scene.domain.sides);
  const double x = fold(sides, sides, g.nx, i);
  const double y = fold(mirrors(scene.domain.bottom), mirrors(scene.domain.top), g.ny, j);
  return {g.node(i, j), x, y};
}

// What splits each node, and which of them the fracture splits ahead of a tip: the number of that tip + 1.
struct NodeMasks {
  std::vector<SideWord> word;
  std::vector<char> ahead;
};

// The sides of some interfaces that the fracture has entered; but for those of the rock ahead of a tip, where one is
// given.
std::vector<SideWord> entered_sides(const State& state, SideWord interfaces, const Tip* tip) {
  std::vector<SideWord> entered;
  for (const SurfacePoint& point : state.fracture().points) {
    const SideWord word = point.sides & interfaces;
    if (std::find(entered.begin(), entered.end(), word) == entered.end()) entered.push_back(word);
  }
  if (tip != nullptr) std::erase(entered, sides_ahead(state, *tip) & interfaces);
  return entered;
}

// Where an interface has come apart, a tip on it or beyond it belongs to the rock ahead alone: the rock behind is cut
// through, by the fracture's straight extension where its copies belong to nodes that are not behind the tip.
void mark_ahead(const Scene& scene, const State& state, NodeMasks& masks) {
  const Surface& s = state.fracture();
  for (std::size_t t = 0; t < state.tips.size(); ++t) {
    const Vec2 at = tip_position(state, state.tips[t]);
    const Vec2 to = at + extension(state.grid) * tip_direction(s, state.tips[t].at_back);
    for_each_node_near(state.grid, at, to, split_reach(scene, state.grid), [&](std::size_t node, const Vec2&) {
      SideWord& word = masks.word[node];
      if (word == 0 || (word & s.mask()) != 0 || entered_sides(state, word, &state.tips[t]).empty()) return;
      word |= s.mask();
      masks.ahead[node] = static_cast<char>(t + 1);
    });
  }
}

NodeMasks node_masks(const Scene& scene, const State& state) {
  const auto nodes = static_cast<std::size_t>(state.grid.nodes());
  NodeMasks masks{std::vector<SideWord>(nodes, 0), std::vector<char>(nodes, 0)};
  for (const Surface& s : state.surfaces) {
    if (s.kind == Surface::Kind::fracture) mark_fracture(scene, state, masks.word);
    if (s.kind == Surface::Kind::interface) mark_interface(scene, state, s, masks.word);
  }
  if (state.has_fracture) mark_ahead(scene, state, masks);
  for (std::size_t node = 0; node < nodes; ++node) {
    const auto image = static_cast<std::size_t>(mirror_of(scene, state.grid, static_cast<int>(node)).record);
    masks.word[node] = masks.word[image], masks.ahead[node] = masks.ahead[image];
  }
  return masks;
}

// Bonded places in a column that has parted on the fracture's other side.
std::vector<std::pair<const Surface*, const SurfacePoint*>> half_parted(const State& state) {
  std::vector<std::pair<const Surface*, const SurfacePoint*>> bonded;
  for (const Surface& surface : state.surfaces) {
    const auto& points = surface.points;
    for (std::size_t q = 0; q + 1 < points.size(); ++q) {
      const SurfacePoint &a = points[q], &b = points[q + 1];
      if (a.column == b.column && a.split != b.split) bonded.emplace_back(&surface, a.split ? &b : &a);
    }
  }
  return bonded;
}

void make_cut_nodes(const Scene& scene, const State& state, const NodeMasks& masks, Copies& copies) {
  const auto bonded = half_parted(state);
  copies.cut_of_node.assign(masks.word.size(), -1);
  copies.cut.clear();
  copies.node_of_record.resize(masks.word.size());
  std::iota(copies.node_of_record.begin(), copies.node_of_record.end(), 0);
  const SideWord fracture = state.has_fracture ? state.fracture().mask() : 0;
  for (std::size_t node = 0; node < masks.word.size(); ++node) {
    if (masks.word[node] == 0) continue;
    copies.cut_of_node[node] = static_cast<int>(copies.cut.size());
    CutNode cut;
    cut.mask = masks.word[node];
    cut.fracture = cut.mask & fracture;
    const SideWord interfaces = cut.mask & ~fracture;
    const int tip = masks.ahead[node] - 1;
    if (cut.fracture != 0 && interfaces != 0)
      cut.entered = entered_sides(state, interfaces, tip < 0 ? nullptr : &state.tips[static_cast<std::size_t>(tip)]);
    for (const auto& [surface, point] : bonded) {  // there it is whole
      const int i = static_cast<int>(node);
      const int column = scene.strata.upwards() ? state.grid.column(i) : state.grid.row(i);
      if ((cut.mask & surface->mask()) == 0 || column != point->column) continue;
      cut.joined.push_back({cut.key(point->sides), cut.key(point->sides | surface->mask())});
    }
    copies.cut.push_back(std::move(cut));
  }
}

int record_for(Copies& copies, int node, SideWord sides) {
  const int found = record_of(copies, node, sides);
  if (found >= 0) return found;
  CutNode& cut = copies.cut[static_cast<std::size_t>(copies.cut_of_node[static_cast<std::size_t>(node)])];
  int record = node;
  if (!cut.keys.empty()) {
    record = copies.records();
    copies.node_of_record.push_back(node);
  }
  cut.keys.push_back(cut.key(sides));
  cut.records.push_back(record);
  return record;
}

struct SortKey {
  int j, i;
  SideWord sides;
  std::int32_t id;
  std::size_t from;
  auto operator<=>(const SortKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

// Which surfaces split any node of the stencil around a node.
std::vector<SideWord> reach_of(const Grid& g, const std::vector<SideWord>& mask) {
  std::vector<SideWord> along(mask.size(), 0), reach(mask.size(), 0);
  for (std::size_t node = 1; node + 1 < mask.size(); ++node) along[node] = mask[node - 1] | mask[node] | mask[node + 1];
  const auto row = static_cast<std::size_t>(g.columns());
  for (std::size_t node = row; node + row < mask.size(); ++node)
    reach[node] = along[node - row] | along[node] | along[node + row];
  return reach;
}

std::vector<SortKey> sort_keys(const State& state, const std::vector<SideWord>& reach) {
  const Particles& p = state.particles;
  const Grid& g = state.grid;
  std::vector<SortKey> keys(p.size());
  int i = 0, j = 0;  // those of the particle before, most often
  for (std::size_t k = 0; k < p.size(); ++k) {
    i = g.column_at(p.x[k], i), j = g.row_at(p.y[k], j);
    if (i < 0 || i > g.nx || j < 0 || j > g.ny) {
      throw NumericalFailure("a particle has left the block at x = " + std::to_string(p.x[k]) +
                             ", y = " + std::to_string(p.y[k]) + " m: parts move freely, or the time step is too long");
    }
    keys[k] = {j, i, p.sides[k] & reach[static_cast<std::size_t>(g.node(i, j))], p.id[k], k};
  }
  return keys;
}

void sort_particles(Particles& particles, const std::vector<std::size_t>& order) {
  std::vector<std::size_t> moved;
  for (std::size_t k = 0; k < order.size(); ++k) {
    if (order[k] != k) moved.push_back(k);
  }
  if (moved.empty()) return;
  for_each_array(particles, [&](auto& array) {
    std::remove_reference_t<decltype(array)> taken(moved.size());
    for (std::size_t k = 0; k < moved.size(); ++k) taken[k] = array[order[moved[k]]];
    for (std::size_t k = 0; k < moved.size(); ++k) array[moved[k]] = taken[k];
  });
}

void make_bins(State& state, const std::vector<SideWord>& reach, const std::vector<SortKey>& keys) {
  state.bins.clear();
  for (std::size_t k = 0; k < keys.size(); ++k) {
    const bool same = k > 0 && std::tie(keys[k].j, keys[k].i, keys[k].sides) ==
                                   std::tie(keys[k - 1].j, keys[k - 1].i, keys[k - 1].sides);
    if (!same) {
      Bin bin;
      bin.first = static_cast<int>(k);
      bin.i = keys[k].i, bin.j = keys[k].j;
      bin.record = state.grid.around(bin.i, bin.j);
      if (reach[static_cast<std::size_t>(state.grid.node(bin.i, bin.j))] != 0) {
        for (int& record : bin.record) record = record_for(state.copies, record, keys[k].sides);
      }
      state.bins.push_back(bin);
    }
    state.bins.back().last = static_cast<int>(k) + 1;
  }
}

void list_bins(const std::vector<SideWord>& reach, State& state) {
  state.cut_bins.clear();
  state.strips.clear();
  for (std::size_t b = 0; b < state.bins.size(); ++b) {
    const Bin& bin = state.bins[b];
    if (reach[static_cast<std::size_t>(state.grid.node(bin.i, bin.j))] != 0) state.cut_bins.push_back(b);
    const auto strip = static_cast<std::size_t>(bin.j / rows_per_strip), at = b;
    while (state.strips.size() <= strip) state.strips.push_back({static_cast<int>(at), static_cast<int>(at)});
    state.strips.back().last = static_cast<int>(b) + 1;
  }
}

Master master_of(const Scene& scene, State& state, int record) {
  Copies& copies = state.copies;
  const int node = copies.node(record);
  Master master = mirror_of(scene, state.grid, node);
  const CutNode* cut = copies.cut_at(node);
  if (cut == nullptr) return master;
  const auto key = cut->key_of(record);
  if (!key) return {record};  // not in use
  master.record = master.record == node ? record : record_for(copies, master.record, *key);
  return master;
}

void make_masters(const Scene& scene, State& state) {
  state.masters.clear();
  state.tied.clear();
  for (int record = 0; record < state.copies.records(); ++record) {
    const Master master = master_of(scene, state, record);  // may add the record it mirrors
    state.masters.push_back(master);
    if (master.record != record || master.x == 0.0 || master.y == 0.0) state.tied.push_back(record);
  }
}

SurfaceStencil stencil_at(const State& state, const Surface& s, const SurfacePoint& point) {
  SurfaceStencil stencil;
  const Grid& g = state.grid;
  stencil.i = std::clamp(g.column_at(point.x.x()), 0, g.nx);
  stencil.j = std::clamp(g.row_at(point.x.y()), 0, g.ny);
  const auto nodes = g.around(stencil.i, stencil.j);
  for (std::size_t n = 0; n < 9; ++n) {
    const int minus = record_of(state.copies, nodes[n], point.sides);
    const int plus = record_of(state.copies, nodes[n], point.sides | s.mask());
    // A side without particles has no record: the node does not tell the sides apart.
    stencil.plus[n] = plus >= 0 ? plus : std::max(minus, nodes[n]);
    stencil.minus[n] = minus >= 0 ? minus : stencil.plus[n];
  }
  return stencil;
}

void make_surface_stencils(State& state) {
  state.point_stencils.clear();
  state.vertex_stencils.clear();
  for (const Surface& s : state.surfaces) {
    for (const auto& [places, stencils] :
         {std::pair{&s.points, &state.point_stencils}, {&s.vertices, &state.vertex_stencils}}) {
      auto& of_surface = stencils->emplace_back();
      for (const SurfacePoint& place : *places) of_surface.push_back(stencil_at(state, s, place));
    }
  }
}

}  // namespace

SideWord CutNode::key(SideWord sides) const {
  const SideWord all = sides & mask, interfaces = all & ~fracture;
  const bool everywhere = (mask & ~fracture) == 0;
  const SideWord own = everywhere || std::ranges::count(entered, interfaces) > 0 ? all : interfaces;
  const auto corner = std::ranges::find(joined, own, [](const auto& pair) { return pair[0]; });
  return corner == joined.end() ? own : (*corner)[1];
}

std::optional<SideWord> CutNode::key_of(int record) const {
  const auto at = static_cast<std::size_t>(std::ranges::find(records, record) - records.begin());
  return at == records.size() ? std::nullopt : std::optional(keys[at]);
}

std::vector<Vec2> nodal_reactions(const Surface& surface, const std::vector<SurfaceStencil>& stencils) {
  struct Force {
    Vec2 r = Vec2::Zero();  // N/m
    double length = 0.0;    // m
  };
  const std::vector<SurfacePoint>& points = surface.points;
  std::map<std::pair<int, int>, Force> nodes;  // by the records of the two sides
  const auto visit = [&](std::size_t q, const auto& of) {
    const SurfaceStencil& s = stencils[q];
    for (std::size_t n = 0; n < 9 && points[q].split; ++n) {
      if (s.plus[n] != s.minus[n] && s.N[n] > 0.0) of(nodes[{s.plus[n], s.minus[n]}], s.N[n]);
    }
  };
  for (std::size_t q = 0; q < points.size(); ++q) {
    const double A = points[q].A;
    visit(q, [&](Force& at, double N) { at.r += A * N * points[q].reaction, at.length += A * N; });
  }
  std::vector<Vec2> r;
  std::vector<double> weight(points.size(), 0.0);
  for (std::size_t q = 0; q < points.size(); ++q) {
    Vec2 sum = Vec2::Zero();
    visit(q, [&](const Force& at, double N) { sum += N / at.length * at.r, weight[q] += N; });
    r.push_back(weight[q] > 0.0 ? Vec2{sum / weight[q]} : points[q].reaction);
  }
  const auto fill = [&](std::size_t q, std::size_t next) {
    if (points[q].split && weight[q] == 0.0 && weight[next] > 0.0) r[q] = r[next], weight[q] = weight[next];
  };
  for (std::size_t q = 1; q < r.size(); ++q) fill(q, q - 1);
  for (std::size_t q = r.size(); q-- > 1;) fill(q - 1, q);
  return r;
}

int record_of(const Copies& copies, int node, SideWord sides) {
  const CutNode* cut = copies.cut_at(node);
  if (cut == nullptr) return node;
  const auto at = std::ranges::find(cut->keys, cut->key(sides)) - cut->keys.begin();
  return at == std::ssize(cut->keys) ? -1 : cut->records[static_cast<std::size_t>(at)];
}

SideWord sides_ahead(const State& state, const Tip& tip) {
  return sides_at(state, place_ahead(state, tip), state.fracture().bit);
}

std::vector<std::size_t> bins_of_particles(const State& state) {
  std::vector<std::size_t> of(state.particles.size());
  for (std::size_t b = 0; b < state.bins.size(); ++b) {
    for (const std::size_t q : state.bins[b]) of[q] = b;
  }
  return of;
}

double support_in_cells(const Scene& scene) {
  return scene.numerics.shape == Numerics::Shape::bspline2 ? 1.5 : 1.0;
}

SideWord sides_at(const State& state, const Vec2& x, int except) {
  SideWord word = 0;
  for (const Surface& s : state.surfaces) {
    if (s.bit != except && side(s, x, extension(state.grid))) word |= s.mask();
  }
  return word;
}

void rebuild_copies(const Scene& scene, State& state) {
  const NodeMasks masks = node_masks(scene, state);
  make_cut_nodes(scene, state, masks, state.copies);
  const std::vector<SideWord> reach = reach_of(state.grid, masks.word);
  std::vector<SortKey> keys = sort_keys(state, reach);
  if (!std::ranges::is_sorted(keys)) std::ranges::sort(keys);
  make_bins(state, reach, keys);
  std::vector<std::size_t> order(keys.size());
  std::ranges::transform(keys, order.begin(), &SortKey::from);
  join_corners(scene, order, state);
  if (scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics) number_along_rows(state.copies, state.bins);
  if (scene.numerics.in_lanes()) {  // to bins and blocks in one move
    std::vector<std::uint8_t> rock;
    for (const std::size_t from : order) rock.push_back(state.particles.rock[from]);
    std::vector<std::size_t> blocks = make_blocks(rock, state.bins);
    for (std::size_t& k : blocks) k = order[k];
    order.swap(blocks);
  }
  sort_particles(state.particles, order);
  list_bins(reach, state);
  make_masters(scene, state);
  make_surface_stencils(state);
  join_light_copies(scene, state);
  state.x_spans = spans_along(state.grid, Axis::x), state.y_spans = spans_along(state.grid, Axis::y);
  const auto records = static_cast<std::size_t>(state.copies.records());
  state.sums.clear(records), state.motion.clear(records);
  state.gathered = false;
  state.body.clear();
  state.total.based = false;
  state.total.op.reset();
}

}  // namespace strata
