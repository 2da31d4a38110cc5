#include "scene/graded_cells.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace strata {
namespace {

// Length of the straight way from x along the unit vector d until it leaves the block.
double way_to_edge(const Domain& domain, const Point& x, const Point& d) {
  double way = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < 2; ++k) {
    if (d[k] > 0.0) way = std::min(way, (domain.extent_m(k) - x[k]) / d[k]);
    if (d[k] < 0.0) way = std::min(way, -x[k] / d[k]);
  }
  return std::max(0.0, way);
}

// Unit vector along which the fracture would go on at its end `tip`, which `before` comes before.
Point direction(const Point& before, const Point& tip) {
  const Point d{tip[0] - before[0], tip[1] - before[1]};
  const double length = std::hypot(d[0], d[1]);
  return {d[0] / length, d[1] / length};
}

// Spans of one stretch of growing cells, for a trial q.
struct Growth {
  enum class End { edge, neighbour, fine };  // an edge halves the last span; towards fine cells spans shrink again
  double h, far, most;                       // most: largest q
  End end;
  double span(int k, int m, double q) const {
    return std::min(h * std::pow(q, end == End::fine ? std::min(k, m + 1 - k) : k), far);
  }
  double sum(int m, double q) const {
    double total = 0.0;
    for (int k = 1; k <= m; ++k) total += (end == End::edge && k == m ? 0.5 : 1.0) * span(k, m, q);
    return total;
  }
};

// Spans that fill `length` m, from the fine ones on.
std::vector<double> growing_spans(const Growth& growth, double length) {
  const double round_off = 1e-9 * growth.h;
  int m = std::max(1, static_cast<int>(length / growth.far));  // the fewest spans
  while (growth.sum(m, growth.most) < length - round_off) ++m;
  double low = 1.0, high = growth.most;
  for (int halving = 0; halving < 60; ++halving) {  // to the last digit
    const double q = 0.5 * (low + high);
    (growth.sum(m, q) < length ? low : high) = q;
  }
  std::vector<double> spans;
  for (int k = 1; k <= m; ++k) spans.push_back(growth.span(k, m, high));
  return spans;
}

// Spans from the last fine node, `cells` cells from an end of the block, outwards to the end of the rock.
std::vector<double> outward_spans(const Grading& axis, long cells, double beyond) {
  const auto to_edge = static_cast<double>(cells) * axis.h;
  if (beyond == 0.0) {
    if (cells == 0) return {};
    return growing_spans({axis.h, axis.far, span_growth, Growth::End::edge}, to_edge - 0.5 * axis.h);
  }
  std::vector<double> spans;
  if (cells > 0) spans = growing_spans({axis.h, axis.far, span_growth, Growth::End::neighbour}, to_edge);
  const double last = spans.empty() ? axis.h : spans.back();
  constexpr double unbounded = std::numeric_limits<double>::infinity();
  const std::vector<double> more =
      growing_spans({last, unbounded, span_growth_beyond, Growth::End::edge}, beyond - 0.5 * axis.h);
  spans.insert(spans.end(), more.begin(), more.end());
  return spans;
}

// First and last node of a fine stretch, as numbers of cells of h from the origin.
struct FineNodes {
  long first, last;
};

std::vector<FineNodes> fine_nodes(double h, long cells, const std::vector<Stretch>& fine) {
  constexpr double round_off = 1e-6;  // of a cell
  std::vector<FineNodes> nodes;       // in order, none touching the next
  for (const Stretch& s : fine) {
    const long first = std::max(0L, std::lround(std::floor(s.from / h + round_off)));
    const long last = std::min(cells, std::lround(std::ceil(s.to / h - round_off)));
    if (!nodes.empty() && first <= nodes.back().last + 1) {
      nodes.back().last = std::max(nodes.back().last, last);
    } else {
      nodes.push_back({first, last});
    }
  }
  return nodes;
}

bool graded(const Numerics& numerics) {
  return numerics.far_cell_m.value_or(numerics.cell_m) > numerics.cell_m;
}

// What is between fine stretches, and beyond them, follows from their ends alone.
bool mirrored_columns(const Scene& scene) {
  if (!graded(scene.numerics)) return true;
  const std::vector<Stretch> fine = fine_stretches(scene, 0);
  for (std::size_t k = 0; k < fine.size(); ++k) {
    const double off = fine[k].from + fine[fine.size() - 1 - k].to - scene.domain.width_m;
    if (std::abs(off) > 0.5 * scene.numerics.cell_m) return false;  // ends are nodes
  }
  return true;
}

}  // namespace

std::vector<GrowthWay> ways_of_growth(const Scene& scene) {
  if (!scene.fracture || scene.fracture->growth == Fracture::Growth::none) return {};
  const auto& path = scene.fracture->path_m;
  std::vector<std::pair<Point, Point>> rays{{path.back(), direction(path[path.size() - 2], path.back())}};
  const bool from_symmetry = scene.domain.bottom == Edge::symmetry && path.front()[1] == 0.0;
  if (!from_symmetry) rays.emplace_back(path.front(), direction(path[1], path.front()));
  double longest = std::numeric_limits<double>::infinity();
  for (const auto& [tip, d] : rays) {
    if (scene.stop.tip_y_m && d[1] > 0.0)
      longest = std::min(longest, std::max(0.0, (*scene.stop.tip_y_m - tip[1]) / d[1]));
  }
  std::vector<GrowthWay> ways;
  for (const auto& [tip, d] : rays) {
    const bool to_stop = scene.stop.lower_tip_y_m && d[1] < 0.0;
    const double length = std::min(to_stop ? std::max(0.0, (*scene.stop.lower_tip_y_m - tip[1]) / d[1]) : longest,
                                   way_to_edge(scene.domain, tip, d));
    ways.push_back({{tip[0] + length * d[0], tip[1] + length * d[1]}, length});
  }
  return ways;
}

std::vector<Stretch> fine_stretches(const Scene& scene, std::size_t axis) {
  const double h = scene.numerics.cell_m;
  std::vector<Stretch> fine;
  if (scene.fracture) {
    std::vector<Point> places = scene.fracture->path_m;
    for (const GrowthWay& way : ways_of_growth(scene)) places.push_back(way.end);
    const auto [low, high] = std::ranges::minmax(places, {}, [axis](const Point& x) { return x[axis]; });
    const Numerics& numerics = scene.numerics;
    const auto& from = axis == 0 ? numerics.fine_left_m : numerics.fine_bottom_m;
    const auto& to = axis == 0 ? numerics.fine_right_m : numerics.fine_top_m;
    fine.push_back(
        {from.value_or(low[axis] - fine_cells_at_fracture * h), to.value_or(high[axis] + fine_cells_at_fracture * h)});
  }
  const auto add_around = [&](double at) {
    fine.push_back({at - fine_cells_at_interface * h, at + fine_cells_at_interface * h});
  };
  for (std::size_t n = 0; n < scene.strata.interfaces.size(); ++n) {
    const InterfacePlace& place = scene.strata.interfaces[n];
    const bool runs_along = scene.strata.upwards() == (axis == 0);
    if (!runs_along && scene.changes_at(n)) add_around(place.at_m);
    for (const auto& end : {place.from_m, place.to_m})
      if (runs_along && end) add_around(*end);
  }
  std::ranges::sort(fine, {}, &Stretch::from);
  std::vector<Stretch> between_nodes;
  for (const auto& [first, last] : fine_nodes(h, std::lround(scene.domain.extent_m(axis) / h), fine))
    between_nodes.push_back({static_cast<double>(first) * h, static_cast<double>(last) * h});
  return between_nodes;
}

std::vector<double> graded_knots(const Grading& axis) {
  const double h = axis.h;
  const long cells = std::lround(axis.extent / h);
  std::vector<FineNodes> nodes = fine_nodes(h, cells, axis.fine);
  if (nodes.empty()) nodes.push_back({0, std::min(cells, 1L)});
  std::vector<double> t;  // from t_0 on, the lower end of the first node's span
  const std::vector<double> down = outward_spans(axis, nodes.front().first, axis.below);
  if (!down.empty()) {
    t.push_back(-axis.below - 0.5 * down.back());
    for (std::size_t k = down.size() - 1; k > 0; --k) t.push_back(t.back() + down[k]);
  }
  for (std::size_t n = 0; n < nodes.size(); ++n) {
    for (long i = nodes[n].first; i <= nodes[n].last + 1; ++i) t.push_back((static_cast<double>(i) - 0.5) * h);
    if (n + 1 == nodes.size()) break;
    const double gap = static_cast<double>(nodes[n + 1].first - nodes[n].last - 1) * h;
    const std::vector<double> spans = growing_spans({h, axis.far, span_growth, Growth::End::fine}, gap);
    for (std::size_t k = 0; k + 1 < spans.size(); ++k) t.push_back(t.back() + spans[k]);
  }
  const std::vector<double> up = outward_spans(axis, cells - nodes.back().last, axis.above);
  if (!up.empty()) {
    for (std::size_t k = 0; k + 1 < up.size(); ++k) t.push_back(t.back() + up[k]);
    t.push_back(2.0 * (axis.extent + axis.above) - t.back());  // the last node, in the middle, stands on the edge
  }
  t[0] = -2.0 * axis.below - t[1];  // the first node stands on the edge
  // Ghosts: node -1 mirrors node 1, node n + 1 mirrors node n - 1.
  t.insert(t.begin(), t[0] - (t[2] - t[1]));
  const std::size_t end = t.size() - 1;
  t.push_back(t[end] + (t[end - 1] - t[end - 2]));
  return t;
}

std::vector<double> scene_knots(const Scene& scene, std::size_t axis) {
  const double h = scene.numerics.cell_m, far = scene.numerics.far_cell_m.value_or(h);
  const Domain& domain = scene.domain;
  const bool goes_on = domain.beyond_m > 0.0, grows = graded(scene.numerics);
  if (!grows && !goes_on) return {};
  const double extent = domain.extent_m(axis);
  const Stretch rock = axis == 0 ? domain.along_x() : domain.along_y();
  const std::vector<Stretch> fine = grows ? fine_stretches(scene, axis) : std::vector<Stretch>{{0.0, extent}};
  return graded_knots({extent, h, far, fine, -rock.from, rock.to - extent});
}

bool mirror_symmetric(const Scene& scene) {
  if (!scene.fracture || !scene.strata.upwards()) return false;
  const InSitu& in_situ = scene.in_situ;
  if (scene.body.acceleration_m_s2 || !in_situ.vertical_Pa.formula.empty())
    return false;  // formulas need not be symmetric
  if (in_situ.shear_Pa != 0.0) return false;
  if (scene.domain.sides != Edge::fixed || scene.fracture->direction != Fracture::Direction::straight) return false;
  const double middle = 0.5 * scene.domain.width_m;
  const bool upright = std::ranges::all_of(scene.fracture->path_m, [&](const Point& point) {
    return std::abs(point[0] - middle) < 1e-9 * scene.numerics.cell_m;
  });
  const bool mirrored = std::ranges::all_of(scene.strata.interfaces, [&](const InterfacePlace& place) {
    const double off = place.from_m.value_or(0.0) + place.to_m.value_or(scene.domain.width_m) - scene.domain.width_m;
    return place.from_m.has_value() == place.to_m.has_value() && std::abs(off) < 1e-9 * scene.numerics.cell_m;
  });
  return upright && mirrored && mirrored_columns(scene);
}

}  // namespace strata
