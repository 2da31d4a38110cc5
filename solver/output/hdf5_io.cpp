#include "output/hdf5_io.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <type_traits>

#include "output/run_folder.hpp"

namespace strata::hdf5 {

namespace {

using Text = const std::string&;

// The deepest message of the last error, which tells its cause: the library forgets it once objects have been closed.
std::string cause;

herr_t keep_cause(hid_t errors, void* /*unused*/) {
  const auto take_first = [](unsigned n, const H5E_error2_t* error, void* /*unused*/) -> herr_t {
    if (n == 0 && error->desc != nullptr) cause = error->desc;
    return 0;
  };
  return H5Ewalk2(errors, H5E_WALK_UPWARD, take_first, nullptr);
}

// Of functions without a class.
void require(herr_t result) {
  if (result < 0) throw H5::Exception();
}

// Does `action`, and says what the library refuses, which prints its errors itself unless told not to.
void telling(const std::filesystem::path& file, const std::function<void()>& action) {
  H5Eset_auto2(H5E_DEFAULT, keep_cause, nullptr);
  H5set_free_list_limits(0, 0, 0, 0, 0, 0);  // what the library frees is not kept for the next file
  try {
    action();
  } catch (const H5::Exception&) {
    throw OutputFailure(fmt::format("{}: HDF5 says: {}", file.string(), cause));
  }
}

// Makes the groups above what is made.
H5::LinkCreatPropList with_groups() {
  H5::LinkCreatPropList links;
  links.setCreateIntermediateGroup(true);
  return links;
}

H5::StrType text_type() {
  H5::StrType type(H5::PredType::C_S1, H5T_VARIABLE);
  type.setCset(H5T_CSET_UTF8);
  return type;
}

// Makes a data set without the time, so that files of equal runs are equal.
H5::DataSet make(const H5::Group& parent, Text path, const H5::DataType& type, const H5::DataSpace& space,
                 const H5::DSetCreatPropList& properties, const std::string& unit, const std::string& description) {
  H5Pset_obj_track_times(properties.getId(), false);
  H5::DataSet set = parent.createDataSet(path, type, space, properties, H5::DSetAccPropList::DEFAULT, with_groups());
  set_attribute(set, "unit", unit);
  set_attribute(set, "description", description);
  return set;
}

}  // namespace

void use_file(const std::filesystem::path& file, unsigned how, const Use& use) {
  telling(file, [&] {
    const H5::FileAccPropList access;
    access.setFileLocking(false, true);
    H5AC_cache_config_t known{};  // what the library knows of the file: 2 MB of it and more, if it may
    known.version = H5AC__CURR_CACHE_CONFIG_VERSION;
    require(H5Pget_mdc_config(access.getId(), &known));
    known.set_initial_size = true;
    known.initial_size = known.min_size = known.max_size = std::size_t{1} << 15U;
    require(H5Pset_mdc_config(access.getId(), &known));
    const H5::H5File opened(file.c_str(), how, H5::FileCreatPropList::DEFAULT, access);
    use(opened);
    opened.flush(H5F_SCOPE_GLOBAL);
  });
}

void write_file(const std::filesystem::path& file, const Use& use) {
  telling(file, [&] {
    // The library has the file in memory alone, so that what the disc refuses is said by the system.
    const H5::FileAccPropList access;
    access.setCore(std::size_t{1} << 16U, false);  // bytes taken at a time
    const H5::FileCreatPropList creation;
    creation.setIstorek(1);  // most fields are of one chunk: a tree of 64, as is the default, takes 2 kB of each
    const H5::H5File made(file.c_str(), H5F_ACC_TRUNC, creation, access);
    use(made);
    made.flush(H5F_SCOPE_GLOBAL);
    void* bytes = nullptr;
    made.getVFDHandle(&bytes);
    const ssize_t size = H5Fget_file_image(made.getId(), nullptr, 0);  // less than is taken
    require(size < 0 ? -1 : 0);
    atomic_write(file, {*static_cast<const char**>(bytes), static_cast<std::size_t>(size)}, Sync::no);
  });
}

H5::Group make_group(const H5::Group& parent, const std::string& path) {
  return parent.createGroup(path, with_groups());
}

std::vector<std::string> names(const H5::Group& parent, const std::string& path) {
  const H5::Group group = parent.openGroup(path);
  std::vector<std::string> list(group.getNumObjs());
  for (hsize_t k = 0; k < list.size(); ++k) list[k] = group.getObjnameByIdx(k);
  return list;
}

void copy(const H5::Group& from, const std::string& path, const H5::Group& to) {
  require(H5Ocopy(from.getId(), path.c_str(), to.getId(), path.c_str(), H5P_DEFAULT, with_groups().getId()));
}

template <class Number>
void write(const H5::Group& parent, Text path, const std::vector<Number>& values, Text unit, Text description,
           bool packed) {
  const H5::PredType& type = std::is_same_v<Number, double>  ? H5::PredType::NATIVE_DOUBLE
                             : std::is_same_v<Number, float> ? H5::PredType::NATIVE_FLOAT
                                                             : H5::PredType::NATIVE_INT32;
  const hsize_t n = values.size(), chunk = std::min(n, hsize_t{1} << 18U);  // one for most fields
  const H5::DSetCreatPropList properties;
  if (packed && n > 0) {
    properties.setChunk(1, &chunk);
    properties.setShuffle();
    properties.setDeflate(1);
  }
  make(parent, path, type, H5::DataSpace(1, &n), properties, unit, description).write(values.data(), type);
}
template void write(const H5::Group&, Text, const std::vector<double>&, Text, Text, bool);
template void write(const H5::Group&, Text, const std::vector<float>&, Text, Text, bool);
template void write(const H5::Group&, Text, const std::vector<std::int32_t>&, Text, Text, bool);

void write_vectors(const H5::Group& group, Text path, Text x, Text y, Text unit, Text description) {
  const H5::DataSet first = group.openDataSet(x);
  const H5::DataSpace points = first.getSpace();
  const hsize_t shape[] = {static_cast<hsize_t>(points.getSimpleExtentNpoints()), 3}, column[] = {shape[0], 1};
  const H5::DataSpace space(2, shape);
  const H5::DSetCreatPropList properties;
  for (hsize_t c = 0; c < 2 && shape[0] > 0; ++c) {
    const hsize_t start[] = {0, c};
    space.selectHyperslab(H5S_SELECT_SET, column, start);
    properties.setVirtual(space, ".", group.getObjName() + "/" + (c == 0 ? x : y), points);  // ".": the same file
  }
  make(group, path, first.getDataType(), space, properties, unit, description);
}

void set_attribute(const H5::H5Object& of, const std::string& attribute, double value) {
  const H5::PredType& type = H5::PredType::NATIVE_DOUBLE;
  of.createAttribute(attribute, type, H5::DataSpace()).write(type, &value);
}

void set_attribute(const H5::H5Object& of, const std::string& attribute, const std::string& value) {
  of.createAttribute(attribute, text_type(), H5::DataSpace()).write(text_type(), value);
}

std::string text_attribute(const H5::H5Object& of, const std::string& attribute) {
  std::string value;
  of.openAttribute(attribute).read(text_type(), value);
  return value;
}

}  // namespace strata::hdf5
