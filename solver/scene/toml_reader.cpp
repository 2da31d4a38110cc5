#include "scene/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <fstream>
#include <memory>
#include <sstream>
#include <utility>

#include "scene/derived.hpp"
#include "scene/entries.hpp"
#include "scene/scene_checks.hpp"
#include "scene/syntax.hpp"

namespace strata {
namespace {

// A file's text, or why there is none.
struct FileText {
  std::string text;
  std::string error;
};

FileText file_text(const std::filesystem::path& file) {
  const std::string name = shortened(file.string(), 1000);
  std::error_code code;
  if (!std::filesystem::exists(file, code)) return {"", name + ": there is no such file. Check the path."};
  if (std::filesystem::is_directory(file, code))
    return {"", name + ": this is a folder. Give the path of a scene file."};
  std::ifstream in(file, std::ios::binary);
  if (!in) return {"", name + ": the file cannot be read. Check its permissions."};
  std::ostringstream text;
  text << in.rdbuf();
  return {text.str(), ""};
}

struct Variant {
  std::string name;
  Where where;
  Entries entries;
};

bool is_folder_name(std::string_view name) {
  constexpr std::size_t longest = 100;  // systems take 255
  return !name.empty() && name.size() <= longest && name[0] != '.' && std::ranges::all_of(name, [](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 ||
           std::string_view("_-.+").find(c) != std::string_view::npos;
  });
}

// All variants of the scene in the order of the file; what is wrong with them, chosen or not, goes to `faults`.
std::vector<Variant> read_variants(const toml::table& root, const std::string& file_name, Faults& faults) {
  std::vector<Variant> variants;
  const Origin origin{file_name, 1};
  const toml::node* node = root.get("variants");
  if (node == nullptr) return variants;
  if (!node->is_table()) {
    faults.add(where_of(origin, node->source()), "variants is not a table. Write [variants.NAME] above each.");
    return variants;
  }
  for (const auto& [name, value] : *node->as_table()) {
    Variant variant{std::string(name.str()), where_of(origin, name.source()), {}};
    if (!is_folder_name(variant.name)) {
      faults.add(variant.where, fmt::format("variants.\"{}\": a variant names a folder, so it is made of letters, "
                                            "digits, _ - + and a dot that is not the first, at most 100 of them.",
                                            variant.name));
    } else if (!value.is_table()) {
      faults.add(variant.where,
                 fmt::format("variants.{} = {} is not a table. Write [variants.{}] and below it the keys it replaces.",
                             variant.name, as_typed(value), variant.name));
    } else {
      flatten(*value.as_table(), "", origin, variant.entries, faults);
      variants.push_back(std::move(variant));
    }
  }
  std::ranges::stable_sort(variants, {}, [](const Variant& v) { return std::pair(v.where.line, v.where.column); });
  return variants;
}

// Reads one "key.path=value" into `entries`; the parsed value is put into `tables`, which must live as long.
void read_setting(const std::string& setting, std::vector<std::unique_ptr<toml::table>>& tables, Entries& entries,
                  Faults& faults) {
  const Origin origin{"--set " + setting, 2};
  const Where where{origin.name, 0, 0, 2};
  const std::size_t equals = setting.find('=');
  const std::string path(trimmed(std::string_view(setting).substr(0, equals)));
  if (equals == std::string::npos || path.empty()) {
    faults.add(where, "this is not key.path=value.");
    return;
  }
  const std::string value(trimmed(std::string_view(setting).substr(equals + 1)));
  Faults of_syntax;
  toml::table table = parse_toml("value = " + value, origin, of_syntax).table;
  if (!of_syntax.list.empty() && is_plain_name(value)) {
    table = toml::table{{"value", value}};
  } else if (!of_syntax.list.empty() || table.size() != 1) {
    std::string advice = advice_on_value(value, find_key(path));
    for (const Fault& fault : of_syntax.list) {
      const std::size_t end = fault.text.find("this is not TOML. ");
      if (advice.empty() && end != std::string::npos) advice = ' ' + fault.text.substr(end == 0 ? 18 : 0);
    }
    if (advice.empty() || advice.find("Text stands in quotes") != std::string::npos)
      advice = " Text in a list or with spaces needs quotes: '[\"weak\"]'.";
    faults.add(where, fmt::format("{} is neither TOML nor a bare word.{}",
                                  value.empty() ? "an empty value" : shortened(value, 60), advice));
    return;
  }
  tables.push_back(std::make_unique<toml::table>(std::move(table)));
  flatten_value(path, *tables.back()->get("value"), where, origin, entries, faults);
}

// The [[claim]] tables as they will stand in the resolved scene.
std::string claims_text(const toml::table& root) {
  const toml::node* claims = root.get("claim");
  if (claims == nullptr) return {};
  toml::table table;
  table.insert("claim", *claims->as_array());
  std::ostringstream out;
  out << toml::toml_formatter{table, toml::format_flags::allow_unicode_strings};
  return out.str();
}

// Turns the path of a fracture that ends on the symmetry line so that it starts there.
void start_at_symmetry_line(Scene& scene) {
  if (!scene.fracture || scene.domain.bottom != Edge::symmetry) return;
  auto& path_m = scene.fracture->path_m;
  if (path_m.back()[1] == 0.0 && path_m.front()[1] != 0.0) std::ranges::reverse(path_m);
}

void lay_variant(const std::string& name, const std::vector<Variant>& variants, const std::string& file_name,
                 Entries& entries, Faults& faults) {
  if (name.empty()) return;
  const auto chosen = std::ranges::find(variants, name, &Variant::name);
  if (chosen != variants.end()) {
    lay_over(entries, chosen->entries);
    return;
  }
  std::vector<std::string> names;
  names.reserve(variants.size());
  for (const Variant& variant : variants) names.push_back(variant.name);
  const std::string known = names.empty() ? "It has no variants." : fmt::format("It has {}.", fmt::join(names, ", "));
  faults.add({file_name}, fmt::format("there is no variant {}. {}{}", name, known, did_you_mean(name, names)));
}

}  // namespace

ReadResult read_scene_text(std::string_view text, const std::string& file_name, const std::string& variant,
                           const std::vector<std::string>& set) {
  const Origin origin{file_name, 0};
  Faults of_syntax;
  const Parsed parsed = parse_toml(text, origin, of_syntax);
  if (!parsed.whole) return {std::nullopt, as_lines(of_syntax)};
  Faults faults;
  Entries entries;
  entries.at[""].where = {file_name + ":1:1", 1, 1, 0};
  flatten(parsed.table, "", origin, entries, faults);
  if (const toml::node* claims = parsed.table.get("claim")) check_claims(*claims, origin, faults);
  lay_variant(variant, read_variants(parsed.table, file_name, faults), file_name, entries, faults);
  std::vector<std::unique_ptr<toml::table>> tables;
  for (const std::string& setting : set) {
    Entries above;
    read_setting(setting, tables, above, faults);
    lay_over(entries, above);
  }
  Scene scene = build_scene(entries, faults);
  if (scene.name.empty()) scene.name = std::filesystem::path(file_name).stem().string();
  if (!variant.empty()) scene.variant = variant;
  check_scene({scene, entries, faults});
  // Of a line that is no TOML enough has been said.
  std::erase_if(faults.list, [&](const Fault& fault) { return parsed.mended.contains(fault.where.line); });
  faults.list.insert(faults.list.end(), of_syntax.list.begin(), of_syntax.list.end());
  if (!faults.list.empty()) return {std::nullopt, as_lines(faults)};
  start_at_symmetry_line(scene);
  scene.resolved_toml = resolved_toml(scene, claims_text(parsed.table));
  return {std::move(scene), {}};
}

ReadResult read_scene(const std::filesystem::path& file, const std::string& variant,
                      const std::vector<std::string>& set) {
  const FileText read = file_text(file);
  if (!read.error.empty()) return {std::nullopt, {read.error}};
  return read_scene_text(read.text, file.string(), variant, set);
}

VariantList list_variants_text(std::string_view text, const std::string& file_name) {
  Faults faults;
  const Parsed parsed = parse_toml(text, {file_name, 0}, faults);
  if (!faults.list.empty()) return {{}, as_lines(faults)};
  VariantList list;
  for (const Variant& variant : read_variants(parsed.table, file_name, faults)) list.names.push_back(variant.name);
  return list;
}

VariantList list_variants(const std::filesystem::path& file) {
  const FileText read = file_text(file);
  if (!read.error.empty()) return {{}, {read.error}};
  return list_variants_text(read.text, file.string());
}

ReadResult read_scene_that_fits(const std::filesystem::path& file, const std::string& variant,
                                const std::vector<std::string>& set) {
  ReadResult result = read_scene(file, variant, set);
  if (!result.scene) return result;
  if (const auto reason = too_large(*result.scene, available_memory())) {
    return {std::nullopt, {file.string() + ":1:1: " + *reason}};
  }
  return result;
}

std::vector<std::string> check(const std::vector<std::string>& files) {
  std::vector<std::string> lines;
  for (const std::string& file : files) {
    const std::vector<std::string> of_scene = read_scene_that_fits(file, "", {}).errors;
    lines.insert(lines.end(), of_scene.begin(), of_scene.end());
    for (const std::string& variant : list_variants(file).names) {
      for (const std::string& line : read_scene_that_fits(file, variant, {}).errors) {
        const bool known = std::ranges::find(of_scene, line) != of_scene.end();
        if (!known) lines.push_back(line + " [variant " + variant + "]");
      }
    }
  }
  return lines;
}

}  // namespace strata
