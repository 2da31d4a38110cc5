// Static equilibrium of the condensed block with the laws of its split surfaces.
#pragma once

#include <array>
#include <vector>

#include "quasistatic/condensed.hpp"
#include "quasistatic/pivoting.hpp"

namespace strata {

struct Equilibrium {
  Eigen::VectorXd j;    // m
  Answers answers;      // one a place
  std::vector<Vec2> w;  // jump of each place (m)
  Pieces pieces;
  double energy = 0.0;         // potential energy: strain and laws less the work of the loads (J/m)
  double strain = 0.0;         // strain energy of the rock (J/m)
  double residual = 0.0;       // largest force out of balance over the largest load
  Eigen::VectorXd unbalanced;  // loads and reactions less S j (N/m)
  int iterations = 0;
};

/// The point of a surface, or the spring of a tip, that a place is. Throws nothing.
template <class AnyState>
auto& point_of(AnyState& state, const ContactPlace& place) {
  return place.tie >= 0 ? state.ties[static_cast<std::size_t>(place.tie)].s
                        : state.surfaces[place.surface].points[place.point];
}

/// The split places of a state and the springs of its tips, with the memory of friction as the state holds it.
/// Stencil weights must be up to date.
Places contact_places(const Scene& scene, const Rocks& rocks, const State& state, const Condensed& condensed);

/// Solves S j = sum_s A_s D_s^T (P n - t_in_situ + r(D j)) + condensed.load.jumps for the pressures that the state's
/// points hold, by Newton's method on the pieces of the laws (semismooth, by block pivoting). Where that does not end
/// by itself, friction's bounds are held fixed, so that the problem is the minimum of a convex energy (Newton with a
/// line search), and renewed until they agree with the normal reactions; and where that goes round too, a cohesion
/// falls to nothing (falling_cohesion.hpp): of several equilibria the one that this leads to. What is returned depends
/// on loads and memory only, not on `start` (the first guess, or empty). `factor` is reused where the pieces are the
/// same, and left for what follows. Throws NumericalFailure where parts of the block move freely, or where no
/// equilibrium is found.
Equilibrium solve_equilibrium(const State& state, const Condensed& condensed, const Places& places,
                              const Eigen::VectorXd& start, TangentFactor& factor);

/// Change of the opening at the fracture's points with the pressure at each of them (m/Pa), at an equilibrium.
Eigen::MatrixXd opening_per_pressure(const State& state, const Condensed& condensed, const Places& places,
                                     const Equilibrium& equilibrium, const TangentFactor& factor);

/// Rows of the jump's x and y at a stencil in terms of the jump unknowns. Throws nothing.
std::array<SparseRow, 2> jump_rows(const Condensed& condensed, const SurfaceStencil& stencil);

/// Jump (m) at a stencil for the jump unknowns j.
Vec2 jump_at(const Condensed& condensed, const SurfaceStencil& stencil, const Eigen::VectorXd& j);

}  // namespace strata
