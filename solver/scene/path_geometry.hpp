// Does a polyline meet itself?
#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <utility>
#include <vector>

namespace strata {

using Point = std::array<double, 2>;

/// Least distance (m) between the segments a0 a1 and b0 b1, 0 where they cross. All points in m. Throws nothing.
double segment_distance(const Point& a0, const Point& a1, const Point& b0, const Point& b1);

/// The first two segments of a path that cross, touch or double back, counted from 0 by their first points, or nothing.
/// path_m: points in m, no two neighbours the same; tolerance_m: distance below which segments touch. Throws nothing.
std::optional<std::pair<std::size_t, std::size_t>> self_contact(const std::vector<Point>& path_m, double tolerance_m);

}  // namespace strata
