// What is wrong with a scene, gathered so that all of it is reported in one pass.
#pragma once

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace strata {

// A place in the input: "exp1.toml:14:1" or "--set key.path=value".
struct Where {
  std::string text;
  unsigned line = 0;
  unsigned column = 0;
  int rank = 0;  // 0 the scene itself, 1 its variant, 2 --set
};

struct Fault {
  Where where;
  std::string text;
};

struct Faults {
  std::vector<Fault> list;

  void add(const Where& where, std::string text) { list.push_back({where, std::move(text)}); }
};

/// The faults as lines "where: what", in the order of the input and each once. Words of more than 100 bytes and texts
/// of more than 1000 are shortened in the middle, control characters are written out. Throws nothing but
/// std::bad_alloc.
std::vector<std::string> as_lines(const Faults& faults);

// Where each key of a scene ("domain.width_m"), each table ("domain") and each element of a list ("strata.layers[1]",
// "fracture.path_m[0]") was given, and which keys were given with a value that is no use.
struct Positions {
  std::map<std::string, Where, std::less<>> at;
  std::set<std::string, std::less<>> unsound;
  Where start;  // of the file

  bool given(std::string_view path) const { return at.contains(path); }
  bool sound(std::string_view path) const { return !unsound.contains(path); }
  bool usable(std::string_view path) const { return given(path) && sound(path); }
};

/// The place of `path`, or of the innermost table or list that would hold it, or the start of the file.
/// Throws nothing but std::bad_alloc.
Where where_is(const Positions& positions, std::string_view path);

}  // namespace strata
