// A checkpoint: the state of a run to the last digit, and how far its output had come; and whether the scene in its
// folder is still the run's.
#pragma once

#include <cstdint>
#include <filesystem>

#include "output/history.hpp"
#include "output/run_folder.hpp"
#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// How far the output of a run had come: what is behind it is cut off before the run goes on.
struct OutputMark {
  HistoryMark history;
  std::uint64_t outputs = 0;  // output times in result.h5
};

struct Checkpoint {
  State state;  // without its derived members: restore() comes next
  OutputMark mark;
};

/// A number that tells resolved scenes apart (FNV-1a, 64 bit, of Scene::resolved_toml); throws nothing.
std::uint64_t scene_hash(const Scene& scene);

/// Writes the state, but what is derived of it, to `file` in one piece: the old checkpoint stays until the new one is
/// complete. Throws std::runtime_error if it cannot be written.
void save_checkpoint(const std::filesystem::path& file, const Scene& scene, const State& state, const OutputMark& mark);

/// Reads a checkpoint back to the same digits. Throws std::runtime_error, saying which, where `file` is missing, is no
/// checkpoint, is of another format or torn, OutputFailure where it is of another scene.
Checkpoint load_checkpoint(const std::filesystem::path& file, const Scene& scene);

/// Throws OutputFailure, with the keys that differ and what to do, where result.h5 says that the run was made with
/// another scene than `scene`, which its scene.toml holds now; comments and order do not count.
void require_unchanged_scene(const RunFolder& folder, const Scene& scene);

}  // namespace strata
