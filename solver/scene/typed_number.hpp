// Numbers as people write them, where TOML or a key takes them otherwise.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace strata {

/// What to type in place of a number with a comma, grouped digits, a unit or more behind it, " Write 10e9: the unit,
/// Pa, stands in the key."; nothing where `typed` does not begin like a number or may stand as it is. unit: the key's,
/// "" where it has none, nullptr where the key is not known. Throws nothing but std::bad_alloc.
std::optional<std::string> advice_on_number(std::string_view typed, const std::string* unit);

}  // namespace strata
