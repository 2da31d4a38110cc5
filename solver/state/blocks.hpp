// Blocks of neighbouring bins, whose particles are swept as lanes of vectors (see Bin).
#pragma once

#include <cstdint>
#include <vector>

#include "state/copies.hpp"

namespace strata {

/// Numbers the further copies of nodes anew, those with the same key side by side along a row, so that bins beside
/// surfaces form blocks as others do. Throws nothing.
void number_along_rows(Copies& copies, std::vector<Bin>& bins);

/// Groups neighbouring bins to blocks of up to most_lanes and puts their particles side by side: bins are replaced,
/// those with more particles than the block shares have the rest in another bin, and `order` (the particles' indices,
/// bin by bin) is permuted; rock: of each particle by these indices. Throws nothing.
void make_blocks(const std::vector<std::uint8_t>& rock, std::vector<Bin>& bins, std::vector<std::size_t>& order);

}  // namespace strata
