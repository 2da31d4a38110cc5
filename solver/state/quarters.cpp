#include "state/quarters.hpp"

namespace strata {

std::size_t Quarters::points(const Particles& p) const {
  std::size_t n = p.size();
  for (std::size_t q = 0; in_use_ && q < p.size(); ++q) n += whole(p, q) ? 3 : 0;
  return n;
}

void Quarters::divide(Particles& p, std::size_t q) const {
  const std::int32_t first = p.id[q], row = 4 * grid_.nx;
  split_in_four(p, q, {first + row + 1, first + row, first + 1});
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
