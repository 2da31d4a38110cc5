#include "quasistatic/intact_body.hpp"

#include <algorithm>
#include <cmath>

#include "state/rebuild.hpp"
#include "state/stiffness.hpp"

namespace strata {
namespace {

// The node across the mirror line x = width/2.
int mirror_node(const Grid& g, int node) {
  return g.node(g.nx - g.column(node), g.row(node));
}

// The record across the mirror line: the other side of the fracture, the same side of everything else.
int mirror_record(const State& state, int record) {
  const Copies& copies = state.copies;
  const int node = copies.node_of_record[static_cast<std::size_t>(record)];
  const int c = copies.cut_of_node[static_cast<std::size_t>(node)];
  if (c < 0) return mirror_node(state.grid, node);
  const CutNode& cut = copies.cut[static_cast<std::size_t>(c)];
  const auto at = std::find(cut.records.begin(), cut.records.end(), record);
  if (at == cut.records.end()) return record;  // not in use
  const SideWord key = cut.keys[static_cast<std::size_t>(at - cut.records.begin())];
  const int found = record_of(copies, mirror_node(state.grid, node), key ^ cut.fracture);
  if (found < 0) throw std::logic_error("a record has no image across the mirror line");
  return found;
}

// Lets the left half stand for the block: twice.
void weigh_halves(const Scene& scene, Particles& p) {
  for (std::size_t q = 0; q < p.size(); ++q) p.V[q] *= p.x[q] < 0.5 * scene.domain.width_m ? 2.0 : 0.0;
}

// Ties the corner unknowns that rigid motion needs held, so that K is regular.
void hold_rigid_motion(const Scene& scene, const Grid& grid, bool halved, std::vector<Master>& masters) {
  const bool x_held = halved || scene.domain.holds_x(), y_held = scene.domain.holds_y();
  const auto hold = [&](int node, bool x) {
    for (Master& master : masters) {
      if (master.record == node) (x ? master.x : master.y) = 0.0;
    }
  };
  if (!x_held) hold(grid.node(0, 0), true);
  if (!y_held) hold(grid.node(0, 0), false);
  if (!x_held && !y_held) hold(grid.node(grid.nx, 0), false);
}

}  // namespace

std::vector<Master> mirrored(const State& state, std::vector<Master> masters) {
  const Grid& g = state.grid;
  const std::vector<Master> edges = masters;
  for (Master& master : masters) {
    const int node = state.copies.node_of_record[static_cast<std::size_t>(master.record)];
    const int column = g.column(node);
    if (2 * column < g.nx) continue;
    const int image = mirror_record(state, master.record);
    if (image == master.record) {  // on the line and not split by the fracture
      if (2 * column == g.nx) master.x = 0.0;
    } else if (2 * column > g.nx || master.record > image) {
      const Master& beyond = edges[static_cast<std::size_t>(image)];  // may itself be tied to an edge
      master = {beyond.record, -master.x * beyond.x, master.y * beyond.y};
    }
  }
  return masters;
}

IntactBody::IntactBody(const Scene& scene, const Rocks& rocks, const State& state, bool halved) : halved_(halved) {
  State intact;
  intact.grid = state.grid;
  intact.particles = state.particles;
  points_ = intact.particles.next_id;
  if (halved) weigh_halves(scene, intact.particles);
  rebuild_copies(scene, intact);
  masters_ = halved ? mirrored(intact, intact.masters) : intact.masters;
  hold_rigid_motion(scene, state.grid, halved, masters_);
  factor_ = TreeFactor(assemble_stiffness(scene, rocks, intact, masters_),
                       "the stiffness of the intact block is singular: its edges leave a motion free");
}

}  // namespace strata
