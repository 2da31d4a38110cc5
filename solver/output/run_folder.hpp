// The folder of a run: the names of its files, and how they are written.
#pragma once

#include <fmt/format.h>
#include <fmt/os.h>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>

namespace strata {

// Thrown where the disc or the folder does not take what is to be written; the text names the file and the reason.
struct OutputFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

struct RunFolder {
  std::filesystem::path path;

  std::filesystem::path scene() const { return path / "scene.toml"; }
  std::filesystem::path summary() const { return path / "summary.json"; }
  std::filesystem::path history() const { return path / "history.csv"; }
  std::filesystem::path result() const { return path / "result.h5"; }
  std::filesystem::path xdmf() const { return path / "result.xdmf"; }
  std::filesystem::path checkpoint() const { return path / "checkpoint.bin"; }
  std::filesystem::path all_fields() const { return path / "result.h5.fields"; }  // until the run has ended
  std::filesystem::path fields(std::size_t k) const { return all_fields() / fmt::format("{:05}.h5", k); }
};

// What is refused in the following throws OutputFailure, with all as it was.

/// Makes a folder, with its parents, where it is missing.
void make_folder(const std::filesystem::path& folder);

/// Locks a folder, if it is not locked already, for the process that writes to it, until what is returned goes or the
/// process ends; on a file system without locks nothing is locked.
fmt::file lock_folder(const std::filesystem::path& folder);

/// Makes way for a run: refuses a folder that holds one, saying what may be done, unless `replace`, which removes that
/// one's files but scene.toml, which the new run's replaces in one piece: it can always be resumed.
void clear_run_folder(const RunFolder& folder, bool replace);

/// Removes a file, or a folder with what is in it, if it is there.
void remove_file(const std::filesystem::path& file);

// Whether what is written is to survive a loss of power, for which one waits for the disc; it survives the end of the
// process in any case.
enum class Sync { no, yes };

/// Lets `write` write a file beside `file`, which is then renamed to it: at any time either the old or the new content
/// is there.
void write_beside(const std::filesystem::path& file, Sync sync,
                  const std::function<void(const std::filesystem::path& beside)>& write);

/// Writes `text` to `file` by write_beside().
void atomic_write(const std::filesystem::path& file, std::string_view text, Sync sync = Sync::yes);

/// Takes the room of so many bytes for `file`.
void take_room(const std::filesystem::path& file, std::uint64_t bytes);

/// Adds `text` by one call of the system to `file`, which must be there and `bytes` long.
void append_at(const std::filesystem::path& file, std::uint64_t bytes, std::string_view text);

/// Waits until what `file` holds is on the disc.
void sync_file(const std::filesystem::path& file);

/// All bytes of `file`; throws std::runtime_error where it cannot be read.
std::string read_whole(const std::filesystem::path& file);

}  // namespace strata
