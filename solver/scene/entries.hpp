// A scene's text as a flat list of keys and values with their places: from the file, its variants and --set alike.
#pragma once

#include <map>
#include <string>
#include <string_view>
#include <vector>

#include <toml++/toml.h>

#include "scene/faults.hpp"
#include "scene/keys.hpp"

namespace strata {

// Where a table was read from. A text given with --set has no lines: `name` is then the whole "--set key=value".
struct Origin {
  std::string name;
  int rank = 0;  // 0 the scene itself, 1 its variant, 2 --set
};

struct Given {
  const Key* key = nullptr;
  const toml::node* value = nullptr;  // belongs to the parsed table, which must live as long
  Origin origin;
  Where where;
  bool sound = true;  // of the right type and within bounds
};

struct Entries {
  std::map<std::string, Given, std::less<>> values;  // by full path
  std::map<std::string, Where, std::less<>> tables;
};

/// The place of a node or key of a table read from `origin`. Throws nothing but std::bad_alloc.
Where where_of(const Origin& origin, const toml::source_region& source);

/// A value as it would be typed, cut short where it is long. Throws nothing but std::bad_alloc.
std::string as_typed(const toml::node& value);

/// Adds every known key in `table` to `entries`; unknown, repeated and unsound ones are added to `faults`.
/// prefix: path of the table, "" for the top level; skip: names at this level that are not keys; dotted: whether a
/// quoted name may be a path ("strata.interfaces"). Throws nothing but std::bad_alloc.
void flatten(const toml::table& table, const std::string& prefix, const Origin& origin,
             const std::vector<std::string>& skip, bool dotted, Entries& entries, Faults& faults);

/// The same for one key and its value. path: full path of the key; where: its place. Throws nothing but std::bad_alloc.
void flatten_value(const std::string& path, const toml::node& value, const Where& where, const Origin& origin,
                   bool dotted, Entries& entries, Faults& faults);

/// `base` with the values of `above` in the place of its own. Throws nothing but std::bad_alloc.
void lay_over(Entries& base, const Entries& above);

/// Whether the value is one that its key may take; what is wrong with it is added to `faults`. path: full path of the
/// key, as it stands in messages. Throws nothing but std::bad_alloc.
bool check_value(const std::string& path, const Given& given, Faults& faults);

/// Whether each [[claim]] has its text keys; what is wrong is added to `faults`. claims: the value of `claim`.
/// Throws nothing but std::bad_alloc.
void check_claims(const toml::node& claims, const Origin& origin, Faults& faults);

}  // namespace strata
