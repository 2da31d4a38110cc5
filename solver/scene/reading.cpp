#include "scene/reading.hpp"

#include <algorithm>
#include <sstream>

namespace strata {
namespace {

// Whether a name in rock.NAME or interface.NAME may be used.
bool check_table_name(Reading& reading, const std::string& path, const Where& where) {
  const std::vector<std::string> names = split(path, ".");
  if (names.size() < 2 || (names[0] != "rock" && names[0] != "interface")) return true;
  constexpr std::size_t longest = 64;  // so that it can be read in messages and figures
  const bool plain = is_plain_name(names[1]) && names[1].size() <= longest,
             taken = names[0] == "interface" && names[1] == "perfect";
  if (!plain)
    reading.fault(where, "{}: a name is made of letters, digits, _ and -, at most {} of them.", path, longest);
  if (taken) reading.fault(where, "interface.perfect: the name perfect is taken; a perfect interface needs no table.");
  return plain && !taken;
}

bool is_key_table(const std::string& path) {
  return !names_in_table(path).empty();
}

// A layer has a rock, a border of layers an interface.
void note_use(Reading& reading, std::string_view pattern, const toml::node& value) {
  const bool has_rock = pattern == "strata.layers[].rock";
  if (value.is_string() && (has_rock || pattern == "strata.interfaces[]" || pattern == "strata.interfaces[].name"))
    reading.used.insert((has_rock ? "rock." : "interface.") + value.as_string()->get());
}

// Elements of a list have each a place; those that are tables give keys of their own.
void take_elements(Reading& reading, const std::string& path, const toml::array& list, const Where& source) {
  std::erase_if(reading.entries, [&](const auto& entry) { return entry.first.starts_with(path + '['); });
  for (std::size_t k = 0; k < list.size(); ++k) {
    const std::string element = fmt::format("{}[{}]", path, k);
    const Where where = where_of(source, list[k].source());
    reading.entries[element] = {nullptr, &list[k], where};
    note_use(reading, path + "[]", list[k]);
    if (const toml::table* table = list[k].as_table(); table != nullptr && is_key_table(element))
      take_table(reading, *table, element, where);
  }
}

// A table or a list of tables, or where there should be one.
void take_inner_table(Reading& reading, const std::string& path, const toml::node& value, const Where& where) {
  reading.entries.try_emplace(path, Given{nullptr, nullptr, where});  // it was given, if not well
  const bool is_list = value.is_array_of_tables();
  if (!is_key_table(path)) {
    if (is_list) return take_elements(reading, path, *value.as_array(), where);
    return reading.fault(where, "{0} is not a list of tables. Write [[{0}]] above each.", path);
  }
  if (!value.is_table()) {
    const std::string kind = path.substr(0, path.find('.'));
    const bool named = kind != path && (kind == "rock" || kind == "interface");
    const std::string keys = fmt::format("{}", fmt::join(names_in_table(path), ", "));
    reading.fault(where, "{} = {} is not a table. {}.", path, as_typed(value),
                  named                 ? fmt::format("Give each {0} a name: [{0}.NAME]", kind)
                  : path.ends_with(']') ? fmt::format("Write {{...}} with keys of {}", keys)
                                        : fmt::format("Write [{}] once; it has the keys {}", path, keys));
  }
  const toml::table* table = is_list ? value.as_array()->front().as_table() : value.as_table();
  if (table != nullptr) take_table(reading, *table, path, where);
}

}  // namespace

const Where& Reading::where(std::string_view path) const {
  auto found = entries.find(path);
  while (found == entries.end()) {
    const std::size_t end = path.find_last_of(".[");
    path = end == path.npos ? "" : path.substr(0, end);
    found = entries.find(path);
  }
  return found->second.where;
}

bool Reading::sound(std::string_view path) const {
  for (auto at = entries.lower_bound(path); at != entries.end() && at->first.starts_with(path); ++at) {
    const bool within = at->first.size() == path.size() || at->first[path.size()] == '[';
    if (within && !at->second.sound) return false;
  }
  return true;
}

std::string quoted_element(const std::string& path, const toml::node& value) {
  const toml::table* table = value.as_table();
  if (table == nullptr || table->empty() || !is_key_table(path + "[]")) return "";
  const std::string_view first = table->begin()->first.str();
  if (first.find_first_not_of("0123456789") != first.npos) return "";
  const toml::table* inner = table->begin()->second.as_table();
  const std::string key = inner != nullptr && !inner->empty() ? fmt::format(".{}", inner->begin()->first.str()) : "";
  return fmt::format("\"{}[{}]{}\"", path, first, key);
}

std::string as_one_line(const toml::node& value) {
  if (const auto* number = value.as_floating_point()) return number_text(number->get());
  std::ostringstream out;
  out << toml::toml_formatter{value, toml::format_flags::allow_unicode_strings};
  std::string text = out.str();
  std::ranges::replace(text, '\n', ' ');
  return text;
}

std::string as_typed(const toml::node& value) {
  constexpr std::size_t longest = 60;  // what fits in a line beside the rest of a message
  return shortened(as_one_line(value), longest);
}

void take_value(Reading& reading, const std::string& path, const toml::node& value, const Where& where) {
  if (!check_table_name(reading, path, where)) return;
  if (where.rank > 0 && (path.starts_with("variants") || path.starts_with("claim") || path.starts_with("sweep"))) {
    reading.fault(where,
                  "{}: a variant, a sweep and --set may replace keys of the scene, not claims, variants or a sweep.",
                  path);
    return;
  }
  const Key* key = find_key(path);
  const bool is_table = is_key_table(path) || is_key_table(path + "[]");
  const std::string element = path.substr(0, path.rfind(']') + 1);  // of a list, if any
  if (key == nullptr && path.starts_with("claim[")) return;         // the harness's
  if (!reading.given(element))
    return reading.fault(where, "unknown key {}. There is no {}; elements are counted from 0.", path, element);
  if (key == nullptr && !is_table) return reading.fault(where, "{}", unknown_key_message(path));
  if (key == nullptr && value.is_string() && find_key(path + ".name") != nullptr)  // an interface by its name alone
    return take_value(reading, path + ".name", value, where);
  if (key == nullptr) return take_inner_table(reading, path, value, where);
  const auto earlier = reading.entries.find(path);
  if (earlier != reading.entries.end() && where.rank == 1 && earlier->second.where.rank == 1) {
    reading.fault(where, "{} is given twice; first at line {}. Remove one.", path, earlier->second.where.line);
    return;
  }
  for (std::size_t dot = path.find('.'); dot != path.npos; dot = path.find('.', dot + 1))  // --set names no tables
    reading.entries.try_emplace(path.substr(0, dot), Given{nullptr, nullptr, where});
  if (const std::string quoted = quoted_element(path, value); !quoted.empty())
    return reading.fault(where, "{} is a list. Name an element of it, counted from 0, in quotes: {} = ...", path,
                         quoted);
  Scene any = scene_of_one();
  const bool sound = key->member.read({path, *key, value, where, reading.faults}, any, 0);
  reading.entries[path] = {key, &value, where, sound};
  note_use(reading, key->path, value);
  if (value.is_array()) take_elements(reading, path, *value.as_array(), where);
}

void take_table(Reading& reading, const toml::table& table, const std::string& prefix, const Where& source) {
  for (const auto& [key, value] : table) {
    const std::string name(key.str()), path = prefix.empty() ? name : prefix + '.' + name;
    const Where where = where_of(source, key.source());
    if (source.rank == 0 && (path == "variants" || path == "sweep")) continue;
    if (source.rank == 0 && name.find_first_of(".[") != name.npos) {
      reading.fault(where, "unknown key \"{}\". Outside [variants] write a path without quotes.", name);
    } else {
      take_value(reading, path, value, where);
    }
  }
}

}  // namespace strata
