#include "mechanics/quarter_forces.hpp"

#include "state/quarters.hpp"
#include "state/shape_functions.hpp"

namespace strata {

namespace {

using Forces = std::array<Vec2, 9>;  // on the nodes of a bin

void exert(const Stress& s, const Gradients& g, double V, Forces& f) {
  for (std::size_t n = 0; n < 9; ++n) f[n] -= V * s.on({g.N_x[n], g.N_y[n]});
}

// Stress at a place whose gradients are g.
Stress stress_at(const Elasticity& rock, const Gradients& g, const std::array<Vec2, 9>& u) {
  Vec2 d_x = Vec2::Zero(), d_y = Vec2::Zero();
  for (std::size_t n = 0; n < 9; ++n) d_x += g.N_x[n] * u[n], d_y += g.N_y[n] * u[n];
  return stress_of(rock, d_x.x(), d_y.x(), d_x.y(), d_y.y());
}

}  // namespace

void exert_quarters(const Scene& scene, const std::vector<Elasticity>& rocks, const std::vector<Vec2>& u,
                    State& state) {
  const Quarters quarters(scene, state.grid);
  if (!quarters.in_use()) return;
  const Particles& p = state.particles;
  for (const Bin& bin : state.bins) {
    std::array<Vec2, 9> moved;
    for (std::size_t n = 0; n < 9; ++n) moved[n] = u[static_cast<std::size_t>(bin.record[n])];
    Forces f;
    f.fill(Vec2::Zero());
    for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
         q += static_cast<std::size_t>(bin.stride)) {
      if (!quarters.whole(p, q)) continue;
      const Elasticity& rock = rocks[p.rock[q]];
      const auto at = [&](const Vec2& x, const Vec2& half) {
        return gradients_at(scene, state.grid, bin.i, bin.j, x, half);
      };
      const Stress own = stress_of(rock, p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
      exert(own, at({p.x[q], p.y[q]}, p.half(q)), -p.V[q], f);
      quarters.for_each_point(p, q, [&](const Vec2& x, const Vec2& half, double V) {
        const Gradients g = at(x, half);
        exert(stress_at(rock, g, moved), g, V, f);
      });
    }
    for (std::size_t n = 0; n < 9; ++n) {
      const auto r = static_cast<std::size_t>(bin.record[n]);
      state.sums.f_x[r] += f[n].x(), state.sums.f_y[r] += f[n].y();
    }
  }
}

}  // namespace strata
