#include "scene/check.hpp"

#include <algorithm>

#include "scene/toml_reader.hpp"

namespace strata {

std::vector<std::string> check(const std::vector<std::string>& files) {
  std::vector<std::string> lines;
  for (const std::string& file : files) {
    const std::vector<std::string> of_scene = read_scene(file, "", {}).errors;
    lines.insert(lines.end(), of_scene.begin(), of_scene.end());
    for (const std::string& variant : list_variants(file).names) {
      for (const std::string& line : read_scene(file, variant, {}).errors) {
        const bool known = std::ranges::find(of_scene, line) != of_scene.end();
        if (!known) lines.push_back(line + " [variant " + variant + "]");
      }
    }
  }
  return lines;
}

}  // namespace strata
