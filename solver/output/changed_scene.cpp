#include "output/changed_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "output/result_hdf5.hpp"
#include "scene/spelling.hpp"
#include "scene/toml_reader.hpp"

namespace strata {

namespace {

using Lines = std::map<std::string, std::string>;  // "stop.tip_y_m" and its value

// A resolved scene by its keys; a list that has several lines counts as one value.
Lines lines_of(std::string_view text) {
  Lines lines;
  std::string table, key;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t equals = line.find(" = ");
    if (line.starts_with('[')) {
      table = std::string(line.substr(1, line.find(']') - 1)) + '.';
    } else if (equals != std::string_view::npos && !line.starts_with(' ')) {
      key = table + std::string(line.substr(0, equals));
      lines[key] += line.substr(equals + 3);
    } else {
      lines[key] += line;
    }
  }
  return lines;
}

std::string value_of(const Lines& lines, const std::string& key) {
  const auto found = lines.find(key);
  return found == lines.end() ? "left out" : shortened(found->second, 60);
}

// "stop.tip_y_m = 20.0 (12.0 in the run)" of each key that differs.
std::vector<std::string> changes(const Lines& run, const Lines& now) {
  Lines all = run;
  all.insert(now.begin(), now.end());
  std::vector<std::string> texts;
  for (const auto& [key, value] : all) {
    if (run.contains(key) && now.contains(key) && run.at(key) == now.at(key)) continue;
    texts.push_back(fmt::format("{} = {} ({} in the run)", key, value_of(now, key), value_of(run, key)));
  }
  return texts;
}

}  // namespace

void require_unchanged_scene(const RunFolder& folder, const Scene& scene) {
  const std::string of_run = made_with(folder.result()).scene;
  if (of_run.empty()) return;  // nothing was computed
  // Read as scene.toml is: another version may know more keys.
  const ReadResult read = read_scene_text(of_run, folder.scene().string(), "", {});
  const std::string before = read.scene ? read.scene->resolved_toml : of_run;
  if (before == scene.resolved_toml) return;
  throw OutputFailure(fmt::format(
      "{0}: was changed after the run began: {1}. The run belongs to the scene as it was. Put that back, or run the "
      "changed "
      "scene anew: `strata run {0} --out DIR`, or `strata run {0} --out {2} --replace` in the place of this run.",
      folder.scene().string(), fmt::join(changes(lines_of(before), lines_of(scene.resolved_toml)), ", "),
      folder.path.string()));
}

std::string how_it_ended(const RunFolder& folder) {
  std::string how = "its summary cannot be read";
  try {
    const auto summary = nlohmann::json::parse(read_whole(folder.summary()));
    how = fmt::format("{}: {}", summary.at("status").get<std::string>(), summary.at("reason").get<std::string>());
  } catch (const std::exception&) {  // said already
  }
  const bool known = !made_with(folder.result()).scene.empty();
  return fmt::format("{}: has ended and is left as it is ({}){}", folder.path.string(), how,
                     known ? "" : "; whether scene.toml was changed since then it does not say");
}

}  // namespace strata
