#include "interfaces/tip_ties.hpp"

#include <algorithm>
#include <cmath>

#include "interfaces/failure.hpp"
#include "state/rebuild.hpp"

namespace strata {
namespace {

// Measured: with c = 0.11 the K_I of the pressurised crack in a 40 m block (tip at 8, 8.25, 8.5, 8.75, 9 m, 1 m cells)
// is 0.14, 0.15, 0.14, 0.10, 0.16 % above the reference; 0.07 gives up to 0.7 % more and 0.16 up to 0.4 % less within
// the cell, and without springs K_I by J jumps by 6 %. Hat functions need about twice the spring.
double tip_tie_coefficient(const Scene& scene) {
  return scene.numerics.shape == Numerics::Shape::bspline2 ? 0.11 : 0.22;
}

// Nearer than this to the tip (in cells) a node counts as standing on it, farther than 1 - this as a whole cell behind.
constexpr double at_a_node_cells = 0.02;

double spline(double f) {
  f = std::abs(f);
  if (f < 0.5) return 0.75 - f * f;
  return f < 1.5 ? 0.5 * (1.5 - f) * (1.5 - f) : 0.0;
}

double energy(const TipTie& tie) {
  return 0.5 * tie.stiffness * tie.s.w.squaredNorm();
}

// The spring of a node pair behind a tip, or one of no stiffness.
TipTie make_tie(double c, const Elasticity& rock, const State& state, int node, const Tip& tip) {
  const bool at_back = tip.at_back;
  const Grid& g = state.grid;
  const Surface& fracture = state.fracture();
  TipTie tie;
  tie.node = node;
  tie.s.x = Vec2{g.x(g.column(node)), g.y(g.row(node))};
  tie.s.n = at_back ? fracture.points.back().n : fracture.points.front().n;
  tie.s.A = 1.0;
  tie.s.split = true;
  tie.s.sides = sides_ahead(state, tip);  // rock behind an interface that is apart is cut through
  const Projection on = project(fracture, tie.s.x, extension(g));
  const double behind = (at_back ? fracture.length() - on.arc : on.arc) / g.h;
  if (behind <= at_a_node_cells || behind >= 1.0 - at_a_node_cells) return tie;
  tie.stiffness = c * rock.E_prime * (1.0 - behind) / behind * spline(on.distance / g.h);
  tie.plus = record_of(state.copies, node, tie.s.sides | fracture.mask());
  tie.minus = record_of(state.copies, node, tie.s.sides & ~fracture.mask());
  if (tie.plus < 0 || tie.minus < 0 || tie.plus == tie.minus) tie.stiffness = 0.0;
  return tie;
}

}  // namespace

void update_tip_ties(const Scene& scene, const Rocks& rocks, State& state) {
  std::vector<TipTie> old = std::move(state.ties);
  state.ties.clear();
  for (const Tip& tip : state.tips) {
    const Vec2 at = tip_position(state, tip);
    const Elasticity& rock = rocks[rock_at(scene, place_ahead(state, tip))];
    for (const CutNode& cut : state.copies.cut) {
      if (cut.fracture == 0 || cut.records.size() < 2) continue;
      const int node = state.copies.node(cut.records.front());
      const Vec2 x{state.grid.x(state.grid.column(node)), state.grid.y(state.grid.row(node))};
      // A tied node is less than a cell behind the tip and no more than 1.5 cells across: never as far as this.
      if ((x - at).norm() > 3.0 * state.grid.h) continue;
      TipTie tie = make_tie(tip_tie_coefficient(scene), rock, state, node, tip);
      if (tie.stiffness == 0.0) continue;
      const auto before = std::find_if(old.begin(), old.end(), [node](const TipTie& t) { return t.node == node; });
      if (before != old.end()) {
        tie.s.w = before->s.w;
        state.ledger.excess += energy(*before) - energy(tie);
        before->stiffness = 0.0;
      }
      state.ties.push_back(tie);
    }
  }
  for (const TipTie& tie : old) state.ledger.excess += energy(tie);
}

void rebuild(const Scene& scene, const Rocks& rocks, State& state) {
  rebuild_copies(scene, state);
  update_tip_ties(scene, rocks, state);
  if (scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics) state.bonds = find_bonds(scene, state);
}

}  // namespace strata
