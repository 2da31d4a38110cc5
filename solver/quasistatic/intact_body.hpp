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
class IntactBody {
 public:
  /// Assembles and factors K from the state's particles with all surfaces closed; halved: with the mirror's ties, the
  /// energy of the left half counted twice. Rigid motion that no edge holds is held at corners: loads are in balance.
  /// Throws NumericalFailure where the factorisation fails.
  IntactBody(const Scene& scene, const Rocks& rocks, const State& state, bool halved);

  /// K = L L^T in one value for each of the 2 x nodes unknowns (N/m, m); loads on held ones must be 0.
  const TreeFactor& factor() const { return factor_; }

  bool halved() const { return halved_; }
  int points() const { return points_; }                           // that K is summed over: next_id of these
  const std::vector<Master>& masters() const { return masters_; }  // of the grid's nodes
  int unknowns() const { return 2 * static_cast<int>(masters_.size()); }

 private:
  TreeFactor factor_;
  std::vector<Master> masters_;
  int points_ = 0;
  bool halved_ = false;
};

}  // namespace strata
