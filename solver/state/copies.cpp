#include "state/copies.hpp"

#include <algorithm>

namespace strata {

SideWord CutNode::key(SideWord sides) const {
  const SideWord all = sides & mask;
  const SideWord interfaces = all & ~fracture;
  const bool everywhere = (mask & ~fracture) == 0;
  if (everywhere || std::find(entered.begin(), entered.end(), interfaces) != entered.end()) return all;
  return interfaces;
}

int record_of(const Copies& copies, int node, SideWord sides) {
  const int c = copies.cut_of_node[static_cast<std::size_t>(node)];
  if (c < 0) return node;
  const CutNode& cut = copies.cut[static_cast<std::size_t>(c)];
  const SideWord key = cut.key(sides);
  for (std::size_t k = 0; k < cut.keys.size(); ++k) {
    if (cut.keys[k] == key) return cut.records[k];
  }
  return -1;
}

}  // namespace strata
