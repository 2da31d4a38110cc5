#include "output/hdf5_io.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <type_traits>

#include "output/run_folder.hpp"

namespace strata::hdf5 {

static_assert(std::is_same_v<hid_t, Id> && std::is_same_v<herr_t, int>);

namespace {

// Throws with the deepest message of the library's error stack, which tells the cause, where a result is below 0.
void require(Id result, const std::string& what) {
  if (result >= 0) return;
  std::string cause;
  const auto take_first = [](unsigned n, const H5E_error2_t* error, void* out) -> herr_t {
    if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
    return 0;
  };
  H5Ewalk2(H5E_DEFAULT, H5E_WALK_UPWARD, take_first, &cause);
  throw OutputFailure(fmt::format("{}: HDF5 says: {}", what, cause));
}

// How files are opened; the library, which prints its errors unless told not to, is told so before the first.
Handle file_access() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5set_free_list_limits(0, 0, 0, 0, 0, 0);  // what the library frees is not kept for the next file
  const Id access = H5Pcreate(H5P_FILE_ACCESS);
  H5Pset_file_locking(access, false, true);
  return {access, H5Pclose, "file access"};
}

// Makes the groups above what is made.
Handle with_groups() {
  const Id links = H5Pcreate(H5P_LINK_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  return {links, H5Pclose, "links"};
}

Handle data_set(Id parent, const std::string& path) {
  return {H5Dopen2(parent, path.c_str(), H5P_DEFAULT), H5Dclose, path};
}

// How data sets are made: without the time, so that files of equal runs are equal.
Handle made_so() {
  const Id properties = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_obj_track_times(properties, false);
  return {properties, H5Pclose, "data set"};
}

Handle text_type() {
  const Id type = H5Tcopy(H5T_C_S1);
  H5Tset_size(type, H5T_VARIABLE);
  H5Tset_cset(type, H5T_CSET_UTF8);
  return {type, H5Tclose, "text"};
}

void put_attribute(Id parent, const std::string& path, const std::string& attribute, Id type, const void* value) {
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, path);
  const Handle made(
      H5Acreate_by_name(parent, path.c_str(), attribute.c_str(), type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT),
      H5Aclose, path + "@" + attribute);
  require(H5Awrite(made, type, value), path);
}

void get_attribute(Id parent, const std::string& path, const std::string& attribute, Id type, void* value) {
  const Handle from(H5Aopen_by_name(parent, path.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT), H5Aclose,
                    path + "@" + attribute);
  require(H5Aread(from, type, value), path);
}

void set_meaning(Id set, const Meaning& meaning) {
  set_attribute(set, ".", "unit", meaning.unit);
  set_attribute(set, ".", "description", meaning.description);
}

}  // namespace

Handle::Handle(Id id, int (*close)(Id), const std::string& what) : id_(id), close_(close) {
  require(id, what);
}

Handle open_file(const std::filesystem::path& file) {
  return {H5Fopen(file.c_str(), H5F_ACC_RDONLY, file_access()), H5Fclose, file.string()};
}

void write_file(const std::filesystem::path& file, const Change& change) {
  // The library has the file in memory alone, so that what the disc refuses is said by the system.
  constexpr std::size_t taken_at_a_time = std::size_t{1} << 16U;  // bytes
  const Handle access = file_access(), creation(H5Pcreate(H5P_FILE_CREATE), H5Pclose, file.string());
  H5Pset_fapl_core(access, taken_at_a_time, false);
  H5Pset_istore_k(creation, 1);  // most fields are of one chunk: a tree of 64, as is the default, takes 2 kB of each
  const Handle made(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, creation, access), H5Fclose, file.string());
  change(made);
  require(H5Fflush(made, H5F_SCOPE_GLOBAL), file.string());
  const ssize_t size = H5Fget_file_image(made, nullptr, 0);
  void* bytes = nullptr;
  require(std::min<Id>(size, H5Fget_vfd_handle(made, H5P_DEFAULT, &bytes)), file.string());
  atomic_write(file, {*static_cast<const char**>(bytes), static_cast<std::size_t>(size)}, Sync::no);
}

void change_in_place(const std::filesystem::path& file, const Change& change) {
  const Handle access = file_access();
  H5AC_cache_config_t known{};  // what the library knows of the file: 2 MB of it and more, if it may
  known.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  require(H5Pget_mdc_config(access, &known), file.string());
  known.set_initial_size = true;
  known.initial_size = known.min_size = known.max_size = std::size_t{1} << 15U;
  require(H5Pset_mdc_config(access, &known), file.string());
  const Handle opened(H5Fopen(file.c_str(), H5F_ACC_RDWR, access), H5Fclose, file.string());
  change(opened);
  require(H5Fflush(opened, H5F_SCOPE_GLOBAL), file.string());
}

bool exists(Id parent, const std::string& path) {
  return H5Lexists(parent, path.c_str(), H5P_DEFAULT) > 0;
}

void make_group(Id parent, const std::string& path) {
  const Handle made(H5Gcreate2(parent, path.c_str(), H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Gclose, path);
}

std::vector<std::string> names(Id parent, const std::string& path) {
  std::vector<std::string> list;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  require(H5Literate_by_name(parent, path.c_str(), H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &list, H5P_DEFAULT),
          path);
  return list;
}

void copy(Id from, const std::string& path, Id to) {
  require(H5Ocopy(from, path.c_str(), to, path.c_str(), H5P_DEFAULT, with_groups()), path);
}

template <class Number>
void write(Id parent, const std::string& path, const std::vector<Number>& values, const Meaning& meaning, bool packed) {
  const Id type = std::is_same_v<Number, double>  ? H5T_NATIVE_DOUBLE
                  : std::is_same_v<Number, float> ? H5T_NATIVE_FLOAT
                                                  : H5T_NATIVE_INT32;
  const hsize_t n = values.size();
  const Handle properties = made_so();
  if (packed && n > 0) {
    const hsize_t chunk = std::min(n, hsize_t{1} << 18U);  // one for most fields
    H5Pset_chunk(properties, 1, &chunk);
    H5Pset_shuffle(properties);
    H5Pset_deflate(properties, 1);
  }
  const Handle space(H5Screate_simple(1, &n, nullptr), H5Sclose, path);
  const Handle set(H5Dcreate2(parent, path.c_str(), type, space, with_groups(), properties, H5P_DEFAULT), H5Dclose,
                   path);
  require(H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  set_meaning(set, meaning);
}
template void write(Id, const std::string&, const std::vector<double>&, const Meaning&, bool);
template void write(Id, const std::string&, const std::vector<float>&, const Meaning&, bool);
template void write(Id, const std::string&, const std::vector<std::int32_t>&, const Meaning&, bool);

void write_vectors(Id parent, const std::string& path, const std::vector<std::string>& components,
                   const Meaning& meaning) {
  const Handle first = data_set(parent, components.front());
  const Handle type(H5Dget_type(first), H5Tclose, path), points(H5Dget_space(first), H5Sclose, path);
  const hsize_t shape[] = {static_cast<hsize_t>(H5Sget_simple_extent_npoints(points)), 3}, column[] = {shape[0], 1};
  const Handle properties = made_so(), space(H5Screate_simple(2, shape, nullptr), H5Sclose, path);
  for (hsize_t c = 0; c < components.size() && shape[0] > 0; ++c) {
    const hsize_t start[] = {0, c};
    require(H5Sselect_hyperslab(space, H5S_SELECT_SET, start, nullptr, column, nullptr), path);
    require(H5Pset_virtual(properties, space, ".", components[c].c_str(), points), path);  // ".": the same file
  }
  const Handle set(H5Dcreate2(parent, path.c_str(), type, space, with_groups(), properties, H5P_DEFAULT), H5Dclose,
                   path);
  set_meaning(set, meaning);
}

Layout layout(Id parent, const std::string& path) {
  const Handle set = data_set(parent, path);
  const Handle space(H5Dget_space(set), H5Sclose, path), type(H5Dget_type(set), H5Tclose, path);
  Layout found{H5Tget_class(type) == H5T_INTEGER, H5Tget_size(type), {}};
  hsize_t shape[H5S_MAX_RANK];
  const int rank = H5Sget_simple_extent_dims(space, shape, nullptr);
  require(rank, path);
  found.shape.assign(shape, shape + rank);
  return found;
}

std::vector<double> read(Id parent, const std::string& path) {
  const Handle set = data_set(parent, path);
  const Handle space(H5Dget_space(set), H5Sclose, path);
  std::vector<double> values(static_cast<std::size_t>(H5Sget_simple_extent_npoints(space)));
  require(H5Dread(set, H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), path);
  return values;
}

void set_attribute(Id parent, const std::string& path, const std::string& attribute, double value) {
  put_attribute(parent, path, attribute, H5T_NATIVE_DOUBLE, &value);
}

void set_attribute(Id parent, const std::string& path, const std::string& attribute, const std::string& value) {
  const char* text = value.c_str();
  put_attribute(parent, path, attribute, text_type(), &text);
}

double number_attribute(Id parent, const std::string& path, const std::string& attribute) {
  double value = 0.0;
  get_attribute(parent, path, attribute, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::string text_attribute(Id parent, const std::string& path, const std::string& attribute) {
  char* text = nullptr;
  get_attribute(parent, path, attribute, text_type(), &text);
  std::string value = text;
  H5free_memory(text);
  return value;
}

}  // namespace strata::hdf5
