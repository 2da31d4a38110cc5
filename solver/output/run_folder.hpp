// The folder of a run: the names of its files, and how they are written.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>

namespace strata {

// Thrown where the disc or the folder does not take what is to be written; the text names the file and the reason.
struct OutputFailure : std::runtime_error {
  using std::runtime_error::runtime_error;
};

/// The folder beside a result file that holds its fields until the run has ended. Throws nothing but std::bad_alloc.
inline std::filesystem::path fields_of(std::filesystem::path result) {
  return result += ".fields";
}

struct RunFolder {
  std::filesystem::path path;

  std::filesystem::path scene() const { return path / "scene.toml"; }
  std::filesystem::path summary() const { return path / "summary.json"; }
  std::filesystem::path history() const { return path / "history.csv"; }
  std::filesystem::path result() const { return path / "result.h5"; }
  std::filesystem::path xdmf() const { return path / "result.xdmf"; }
  std::filesystem::path checkpoint() const { return path / "checkpoint.bin"; }
};

// An open file or folder of the system; -1 where it could not be opened.
class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags);
  Descriptor(Descriptor&& other) noexcept : descriptor_(std::exchange(other.descriptor_, -1)) {}
  Descriptor& operator=(Descriptor&&) = delete;
  ~Descriptor();
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

/// Locks a folder for the process that writes to it, until what is returned goes or the process ends: a lock of the
/// system on the folder itself. Throws OutputFailure where another process writes to the folder, or where it cannot be
/// opened. On a file system without locks nothing is locked.
Descriptor lock_folder(const std::filesystem::path& folder);

/// Makes the folder, with its parents, and locks it. Throws OutputFailure where it cannot be made, is not a folder or
/// is in use.
Descriptor make_run_folder(const std::filesystem::path& path);

/// Makes way for a run in a folder that is locked: throws OutputFailure, saying what may be done, where it holds one,
/// unless `replace`, which takes that one's files out of it. Other files stay, and scene.toml, which the new run's
/// replaces in one piece, so that the folder can be resumed at any time.
RunFolder clear_run_folder(const std::filesystem::path& path, bool replace);

// Whether what is written is to survive a loss of power, for which one waits for the disc; it survives the end of the
// process in any case.
enum class Sync { no, yes };

/// Lets `write` write a file beside `file`, which is then renamed to it, so that at any time either the old or the new
/// content is there; where that throws, the one beside is removed. Throws OutputFailure, naming the file and the
/// system's reason.
void write_beside(const std::filesystem::path& file, Sync sync,
                  const std::function<void(const std::filesystem::path& beside)>& write);

/// Writes `text` to `file` so that at any time either the old or the new content is there, by
/// write_beside(); throws as that.
void atomic_write(const std::filesystem::path& file, std::string_view text, Sync sync = Sync::yes);

/// Writes `text` to a new `file` and takes so many bytes of the disc for it, so that what is written within them later
/// is not refused. Throws OutputFailure where the disc has no such room.
void write_with_room(const std::filesystem::path& file, std::string_view text, std::uint64_t bytes);

/// Adds `text` by one call of the system to the end of `file`, which must be its `bytes` long. Throws OutputFailure,
/// with the file as it was, where the disc refuses it, or where the file is gone or has another length.
void append_at(const std::filesystem::path& file, std::uint64_t bytes, std::string_view text);

/// Waits until what `file` holds is on the disc; throws OutputFailure where it cannot be.
void sync_file(const std::filesystem::path& file);

/// All bytes of `file`; throws std::runtime_error where it cannot be read.
std::string read_whole(const std::filesystem::path& file);

/// FNV-1a, 64 bit (Fowler, Noll, Vo; RFC 9923); throws nothing.
std::uint64_t checksum(std::string_view bytes);

}  // namespace strata
