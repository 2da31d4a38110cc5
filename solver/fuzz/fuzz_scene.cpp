// What libFuzzer tries on the scene reader: any bytes are either refused with messages that say where, or are a scene
// whose resolved text is read back to the same text. Lines that begin with "#set " act as --set does.
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include "scene/derived.hpp"
#include "scene/toml_reader.hpp"

namespace {

constexpr std::size_t most_variants = 2;  // of an input, so that none takes long

[[noreturn]] void found(const char* what, const std::string& text) {
  std::fprintf(stderr, "%s:\n%s\n", what, text.c_str());
  std::abort();
}

std::vector<std::string> settings_of(std::string_view text) {
  constexpr std::string_view mark = "#set ";
  std::vector<std::string> settings;
  while (!text.empty()) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    if (line.starts_with(mark)) settings.emplace_back(line.substr(mark.size()));
    if (end == std::string_view::npos) break;
    text.remove_prefix(end + 1);
  }
  return settings;
}

void try_reading(std::string_view text, const std::string& variant, const std::vector<std::string>& settings) {
  const strata::ReadResult read = strata::read_scene_text(text, "fuzz.toml", variant, settings);
  if (read.scene.has_value() != read.errors.empty()) found("a scene with errors, or none without", std::string(text));
  for (const std::string& error : read.errors) {
    const bool says_where = error.starts_with("fuzz.toml") || error.starts_with("--set ");
    if (!says_where) found("an error without its place", error);
  }
  if (!read.scene || strata::too_large(*read.scene, 1e12)) return;
  const strata::ReadResult again = strata::read_scene_text(read.scene->resolved_toml, "fuzz.toml", "", {});
  if (!again.scene) found("a resolved scene that is refused", again.errors.front() + "\n" + read.scene->resolved_toml);
  if (again.scene->resolved_toml != read.scene->resolved_toml) {
    found("a resolved scene that changes when it is read", read.scene->resolved_toml + again.scene->resolved_toml);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::vector<std::string> settings = settings_of(text);
  try_reading(text, "", settings);
  std::vector<std::string> names = strata::list_variants(text, "fuzz.toml").lines;
  if (names.size() > most_variants) names.resize(most_variants);
  for (const std::string& name : names) try_reading(text, name, settings);
  return 0;
}
