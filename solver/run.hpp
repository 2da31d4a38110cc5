// What the commands `strata run` and `strata resume` do, once the scene is read.
#pragma once

#include <filesystem>

#include "scene/scene.hpp"

namespace strata {

struct RunOptions {
  std::filesystem::path out;  // folder of the run
  int threads = 0;            // 0: all cores
  bool quiet = false;
  bool replace = false;              // of a run that the folder holds
  double checkpoint_every_s = 60.0;  // of wall time: what a crash costs at most, and rare enough to cost nothing
};

/// Runs a scene and writes its folder. Returns the exit status: 0 done, 2 the folder can no longer be written, 3 the
/// numerics failed, 130 interrupted. Throws OutputFailure where the folder holds a run, is in use or cannot be written
/// at the start; else only what is a bug.
int run_scene(const Scene& scene, const RunOptions& options);

/// Goes on with the run in `dir` from its last checkpoint, or from the start where there is none, to the same digits;
/// a finished run is left as it is. options.out is not used. Returns and throws as run_scene.
int resume_run(const std::filesystem::path& dir, const RunOptions& options);

}  // namespace strata
