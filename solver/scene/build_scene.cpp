#include "scene/build_scene.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "scene/spelling.hpp"

namespace strata {
namespace {

double as_number(const toml::node& node) {
  return node.is_integer() ? static_cast<double>(node.as_integer()->get()) : node.as_floating_point()->get();
}

// A number stands for the formula that is it.
std::string formula_text(const toml::node& node) {
  return node.is_string() ? node.as_string()->get() : number_text(as_number(node));
}

// The second segment of every path that starts with `table`: the names of rocks or interfaces, in alphabetical order.
std::vector<std::string> names_of(const Entries& entries, std::string_view table) {
  std::set<std::string> names;
  const auto take = [&](std::string_view path) {
    if (!path.starts_with(table) || path.size() <= table.size() || path[table.size()] != '.') return;
    path.remove_prefix(table.size() + 1);
    names.emplace(path.substr(0, path.find('.')));
  };
  for (const auto& [path, given] : entries.values) take(path);
  for (const auto& [path, where] : entries.tables) take(path);
  return {names.begin(), names.end()};
}

bool has_table(const Entries& entries, const std::string& table) {
  const auto first = entries.values.lower_bound(table + '.');
  return entries.tables.contains(table) || (first != entries.values.end() && first->first.starts_with(table + '.'));
}

// Puts one value where its key leads to; index: of the rock or law.
void apply(const Given& given, std::size_t index, Scene& scene) {
  struct Apply {
    const Given& given;
    std::size_t index;
    Scene& scene;
    void operator()(std::monostate) const {}
    void operator()(NumberPlace at) const { at(scene, index) = as_number(*given.value); }
    void operator()(OptionalPlace at) const { at(scene, index) = as_number(*given.value); }
    void operator()(IntegerPlace at) const { at(scene, index) = static_cast<int>(given.value->as_integer()->get()); }
    void operator()(TextPlace at) const { at(scene, index) = given.value->as_string()->get(); }
    void operator()(FormulasPlace at) const {
      const toml::array& both = *given.value->as_array();
      at(scene, index) = Formulas{formula_text(both[0]), formula_text(both[1])};
    }
    void operator()(const WordPlace& at) const {
      const auto word = std::ranges::find(given.key->words, given.value->as_string()->get(), &Word::text);
      at.set(scene, index, word->value);
    }
  };
  if (given.sound) std::visit(Apply{given, index, scene}, given.key->place);
}

std::string full_path(const Key& key, const std::string& name) {
  std::string path = key.path;
  const std::size_t at = path.find("NAME");
  if (at != std::string::npos) path.replace(at, 4, name);
  return path;
}

void apply_plain_keys(const Entries& entries, Scene& scene) {
  for (const auto& [path, given] : entries.values) {
    if (given.key->path.find("NAME") == std::string::npos) apply(given, 0, scene);
  }
}

void build_rocks(const Entries& entries, Scene& scene) {
  for (const std::string& name : names_of(entries, "rock")) {
    scene.rocks.emplace_back().name = name;
    for (const Key& key : scene_keys()) {
      if (!key.path.starts_with("rock.")) continue;
      const auto given = entries.values.find(full_path(key, name));
      if (given != entries.values.end()) apply(given->second, scene.rocks.size() - 1, scene);
    }
  }
}

// The keys of one interface. A key of another law than the one in force is a fault, unless the law was replaced by a
// variant or --set that lies above the key.
void build_law(const Entries& entries, const std::string& name, std::size_t index, Scene& scene, Faults& faults) {
  const auto law = entries.values.find("interface." + name + ".law");
  const bool known = law != entries.values.end() && law->second.sound;
  const std::string in_force = known ? law->second.value->as_string()->get() : "";
  for (const Key& key : scene_keys()) {
    if (!key.path.starts_with("interface.")) continue;
    const auto given = entries.values.find(full_path(key, name));
    if (given == entries.values.end()) continue;
    if (key.is_of(in_force)) {
      apply(given->second, index, scene);
    } else if (known && given->second.where.rank >= law->second.where.rank) {
      faults.add(given->second.where,
                 fmt::format("{} belongs to law = \"{}\", but interface.{}.law = \"{}\". Remove it, or "
                             "change the law.",
                             given->first, key.law, name, in_force));
    }
  }
}

void build_laws(const Entries& entries, Scene& scene, Faults& faults) {
  scene.laws.emplace_back();
  for (const std::string& name : names_of(entries, "interface")) {
    scene.laws.emplace_back().name = name;
    build_law(entries, name, scene.laws.size() - 1, scene, faults);
  }
}

// Rank of what was given for a key, -1 where nothing was.
int rank_of(const Positions& positions, std::string_view path) {
  const auto given = positions.at.find(path);
  return given == positions.at.end() ? -1 : given->second.rank;
}

// The inlet's pressure or its rate: where both are given, the one that a variant or --set lays above the other.
void choose_inlet(const Positions& positions, Scene& scene, Faults& faults) {
  const int rate = rank_of(positions, "fluid.inlet.rate_m2_s");
  const int start = rank_of(positions, "fluid.inlet.start_Pa"), rise = rank_of(positions, "fluid.inlet.rate_Pa_s");
  const int pressure = std::max(start, rise);
  if (rate < 0 || pressure < 0) return;
  if (rate > pressure) {
    scene.fluid.start_Pa = scene.fluid.rate_Pa_s = 0.0;
  } else if (rate < pressure) {
    scene.fluid.rate_m2_s.reset();
  } else {
    faults.add(where_is(positions, "fluid.inlet.rate_m2_s"),
               fmt::format("fluid.inlet has both rate_m2_s and {}. Prescribe the rate, inlet = {{rate_m2_s}}, or the "
                           "pressure, inlet = {{start_Pa, rate_Pa_s}}: a fracture fed at a rate starts at its closing "
                           "stress.",
                           start == pressure ? "start_Pa" : "rate_Pa_s"));
  }
}

// Keys that must be there: those of every scene, of every rock and interface named, and of a fracture if there is one.
void check_required(const Entries& entries, const Positions& positions, Faults& faults) {
  const auto require = [&](const std::string& path) {
    if (positions.given(path)) return;
    const std::string table = path.substr(0, path.rfind('.'));
    faults.add(where_is(positions, path), fmt::format("{} is missing. Give it in [{}].", path, table));
  };
  const bool has_fracture = has_table(entries, "fracture");
  for (const Key& key : scene_keys()) {
    if (!key.required || key.path.find('[') != std::string::npos) continue;
    if (key.path.starts_with("fracture.") && !has_fracture) continue;
    if (key.path.find("NAME") == std::string::npos) {
      require(key.path);
    } else {
      const std::string table = key.path.substr(0, key.path.find('.'));
      for (const std::string& name : names_of(entries, table)) require(full_path(key, name));
    }
  }
  if (names_of(entries, "rock").empty())
    faults.add(where_is(positions, "rock"), "there is no rock. Give a table [rock.NAME].");
  if (has_fracture && !positions.given("fluid.inlet.start_Pa") && !positions.given("fluid.inlet.rate_Pa_s") &&
      !positions.given("fluid.inlet.rate_m2_s")) {
    faults.add(
        where_is(positions, "fluid.inlet"),
        "fluid.inlet is missing; a fracture needs it. Give inlet = {start_Pa = 2e6, rate_Pa_s = 0.35e6} in [fluid].");
  }
  if (!positions.given("stop.tip_y_m") && !positions.given("stop.inlet_Pa") && !positions.given("stop.time_s")) {
    faults.add(where_is(positions, "stop"), "nothing ends the run. Give tip_y_m, inlet_Pa or time_s in [stop].");
  }
}

// Index of the element called `name`, or a fault that lists the names there are.
template <class Element>
std::size_t index_of(const std::vector<Element>& elements, const std::string& name, const std::string& path,
                     const std::string& table, const Where& where, Faults& faults) {
  const auto found = std::ranges::find(elements, name, &Element::name);
  if (found != elements.end()) return static_cast<std::size_t>(found - elements.begin());
  std::vector<std::string> names;
  for (const Element& element : elements) names.push_back(element.name);
  faults.add(where, fmt::format("{} = \"{}\": there is no [{}.{}]. There is {}.{}", path, name, table, name,
                                names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")),
                                did_you_mean(name, names)));
  return 0;
}

// Onto a grid line or the middle of a cell where it is one but for round-off.
double snapped(double at_m, double cell_m) {
  const double nearest = std::round(2.0 * at_m / cell_m) * cell_m / 2.0;
  return std::abs(nearest - at_m) < 1e-6 * cell_m ? nearest : at_m;
}

// Heights (or widths) of the layers, the last one what the others leave.
void place_layers(const toml::array& given, double extent_m, double cell_m, const Positions& positions, Scene& scene,
                  Faults& faults) {
  const double tolerance = 1e-9 * extent_m;  // round-off of a sum of thicknesses
  double from = 0.0;
  for (std::size_t k = 0; k < given.size(); ++k) {
    const toml::node* thickness = given[k].as_table()->get("thickness_m");
    const bool is_last = k + 1 == given.size();
    const Where where = where_is(positions, fmt::format("strata.layers[{}]", k));
    double to = thickness != nullptr ? from + as_number(*thickness) : extent_m;
    if (is_last && from >= extent_m - tolerance) {
      faults.add(where, fmt::format("strata.layers[{}] has no room: the layers before it fill {} of {} m.", k,
                                    number_text(from), number_text(extent_m)));
    } else if (is_last && std::abs(to - extent_m) > tolerance) {
      faults.add(
          where,
          fmt::format("strata.layers add up to {} m, but the block has {} m. Make the last thickness_m {}, or leave "
                      "it out.",
                      number_text(to), number_text(extent_m), number_text(extent_m - from)));
    }
    to = is_last ? extent_m : (cell_m > 0.0 ? snapped(to, cell_m) : to);
    scene.strata.layers[k].from_m = from;
    scene.strata.layers[k].to_m = to;
    from = to;
  }
}

void build_layers(const Entries& entries, const Positions& positions, Scene& scene, Faults& faults) {
  const auto given = entries.values.find("strata.layers");
  if (given == entries.values.end() || !given->second.sound) return;
  const toml::array& layers = *given->second.value->as_array();
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const std::string name = layers[k].as_table()->get("rock")->as_string()->get();
    const std::string path = fmt::format("strata.layers[{}]", k);
    Layer layer;
    layer.rock = index_of(scene.rocks, name, path + ".rock", "rock", where_is(positions, path), faults);
    scene.strata.layers.push_back(layer);
  }
  const bool upwards = scene.strata.along == Strata::Along::y;
  const std::string extent = upwards ? "domain.height_m" : "domain.width_m";
  if (!positions.given(extent) || !positions.sound(extent) || !positions.sound("strata.along")) return;
  const double extent_m = upwards ? scene.domain.height_m : scene.domain.width_m;
  place_layers(layers, extent_m, scene.numerics.cell_m, positions, scene, faults);
}

void build_interfaces(const Entries& entries, const Positions& positions, Scene& scene, Faults& faults) {
  const std::size_t expected = scene.strata.layers.empty() ? 0 : scene.strata.layers.size() - 1;
  scene.strata.interfaces.resize(expected);
  for (std::size_t k = 0; k < expected; ++k) scene.strata.interfaces[k].at_m = scene.strata.layers[k].to_m;
  const auto given = entries.values.find("strata.interfaces");
  if (given == entries.values.end() || !given->second.sound) return;
  const toml::array& names = *given->second.value->as_array();
  for (std::size_t k = 0; k < names.size(); ++k) {
    const std::string path = fmt::format("strata.interfaces[{}]", k);
    const std::string name = names[k].as_string()->get();
    const std::size_t law = index_of(scene.laws, name, path, "interface", where_is(positions, path), faults);
    if (k < expected) scene.strata.interfaces[k].law = law;
  }
  if (names.size() != expected && !scene.strata.layers.empty()) {
    faults.add(given->second.where,
               fmt::format("strata.interfaces has {} {} for {} layers. Give one between each two: {}.", names.size(),
                           names.size() == 1 ? "name" : "names", scene.strata.layers.size(), expected));
  }
}

void build_path(const Entries& entries, Scene& scene) {
  const auto given = entries.values.find("fracture.path_m");
  if (given == entries.values.end() || !given->second.sound) return;
  auto& path_m = scene.fracture->path_m;
  for (const toml::node& node : *given->second.value->as_array()) {
    const toml::array& point = *node.as_array();
    path_m.push_back({as_number(point[0]), as_number(point[1])});
  }
  if (scene.domain.bottom != Edge::symmetry) return;
  const double tolerance = 1e-9 * scene.domain.height_m;
  for (auto* end : {&path_m.front(), &path_m.back()}) {
    if (std::abs((*end)[1]) <= tolerance) (*end)[1] = 0.0;
  }
}

// A rock or interface that only a variant or --set names, and that nothing uses, is a slip of the fingers.
void check_new_names(const Entries& entries, const Scene& scene, Faults& faults) {
  const auto check = [&](const std::string& path, const Given& given, bool used,
                         const std::vector<std::string>& others) {
    if (given.where.rank == 0 || used) return;
    const std::string table = path.substr(0, path.rfind('.'));
    const std::string name = table.substr(table.find('.') + 1);
    faults.add(given.where, fmt::format("{}: there is no [{}] in the scene, and no layer uses it.{}", path, table,
                                        did_you_mean(name, others)));
  };
  for (const bool rock : {true, false}) {
    const std::string table = rock ? "rock" : "interface";
    std::set<std::string> in_scene;
    for (const auto& [path, where] : entries.tables) {
      if (where.rank == 0 && path.starts_with(table + '.')) in_scene.insert(path.substr(table.size() + 1));
    }
    const std::vector<std::string> others(in_scene.begin(), in_scene.end());
    for (const auto& [path, given] : entries.values) {
      if (!path.starts_with(table + '.')) continue;
      const std::string name = path.substr(table.size() + 1, path.rfind('.') - table.size() - 1);
      bool used = in_scene.contains(name);
      for (const Layer& layer : scene.strata.layers) used = used || (rock && scene.rocks[layer.rock].name == name);
      for (const InterfacePlace& i : scene.strata.interfaces) used = used || (!rock && scene.laws[i.law].name == name);
      check(path, given, used, others);
    }
  }
}

}  // namespace

void start_at_symmetry_line(Scene& scene) {
  if (!scene.fracture || scene.domain.bottom != Edge::symmetry) return;
  auto& path_m = scene.fracture->path_m;
  if (path_m.back()[1] == 0.0 && path_m.front()[1] != 0.0) std::ranges::reverse(path_m);
}

Positions positions_of(const Entries& entries, const Where& start) {
  Positions positions;
  positions.start = start;
  for (const auto& [path, where] : entries.tables) positions.at.emplace(path, where);
  for (const auto& [path, given] : entries.values) {
    positions.at.insert_or_assign(path, given.where);
    if (!given.sound) positions.unsound.insert(path);
    const toml::array* list = given.value->as_array();
    for (std::size_t k = 0; list != nullptr && k < list->size(); ++k) {
      positions.at.emplace(fmt::format("{}[{}]", path, k), where_of(given.origin, (*list)[k].source()));
    }
  }
  return positions;
}

Scene build_scene(const Entries& entries, const Positions& positions, Faults& faults) {
  Scene scene;
  if (has_table(entries, "fracture")) scene.fracture.emplace();
  apply_plain_keys(entries, scene);
  choose_inlet(positions, scene, faults);
  build_rocks(entries, scene);
  build_laws(entries, scene, faults);
  check_required(entries, positions, faults);
  build_layers(entries, positions, scene, faults);
  build_interfaces(entries, positions, scene, faults);
  if (scene.fracture) build_path(entries, scene);
  check_new_names(entries, scene, faults);
  return scene;
}

}  // namespace strata
