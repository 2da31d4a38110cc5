// What `strata check` says.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "scene/toml_reader.hpp"

namespace strata {

/// As read_scene(), and an error where the machine has not the memory that a run of the scene would take.
ReadResult read_scene_that_fits(const std::filesystem::path& file, const std::string& variant,
                                const std::vector<std::string>& set);

/// All that is wrong with scene files, as lines: of each the scene itself and all its variants; what only a variant is
/// guilty of ends in "[variant NAME]". files: paths. Throws nothing but std::bad_alloc.
std::vector<std::string> check(const std::vector<std::string>& files);

}  // namespace strata
