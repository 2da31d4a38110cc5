#include "scene/new_scene.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <memory>
#include <set>
#include <string_view>
#include <utility>

#include "scene/keys.hpp"
#include "scene/messages.hpp"

namespace strata {
namespace {

// The text of new_scene.toml. What its keys mean is put above them, also above a line "# key = value".
constexpr std::string_view scene_to_start_from =
#include <new_scene.toml.hpp>
    ;

// What the list of keys says of a key, and of those of its elements, as lines of a comment.
std::string comment_on(const Key& key, std::string_view indent = "") {
  constexpr std::size_t longest = 100;
  const bool has_choice = key.kind != Key::Kind::list && key.kind != Key::Kind::text;
  const std::string unit = key.unit.empty() ? "" : fmt::format(" ({})", key.unit), standard = default_text(key);
  std::string text, line = fmt::format("# {}{}{}:", indent, key.name(), unit);
  for (const std::string& word :
       split(fmt::format("{}{}{}", key.help, has_choice ? fmt::format(" Allowed: {}.", allowed_text(key)) : "",
                         standard.size() < 3 ? "" : fmt::format(" Default: {}.", standard)),
             " ")) {
    if (line.size() + 1 + word.size() > longest) text += std::exchange(line, fmt::format("#  {}", indent)) + '\n';
    line += ' ' + word;
  }
  text += line + '\n';
  for (const Key& of_element : scene_keys())
    if (of_element.table() == fmt::format("{}[].", key.path)) text += comment_on(of_element, "  ");
  return text;
}

// The scene with this title, its keys explained where they first stand.
std::string new_scene_text(std::string_view title) {
  std::string text, table;
  std::set<std::string_view> explained;
  for (const std::string& line : split(scene_to_start_from, "\n")) {
    if (line.starts_with('[')) table = line.substr(1, line.size() - 2) + '.';
    const std::size_t start = line.starts_with("# ") ? 2 : 0, end = line.find(" = ");
    const Key* key = end == line.npos ? nullptr : find_key(table + line.substr(start, end - start));
    if (key != nullptr && explained.insert(key->path).second) text += comment_on(*key);
    text += line + '\n';
  }
  return text.replace(text.find("TITLE"), 5, title);
}

}  // namespace

std::vector<std::string> write_new_scene(const std::string& name) {
  const std::string title = name.substr(0, name.size() - (name.ends_with(".toml") ? 5 : 0)), file = title + ".toml";
  if (!is_plain_name(title, ".")) return {fmt::format("{}: a name is made of letters, digits, _ - and dots.", name)};
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> out(std::fopen(file.c_str(), "wx"), &std::fclose);
  if (!out && errno == EEXIST)
    return {fmt::format("{}: the file is there and is left as it is. Give another name.", file)};
  if (out && std::fputs(new_scene_text(title).c_str(), out.get()) >= 0 && std::fflush(out.get()) == 0) return {};
  if (out) std::remove(file.c_str());
  return {fmt::format("{}: the file cannot be written. Check the folder's permissions and room.", file)};
}

}  // namespace strata
