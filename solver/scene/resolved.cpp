#include "scene/resolved.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include <toml++/toml.h>

#include "scene/keys.hpp"

namespace strata {
namespace {

std::string toml_text(const std::string& text) {
  std::ostringstream out;
  const toml::value<std::string> value(text);
  out << toml::toml_formatter{value, toml::format_flags::allow_unicode_strings};
  return out.str();
}

// Value of a key in the scene as TOML, or nothing where an optional one is absent. index: of the rock or law.
std::string value_text(const Key& key, Scene& scene, std::size_t index) {
  struct Text {
    const Key& key;
    Scene& scene;
    std::size_t index;
    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(NumberPlace at) const { return number_text(at(scene, index)); }
    std::string operator()(OptionalPlace at) const {
      return at(scene, index) ? number_text(*at(scene, index)) : std::string();
    }
    std::string operator()(IntegerPlace at) const { return fmt::format("{}", at(scene, index)); }
    std::string operator()(TextPlace at) const { return toml_text(at(scene, index)); }
    std::string operator()(FormulasPlace at) const {
      const std::optional<Formulas>& both = at(scene, index);
      return both ? fmt::format("[{}, {}]", toml_text((*both)[0]), toml_text((*both)[1])) : std::string();
    }
    std::string operator()(const WordPlace& at) const {
      return toml_text(std::ranges::find(key.words, at.get(scene, index), &Word::value)->text);
    }
  };
  return std::visit(Text{key, scene, index}, key.place);
}

// Layers end on grid lines or at mid-cell and are put back there when read, so a thickness needs no digits of
// round-off.
std::string thickness_text(const Layer& layer, double cell_m) {
  const double thickness = layer.to_m - layer.from_m;
  const double rounded = std::strtod(fmt::format("{:.9g}", thickness).c_str(), nullptr);
  return number_text(std::abs(rounded - thickness) < 1e-7 * cell_m ? rounded : thickness);
}

std::string layers_text(const Scene& scene) {
  std::string text = "[\n";
  for (const Layer& layer : scene.strata.layers) {
    const bool is_last = &layer == &scene.strata.layers.back();
    text += "  {rock = " + toml_text(scene.rocks[layer.rock].name);
    text += is_last ? "},\n" : ", thickness_m = " + thickness_text(layer, scene.numerics.cell_m) + "},\n";
  }
  return text + "]";
}

std::string list_text(const Key& key, const Scene& scene) {
  std::vector<std::string> items;
  if (key.type == KeyType::layers) return layers_text(scene);
  if (key.type == KeyType::names) {
    for (const InterfacePlace& place : scene.strata.interfaces) items.push_back(toml_text(scene.laws[place.law].name));
  } else if (key.type == KeyType::points) {
    for (const auto& point : scene.fracture->path_m) {
      items.push_back(fmt::format("[{}, {}]", number_text(point[0]), number_text(point[1])));
    }
  } else {
    return {};
  }
  return fmt::format("[{}]", fmt::join(items, ", "));
}

std::string law_name(Scene& scene, std::size_t index) {
  const Key& law = *find_key("interface.NAME.law");
  return std::ranges::find(law.words, std::get<WordPlace>(law.place).get(scene, index), &Word::value)->text;
}

// A line "name = value", or nothing for a key that the scene does not have.
std::string line(const Key& key, Scene& scene, std::size_t index) {
  if (key.path.find('[') != std::string::npos) return {};
  if (!key.law.empty() && !key.is_of(law_name(scene, index))) return {};
  // The inlet is given in one of two ways.
  if (scene.fluid.rate_m2_s && (key.path == "fluid.inlet.start_Pa" || key.path == "fluid.inlet.rate_Pa_s")) return {};
  std::string value = list_text(key, scene);
  if (value.empty()) value = value_text(key, scene, index);
  return value.empty() ? value : key.path.substr(key.path.rfind('.') + 1) + " = " + value + '\n';
}

// The lines of all keys in the table `table` of the list of keys ("rock.NAME").
std::string lines(const std::string& table, Scene& scene, std::size_t index) {
  std::string text;
  for (const Key& key : scene_keys()) {
    const std::size_t dot = key.path.rfind('.');
    if (dot != std::string::npos && key.path.substr(0, dot) == table) text += line(key, scene, index);
  }
  return text;
}

}  // namespace

std::string resolved_toml(const Scene& given, std::string_view claims) {
  Scene scene = given;  // places lead to members that may be changed
  std::string text = line(*find_key("title"), scene, 0);
  std::set<std::string> done;
  for (const Key& key : scene_keys()) {
    const std::size_t dot = key.path.rfind('.');
    if (dot == std::string::npos || key.path.find('[') != std::string::npos) continue;
    const std::string table = key.path.substr(0, dot);
    if ((table == "fracture" && !scene.fracture) || !done.insert(table).second) continue;
    if (table == "rock.NAME") {
      for (std::size_t k = 0; k < scene.rocks.size(); ++k) {
        text += fmt::format("\n[rock.{}]\n{}", scene.rocks[k].name, lines(table, scene, k));
      }
    } else if (table == "interface.NAME") {
      for (std::size_t k = 1; k < scene.laws.size(); ++k) {
        text += fmt::format("\n[interface.{}]\n{}", scene.laws[k].name, lines(table, scene, k));
      }
    } else if (const std::string body = lines(table, scene, 0); !body.empty()) {
      text += fmt::format("\n[{}]\n{}", table, body);
    }
  }
  if (!claims.empty()) text += fmt::format("\n{}\n", claims);
  return text;
}

}  // namespace strata
