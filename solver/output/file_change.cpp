#include "output/file_change.hpp"

#include <fcntl.h>
#include <fmt/format.h>
#include <hdf5.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <system_error>

#include "output/run_folder.hpp"

namespace strata::hdf5 {

namespace {

constexpr std::uint64_t page_size = 4096;
using Page = std::array<char, page_size>;

constexpr std::string_view magic = "strata-change-1\n";

bool write_all(int file, const char* from, std::uint64_t size, std::uint64_t at) {
  while (size > 0) {
    const ssize_t written = ::pwrite(file, from, size, static_cast<off_t>(at));
    if (written < 0 && errno == EINTR) continue;
    if (written < 0) return false;
    from += written, at += static_cast<std::uint64_t>(written), size -= static_cast<std::uint64_t>(written);
  }
  return true;
}

// What is behind the end of the file is read as zeros.
bool read_all(int file, char* to, std::uint64_t size, std::uint64_t at) {
  while (size > 0) {
    const ssize_t got = ::pread(file, to, size, static_cast<off_t>(at));
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return false;
    if (got == 0) break;
    to += got, at += static_cast<std::uint64_t>(got), size -= static_cast<std::uint64_t>(got);
  }
  std::memset(to, 0, size);
  return true;
}

std::filesystem::path note_of(std::filesystem::path file) {
  return file += ".change";
}

template <class Number>
void put(std::string& bytes, Number number) {
  bytes.append(reinterpret_cast<const char*>(&number), sizeof number);
}

std::uint64_t take(std::string_view& bytes) {
  std::uint64_t number = 0;
  if (bytes.size() < sizeof number) return 0;
  std::memcpy(&number, bytes.data(), sizeof number);
  bytes.remove_prefix(sizeof number);
  return number;
}

[[noreturn]] void refuse(const std::filesystem::path& file, int error) {
  throw OutputFailure(fmt::format("{}: cannot be written: {}", file.string(), std::generic_category().message(error)));
}

// What a note holds behind its magic and its sum; nothing where it is not whole.
std::string_view content_of(std::string_view note) {
  if (!note.starts_with(magic)) return {};
  note.remove_prefix(magic.size());
  const std::uint64_t sum = take(note);
  return sum == checksum(note) ? note : std::string_view{};
}

// Puts the pages of a note in their places.
void put_in_place(int file, std::string_view note, const std::filesystem::path& name) {
  const std::uint64_t size = take(note);
  while (note.size() >= sizeof(std::uint64_t) + page_size) {
    const std::uint64_t at = take(note);
    if (at < size && !write_all(file, note.data(), std::min(page_size, size - at), at)) refuse(name, errno);
    note.remove_prefix(page_size);
  }
  if (::ftruncate(file, static_cast<off_t>(size)) != 0) refuse(name, errno);
}

}  // namespace

// A change as it goes on: the file, and the pages that differ from it.
struct FileChange::Pending {
  std::filesystem::path name;
  int file = -1;
  int error = 0;              // of the system, the first one
  std::uint64_t old_end = 0;  // bytes of the file before
  std::uint64_t kept = 0;     // bytes that must not be written over before the end, whole pages
  std::uint64_t end = 0;      // bytes of the file as the library sees it
  std::map<std::uint64_t, Page> pages;

  explicit Pending(const std::filesystem::path& path) : name(path), file(::open(path.c_str(), O_RDWR | O_CLOEXEC)) {
    struct stat status {};
    if (file < 0 || ::fstat(file, &status) != 0) {
      error = errno;
      return;
    }
    old_end = end = static_cast<std::uint64_t>(status.st_size);
    kept = (old_end + page_size - 1) / page_size * page_size;
  }
  Pending(const Pending&) = delete;
  Pending& operator=(const Pending&) = delete;
  ~Pending() {
    if (file >= 0) ::close(file);
  }

  void fail() {
    if (error == 0) error = errno;
  }

  Page& page(std::uint64_t number) {
    const auto [place, made] = pages.try_emplace(number);
    if (made && !read_all(file, place->second.data(), page_size, number * page_size)) fail();
    return place->second;
  }

  void read(std::uint64_t at, std::uint64_t size, char* to) {
    if (!read_all(file, to, size, at)) fail();
    for (auto p = pages.lower_bound(at / page_size); p != pages.end() && p->first * page_size < at + size; ++p) {
      const std::uint64_t from = std::max(at, p->first * page_size);
      const std::uint64_t until = std::min(at + size, (p->first + 1) * page_size);
      std::memcpy(to + (from - at), p->second.data() + from % page_size, until - from);
    }
  }

  // After an error nothing reaches the file any more: the library closes it in peace, and the change is dropped.
  void write(std::uint64_t at, std::uint64_t size, const char* from) {
    end = std::max(end, at + size);
    while (size > 0) {
      std::uint64_t part = size;
      const bool behind = at >= kept && error == 0;
      if (behind && !write_all(file, from, size, at)) {
        fail();
        continue;
      }
      if (!behind) {
        part = std::min(size, page_size - at % page_size);
        std::memcpy(page(at / page_size).data() + at % page_size, from, part);
      }
      at += part, from += part, size -= part;
    }
  }

  std::string note() const {
    std::string content;
    put(content, end);
    for (const auto& [number, bytes] : pages) {
      put(content, number * page_size);
      content.append(bytes.data(), page_size);
    }
    std::string text(magic);
    put(text, checksum(content));
    return text + content;
  }
};

namespace {

using Pending = FileChange::Pending;

// What the library knows of an open file, and where its own part ends.
struct Driven {
  H5FD_t library{};
  Pending* pending = nullptr;
  haddr_t end_of_addresses = 0;
};

Driven& driven(H5FD_t* file) {
  return *reinterpret_cast<Driven*>(file);
}
const Driven& driven(const H5FD_t* file) {
  return *reinterpret_cast<const Driven*>(file);
}

H5FD_t* open_driven(const char*, unsigned, hid_t access, haddr_t) {
  const auto* info = static_cast<Pending* const*>(H5Pget_driver_info(access));
  if (info == nullptr || (*info)->error != 0) return nullptr;
  auto* file = new (std::nothrow) Driven;
  if (file != nullptr) file->pending = *info;
  return reinterpret_cast<H5FD_t*>(file);
}

herr_t close_driven(H5FD_t* file) {
  delete &driven(file);
  return 0;
}

herr_t ask_driven(const H5FD_t*, unsigned long* flags) {
  *flags = H5FD_FEAT_AGGREGATE_METADATA | H5FD_FEAT_ACCUMULATE_METADATA | H5FD_FEAT_DATA_SIEVE |
           H5FD_FEAT_AGGREGATE_SMALLDATA;
  return 0;
}

// The library is C: nothing may be thrown through it.
template <class Work>
herr_t caught(H5FD_t* file, Work work) {
  try {
    work(*driven(file).pending);
    return 0;
  } catch (...) {
    if (driven(file).pending->error == 0) driven(file).pending->error = ENOMEM;
    return -1;
  }
}

herr_t read_driven(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, void* to) {
  return caught(file, [&](Pending& pending) { pending.read(at, size, static_cast<char*>(to)); });
}

herr_t write_driven(H5FD_t* file, H5FD_mem_t, hid_t, haddr_t at, std::size_t size, const void* from) {
  return caught(file, [&](Pending& pending) { pending.write(at, size, static_cast<const char*>(from)); });
}

// A file that grows does so at once, and one that shrinks when the change is made.
herr_t cut_driven(H5FD_t* file, hid_t, hbool_t) {
  return caught(file, [&](Pending& pending) {
    const haddr_t end = driven(file).end_of_addresses;
    if (end > pending.end && pending.error == 0 && ::ftruncate(pending.file, static_cast<off_t>(end)) != 0) {
      pending.fail();
    }
    pending.end = end;
  });
}

H5FD_class_t make_driver() {
  H5FD_class_t driver{};
  driver.name = "strata-change";
  driver.maxaddr = haddr_t{1} << 62;
  driver.fc_degree = H5F_CLOSE_STRONG;
  driver.fapl_size = sizeof(Pending*);
  driver.open = open_driven;
  driver.close = close_driven;
  driver.query = ask_driven;
  driver.get_eoa = [](const H5FD_t* file, H5FD_mem_t) { return driven(file).end_of_addresses; };
  driver.set_eoa = [](H5FD_t* file, H5FD_mem_t, haddr_t end) -> herr_t {
    driven(file).end_of_addresses = end;
    return 0;
  };
  driver.get_eof = [](const H5FD_t* file, H5FD_mem_t) -> haddr_t { return driven(file).pending->end; };
  driver.read = read_driven;
  driver.write = write_driven;
  driver.truncate = cut_driven;
  constexpr H5FD_mem_t kinds[H5FD_MEM_NTYPES] = H5FD_FLMAP_DICHOTOMY;
  std::copy(std::begin(kinds), std::end(kinds), driver.fl_map);
  return driver;
}

std::int64_t open_through(const std::filesystem::path& name, Pending* pending) {
  hid_t file = -1;
  H5E_BEGIN_TRY {
    const H5FD_class_t driver = make_driver();
    const hid_t registered = H5FDregister(&driver), access = H5Pcreate(H5P_FILE_ACCESS);
    if (H5Pset_driver(access, registered, &pending) >= 0) file = H5Fopen(name.c_str(), H5F_ACC_RDWR, access);
    H5Pclose(access);
    H5FDunregister(registered);
  }
  H5E_END_TRY;
  if (file < 0) throw OutputFailure(fmt::format("{}: cannot be opened: it is no HDF5 file", name.string()));
  return file;
}

}  // namespace

void finish_change(const std::filesystem::path& file) {
  const std::filesystem::path note = note_of(file);
  std::error_code error;
  if (!std::filesystem::exists(note, error)) return;
  const std::string text = read_whole(note);
  const std::string_view content = content_of(text);
  if (!content.empty()) {
    const Pending pending(file);
    if (pending.error != 0) refuse(file, pending.error);
    put_in_place(pending.file, content, file);
  }
  std::filesystem::remove(note, error);
  if (error) refuse(note, error.value());
}

FileChange::FileChange(const std::filesystem::path& file) {
  finish_change(file);
  pending_ = std::make_unique<Pending>(file);
  if (pending_->error != 0) {
    throw OutputFailure(
        fmt::format("{}: cannot be opened: {}", file.string(), std::generic_category().message(pending_->error)));
  }
  id_ = open_through(file, pending_.get());
}

FileChange::~FileChange() {
  if (id_ < 0) return;
  close();
  drop();
}

void FileChange::close() {
  H5E_BEGIN_TRY {
    if (H5Fclose(id_) < 0) pending_->error = pending_->error != 0 ? pending_->error : EIO;
  }
  H5E_END_TRY;
  id_ = -1;
}

// What was appended is taken off again; where even that fails, it lies behind the end that the file itself knows.
void FileChange::drop() {
  if (::ftruncate(pending_->file, static_cast<off_t>(pending_->old_end)) != 0) pending_->fail();
}

void FileChange::commit() {
  close();
  const std::filesystem::path note = note_of(pending_->name);
  std::string text;
  try {
    if (pending_->error != 0) refuse(pending_->name, pending_->error);
    text = pending_->note();
    atomic_write(note, text, Sync::no);
  } catch (...) {
    drop();
    throw;
  }
  put_in_place(pending_->file, content_of(text), pending_->name);
  if (::unlink(note.c_str()) != 0) refuse(note, errno);
}

}  // namespace strata::hdf5
