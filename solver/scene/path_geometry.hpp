// Polylines: do they meet themselves, and where interfaces cut them.
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

#include "scene/scene.hpp"

namespace strata {

using Point = std::array<double, 2>;

/// Least distance (m) between the segments a0 a1 and b0 b1, 0 where they cross. All points in m. Throws nothing.
double segment_distance(const Point& a0, const Point& a1, const Point& b0, const Point& b1);

/// The first two segments of a path that cross, touch or double back, counted from 0 by their first points, or nothing.
/// path_m: points in m, no two neighbours the same; tolerance_m: distance below which segments touch. Throws nothing.
std::optional<std::pair<std::size_t, std::size_t>> self_contact(const std::vector<Point>& path_m, double tolerance_m);

/// The ends (m) of the legs of a straight line from one place to another (m) that interfaces with a law cut it into,
/// the last of them `to`: no piece of a fracture lies on both sides of one. Throws nothing but std::bad_alloc.
std::vector<Point> legs_between_interfaces(const Scene& scene, const Point& from, const Point& to);

}  // namespace strata
