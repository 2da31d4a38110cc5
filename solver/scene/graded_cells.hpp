// Which cells a graded grid has (numerics.far_cell_m): fine ones, of cell_m, where the scene needs them, and between
// and beyond them cells that grow by at most 1.2 from one to the next, up to far_cell_m. Columns and rows are chosen
// each for themselves.
#pragma once

#include <array>
#include <vector>

#include "scene/scene.hpp"

namespace strata {

// Most that a span may be longer than its neighbour.
constexpr double span_growth = 1.2;
// Cells of cell_m on each side of the initial fracture and of the straight way it may grow.
constexpr double fine_cells_at_fracture = 10.0;
// And of an interface or a border of rocks elsewhere. The copies that an interface splits and the kink of strain at a
// border reach 1.5 cells to each side, and the functions of the nodes there 1.5 cells further.
constexpr double fine_cells_at_interface = 4.0;

// A stretch along an axis (m).
struct Stretch {
  double from = 0.0, to = 0.0;
};

/// Stretches along x (axis 0) or y (1) on which all cells are of cell_m: around the fracture and the straight way of
/// its tips, which ends at stop.tip_y_m or else at the block's edge, and around the places where rocks or interfaces
/// meet. In order, cut at the block's edges, none touching the next. Throws nothing.
std::vector<Stretch> fine_stretches(const Scene& scene, int axis);

/// Knots t_-1 ... t_n+2 (m; see state/grid.hpp) of an axis of `extent` m with cells of h m on the fine stretches (m,
/// in order) and up to `far` m elsewhere. Nodes of fine cells stand at multiples of h, as in a uniform grid; where
/// nothing is fine the first cell at the origin is. The spans of a stretch of growing cells are
///   s_k = min(h q^k, far), k = 1, 2, ... to the block's edge, the last one counted half,
///   s_k = min(h q^min(k, m+1-k), far), k = 1 ... m between two fine stretches,
/// with the fewest spans for which some q <= 1.2 makes them fill it, and this q. extent/h is a whole number and far >=
/// h. Throws nothing.
std::vector<double> graded_knots(double extent, double h, double far, const std::vector<Stretch>& fine);

/// Knots along x (axis 0) or y (1) of a scene's grid; none where it is uniform. Throws nothing.
std::vector<double> scene_knots(const Scene& scene, int axis);

}  // namespace strata
