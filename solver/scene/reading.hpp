// A scene while it is read: what was given for which key, and where; the scene made of it; what is wrong with it.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <fmt/format.h>

#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "scene/keys.hpp"
#include "scene/messages.hpp"
#include "scene/scene.hpp"

namespace strata {

/// A value as TOML on one line.
std::string as_one_line(const toml::node& value);

/// How a key of an element is written where a list of tables is given a table of numbers ("strata.layers.1.rock" in a
/// file): "\"strata.layers[1].rock\""; else "".
std::string quoted_element(const std::string& path, const toml::node& value);

/// A value as it would be typed, cut short where it is long.
std::string as_typed(const toml::node& value);

// The place of a node of a table read from `source`; with --set that is all there is to say.
inline Where where_of(const Where& source, const toml::source_region& region) {
  if (source.rank == 2) return source;
  return {source.source, source.rank, region.begin.line, region.begin.column};
}

// What was given for a key, or a table or an element of a list that keys were given in.
struct Given {
  const Key* key = nullptr;
  const toml::node* value = nullptr;  // belongs to the parsed table, which must live as long; of tables none
  Where where;
  bool sound = true;  // of the right type and within bounds
};

struct Reading {
  Scene scene;
  // By full path: keys ("domain.width_m", "strata.layers[1].rock"), tables ("domain") and elements of lists
  // ("strata.layers[1]"); "" is the start of the file.
  std::map<std::string, Given, std::less<>> entries;
  std::vector<Fault> faults, notes;
  std::set<std::string> used;  // "rock.NAME" and "interface.NAME" that a layer or border has in the scene or a variant

  bool given(std::string_view path) const { return entries.contains(path); }
  // Whether what was given for the path, if anything, is of use; of a list all that is in it.
  bool sound(std::string_view path) const;
  // Whether the keys were given, each with a value of use.
  bool usable(const auto&... paths) const { return ((given(paths) && sound(paths)) && ...); }
  // Where the path was given, or else the innermost table or list that would hold it.
  const Where& where(std::string_view path) const;

  template <class... Values>
  void fault(const Where& where, fmt::format_string<const Values&...> text, const Values&... values) {
    faults.push_back({where, fmt::format(text, values...)});
  }
  template <class... Values>
  void refuse(std::string_view path, fmt::format_string<const Values&...> text, const Values&... values) {
    fault(where(path), text, values...);
  }
  // Refuses the value of a key that is usable: "numerics.cell_m = 3 ...".
  template <class... Values>
  void refuse_if(bool applies, std::string_view path, fmt::format_string<const Values&...> text,
                 const Values&... values) {
    if (!applies || !usable(path)) return;
    refuse(path, "{} = {} {}", path, as_typed(*entries.find(path)->second.value), fmt::format(text, values...));
  }
};

// A value, or an element of one, and the path that messages have for it.
struct Value {
  std::string path;
  const Key& key;
  const toml::node& node;
  Where where;
  std::vector<Fault>& faults;
};

/// Takes up every known key in `table` with a value of its own; unknown, repeated and unsound ones are faults. Later
/// ranks replace what earlier ones gave. At the top level of a scene variants are left out. prefix: path of
/// the table, "" for the top level.
void take_table(Reading& reading, const toml::table& table, const std::string& prefix, const Where& source);

/// The same for one key and its value. path: full path of the key; where: its place.
void take_value(Reading& reading, const std::string& path, const toml::node& value, const Where& where);

/// Makes the scene of what was given, each key that is absent with its default. Missing keys, names that do not exist,
/// keys of another interface law and layers that do not add up are faults; the scene is then of use only for finding
/// more of them.
void build_scene(Reading& reading);

/// Whether the parts of the scene fit each other: faults where cells do not divide the block, interfaces or particles
/// do not fit the cells, the fracture does not lie in the block or meets itself, where the run could not end, and where
/// keys do not go together. What depends on a value that is itself missing or of no use is left out.
void check_scene(Reading& reading);

}  // namespace strata
