#include "state/quarters.hpp"

#include "state/make_grid.hpp"

namespace strata {

Quarters::Quarters(const Scene& scene, const Grid& grid) : grid_(grid), in_use_(refines_ahead(scene)) {
  if (!in_use_) return;
  for (const GridPoint& column : points_along_x(grid, 4)) x_.push_back(column.at);
  for (const GridPoint& row : points_along_y(grid, 4)) y_.push_back(row.at);
}

std::size_t Quarters::points(const Particles& p) const {
  std::size_t n = p.size();
  for (std::size_t q = 0; in_use_ && q < p.size(); ++q) n += whole(p, q) ? 3 : 0;
  return n;
}

void Quarters::divide(Particles& p, std::size_t q) const {
  const std::array<std::int32_t, 4> all = ids(p.id[q]);
  const std::size_t further = p.size();
  split_in_four(p, q, {all[3], all[2], all[1]});
  for (const std::size_t k : {q, further, further + 1, further + 2}) {
    const Vec2 x = place(p.id[k]);
    p.x[k] = x.x(), p.y[k] = x.y();
  }
}

void Quarters::divide_all(Particles& p) const {
  const std::size_t before = p.size();
  for (std::size_t q = 0; in_use_ && q < before; ++q) {
    if (whole(p, q)) divide(p, q);
  }
}

void split_in_four(Particles& p, std::size_t q, const std::array<std::int32_t, 3>& ids) {
  p.m[q] *= 0.25, p.V[q] *= 0.25, p.half_x[q] *= 0.5, p.half_y[q] *= 0.5;
  const Vec2 quarter = p.half(q);
  const double x = p.x[q], y = p.y[q], u_x = p.u_x[q], u_y = p.u_y[q];
  for (int child = 3; child >= 0; --child) {
    std::size_t c = q;
    if (child > 0) {
      for_each_array(p, [q](auto& array) { array.push_back(array[q]); });
      c = p.size() - 1;
      p.id[c] = ids[static_cast<std::size_t>(3 - child)];
    }
    const double d_x = (child & 1) != 0 ? quarter.x() : -quarter.x(),
                 d_y = (child & 2) != 0 ? quarter.y() : -quarter.y();
    p.x[c] = x + d_x, p.y[c] = y + d_y;
    p.u_x[c] = u_x + p.g_xx[q] * d_x + p.g_xy[q] * d_y;
    p.u_y[c] = u_y + p.g_yx[q] * d_x + p.g_yy[q] * d_y;
  }
}

}  // namespace strata
