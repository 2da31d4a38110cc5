#include "scene/well_log.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>
#include <set>

#include "scene/reading.hpp"

namespace strata {
namespace {

constexpr double units_per_m = 1e4;  // lengths are whole numbers of 0.1 mm, as half feet are
constexpr std::string_view text_of_scene =
#include <well_log.toml.hpp>
    ;
constexpr std::string_view needed = "top_m, youngs_modulus_Pa, poisson_ratio, toughness_Pa_sqrt_m, horizontal_Pa";

// Until layers are stacked, to_m holds the depth of a layer's top.
constexpr Key top_m{.kind = Key::Kind::number,
                    .path = "top_m",
                    .member = at<&Scene::strata, &Strata::layers, &Layer::to_m>,
                    .help = "",
                    .bounds = {0.0, 1e5, false, false},
                    .advice = "Depths grow downwards from the ground."};

const Key* column(const std::string& name) {
  if (name == "top_m") return &top_m;
  if (name == "interface") return find_key("interface.NAME.law");
  return find_key((name == "rock" || name == "horizontal_Pa" ? "strata.layers[]." : "rock.NAME.") + name);
}

struct Cell {
  std::string text;
  Where where;
};

// A log while it is read. The scene's rocks, laws and layers are those of the rows, from the top.
struct Log {
  Reading reading;
  std::vector<std::vector<Cell>> rows;  // the header first; the last one is the bottom

  // The cell of a row in a column; empty where there is none.
  Cell cell(std::size_t row, std::string_view name) const {
    const auto at = static_cast<std::size_t>(std::ranges::find(rows[0], name, &Cell::text) - rows[0].begin());
    return at < rows[row].size() ? rows[row][at] : Cell{"", rows[row][0].where};
  }
};

void split_rows(Log& log, std::string_view text, const std::string& file) {
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);  // by which spreadsheets mark UTF-8
  Where where{file, 0, 0, 1};
  for (const std::string& line : split(text, "\n")) {
    ++where.line;
    where.column = 1;
    if (trimmed(line).starts_with('#') || line.find_first_not_of(", \t\r") == line.npos) continue;
    auto& row = log.rows.emplace_back();
    for (const std::string& cell : split(line, ",")) {
      row.push_back({std::string(trimmed(cell)), where});
      row.back().where.column += static_cast<unsigned>(std::min(cell.find_first_not_of(" \t\r"), cell.size()));
      where.column += static_cast<unsigned>(cell.size()) + 1;
    }
  }
  if (log.rows.size() < 3) log.reading.fault({file, 0, 1, 1}, "this is no well log: {}", log_help());
}

void check_header(Log& log) {
  std::vector<std::string> known = names_in_table("rock.NAME");
  known.insert(known.begin(), {"top_m", "rock", "horizontal_Pa", "interface"});
  for (const auto& [name, where] : log.rows[0]) {
    if (column(name) == nullptr)
      log.reading.fault(where, "{} is no column of a well log, which has {}, with commas between.{}", name,
                        fmt::format("{}", fmt::join(known, ", ")), did_you_mean(name, known));
    if (log.cell(0, name).where.column != where.column)
      log.reading.fault(where, "the column {} is there twice. Remove one.", name);
  }
  for (const std::string& name : split(needed, ", "))
    if (log.cell(0, name).text != name)
      log.reading.fault(log.rows[0][0].where, "the column {} is missing. A log needs {}.", name, needed);
}

// Writes a cell to its member of the scene.
void read_cell(Log& log, std::size_t row, const std::string& name) {
  const auto [text, where] = log.cell(row, name);
  const Key& key = *column(name);
  const bool is_word = key.kind == Key::Kind::text || key.kind == Key::Kind::word;
  double number = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  if (!is_word && (error != std::errc() || end != text.data() + text.size()))
    return log.reading.fault(where, "{} = {} is not a number. Write digits as in 1.5e6, without a unit.", name, text);
  const toml::value<double> as_number(number);
  const toml::value<std::string> as_word(text);
  const toml::node& node = is_word ? static_cast<const toml::node&>(as_word) : as_number;
  key.member.read({name, key, node, where, log.reading.faults}, log.reading.scene, row - 1);
}

// A row of the log. What a layer leaves out of its rock is that of the last row above with the rock's name.
void read_row(Log& log, std::size_t row) {
  Scene& scene = log.reading.scene;
  const Cell named = log.cell(row, "rock"), top = log.cell(row, "top_m");
  const auto above = std::ranges::find(scene.rocks.rbegin(), scene.rocks.rend(), named.text, &Rock::name);
  const bool is_bottom = row + 1 == log.rows.size(), is_known = !named.text.empty() && above != scene.rocks.rend();
  if (!is_bottom) scene.rocks.push_back(is_known ? Rock(*above) : Rock{.name = named.text});
  scene.laws.emplace_back();
  scene.strata.layers.emplace_back().to_m = std::numeric_limits<double>::quiet_NaN();
  const std::vector<std::string> must = split(needed, ", ");
  for (const auto& [name, place] : log.rows[0]) {
    if (column(name) == nullptr) continue;
    const auto [text, where] = log.cell(row, name);
    const bool from_above = is_known && column(name)->path.starts_with("rock."), is_depth = name == "top_m";
    if (!text.empty() && is_bottom && !is_depth) {
      log.reading.fault(where, "{} = {}: the last row holds the depth where the last layer ends, alone. Add it.", name,
                        text);
      break;
    } else if (!text.empty()) {
      read_cell(log, row, name);
    } else if (std::ranges::count(must, name) > 0 && (is_depth || !is_bottom) && !from_above) {
      log.reading.fault(where, "{} is missing. Give it{}.", name,
                        is_depth ? "" : ", or the name of a rock above that has it");
    }
  }
  const double above_m = row > 1 ? scene.strata.layers[row - 2].to_m : -std::numeric_limits<double>::infinity();
  if (scene.strata.layers.back().to_m < above_m + 1.0 / units_per_m)
    log.reading.fault(top.where, "top_m = {} is not below the row above, at {} m. Sort rows by depth.", top.text,
                      above_m);
  constexpr std::size_t longest = 60;  // of 64 in a scene, with room for a number
  if (!named.text.empty() && (!is_plain_name(named.text) || named.text.size() > longest))
    log.reading.fault(named.where, "rock = {}: a name is made of letters, digits, _ and -, at most {}.", named.text,
                      longest);
  if (row == 1 && scene.laws[0].kind != InterfaceLaw::Kind::perfect)
    log.reading.fault(log.cell(row, "interface").where, "interface: no layer lies above the first. Leave it out.");
  if (log.rows[row].size() > log.rows[0].size())
    log.reading.fault(log.rows[row][log.rows[0].size()].where, "the row has more cells than the header. Remove them.");
}

std::string metres(double length) {
  return number_text(std::round(length * units_per_m) / units_per_m);
}

// The largest cell that divides all layers, and the thinnest into four at least.
void choose_cell(Log& log) {
  constexpr long fewest = 4, most = 40;
  const std::vector<Layer>& layers = log.reading.scene.strata.layers;
  long step = 0, thinnest = std::numeric_limits<long>::max();
  for (std::size_t k = 1; k < layers.size(); ++k) {
    const long thickness = std::lround((layers[k].to_m - layers[k - 1].to_m) * units_per_m);
    step = std::gcd(step, thickness);
    thinnest = std::min(thinnest, thickness);
  }
  long parts = 1 + (fewest * step - 1) / thinnest;
  while (step % parts != 0 && parts < step) ++parts;
  const long cell = step / parts;
  const double cell_m = log.reading.scene.numerics.cell_m = static_cast<double>(cell) / units_per_m;
  const double thinnest_m = static_cast<double>(thinnest) / units_per_m;
  if (cell * most < thinnest || cell * fewest > thinnest)
    log.reading.fault(
        log.cell(0, "top_m").where,
        "top_m: cells that divide all layers have {} m, and the thinnest layer {} m. Round depths to {} m.",
        metres(cell_m), metres(thinnest_m), std::pow(10.0, std::floor(std::log10(thinnest_m / fewest))));
}

// The index of an equal rock; a new one of a name that is taken becomes NAME_2, NAME_3, ...
std::size_t take_up(std::vector<Rock>& rocks, Rock rock) {
  const std::string name = rock.name = rock.name.empty() ? "rock" : rock.name;
  for (int k = 2;; ++k) {
    const auto same = std::ranges::find(rocks, rock.name, &Rock::name);
    const auto index = static_cast<std::size_t>(same - rocks.begin());
    if (same == rocks.end()) rocks.push_back(rock);
    if (rocks[index] == rock) return index;
    rock.name = fmt::format("{}_{}", name, k);
  }
}

// Puts the layers upwards from y = 0, the log's bottom, whose depth (m) is returned.
double stack(Scene& scene) {
  auto& layers = scene.strata.layers;
  const double bottom_m = layers.back().to_m;
  std::vector<Rock> rocks;
  for (std::size_t k = 0; k + 1 < layers.size(); ++k) {
    layers[k].rock = take_up(rocks, scene.rocks[k]);
    layers[k].from_m = bottom_m - layers[k + 1].to_m;
    layers[k].to_m = bottom_m - layers[k].to_m;
  }
  scene.rocks = rocks;
  layers.pop_back();
  scene.laws.pop_back();
  std::ranges::reverse(layers);
  std::ranges::reverse(scene.laws);
  scene.domain.height_m = layers.back().to_m;
  return bottom_m;
}

// Tables of rocks and interfaces, and the layers.
std::string strata_text(Scene& scene, double bottom_m) {
  std::string text, layers, interfaces;
  const auto add = [&](const std::string& name, std::string_view keys, std::size_t k) {
    text += fmt::format("\n[{}]\n{}\n", name, fmt::join(lines_of(keys, scene, k), "\n"));
  };
  for (std::size_t k = 0; k < scene.rocks.size(); ++k) add("rock." + scene.rocks[k].name, "rock.NAME.", k);
  std::set laws{InterfaceLaw::Kind::perfect};
  for (std::size_t k = 0; k < scene.strata.layers.size(); ++k) {
    const std::string law = word_of(scene.laws[k].kind);
    scene.laws[k].failure_length_m = 2.0 * scene.numerics.cell_m;  // a shorter one is not resolved
    if (laws.insert(scene.laws[k].kind).second) {
      text += "\n# open: all but the law";
      add("interface." + law, "interface.NAME.", k);
    }
    layers += fmt::format("  {{{}}},    # up from {} m\n", fmt::join(lines_of("strata.layers[].", scene, k), ", "),
                          metres(bottom_m - scene.strata.layers[k].from_m));
    if (k + 1 < scene.strata.layers.size()) interfaces += fmt::format("{}\"{}\"", k > 0 ? ", " : "", law);
  }
  return fmt::format("{}\n[strata]\nlayers = [    # upwards, with their depths\n{}]\ninterfaces = [{}]", text, layers,
                     interfaces);
}

// Stops by the tips, 5 cells before the log's ends, where rings no longer fit into fine cells; of a tip that begins
// there none.
std::string tip_stops(double height, double cell, double low, double high) {
  constexpr double clear = 5.0;  // cells
  const double least = clear * cell, most = height - clear * cell, slack = 0.5 * cell;
  std::string text;
  if (high < most - slack) text += fmt::format("\ntip_y_m = {}    # 5 cells below the log's top", metres(most));
  if (low > least + slack) text += fmt::format("\nlower_tip_y_m = {}    # 5 cells above its bottom", metres(least));
  return text;
}

// The scene: a fracture in the layer of least stress, the thickest of such, under a pressure that no layer withstands.
std::string scene_text(Scene& scene) {
  const double bottom_m = stack(scene), cell = scene.numerics.cell_m, height = scene.domain.height_m;
  const auto stress = [](const Layer& layer) { return layer.horizontal_Pa->number; };
  const Layer& weakest = *std::ranges::min_element(
      scene.strata.layers, {}, [&](const Layer& l) { return std::pair(stress(l), l.from_m - l.to_m); });
  const double quarter = cell * std::floor((weakest.to_m - weakest.from_m) / cell / 4.0 + 0.1);  // in whole cells
  const double from = weakest.from_m + quarter, to = weakest.to_m - quarter;
  const double x = cell * std::ceil(height / cell / 4.0 - 0.1),
               most = stress(std::ranges::max(scene.strata.layers, {}, stress));
  const double toughest = std::ranges::max(scene.rocks, {}, &Rock::toughness_Pa_sqrt_m).toughness_Pa_sqrt_m;
  std::string fluid = fmt::format(
      R"(law = "uniform"    # open: or "reynolds", with viscosity_Pa_s, inlet = {{rate_m2_s = 1e-4}} and stop.time_s
inlet = {{start_Pa = {}, rate_Pa_s = 0.1e6}}    # from the stress that closes the fracture)",
      number_text(stress(weakest)));
  std::string stop = fmt::format(
      "inlet_Pa = {:.4e}    # open: above the largest stress by 1 % and what starts the fracture in the toughest rock",
      1.01 * most + toughest / std::sqrt(std::numbers::pi / 2.0 * (to - from)));
  if (scene.leaks()) {  // which needs a law that conserves the fluid
    fluid = "law = \"reynolds\"\nviscosity_Pa_s = 0.1    # open\ninlet = {rate_m2_s = 1e-4}    # open";
    stop = "time_s = 100.0    # open";
  }
  stop += tip_stops(height, cell, from, to);
  return fmt::format(text_of_scene, fmt::arg("bottom", metres(bottom_m)), fmt::arg("width", metres(2.0 * x)),
                     fmt::arg("height", metres(height)), fmt::arg("beyond", metres(20.0 * height)),
                     fmt::arg("vertical", 25e3 * (bottom_m - height / 2.0)),
                     fmt::arg("strata", strata_text(scene, bottom_m)), fmt::arg("x", metres(x)),
                     fmt::arg("low", metres(from)), fmt::arg("high", metres(to)), fmt::arg("cell", metres(cell)),
                     fmt::arg("pair", metres(2.0 * cell)), fmt::arg("far", metres(8.0 * cell)),
                     fmt::arg("fluid", fluid), fmt::arg("stop", stop));
}

}  // namespace

Found scene_of_log(std::string_view text, const std::string& file_name) {
  Log log;
  split_rows(log, text, file_name);
  const std::size_t end = log.reading.faults.empty() ? log.rows.size() : 0;
  if (end > 0) check_header(log);
  for (std::size_t row = 1; row < end; ++row) read_row(log, row);
  if (log.reading.faults.empty()) choose_cell(log);
  return log.reading.faults.empty() ? Found{{scene_text(log.reading.scene)}, {}}
                                    : Found{{}, as_lines(log.reading.faults)};
}

std::string log_help() {
  return fmt::format(
      "a row a layer, from the top, and a last one with the depth where the last layer ends; cells between commas, "
      "lines of # left out. Columns by the header: top_m (depth of the layer's top, growing downwards), horizontal_Pa "
      "(the stress that closes a fracture), interface (at the layer's top: {}; none: perfect), rock (its name) and {}.",
      find_key("interface.NAME.law")->allowed, fmt::join(names_in_table("rock.NAME"), ", "));
}

}  // namespace strata
