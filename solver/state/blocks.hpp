// Blocks of neighbouring bins, whose particles are swept as lanes of vectors (see Bin).
#pragma once

#include <cstdint>
#include <vector>

#include "state/copies.hpp"

namespace strata {

/// Numbers the further copies of nodes anew, those with the same key side by side along a row, so that bins beside
/// surfaces form blocks as others do. Throws nothing.
void number_along_rows(Copies& copies, std::vector<Bin>& bins);

/// Groups neighbouring bins to blocks of most_lanes or a half, a quarter ... of it, whose particles stand side by side
/// in the order that is returned: bins are replaced, those with more particles than the block shares have the rest in
/// another bin. rock: of each particle, bin by bin. Throws nothing.
std::vector<std::size_t> make_blocks(const std::vector<std::uint8_t>& rock, std::vector<Bin>& bins);

}  // namespace strata
