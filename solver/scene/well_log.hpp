// A well log, a table of layers as CSV, becomes a scene. Nothing here throws but std::bad_alloc.
#pragma once

#include <string>
#include <string_view>

#include "scene/toml_reader.hpp"

namespace strata {

/// The scene of a log as one text, or what is wrong with the log: lines "file:row:column: what. What to do.". Its
/// layers stand bottom-up, equal rocks once; cells divide the layers, the fracture is in the layer of least horizontal
/// stress. Bounds of values are those of the scene's keys. What the log does not say is marked "open".
Found scene_of_log(std::string_view text, const std::string& file_name);

/// What a log is, for `strata log --help`.
std::string log_help();

}  // namespace strata
