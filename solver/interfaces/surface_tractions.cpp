#include "interfaces/surface_tractions.hpp"

#include "state/shape_functions.hpp"

namespace strata {
namespace {

// A copy that no particle's shape function reaches has no motion of its own: there the node does not tell the sides
// apart.
void join_massless(const NodalSums& sums, SurfaceStencil& stencil) {
  for (std::size_t n = 0; n < 9; ++n) {
    if (stencil.plus[n] == stencil.minus[n]) continue;
    if (sums[static_cast<std::size_t>(stencil.plus[n])].m == 0.0) stencil.plus[n] = stencil.minus[n];
    if (sums[static_cast<std::size_t>(stencil.minus[n])].m == 0.0) stencil.minus[n] = stencil.plus[n];
  }
}

Vec2 velocity(const NodeMotion& motion) {
  return {motion.v_x, motion.v_y};
}

}  // namespace

void update_stencil_weights(const Scene& scene, State& state) {
  const bool spline = scene.numerics.shape == Numerics::Shape::bspline2;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const auto weigh_all = [&](const std::vector<SurfacePoint>& points, std::vector<SurfaceStencil>& stencils) {
      for (std::size_t q = 0; q < points.size(); ++q) {
        SurfaceStencil& s = stencils[q];
        s.N = spline ? gradients_of<QuadraticBspline>(state.grid, s.i, s.j, points[q].x, Vec2::Zero()).N
                     : gradients_of<Linear>(state.grid, s.i, s.j, points[q].x, Vec2::Zero()).N;
        join_massless(state.sums, s);
      }
    };
    weigh_all(state.surfaces[k].points, state.point_stencils[k]);
    weigh_all(state.surfaces[k].vertices, state.vertex_stencils[k]);
  }
}

Vec2 jump(const SurfaceStencil& stencil, const NodalMotion& motion) {
  Vec2 w = Vec2::Zero();
  for (std::size_t n = 0; n < 9; ++n) {
    if (stencil.plus[n] == stencil.minus[n]) continue;
    w += stencil.N[n] * (velocity(motion[static_cast<std::size_t>(stencil.plus[n])]) -
                         velocity(motion[static_cast<std::size_t>(stencil.minus[n])]));
  }
  return w;
}

Vec2 mean_velocity(const SurfaceStencil& stencil, const NodalMotion& motion) {
  Vec2 v = Vec2::Zero();
  for (std::size_t n = 0; n < 9; ++n) {
    v += 0.5 * stencil.N[n] *
         (velocity(motion[static_cast<std::size_t>(stencil.plus[n])]) +
          velocity(motion[static_cast<std::size_t>(stencil.minus[n])]));
  }
  return v;
}

void add_traction(const SurfaceStencil& stencil, const Vec2& t, double A, NodalSums& sums) {
  for (std::size_t n = 0; n < 9; ++n) {
    if (stencil.plus[n] == stencil.minus[n]) continue;
    const Vec2 f = stencil.N[n] * A * t;
    const NodalSums::Record plus = sums[static_cast<std::size_t>(stencil.plus[n])];
    const NodalSums::Record minus = sums[static_cast<std::size_t>(stencil.minus[n])];
    plus.f_x += f.x(), plus.f_y += f.y();
    minus.f_x -= f.x(), minus.f_y -= f.y();
  }
}

void add_net_tractions(State& state) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const auto& points = state.surfaces[k].points;
    for (std::size_t q = 0; q < points.size(); ++q) {
      const SurfacePoint& s = points[q];
      if (s.split) add_traction(state.point_stencils[k][q], s.P * s.n - s.in_situ, s.A, state.sums);
    }
  }
}

void follow_surfaces(State& state) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    Surface& surface = state.surfaces[k];
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      SurfacePoint& s = surface.points[q];
      if (!s.split) s.w += state.dt * jump(state.point_stencils[k][q], state.motion);
    }
    for (std::size_t q = 0; q < surface.vertices.size(); ++q) {
      const SurfaceStencil& stencil = state.vertex_stencils[k][q];
      surface.vertices[q].w += state.dt * jump(stencil, state.motion);
      surface.vertices[q].x += state.dt * mean_velocity(stencil, state.motion);
    }
    update_geometry(surface);
  }
}

}  // namespace strata
