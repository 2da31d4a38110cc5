// A scene's text as TOML and, where it is none, what to type instead.
#pragma once

#include <optional>
#include <set>
#include <string>
#include <string_view>

#include <toml++/toml.h>

#include "scene/entries.hpp"
#include "scene/messages.hpp"

namespace strata {

struct Parsed {
  toml::table table;
  std::set<unsigned> mended;  // lines that are no TOML; values in them are nan, so that the rest could be read
  bool whole = true;          // whether all lines could be read so
};

/// Parses a text; each place that is not TOML goes to `faults` with what to type there. What stands on one line is left
/// out and the rest read all the same. Throws nothing but std::bad_alloc.
Parsed parse_toml(std::string_view text, const Origin& origin, Faults& faults);

/// What to type in place of a value that is no TOML, " Write 10e9: ...", or "" where that is not clear.
/// key: what the value is for, or nullptr. Throws nothing but std::bad_alloc.
std::string advice_on_value(std::string_view value, const Key* key);

/// What to type in place of a number with a comma, grouped digits, a unit or more behind it, " Write 10e9: the unit,
/// Pa, stands in the key."; nothing where `typed` does not begin like a number or may stand as it is. unit: the key's,
/// "" where it has none, nullptr where the key is not known. Throws nothing but std::bad_alloc.
std::optional<std::string> advice_on_number(std::string_view typed, const std::string* unit);

}  // namespace strata
