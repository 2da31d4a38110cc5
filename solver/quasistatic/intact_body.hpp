// The block without its surfaces, factored once: everything that surfaces add is expressed by jumps against it.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "quasistatic/tree_factor.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// The ties of `masters` with the mirror's added: records on the right half and the right face of the fracture follow
/// those on the left, u_x(right) = -u_x(left), u_y(right) = u_y(left); what lies on the mirror line uncut has no u_x.
std::vector<Master> mirrored(const State& state, std::vector<Master> masters);

// K of the intact block, factored.
struct IntactBody {
  /// Assembles and factors K from the state's particles with all surfaces closed; halved: with the mirror's ties, the
  /// energy of the left half counted twice. Rigid motion that no edge holds is held at corners: loads are in balance.
  /// Throws NumericalFailure where the factorisation fails.
  IntactBody(const Scene& scene, const Rocks& rocks, const State& state, bool halved);

  bool halved;
  int points;                   // that K is summed over: next_id of these
  std::vector<Master> masters;  // of the grid's nodes
  TreeFactor factor;            // K = L L^T in one value for each unknown (N/m, m); loads on held ones must be 0

  int unknowns() const { return 2 * static_cast<int>(masters.size()); }
};

/// The in-situ state `loaded`: K u = f with K = sum_p V_p B^T C B of the bonded block without fracture under the
/// in-situ tractions on sides and top (and bottom, where it is no symmetry line), whatever the scene's edges are
/// afterwards; writes the stress to particles.in_situ (Pa). Rigid motion that no edge holds is taken out. Throws
/// NumericalFailure where the factorisation fails.
void load_in_situ(const Scene& scene, const Rocks& rocks, State& state);

}  // namespace strata
