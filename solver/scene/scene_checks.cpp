// Whether the parts of a scene fit each other.
#include <algorithm>
#include <cmath>
#include <limits>

#include <fmt/ranges.h>

#include "scene/derived.hpp"
#include "scene/in_situ.hpp"
#include "scene/reading.hpp"

namespace strata {
namespace {

constexpr double round_off = 1e-6;  // of a cell: lengths typed with as few digits still fit

bool is_whole(double value) {
  return std::abs(value - std::round(value)) < round_off;
}

// Whether the cells divide the block.
bool check_cells(Reading& reading) {
  const double width_m = reading.scene.domain.width_m, height_m = reading.scene.domain.height_m;
  const double cell_m = reading.scene.numerics.cell_m, columns = width_m / cell_m, rows = height_m / cell_m;
  if (is_whole(columns) && is_whole(rows) && columns > 0.5 && rows > 0.5) return true;
  const auto fit = [&](double n) {
    return n >= 1.0 && height_m / width_m * n > 0.5 && is_whole(height_m / width_m * n);
  };
  constexpr int longest_search = 100000;
  std::vector<double> sizes;
  for (const double step : {1.0, -1.0}) {
    double n = step > 0.0 ? std::max(1.0, std::ceil(columns)) : std::floor(columns);
    for (int k = 0; k < longest_search && n >= 1.0 && !fit(n); ++k) n += step;
    if (fit(n)) sizes.push_back(width_m / n);
  }
  reading.refuse_if(true, "numerics.cell_m", "does not divide the block of {} m x {} m into whole cells. {}", width_m,
                    height_m,
                    sizes.empty() ? "Give width and height a common divisor."
                                  : fmt::format("The nearest sizes that do: {}.", fmt::join(sizes, " and ")));
  return false;
}

// Whether a place at mid-cell is taken: with 3 x 3 particles a cell one row of them lies there.
bool on_particles(const Scene& scene, double at_m) {
  return scene.numerics.particles_per_cell % 2 == 1 && is_whole(at_m / scene.numerics.cell_m - 0.5);
}

void check_interfaces(Reading& reading) {
  const Strata& strata = reading.scene.strata;
  const double cell_m = reading.scene.numerics.cell_m, extent_m = strata.layers.back().to_m;
  for (std::size_t k = 0; k < strata.interfaces.size(); ++k) {
    const double at_m = strata.interfaces[k].at_m, halves = 2.0 * at_m / cell_m;
    if (at_m >= extent_m) return;  // layers that do not fit are reported as such
    const std::string layer = fmt::format("strata.layers[{}]", k);
    const std::string place = fmt::format("{} ends at {} = {} m", layer, word_of(strata.along), at_m);
    if (!is_whole(at_m / cell_m) && !is_whole(at_m / cell_m - 0.5)) {
      const double nearest = std::clamp(std::round(halves), 1.0, std::round(2.0 * extent_m / cell_m) - 1.0);
      reading.refuse(
          layer,
          "{}, neither on a grid line nor at mid-cell of cells of {} m. The nearest place for the interface: {} m.",
          place, cell_m, nearest * cell_m / 2.0);
    } else if (on_particles(reading.scene, at_m)) {
      reading.refuse(layer,
                     "{}, where a row of 3 x 3 particles a cell lies. Use particles_per_cell = 4 or 16, or put the "
                     "interface on a grid line.",
                     place);
    }
  }
}

// Where interfaces that end do so.
void check_ends(Reading& reading) {
  const Scene& scene = reading.scene;
  const double h = scene.numerics.cell_m;
  const Stretch rock = scene.along_interfaces();
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    const Stretch held = scene.held_by(scene.strata.interfaces[k]);
    const double from = held.from, to = held.to;
    const std::string path = fmt::format("strata.interfaces[{}].", k);
    for (const auto& [key, end] : {std::pair{path + "from_m", from}, std::pair{path + "to_m", to}}) {
      reading.refuse_if(end < rock.from || end > rock.to, key, "is outside the rock, from {} to {} m.", rock.from + 0.0,
                        rock.to);
      reading.refuse_if(!is_whole(end / h), key, "is not on a grid line of cells of {} m. The nearest: {} m.", h,
                        std::round(end / h) * h);
    }
    reading.refuse_if(to - from < 3.99 * h, reading.given(path + "to_m") ? path + "to_m" : path + "from_m",
                      "leaves the interface {} m, less than 4 cells. Let it be longer, or use smaller cells.",
                      to - from);
  }
}

// How y is counted, for those who count depths.
std::string upwards(double height_m) {
  return fmt::format("y is counted upwards from the block's lower edge: a point d below its top has y = {} - d.",
                     height_m);
}

// What is wrong with the place of a point of the path; empty where nothing is.
std::string fault_of_point(const Scene& scene, const Point& point, bool is_end) {
  const auto [x, y] = point;
  const double width_m = scene.domain.width_m, height_m = scene.domain.height_m;
  const bool in_y = y < 0.0 || y > height_m;
  if (x < 0.0 || x > width_m || in_y) {
    return fmt::format("outside the block of {} m x {} m. {}", width_m, height_m,
                       in_y ? upwards(height_m) : "x is counted from the block's left edge.");
  }
  if (x <= 0.0 || x >= width_m || y >= height_m)
    return "on an edge. A fracture may end only on the symmetry line or inside the block.";
  if (y <= 0.0 && scene.domain.bottom != Edge::symmetry)
    return "on the bottom, which is no symmetry line. Use bottom = \"symmetry\", or end inside the block.";
  return y <= 0.0 && !is_end ? "on the symmetry line, but only an end may be there." : "";
}

// A straight piece of fracture along an axis may not lie on particles, nor on an interface that has a law.
void check_lie(Reading& reading) {
  const Scene& scene = reading.scene;
  const auto& path_m = scene.fracture->path_m;
  const double tolerance_m = round_off * scene.numerics.cell_m;
  const std::size_t across = scene.strata.upwards() ? 1 : 0;
  for (std::size_t k = 0; k + 1 < path_m.size(); ++k) {
    for (const std::size_t axis : {0U, 1U}) {
      const double at_m = path_m[k][axis];
      if (std::abs(path_m[k + 1][axis] - at_m) > tolerance_m) continue;
      const std::string text = fmt::format("fracture.path_m: the segment from {} lies", path_m[k]);
      if (on_particles(scene, at_m)) {
        reading.refuse("fracture.path_m",
                       "{} at mid-cell, where a row of 3 x 3 particles a cell lies. Use particles_per_cell = 4 or 16.",
                       text);
      }
      for (const InterfacePlace& place : scene.strata.interfaces) {
        if (axis != across || !scene.has_law(place) || std::abs(place.at_m - at_m) > tolerance_m) continue;
        reading.refuse("fracture.path_m",
                       "{} on the interface \"{}\". Make that interface perfect, or move the fracture.", text,
                       scene.laws[place.law].name);
      }
    }
  }
}

void check_fracture(Reading& reading, bool cells_sound) {
  if (!reading.scene.fracture || !reading.usable("fracture.path_m", "domain.width_m", "domain.height_m") ||
      !reading.sound("domain.bottom"))
    return;
  const auto& path_m = reading.scene.fracture->path_m;
  const Domain& domain = reading.scene.domain;
  const double tolerance_m = 1e-9 * std::max(domain.width_m, domain.height_m);
  bool distinct = true;
  for (std::size_t k = 0; k < path_m.size(); ++k) {
    const Point& before = path_m[k == 0 ? path_m.size() - 1 : k - 1];
    const bool repeated = k > 0 && std::hypot(path_m[k][0] - before[0], path_m[k][1] - before[1]) <= tolerance_m;
    distinct = distinct && !repeated;
    const std::string fault = repeated ? "repeated. Remove it: a segment has a length."
                                       : fault_of_point(reading.scene, path_m[k], k == 0 || k + 1 == path_m.size());
    if (!fault.empty())
      reading.refuse(fmt::format("fracture.path_m[{}]", k), "fracture.path_m: the point {} is {}", path_m[k], fault);
  }
  if (const auto contact = distinct ? self_contact(path_m, tolerance_m) : std::nullopt) {
    reading.refuse("fracture.path_m",
                   "fracture.path_m meets itself: the segments from {} and from {} cross, touch or double back.",
                   path_m[contact->first], path_m[contact->second]);
  }
  if (distinct && path_m.front()[1] == 0.0 && path_m.back()[1] == 0.0 && domain.bottom == Edge::symmetry) {
    reading.refuse("fracture.path_m",
                   "fracture.path_m has both ends on the symmetry line; one may be there. A fracture that cuts out a "
                   "piece of rock has no tip.");
  }
  if (cells_sound) check_lie(reading);
}

// Stops that have no meaning, or that the start has passed already.
void check_stop_values(Reading& reading) {
  const Scene& scene = reading.scene;
  for (const char* path : {"stop.tip_y_m", "stop.lower_tip_y_m", "stop.inlet_Pa"})
    reading.refuse_if(!scene.fracture, path, "cannot be reached: the scene has no [fracture]. Use stop.time_s.");
  if (!scene.fracture) return;
  const double height_m = scene.domain.height_m, tip_y_m = scene.stop.tip_y_m.value_or(0.0);
  reading.refuse_if(reading.usable("domain.height_m") && tip_y_m >= height_m, "stop.tip_y_m",
                    "is not below the top of the block at {} m. {}", height_m, upwards(height_m));
  if (reading.usable("fracture.path_m")) {
    const auto [low_m, tip_m] = std::minmax(scene.fracture->path_m.front()[1], scene.fracture->path_m.back()[1]);
    reading.refuse_if(tip_y_m <= tip_m, "stop.tip_y_m",
                      "ends the run before it starts: a tip is at y = {} m. Give more than that.", tip_m);
    const bool one_tip = scene.domain.bottom == Edge::symmetry && low_m == 0.0;
    reading.refuse_if(one_tip, "stop.lower_tip_y_m",
                      "is never reached: the fracture begins on the symmetry line and has no lower tip. Use "
                      "bottom = \"traction\" and a path inside the block, or leave it out.");
    reading.refuse_if(!one_tip && scene.stop.lower_tip_y_m >= low_m, "stop.lower_tip_y_m",
                      "ends the run before it starts: the lower tip is at y = {} m. Give less than that.", low_m);
  }
  const bool pressed = !scene.fluid.rate_m2_s && scene.fluid.table.empty() && reading.sound("fluid.inlet.start_Pa");
  reading.refuse_if(scene.fracture->growth == Fracture::Growth::none, "stop.lower_tip_y_m",
                    "is never reached: the fracture does not grow (fracture.growth = \"none\"). Leave it out.");
  reading.refuse_if(pressed && scene.fluid.start_Pa >= scene.stop.inlet_Pa, "stop.inlet_Pa",
                    "ends the run before it starts: fluid.inlet.start_Pa = {}. Give more than that.",
                    scene.fluid.start_Pa);
}

// Stops that are given beside or above time 0, at which the run ends with one equilibrium: a variant keeps what it does
// not replace.
void note_stops_of_one_state(Reading& reading) {
  if (reading.scene.stop.time_s != 0.0 || reading.given("resolved_from")) return;
  const int rank = reading.where("stop.time_s").rank;
  for (const char* path : {"stop.tip_y_m", "stop.lower_tip_y_m", "stop.inlet_Pa"}) {
    if (!reading.given(path) || reading.where(path).rank < rank) continue;
    reading.notes.push_back(
        {reading.where(path),
         fmt::format("note: {} is not reached: stop.time_s = 0 ends the run with one equilibrium at "
                     "the start pressure. Give another stop.time_s.",
                     path)});
  }
}

// Whether one of the stops given is sure to be reached: a fracture under a pressure that does not rise may stay; one
// that is fed at a rate grows, or takes ever more pressure where it may not.
void check_end(Reading& reading) {
  const bool by_inlet = reading.given("stop.inlet_Pa"), by_upper = reading.given("stop.tip_y_m");
  const bool by_tip = by_upper || reading.given("stop.lower_tip_y_m");
  if (!reading.scene.fracture || reading.given("stop.time_s") || (!by_inlet && !by_tip)) return;
  for (const char* path : {"fluid.inlet.rate_Pa_s", "fluid.inlet.rate_m2_s", "fracture.growth"})
    if (!reading.sound(path)) return;
  const bool fed = reading.scene.fluid.rate_m2_s.has_value();
  if (reading.given("fluid.inlet.table")) return;  // asks for stop.time_s itself
  if (!fed && !reading.given("fluid.inlet.start_Pa") && !reading.given("fluid.inlet.rate_Pa_s")) return;
  const double rate_Pa_s = reading.scene.fluid.rate_Pa_s;
  const bool grows = reading.scene.fracture->growth != Fracture::Growth::none;
  const bool rises = fed ? !grows : rate_Pa_s > 0.0;
  if ((by_inlet && rises) || (by_tip && grows && (fed || rises))) return;
  const char* stop = by_inlet ? "stop.inlet_Pa" : by_upper ? "stop.tip_y_m" : "stop.lower_tip_y_m";
  reading.refuse(stop, "the run could never end: {}. Give stop.time_s too.",
                 rises ? "the fracture does not grow (fracture.growth = \"none\")"
                 : fed ? "the pressure of a fracture fed at a rate falls as it grows"
                       : fmt::format("the inlet pressure does not rise (fluid.inlet.rate_Pa_s = {})", rate_Pa_s));
}

// What one of the two mechanics cannot do.
void check_mechanics(Reading& reading) {
  if (!reading.sound("numerics.mechanics")) return;
  const Scene& scene = reading.scene;
  const bool rests = scene.numerics.mechanics == Numerics::Mechanics::quasistatic, moves = !rests;
  const Fracture fracture = scene.fracture.value_or(Fracture());
  const char* without = "needs mechanics = \"quasistatic\", but mechanics = \"explicit\"";
  reading.refuse_if(moves && fracture.growth == Fracture::Growth::energy, "fracture.growth",
                    "compares equilibria and {}. Use growth = \"J\" or \"none\".", without);
  reading.refuse_if(moves && fracture.order == Fracture::Order::larger_margin, "fracture.order",
                    "asks what goes first at one load and {}, where either takes its time. Use order = \"interfaces\".",
                    without);
  reading.refuse_if(moves && scene.fluid.law == Fluid::Law::reynolds, "fluid.law",
                    "is solved together with the rock's equilibrium and {}. Use law = \"paper\" or \"uniform\".",
                    without);
  reading.refuse_if(moves && scene.stop.time_s == 0.0, "stop.time_s",
                    "asks for one equilibrium and {}. Give a time above 0, or use quasistatic.", without);
  reading.refuse_if(rests, "initial.velocity_m_s",
                    "moves the block at time 0, which needs inertia, but mechanics = \"quasistatic\". Use mechanics = "
                    "\"explicit\", or leave it out.");
  // uGIMP weights follow particles that move.
  reading.refuse_if(scene.numerics.shape == Numerics::Shape::gimp && scene.numerics.keeps_places(), "numerics.shape",
                    "is for moving points only, but {} leaves them in their reference place, where it is linear. Use "
                    "shape = \"bspline2\" or \"linear\".",
                    rests ? "mechanics = \"quasistatic\"" : "kinematics = \"total\"");
}

// An interface parts by its toughness or by strengths; a variant or --set may put the toughness above them.
void check_toughness(Reading& reading) {
  const bool moves =
      reading.sound("numerics.mechanics") && reading.scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics;
  for (const InterfaceLaw& law : reading.scene.laws) {
    const std::string table = "interface." + law.name + '.', toughness = table + "toughness_Pa_sqrt_m";
    if (!law.has_toughness()) continue;
    reading.refuse_if(moves, toughness,
                      "compares equilibria and needs mechanics = \"quasistatic\", but mechanics = \"explicit\". Give "
                      "shear_strength_Pa and tensile_strength_Pa instead.");
    for (const char* key : {"shear_strength_Pa", "tensile_strength_Pa", "failure_length_m"}) {
      if (!reading.given(table + key) || reading.where(table + key).rank < reading.where(toughness).rank) continue;
      reading.refuse_if(true, table + key,
                        "is for an interface that fails by its strength, but {} lets it part by energy. Give one or "
                        "the other.",
                        toughness);
    }
  }
}

// Cells far away and beyond the block.
void check_grading(Reading& reading) {
  if (!reading.usable("numerics.cell_m")) return;
  const double beyond = reading.scene.domain.beyond_m, cell = reading.scene.numerics.cell_m;
  const double far = reading.scene.numerics.far_cell_m.value_or(cell);
  reading.refuse_if(far < cell, "numerics.far_cell_m",
                    "is below numerics.cell_m = {}: cells grow away from the fracture. Give at least cell_m, or leave "
                    "it out.",
                    cell);
  const double least = 2.0 * std::max(cell, far);  // shorter, cells would shrink
  reading.refuse_if(beyond > 0.0 && beyond < least, "domain.beyond_m",
                    "is less than two of the cells at the block's edges. Give at least {}, or 0: the rock ends there.",
                    least);
  // The middle one of three stands on the border of two spans: at a loaded edge, which halves a span, its weights do
  // not integrate the derivative of a B-spline, and a uniform stress would not be in equilibrium.
  const bool grows = far > cell;
  reading.refuse_if(reading.scene.numerics.particles_per_cell == 9 && (grows || beyond > 0.0),
                    "numerics.particles_per_cell", "is for uniform grids, but {} = {} grades this one. Use 4 or 16.",
                    grows ? "numerics.far_cell_m" : "domain.beyond_m", grows ? far : beyond);
}

// Ends of the fine cells: on the far side of the initial fracture, and of a graded grid.
void check_fine_ends(Reading& reading) {
  if (!reading.scene.fracture) return;
  const Numerics& n = reading.scene.numerics;
  const std::pair<const char*, std::optional<double>> ends[] = {
      {"left", n.fine_left_m}, {"right", n.fine_right_m}, {"bottom", n.fine_bottom_m}, {"top", n.fine_top_m}};
  for (std::size_t k = 0; k < 4; ++k) {
    const std::string key = fmt::format("numerics.fine_{}_m", ends[k].first);
    reading.refuse_if(!reading.given("numerics.far_cell_m"), key,
                      "says where a graded grid is fine, but numerics.far_cell_m is missing: all cells are of cell_m. "
                      "Give it, or leave this one out.");
    if (!reading.usable("fracture.path_m")) continue;
    const auto [low, high] =
        std::ranges::minmax(reading.scene.fracture->path_m, {}, [&](const auto& x) { return x[k / 2]; });
    const bool is_least = k % 2 == 0;
    const double fracture = (is_least ? low : high)[k / 2], end = ends[k].second.value_or(fracture);
    reading.refuse_if(is_least ? end > fracture : end < fracture, key,
                      "lies within the initial fracture, which reaches to {}. Give at {} that.", fracture,
                      is_least ? "most" : "least");
  }
}

// The inlet's table: what its rows may be, and what goes with it.
void check_inlet_table(Reading& reading) {
  const char* key = "fluid.inlet.table";
  const auto& table = reading.scene.fluid.table;
  reading.refuse_if(!reading.given(key), "fluid.inlet.of", "says what a table holds, but there is no {}.", key);
  if (table.empty() || !reading.usable(key)) return;
  if (!reading.given("fluid.inlet.of"))
    reading.refuse(key, "{}: of is missing. Add of = \"rate_m2_s\" or of = \"pressure_Pa\".", key);
  if (table.front()[0] != 0.0) reading.refuse(key, "{} begins at {} s. Begin at time 0.", key, table.front()[0]);
  for (std::size_t k = 0; k < table.size(); ++k) {
    const auto& [time, value] = table[k];
    if (k > 0 && time <= table[k - 1][0]) {
      reading.refuse(key,
                     "{}[{}]: the time {} s is not after {} s of the row before. A jump takes two rows a moment apart.",
                     key, k, time, table[k - 1][0]);
    }
    if (value < 0.0) reading.refuse(key, "{}[{}]: the value {} is outside [0, inf).", key, k, value);
  }
  if (!reading.given("stop.time_s"))
    reading.refuse("stop", "a run with {} needs stop.time_s: the table's last value is held without end.", key);
}

// A floor may conduct so well that the pressure's own round-off moves a good part of what is fed: then the balance of
// flow and rock has no digits. In 0.25 m cells verification/analytic/kgd.toml is solved at half of the bound; at the
// bound and beyond it its steps fail or shrink.
void check_floor(Reading& reading) {
  const Fluid& fluid = reading.scene.fluid;
  if (!fluid.rate_m2_s || fluid.law != Fluid::Law::reynolds) return;
  if (!reading.sound("fluid.viscosity_Pa_s") || !reading.sound("fluid.inlet.table")) return;
  constexpr double share = 0.1;
  double fed = *fluid.rate_m2_s;
  for (const Point& row : fluid.table) fed = std::max(fed, row[1]);
  const double noise = std::numeric_limits<double>::epsilon() * largest_in_situ(reading.scene);  // Pa
  const double most = std::cbrt(share * fed * 12.0 * fluid.viscosity_Pa_s * reading.scene.numerics.cell_m / noise);
  reading.refuse_if(fed > 0.0 && fluid.minimum_opening_m > most, "fluid.minimum_opening_m",
                    "conducts so well that round-off of the pressure moves more than a tenth of what is fed. Give less "
                    "than {:.2g}; 0.1 mm is 1e-4.",
                    most);
}

void check_fluid(Reading& reading) {
  const Fluid& fluid = reading.scene.fluid;
  if (!reading.scene.fracture) return;
  check_inlet_table(reading);
  if (!reading.sound("fluid.law")) return;
  const bool conserves = fluid.law == Fluid::Law::reynolds;
  const char* why = "needs a law that conserves the fluid's mass, but fluid.law";
  for (const char* path : {"fluid.inlet.rate_m2_s", "fluid.inlet.table"}) {
    reading.refuse_if(fluid.rate_m2_s && !conserves, path,
                      "{} = \"{}\". Use law = \"reynolds\", or inlet = {{start_Pa, rate_Pa_s}}.", why,
                      word_of(fluid.law));
  }
  for (const Rock& rock : reading.scene.rocks) {
    reading.refuse_if(rock.leakoff_m_sqrt_s > 0.0 && !conserves, "rock." + rock.name + ".leakoff_m_sqrt_s",
                      "{} = \"{}\". Use law = \"reynolds\", or leave it out.", why, word_of(fluid.law));
  }
  reading.refuse_if(
      fluid.density_kg_m3 != 0.0 && fluid.law == Fluid::Law::paper, "fluid.density_kg_m3",
      "gives the fluid a weight, which the study's diffusion, fluid.law = \"paper\", does not have. Use law "
      "= \"reynolds\" or \"uniform\", or leave it out.");
  const bool pressed = reading.usable("fluid.inlet.start_Pa") && !fluid.rate_m2_s;
  reading.refuse_if(pressed && fluid.cavitation_Pa > fluid.start_Pa, "fluid.cavitation_Pa",
                    "is above fluid.inlet.start_Pa = {}, but no pressure may be below it. Lower it, or start higher.",
                    fluid.start_Pa);
}

// What a state holds at most: a bit for each surface, a byte for a particle's rock.
void check_numbers(Reading& reading) {
  constexpr std::size_t most_surfaces = 31, most_rocks = 255;
  const Scene& scene = reading.scene;
  std::size_t surfaces = scene.fracture ? 1 : 0;
  for (const InterfacePlace& place : scene.strata.interfaces) surfaces += scene.has_law(place) ? 1 : 0;
  if (surfaces > most_surfaces)
    reading.refuse("strata.interfaces",
                   "strata.interfaces: {} surfaces{} are more than {}. Make some interfaces perfect.", surfaces,
                   scene.fracture ? ", the fracture and all interfaces that are not perfect," : "", most_surfaces);
  if (scene.rocks.size() > most_rocks)
    reading.refuse("rock", "there are {} rocks, more than {}. Remove those that no layer uses, or let layers share.",
                   scene.rocks.size(), most_rocks);
}

}  // namespace

void check_scene(Reading& reading) {
  bool cells_sound = reading.usable("numerics.cell_m") && reading.sound("numerics.particles_per_cell");
  if (cells_sound && reading.usable("domain.width_m", "domain.height_m")) cells_sound = check_cells(reading);
  const char* extent = reading.scene.strata.upwards() ? "domain.height_m" : "domain.width_m";
  const bool layers_sound = reading.usable("strata.layers", extent) && reading.sound("strata.along");
  if (cells_sound && layers_sound) check_interfaces(reading);
  if (layers_sound && reading.usable("domain.width_m", "domain.height_m")) {
    const auto in_situ = in_situ_faults(reading.scene);
    for (const auto& [key, text] : in_situ) reading.refuse(key, "{}", text);
    if (cells_sound) check_ends(reading);
    if (cells_sound && in_situ.empty()) check_floor(reading);
  }
  check_fracture(reading, cells_sound);
  check_stop_values(reading);
  note_stops_of_one_state(reading);
  check_end(reading);
  check_mechanics(reading);
  check_toughness(reading);
  check_grading(reading);
  check_fine_ends(reading);
  check_fluid(reading);
  check_numbers(reading);
}

}  // namespace strata
