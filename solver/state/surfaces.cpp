#include "state/surfaces.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strata {
namespace {

constexpr double on_it = 1e-9;  // of a segment's length: nearer than this a place is on the surface, and on its + side

struct Foot {
  double distance2 = 0.0;
  double along = 0.0;  // from the segment's start (m), beyond its ends where it is extended
};

Foot foot_on_segment(const Vec2& a, const Vec2& b, const Vec2& x, double before, double after) {
  const Vec2 d = b - a;
  const double L = d.norm();
  const double along = std::clamp((x - a).dot(d) / L, -before, L + after);
  return {(x - a - d * (along / L)).squaredNorm(), along};
}

}  // namespace

Projection project(const Surface& surface, const Vec2& x, double reach) {
  const auto& v = surface.vertices;
  const std::size_t n = v.size() - 1;
  std::size_t best = 0;
  Foot foot{std::numeric_limits<double>::max(), 0.0};
  double distance = std::numeric_limits<double>::infinity();
  // The first of the nearest, though from the last one on: places are most often beside the newest segments.
  for (std::size_t k = n; k-- > 0;) {
    const double before = k == 0 ? reach : 0.0, after = k + 1 == n ? reach : 0.0;
    const double farthest = distance + (surface.points[k].A + before + after) * (1.0 + 1e-9);
    if ((x - v[k].x).squaredNorm() > farthest * farthest) continue;
    const Foot f = foot_on_segment(v[k].x, v[k + 1].x, x, before, after);
    if (f.distance2 <= foot.distance2) {
      foot = f;
      best = k;
      distance = std::sqrt(f.distance2) * (1.0 + 1e-9);
    }
  }
  const Vec2 d = (v[best + 1].x - v[best].x).normalized();
  // At a kink the nearest place is a vertex: the mean of the two normals there tells the sides apart for both segments.
  Vec2 normal{-d.y(), d.x()};
  const double L = (v[best + 1].x - v[best].x).norm();
  if (foot.along >= L && best + 1 < n) normal = v[best + 1].n;
  if (foot.along <= 0.0 && best > 0) normal = v[best].n;
  const Vec2 off = x - v[best].x - d * foot.along;
  const bool plus = off.dot(normal) >= -on_it * L;
  return {(plus ? 1.0 : -1.0) * std::sqrt(foot.distance2), v[best].arc + foot.along};
}

bool side(const Surface& surface, const Vec2& x, double reach) {
  const SurfacePoint& first = surface.points.front();
  if (std::all_of(surface.points.begin(), surface.points.end(), [&](const SurfacePoint& s) { return s.n == first.n; }))
    return (x - surface.vertices.front().x).dot(first.n) >= -on_it * first.A;
  return project(surface, x, reach).distance >= 0.0;
}

void update_geometry(Surface& surface) {
  auto& v = surface.vertices;
  double arc = 0.0;
  for (std::size_t k = 0; k + 1 < v.size(); ++k) {
    SurfacePoint& s = surface.points[k];
    const Vec2 d = v[k + 1].x - v[k].x;
    s.A = d.norm();
    s.n = Vec2{-d.y(), d.x()} / s.A;
    s.x = 0.5 * (v[k].x + v[k + 1].x);
    s.arc = arc + 0.5 * s.A;
    v[k].arc = arc;
    arc += s.A;
  }
  v.back().arc = arc;
  v.front().n = surface.points.front().n;
  v.back().n = surface.points.back().n;
  for (std::size_t k = 1; k + 1 < v.size(); ++k) {
    v[k].n = (surface.points[k - 1].n + surface.points[k].n).normalized();
  }
}

Surface make_surface(Surface::Kind kind, int bit, const std::vector<Vec2>& path, double spacing) {
  Surface surface;
  surface.kind = kind;
  surface.bit = bit;
  surface.vertices.resize(1);
  surface.vertices[0].x = path.front();
  for (std::size_t k = 1; k < path.size(); ++k) extend(surface, true, path[k], spacing);
  return surface;
}

void extend(Surface& surface, bool at_back, const Vec2& to, double spacing) {
  auto& v = surface.vertices;
  const Vec2 from = at_back ? v.back().x : v.front().x;
  const int pieces = std::max(1, static_cast<int>(std::lround(std::ceil((to - from).norm() / spacing - 1e-6))));
  for (int k = 1; k <= pieces; ++k) {
    SurfacePoint vertex;
    vertex.x = from + (to - from) * (static_cast<double>(k) / pieces);
    v.insert(at_back ? v.end() : v.begin(), vertex);
    surface.points.insert(at_back ? surface.points.end() : surface.points.begin(), SurfacePoint{});
  }
  update_geometry(surface);
}

Vec2 tip_direction(const Surface& fracture, bool at_back) {
  const auto& v = fracture.vertices;
  return at_back ? (v.back().x - v[v.size() - 2].x).normalized() : (v[0].x - v[1].x).normalized();
}

}  // namespace strata
