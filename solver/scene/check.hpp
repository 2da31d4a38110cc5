// What `strata check` says.
#pragma once

#include <string>
#include <vector>

namespace strata {

/// All that is wrong with scene files, as lines: of each the scene itself and all its variants; what only a variant is
/// guilty of ends in "[variant NAME]". files: paths. Throws nothing but std::bad_alloc.
std::vector<std::string> check(const std::vector<std::string>& files);

}  // namespace strata
