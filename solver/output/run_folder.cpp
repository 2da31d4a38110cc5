#include "output/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <system_error>

#include "scene/messages.hpp"

namespace strata {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* doing, int error) {
  throw OutputFailure(fmt::format("{}: cannot {}: {}", file.string(), doing, std::generic_category().message(error)));
}

std::filesystem::path with_ending(std::filesystem::path file, const char* ending) {
  return file += ending;
}

// The summary first: without it nothing is taken for a run that has ended.
std::array<std::filesystem::path, 6> files_of(const RunFolder& folder) {
  return {folder.summary(), folder.checkpoint(), folder.history(), folder.result(), folder.xdmf(), folder.scene()};
}

void remove_file(const std::filesystem::path& file) {
  std::error_code error;
  std::filesystem::remove_all(file, error);
  if (error) throw OutputFailure(fmt::format("{}: cannot be replaced: {}", file.string(), error.message()));
}

}  // namespace

Descriptor::Descriptor(const std::filesystem::path& file, int flags)
    : descriptor_(::open(file.c_str(), flags | O_CLOEXEC, 0644)) {}

Descriptor::~Descriptor() {
  if (descriptor_ >= 0) ::close(descriptor_);
}

Descriptor lock_folder(const std::filesystem::path& folder) {
  Descriptor lock(folder, O_RDONLY | O_DIRECTORY);
  if (lock.get() < 0) fail(folder, "be opened", errno);
  if (::flock(lock.get(), LOCK_EX | LOCK_NB) == 0 || errno != EWOULDBLOCK) return lock;
  throw OutputFailure(fmt::format(
      "{}: in use by a run that is going on. Wait for its end, stop it, or name another folder.", folder.string()));
}

Descriptor make_run_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error)
    throw OutputFailure(fmt::format("{}: cannot be made: {}", shortened(path.string(), 1000), error.message()));
  if (!std::filesystem::is_directory(path)) throw OutputFailure(fmt::format("{}: is not a folder", path.string()));
  return lock_folder(path);
}

RunFolder clear_run_folder(const std::filesystem::path& path, bool replace) {
  RunFolder folder{path};
  for (const auto& file : files_of(folder)) {
    std::error_code error;
    if (!replace && std::filesystem::exists(file, error)) {
      throw OutputFailure(
          fmt::format("{0}: holds a run already. `strata resume {0}` goes on with it or leaves it as it is where it "
                      "has ended; --replace runs the scene anew in its place; --out names another folder.",
                      path.string()));
    }
  }
  for (const auto& file : files_of(folder)) {
    remove_file(with_ending(file, ".tmp"));
    if (file != folder.scene()) remove_file(file);
  }
  remove_file(fields_of(folder.result()));
  return folder;
}

void write_beside(const std::filesystem::path& file, Sync sync,
                  const std::function<void(const std::filesystem::path& beside)>& write) {
  const std::filesystem::path beside = with_ending(file, ".tmp");
  try {
    write(beside);
    if (sync == Sync::yes) sync_file(beside);
    if (std::rename(beside.c_str(), file.c_str()) != 0) fail(file, "be replaced", errno);
  } catch (...) {
    std::remove(beside.c_str());
    throw;
  }
  if (sync == Sync::no) return;
  // The new name is safe once its folder is; a file system that cannot sync a folder does so on its own.
  const auto parent = file.parent_path();
  const Descriptor folder(parent.empty() ? std::filesystem::path(".") : parent, O_RDONLY | O_DIRECTORY);
  if (folder.get() >= 0) ::fsync(folder.get());
}

void atomic_write(const std::filesystem::path& file, std::string_view text, Sync sync) {
  write_beside(file, sync, [text](const std::filesystem::path& beside) { write_with_room(beside, text, 0); });
}

void write_with_room(const std::filesystem::path& file, std::string_view text, std::uint64_t bytes) {
  const Descriptor out(file, O_WRONLY | O_CREAT | O_TRUNC);
  if (out.get() < 0) fail(file, "be written", errno);
  while (!text.empty()) {
    const ssize_t written = ::write(out.get(), text.data(), text.size());
    if (written < 0 && errno != EINTR) fail(file, "be written", errno);
    if (written > 0) text.remove_prefix(static_cast<std::size_t>(written));
  }
  const int full = bytes > 0 ? ::posix_fallocate(out.get(), 0, static_cast<off_t>(bytes)) : 0;
  if (full != 0) fail(file, "be written", full);
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
  if (!in) throw std::runtime_error(fmt::format("{}: cannot be opened", file.string()));
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::uint64_t checksum(std::string_view bytes) {
  std::uint64_t hash = 0xcbf29ce484222325U;
  for (const char c : bytes) hash = (hash ^ static_cast<unsigned char>(c)) * 0x100000001b3U;
  return hash;
}

}  // namespace strata
