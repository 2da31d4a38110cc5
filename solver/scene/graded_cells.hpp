// Which cells a graded grid has (numerics.far_cell_m): fine ones, of cell_m, where the scene needs them, and between
// and beyond them cells that grow by at most 1.2 from one to the next, up to far_cell_m; and cells that grow without
// bound over the rock beyond the block (domain.beyond_m). Columns and rows are chosen each for themselves.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <vector>

#include "scene/scene.hpp"

namespace strata {

// Most that a span may be longer than its neighbour.
constexpr double span_growth = 1.2;
// And beyond the block. What a fracture moves there falls off as its distance squared, and a cell is a fixed share of
// that distance.
constexpr double span_growth_beyond = 1.5;
// Cells of cell_m on each side of the initial fracture and of the straight way it may grow.
constexpr double fine_cells_at_fracture = 10.0;
// And of an interface or a border of rocks elsewhere. The copies that an interface splits and the kink of strain at a
// border reach 1.5 cells to each side, and the functions of the nodes there 1.5 cells further.
constexpr double fine_cells_at_interface = 4.0;

// The straight way along which a tip may grow.
struct GrowthWay {
  Point end{};          // m
  double length = 0.0;  // m
};

/// The ways of all tips that may grow, each in the direction of its end of the path: up to stop.tip_y_m (of the lower
/// to stop.lower_tip_y_m), or else to the block's edge; a tip that does not go up goes as far as the one that does.
std::vector<GrowthWay> ways_of_growth(const Scene& scene);

/// Stretches along x (axis 0) or y (1) on which all cells are of cell_m: around the fracture and the straight way of
/// its tips, which ends at stop.tip_y_m or else at the block's edge (or up to where the scene says,
/// numerics.fine_left_m and its like), and around the places where rocks or interfaces meet. In order, cut at the
/// block's edges, none touching the next.
std::vector<Stretch> fine_stretches(const Scene& scene, std::size_t axis);

// What an axis of a graded grid is to have (m).
struct Grading {
  double extent;                    // of the block, from 0 on; a whole number of cells of h
  double h, far;                    // cells of h on the fine stretches and up to far >= h elsewhere
  std::vector<Stretch> fine;        // in order
  double below = 0.0, above = 0.0;  // how far rock goes on beyond the block's two ends: 0, or at least 2 far
};

/// Knots t_-1 ... t_n+2 (m; see state/grid.hpp) of an axis. Nodes of fine cells stand at multiples of h, as in a
/// uniform grid; where nothing is fine the first cell at the origin is. The spans of a stretch of growing cells are
///   s_k = min(h q^k, far), k = 1, 2, ... to the block's edge, the last one counted half if rock ends there; else they
///   end with the half of a cell of h that reaches over the edge, and from the last of them, s_m, there follow
///   s_k = s_m r^(k-m), k = m + 1, ... to the end of the rock, the last one counted half,
///   s_k = min(h q^min(k, m+1-k), far), k = 1 ... m between two fine stretches,
/// each with the fewest spans for which some q <= 1.2, r <= 1.5 makes them fill it, and this q or r.
std::vector<double> graded_knots(const Grading& axis);

/// Knots along x (axis 0) or y (1) of a scene's grid; none where it is uniform.
std::vector<double> scene_knots(const Scene& scene, std::size_t axis);

/// Whether scene and grid are mirror-symmetric about the vertical through the fracture, and stay so: layers stacked
/// upwards, a straight vertical fracture in the middle of the block, columns that are their own mirror image, sides
/// held, no body force. (With loaded sides parts may slide antisymmetrically, which half a block would not see.) Makes
/// no grid.
bool mirror_symmetric(const Scene& scene);

}  // namespace strata
