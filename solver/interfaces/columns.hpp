// Columns of nodes across an interface, moved as one: their balance tells what the interface carries.
#pragma once

#include <array>

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// The rows (for a vertical interface: columns) of nodes that an interface splits when it lets go.
struct Band {
  bool along_x = true;
  int first = 0, last = 0;
  bool holds(int across) const { return across >= first && across <= last; }
};

/// The band of an interface. Throws nothing.
Band band_of(const Scene& scene, const State& state, const Surface& surface);

// The weight Phi = sum N_i over the band, and its gradient (1/m), of the three columns around a place.
struct ColumnWeights {
  std::array<int, 3> column{};
  std::array<double, 3> Phi{};
  std::array<Vec2, 3> grad{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
};

/// The weights at a place x (m) of a particle of half sides `half` (m). Throws nothing.
ColumnWeights column_weights(const Scene& scene, const Grid& g, const Band& band, const Vec2& x, const Vec2& half);

/// Gives the points of interfaces what the bonded block of the in-situ state `loaded` hands over there, as tractions
/// whose forces on the columns are those of the rock on the - side:
///   sum_s A_s Phi_c(x_s) t(x_s) = -sum_p V_p (sigma_p - sigma) grad Phi_c,  t(x) = sum_c Phi_c(x) t_c,
/// and -sigma n on top, with sigma the stress that balances the edges' tractions (Pa). A mean of the particles around
/// is up to 10 % off between unlike rocks, whose strain the splines make continuous. Springs that take compression keep
/// what they have. Throws NumericalFailure where the columns cannot be told apart.
void hand_over_in_situ(const Scene& scene, State& state);

}  // namespace strata
