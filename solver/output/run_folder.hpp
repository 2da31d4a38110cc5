// The folder of a run: the names of its files, and how they are written.
#pragma once

#include <filesystem>
#include <string_view>

namespace strata {

struct RunFolder {
  std::filesystem::path path;

  std::filesystem::path scene() const { return path / "scene.toml"; }
  std::filesystem::path summary() const { return path / "summary.json"; }
  std::filesystem::path history() const { return path / "history.csv"; }
  std::filesystem::path result() const { return path / "result.h5"; }
  std::filesystem::path xdmf() const { return path / "result.xdmf"; }
  std::filesystem::path checkpoint() const { return path / "checkpoint.bin"; }
};

/// Makes the folder, with its parents, and takes the files of an earlier run out of it; other files stay. Throws
/// std::runtime_error where it cannot be made or is not a folder.
RunFolder create_run_folder(const std::filesystem::path& path);

/// Writes `text` to `file` so that at any time either the old or the new content is there: to a file beside it, synced,
/// then renamed. Throws std::runtime_error, naming the file and the system's reason.
void atomic_write(const std::filesystem::path& file, std::string_view text);

}  // namespace strata
