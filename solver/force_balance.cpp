#include "force_balance.hpp"

#include <cmath>

#include "explicit/transfers.hpp"
#include "interfaces/surface_tractions.hpp"
#include "state/round_off.hpp"

namespace strata {
namespace {

// D^T r A of split places and of the springs of tips.
void add_reactions(State& state) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const std::vector<SurfacePoint>& points = state.surfaces[k].points;
    for (std::size_t q = 0; q < points.size(); ++q) {
      if (points[q].split) add_traction(state.point_stencils[k][q], points[q].reaction, points[q].A, state.sums);
    }
  }
  for (const TipTie& tie : state.ties) {
    SurfaceStencil stencil;  // one node's two copies
    stencil.plus[0] = tie.plus, stencil.minus[0] = tie.minus, stencil.N[0] = 1.0;
    add_traction(stencil, tie.s.reaction, 1.0, state.sums);
  }
}

}  // namespace

void watch_forces(const Scene& scene, const Rocks& rocks, State& state) {
  const NodalSums kept = state.sums;
  particles_to_grid(scene, rocks, state);
  update_stencil_weights(scene, state);
  NodalSums rock = state.sums;
  for (std::size_t r = 0; r < rock.size(); ++r) state.sums[r].f_x = state.sums[r].f_y = 0.0;
  add_body_force(scene, state);
  add_net_tractions(state);
  NodalSums given = state.sums;  // the scale: with reactions nothing is left of the load on faces that stay closed
  add_reactions(state);
  fold_to_masters(state, rock);
  fold_to_masters(state, given);
  fold_to_masters(state, state.sums);
  double left = 0.0, load = 0.0;
  for (std::size_t r = 0; r < rock.size(); ++r) {
    const Master& master = state.masters[r];
    if (master.record != static_cast<int>(r) || !(rock[r].m > 0.0)) continue;
    const Vec2 free{std::abs(master.x), std::abs(master.y)};  // what an edge holds takes any force
    const Vec2 of_rock{rock[r].f_x, rock[r].f_y}, on_it{state.sums[r].f_x, state.sums[r].f_y};
    note_largest(left, free.cwiseProduct(of_rock + on_it).norm());
    note_largest(load, free.cwiseProduct(Vec2{given[r].f_x, given[r].f_y}).norm());
  }
  state.sums = kept;
  const double nothing = round_off(scene, state).stress * state.grid.h;  // of a cell's face
  if (load > nothing || !(left <= nothing)) note_largest(state.monitors.force_balance, left / load);
}

}  // namespace strata
