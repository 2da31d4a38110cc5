#include "quasistatic/intact_body.hpp"

#include <algorithm>
#include <cmath>

#include "state/particle_loop.hpp"
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
  const int node = copies.node(record);
  const CutNode* cut = copies.cut_at(node);
  if (cut == nullptr) return mirror_node(state.grid, node);
  const auto key = cut->key_of(record);
  if (!key) return record;  // not in use
  const int found = record_of(copies, mirror_node(state.grid, node), *key ^ cut->fracture);
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

// Adds the force of a uniform traction t (Pa) on 1/parts of an edge of `length` m to f, applied at x.
void load_point(const Scene& scene, const State& state, const Vec2& x, const Vec2& t, double length, int parts,
                Eigen::VectorXd& f) {
  const Grid& g = state.grid;
  const int i = std::min(g.column_at(x.x()), g.nx), j = std::min(g.row_at(x.y()), g.ny);
  const Gradients weights = gradients_at(scene, g, i, j, x, Vec2::Zero());
  for (std::size_t node = 0; node < 9; ++node) {
    const int record = g.node(i + static_cast<int>(node % 3) - 1, j + static_cast<int>(node / 3) - 1);
    for (int component = 0; component < 2; ++component) {
      const Unknown at = unknown_of(state.masters, record, component);
      if (at.index >= 0) f[at.index] += at.factor * weights.N[node] * t[component] * length / parts;
    }
  }
}

// Adds the force of a uniform traction t (Pa) on the straight edge from a to b to f, at the coordinates at which the
// particles beside it stand: a uniform stress in these is then in equilibrium with it at every node.
void load_edge(const Scene& scene, const State& state, const Vec2& a, const Vec2& b, const Vec2& t,
               Eigen::VectorXd& f) {
  const Grid& g = state.grid;
  const bool along_x = a.y() == b.y();
  const int across = static_cast<int>(std::lround(std::sqrt(scene.numerics.particles_per_cell)));
  if ((along_x ? g.x_knots : g.y_knots).empty()) {
    const int n = across * (along_x ? g.nx : g.ny);
    for (int k = 0; k < n; ++k) load_point(scene, state, a + (b - a) * ((k + 0.5) / n), t, (b - a).norm(), n, f);
    return;
  }
  for (const GridPoint& s : points_along(g, along_x ? Axis::x : Axis::y, across))
    load_point(scene, state, along_x ? Vec2{s.at, a.y()} : Vec2{a.x(), s.at}, t, s.length, 1, f);
}

}  // namespace

std::vector<Master> mirrored(const State& state, std::vector<Master> masters) {
  const Grid& g = state.grid;
  const std::vector<Master> edges = masters;
  for (Master& master : masters) {
    const int node = state.copies.node(master.record);
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

IntactBody::IntactBody(const Scene& scene, const Rocks& rocks, const State& state, bool halved)
    : halved(halved), points(state.particles.next_id) {
  State intact;
  intact.grid = state.grid;
  intact.particles = state.particles;
  if (halved) weigh_halves(scene, intact.particles);
  rebuild_copies(scene, intact);
  masters = halved ? mirrored(intact, intact.masters) : intact.masters;
  hold_rigid_motion(scene, state.grid, halved, masters);
  factor = TreeFactor(assemble_stiffness(scene, rocks, intact, masters),
                      "the stiffness of the intact block is singular: its edges leave a motion free");
}

void load_in_situ(const Scene& scene, const Rocks& rocks, State& state) {
  Scene loaded = scene;
  loaded.domain.sides = Edge::traction;
  loaded.domain.top = Edge::traction;
  // uGIMP particles start between nodes, where they weigh as points do. Those that reach over an edge's by round-off
  // would leave the ghosts beyond it all but free.
  if (loaded.numerics.shape == Numerics::Shape::gimp) loaded.numerics.shape = Numerics::Shape::linear;
  rebuild_copies(loaded, state);
  const IntactBody body(loaded, rocks, state, false);  // the loads are in balance: what it holds costs no reaction
  state.masters = body.masters;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(body.unknowns());
  const double horizontal = scene.in_situ.horizontal_Pa.number, vertical = scene.in_situ.vertical_Pa.number;
  const Stretch x = scene.domain.along_x(), y = scene.domain.along_y();
  const Vec2 corners[4] = {{x.from, y.from}, {x.to, y.from}, {x.to, y.to}, {x.from, y.to}};
  load_edge(loaded, state, corners[0], corners[3], {horizontal, 0.0}, f);
  load_edge(loaded, state, corners[1], corners[2], {-horizontal, 0.0}, f);
  load_edge(loaded, state, corners[3], corners[2], {0.0, -vertical}, f);
  if (scene.domain.bottom == Edge::traction) load_edge(loaded, state, corners[0], corners[1], {0.0, vertical}, f);
  const Eigen::VectorXd u = body.factor.solve(f);
  Particles& p = state.particles;
  for_each_particle(loaded, state, state.bins, [&](const Bin& bin, std::size_t q, const Gradients& g) {
    double e[2][2] = {};
    for (std::size_t n = 0; n < 9; ++n) {
      for (int component = 0; component < 2; ++component) {
        const Unknown at = unknown_of(state.masters, bin.record[n], component);
        const double value = at.index < 0 ? 0.0 : at.factor * u[at.index];
        e[component][0] += value * g.N_x[n], e[component][1] += value * g.N_y[n];
      }
    }
    p.in_situ[q] =
        p.in_situ[q] + -1.0 * edges_stress(scene) + stress_of(rocks[p.rock[q]], e[0][0], e[0][1], e[1][0], e[1][1]);
  });
}

}  // namespace strata
