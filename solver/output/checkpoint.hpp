// A checkpoint: the state of a run to the last digit, and what had been written then; and whether the scene in its
// folder is still the run's.
#pragma once

#include <filesystem>
#include <vector>

#include "output/history.hpp"
#include "output/run_folder.hpp"
#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// What a run has written.
struct Written {
  std::vector<HistoryRow> rows;
  std::vector<double> output_times;  // s
};

struct Checkpoint {
  State state;  // without its derived members: restore() comes next
  Written written;
};

/// Writes the state, but what is derived of it, to `file`, in one piece. Throws OutputFailure where it cannot.
void save_checkpoint(const std::filesystem::path& file, const Scene& scene, const Checkpoint& checkpoint);

/// Reads a checkpoint back to the same digits. Throws std::runtime_error, saying which, where `file` is missing, is no
/// checkpoint of this format or torn, OutputFailure where it is of another scene.
Checkpoint load_checkpoint(const std::filesystem::path& file, const Scene& scene);

/// Throws OutputFailure, with the lines that differ and what to do, where the files of the run say that it was made
/// with another scene than `scene`, which its scene.toml holds now; comments and order do not count.
void require_unchanged_scene(const RunFolder& folder, const Scene& scene);

}  // namespace strata
