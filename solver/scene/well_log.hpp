// A well log, a table of layers as CSV, becomes a scene.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace strata {

// A scene as TOML, or else what is wrong with the log: lines "file:row:column: what. What to do.".
struct LogResult {
  std::string toml;
  std::vector<std::string> errors;
};

/// The scene of a log: its layers bottom-up, equal rocks once, cells that divide the layers, a fracture in the layer of
/// least horizontal stress. Bounds of values are those of the scene's keys. What the log does not say is marked "open".
LogResult scene_of_log(const std::filesystem::path& file);

/// The same from text. file_name: what messages call it.
LogResult scene_of_log_text(std::string_view text, const std::string& file_name);

/// What a log is, for `strata log --help`.
std::string log_help();

}  // namespace strata
