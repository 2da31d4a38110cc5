// Keys that people look for and that this version does not have.
#pragma once

#include <string_view>

namespace strata {

/// What to do instead of giving the key `path`, " In this version ..."; "" where nothing is known of it. Throws
/// nothing.
std::string_view advice_on_absent_key(std::string_view path);

/// What there is one of in a scene, for those who type `path` to have more of it; "" for others. Throws nothing.
std::string_view note_on_table(std::string_view path);

}  // namespace strata
