#include "scene/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <set>
#include <sstream>

#include <toml++/toml.h>

namespace strata {
namespace {

// Keys that people look for and that this version does not have.
// A path by its table and its last name; anything may stand between.
struct Absent {
  std::string_view table, name, advice;
};

constexpr std::string_view one_stress =
    " In this version the in-situ stress is one for the whole block: in_situ.horizontal_Pa and in_situ.vertical_Pa. "
    "in_situ.initialise = \"loaded\" gives each layer what its stiffness takes of them.";

constexpr Absent absent[] = {
    {"in_situ.", "shear_Pa",
     " In this version there is no in-situ shear stress: lay the block along the principal stresses."},
    {"in_situ.", "weight", " In this version stresses do not grow with depth: give those at the fracture."},
    {"strata.layers[", "_Pa", one_stress},
    {"rock.", ".horizontal_Pa", one_stress},
    {"rock.", ".vertical_Pa", one_stress},
    {"rock.", ".leakoff_m_sqrt_s", " In this version rock takes no fluid: leave it out."},
    {"interface.", ".toughness_Pa_sqrt_m",
     " In this version an interface fails by strength: law = \"weak\", shear_strength_Pa and tensile_strength_Pa."},
    {"fracture.", "friction", " In this version the fracture's faces meet without friction: leave it out."},
    {"fluid.inlet.", "table",
     " In this version the inlet has one rate: inlet = {start_Pa, rate_Pa_s}, or {rate_m2_s} with law = \"reynolds\"."},
    {"sweep", "", " In this version each case is a variant: [variants.NAME] and below it the keys that differ."},
};

// Whether a key's path begins with the segments given, any name standing for NAME.
bool begins_with(const std::vector<std::string>& key, const std::vector<std::string>& given) {
  return key.size() >= given.size() && std::equal(given.begin(), given.end(), key.begin(), [](auto& segment, auto& of) {
           return of == "NAME" || of == segment;
         });
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string allowed_text(const Key& key) {
  if (key.is_number()) return to_text(key.bounds);
  if (key.is_list()) return "list";
  if (key.is<Way<std::string>>()) return "text";
  return (key.is<Way<std::optional<Formulas>>>() ? "formulas of " : "") + joined(key.allowed);
}

// Members as TOML.
struct ValueText {
  const Scene& scene;

  std::string operator()(double value) const { return number_text(value); }
  std::string operator()(int value) const { return std::to_string(value); }

  std::string operator()(const std::string& value) const {
    std::ostringstream out;
    out << toml::toml_formatter{toml::value<std::string>(value), toml::format_flags::allow_unicode_strings};
    return out.str();
  }

  template <class Value>
  std::string operator()(const std::optional<Value>& value) const {
    return value ? (*this)(*value) : std::string();
  }

  template <class Value, std::size_t size>
  std::string operator()(const std::array<Value, size>& values) const {
    return list(values);
  }

  std::string operator()(const Path& points) const { return list(points); }

  std::string operator()(const InterfacePlace& place) const { return (*this)(scene.laws[place.law].name); }
  std::string operator()(const std::vector<InterfacePlace>& places) const { return list(places); }

  // Layers end on grid lines or at mid-cell and are put back there when read, so a thickness needs no digits of
  // round-off.
  std::string operator()(const std::vector<Layer>& layers) const {
    std::string text = "[\n";
    for (const Layer& layer : layers) {
      text += "  {rock = " + (*this)(scene.rocks[layer.rock].name);
      const double thickness = layer.to_m - layer.from_m;
      const double rounded = std::strtod(fmt::format("{:.9g}", thickness).c_str(), nullptr);
      const bool is_round = std::abs(rounded - thickness) < 1e-7 * scene.numerics.cell_m;
      if (&layer != &layers.back()) text += ", thickness_m = " + number_text(is_round ? rounded : thickness);
      text += "},\n";
    }
    return text + "]";
  }

  std::string list(const auto& values) const {
    std::vector<std::string> texts;
    for (const auto& value : values) texts.push_back((*this)(value));
    return '[' + joined(texts) + ']';
  }
};

// The lines "name = value" of all keys of a table ("rock.NAME.") that are in force.
std::string lines(std::string_view table, Scene& scene, std::size_t index) {
  std::string text;
  for (const Key& key : scene_keys()) {
    if (key.table() != table || key.in_list()) continue;
    if (!key.law.empty() && !key.is_of(word_of(scene.laws[index].kind))) continue;
    // The inlet is given in one of two ways.
    if (scene.fluid.rate_m2_s && (key.path == "fluid.inlet.start_Pa" || key.path == "fluid.inlet.rate_Pa_s")) continue;
    const std::string value = value_text(key, scene, index);
    if (!value.empty()) text += fmt::format("{} = {}\n", key.name(), value);
  }
  return text;
}

}  // namespace

const Key* find_key(std::string_view path) {
  const auto given = split(path, ".");
  const auto key = std::ranges::find_if(scene_keys(), [&](const Key& k) {
    const auto segments = split(k.path, ".");
    return segments.size() == given.size() && begins_with(segments, given);
  });
  return key == scene_keys().end() ? nullptr : &*key;
}

bool is_key_table(std::string_view path) {
  return std::ranges::any_of(scene_keys(), [given = split(path, ".")](const Key& key) {
    const auto segments = split(key.path, ".");
    return segments.size() > given.size() && begins_with(segments, given);
  });
}

std::vector<std::string> names_in_table(std::string_view path) {
  const auto given = path.empty() ? std::vector<std::string>() : split(path, ".");
  std::vector<std::string> names;
  for (const Key& key : scene_keys()) {
    const auto segments = split(key.path, ".");
    if (segments.size() <= given.size() || !begins_with(segments, given)) continue;
    std::string name = segments[given.size()];
    if (path.empty() && name.ends_with("[]")) name.resize(name.size() - 2);
    const bool listed = std::ranges::find(names, name) != names.end();
    if (!listed && name != "NAME" && !name.ends_with("[]")) names.push_back(std::move(name));
  }
  if (path.empty()) names.emplace_back("variants");
  return names;
}

std::string unknown_key_message(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  const std::string_view table = path.substr(0, dot == path.npos ? 0 : dot), name = path.substr(dot + 1);
  const std::vector<std::string> names = names_in_table(table);
  const std::string message = fmt::format("unknown key {}.", path);
  if (const auto advice = advice_on_absent_key(path); !advice.empty()) return fmt::format("{}{}", message, advice);
  const bool for_more = table.empty() || path.starts_with("fracture.path");  // of what there is one of
  if (const std::string meant = did_you_mean(name, names); !meant.empty())
    return fmt::format("{}{}{}", message, meant, for_more ? note_on_table(path) : "");
  for (const Key& key : scene_keys()) {  // of another table
    if (!key.in_list() && key.name() == name) return fmt::format("{} Did you mean {}?", message, key.path);
  }
  if (table.empty()) return message + " At the top level there are " + joined(names) + ".";
  return fmt::format("{} [{}] has {}.{}", message, table, joined(names), note_on_table(path));
}

std::string to_text(const Bounds& bounds) {
  return fmt::format("{}{}, {}{}", bounds.low_open ? '(' : '[', bounds.low, bounds.high, bounds.high_open ? ')' : ']');
}

std::string value_text(const Key& key, Scene& scene, std::size_t index) {
  return std::visit(
      [&](const auto& way) -> std::string {
        if constexpr (std::is_same_v<decltype(way), const WordWay&>) {
          return '"' + split(way.words, ", ")[static_cast<std::size_t>(way.get(scene, index))] + '"';
        } else {
          return way == nullptr ? std::string() : ValueText{scene}(way(scene, index));
        }
      },
      key.place);
}

std::string default_text(const Key& key) {
  if (key.required || key.is_list()) return {};
  Scene scene;
  scene.rocks.emplace_back();
  scene.laws.emplace_back();
  scene.fracture.emplace();
  return value_text(key, scene, 0);
}

std::string keys_as_markdown() {
  std::string text = "| key | unit | default | allowed | meaning |\n|---|---|---|---|---|\n";
  for (const Key& key : scene_keys()) {
    text += fmt::format("| `{}` | {} | {} | {} | {}{} |\n", key.path, key.unit,
                        key.required ? "required" : default_text(key), allowed_text(key), key.help,
                        key.law.empty() ? "" : fmt::format(" (law \"{}\")", key.law));
  }
  return text;
}

std::string resolved_toml(Scene scene, std::string_view claims) {
  std::string text;
  std::set<std::string_view> done;
  for (const Key& key : scene_keys()) {
    const std::string_view table = key.table();
    if (key.in_list() || (table == "fracture." && !scene.fracture) || !done.insert(table).second) continue;
    const bool of_rocks = table == "rock.NAME.", of_laws = table == "interface.NAME.";
    const std::size_t end = of_rocks ? scene.rocks.size() : of_laws ? scene.laws.size() : 1;
    for (std::size_t k = of_laws ? 1 : 0; k < end; ++k) {
      const std::string body = lines(table, scene, k);
      const std::string name = of_rocks  ? "rock." + scene.rocks[k].name
                               : of_laws ? "interface." + scene.laws[k].name
                                         : std::string(table.substr(0, table.size() - 1));
      if (!body.empty()) text += table.empty() ? body : fmt::format("\n[{}]\n{}", name, body);
    }
  }
  if (!claims.empty()) text += fmt::format("\n{}\n", claims);
  return text;
}

std::string_view advice_on_absent_key(std::string_view path) {
  const auto found = std::ranges::find_if(absent, [&](const Absent& key) {
    return path.size() >= key.table.size() + key.name.size() && path.starts_with(key.table) && path.ends_with(key.name);
  });
  return found == std::end(absent) ? std::string_view() : found->advice;
}

std::string_view note_on_table(std::string_view path) {
  if (path.starts_with("in_situ")) return one_stress;
  if (path.starts_with("fracture")) return " A scene has one fracture: [fracture] with path_m = [[x, y], [x, y]].";
  return {};
}

}  // namespace strata
