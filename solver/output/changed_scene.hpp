// Whether the scene in a run's folder is still the one that the run was made with.
#pragma once

#include "output/run_folder.hpp"
#include "scene/scene.hpp"

namespace strata {

/// Throws OutputFailure, with the keys that differ and what to do, where result.h5 says that the run was made with
/// another scene than `scene`, which its scene.toml holds now; comments and order do not count.
void require_unchanged_scene(const RunFolder& folder, const Scene& scene);

/// That the run has ended and is left as it is, and how it ended by its summary. Throws nothing but std::bad_alloc.
std::string how_it_ended(const RunFolder& folder);

}  // namespace strata
