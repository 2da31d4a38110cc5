#include "state/copies.hpp"

#include <algorithm>

namespace strata {

SideWord CutNode::key(SideWord sides) const {
  const SideWord all = sides & mask, interfaces = all & ~fracture;
  const bool everywhere = (mask & ~fracture) == 0;
  const SideWord own = everywhere || std::ranges::count(entered, interfaces) > 0 ? all : interfaces;
  const auto corner = std::ranges::find(joined, own, [](const auto& pair) { return pair[0]; });
  return corner == joined.end() ? own : (*corner)[1];
}

int record_of(const Copies& copies, int node, SideWord sides) {
  const int c = copies.cut_of_node[static_cast<std::size_t>(node)];
  if (c < 0) return node;
  const CutNode& cut = copies.cut[static_cast<std::size_t>(c)];
  const auto at = std::ranges::find(cut.keys, cut.key(sides));
  return at == cut.keys.end() ? -1 : cut.records[static_cast<std::size_t>(at - cut.keys.begin())];
}

}  // namespace strata
