#include "output/hdf5_io.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <stdexcept>
#include <type_traits>

#include "output/run_folder.hpp"

namespace strata::hdf5 {

static_assert(std::is_same_v<hid_t, Id> && std::is_same_v<herr_t, int>);

namespace {

// The deepest message of the library's error stack, which tells the cause.
std::string cause() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned n, const H5E_error2_t* error, void* out) -> herr_t {
        if (n == 0 && error->desc != nullptr) *static_cast<std::string*>(out) = error->desc;
        return 0;
      },
      &text);
  return text;
}

template <class Result>
Result checked(Result result, const std::string& what, const char* doing) {
  if (result < 0) throw std::runtime_error(fmt::format("{}: cannot {}: {}", what, doing, cause()));
  return result;
}

// How files are opened; the library, which prints its errors unless told not to, is told so before the first.
Handle file_access() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  H5set_free_list_limits(0, 0, 0, 0, 0, 0);  // what the library frees is not kept for the next file
  Handle access(checked(H5Pcreate(H5P_FILE_ACCESS), "HDF5", "set up file access"), H5Pclose);
  checked(H5Pset_file_locking(access.id(), false, true), "HDF5", "do without file locks");
  return access;
}

Handle text_type() {
  Handle type(checked(H5Tcopy(H5T_C_S1), "HDF5", "make a text type"), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

void remove_link(Id parent, const std::string& name) {
  if (exists(parent, name)) checked(H5Ldelete(parent, name.c_str(), H5P_DEFAULT), name, "be replaced");
}

void put_attribute(Id parent, const std::string& name, const std::string& attribute, hid_t type, const void* value) {
  const std::string what = name + "@" + attribute;
  if (H5Aexists_by_name(parent, name.c_str(), attribute.c_str(), H5P_DEFAULT) > 0)
    checked(H5Adelete_by_name(parent, name.c_str(), attribute.c_str(), H5P_DEFAULT), what, "be replaced");
  const Handle space(checked(H5Screate(H5S_SCALAR), what, "be made"), H5Sclose);
  const Handle made(checked(H5Acreate_by_name(parent, name.c_str(), attribute.c_str(), type, space.id(), H5P_DEFAULT,
                                              H5P_DEFAULT, H5P_DEFAULT),
                            what, "be made"),
                    H5Aclose);
  checked(H5Awrite(made.id(), type, value), what, "be written");
}

void get_attribute(Id parent, const std::string& name, const std::string& attribute, hid_t type, void* value) {
  const std::string what = name + "@" + attribute;
  const Handle from(
      checked(H5Aopen_by_name(parent, name.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT), what, "be opened"),
      H5Aclose);
  checked(H5Aread(from.id(), type, value), what, "be read");
}

}  // namespace

Handle open_file(const std::filesystem::path& file) {
  const Handle access = file_access();
  return {checked(H5Fopen(file.c_str(), H5F_ACC_RDONLY, access.id()), file.string(), "be opened"), H5Fclose};
}

void write_file(const std::filesystem::path& file, std::size_t room, const Change& change) {
  // The library has the file in memory alone, so that what the disc refuses is said by the system.
  const Handle access = file_access();
  checked(H5Pset_fapl_core(access.id(), room, false), file.string(), "be made in memory");
  // Most fields are of one chunk: a tree of 64, as is the default, takes 2 kB of each.
  const Handle tree(checked(H5Pcreate(H5P_FILE_CREATE), "HDF5", "set up a file"), H5Pclose);
  H5Pset_istore_k(tree.id(), 1);
  const Handle made(checked(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, tree.id(), access.id()), file.string(), "be opened"),
                    H5Fclose);
  change(made.id());
  checked(H5Fflush(made.id(), H5F_SCOPE_GLOBAL), file.string(), "be made");
  const auto size = static_cast<std::size_t>(
      checked(H5Fget_file_image(made.id(), nullptr, 0), file.string(), "be made"));  // what is used of it
  void* bytes = nullptr;
  checked(H5Fget_vfd_handle(made.id(), H5P_DEFAULT, &bytes), file.string(), "be made");
  atomic_write(file, {*static_cast<const char**>(bytes), size}, Sync::no);
}

void change_in_place(const std::filesystem::path& file, const Change& change) {
  const Handle access = file_access();
  // What the library knows of the file: 2 MB of it and more, ten times as large in memory, if it may.
  H5AC_cache_config_t known{};
  known.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  checked(H5Pget_mdc_config(access.id(), &known), file.string(), "be set up");
  known.set_initial_size = true;
  known.initial_size = known.min_size = known.max_size = std::size_t{1} << 15U;
  checked(H5Pset_mdc_config(access.id(), &known), file.string(), "be set up");
  const Handle opened(checked(H5Fopen(file.c_str(), H5F_ACC_RDWR, access.id()), file.string(), "be opened"), H5Fclose);
  change(opened.id());
  checked(H5Fflush(opened.id(), H5F_SCOPE_GLOBAL), file.string(), "be written");
}

Handle group(Id parent, const std::string& name) {
  if (exists(parent, name)) return {checked(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), name, "be opened"), H5Gclose};
  const Handle links(checked(H5Pcreate(H5P_LINK_CREATE), name, "be set up"), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  return {checked(H5Gcreate2(parent, name.c_str(), links.id(), H5P_DEFAULT, H5P_DEFAULT), name, "be made"), H5Gclose};
}

bool exists(Id parent, const std::string& path) {
  for (std::size_t end = path.find('/'); end != std::string::npos; end = path.find('/', end + 1)) {
    if (end > 0 && H5Lexists(parent, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(parent, path.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> names(Id parent) {
  std::vector<std::string> list;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  checked(H5Literate(parent, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &list), "group", "be listed");
  return list;
}

void link_to_file(Id parent, const std::string& name, const std::string& file, const std::string& path) {
  checked(H5Lcreate_external(file.c_str(), path.c_str(), parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), name,
          "be linked");
}

void copy(Id from, const std::string& path, Id parent, const std::string& name) {
  remove_link(parent, name);
  checked(H5Ocopy(from, path.c_str(), parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), name, "be copied");
}

template <class Number>
void write(Id parent, const std::string& name, const std::vector<Number>& values, const std::string& unit,
           Storage storage) {
  const hid_t type = std::is_same_v<Number, double>  ? H5T_NATIVE_DOUBLE
                     : std::is_same_v<Number, float> ? H5T_NATIVE_FLOAT
                                                     : H5T_NATIVE_INT32;
  const hsize_t n = values.size();
  remove_link(parent, name);
  {
    const Handle properties(checked(H5Pcreate(H5P_DATASET_CREATE), name, "be set up"), H5Pclose);
    H5Pset_obj_track_times(properties.id(), false);  // files of equal runs are equal
    if (storage == Storage::packed && n > 0) {
      const hsize_t chunk = std::min(n, hsize_t{1} << 18U);  // one for most fields
      checked(H5Pset_chunk(properties.id(), 1, &chunk), name, "be chunked");
      checked(H5Pset_shuffle(properties.id()), name, "be shuffled");
      checked(H5Pset_deflate(properties.id(), 1), name, "be compressed");
    }
    const Handle space(checked(H5Screate_simple(1, &n, nullptr), name, "be set up"), H5Sclose);
    const Handle set(
        checked(H5Dcreate2(parent, name.c_str(), type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), name,
                "be made"),
        H5Dclose);
    checked(H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name, "be written");
  }
  set_attribute(parent, name, "unit", unit);
}
template void write(Id, const std::string&, const std::vector<double>&, const std::string&, Storage);
template void write(Id, const std::string&, const std::vector<float>&, const std::string&, Storage);
template void write(Id, const std::string&, const std::vector<std::int32_t>&, const std::string&, Storage);

std::vector<double> read(Id parent, const std::string& name) {
  const Handle set(checked(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), name, "be opened"), H5Dclose);
  const Handle space(checked(H5Dget_space(set.id()), name, "be measured"), H5Sclose);
  std::vector<double> values(
      static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space.id()), name, "be measured")));
  checked(H5Dread(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name, "be read");
  return values;
}

void set_attribute(Id parent, const std::string& name, const std::string& attribute, double value) {
  put_attribute(parent, name, attribute, H5T_NATIVE_DOUBLE, &value);
}

void set_attribute(Id parent, const std::string& name, const std::string& attribute, const std::string& value) {
  const char* text = value.c_str();
  put_attribute(parent, name, attribute, text_type().id(), &text);
}

double number_attribute(Id parent, const std::string& name, const std::string& attribute) {
  double value = 0.0;
  get_attribute(parent, name, attribute, H5T_NATIVE_DOUBLE, &value);
  return value;
}

std::string text_attribute(Id parent, const std::string& name, const std::string& attribute) {
  char* text = nullptr;
  get_attribute(parent, name, attribute, text_type().id(), &text);
  std::string value = text;
  H5free_memory(text);
  return value;
}

}  // namespace strata::hdf5
