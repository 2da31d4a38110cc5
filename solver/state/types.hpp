// Small types that every module of the solver shares.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <stdexcept>

namespace strata {

using Vec2 = Eigen::Vector2d;

// Which side of each surface a place is on: bit k is set on the + side of surface k.
using SideWord = std::uint32_t;

// In-plane stress, tension positive: s_xy is the tensor component.
struct Stress {
  double xx = 0.0;
  double yy = 0.0;
  double xy = 0.0;

  // Traction on a plane with unit normal n: sigma n (Pa).
  Vec2 on(const Vec2& n) const { return {xx * n.x() + xy * n.y(), xy * n.x() + yy * n.y()}; }
};

inline Stress operator+(const Stress& a, const Stress& b) {
  return {a.xx + b.xx, a.yy + b.yy, a.xy + b.xy};
}
inline Stress operator*(double c, const Stress& a) {
  return {c * a.xx, c * a.yy, c * a.xy};
}

// The numerics failed (exit status 3): what happened, when, and what to do about it.
struct NumericalFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

// The tangent that goes with a surface's normal n.
inline Vec2 tangent_of(const Vec2& n) {
  return {n.y(), -n.x()};
}

inline double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

}  // namespace strata
