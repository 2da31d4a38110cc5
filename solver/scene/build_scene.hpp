// From a flat list of keys and values to a scene.
#pragma once

#include "scene/entries.hpp"
#include "scene/faults.hpp"
#include "scene/scene.hpp"

namespace strata {

/// The scene that `entries` describe, each key that is absent with its default. Missing keys, names that do not exist,
/// keys of another interface law and layers that do not add up are added to `faults`; the scene is then of use only for
/// finding more of them. Throws nothing but std::bad_alloc.
Scene build_scene(const Entries& entries, Faults& faults);

/// Turns the path of a fracture that ends on the symmetry line so that it starts there. Throws nothing.
void start_at_symmetry_line(Scene& scene);

}  // namespace strata
