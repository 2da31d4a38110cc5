#include "output/run_folder.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <stdexcept>
#include <string>
#include <system_error>

namespace strata {

namespace {

[[noreturn]] void fail(const std::filesystem::path& file, const char* doing, int error) {
  throw std::runtime_error(
      fmt::format("{}: cannot {}: {}", file.string(), doing, std::generic_category().message(error)));
}

class Descriptor {
 public:
  Descriptor(const std::filesystem::path& file, int flags) : descriptor_(::open(file.c_str(), flags, 0644)) {}
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  ~Descriptor() {
    if (descriptor_ >= 0) ::close(descriptor_);
  }
  int get() const { return descriptor_; }

 private:
  int descriptor_;
};

void write_synced(const std::filesystem::path& file, std::string_view text) {
  const Descriptor out(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC);
  if (out.get() < 0) fail(file, "be written", errno);
  while (!text.empty()) {
    const ssize_t written = ::write(out.get(), text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) fail(file, "be written", errno);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
  if (::fsync(out.get()) != 0) fail(file, "be synced", errno);
}

}  // namespace

RunFolder create_run_folder(const std::filesystem::path& path) {
  std::error_code error;
  std::filesystem::create_directories(path, error);
  if (error) throw std::runtime_error(fmt::format("{}: cannot be made: {}", path.string(), error.message()));
  if (!std::filesystem::is_directory(path)) {
    throw std::runtime_error(fmt::format("{}: is not a folder", path.string()));
  }
  const RunFolder folder{path};
  for (const auto& file :
       {folder.summary(), folder.scene(), folder.history(), folder.result(), folder.xdmf(), folder.checkpoint()}) {
    std::filesystem::remove(file, error);
    if (error) throw std::runtime_error(fmt::format("{}: cannot be replaced: {}", file.string(), error.message()));
  }
  return folder;
}

void atomic_write(const std::filesystem::path& file, std::string_view text) {
  std::filesystem::path beside = file;
  beside += ".tmp";
  try {
    write_synced(beside, text);
    if (std::rename(beside.c_str(), file.c_str()) != 0) fail(file, "be replaced", errno);
  } catch (...) {
    std::remove(beside.c_str());
    throw;
  }
  // The new name is safe once its folder is; a file system that cannot sync a folder does so on its own.
  const auto parent = file.parent_path();
  const Descriptor folder(parent.empty() ? std::filesystem::path(".") : parent, O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  if (folder.get() >= 0) ::fsync(folder.get());
}

}  // namespace strata
