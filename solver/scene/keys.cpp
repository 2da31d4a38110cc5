#include "scene/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace strata {
namespace {

// Whether the names of a path are the first ones of a pattern.
bool begins(const std::vector<std::string>& path, const std::vector<std::string>& pattern) {
  return path.size() <= pattern.size() &&
         std::equal(path.begin(), path.end(), pattern.begin(), [](auto& name, auto& of) {
           const std::size_t bracket = name.find('[');
           const std::string any = bracket == name.npos ? "NAME" : name.substr(0, bracket) + "[]";
           return of == any || of == name;
         });
}

std::vector<std::string> names_in(std::string_view path) {
  return path.empty() ? std::vector<std::string>() : split(path, ".");
}

// Whether `path` is one of the tables that hold a key.
bool holds(std::string_view path, const Key& key) {
  const auto names = names_in(path), pattern = names_in(key.path);
  return names.size() < pattern.size() && begins(names, pattern);
}

std::string allowed_text(const Key& key) {
  if (key.kind == Key::Kind::number) return to_text(key.bounds);
  if (key.kind == Key::Kind::list) return "list";
  if (key.kind == Key::Kind::text) return "text";
  return fmt::format("{}{}", key.kind == Key::Kind::formula ? "formulas of " : "", key.allowed);
}

}  // namespace

Scene scene_of_one() {
  Scene scene;
  scene.rocks.emplace_back();
  scene.laws.emplace_back();
  scene.strata.layers.emplace_back();
  scene.fracture.emplace();
  return scene;
}

bool fits(std::string_view path, std::string_view pattern) {
  const auto names = names_in(path), of = names_in(pattern);
  return names.size() == of.size() && begins(names, of);
}

const Key* find_key(std::string_view path) {
  const auto key = std::ranges::find_if(scene_keys(), [&](const Key& k) { return fits(path, k.path); });
  return key == scene_keys().end() ? nullptr : &*key;
}

bool is_key_table(std::string_view path) {
  return std::ranges::any_of(scene_keys(), [&](const Key& key) { return holds(path, key); });
}

std::vector<std::string> names_in_table(std::string_view path) {
  std::vector<std::string> names;
  for (const Key& key : scene_keys()) {
    if (!holds(path, key)) continue;
    const std::string segment = names_in(key.path)[names_in(path).size()], name = segment.substr(0, segment.find('['));
    if (name != "NAME" && std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  if (path.empty()) names.emplace_back("variants");
  return names;
}

std::string unknown_key_message(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  const std::string_view table = path.substr(0, dot == path.npos ? 0 : dot), name = path.substr(dot + 1);
  const std::vector<std::string> names = names_in_table(table);
  const std::string message = fmt::format("unknown key {}.", path), meant = did_you_mean(name, names);
  if (!meant.empty()) return message + meant;
  for (const Key& key : scene_keys()) {  // of another table
    if (!key.in_list() && key.name() == name) return fmt::format("{} Did you mean {}?", message, key.path);
  }
  const std::string where = table.empty() ? "At the top level there are" : fmt::format("[{}] has", table);
  return fmt::format("{} {} {}.", message, where, fmt::join(names, ", "));
}

std::string to_text(const Bounds& bounds) {
  return fmt::format("{}{}, {}{}", bounds.low_open ? '(' : '[', bounds.low, bounds.high, bounds.high_open ? ')' : ']');
}

std::string default_text(const Key& key) {
  Scene scene = scene_of_one();
  return key.required || key.kind == Key::Kind::list ? std::string() : key.member.text(scene, 0);
}

std::vector<std::string> lines_of(std::string_view table, Scene& scene, std::size_t index) {
  std::vector<std::string> lines;
  for (const Key& key : scene_keys()) {
    if (key.table() != table) continue;
    if (!key.law.empty() && !key.is_of(word_of(scene.laws[index].kind))) continue;
    // The inlet is given in one of two ways.
    if (scene.fluid.rate_m2_s && (key.path == "fluid.inlet.start_Pa" || key.path == "fluid.inlet.rate_Pa_s")) continue;
    const std::string value = key.member.text(scene, index);
    if (!value.empty()) lines.push_back(fmt::format("{} = {}", key.name(), value));
  }
  return lines;
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
      const std::string body = fmt::format("{}", fmt::join(lines_of(table, scene, k), "\n"));
      const std::string name = of_rocks  ? "rock." + scene.rocks[k].name
                               : of_laws ? "interface." + scene.laws[k].name
                                         : std::string(table.substr(0, table.size() - 1));
      if (!body.empty()) text += table.empty() ? body + '\n' : fmt::format("\n[{}]\n{}\n", name, body);
    }
  }
  if (!claims.empty()) text += fmt::format("\n{}\n", claims);
  return text;
}

}  // namespace strata
