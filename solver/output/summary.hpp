// summary.json: what a run came to.
#pragma once

#include <string>

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// What the summary says of a run beyond its scene and its last state.
struct RunRecord {
  std::string scene_name;  // title or, without one, the stem of the scene's file
  std::string status;      // "completed" or "failed"
  std::string reason;      // why it ended
  double wall_s = 0.0;     // of the whole process
  int threads = 1;
  double particle_steps = 0.0;  // particles times steps, summed, of this process
};

/// The version of strata, as in CMakeLists.txt; throws nothing.
std::string version();

/// The summary as JSON text; numbers that are not finite become null. Throws std::bad_alloc only.
std::string summary_json(const Scene& scene, const State& state, const RunRecord& record);

}  // namespace strata
