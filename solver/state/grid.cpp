#include "state/grid.hpp"

#include <cmath>

#include "scene/graded_cells.hpp"

namespace strata {
Grid make_grid(const Scene& scene) {
  const double h = scene.numerics.cell_m;
  Grid grid{static_cast<int>(std::lround(scene.domain.width_m / h)),
            static_cast<int>(std::lround(scene.domain.height_m / h)), h, scene_knots(scene, 0), scene_knots(scene, 1)};
  constexpr int ghosts = 4;  // knots beyond those between the nodes
  if (!grid.x_knots.empty()) grid.nx = static_cast<int>(grid.x_knots.size()) - ghosts;
  if (!grid.y_knots.empty()) grid.ny = static_cast<int>(grid.y_knots.size()) - ghosts;
  return grid;
}

std::vector<GridPoint> points_along(const Grid& grid, Axis axis, int across) {
  const std::vector<double>& t = axis == Axis::x ? grid.x_knots : grid.y_knots;
  const int n = axis == Axis::x ? grid.nx : grid.ny;
  std::vector<GridPoint> points;
  if (t.empty()) {
    const double side = grid.h / across;
    for (int k = 0; k < n * across; ++k) points.push_back({(k + 0.5) * side, side});
    return points;
  }
  for (int i = 0; i < n; ++i) {
    const auto k = static_cast<std::size_t>(i + 1);  // t[k] is t_i
    const double s = t[k + 1] - t[k], next = t[k + 2] - t[k + 1];
    for (int m = 0; m < across; ++m) {
      const double c = (m + 0.5) / across;
      if (2 * m + 1 < across) points.push_back({0.5 * (t[k] + t[k + 1]) + c * s, s / across});
      if (2 * m + 1 == across) points.push_back({t[k + 1], 0.5 * (s + next) / across});
      if (2 * m + 1 > across) points.push_back({0.5 * (t[k + 1] + t[k + 2]) - (1.0 - c) * next, next / across});
    }
  }
  return points;
}

SpanTable spans_along(const Grid& grid, Axis axis) {
  const int n = axis == Axis::x ? grid.nx : grid.ny;
  const auto span = [&](int i) { return axis == Axis::x ? grid.span_x(i) : grid.span_y(i); };
  // The outermost spans have no other beside them, and no place is in them.
  const auto share = [&](int i, int beside) {
    return beside < -1 || beside > n + 1 ? 0.5 : 1.0 / (1.0 + span(beside) / span(i));
  };
  SpanTable table;
  for (int i = -1; i <= n + 1; ++i) {
    table.node.push_back(axis == Axis::x ? grid.x(i) : grid.y(i));
    table.per_length.push_back(1.0 / span(i));
    table.share_before.push_back(share(i, i - 1)), table.share_after.push_back(share(i, i + 1));
  }
  return table;
}

}  // namespace strata
