// Surfaces of discontinuity: the fracture and the interfaces are the same kind of polyline under different laws.
// This is geometry and memory only; what happens on a surface is in interfaces/ and flow/.
#pragma once

#include <vector>

#include "scene/scene.hpp"
#include "state/types.hpp"

namespace strata {

// A place on a surface. Quadrature points stand at the middle of segments, vertices at their ends.
struct SurfacePoint {
  Vec2 x = Vec2::Zero();         // position (m)
  Vec2 n = Vec2::Zero();         // unit normal, from the - to the + side
  double A = 0.0;                // length of its piece of surface (m)
  double arc = 0.0;              // arc length from the first vertex (m)
  Vec2 w = Vec2::Zero();         // jump u(+) - u(-) since the in-situ state (m)
  Vec2 u = Vec2::Zero();         // displacement from x under kinematics = "total", where x stays (m)
  Vec2 reaction = Vec2::Zero();  // what the law exerts on the + face (Pa)
  Vec2 in_situ = Vec2::Zero();   // what the - side exerted on the + face in the in-situ state, -sigma_0 n (Pa)
  Vec2 bonded = Vec2::Zero();    // jump that its neighbours' splitting had opened here when it split: no part of w (m)
  double P = 0.0;                // fluid pressure (Pa)
  InterfaceLaw::Memory memory;   // what its law remembers beside
  int column = 0;                // the grid column (or row) an interface's point belongs to
  SideWord sides = 0;            // sides of the other surfaces; its own bit is clear
  bool split = false;            // two sides exist here: a law acts. Intact and bonded places are not split
  double failed_s = -1.0;        // when a bonded place let go (s); -1 while it has not, and where nothing was bonded

  double opening() const { return w.dot(n); }
  double closing_stress() const { return in_situ.dot(n); }
};

struct Surface {
  enum class Kind { fracture, interface };
  Kind kind = Kind::interface;
  int bit = 0;                         // its place in a SideWord
  std::size_t law = 0;                 // index into Scene::laws (interfaces)
  std::vector<SurfacePoint> vertices;  // n + 1
  std::vector<SurfacePoint> points;    // n, one a segment

  SideWord mask() const { return SideWord{1} << bit; }
  double length() const { return vertices.back().arc; }
};

// Where a place projects onto a surface whose end segments are extended straight on.
struct Projection {
  double distance = 0.0;  // signed, positive on the + side; a place on the surface counts as + (m)
  double arc = 0.0;  // arc length of the foot point: negative before the first vertex, > length() after the last (m)
};

/// Projects x (m) on the surface, extended straight by `reach` (m) at both ends: nearest point and side of it.
Projection project(const Surface& surface, const Vec2& x, double reach);

/// The one rule that tells sides apart, for nodes, particles and points alike: true on the + side of the surface.
bool side(const Surface& surface, const Vec2& x, double reach);

/// Sets normals, arc lengths, lengths and middles of all segments from the positions of the vertices (m).
void update_geometry(Surface& surface);

/// A surface along the polyline `path` (m), each leg in equal segments no longer than `spacing` (m).
Surface make_surface(Surface::Kind kind, int bit, const std::vector<Vec2>& path, double spacing);

/// Adds a segment from the last vertex (at_back) or the first one to `to` (m), in pieces no longer than `spacing` (m).
void extend(Surface& surface, bool at_back, const Vec2& to, double spacing);

/// Unit vector along which a tip points away from its fracture.
Vec2 tip_direction(const Surface& fracture, bool at_back);

}  // namespace strata
