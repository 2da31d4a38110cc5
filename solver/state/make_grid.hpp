// The grid of a scene, and the points at which integrals along its axes are sampled.
#pragma once

#include <vector>

#include "scene/scene.hpp"
#include "state/grid.hpp"

namespace strata {

/// The scene's grid: uniform, or graded where it has numerics.far_cell_m (see scene/graded_cells.hpp). Throws nothing.
Grid make_grid(const Scene& scene);

// A point along an axis and the length it stands for (m).
struct GridPoint {
  double at = 0.0, length = 0.0;
};

/// The points of `across` (2, 3 or 4) particles a cell along x. In fractions c = (k + 1/2)/across of a cell from node i
/// to node i + 1 with spans s_i, s_i+1: x_i + c s_i in the first half, x_i+1 - (1 - c) s_i+1 in the second one, and the
/// knot between the spans at c = 1/2, with lengths s_i/across, s_i+1/across and the mean of both. In each span they are
/// symmetric about its middle: what is linear on every span, as the derivatives of shape functions are, is integrated
/// exactly. Lattices of (k + 1/2) h/across where the grid is uniform. Throws nothing.
std::vector<GridPoint> points_along_x(const Grid& grid, int across);

/// The same along y.
std::vector<GridPoint> points_along_y(const Grid& grid, int across);

/// The spans of the grid's columns (x) or rows (y). Throws nothing.
enum class Axis { x, y };
SpanTable spans_along(const Grid& grid, Axis axis);

}  // namespace strata
