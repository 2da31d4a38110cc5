#include <algorithm>
#include <cmath>
#include <set>

#include "scene/entries.hpp"

namespace strata {
namespace {

constexpr std::string_view rocks = "rock.", laws = "interface.";  // the tables that have names

// The second segment of every path that starts with `table`, in alphabetical order; with rank 0 of the scene itself.
std::vector<std::string> names_of(const Entries& entries, std::string_view table, int most_rank = 2) {
  std::set<std::string> names;
  for (const auto& [path, given] : entries.at) {
    if (path.starts_with(table) && given.where.rank <= most_rank) names.insert(split(path, ".")[1]);
  }
  return {names.begin(), names.end()};
}

bool has_fracture(const Entries& entries) {
  const auto first = entries.at.lower_bound("fracture.");
  return entries.given("fracture") || (first != entries.at.end() && first->first.starts_with("fracture."));
}

// The value of a list that is sound, or nullptr.
const toml::array* list_of(const Entries& entries, std::string_view path) {
  return entries.usable(path) ? entries.at.find(path)->second.value->as_array() : nullptr;
}

// Whether a key is one of the law in force. One of another law is a fault, unless the law was replaced by a variant or
// --set that lies above the key.
bool is_of_law(const Entries& entries, const std::string& path, const Given& given, Faults& faults) {
  const std::string law_path = path.substr(0, path.rfind('.')) + ".law";
  const bool known = entries.usable(law_path);
  const std::string in_force = known ? entries.at.find(law_path)->second.value->as_string()->get() : "";
  if (given.key->is_of(in_force)) return true;
  if (known && given.where.rank >= entries.at.find(law_path)->second.where.rank) {
    faults.add(given.where, "{} belongs to law = \"{}\", but {} = \"{}\". Remove it, or change the law.", path,
               given.key->law, law_path, in_force);
  }
  return false;
}

// Writes each sound value to its member of the scene.
void apply(const Entries& entries, Scene& scene, Faults& faults) {
  if (has_fracture(entries)) scene.fracture.emplace();
  for (const std::string& name : names_of(entries, rocks)) scene.rocks.emplace_back().name = name;
  scene.laws.emplace_back();
  for (const std::string& name : names_of(entries, laws)) scene.laws.emplace_back().name = name;
  for (const auto& [path, given] : entries.at) {
    if (given.key == nullptr) continue;
    const bool of_law = path.starts_with(laws), of_rock = path.starts_with(rocks);
    if (of_law && !is_of_law(entries, path, given, faults)) continue;
    const std::string name = of_law || of_rock ? split(path, ".")[1] : "";
    const auto index_in = [&](const auto& list) {
      return static_cast<std::size_t>(std::ranges::find_if(list, [&](auto& one) { return one.name == name; }) -
                                      list.begin());
    };
    apply_value(given, of_law ? index_in(scene.laws) : of_rock ? index_in(scene.rocks) : 0, scene);
  }
}

// The inlet's pressure or its rate: where both are given, the one that a variant or --set lays above the other.
void choose_inlet(const Entries& entries, Scene& scene, Faults& faults) {
  const auto rank_of = [&](std::string_view path) { return entries.given(path) ? where_is(entries, path).rank : -1; };
  const int rate = rank_of("fluid.inlet.rate_m2_s"), start = rank_of("fluid.inlet.start_Pa");
  const int pressure = std::max(start, rank_of("fluid.inlet.rate_Pa_s"));
  if (rate < 0 || pressure < 0) return;
  if (rate > pressure) {
    scene.fluid.start_Pa = scene.fluid.rate_Pa_s = 0.0;
  } else if (rate < pressure) {
    scene.fluid.rate_m2_s.reset();
  } else {
    faults.add(where_is(entries, "fluid.inlet.rate_m2_s"),
               "fluid.inlet has both rate_m2_s and {}. Prescribe the rate, inlet = {{rate_m2_s}}, or the pressure, "
               "inlet = {{start_Pa, rate_Pa_s}}: a fracture fed at a rate starts at its closing stress.",
               start == pressure ? "start_Pa" : "rate_Pa_s");
  }
}

// Keys that must be there: those of every scene, of every rock and interface named, and of a fracture if there is one.
void check_required(const Entries& entries, Faults& faults) {
  const auto require_one = [&](const std::vector<std::string>& paths, const std::string& where, auto&&... text) {
    const auto is_given = [&](const std::string& path) { return entries.given(path); };
    if (std::ranges::none_of(paths, is_given)) faults.add(where_is(entries, where), text...);
  };
  const auto require = [&](const std::string& path) {
    require_one({path}, path, fmt::format("{} is missing. Give it in [{}].", path, path.substr(0, path.rfind('.'))));
  };
  const bool fracture = has_fracture(entries);
  for (const Key& key : scene_keys()) {
    if (!key.required || key.in_list() || (key.path.starts_with("fracture.") && !fracture)) continue;
    const std::vector<std::string> segments = split(key.path, ".");
    if (segments[1] != "NAME") {
      require(std::string(key.path));
    } else {
      for (const std::string& name : names_of(entries, segments[0] + '.'))
        require(segments[0] + '.' + name + '.' + segments[2]);
    }
  }
  if (names_of(entries, rocks).empty()) require_one({}, "rock", "there is no rock. Give a table [rock.NAME].");
  if (fracture) {
    require_one(
        {"fluid.inlet.start_Pa", "fluid.inlet.rate_Pa_s", "fluid.inlet.rate_m2_s"}, "fluid.inlet",
        "fluid.inlet is missing; a fracture needs it. Give inlet = {start_Pa = 2e6, rate_Pa_s = 0.35e6} in [fluid].");
  }
  require_one({"stop.tip_y_m", "stop.inlet_Pa", "stop.time_s"}, "stop",
              "nothing ends the run. Give tip_y_m, inlet_Pa or time_s in [stop].");
}

// Index of the element called `name`, or a fault that lists the names there are.
template <class Element>
std::size_t index_of(const std::vector<Element>& elements, const std::string& name, const std::string& path,
                     const char* table, const Where& where, Faults& faults) {
  const auto found = std::ranges::find(elements, name, &Element::name);
  if (found != elements.end()) return static_cast<std::size_t>(found - elements.begin());
  std::vector<std::string> names;
  for (const Element& element : elements) names.push_back(element.name);
  faults.add(where, "{} = \"{}\": there is no [{}.{}]. There is {}.{}", path, name, table, name,
             names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")), did_you_mean(name, names));
  return 0;
}

// Onto a grid line or the middle of a cell where it is one but for round-off.
double snapped(double at_m, double cell_m) {
  if (cell_m <= 0.0) return at_m;
  const double nearest = std::round(2.0 * at_m / cell_m) * cell_m / 2.0;
  return std::abs(nearest - at_m) < 1e-6 * cell_m ? nearest : at_m;
}

// Heights (or widths) of the layers, the last one what the others leave.
void place_layers(const toml::array& given, double extent_m, const Entries& entries, Scene& scene, Faults& faults) {
  const double tolerance = 1e-9 * extent_m;  // round-off of a sum of thicknesses
  double from = 0.0;
  for (std::size_t k = 0; k < given.size(); ++k) {
    const toml::node* thickness = given[k].as_table()->get("thickness_m");
    const bool is_last = k + 1 == given.size();
    const Where& where = where_is(entries, fmt::format("strata.layers[{}]", k));
    const double to = thickness != nullptr ? from + as_number(*thickness) : extent_m;
    if (is_last && from >= extent_m - tolerance) {
      faults.add(where, "strata.layers[{}] has no room: the layers before it fill {} of {} m.", k, from, extent_m);
    } else if (is_last && std::abs(to - extent_m) > tolerance) {
      faults.add(where,
                 "strata.layers add up to {} m, but the block has {} m. Make the last thickness_m {}, or leave it out.",
                 to, extent_m, extent_m - from);
    }
    scene.strata.layers[k].from_m = from;
    from = scene.strata.layers[k].to_m = is_last ? extent_m : snapped(to, scene.numerics.cell_m);
  }
}

void build_layers(const Entries& entries, Scene& scene, Faults& faults) {
  const toml::array* layers = list_of(entries, "strata.layers");
  if (layers == nullptr) return;
  for (std::size_t k = 0; k < layers->size(); ++k) {
    const std::string path = fmt::format("strata.layers[{}]", k);
    const std::string name = (*layers)[k].as_table()->get("rock")->as_string()->get();
    const std::size_t rock = index_of(scene.rocks, name, path + ".rock", "rock", where_is(entries, path), faults);
    scene.strata.layers.push_back({rock});
  }
  const bool upwards = scene.strata.along == Strata::Along::y;
  if (!entries.usable(upwards ? "domain.height_m" : "domain.width_m") || !entries.sound("strata.along")) return;
  place_layers(*layers, upwards ? scene.domain.height_m : scene.domain.width_m, entries, scene, faults);
}

void build_interfaces(const Entries& entries, Scene& scene, Faults& faults) {
  const std::size_t layers = scene.strata.layers.size(), expected = layers == 0 ? 0 : layers - 1;
  for (std::size_t k = 0; k < expected; ++k) scene.strata.interfaces.push_back({0, scene.strata.layers[k].to_m});
  const toml::array* names = list_of(entries, "strata.interfaces");
  if (names == nullptr) return;
  for (std::size_t k = 0; k < names->size(); ++k) {
    const std::string path = fmt::format("strata.interfaces[{}]", k), name = (*names)[k].as_string()->get();
    const std::size_t law = index_of(scene.laws, name, path, "interface", where_is(entries, path), faults);
    if (k < expected) scene.strata.interfaces[k].law = law;
  }
  if (names->size() != expected && layers > 0) {
    faults.add(where_is(entries, "strata.interfaces"),
               "strata.interfaces has {} {} for {} layers. Give one between each two: {}.", names->size(),
               names->size() == 1 ? "name" : "names", layers, expected);
  }
}

// An end on the symmetry line is put onto it.
void place_path(Scene& scene) {
  if (!scene.fracture || scene.fracture->path_m.empty() || scene.domain.bottom != Edge::symmetry) return;
  auto& path_m = scene.fracture->path_m;
  for (auto* end : {&path_m.front(), &path_m.back()}) {
    if (std::abs((*end)[1]) <= 1e-9 * scene.domain.height_m) (*end)[1] = 0.0;
  }
}

// A rock or interface that only a variant or --set names, and that nothing uses, is a slip of the fingers.
void check_new_names(const Entries& entries, const Scene& scene, Faults& faults) {
  std::set<std::string> used;
  for (const Layer& layer : scene.strata.layers) {
    if (!scene.rocks.empty()) used.insert("rock." + scene.rocks[layer.rock].name);
  }
  for (const InterfacePlace& place : scene.strata.interfaces) used.insert("interface." + scene.laws[place.law].name);
  for (const std::string_view kind : {rocks, laws}) {
    const std::vector<std::string> in_scene = names_of(entries, kind, 0);
    for (const auto& [path, given] : entries.at) {
      if (!path.starts_with(kind) || given.key == nullptr || given.where.rank == 0) continue;
      const std::string table = path.substr(0, path.rfind('.')), name = table.substr(kind.size());
      if (used.contains(table) || std::ranges::find(in_scene, name) != in_scene.end()) continue;
      faults.add(given.where, "{}: there is no [{}] in the scene, and no layer uses it.{}", path, table,
                 did_you_mean(name, in_scene));
    }
  }
}

}  // namespace

Scene build_scene(const Entries& entries, Faults& faults) {
  Scene scene;
  apply(entries, scene, faults);
  choose_inlet(entries, scene, faults);
  check_required(entries, faults);
  build_layers(entries, scene, faults);
  build_interfaces(entries, scene, faults);
  place_path(scene);
  check_new_names(entries, scene, faults);
  return scene;
}

}  // namespace strata
