// The little of HDF5 that the output needs, with handles that close themselves. Everything here throws
// std::runtime_error, naming what it was about, where the library refuses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "output/packing.hpp"

namespace strata::hdf5 {

using Id = std::int64_t;  // the library's hid_t, without its header

// Owns a file or a group.
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

/// Makes an empty `file` in place of what was there, in one piece. Throws OutputFailure where it cannot be written.
void make_file(const std::filesystem::path& file);

/// Opens `file` to be read, or to be changed by tests; what a run writes goes through FileChange. No lock is taken, so
/// that a reader cannot stop a run.
Handle open_file(const std::filesystem::path& file, bool writable);

/// The group `name` below `parent`, made with the groups above it where it is missing.
Handle group(Id parent, const std::string& name);

/// Whether `path` (without the groups above it missing) exists below `parent`.
bool exists(Id parent, const std::string& path);

/// Names of what is in a group, in alphabetical order.
std::vector<std::string> names(Id parent);

/// Takes the link `name` out of `parent`.
void remove(Id parent, const std::string& name);

/// Writes a new 1-D data set with its attribute `unit`; compressed ones are for large fields.
void write(Id parent, const std::string& name, std::span<const double> values, const std::string& unit);
void write(Id parent, const std::string& name, std::span<const std::int32_t> values, const std::string& unit);
void write_compressed(Id parent, const std::string& name, std::span<const float> values, const std::string& unit,
                      Packer& packer);
void write_compressed(Id parent, const std::string& name, std::span<const std::int32_t> values, const std::string& unit,
                      Packer& packer);

/// Gives the data set at `path`, from the root ("/..."), the further name `name` below `parent`.
void link(Id parent, const std::string& name, const std::string& path);

/// Writes a 1-D data set that may have another length the next time, made where it is missing.
void rewrite(Id parent, const std::string& name, std::span<const double> values, const std::string& unit);

/// Values of a 1-D data set, converted to double, and its length.
std::vector<double> read(Id parent, const std::string& name);
std::size_t length(Id parent, const std::string& name);

/// Attributes of a group or data set `name` below `parent` ("." is parent itself), written over where they exist.
void set_attribute(Id parent, const std::string& name, const std::string& attribute, double value);
void set_attribute(Id parent, const std::string& name, const std::string& attribute, const std::string& value);
double number_attribute(Id parent, const std::string& name, const std::string& attribute);
std::string text_attribute(Id parent, const std::string& name, const std::string& attribute);

}  // namespace strata::hdf5
