#include "scene/new_scene.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "scene/keys.hpp"
#include "scene/messages.hpp"

namespace strata {
namespace {

// What its keys mean is put above them, also above a line "# key = value".
constexpr std::string_view scene_to_start_from = R"(title = "TITLE"

[domain]
width_m = 20
height_m = 20
bottom = "symmetry"
sides = "fixed"

[in_situ]
vertical_Pa = 3.0e6
horizontal_Pa = 2.0e6

[rock.shale]
youngs_modulus_Pa = 10.0e9
poisson_ratio = 0.2
density_kg_m3 = 2500
toughness_Pa_sqrt_m = 1.45e6
# leakoff_m_sqrt_s = 1e-5

[rock.sandstone]
youngs_modulus_Pa = 20.0e9
toughness_Pa_sqrt_m = 1.0e6

[interface.bedding]
law = "soft"
normal_stiffness_Pa_m = 0.5e6
shear_stiffness_Pa_m = 0.5e6

[interface.joint]
law = "friction"
coefficient = 0.6

[interface.clay]
law = "weak"
shear_strength_Pa = 0.5e6
tensile_strength_Pa = 0.5e6

[strata]
along = "y"
layers = [{rock = "shale", thickness_m = 10}, {rock = "sandstone", horizontal_Pa = 2.2e6}]
interfaces = ["bedding"]

[fracture]
path_m = [[10, 0], [10, 5]]
growth = "J"
increment_m = 1.0
direction = "straight"

[fluid]
law = "uniform"
# viscosity_Pa_s = 0.1

[fluid.inlet]
start_Pa = 2.0e6
rate_Pa_s = 0.35e6
# Instead of both, with law "reynolds":
# rate_m2_s = 1e-4

[numerics]
mechanics = "quasistatic"
cell_m = 0.5
# With mechanics "explicit":
# damping_1_s = 20

[stop]
tip_y_m = 14
inlet_Pa = 4.5e6
# time_s = 60

# strata run FILE --variant clay
[variants.clay]
strata.interfaces = ["clay"]

[variants.joint]
strata.interfaces = ["joint"]
)";

// What the list of keys says of a key, and of those of its elements, as lines of a comment.
std::string comment_on(const Key& key, std::string_view indent = "") {
  constexpr std::size_t longest = 100;
  const bool has_choice = key.kind != Key::Kind::list && key.kind != Key::Kind::text;
  const std::string unit = key.unit.empty() ? "" : fmt::format(" ({})", key.unit), standard = default_text(key);
  std::string text, line = fmt::format("# {}{}{}:", indent, key.name(), unit);
  for (const std::string& word :
       split(fmt::format("{}{}{}", key.help, has_choice ? fmt::format(" Allowed: {}.", allowed_text(key)) : "",
                         standard.size() < 3 ? "" : fmt::format(" Default: {}.", standard)),
             " ")) {
    if (line.size() + 1 + word.size() > longest) text += std::exchange(line, fmt::format("#  {}", indent)) + '\n';
    line += ' ' + word;
  }
  text += line + '\n';
  for (const Key& of_element : scene_keys())
    if (of_element.table() == fmt::format("{}[].", key.path)) text += comment_on(of_element, "  ");
  return text;
}

// The scene with this title, its keys explained where they first stand.
std::string new_scene_text(std::string_view title) {
  std::string text, table;
  std::set<std::string_view> explained;
  for (const std::string& line : split(scene_to_start_from, "\n")) {
    if (line.starts_with('[')) table = line.substr(1, line.size() - 2) + '.';
    const std::size_t start = line.starts_with("# ") ? 2 : 0, end = line.find(" = ");
    const Key* key = end == line.npos ? nullptr : find_key(table + line.substr(start, end - start));
    if (key != nullptr && explained.insert(key->path).second) text += comment_on(*key);
    text += line + '\n';
  }
  text.pop_back();  // the line behind the last end of line
  return text.replace(text.find("TITLE"), 5, title);
}

}  // namespace

std::vector<std::string> write_new_scene(const std::string& name) {
  const std::string title = name.substr(0, name.size() - (name.ends_with(".toml") ? 5 : 0)), file = title + ".toml";
  if (!is_plain_name(title, ".")) return {fmt::format("{}: a name is made of letters, digits, _ - and dots.", name)};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wx"), &std::fclose);
  if (!out && errno == EEXIST)
    return {fmt::format("{}: the file is there and is left as it is. Give another name.", file)};
  if (out && std::fputs(new_scene_text(title).c_str(), out.get()) >= 0 && std::fflush(out.get()) == 0) return {};
  if (out) std::remove(file.c_str());
  return {fmt::format("{}: the file cannot be written. Check the folder's permissions and room.", file)};
}

}  // namespace strata
