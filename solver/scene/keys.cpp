#include "scene/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/absent_keys.hpp"
#include "scene/spelling.hpp"

namespace strata {
namespace {

std::vector<std::string_view> split(std::string_view path) {
  std::vector<std::string_view> segments;
  for (;;) {
    const std::size_t dot = path.find('.');
    segments.push_back(path.substr(0, dot));
    if (dot == std::string_view::npos) return segments;
    path.remove_prefix(dot + 1);
  }
}

// How many leading segments of the key's path the given ones agree with.
bool agrees(const std::vector<std::string_view>& key, const std::vector<std::string_view>& given, std::size_t count) {
  for (std::size_t k = 0; k < count; ++k) {
    if (key[k] != "NAME" && key[k] != given[k]) return false;
  }
  return true;
}

std::string last_segment(std::string_view path) {
  return std::string(split(path).back());
}

std::string parent(std::string_view path) {
  const std::size_t dot = path.rfind('.');
  return dot == std::string_view::npos ? std::string() : std::string(path.substr(0, dot));
}

// Keys of other tables that end in the same word: a key in the wrong table.
std::string same_name_elsewhere(std::string_view path) {
  for (const Key& key : scene_keys()) {
    if (key.path.find('[') == std::string::npos && last_segment(key.path) == last_segment(path)) return key.path;
  }
  return {};
}

std::string joined(const std::vector<std::string>& words) {
  return fmt::format("{}", fmt::join(words, ", "));
}

std::string allowed_text(const Key& key) {
  switch (key.type) {
    case KeyType::number:
      return to_text(key.bounds);
    case KeyType::integer:
      return fmt::format("{}", fmt::join(key.allowed, ", "));
    case KeyType::word: {
      std::vector<std::string> words;
      for (const Word& word : key.words) words.push_back(word.text);
      return joined(words);
    }
    case KeyType::text:
      return "text";
    case KeyType::formulas:
      return fmt::format("formulas of {}", joined(key.variables));
    case KeyType::layers:
    case KeyType::names:
    case KeyType::points:
      return "list";
    case KeyType::anything:
      break;
  }
  return "";
}

// A scene in which every member that a key leads to exists.
Scene scene_of_defaults() {
  Scene scene;
  scene.rocks.emplace_back();
  scene.laws.emplace_back();
  scene.fracture.emplace();
  return scene;
}

}  // namespace

const Key* find_key(std::string_view path) {
  const auto given = split(path);
  for (const Key& key : scene_keys()) {
    const auto segments = split(key.path);
    if (segments.size() == given.size() && agrees(segments, given, given.size())) return &key;
  }
  return nullptr;
}

bool is_key_table(std::string_view path) {
  const auto given = split(path);
  return std::ranges::any_of(scene_keys(), [&](const Key& key) {
    const auto segments = split(key.path);
    return segments.size() > given.size() && agrees(segments, given, given.size());
  });
}

std::vector<std::string> names_in_table(std::string_view path) {
  const auto given = path.empty() ? std::vector<std::string_view>() : split(path);
  std::vector<std::string> names;
  for (const Key& key : scene_keys()) {
    const auto segments = split(key.path);
    if (segments.size() <= given.size() || !agrees(segments, given, given.size())) continue;
    std::string name(segments[given.size()]);
    if (path.empty() && name.ends_with("[]")) name.resize(name.size() - 2);
    const bool listed = std::ranges::find(names, name) != names.end();
    if (!listed && name != "NAME" && !name.ends_with("[]")) names.push_back(std::move(name));
  }
  if (path.empty()) names.emplace_back("variants");
  return names;
}

std::string unknown_key_message(std::string_view path) {
  const std::string table = parent(path);
  const std::vector<std::string> names = names_in_table(table);
  const std::string message = fmt::format("unknown key {}.", path);
  if (const auto advice = advice_on_absent_key(path); !advice.empty()) return fmt::format("{}{}", message, advice);
  const bool for_more = table.empty() || path.starts_with("fracture.path");  // of what there is one of
  if (const auto nearest = nearest_word(last_segment(path), names))
    return fmt::format("{} Did you mean {}?{}", message, *nearest, for_more ? note_on_table(path) : "");
  const std::string elsewhere = same_name_elsewhere(path);
  if (!elsewhere.empty()) return message + " Did you mean " + elsewhere + "?";
  if (table.empty()) return message + " At the top level there are " + joined(names) + ".";
  return message + fmt::format(" [{}] has {}.{}", table, joined(names), note_on_table(path));
}

std::string to_text(const Bounds& bounds) {
  return fmt::format("{}{}, {}{}", bounds.low_open ? '(' : '[', bounds.low, bounds.high, bounds.high_open ? ')' : ']');
}

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (std::isfinite(value) && text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string default_text(const Key& key) {
  if (key.required) return {};
  Scene scene = scene_of_defaults();
  struct Text {
    const Key& key;
    Scene& scene;
    std::string operator()(std::monostate) const { return {}; }
    std::string operator()(NumberPlace at) const { return number_text(at(scene, 0)); }
    std::string operator()(OptionalPlace at) const { return at(scene, 0) ? number_text(*at(scene, 0)) : ""; }
    std::string operator()(IntegerPlace at) const { return fmt::format("{}", at(scene, 0)); }
    std::string operator()(TextPlace at) const { return '"' + at(scene, 0) + '"'; }
    std::string operator()(FormulasPlace) const { return {}; }
    std::string operator()(const WordPlace& at) const {
      const int value = at.get(scene, 0);
      const auto word = std::ranges::find(key.words, value, &Word::value);
      return word == key.words.end() ? "" : '"' + word->text + '"';
    }
  };
  return std::visit(Text{key, scene}, key.place);
}

std::string keys_as_markdown() {
  std::string text = "| key | unit | default | allowed | meaning |\n|---|---|---|---|---|\n";
  for (const Key& key : scene_keys()) {
    const std::string fallback = key.required ? "required" : default_text(key);
    const std::string law = key.law.empty() ? "" : fmt::format(" (law \"{}\")", key.law);
    text +=
        fmt::format("| `{}` | {} | {} | {} | {}{} |\n", key.path, key.unit, fallback, allowed_text(key), key.help, law);
  }
  return text;
}

}  // namespace strata
