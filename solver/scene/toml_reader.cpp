#include "scene/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <deque>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <utility>

#include "scene/derived.hpp"
#include "scene/reading.hpp"
#include "scene/sweep.hpp"

namespace strata {
namespace {

toml::table parse(std::string_view text) {
  constexpr int most_dots = 1000;  // the parser goes from a key's name into the next, and overflows at several 10,000
  toml::source_position at{1, 1};
  int dots = 0;
  for (const char c : text) {
    if (std::string_view("\n[]{},=#").find(c) != std::string_view::npos) dots = 0;
    if (c == '\n') ++at.line;
    if (c == '.' && ++dots > most_dots)
      throw toml::parse_error("a key of more than a thousand names", {at, at, nullptr});
  }
  return toml::parse(text);
}

struct Parsed {
  toml::table table;
  std::set<unsigned> mended;  // lines that are no TOML, with nan for the value, so that the rest could be read
  bool whole = true;          // whether all lines could be read so
  std::vector<Fault> faults;
};

// A line "key = what is no TOML" as TOML; nothing where it is another, or does not end what it begins.
std::optional<std::string> mended(std::string_view line) {
  const std::string_view key = trimmed(line.substr(0, line.find('=')));
  const auto count = [&](char c) { return std::ranges::count(line, c); };
  if (key.size() == line.size() || !is_plain_name(key, ".") || count('[') != count(']') || count('{') != count('}'))
    return std::nullopt;
  return fmt::format("{} = nan", key);
}

Parsed parse_toml(std::string_view text, const Where& source) {
  constexpr std::size_t most_lines = 50;  // each asks for the text to be parsed anew
  Parsed parsed;
  std::vector<std::string> lines = split(text, "\n");
  for (;;) {
    try {
      parsed.table = parse(fmt::format("{}", fmt::join(lines, "\n")));
      return parsed;
    } catch (const toml::parse_error& error) {
      const unsigned number = error.source().begin.line;
      lines.resize(std::max<std::size_t>(lines.size(), number));  // the end of the text is behind its last line
      std::string& line = lines[number - 1];
      const auto as_toml = mended(line);
      const bool is_new = parsed.mended.insert(number).second;  // else what is wrong with the line begins above
      parsed.whole = is_new && as_toml && parsed.mended.size() < most_lines;
      if (is_new)
        parsed.faults.push_back(
            {where_of(source, error.source()),
             fmt::format("this is not TOML: {}: {}. Write key = value: text in quotes, lists in [ ], numbers with a "
                         "decimal point and no unit, which stands in the key.",
                         shortened(trimmed(line), 60), error.description())});
      if (!parsed.whole) return parsed;
      line = *as_toml;
    }
  }
}

struct Variant {
  std::string name;
  Where where;
  const toml::table* table;
};

// All variants of the scene in the order of the file.
std::vector<Variant> variants_of(const toml::table& root, const std::string& file_name, std::vector<Fault>& faults) {
  std::vector<Variant> variants;
  const Where source{file_name, 1};
  const toml::node* node = root.get("variants");
  if (node == nullptr) return variants;
  if (!node->is_table()) {
    faults.push_back({where_of(source, node->source()), "variants is not a table. Write [variants.NAME] above each."});
    return variants;
  }
  constexpr std::size_t longest = 100;  // of a folder's name systems take 255
  for (const auto& [key, value] : *node->as_table()) {
    const std::string name(key.str());
    const Where where = where_of(source, key.source());
    if (!is_plain_name(name, ".+") || name[0] == '.' || name.size() > longest) {
      faults.push_back({where, fmt::format("variants.\"{}\": a variant names a folder, so it is made of letters, "
                                           "digits, _ - + and a dot that is not the first, at most {} of them.",
                                           name, longest)});
    } else if (!value.is_table()) {
      faults.push_back({where, fmt::format("variants.{0} = {1} is not a table. Write [variants.{0}] and below it the "
                                           "keys it replaces.",
                                           name, as_typed(value))});
    } else {
      variants.push_back({name, where, value.as_table()});
    }
  }
  std::ranges::stable_sort(variants, {}, [](const Variant& v) { return std::pair(v.where.line, v.where.column); });
  return variants;
}

std::vector<std::string> names_of(const std::vector<Variant>& variants) {
  std::vector<std::string> names;
  for (const Variant& variant : variants) names.push_back(variant.name);
  return names;
}

// The chosen variant replaces keys of the scene; what is wrong with the others is a fault too.
void take_variants(Reading& reading, const std::vector<Variant>& variants, const std::string& chosen,
                   const std::string& file_name) {
  const Reading scene = reading;
  const std::vector<std::string> names = names_of(variants);
  for (const auto& [name, where, table] : variants) {
    Reading other = scene;
    take_table(name == chosen ? reading : other, *table, "", where);
    reading.faults.insert(reading.faults.end(), other.faults.begin(), other.faults.end());
    reading.used.merge(other.used);
  }
  if (chosen.empty() || std::ranges::find(names, chosen) != names.end()) return;
  reading.fault({file_name}, "there is no variant {}. It has {}.{}", chosen,
                names.empty() ? "no variants" : fmt::format("{}", fmt::join(names, ", ")), did_you_mean(chosen, names));
}

// Takes up a setting; the table that will hold its value must live as long as the reading.
void take_setting(Reading& reading, const Setting& given, toml::table& table) {
  const auto& [setting, where] = given;
  const std::size_t equals = setting.find('=');
  static const std::regex element(R"(^(strata\.\w+)\.(\d+)\b)");  // as other programs count them
  const std::string path =
      std::regex_replace(std::string(trimmed(std::string_view(setting).substr(0, equals))), element, "$1[$2]");
  if (equals == std::string::npos || path.empty()) return reading.fault(where, "this is not key.path=value.");
  const std::string value(trimmed(std::string_view(setting).substr(equals + 1)));
  try {
    table = parse("value = " + value);
  } catch (const toml::parse_error&) {
    if (is_plain_name(value)) table.insert("value", value);
  }
  if (table.size() == 1) return take_value(reading, path, *table.get("value"), where);
  reading.fault(where,
                "{} is neither TOML nor a bare word. Text in a list or with spaces needs quotes, '[\"weak\"]'; a "
                "number has a decimal point and no unit, which stands in the key.",
                value.empty() ? "an empty value" : shortened(value, 60));
}

// The [[claim]] tables as they will stand in the resolved scene.
std::string claims_text(const toml::table& root) {
  toml::table table;
  if (const toml::node* claims = root.get("claim")) table.insert("claim", *claims->as_array());
  std::ostringstream out;
  if (!table.empty()) out << toml::toml_formatter{table, toml::format_flags::allow_unicode_strings};
  return out.str();
}

// Turns the path of a fracture that ends on the symmetry line so that it starts there.
void start_at_symmetry_line(Scene& scene) {
  if (!scene.fracture || scene.domain.bottom != Edge::symmetry) return;
  auto& path_m = scene.fracture->path_m;
  if (path_m.back()[1] == 0.0 && path_m.front()[1] != 0.0) std::ranges::reverse(path_m);
}

// A scene of a parsed text with a variant and settings; `runs`, where asked for, are those of its sweep.
ReadResult read_parsed(const Parsed& parsed, const std::string& file_name, const std::string& variant,
                       const std::vector<Setting>& set, std::vector<SweepRun>* runs) {
  const Where source{file_name};
  if (!parsed.whole) return {std::nullopt, as_lines(parsed.faults)};
  Reading reading;
  reading.entries[""].where = {file_name, 0, 1, 1};
  take_table(reading, parsed.table, "", source);
  const std::vector<Variant> variants = variants_of(parsed.table, file_name, reading.faults);
  const toml::node* sweep = parsed.table.get("sweep");
  if (runs != nullptr && sweep != nullptr) *runs = take_sweep(reading, *sweep, source, names_of(variants));
  take_variants(reading, variants, variant, file_name);
  std::deque<toml::table> settings;
  for (const Setting& setting : set) take_setting(reading, setting, settings.emplace_back());
  build_scene(reading);
  Scene& scene = reading.scene;
  if (scene.name.empty()) scene.name = std::filesystem::path(file_name).stem().string();
  if (!variant.empty()) scene.variant = variant;
  check_scene(reading);
  // Of a line that is no TOML enough has been said.
  std::erase_if(reading.faults, [&](const Fault& fault) { return parsed.mended.contains(fault.where.line); });
  reading.faults.insert(reading.faults.end(), parsed.faults.begin(), parsed.faults.end());
  if (!reading.faults.empty()) return {std::nullopt, as_lines(reading.faults)};
  start_at_symmetry_line(scene);
  scene.resolved_toml = resolved_toml(scene, claims_text(parsed.table));
  return {std::move(scene), {}, as_lines(std::move(reading.notes))};
}

}  // namespace

ReadResult read_scene_text(std::string_view text, const std::string& file_name, const std::string& variant,
                           const std::vector<std::string>& set) {
  std::vector<Setting> settings;
  for (const std::string& setting : set) settings.push_back({setting, {"--set " + setting, 2}});
  std::vector<SweepRun> runs;
  return read_parsed(parse_toml(text, {file_name}), file_name, variant, settings, &runs);
}

Found list_sweep(std::string_view text, const std::string& file_name) {
  const Parsed parsed = parse_toml(text, {file_name});
  std::vector<SweepRun> runs;
  Found list{{}, read_parsed(parsed, file_name, "", {}, &runs).errors};
  if (!list.errors.empty()) return list;
  constexpr std::size_t most_lines = 20;
  std::set<std::string> said;
  for (const SweepRun& run : runs) {
    toml::array set;
    for (const Setting& setting : run.set) set.push_back(setting.text);
    for (const std::string& line : read_parsed(parsed, file_name, run.variant, run.set, nullptr).errors) {
      if (said.insert(line).second && said.size() <= most_lines)
        list.errors.push_back(fmt::format("{} [run {}]", line, run.name));
    }
    toml::table line{{"name", run.name}, {"set", set}, {"variant", run.variant}};
    line.is_inline(true);
    list.lines.push_back(as_one_line(line));
  }
  return list;
}

Found of_file(const std::filesystem::path& file, Found (*of_text)(std::string_view, const std::string&)) {
  std::error_code code;
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  const char* error = !std::filesystem::exists(file, code)        ? "there is no such file. Check the path."
                      : std::filesystem::is_directory(file, code) ? "this is a folder. Give the path of a file."
                      : !in                                       ? "the file cannot be read. Check its permissions."
                                                                  : nullptr;
  if (error != nullptr) return {{}, {shortened(file.string(), 1000) + ": " + error}};
  text << in.rdbuf();
  return of_text(text.str(), file.string());
}

ReadResult read_scene(const std::filesystem::path& file, const std::string& variant,
                      const std::vector<std::string>& set) {
  const auto [lines, errors] = of_file(file, [](auto text, auto&) { return Found{{std::string(text)}, {}}; });
  return errors.empty() ? read_scene_text(lines[0], file.string(), variant, set) : ReadResult{std::nullopt, errors};
}

Found list_variants(std::string_view text, const std::string& file_name) {
  Parsed parsed = parse_toml(text, {file_name});
  if (!parsed.faults.empty()) return {{}, as_lines(parsed.faults)};
  return {names_of(variants_of(parsed.table, file_name, parsed.faults)), {}};
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

ReadResult check(const std::filesystem::path& file) {
  ReadResult result = read_scene_that_fits(file, "", {});
  const std::vector<std::string> of_scene = result.errors;
  for (const std::string& variant : of_file(file, list_variants).lines) {
    for (const std::string& line : read_scene_that_fits(file, variant, {}).errors) {
      const bool known = std::ranges::find(of_scene, line) != of_scene.end();
      if (!known) result.errors.push_back(line + " [variant " + variant + "]");
    }
  }
  for (const std::string& line : of_scene.empty() ? of_file(file, list_sweep).errors : std::vector<std::string>())
    result.errors.push_back(line);
  return result;
}

}  // namespace strata
