#include "output/run_folder.hpp"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <system_error>

#include "scene/messages.hpp"

namespace strata {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* doing, int error) {
  throw OutputFailure(
      fmt::format("{}: cannot {}: {}", shortened(file.string(), 1000), doing, std::generic_category().message(error)));
}

std::filesystem::path beside(std::filesystem::path file) {
  return file += ".tmp";
}

}  // namespace

Descriptor::Descriptor(const std::filesystem::path& file, int flags)
    : descriptor_(::open(file.c_str(), flags | O_CLOEXEC, 0644)) {}

Descriptor::~Descriptor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

void make_folder(const std::filesystem::path& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  if (error) fail(folder, "be made", error.value());
}

Descriptor lock_folder(const std::filesystem::path& folder) {
  Descriptor lock(folder, O_RDONLY | O_DIRECTORY);
  if (lock.get() < 0) fail(folder, "be opened", errno);
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return lock;
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

void remove_file(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove_all(file, error);
  if (error) fail(file, "be removed", error.value());
}

void write_beside(const std::filesystem::path& file, Sync sync,
                  const std::function<void(const std::filesystem::path& beside)>& write) {
  const std::filesystem::path made = beside(file);
  try {
    write(made);
    if (sync == Sync::yes) sync_file(made);
    if (std::rename(made.c_str(), file.c_str()) != 0) fail(file, "be replaced", errno);
  } catch (...) {
    std::remove(made.c_str());
    throw;
  }
  if (sync == Sync::no) return;
  // The new name is safe once its folder is; a file system that cannot sync a folder does so on its own.
  const auto parent = file.parent_path();
  const Descriptor folder(parent.empty() ? std::filesystem::path(".") : parent, O_RDONLY | O_DIRECTORY);
  if (folder.get() >= 0) ::fsync(folder.get());
}

void atomic_write(const std::filesystem::path& file, std::string_view text, Sync sync) {
  write_beside(file, sync, [text](const std::filesystem::path& made) {
    const Descriptor out(made, O_WRONLY | O_CREAT | O_TRUNC);
    if (out.get() < 0) fail(made, "be written", errno);
    for (std::string_view rest = text; !rest.empty();) {
      const ssize_t written = ::write(out.get(), rest.data(), rest.size());
      if (written < 0 && errno != EINTR) fail(made, "be written", errno);
      if (written > 0) rest.remove_prefix(static_cast<std::size_t>(written));
    }
  });
}

void take_room(const std::filesystem::path& file, std::uint64_t bytes) {
  const Descriptor out(file, O_WRONLY);
  const int error = out.get() < 0 ? errno : ::posix_fallocate(out.get(), 0, static_cast<off_t>(bytes));
  if (error != 0) fail(file, "be written", error);
}

void append_at(const std::filesystem::path& file, std::uint64_t bytes, std::string_view text) {
  const Descriptor out(file, O_WRONLY | O_APPEND);
  struct stat status {};
  if (out.get() < 0 || ::fstat(out.get(), &status) != 0) fail(file, "be written", errno);
  if (static_cast<std::uint64_t>(status.st_size) != bytes) {
    throw OutputFailure(fmt::format(
        "{}: cannot be written: it has {} bytes and not the {} that were written; another program has changed it",
        file.string(), status.st_size, bytes));
  }
  ssize_t written = 0;
  do {
    written = ::write(out.get(), text.data(), text.size());
  } while (written < 0 && errno == EINTR);
  if (written == static_cast<ssize_t>(text.size())) return;
  const int error = written < 0 ? errno : ENOSPC;
  if (::ftruncate(out.get(), static_cast<off_t>(bytes)) != 0) fail(file, "be cut to whole rows", errno);
  fail(file, "be written", error);
}

void sync_file(const std::filesystem::path& file) {
  const Descriptor out(file, O_WRONLY);
  if (out.get() < 0 || ::fsync(out.get()) != 0) fail(file, "be synced", errno);
}

std::string read_whole(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be opened.", file.string()));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

}  // namespace strata
