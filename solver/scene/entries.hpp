// A scene's text as a flat list of keys and values with their places, from the file, its variants and --set alike; and
// from there to a scene.
#pragma once

#include <map>
#include <string>
#include <string_view>

#include <toml++/toml.h>

#include "scene/keys.hpp"
#include "scene/messages.hpp"

namespace strata {

// Where a table was read from. A text given with --set has no lines: `name` is then the whole "--set key=value".
struct Origin {
  std::string name;
  int rank = 0;  // 0 the scene itself, 1 its variant, 2 --set
};

// What was given for a key; of tables and of elements of lists only the place.
struct Given {
  const Key* key = nullptr;
  const toml::node* value = nullptr;  // belongs to the parsed table, which must live as long
  Origin origin;
  Where where;
  bool sound = true;  // of the right type and within bounds
};

// By full path: keys ("domain.width_m"), tables ("domain") and elements of lists ("strata.layers[1]"); "" is the start
// of the file.
struct Entries {
  std::map<std::string, Given, std::less<>> at;

  bool given(std::string_view path) const { return at.contains(path); }
  bool sound(std::string_view path) const { return !given(path) || at.find(path)->second.sound; }
  bool usable(std::string_view path) const { return given(path) && sound(path); }
};

/// The place of `path`, or of the innermost table or list that would hold it, or the start of the file.
/// Throws nothing but std::bad_alloc.
const Where& where_is(const Entries& entries, std::string_view path);

/// The place of a node or key of a table read from `origin`. Throws nothing but std::bad_alloc.
Where where_of(const Origin& origin, const toml::source_region& source);

/// A value as it would be typed, cut short where it is long. Throws nothing but std::bad_alloc.
std::string as_typed(const toml::node& value);

/// The double that a number is, of whatever type. Throws nothing.
double as_number(const toml::node& number);

/// Adds every known key in `table` to `entries`; unknown, repeated and unsound ones are added to `faults`. At the top
/// level of a scene variants and claims are left out. prefix: path of the table, "" for the top level.
/// Throws nothing but std::bad_alloc.
void flatten(const toml::table& table, const std::string& prefix, const Origin& origin, Entries& entries,
             Faults& faults);

/// The same for one key and its value. path: full path of the key; where: its place. Throws nothing but std::bad_alloc.
void flatten_value(const std::string& path, const toml::node& value, const Where& where, const Origin& origin,
                   Entries& entries, Faults& faults);

/// `base` with the values of `above` in the place of its own. Throws nothing but std::bad_alloc.
void lay_over(Entries& base, const Entries& above);

/// Whether the value is one that its key may take; what is wrong with it is added to `faults`. path: full path of the
/// key, as it stands in messages. Throws nothing but std::bad_alloc.
bool check_value(const std::string& path, const Given& given, Faults& faults);

/// Writes a sound value to the member that its key leads to; layers and interfaces, which name others, are left as they
/// are. index: of the rock or law, else 0. Throws nothing but std::bad_alloc.
void apply_value(const Given& given, std::size_t index, Scene& scene);

/// Whether each [[claim]] has its text keys; what is wrong is added to `faults`. claims: the value of `claim`.
/// Throws nothing but std::bad_alloc.
void check_claims(const toml::node& claims, const Origin& origin, Faults& faults);

/// The scene that `entries` describe, each key that is absent with its default. Missing keys, names that do not exist,
/// keys of another interface law and layers that do not add up are added to `faults`; the scene is then of use only for
/// finding more of them. Throws nothing but std::bad_alloc.
Scene build_scene(const Entries& entries, Faults& faults);

}  // namespace strata
