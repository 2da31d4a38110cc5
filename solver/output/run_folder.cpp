#include "output/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <fstream>
#include <iterator>
#include <system_error>

#include "scene/messages.hpp"

namespace strata {
namespace {

using FilePath = std::filesystem::path;

// Does `action` on a file; what the system refuses is said as "FILE: cannot be written: REASON".
void doing(const char* what, const FilePath& file, const auto& action) {
  try {
    action();
  } catch (const std::system_error& error) {
    throw OutputFailure(fmt::format("{}: cannot {}: {}", shortened(file.string(), 1000), what, error.code().message()));
  }
}

void require(bool success, int error = errno) {
  if (!success) throw std::system_error(error, std::generic_category());
}

fmt::file opened(const FilePath& file, int how) {
  return {file.c_str(), how | O_CLOEXEC};
}

FilePath beside(FilePath file) {
  return file += ".tmp";
}

}  // namespace

void make_folder(const FilePath& folder) {
  doing("be made", folder, [&] { std::filesystem::create_directories(folder); });
}

fmt::file lock_folder(const FilePath& folder) {
  fmt::file lock;
  doing("be opened", folder, [&] { lock = opened(folder, O_RDONLY | O_DIRECTORY); });
  if (::flock(lock.descriptor(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return lock;
  throw OutputFailure(fmt::format(
      "{}: in use by a run that is going on. Wait for its end, stop it, or name another folder.", folder.string()));
}

void clear_run_folder(const RunFolder& folder, bool replace) {
  // The summary first: without it nothing is taken for a run that has ended.
  for (const auto& file :
       {folder.summary(), folder.checkpoint(), folder.history(), folder.result(), folder.xdmf(), folder.scene()}) {
    std::error_code error;
    if (!replace && std::filesystem::exists(file, error)) {
      throw OutputFailure(
          fmt::format("{0}: holds a run already. `strata resume {0}` goes on with it or leaves it as it is where it "
                      "has ended; --replace runs the scene anew in its place; --out names another folder.",
                      folder.path.string()));
    }
    remove_file(beside(file));
    if (file != folder.scene()) remove_file(file);
  }
  remove_file(folder.all_fields());
}

void remove_file(const FilePath& file) {
  doing("be removed", file, [&] { std::filesystem::remove_all(file); });
}

void write_beside(const FilePath& file, Sync sync, const std::function<void(const FilePath& beside)>& write) {
  const FilePath made = beside(file);
  try {
    write(made);
    if (sync == Sync::yes) sync_file(made);
    doing("be replaced", file, [&] { std::filesystem::rename(made, file); });
  } catch (...) {
    std::error_code gone;
    std::filesystem::remove(made, gone);
    throw;
  }
  if (sync == Sync::no) return;
  // The new name is safe once its folder is; a file system that cannot sync a folder does so on its own.
  const auto parent = file.parent_path();
  try {
    ::fsync(opened(parent.empty() ? "." : parent, O_RDONLY | O_DIRECTORY).descriptor());
  } catch (const std::system_error&) {  // the same
  }
}

void atomic_write(const FilePath& file, std::string_view text, Sync sync) {
  write_beside(file, sync, [text](const FilePath& made) {
    doing("be written", made, [&] {
      fmt::file out = opened(made, O_WRONLY | O_CREAT | O_TRUNC);
      for (std::string_view rest = text; !rest.empty();) rest.remove_prefix(out.write(rest.data(), rest.size()));
    });
  });
}

void take_room(const FilePath& file, std::uint64_t bytes) {
  doing("be written", file, [&] {
    const int error = ::posix_fallocate(opened(file, O_WRONLY).descriptor(), 0, static_cast<off_t>(bytes));
    require(error == 0, error);
  });
}

void append_at(const FilePath& file, std::uint64_t bytes, std::string_view text) {
  doing("be written", file, [&] {
    fmt::file out = opened(file, O_WRONLY | O_APPEND);
    if (const auto size = static_cast<std::uint64_t>(out.size()); size != bytes)
      throw OutputFailure(fmt::format(
          "{}: cannot be written: it has {} bytes and not the {} that were written; another program has changed it",
          file.string(), size, bytes));
    if (out.write(text.data(), text.size()) == text.size()) return;
    std::filesystem::resize_file(file, bytes);  // to whole rows
    require(false, ENOSPC);
  });
}

void sync_file(const FilePath& file) {
  doing("be synced", file, [&] { require(::fsync(opened(file, O_WRONLY).descriptor()) == 0); });
}

std::string read_whole(const FilePath& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be opened.", file.string()));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace strata
