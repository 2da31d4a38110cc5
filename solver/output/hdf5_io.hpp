// The little of HDF5 that the output needs, with handles that close themselves. Everything here throws
// std::runtime_error, naming what it was about, where the library refuses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace strata::hdf5 {

using Id = std::int64_t;  // the library's hid_t, without its header

// Owns a file, a group or another object of the library.
class Handle {
 public:
  using Close = int (*)(Id);
  Handle(Id id, Close close) : id_(id), close_(close) {}
  Handle(Handle&& other) noexcept : id_(other.id_), close_(other.close_) { other.id_ = -1; }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) close_(id_);
  }
  Id id() const { return id_; }

 private:
  Id id_;
  Close close_;
};

/// Opens `file` to be read. No lock is taken, so that a reader cannot stop a run.
Handle open_file(const std::filesystem::path& file);

using Change = std::function<void(Id root)>;

/// Makes `file` in memory (room: about what it takes, bytes) and writes it in one piece. Throws OutputFailure, with
/// what was there as it was, where it cannot be written.
void write_file(const std::filesystem::path& file, std::size_t room, const Change& change);

/// Changes `file` where it lies, for files that are too large for memory: a process that is killed meanwhile leaves it
/// torn. What is written must have its room on the disc already.
void change_in_place(const std::filesystem::path& file, const Change& change);

/// The group `name` below `parent`, made with the groups above it where it is missing.
Handle group(Id parent, const std::string& name);

/// Whether `path` (without the groups above it missing) exists below `parent`.
bool exists(Id parent, const std::string& path);

/// Names of what is in a group, in alphabetical order.
std::vector<std::string> names(Id parent);

/// Lets `name` below `parent` stand for what has the name `path` in `file`, named from the folder of this one.
void link_to_file(Id parent, const std::string& name, const std::string& file, const std::string& path);

/// Copies what is at `path` below `from` to `name` below `parent`, in place of what has that name.
void copy(Id from, const std::string& path, Id parent, const std::string& name);

// How numbers are stored: as they are, or shuffled and deflated by the library's filters.
enum class Storage { plain, packed };

/// Writes a 1-D data set of double, float or std::int32_t, on disc as in memory, with its attribute `unit`, in place of
/// what has that name.
template <class Number>
void write(Id parent, const std::string& name, const std::vector<Number>& values, const std::string& unit,
           Storage storage = Storage::plain);

/// Values of a 1-D data set, converted to double.
std::vector<double> read(Id parent, const std::string& name);

/// Attributes of a group or data set `name` below `parent` ("." is parent itself), written over where they exist.
void set_attribute(Id parent, const std::string& name, const std::string& attribute, double value);
void set_attribute(Id parent, const std::string& name, const std::string& attribute, const std::string& value);
double number_attribute(Id parent, const std::string& name, const std::string& attribute);
std::string text_attribute(Id parent, const std::string& name, const std::string& attribute);

}  // namespace strata::hdf5
