// Particles that stand for their four quarters. Beside a fracture that turns cells need 4 x 4 points, elsewhere 2 x 2
// are enough; but without inertia the stiffness of the intact block is factored once and must not change as points
// become finer. Where refines_ahead(scene) it is that of 4 x 4 points in every cell from the start: a particle of 2 x 2
// a cell stands for its four quarters in it, and is divided into them before anything else there would tell the
// difference. Ids are those of the finest lattice, row by row from the lower left, and a particle has the one of its
// lower left quarter: sums in the order of ids have the same digits whenever particles were divided.
#pragma once

#include <array>

#include "scene/points_across.hpp"
#include "state/grid.hpp"
#include "state/particles.hpp"

namespace strata {

// Tells which particles stand for four.
class Quarters {
 public:
  Quarters(const Scene& scene, const Grid& grid) : grid_(grid), in_use_(refines_ahead(scene)) {}

  /// Whether any may.
  bool in_use() const { return in_use_; }

  /// Whether particle q does: it is half a span long and not a quarter.
  bool whole(const Particles& p, std::size_t q) const {
    return in_use_ && p.half_x[q] > 0.1875 * grid_.span_x(grid_.column_at(p.x[q]));
  }

  /// Calls visit(place (m), half its sides (m), area (m^2)) for each point of the stiffness that particle q stands for.
  template <class Visit>
  void for_each_point(const Particles& p, std::size_t q, Visit visit) const {
    const Vec2 x{p.x[q], p.y[q]};
    if (!whole(p, q)) return visit(x, p.half(q), p.V[q]);
    const Vec2 quarter = 0.5 * p.half(q);
    for (const double y : {-1.0, 1.0}) {
      for (const double side : {-1.0, 1.0})
        visit(Vec2{x.x() + side * quarter.x(), x.y() + y * quarter.y()}, quarter, 0.25 * p.V[q]);
    }
  }

  /// How many points of the stiffness particles stand for.
  std::size_t points(const Particles& p) const;

  /// Divides particle q, which stands for four, into these.
  void divide(Particles& p, std::size_t q) const;

  /// Divides all that stand for four.
  void divide_all(Particles& p) const;

 private:
  const Grid& grid_;
  bool in_use_;
};

/// Divides particle q into its quarters, which continue its displacement linearly. The lower left one keeps its place
/// in the arrays and its id; the upper right, upper left and lower right ones follow at the arrays' end with these ids.
void split_in_four(Particles& p, std::size_t q, const std::array<std::int32_t, 3>& ids);

}  // namespace strata
