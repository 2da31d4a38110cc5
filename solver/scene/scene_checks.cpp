#include "scene/scene_checks.hpp"

namespace strata {
void check_scene(const Scene&, const Positions&, Faults&) {}
}  // namespace strata
