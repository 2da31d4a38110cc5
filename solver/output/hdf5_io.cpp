#include "output/hdf5_io.hpp"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <cstddef>
#include <stdexcept>
#include <type_traits>
#include <vector>

#include "output/run_folder.hpp"

namespace strata::hdf5 {

static_assert(std::is_same_v<hid_t, Id> && std::is_same_v<herr_t, int>);

namespace {

// The library prints its errors unless told not to; they are exceptions here.
class Silence {
 public:
  Silence() {
    H5Eget_auto2(H5E_DEFAULT, &print_, &data_);
    H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
  }
  Silence(const Silence&) = delete;
  Silence& operator=(const Silence&) = delete;
  ~Silence() { H5Eset_auto2(H5E_DEFAULT, print_, data_); }

 private:
  H5E_auto2_t print_ = nullptr;
  void* data_ = nullptr;
};

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

[[noreturn]] void fail(const std::string& what, const char* doing) {
  throw std::runtime_error(fmt::format("{}: cannot {}: {}", what, doing, cause()));
}

template <class Result>
Result checked(Result result, const std::string& what, const char* doing) {
  if (result < 0) fail(what, doing);
  return result;
}

Handle file_access() {
  Handle access(checked(H5Pcreate(H5P_FILE_ACCESS), "HDF5", "set up file access"), H5Pclose);
  checked(H5Pset_file_locking(access.id(), false, true), "HDF5", "do without file locks");
  return access;
}

Handle space_of(std::size_t n, bool extendible) {
  const hsize_t now = n;
  const hsize_t most = extendible ? H5S_UNLIMITED : now;
  return {checked(H5Screate_simple(1, &now, &most), "HDF5", "make a data space"), H5Sclose};
}

Handle text_type() {
  Handle type(checked(H5Tcopy(H5T_C_S1), "HDF5", "make a text type"), H5Tclose);
  H5Tset_size(type.id(), H5T_VARIABLE);
  H5Tset_cset(type.id(), H5T_CSET_UTF8);
  return type;
}

Handle open_dataset(Id parent, const std::string& name) {
  return {checked(H5Dopen2(parent, name.c_str(), H5P_DEFAULT), name, "be opened"), H5Dclose};
}

enum class Storage { contiguous, compressed, extendible };

// Elements of a chunk of a compressed data set of n: one chunk for most fields.
hsize_t chunk_of(std::size_t n) {
  return std::min<std::size_t>(n, std::size_t{1} << 18U);
}

bool deflates() {
  return H5Zfilter_avail(H5Z_FILTER_DEFLATE) > 0;
}

// Makes a data set that does not record when: files of equal runs are equal. The element type on disc is that in
// memory.
Handle make_dataset(Id parent, const std::string& name, hid_t type, std::size_t n, Storage storage) {
  const Handle properties(checked(H5Pcreate(H5P_DATASET_CREATE), name, "be set up"), H5Pclose);
  H5Pset_obj_track_times(properties.id(), false);
  if (storage == Storage::extendible || (storage == Storage::compressed && n > 0)) {
    // Small chunks where the length is not known beforehand.
    const hsize_t chunk = storage == Storage::extendible ? 512 : chunk_of(n);
    checked(H5Pset_chunk(properties.id(), 1, &chunk), name, "be chunked");
  }
  if (storage == Storage::compressed && n > 0 && deflates()) {
    checked(H5Pset_shuffle(properties.id()), name, "be shuffled");
    checked(H5Pset_deflate(properties.id(), 1), name, "be compressed");
  }
  const Handle space = space_of(n, storage == Storage::extendible);
  return {checked(H5Dcreate2(parent, name.c_str(), type, space.id(), H5P_DEFAULT, properties.id(), H5P_DEFAULT), name,
                  "be made"),
          H5Dclose};
}

// Writes the chunks of a compressed data set, packed here: the filters' own search takes three times as long.
void write_chunks(Id set, const std::string& name, std::span<const std::byte> values, Packer& packer) {
  constexpr std::size_t width = 4;
  const std::size_t n = values.size() / width, chunk = chunk_of(n);
  for (std::size_t from = 0; from < n; from += chunk) {
    const std::size_t count = std::min(chunk, n - from);
    std::span<const std::byte> part = values.subspan(width * from, width * count);
    std::vector<std::byte> whole;
    if (count < chunk) {  // the last one is filled up
      whole.assign(part.begin(), part.end());
      whole.resize(width * chunk);
      part = whole;
    }
    const std::vector<unsigned char> packed = packer.shuffled_and_deflated(part);
    const hsize_t offset = from;
    checked(H5Dwrite_chunk(set, H5P_DEFAULT, 0, &offset, packed.size(), packed.data()), name, "be written");
  }
}

template <class T>
void write_dataset(Id parent, const std::string& name, hid_t type, std::span<const T> values, const std::string& unit,
                   Storage storage, Packer* packer = nullptr) {
  const Silence silence;
  {
    const Handle set = make_dataset(parent, name, type, values.size(), storage);
    if (packer != nullptr && !values.empty() && deflates())
      write_chunks(set.id(), name, std::as_bytes(values), *packer);
    else
      checked(H5Dwrite(set.id(), type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name, "be written");
  }
  set_attribute(parent, name, "unit", unit);
}

void put_attribute(Id parent, const std::string& name, const std::string& attribute, hid_t type, const void* value) {
  const Silence silence;
  const std::string what = name + "@" + attribute;
  const htri_t there = H5Aexists_by_name(parent, name.c_str(), attribute.c_str(), H5P_DEFAULT);
  const Handle space(checked(H5Screate(H5S_SCALAR), what, "be made"), H5Sclose);
  const Handle made(
      checked(there > 0 ? H5Aopen_by_name(parent, name.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT)
                        : H5Acreate_by_name(parent, name.c_str(), attribute.c_str(), type, space.id(), H5P_DEFAULT,
                                            H5P_DEFAULT, H5P_DEFAULT),
              what, "be made"),
      H5Aclose);
  checked(H5Awrite(made.id(), type, value), what, "be written");
}

Handle open_attribute(Id parent, const std::string& name, const std::string& attribute) {
  return {checked(H5Aopen_by_name(parent, name.c_str(), attribute.c_str(), H5P_DEFAULT, H5P_DEFAULT),
                  name + "@" + attribute, "be opened"),
          H5Aclose};
}

}  // namespace

void make_file(const std::filesystem::path& file) {
  // An image in memory, so that what the disc refuses is said by the system and not by the library.
  const Silence silence;
  const Handle access = file_access();
  checked(H5Pset_fapl_core(access.id(), std::size_t{1} << 16, false), file.string(), "be made in memory");
  std::string image;
  {
    const Handle made(
        checked(H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, access.id()), file.string(), "be made"), H5Fclose);
    checked(H5Fflush(made.id(), H5F_SCOPE_GLOBAL), file.string(), "be made");
    image.resize(static_cast<std::size_t>(checked(H5Fget_file_image(made.id(), nullptr, 0), file.string(), "be made")));
    checked(H5Fget_file_image(made.id(), image.data(), image.size()), file.string(), "be made");
  }
  atomic_write(file, image);
}

Handle open_file(const std::filesystem::path& file, bool writable) {
  const Silence silence;
  const Handle access = file_access();
  return {
      checked(H5Fopen(file.c_str(), writable ? H5F_ACC_RDWR : H5F_ACC_RDONLY, access.id()), file.string(), "be opened"),
      H5Fclose};
}

Handle group(Id parent, const std::string& name) {
  const Silence silence;
  if (exists(parent, name)) {
    return {checked(H5Gopen2(parent, name.c_str(), H5P_DEFAULT), name, "be opened"), H5Gclose};
  }
  const Handle links(checked(H5Pcreate(H5P_LINK_CREATE), name, "be set up"), H5Pclose);
  H5Pset_create_intermediate_group(links.id(), 1);
  return {checked(H5Gcreate2(parent, name.c_str(), links.id(), H5P_DEFAULT, H5P_DEFAULT), name, "be made"), H5Gclose};
}

bool exists(Id parent, const std::string& path) {
  const Silence silence;
  for (std::size_t end = path.find('/'); end != std::string::npos; end = path.find('/', end + 1)) {
    if (end > 0 && H5Lexists(parent, path.substr(0, end).c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return H5Lexists(parent, path.c_str(), H5P_DEFAULT) > 0;
}

std::vector<std::string> names(Id parent) {
  const Silence silence;
  std::vector<std::string> list;
  const auto visit = [](hid_t, const char* name, const H5L_info_t*, void* out) -> herr_t {
    static_cast<std::vector<std::string>*>(out)->emplace_back(name);
    return 0;
  };
  checked(H5Literate(parent, H5_INDEX_NAME, H5_ITER_INC, nullptr, visit, &list), "group", "be listed");
  return list;
}

void remove(Id parent, const std::string& name) {
  const Silence silence;
  checked(H5Ldelete(parent, name.c_str(), H5P_DEFAULT), name, "be removed");
}

void write(Id parent, const std::string& name, std::span<const double> values, const std::string& unit) {
  write_dataset(parent, name, H5T_NATIVE_DOUBLE, values, unit, Storage::contiguous);
}

void write(Id parent, const std::string& name, std::span<const std::int32_t> values, const std::string& unit) {
  write_dataset(parent, name, H5T_NATIVE_INT32, values, unit, Storage::contiguous);
}

void write_compressed(Id parent, const std::string& name, std::span<const float> values, const std::string& unit,
                      Packer& packer) {
  write_dataset(parent, name, H5T_NATIVE_FLOAT, values, unit, Storage::compressed, &packer);
}

void write_compressed(Id parent, const std::string& name, std::span<const std::int32_t> values, const std::string& unit,
                      Packer& packer) {
  write_dataset(parent, name, H5T_NATIVE_INT32, values, unit, Storage::compressed, &packer);
}

void link(Id parent, const std::string& name, const std::string& path) {
  const Silence silence;
  checked(H5Lcreate_hard(parent, path.c_str(), parent, name.c_str(), H5P_DEFAULT, H5P_DEFAULT), name, "be linked");
}

void rewrite(Id parent, const std::string& name, std::span<const double> values, const std::string& unit) {
  if (!exists(parent, name)) {
    write_dataset(parent, name, H5T_NATIVE_DOUBLE, values, unit, Storage::extendible);
    return;
  }
  const Silence silence;
  const Handle set = open_dataset(parent, name);
  const hsize_t n = values.size();
  checked(H5Dset_extent(set.id(), &n), name, "be resized");
  checked(H5Dwrite(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name, "be written");
}

std::size_t length(Id parent, const std::string& name) {
  const Silence silence;
  const Handle set = open_dataset(parent, name);
  const Handle space(checked(H5Dget_space(set.id()), name, "be measured"), H5Sclose);
  return static_cast<std::size_t>(checked(H5Sget_simple_extent_npoints(space.id()), name, "be measured"));
}

std::vector<double> read(Id parent, const std::string& name) {
  const Silence silence;
  std::vector<double> values(length(parent, name));
  const Handle set = open_dataset(parent, name);
  checked(H5Dread(set.id(), H5T_NATIVE_DOUBLE, H5S_ALL, H5S_ALL, H5P_DEFAULT, values.data()), name, "be read");
  return values;
}

void set_attribute(Id parent, const std::string& name, const std::string& attribute, double value) {
  put_attribute(parent, name, attribute, H5T_NATIVE_DOUBLE, &value);
}

void set_attribute(Id parent, const std::string& name, const std::string& attribute, const std::string& value) {
  const Handle type = text_type();
  const char* text = value.c_str();
  put_attribute(parent, name, attribute, type.id(), &text);
}

double number_attribute(Id parent, const std::string& name, const std::string& attribute) {
  const Silence silence;
  const Handle from = open_attribute(parent, name, attribute);
  double value = 0.0;
  checked(H5Aread(from.id(), H5T_NATIVE_DOUBLE, &value), name, "be read");
  return value;
}

std::string text_attribute(Id parent, const std::string& name, const std::string& attribute) {
  const Silence silence;
  const Handle from = open_attribute(parent, name, attribute);
  const Handle type = text_type();
  char* text = nullptr;
  checked(H5Aread(from.id(), type.id(), &text), name, "be read");
  std::string value = text;
  H5free_memory(text);
  return value;
}

}  // namespace strata::hdf5
