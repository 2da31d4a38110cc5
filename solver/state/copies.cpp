#include "state/copies.hpp"

namespace strata {

int record_of(const Copies& copies, int node, SideWord sides) {
  const int c = copies.cut_of_node[static_cast<std::size_t>(node)];
  if (c < 0) return node;
  const CutNode& cut = copies.cut[static_cast<std::size_t>(c)];
  const SideWord key = sides & cut.mask;
  for (std::size_t k = 0; k < cut.keys.size(); ++k) {
    if (cut.keys[k] == key) return cut.records[k];
  }
  return -1;
}

}  // namespace strata
