// From what was given for each key to a scene.
#include <algorithm>
#include <cmath>
#include <set>

#include "scene/reading.hpp"

namespace strata {
namespace {

template <class Element>
std::size_t index_in(const std::vector<Element>& elements, const std::string& name) {
  return static_cast<std::size_t>(std::ranges::find(elements, name, &Element::name) - elements.begin());
}

// Whether a key is one of the law in force. One of another law is a fault, unless the law was replaced by a variant or
// --set that lies above the key.
bool is_of_law(Reading& reading, const std::string& path, const Given& given) {
  const std::string law_path = path.substr(0, path.rfind('.')) + ".law";
  const bool known = reading.usable(law_path);
  const std::string law = known ? reading.entries[law_path].value->as_string()->get() : "";
  if (given.key->is_of(law)) return true;
  if (known && given.where.rank >= reading.where(law_path).rank) {
    reading.refuse(path, "{} belongs to law = \"{}\", but {} = \"{}\". Remove it, or change the law.", path,
                   given.key->law, law_path, law);
  }
  return false;
}

// The rock, law or element of a list that a path leads into, by its index.
std::size_t index_of(const Scene& scene, const std::string& path) {
  if (path.starts_with("rock.")) return index_in(scene.rocks, split(path, ".")[1]);
  if (path.starts_with("interface.")) return index_in(scene.laws, split(path, ".")[1]);
  const std::size_t bracket = path.find('[');
  return bracket == path.npos ? 0 : std::stoul(path.substr(bracket + 1));
}

// Writes each sound value to its member of the scene.
void apply(Reading& reading) {
  Scene& scene = reading.scene;
  if (reading.given("fracture")) scene.fracture.emplace();
  scene.laws.emplace_back();
  for (const auto& [path, given] : reading.entries) {
    const std::string name = path.substr(path.find('.') + 1);
    if (pattern_of(path) == "rock.NAME") scene.rocks.emplace_back().name = name;
    if (pattern_of(path) == "interface.NAME") scene.laws.emplace_back().name = name;
  }
  for (const auto& [path, given] : reading.entries) {
    if (given.key == nullptr || (path.starts_with("interface.") && !is_of_law(reading, path, given))) continue;
    if (!reading.sound(path.substr(0, path.find('[')))) continue;  // nor what is in a list of no use
    given.key->member.read({path, *given.key, *given.value, given.where, reading.faults}, scene, index_of(scene, path));
  }
}

// The inlet's pressure, its rate or a table of either: where more are given, the one that a variant or --set lays above
// the others.
void choose_inlet(Reading& reading) {
  const auto rank_of = [&](const char* path) { return reading.given(path) ? reading.where(path).rank : -1; };
  const int rate = rank_of("fluid.inlet.rate_m2_s"), start = rank_of("fluid.inlet.start_Pa");
  const int pressure = std::max(start, rank_of("fluid.inlet.rate_Pa_s")), table = rank_of("fluid.inlet.table");
  const int top = std::max({rate, pressure, table});
  std::vector<std::string> ways;
  if (table == top) ways.emplace_back("table");
  if (rate == top) ways.emplace_back("rate_m2_s");
  if (pressure == top) ways.emplace_back(start == top ? "start_Pa" : "rate_Pa_s");
  if (top >= 0 && ways.size() > 1) {
    reading.refuse(
        "fluid.inlet." + ways[0],
        "fluid.inlet has both {} and {}. Give the pressure, inlet = {{start_Pa, rate_Pa_s}}, the rate, inlet "
        "= {{rate_m2_s}}, at which a fracture starts at its closing stress, or inlet = {{table, of}}.",
        ways[0], ways[1]);
  }
  Fluid& fluid = reading.scene.fluid;
  if (pressure < top) fluid.start_Pa = fluid.rate_Pa_s = 0.0;
  if (rate < top) fluid.rate_m2_s.reset();
  if (table < top) fluid.table.clear();
  if (fluid.table.empty()) return;
  if (fluid.table_of == Fluid::TableOf::rate_m2_s) {
    fluid.rate_m2_s = fluid.table.front()[1];
  } else {
    fluid.start_Pa = fluid.table.front()[1];
  }
}

// Keys that must be there: those of every scene, of each rock, interface and element of a list, and of a fracture if
// there is one.
void check_required(Reading& reading) {
  const auto none = [&](const auto&... paths) { return !(reading.given(paths) || ...); };
  const bool fracture = reading.scene.fracture.has_value();
  for (const Key& key : scene_keys()) {
    const std::string table(key.path.substr(0, key.path.rfind('.')));
    if (!key.required || (table == "fracture" && !fracture)) continue;
    std::set<std::string> tables;  // that need it
    if (table.find("NAME") == table.npos && !key.in_list()) tables.insert(table);
    for (const auto& [path, given] : reading.entries) {
      const bool is_table = given.value == nullptr || given.value->is_table();  // not "stiff" among layers
      if (is_table && pattern_of(path) == table) tables.insert(path);
    }
    for (const std::string& in : tables) {
      const std::string path = fmt::format("{}.{}", in, key.name());
      if (none(path))
        reading.refuse(path, "{} is missing. {}", path, key.in_list() ? key.help : fmt::format("Give it in [{}].", in));
    }
  }
  if (reading.scene.rocks.empty()) reading.refuse("rock", "there is no rock. Give a table [rock.NAME].");
  const bool misspelt = std::ranges::any_of(
      reading.faults, [](const Fault& fault) { return fault.text.starts_with("unknown key fluid.inlet."); });
  if (fracture && !misspelt &&
      none("fluid.inlet.start_Pa", "fluid.inlet.rate_Pa_s", "fluid.inlet.rate_m2_s", "fluid.inlet.table")) {
    reading.refuse("fluid.inlet",
                   "fluid.inlet is missing; a fracture needs it. Give inlet = {{start_Pa = 2e6, rate_Pa_s = 0.35e6}} "
                   "in [fluid].");
  }
  if (none("stop.tip_y_m", "stop.lower_tip_y_m", "stop.inlet_Pa", "stop.time_s"))
    reading.refuse("stop", "nothing ends the run. Give tip_y_m, lower_tip_y_m, inlet_Pa or time_s in [stop].");
}

// Index of the element whose name was given for `path`, or a fault that lists the names there are.
template <class Element>
std::size_t find_named(Reading& reading, const std::vector<Element>& elements, const std::string& path,
                       std::string_view table) {
  if (!reading.usable(path)) return 0;
  const std::string name = reading.entries[path].value->as_string()->get();
  const std::size_t found = index_in(elements, name);
  if (found < elements.size()) return found;
  std::vector<std::string> names;
  for (const Element& element : elements) names.push_back(element.name);
  reading.refuse(path, "{} = \"{}\": there is no [{}.{}]. There is {}.{}", path, name, table, name,
                 names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")), did_you_mean(name, names));
  return 0;
}

// Onto a grid line or the middle of a cell where it is one but for round-off.
double snapped(double at_m, double cell_m) {
  if (cell_m <= 0.0) return at_m;
  const double nearest = std::round(2.0 * at_m / cell_m) * cell_m / 2.0;
  return std::abs(nearest - at_m) < 1e-6 * cell_m ? nearest : at_m;
}

// Where the layers lie, the last one in what the others leave.
void place_layers(Reading& reading, double extent_m) {
  const double tolerance = 1e-9 * extent_m;  // round-off of a sum of thicknesses
  double from = 0.0;
  auto& layers = reading.scene.strata.layers;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const std::string path = fmt::format("strata.layers[{}]", k);
    const bool is_last = k + 1 == layers.size();
    const double to = reading.given(path + ".thickness_m") ? from + layers[k].to_m : extent_m;
    if (is_last && from >= extent_m - tolerance) {
      reading.refuse(path, "{} has no room: the layers before it fill {} of {} m.", path, from, extent_m);
    } else if (is_last && std::abs(to - extent_m) > tolerance) {
      reading.refuse(path,
                     "strata.layers add up to {} m, but the block has {} m. Make the last thickness_m {}, or leave it "
                     "out.",
                     to, extent_m, extent_m - from);
    }
    layers[k].from_m = from;
    from = layers[k].to_m = is_last ? extent_m : snapped(to, reading.scene.numerics.cell_m);
  }
}

// Where a layer has a stress of its own, each needs one, or there is one for all.
void check_layer_stresses(Reading& reading, std::string_view stress) {
  const std::string general = fmt::format("in_situ.{}", stress);
  std::vector<std::string> without;
  const std::size_t count = reading.scene.strata.layers.size();
  for (std::size_t k = 0; k < count; ++k) {
    if (const std::string path = fmt::format("strata.layers[{}].{}", k, stress); !reading.given(path))
      without.push_back(path);
  }
  if (reading.given(general) || without.size() == count) return;
  for (const std::string& path : without)
    reading.refuse(path, "{} is missing, as other layers have one. Give it, or {} for all that leave it out.", path,
                   general);
}

void build_strata(Reading& reading) {
  Scene& scene = reading.scene;
  auto& layers = scene.strata.layers;
  auto& interfaces = scene.strata.interfaces;
  const bool upwards = scene.strata.upwards();
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const std::string path = fmt::format("strata.layers[{}]", k);
    layers[k].rock = find_named(reading, scene.rocks, path + ".rock", "rock");
    if (k + 1 == layers.size() || reading.given(path + ".thickness_m")) continue;
    reading.refuse(path, "{}.thickness_m is missing. Only the last layer may leave it out.", path);
    reading.entries[path].sound = false;
  }
  check_layer_stresses(reading, upwards ? "horizontal_Pa" : "vertical_Pa");
  if (reading.usable("strata.layers", upwards ? "domain.height_m" : "domain.width_m") && reading.sound("strata.along"))
    place_layers(reading, scene.domain.extent_m(upwards ? 1 : 0));

  const std::size_t between = layers.empty() ? 0 : layers.size() - 1, named = interfaces.size();
  for (std::size_t k = 0; k < named; ++k) {
    const std::string path = fmt::format("strata.interfaces[{}]", k);
    const bool is_table = reading.given(path) && reading.entries[path].value->is_table();
    const bool by_key = is_table || reading.given(path + ".name");
    interfaces[k].law = find_named(reading, scene.laws, by_key ? path + ".name" : path, "interface");
  }
  if (reading.usable("strata.interfaces") && !layers.empty() && named != between) {
    reading.refuse("strata.interfaces", "strata.interfaces has {} {} for {} layers. Give one between each two: {}.",
                   named, named == 1 ? "name" : "names", layers.size(), between);
  }
  interfaces.resize(between);
  for (std::size_t k = 0; k < between; ++k) interfaces[k].at_m = layers[k].to_m;
}

// An end on the symmetry line is put onto it.
void place_path(Scene& scene) {
  if (!scene.fracture || scene.fracture->path_m.empty() || scene.domain.bottom != Edge::symmetry) return;
  auto& path_m = scene.fracture->path_m;
  for (auto* end : {&path_m.front(), &path_m.back()}) {
    if (std::abs((*end)[1]) <= 1e-9 * scene.domain.height_m) (*end)[1] = 0.0;
  }
}

// A rock or interface that nothing uses: a slip of the fingers where only a variant or --set names it, else worth a
// note, unless a run has left the variants out.
void check_used(Reading& reading) {
  for (const char* names : {"rock.NAME", "interface.NAME"}) {
    std::vector<std::string> in_scene;
    for (const auto& [path, given] : reading.entries) {
      if (given.where.rank == 0 && pattern_of(path) == names) in_scene.push_back(path.substr(path.find('.') + 1));
    }
    for (const auto& [path, given] : reading.entries) {
      if (pattern_of(path) != names || reading.used.contains(path)) continue;
      if (given.where.rank > 0) {
        reading.refuse(path, "there is no [{}] in the scene, and no layer uses it.{}", path,
                       did_you_mean(path.substr(path.find('.') + 1), in_scene));
      } else if (!reading.given("resolved_from")) {
        reading.notes.push_back({given.where, fmt::format("note: nothing uses [{}], neither {} nor a variant.", path,
                                                          names[0] == 'r' ? "strata.layers" : "strata.interfaces")});
      }
    }
  }
}

}  // namespace

void build_scene(Reading& reading) {
  apply(reading);
  choose_inlet(reading);
  check_required(reading);
  build_strata(reading);
  place_path(reading.scene);
  check_used(reading);
}

}  // namespace strata
