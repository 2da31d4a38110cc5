// The background grid: square cells, nodes at their corners, and one ring of ghost nodes around the block, which
// quadratic B-splines reach.
#pragma once

#include <cmath>

namespace strata {

struct Grid {
  int nx = 0;      // cells along x
  int ny = 0;      // cells along y
  double h = 0.0;  // cell size (m)

  int columns() const { return nx + 3; }
  int rows() const { return ny + 3; }
  int nodes() const { return columns() * rows(); }

  // Index of the node in column i (-1 ... nx + 1) and row j (-1 ... ny + 1).
  int node(int i, int j) const { return (j + 1) * columns() + i + 1; }
  int column(int node) const { return node % columns() - 1; }
  int row(int node) const { return node / columns() - 1; }

  // Column (or row) of the node nearest to a coordinate (m).
  int nearest(double x) const { return static_cast<int>(std::floor(x / h + 0.5)); }
};

}  // namespace strata
