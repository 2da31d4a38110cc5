// The little of HDF5 that the output needs, with handles that close themselves. Paths lead from a file or a group.
// Everything here throws OutputFailure, naming what it was about, where the library refuses.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace strata::hdf5 {

using Id = std::int64_t;  // the library's hid_t, without its header

// Owns an object of the library; `what` names it where the library has made none (id < 0).
class Handle {
 public:
  Handle(Id id, int (*close)(Id), const std::string& what);
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() { close_(id_); }
  operator Id() const { return id_; }

 private:
  Id id_;
  int (*close_)(Id);
};

/// Opens `file` to be read. No lock is taken, so that a reader cannot stop a run.
Handle open_file(const std::filesystem::path& file);

using Change = std::function<void(Id root)>;

/// Makes `file` in memory and writes it in one piece; what was there stays where that fails.
void write_file(const std::filesystem::path& file, const Change& change);

/// Adds to `file` where it lies, for what is too large for memory: a process that is killed meanwhile leaves it torn.
/// What is written must have its room on the disc already.
void change_in_place(const std::filesystem::path& file, const Change& change);

/// Whether `path` exists, and the groups above it.
bool exists(Id parent, const std::string& path);

/// Makes an empty group.
void make_group(Id parent, const std::string& path);

/// Names of what is in a group, in alphabetical order.
std::vector<std::string> names(Id parent, const std::string& path = ".");

/// Copies what is at `path` below `from` to the same path below `to`, with the groups above it.
void copy(Id from, const std::string& path, Id to);

// What a data set says of itself by its attributes of these names.
struct Meaning {
  std::string unit;
  std::string description;
};

/// Writes a 1-D data set of double, float or std::int32_t, with its meaning and the groups above it; packed: shuffled
/// and deflated.
template <class Number>
void write(Id parent, const std::string& path, const std::vector<Number>& values, const Meaning& meaning,
           bool packed = false);

/// Writes vectors of three components, (n, 3), which are those of 1-D data sets of the file, by their paths from its
/// root, and 0 beyond: virtual, so that nothing is stored twice.
void write_vectors(Id parent, const std::string& path, const std::vector<std::string>& components,
                   const Meaning& meaning);

// How a data set is stored.
struct Layout {
  bool integer = false;
  std::size_t bytes = 0;  // of a number
  std::vector<std::uint64_t> shape;
};

/// How the data set at `path` is stored.
Layout layout(Id parent, const std::string& path);

/// Values of a data set, row by row, converted to double.
std::vector<double> read(Id parent, const std::string& path);

/// Attributes of what is at `path`.
void set_attribute(Id parent, const std::string& path, const std::string& attribute, double value);
void set_attribute(Id parent, const std::string& path, const std::string& attribute, const std::string& value);
double number_attribute(Id parent, const std::string& path, const std::string& attribute);
std::string text_attribute(Id parent, const std::string& path, const std::string& attribute);

}  // namespace strata::hdf5
