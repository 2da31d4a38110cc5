// Reading result.h5 back, for tests.
#pragma once

#include <string>
#include <vector>

#include "output/hdf5_io.hpp"

namespace strata::hdf5 {

inline H5::H5File open_file(const std::filesystem::path& file) {
  return {file.c_str(), H5F_ACC_RDONLY};
}

inline bool is_group(const H5::Group& parent, const std::string& path) {
  return parent.childObjType(path) == H5O_TYPE_GROUP;
}

inline std::vector<hsize_t> shape(const H5::Group& parent, const std::string& path) {
  const H5::DataSpace space = parent.openDataSet(path).getSpace();
  std::vector<hsize_t> found(static_cast<std::size_t>(space.getSimpleExtentNdims()));
  space.getSimpleExtentDims(found.data());
  return found;
}

// Values of a data set, row by row.
inline std::vector<double> read(const H5::Group& parent, const std::string& path) {
  const H5::DataSet set = parent.openDataSet(path);
  std::vector<double> values(static_cast<std::size_t>(set.getSpace().getSimpleExtentNpoints()));
  set.read(values.data(), H5::PredType::NATIVE_DOUBLE);
  return values;
}

inline std::string text_attribute(const H5::Group& parent, const std::string& path, const std::string& attribute) {
  return is_group(parent, path) ? text_attribute(parent.openGroup(path), attribute)
                                : text_attribute(parent.openDataSet(path), attribute);
}

inline double number_attribute(const H5::Group& parent, const std::string& group, const std::string& attribute) {
  double value = 0.0;
  parent.openGroup(group).openAttribute(attribute).read(H5::PredType::NATIVE_DOUBLE, &value);
  return value;
}

}  // namespace strata::hdf5
