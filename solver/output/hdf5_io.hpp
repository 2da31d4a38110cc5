// What the output needs beyond HDF5's own classes. Paths lead from a file or a group.
#pragma once

#include <H5Cpp.h>

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace strata::hdf5 {

// Handed an open file. Where the library refuses anything in it, what opened the file throws OutputFailure, naming it
// and the library's cause.
using Use = std::function<void(const H5::H5File& file)>;

/// Makes `file` in memory and writes it in one piece; what was there stays where that fails.
void write_file(const std::filesystem::path& file, const Use& use);

/// Uses `file` where it lies, without a lock, so that a reader cannot stop a run. how: H5F_ACC_RDONLY, or H5F_ACC_RDWR
/// to add what is too large for memory. That must have its room on the disc already, and a process that is killed
/// meanwhile leaves the file torn.
void use_file(const std::filesystem::path& file, unsigned how, const Use& use);

/// Makes a group, with those above it.
H5::Group make_group(const H5::Group& parent, const std::string& path);

/// Names of what is in a group, in alphabetical order.
std::vector<std::string> names(const H5::Group& parent, const std::string& path = ".");

/// Copies what is at `path` below `from` to the same path below `to`, with the groups above it.
void copy(const H5::Group& from, const std::string& path, const H5::Group& to);

/// Writes a 1-D data set of double, float or std::int32_t, with the groups above it and its attributes of these names;
/// packed: shuffled and deflated.
template <class Number>
void write(const H5::Group& parent, const std::string& path, const std::vector<Number>& values, const std::string& unit,
           const std::string& description, bool packed = false);

/// Writes vectors of three components, (n, 3): two 1-D data sets of the group, and 0. Virtual: nothing is stored twice.
void write_vectors(const H5::Group& group, const std::string& path, const std::string& x, const std::string& y,
                   const std::string& unit, const std::string& description);

/// Attributes of a file, group or data set.
void set_attribute(const H5::H5Object& of, const std::string& attribute, double value);
void set_attribute(const H5::H5Object& of, const std::string& attribute, const std::string& value);
std::string text_attribute(const H5::H5Object& of, const std::string& attribute);

}  // namespace strata::hdf5
