#include "scene/path_geometry.hpp"

#include <algorithm>
#include <cmath>

namespace strata {
namespace {

double cross(const Point& o, const Point& a, const Point& b) {
  return (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
}

double distance_to_segment(const Point& p, const Point& a, const Point& b) {
  const double dx = b[0] - a[0];
  const double dy = b[1] - a[1];
  const double length2 = dx * dx + dy * dy;
  const double along = length2 > 0.0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / length2 : 0.0;
  const double t = std::clamp(along, 0.0, 1.0);
  return std::hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

}  // namespace

double segment_distance(const Point& a0, const Point& a1, const Point& b0, const Point& b1) {
  const bool b_apart = cross(a0, a1, b0) * cross(a0, a1, b1) < 0.0;
  const bool a_apart = cross(b0, b1, a0) * cross(b0, b1, a1) < 0.0;
  if (a_apart && b_apart) return 0.0;
  return std::min({distance_to_segment(a0, b0, b1), distance_to_segment(a1, b0, b1), distance_to_segment(b0, a0, a1),
                   distance_to_segment(b1, a0, a1)});
}

std::optional<std::pair<std::size_t, std::size_t>> self_contact(const std::vector<Point>& path_m, double tolerance_m) {
  for (std::size_t i = 0; i + 1 < path_m.size(); ++i) {
    for (std::size_t j = i + 1; j + 1 < path_m.size(); ++j) {
      // Neighbours share a point: they touch besides only where the later one turns back onto the earlier.
      const bool touch = j == i + 1
                             ? distance_to_segment(path_m[j + 1], path_m[i], path_m[j]) <= tolerance_m ||
                                   distance_to_segment(path_m[i], path_m[j], path_m[j + 1]) <= tolerance_m
                             : segment_distance(path_m[i], path_m[i + 1], path_m[j], path_m[j + 1]) <= tolerance_m;
      if (touch) return std::pair(i, j);
    }
  }
  return std::nullopt;
}

std::vector<Point> legs_between_interfaces(const Scene& scene, const Point& from, const Point& to) {
  // An end that stands on an interface: one that follows the rock is a millimetre or so off it (see ahead_cells).
  const double on_it = 0.1 * scene.numerics.cell_m / std::hypot(to[0] - from[0], to[1] - from[1]);
  const std::size_t axis = scene.strata.along == Strata::Along::y ? 1 : 0;
  std::vector<double> shares;
  for (const InterfacePlace& place : scene.strata.interfaces) {
    if (scene.laws[place.law].kind == InterfaceLaw::Kind::perfect) continue;
    const double share = (place.at_m - from[axis]) / (to[axis] - from[axis]);
    if (share > on_it && share < 1.0 - on_it) shares.push_back(share);
  }
  std::sort(shares.begin(), shares.end());
  std::vector<Point> ends;
  for (const double share : shares) {
    Point& end = ends.emplace_back();
    for (std::size_t k = 0; k < 2; ++k) end[k] = from[k] + share * (to[k] - from[k]);
  }
  ends.push_back(to);
  return ends;
}

}  // namespace strata
