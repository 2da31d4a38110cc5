#include "scene/check.hpp"

#include <algorithm>

#include "scene/memory_need.hpp"

namespace strata {

ReadResult read_scene_that_fits(const std::filesystem::path& file, const std::string& variant,
                                const std::vector<std::string>& set) {
  ReadResult result = read_scene(file, variant, set);
  if (!result.scene) return result;
  if (const auto reason = too_large(*result.scene, available_memory())) {
    return {std::nullopt, {file.string() + ":1:1: " + *reason}};
  }
  return result;
}

std::vector<std::string> check(const std::vector<std::string>& files) {
  std::vector<std::string> lines;
  for (const std::string& file : files) {
    const std::vector<std::string> of_scene = read_scene_that_fits(file, "", {}).errors;
    lines.insert(lines.end(), of_scene.begin(), of_scene.end());
    for (const std::string& variant : list_variants(file).names) {
      for (const std::string& line : read_scene_that_fits(file, variant, {}).errors) {
        const bool known = std::ranges::find(of_scene, line) != of_scene.end();
        if (!known) lines.push_back(line + " [variant " + variant + "]");
      }
    }
  }
  return lines;
}

}  // namespace strata
