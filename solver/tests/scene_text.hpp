// A scene for the tests of the reader, and what they do with it.
#pragma once

#include <catch2/catch.hpp>
#include <string>
#include <vector>

#include "scene/toml_reader.hpp"

namespace scene_test {

inline const std::string layered = R"(title = "two layers"
[domain]
width_m = 80
height_m = 80
[in_situ]
vertical_Pa = 3e6
horizontal_Pa = 2e6
[rock.stiff]
youngs_modulus_Pa = 10e9
[rock.soft]
youngs_modulus_Pa = 5e9
toughness_Pa_sqrt_m = 1.25e6
[interface.joint]
law = "friction"
coefficient = 0.4
[strata]
layers = [{rock = "stiff", thickness_m = 10}, {rock = "soft"}]
interfaces = ["joint"]
[fracture]
path_m = [[40, 0], [40, 5]]
[fluid]
inlet = {start_Pa = 2e6, rate_Pa_s = 0.35e6}
[numerics]
cell_m = 1
[stop]
inlet_Pa = 4e6
)";

inline strata::ReadResult read(const std::string& text, const std::string& variant = "",
                               const std::vector<std::string>& set = {}) {
  return strata::read_scene_text(text, "scene.toml", variant, set);
}

// The scene, which must be a good one.
inline strata::Scene good(const std::string& text, const std::string& variant = "",
                          const std::vector<std::string>& set = {}) {
  const strata::ReadResult result = read(text, variant, set);
  CAPTURE(result.errors);
  REQUIRE(result.scene.has_value());
  return *result.scene;
}

// All errors as one text, of a scene that must not be a good one.
inline std::string errors(const std::string& text, const std::string& variant = "",
                          const std::vector<std::string>& set = {}) {
  const strata::ReadResult result = read(text, variant, set);
  REQUIRE_FALSE(result.scene.has_value());
  REQUIRE_FALSE(result.errors.empty());
  std::string all;
  for (const std::string& error : result.errors) all += error + '\n';
  return all;
}

// `text` with its one occurrence of `what` replaced.
inline std::string with(std::string text, const std::string& what, const std::string& by) {
  const std::size_t at = text.find(what);
  REQUIRE(at != std::string::npos);
  return text.replace(at, what.size(), by);
}

}  // namespace scene_test
