#include "state/copies.hpp"

#include <algorithm>

namespace strata {

SideWord CutNode::key(SideWord sides) const {
  const SideWord all = sides & mask;
  const SideWord interfaces = all & ~fracture;
  const bool everywhere = (mask & ~fracture) == 0;
  const bool is_entered = everywhere || std::find(entered.begin(), entered.end(), interfaces) != entered.end();
  const SideWord own = is_entered ? all : interfaces;
  for (const auto& [corner, other] : joined) {
    if (corner == own) return other;
  }
  return own;
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
