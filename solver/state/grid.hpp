// The background grid: rectilinear cells, nodes at their corners, and one ring of ghost nodes around the block, which
// quadratic B-splines reach.
//
// Each node stands in the middle of its span of both axes, [t_i, t_i+1] with knots t: those of quadratic B-splines, of
// which node i's lives on the spans i - 1, i and i + 1. On a uniform grid t_i = (i - 1/2) h; on a graded one spans grow
// (scene/graded_cells.hpp). The first and the last node stand on the block's edges; ghosts' spans mirror those inside.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "scene/scene.hpp"

namespace strata {

struct Grid {
  int nx = 0;                                // cells along x
  int ny = 0;                                // cells along y
  double h = 0.0;                            // cell size (m); of the fine cells where the grid is graded
  std::vector<double> x_knots{}, y_knots{};  // t_-1 ... t_n+2 (m) of a graded axis; none: uniform

  int columns() const { return nx + 3; }
  int rows() const { return ny + 3; }
  int nodes() const { return columns() * rows(); }

  // Index of the node in column i (-1 ... nx + 1) and row j (-1 ... ny + 1).
  int node(int i, int j) const { return (j + 1) * columns() + i + 1; }
  int column(int node) const { return node % columns() - 1; }
  int row(int node) const { return node / columns() - 1; }

  // The nodes of columns i - 1 ... i + 1 and rows j - 1 ... j + 1, row by row from the lower left.
  std::array<int, 9> around(int i, int j) const {
    std::array<int, 9> nodes{};
    for (std::size_t n = 0; n < 9; ++n)
      nodes[n] = node(i - 1 + static_cast<int>(n % 3), j - 1 + static_cast<int>(n / 3));
    return nodes;
  }

  // Coordinate (m) of the nodes of column i (-1 ... nx + 1) or row j.
  double x(int i) const { return node_at(x_knots, i); }
  double y(int j) const { return node_at(y_knots, j); }

  // Length (m) of the span of column i (-1 ... nx + 1) or row j.
  double span_x(int i) const { return span(x_knots, i); }
  double span_y(int j) const { return span(y_knots, j); }

  // Column (or row) whose span holds a coordinate (m): that of the nearest node on a uniform grid. Outside the block it
  // is that of a ghost or, on a uniform grid, one still farther out.
  int column_at(double x) const { return holding(x_knots, x); }
  int row_at(double y) const { return holding(y_knots, y); }

  // The same, found at once where it is `guess` (0 ... nx, or ny).
  int column_at(double x, int guess) const { return holding(x_knots, x, guess); }
  int row_at(double y, int guess) const { return holding(y_knots, y, guess); }

  // Column (row) of the node before a coordinate (m): that of the cell, from node to node, that it is in.
  int cell_along_x(double x) const { return column_at(x) - (x < this->x(column_at(x)) ? 1 : 0); }
  int cell_along_y(double y) const { return row_at(y) - (y < this->y(row_at(y)) ? 1 : 0); }

  // True where all spans that meet the square of `reach` m around a place (m) are of h.
  bool fine_around(double x, double y, double reach) const {
    return fine(x_knots, nx, x - reach, x + reach) && fine(y_knots, ny, y - reach, y + reach);
  }

 private:
  double node_at(const std::vector<double>& t, int i) const {
    const auto k = static_cast<std::size_t>(i) + 1;
    return t.empty() ? i * h : 0.5 * (t[k] + t[k + 1]);
  }
  double span(const std::vector<double>& t, int i) const {
    const auto k = static_cast<std::size_t>(i) + 1;
    return t.empty() ? h : t[k + 1] - t[k];
  }
  int holding(const std::vector<double>& t, double x) const {
    if (t.empty()) return static_cast<int>(std::floor(x / h + 0.5));
    return static_cast<int>(std::upper_bound(t.begin() + 1, t.end() - 1, x) - t.begin()) - 2;
  }
  int holding(const std::vector<double>& t, double x, int guess) const {
    const auto k = static_cast<std::size_t>(guess) + 1;
    return k + 1 < t.size() && t[k] <= x && x < t[k + 1] ? guess : holding(t, x);
  }
  bool fine(const std::vector<double>& t, int n, double from, double to) const {
    if (t.empty()) return true;
    for (int i = std::max(0, holding(t, from)); i <= std::min(n, holding(t, to)); ++i) {
      if (std::abs(span(t, i) - h) > 1e-6 * h) return false;
    }
    return true;
  }
};

// The spans of an axis as arrays over its columns (rows) -1 ... n + 1: nodes' coordinates (m), 1/length (1/m), and
// 1/(1 + length of the span before (after)/own length).
struct SpanTable {
  std::vector<double> node, per_length, share_before, share_after;
};

/// The scene's grid: uniform, or graded where it has numerics.far_cell_m (see scene/graded_cells.hpp). Throws nothing.
Grid make_grid(const Scene& scene);

// A point along an axis and the length it stands for (m).
struct GridPoint {
  double at = 0.0, length = 0.0;
};

/// The points of `across` (2, 3 or 4) particles a cell along an axis. In fractions c = (k + 1/2)/across of a cell from
/// node i to node i + 1 with spans s_i, s_i+1: x_i + c s_i in the first half, x_i+1 - (1 - c) s_i+1 in the second one,
/// and the knot between the spans at c = 1/2, with lengths s_i/across, s_i+1/across and the mean of both. In each span
/// they are symmetric about its middle: what is linear on every span, as the derivatives of shape functions are, is
/// integrated exactly. Lattices of (k + 1/2) h/across where the grid is uniform. Throws nothing.
enum class Axis { x, y };
std::vector<GridPoint> points_along(const Grid& grid, Axis axis, int across);

/// The spans of the grid's columns (x) or rows (y). Throws nothing.
SpanTable spans_along(const Grid& grid, Axis axis);

}  // namespace strata
