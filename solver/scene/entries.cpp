#include "scene/entries.hpp"

#include <algorithm>
#include <sstream>

namespace strata {
namespace {

// Whether a name in rock.NAME or interface.NAME may be used; at `where` otherwise.
bool check_table_name(const std::string& path, const Where& where, Faults& faults) {
  const std::vector<std::string> segments = split(path, ".");
  if (segments.size() < 2 || (segments[0] != "rock" && segments[0] != "interface")) return true;
  constexpr std::size_t longest = 64;  // so that it can be read in messages and figures
  if (!is_plain_name(segments[1]) || segments[1].size() > longest) {
    faults.add(where, "{}: a name is made of letters, digits, _ and -, at most {} of them.", path, longest);
    return false;
  }
  if (segments[0] == "rock" || segments[1] != "perfect") return true;
  faults.add(where, "interface.perfect: the name perfect is taken; a perfect interface needs no table.");
  return false;
}

std::string not_a_table_message(const std::string& path, const toml::node& value) {
  const std::string typed = path + " = " + as_typed(value), table = split(path, ".").front();
  if (table != path && (table == "rock" || table == "interface"))
    return fmt::format("{} is not a table. Give each {} a name: [{}.NAME].", typed, table, table);
  if (value.is_array_of_tables())
    return fmt::format("{} is a list of tables, but a scene has one. Write [{}] once.", typed, path);
  return fmt::format("{} is not a table. It has the keys {}.", typed, fmt::join(names_in_table(path), ", "));
}

}  // namespace

const Where& where_is(const Entries& entries, std::string_view path) {
  auto found = entries.at.find(path);
  while (found == entries.at.end()) {
    const std::size_t end = path.find_last_of(".[");
    path = end == path.npos ? "" : path.substr(0, end);
    found = entries.at.find(path);
  }
  return found->second.where;
}

Where where_of(const Origin& origin, const toml::source_region& source) {
  if (origin.rank == 2) return {origin.name, 0, 0, origin.rank};
  const unsigned line = source.begin.line, column = source.begin.column;
  return {fmt::format("{}:{}:{}", origin.name, line, column), line, column, origin.rank};
}

std::string as_typed(const toml::node& value) {
  if (const auto* number = value.as_floating_point()) return number_text(number->get());
  std::ostringstream out;
  out << toml::toml_formatter{value, toml::format_flags::allow_unicode_strings};
  std::string text = out.str();
  std::ranges::replace(text, '\n', ' ');
  constexpr std::size_t longest = 60;  // what fits in a line beside the rest of a message
  return shortened(text, longest);
}

double as_number(const toml::node& number) {
  return number.is_integer() ? static_cast<double>(number.as_integer()->get()) : number.as_floating_point()->get();
}

void flatten_value(const std::string& path, const toml::node& value, const Where& where, const Origin& origin,
                   Entries& entries, Faults& faults) {
  if (!check_table_name(path, where, faults)) return;
  const std::string first = split(path, ".").front();
  if (first == "variants" || first == "claim") {
    faults.add(where, "{}: a variant and --set may replace keys of the scene, not {}.", path,
               first == "claim" ? "claims" : "variants");
    return;
  }
  const Key* key = find_key(path);
  if (path.find('[') != path.npos || (key == nullptr && !is_key_table(path))) {  // only the list of keys writes [
    faults.add(where, unknown_key_message(path));
    return;
  }
  const toml::array* list = value.as_array();
  if (key == nullptr) {
    entries.at.try_emplace(path, Given{nullptr, nullptr, origin, where});  // it was given, if not well
    const toml::table* inner = value.as_table();
    if (inner == nullptr) faults.add(where, not_a_table_message(path, value));
    if (value.is_array_of_tables()) inner = list->front().as_table();
    if (inner != nullptr) flatten(*inner, path, origin, entries, faults);
    return;
  }
  const auto earlier = entries.at.find(path);
  if (earlier != entries.at.end() && origin.rank != 2) {
    faults.add(where, "{} is given twice; first at line {}. Remove one.", path, earlier->second.where.line);
    return;
  }
  Given given{key, &value, origin, where};
  given.sound = check_value(path, given, faults);
  entries.at.insert_or_assign(path, given);
  for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
    const Where element = where_of(origin, (*list)[k].source());
    entries.at.insert_or_assign(fmt::format("{}[{}]", path, k), Given{nullptr, nullptr, origin, element});
  }
}

void flatten(const toml::table& table, const std::string& prefix, const Origin& origin, Entries& entries,
             Faults& faults) {
  for (const auto& [name, value] : table) {
    const std::string text(name.str());
    if (prefix.empty() && origin.rank == 0 && (text == "variants" || text == "claim")) continue;
    const Where where = where_of(origin, name.source());
    if (origin.rank == 0 && text.find('.') != text.npos) {
      faults.add(where, "unknown key \"{}\". Outside [variants] write a path without quotes.", text);
    } else {
      flatten_value(prefix.empty() ? text : prefix + '.' + text, value, where, origin, entries, faults);
    }
  }
}

void lay_over(Entries& base, const Entries& above) {
  for (const auto& [path, given] : above.at) {
    const bool is_table = given.key == nullptr && path.find('[') == path.npos;
    if (!is_table || !base.given(path)) base.at.insert_or_assign(path, given);
  }
}

}  // namespace strata
