// Changes of an HDF5 file that happen as a whole: whenever the process ends, the file is as it was before the change or
// as it is after it. The library works through a driver of its own that appends to the file but keeps in memory what
// it writes over bytes that were there; these few pages are put in their places at the end, from a note beside the file
// that says them all. A process that is killed while they are written, which takes microseconds, leaves the note, and
// whoever opens the file for its next change finishes that first.
#pragma once

#include <cstdint>
#include <filesystem>
#include <memory>

namespace strata::hdf5 {

/// Finishes the change of `file` whose note was left beside it; does nothing where there is none. A note that is not
/// whole belongs to a change that never began, and is removed. Throws OutputFailure where the file cannot be written.
void finish_change(const std::filesystem::path& file);

class FileChange {
 public:
  /// Opens `file` to be changed, an interrupted change finished before. Throws OutputFailure where it cannot be opened.
  explicit FileChange(const std::filesystem::path& file);
  FileChange(const FileChange&) = delete;
  FileChange& operator=(const FileChange&) = delete;

  /// Without commit() the file is left as it was.
  ~FileChange();

  /// The file, to be changed by the functions of hdf5_io.hpp; all other handles into it must be closed before commit().
  std::int64_t id() const { return id_; }

  /// Makes the change; throws OutputFailure, with the file as it was, where the disc refuses any of it.
  void commit();

  struct Pending;

 private:
  void close();
  void drop();
  std::unique_ptr<Pending> pending_;
  std::int64_t id_ = -1;
};

}  // namespace strata::hdf5
