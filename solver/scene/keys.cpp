#include "scene/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace strata {

Scene scene_of_one() {
  Scene scene;
  scene.rocks.emplace_back();
  scene.laws.emplace_back();
  scene.strata.layers.emplace_back();
  scene.strata.interfaces.emplace_back();
  scene.fracture.emplace();
  return scene;
}

std::string pattern_of(std::string_view path) {
  std::vector<std::string> names = split(path, ".");
  for (std::string& name : names) {
    if (const std::size_t bracket = name.find('['); bracket != name.npos) name = name.substr(0, bracket) + "[]";
  }
  const bool named = names.size() > 1 && (names[0] == "rock" || names[0] == "interface") && is_plain_name(names[1]);
  if (named) names[1] = "NAME";
  return fmt::format("{}", fmt::join(names, "."));
}

const Key* find_key(std::string_view path) {
  const auto key = std::ranges::find(scene_keys(), pattern_of(path), &Key::path);
  return key == scene_keys().end() ? nullptr : &*key;
}

std::vector<std::string> names_in_table(std::string_view path) {
  const std::string table = path.empty() ? "" : pattern_of(path) + '.';
  std::vector<std::string> names;
  for (const Key& key : scene_keys()) {
    if (!key.path.starts_with(table)) continue;
    const std::string name(key.path.substr(table.size(), key.path.find_first_of(".[", table.size()) - table.size()));
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  if (path.empty()) names.insert(names.end(), {"variants", "sweep"});
  return names;
}

std::string unknown_key_message(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  const std::string_view table = path.substr(0, dot == path.npos ? 0 : dot), name = path.substr(dot + 1);
  const std::vector<std::string> names = names_in_table(table);
  const std::string message = fmt::format("unknown key {}.", path), meant = did_you_mean(name, names);
  if (!meant.empty()) return message + meant;
  std::string elsewhere;
  for (const Key& key : scene_keys()) {
    if (elsewhere.empty() && !key.in_list() && key.name() == name)
      elsewhere = fmt::format(" Did you mean {}?", key.path);
  }
  const std::string where = table.empty() ? "At the top level there are" : fmt::format("[{}] has", table);
  return fmt::format("{}{} {} {}.", message, elsewhere, where, fmt::join(names, ", "));
}

std::string to_text(const Bounds& bounds) {
  return fmt::format("{}{}, {}{}", bounds.low_open ? '(' : '[', bounds.low, bounds.high, bounds.high_open ? ')' : ']');
}

std::string allowed_text(const Key& key) {
  if (key.kind == Key::Kind::number) return to_text(key.bounds);
  if (key.kind == Key::Kind::list) return "list";
  if (key.kind == Key::Kind::text) return "text";
  return fmt::format("{}{}", key.kind == Key::Kind::formula ? "formulas of " : "", key.allowed);
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
    if (table == "interface.NAME." && scene.laws[index].has_toughness() && key.of_strength()) continue;
    // The inlet is given in one of three ways.
    if (table == "fluid.inlet.") {
      const bool of_table = key.name() == "table" || key.name() == "of", of_rate = key.name() == "rate_m2_s";
      if (of_table == scene.fluid.table.empty() || (!of_table && of_rate != scene.fluid.rate_m2_s.has_value()))
        continue;
    }
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
