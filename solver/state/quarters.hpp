// Particles that stand for their four quarters. Beside a fracture that turns cells need 4 x 4 points, elsewhere 2 x 2
// are enough; but without inertia the stiffness of the intact block is factored once and must not change as points
// become finer. Where refines_ahead(scene) it is that of 4 x 4 points in every cell from the start: a particle of 2 x 2
// a cell stands for its four quarters in it, and is divided into them before anything else there would tell the
// difference. Ids are those of the finest lattice, row by row from the lower left, and a particle has the one of its
// lower left quarter: sums in the order of ids have the same digits whenever particles were divided.
#pragma once

#include <array>
#include <vector>

#include "scene/points_across.hpp"
#include "state/grid.hpp"
#include "state/particles.hpp"

namespace strata {

// Tells which particles stand for four.
class Quarters {
 public:
  Quarters(const Scene& scene, const Grid& grid);

  /// Whether any may.
  bool in_use() const { return in_use_; }

  /// Whether particle q does: it is half a span long and not a quarter.
  bool whole(const Particles& p, std::size_t q) const {
    return in_use_ && p.half_x[q] > 0.1875 * grid_.span_x(grid_.column_at(p.x[q]));
  }

  /// Calls visit(place (m), half its sides (m), area (m^2)) for each point of the stiffness that particle q stands for.
  template <class Visit>
  void for_each_point(const Particles& p, std::size_t q, Visit visit) const {
    if (!whole(p, q)) return visit(Vec2{p.x[q], p.y[q]}, p.half(q), p.V[q]);
    for (const std::int32_t id : ids(p.id[q])) visit(place(id), Vec2{0.5 * p.half(q)}, 0.25 * p.V[q]);
  }

  /// How many points of the stiffness particles stand for.
  std::size_t points(const Particles& p) const;

  /// Divides particle q, which stands for four, into these.
  void divide(Particles& p, std::size_t q) const;

  /// Divides all that stand for four.
  void divide_all(Particles& p) const;

 private:
  // Ids of the quarters of the particle of this id, row by row from the lower left, and where they are (m).
  std::array<std::int32_t, 4> ids(std::int32_t first) const {
    const auto row = static_cast<std::int32_t>(x_.size());
    return {first, first + 1, first + row, first + row + 1};
  }
  Vec2 place(std::int32_t id) const {
    return {x_[static_cast<std::size_t>(id) % x_.size()], y_[static_cast<std::size_t>(id) / x_.size()]};
  }

  const Grid& grid_;
  bool in_use_;
  std::vector<double> x_, y_;  // of the finest lattice's columns and rows (m)
};

/// Divides particle q into its quarters, which continue its displacement linearly. The lower left one keeps its place
/// in the arrays and its id; the upper right, upper left and lower right ones follow at the arrays' end with these ids.
void split_in_four(Particles& p, std::size_t q, const std::array<std::int32_t, 3>& ids);

}  // namespace strata
