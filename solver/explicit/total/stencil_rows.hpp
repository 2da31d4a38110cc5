// Rows of the operator -M^-1 K under kinematics = "total", from the weights of the particles themselves.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// A row of -M^-1 K: its blocks by ascending offset.
using StencilRow = std::vector<StencilEntry>;

// The rows of all masters. Slots whose surroundings are the same (particles, weights and copies around them) share one.
struct StencilRows {
  std::vector<StencilRow> rows;
  std::vector<int> row_of_slot;  // -1: no master of a mass stands there
};

/// Where the nodal quantities of a state stand; its copies and masters must be built.
Slots make_slots(const State& state);

/// Rows of -M^-1 K with K = sum_p V_p B^T C B (add_stiffness()) and lumped masses, rows and columns folded to masters.
/// Surroundings count as the same where they agree to 1.5e-11 of a cell.
StencilRows make_stencil_rows(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state,
                              const Slots& slots);

/// Whether `long_row`, with what it reaches beyond the block's sides mirrored (u_x odd, u_y even), is `own`, the row of
/// `slot`, to 1e-12 of its largest entry; rows of components that a side holds are left out.
bool same_by_images(const Grid& grid, const Slots& slots, int slot, const StencilRow& long_row, const StencilRow& own);

/// Column of the grid in which a slot stands: -2 ... nx + 2.
inline int column_of(const Slots& slots, int slot) {
  return slot % slots.stride - Slots::ring;
}

/// The slot inside the block that one beyond a side mirrors; the slot itself where it lies within.
int mirrored_slot(const Grid& grid, const Slots& slots, int slot);

}  // namespace strata
