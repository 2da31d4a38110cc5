#include "state/surfaces.hpp"

#include <catch2/catch.hpp>

using namespace strata;

namespace {

Surface path(const std::vector<Vec2>& points, double spacing = 0.5) {
  return make_surface(Surface::Kind::fracture, 3, points, spacing);
}

void check_projection(const Surface& s, const Vec2& x, double distance, double arc) {
  const Projection on = project(s, x, 4.0);
  CAPTURE(x.transpose(), on.distance, on.arc);
  CHECK(on.distance == Approx(distance).margin(1e-14));
  CHECK(on.arc == Approx(arc).margin(1e-14));
  CHECK(side(s, x, 4.0) == (distance >= 0.0));
}

}  // namespace

// Requires pieces that divide each part of the path evenly, arc lengths, middles, unit normals to the left of the way
// (from - to +) and the mean of two normals at a kink, by hand. Mutations that fail: normals turned, not of unit
// length.
TEST_CASE("geometry of a kinked path") {
  const Surface s = path({{1.0, 1.0}, {3.0, 1.0}, {3.0, 2.2}});
  REQUIRE(s.points.size() == 7);
  REQUIRE(s.vertices.size() == 8);
  CHECK(s.mask() == 8U);
  CHECK(s.length() == Approx(3.2).epsilon(1e-14));
  CHECK((s.points[0].n - Vec2{0.0, 1.0}).norm() < 1e-15);
  CHECK((s.points[5].n - Vec2{-1.0, 0.0}).norm() < 1e-15);
  CHECK((s.vertices[4].n - Vec2{-1.0, 1.0} / std::sqrt(2.0)).norm() < 1e-15);
  CHECK((s.vertices[0].n - Vec2{0.0, 1.0}).norm() < 1e-15);
  CHECK((s.vertices[7].n - Vec2{-1.0, 0.0}).norm() < 1e-15);
  CHECK((s.points[1].x - Vec2{1.75, 1.0}).norm() < 1e-15);
  CHECK(s.points[1].A == Approx(0.5));
  CHECK(s.points[1].arc == Approx(0.75));
  CHECK(s.points[5].A == Approx(0.4));
  CHECK(s.vertices[5].arc == Approx(2.4));
}

// Requires the nearest of all segments of a long path that winds back beside itself, of pieces of two lengths, the
// first and the last one extended by 4 m. Mutations that fail: segments skipped three times as far as they may be, the
// first one skipped.
TEST_CASE("the nearest segment of a long path") {
  Surface s = path({{0.0, 0.0}, {0.0, 12.0}, {3.0, 14.0}, {6.0, 12.0}, {5.0, 1.0}, {8.0, -3.0}});
  extend(s, true, {11.0, 9.0}, 1.3);
  extend(s, true, {-12.0, -9.0}, 1.3);
  extend(s, false, {-7.0, -9.0}, 0.2);
  const std::size_t n = s.points.size();
  for (double x = -12.0; x < 16.0; x += 0.37) {
    for (double y = -14.0; y < 18.0; y += 0.41) {
      double nearest = 1e9;
      for (std::size_t k = 0; k < n; ++k) {
        const Vec2 from = s.vertices[k].x, d = (s.vertices[k + 1].x - from).normalized(), at{x, y};
        const double along =
            std::clamp((at - from).dot(d), k == 0 ? -4.0 : 0.0, s.points[k].A + (k + 1 == n ? 4.0 : 0.0));
        nearest = std::min(nearest, (at - from - along * d).norm());
      }
      CAPTURE(x, y);
      CHECK(std::abs(project(s, {x, y}, 4.0).distance) == Approx(nearest).epsilon(1e-12));
    }
  }
}

// Requires signed distances and foot points on a straight surface, beyond its ends on the straight extension, and on
// the surface itself, which counts as +.
TEST_CASE("projection on a straight surface") {
  const Surface s = path({{1.0, 2.0}, {4.0, 2.0}});
  check_projection(s, {2.2, 2.7}, 0.7, 1.2);
  check_projection(s, {2.2, 1.4}, -0.6, 1.2);
  check_projection(s, {2.2, 2.0}, 0.0, 1.2);
  check_projection(s, {6.0, 2.5}, 0.5, 5.0);
  check_projection(s, {6.0, 1.5}, -0.5, 5.0);
  check_projection(s, {0.0, 1.5}, -0.5, -1.0);
  check_projection(s, {6.0, 2.0}, 0.0, 5.0);
}

// Requires that the extension ends after its reach: from there the end of the extension is the nearest place.
TEST_CASE("the extension has an end") {
  const Surface s = path({{1.0, 2.0}, {4.0, 2.0}});
  const Projection on = project(s, {9.0, 1.0}, 4.0);
  CHECK(on.arc == Approx(7.0));
  CHECK(on.distance == Approx(-std::sqrt(2.0)));
  CHECK(project(s, {4.5, 2.5}, 0.0).arc == Approx(3.0));
}

// Requires that the sides are those of the fracture's way: turned about, + and - change places, off the surface.
TEST_CASE("the other way round, the sides change") {
  const Surface s = path({{1.0, 2.0}, {4.0, 3.0}}), back = path({{4.0, 3.0}, {1.0, 2.0}});
  for (const Vec2& x : {Vec2{2.0, 3.0}, Vec2{2.0, 1.0}, Vec2{5.0, 4.0}, Vec2{0.0, 1.0}}) {
    CHECK(side(s, x, 4.0) != side(back, x, 4.0));
    CHECK(project(s, x, 4.0).distance == Approx(-project(back, x, 4.0).distance));
    CHECK(project(s, x, 4.0).arc == Approx(s.length() - project(back, x, 4.0).arc));
  }
}

// Requires that places on an inclined surface, which round-off puts a little to either side of it, all count as +.
// Mutation that fails: no tolerance on the + side.
TEST_CASE("places on an inclined surface count as +") {
  const Vec2 from{1.1, 2.3}, to{4.2, 3.9};
  const Surface s = path({from, to});
  int below = 0;
  for (int k = -20; k <= 120; ++k) {
    const Vec2 x = from + 0.01 * k * (to - from);
    below += cross(to - from, x - from) < 0.0 ? 1 : 0;
    CHECK(side(s, x, 4.0));
  }
  CHECK(below > 5);
}

// Requires one and the same side all around the inner and the outer corner of a kink, for turns either way, where the
// nearest place is the kink itself, and for turns by more than a right angle, where the normal of
// one arm alone would err: a ring of places around it changes sides twice, on the two arms.
TEST_CASE("sides at a kink") {
  for (const double turn : {0.5, -0.5, 1.4, -1.4, 2.2, -2.2}) {
    const Vec2 end = Vec2{4.0, 4.0} + 3.0 * Vec2{std::cos(turn), std::sin(turn)};
    const Surface s = path({{1.0, 4.0}, {4.0, 4.0}, end});
    int changes = 0;
    constexpr int n = 360;
    const auto at = [&](int k) {
      const double angle = 2.0 * 3.14159265358979 * (k + 0.5) / n;
      return side(s, Vec2{4.0 + 0.8 * std::cos(angle), 4.0 + 0.8 * std::sin(angle)}, 4.0);
    };
    for (int k = 0; k < n; ++k) changes += at(k) != at(k + 1) ? 1 : 0;
    CHECK(changes == 2);
    CHECK(at(n / 4 + static_cast<int>(turn * 30)));
    CHECK_FALSE(at(3 * n / 4 + static_cast<int>(turn * 30)));
  }
}

// Requires that both ends grow: new vertices ahead of the end in pieces no longer than the spacing, arc lengths counted
// anew from the first vertex, normals as before, and what the old points remember stays with them.
TEST_CASE("surfaces grow at both ends") {
  Surface s = path({{1.0, 2.0}, {2.0, 2.0}});
  s.points[0].memory.slip = 7.0;
  s.vertices[0].w = {5.0, 6.0};
  extend(s, true, {3.0, 2.0}, 0.5);
  CHECK(s.length() == Approx(2.0));
  CHECK(s.points.size() == 4);
  CHECK(s.points[0].memory.slip == 7.0);
  CHECK((s.vertices.back().x - Vec2{3.0, 2.0}).norm() < 1e-15);
  extend(s, false, {0.1, 2.0}, 0.5);
  CHECK(s.points.size() == 6);
  CHECK(s.length() == Approx(2.9));
  CHECK((s.vertices.front().x - Vec2{0.1, 2.0}).norm() < 1e-15);
  CHECK((s.vertices[1].x - Vec2{0.55, 2.0}).norm() < 1e-15);
  CHECK(s.points[2].memory.slip == 7.0);
  CHECK(s.vertices[2].w == Vec2{5.0, 6.0});
  CHECK(s.points[2].arc == Approx(1.15));
  for (const SurfacePoint& point : s.points) CHECK((point.n - Vec2{0.0, 1.0}).norm() < 1e-14);
  extend(s, true, {3.0, 2.9}, 0.5);
  CHECK(s.points.size() == 8);
  CHECK((s.points.back().n - Vec2{-1.0, 0.0}).norm() < 1e-15);
}

// Requires that geometry follows vertices that have moved: lengths, normals and arc lengths are those of the new
// places.
TEST_CASE("geometry follows the vertices") {
  Surface s = path({{1.0, 2.0}, {2.0, 2.0}});
  s.vertices[1].x = {1.5, 2.5};
  update_geometry(s);
  CHECK(s.length() == Approx(std::sqrt(2.0)));
  CHECK((s.points[0].n - Vec2{-1.0, 1.0} / std::sqrt(2.0)).norm() < 1e-15);
  CHECK((s.points[1].n - Vec2{1.0, 1.0} / std::sqrt(2.0)).norm() < 1e-15);
  CHECK((s.vertices[1].n - Vec2{0.0, 1.0}).norm() < 1e-15);
  CHECK((s.points[1].x - Vec2{1.75, 2.25}).norm() < 1e-15);
}
