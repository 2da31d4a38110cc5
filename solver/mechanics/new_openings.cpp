#include "mechanics/new_openings.hpp"

#include <algorithm>

#include "mechanics/surface_tractions.hpp"
#include "mechanics/total_base.hpp"
#include "mechanics/transfers.hpp"

namespace strata {

void open_new_points(const Scene& scene, const std::vector<Elasticity>& rocks, State& state) {
  constexpr int passes = 8;
  const Particles& p = state.particles;
  const std::vector<Vec2> u = nodes_from_particles(scene, p.u_x, p.u_y, passes, state);
  NodalMotion field(u.size());  // displacements in the place of velocities
  for (std::size_t r = 0; r < u.size(); ++r) field[r] = NodeMotion{u[r].x(), u[r].y(), 0.0, 0.0};
  particles_to_grid(scene, rocks, state);  // masses
  update_stencil_weights(scene, state);
  const auto open = [&](std::vector<SurfacePoint>& points, const std::vector<SurfaceStencil>& stencils) {
    for (std::size_t q = 0; q < points.size(); ++q) {
      SurfacePoint& s = points[q];
      if (s.w != Vec2::Zero()) continue;
      s.w = jump(stencils[q], field);
      s.w -= std::min(0.0, s.opening()) * s.n;  // of what was whole a moment ago no overlap is to be pushed back
    }
  };
  open(state.fracture().points, state.point_stencils.front());
  open(state.fracture().vertices, state.vertex_stencils.front());
}

}  // namespace strata
