#include "scene/entries.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <sstream>

#include "scene/spelling.hpp"

namespace strata {
namespace {

bool is_plain_name(std::string_view name) {
  return !name.empty() && std::ranges::all_of(name, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-';
  });
}

// The name in rock.NAME or interface.NAME, if the path has one.
std::string_view table_name(std::string_view path) {
  for (std::string_view table : {"rock.", "interface."}) {
    if (!path.starts_with(table)) continue;
    path.remove_prefix(table.size());
    return path.substr(0, path.find('.'));
  }
  return {};
}

// Whether a name in rock.NAME or interface.NAME may be used; at `where` otherwise.
bool check_table_name(const std::string& path, const Where& where, Faults& faults) {
  if (path.find('.') == std::string::npos || (!path.starts_with("rock.") && !path.starts_with("interface.")))
    return true;
  const std::string_view name = table_name(path);
  constexpr std::size_t longest = 64;  // so that it can be read in messages and figures
  if (!is_plain_name(name) || name.size() > longest) {
    faults.add(where,
               fmt::format("{}: a name is made of letters, digits, _ and -, at most {} of them.", path, longest));
    return false;
  }
  if (path.starts_with("interface.") && name == "perfect") {
    faults.add(where, "interface.perfect: the name perfect is taken; a perfect interface needs no table.");
    return false;
  }
  return true;
}

std::string not_a_table_message(const std::string& path, const toml::node& value) {
  if (path.starts_with("rock.") || path.starts_with("interface.")) {
    const std::string table = path.substr(0, path.find('.'));
    return fmt::format("{} = {} is not a table. Give each {} a name: [{}.NAME].", path, as_typed(value), table, table);
  }
  if (value.is_array_of_tables()) {
    return fmt::format("{} = {} is a list of tables, but a scene has one. Write [{}] once.", path, as_typed(value),
                       path);
  }
  return fmt::format("{} = {} is not a table. It has the keys {}.", path, as_typed(value),
                     fmt::join(names_in_table(path), ", "));
}

}  // namespace

Where where_of(const Origin& origin, const toml::source_region& source) {
  if (origin.rank == 2) return {origin.name, 0, 0, origin.rank};
  const unsigned line = source.begin.line;
  const unsigned column = source.begin.column;
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

void flatten_value(const std::string& path, const toml::node& value, const Where& where, const Origin& origin,
                   bool dotted, Entries& entries, Faults& faults) {
  if (!check_table_name(path, where, faults)) return;
  const std::string_view first = std::string_view(path).substr(0, path.find('.'));
  if (first == "variants" || first == "claim") {
    faults.add(where, fmt::format("{}: a variant and --set may replace keys of the scene, not {}.", path,
                                  first == "claim" ? "claims" : "variants"));
    return;
  }
  if (path.find('[') != std::string::npos) {  // only this list of keys writes elements so
    faults.add(where, unknown_key_message(path));
    return;
  }
  if (const Key* key = find_key(path)) {
    const auto earlier = entries.values.find(path);
    if (earlier != entries.values.end() && origin.rank != 2) {
      faults.add(where,
                 fmt::format("{} is given twice; first at line {}. Remove one.", path, earlier->second.where.line));
      return;
    }
    Given given{key, &value, origin, where, true};
    given.sound = check_value(path, given, faults);
    entries.values.insert_or_assign(path, given);
    return;
  }
  if (!is_key_table(path)) {
    faults.add(where, unknown_key_message(path));
  } else if (const toml::table* inner = value.as_table()) {
    entries.tables.try_emplace(path, where);
    flatten(*inner, path, origin, {}, dotted, entries, faults);
  } else {
    faults.add(where, not_a_table_message(path, value));
    entries.tables.try_emplace(path, where);  // it was given, if not well
    const toml::array* list = value.is_array_of_tables() ? value.as_array() : nullptr;
    if (list != nullptr) flatten(*list->front().as_table(), path, origin, {}, dotted, entries, faults);
  }
}

void flatten(const toml::table& table, const std::string& prefix, const Origin& origin,
             const std::vector<std::string>& skip, bool dotted, Entries& entries, Faults& faults) {
  for (const auto& [name, value] : table) {
    const std::string text(name.str());
    if (std::ranges::find(skip, text) != skip.end()) continue;
    const std::string path = prefix.empty() ? text : prefix + '.' + text;
    const Where where = where_of(origin, name.source());
    if (!dotted && text.find('.') != std::string::npos) {
      faults.add(where, fmt::format("unknown key \"{}\". Outside [variants] write a path without quotes.", text));
      continue;
    }
    flatten_value(path, value, where, origin, dotted, entries, faults);
  }
}

void lay_over(Entries& base, const Entries& above) {
  for (const auto& [path, given] : above.values) base.values.insert_or_assign(path, given);
  for (const auto& [path, where] : above.tables) base.tables.try_emplace(path, where);
}

}  // namespace strata
