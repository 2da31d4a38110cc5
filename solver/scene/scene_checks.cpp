#include "scene/scene_checks.hpp"

#include <algorithm>
#include <cmath>

#include "scene/derived.hpp"

namespace strata {
namespace {

constexpr double round_off = 1e-6;  // of a cell: lengths typed with as few digits still fit

bool is_whole(double value) {
  return std::abs(value - std::round(value)) < round_off;
}

// Number of cells over `width_m`, nearest to `wanted` from there on in steps of `step` (1 or -1), with which cells also
// divide `height_m`; 0 where a search of reasonable length finds none.
double cells_that_fit(double width_m, double height_m, double wanted, double step) {
  constexpr int longest_search = 100000;
  for (int k = 0; k < longest_search && wanted >= 1.0; ++k, wanted += step) {
    const double rows = height_m / width_m * wanted;
    if (rows > 0.5 && is_whole(rows)) return wanted;
  }
  return 0.0;
}

// Whether the cells divide the block.
bool check_cells(const SceneChecks& checks) {
  const double cell_m = checks.scene.numerics.cell_m;
  const double width_m = checks.scene.domain.width_m, height_m = checks.scene.domain.height_m;
  const double columns = width_m / cell_m, rows = height_m / cell_m;
  if (is_whole(columns) && is_whole(rows) && columns > 0.5 && rows > 0.5) return true;
  std::vector<std::string> sizes;
  for (const double step : {1.0, -1.0}) {
    const double wanted = step > 0.0 ? std::max(1.0, std::ceil(columns)) : std::floor(columns);
    const double fitting = cells_that_fit(width_m, height_m, wanted, step);
    if (fitting > 0.0) sizes.push_back(number_text(width_m / fitting));
  }
  checks.refuse("numerics.cell_m", "numerics.cell_m = {} does not divide the block of {} m x {} m into whole cells. {}",
                cell_m, width_m, height_m,
                sizes.empty() ? "Give width and height a common divisor."
                              : fmt::format("The nearest sizes that do: {}.", fmt::join(sizes, " and ")));
  return false;
}

// Whether a place at mid-cell is taken: with 3 x 3 particles a cell one row of them lies there.
bool on_particles(const Scene& scene, double at_m) {
  return scene.numerics.particles_per_cell % 2 == 1 && is_whole(at_m / scene.numerics.cell_m - 0.5);
}

void check_interfaces(const SceneChecks& checks) {
  const Strata& strata = checks.scene.strata;
  const double cell_m = checks.scene.numerics.cell_m, extent_m = strata.layers.back().to_m;
  for (std::size_t k = 0; k < strata.interfaces.size(); ++k) {
    const double at_m = strata.interfaces[k].at_m, halves = 2.0 * at_m / cell_m;
    if (at_m >= extent_m) return;  // layers that do not fit are reported as such
    const std::string layer = fmt::format("strata.layers[{}]", k);
    const std::string place = fmt::format("{} ends at {} = {} m", layer, word_of(strata.along), number_text(at_m));
    if (!is_whole(at_m / cell_m) && !is_whole(at_m / cell_m - 0.5)) {
      const double nearest = std::clamp(std::round(halves), 1.0, std::round(2.0 * extent_m / cell_m) - 1.0);
      checks.refuse(
          layer,
          "{}, neither on a grid line nor at mid-cell of cells of {} m. The nearest place for the interface: {} m.",
          place, cell_m, nearest * cell_m / 2.0);
    } else if (on_particles(checks.scene, at_m)) {
      checks.refuse(layer,
                    "{}, where a row of 3 x 3 particles a cell lies. Use particles_per_cell = 4 or 16, or put the "
                    "interface on a grid line.",
                    place);
    }
  }
}

std::string point_text(const Point& point) {
  return fmt::format("[{}, {}]", number_text(point[0]), number_text(point[1]));
}

// How y is counted, for those who count depths.
std::string upwards(double height_m) {
  return fmt::format("y is counted upwards from the block's lower edge: a point d below its top has y = {} - d.",
                     number_text(height_m));
}

// What is wrong with the place of a point of the path; empty where nothing is.
std::string fault_of_point(const Scene& scene, const Point& point, bool is_end) {
  const auto [x, y] = point;
  const double width_m = scene.domain.width_m, height_m = scene.domain.height_m;
  const bool in_y = y < 0.0 || y > height_m;
  if (x < 0.0 || x > width_m || in_y) {
    return fmt::format("outside the block of {} m x {} m. {}", number_text(width_m), number_text(height_m),
                       in_y ? upwards(height_m) : "x is counted from the block's left edge.");
  }
  if (x <= 0.0 || x >= width_m || y >= height_m)
    return "on an edge. A fracture may end only on the symmetry line or inside the block.";
  if (y <= 0.0 && scene.domain.bottom != Edge::symmetry)
    return "on the bottom, which is no symmetry line. Use bottom = \"symmetry\", or end inside the block.";
  return y <= 0.0 && !is_end ? "on the symmetry line, but only an end may be there." : "";
}

void check_shape(const SceneChecks& checks) {
  const auto& path_m = checks.scene.fracture->path_m;
  const Domain& domain = checks.scene.domain;
  const double tolerance_m = 1e-9 * std::max(domain.width_m, domain.height_m);
  bool distinct = true;
  for (std::size_t k = 0; k + 1 < path_m.size(); ++k) {
    if (std::hypot(path_m[k + 1][0] - path_m[k][0], path_m[k + 1][1] - path_m[k][1]) > tolerance_m) continue;
    distinct = false;
    checks.refuse(fmt::format("fracture.path_m[{}]", k + 1),
                  "fracture.path_m: the point {} is repeated. Remove it: a segment has a length.",
                  point_text(path_m[k]));
  }
  if (!distinct) return;
  if (const auto contact = self_contact(path_m, tolerance_m)) {
    checks.refuse("fracture.path_m",
                  "fracture.path_m meets itself: the segments from {} and from {} cross, touch or double back.",
                  point_text(path_m[contact->first]), point_text(path_m[contact->second]));
  }
  if (path_m.front()[1] == 0.0 && path_m.back()[1] == 0.0 && domain.bottom == Edge::symmetry) {
    checks.refuse("fracture.path_m",
                  "fracture.path_m has both ends on the symmetry line; one may be there. A fracture that cuts out a "
                  "piece of rock has no tip.");
  }
}

// A straight piece of fracture along an axis may not lie on particles, nor on an interface that has a law.
void check_lie(const SceneChecks& checks) {
  const Scene& scene = checks.scene;
  const auto& path_m = scene.fracture->path_m;
  const double tolerance_m = round_off * scene.numerics.cell_m;
  const std::size_t across = scene.strata.along == Strata::Along::y ? 1 : 0;
  for (std::size_t k = 0; k + 1 < path_m.size(); ++k) {
    for (const std::size_t axis : {0, 1}) {
      const double at_m = path_m[k][axis];
      if (std::abs(path_m[k + 1][axis] - at_m) > tolerance_m) continue;
      const std::string text = fmt::format("fracture.path_m: the segment from {} lies", point_text(path_m[k]));
      if (on_particles(scene, at_m)) {
        checks.refuse("fracture.path_m",
                      "{} at mid-cell, where a row of 3 x 3 particles a cell lies. Use particles_per_cell = 4 or 16.",
                      text);
      }
      for (const InterfacePlace& place : scene.strata.interfaces) {
        const InterfaceLaw& law = scene.laws[place.law];
        const bool perfect = law.kind == InterfaceLaw::Kind::perfect;
        if (axis != across || perfect || std::abs(place.at_m - at_m) > tolerance_m) continue;
        checks.refuse("fracture.path_m",
                      "{} on the interface \"{}\". Make that interface perfect, or move the fracture.", text, law.name);
      }
    }
  }
}

void check_fracture(const SceneChecks& checks, bool cells_sound) {
  if (!checks.usable("fracture.path_m", "domain.width_m", "domain.height_m") || !checks.entries.sound("domain.bottom"))
    return;
  const auto& path_m = checks.scene.fracture->path_m;
  for (std::size_t k = 0; k < path_m.size(); ++k) {
    const std::string fault = fault_of_point(checks.scene, path_m[k], k == 0 || k + 1 == path_m.size());
    if (fault.empty()) continue;
    checks.refuse(fmt::format("fracture.path_m[{}]", k), "fracture.path_m: the point {} is {}", point_text(path_m[k]),
                  fault);
  }
  check_shape(checks);
  if (cells_sound) check_lie(checks);
}

// Stops that have no meaning, or that the start has passed already.
void check_stop_values(const SceneChecks& checks) {
  const Scene& scene = checks.scene;
  const double height_m = scene.domain.height_m, tip_y_m = scene.stop.tip_y_m.value_or(0.0);
  if (checks.usable("stop.tip_y_m", "domain.height_m") && tip_y_m >= height_m) {
    checks.refuse("stop.tip_y_m", "stop.tip_y_m = {} is not below the top of the block at {} m. {}", tip_y_m, height_m,
                  upwards(height_m));
  }
  if (checks.usable("stop.tip_y_m", "fracture.path_m")) {
    const double tip_m = std::max(scene.fracture->path_m.front()[1], scene.fracture->path_m.back()[1]);
    if (tip_y_m <= tip_m) {
      checks.refuse("stop.tip_y_m",
                    "stop.tip_y_m = {} ends the run before it starts: a tip is at y = {} m. Give more than that.",
                    tip_y_m, tip_m);
    }
  }
  if (checks.usable("stop.inlet_Pa") && !scene.fluid.rate_m2_s && checks.entries.sound("fluid.inlet.start_Pa") &&
      scene.fluid.start_Pa >= *scene.stop.inlet_Pa) {
    checks.refuse("stop.inlet_Pa",
                  "stop.inlet_Pa = {} ends the run before it starts: fluid.inlet.start_Pa = {}. Give more than that.",
                  *scene.stop.inlet_Pa, scene.fluid.start_Pa);
  }
}

// Whether one of the stops given is sure to be reached: a fracture under a pressure that does not rise may stay; one
// that is fed at a rate grows, or takes ever more pressure where it may not.
void check_end(const SceneChecks& checks) {
  const auto given = [&](const char* path) { return checks.entries.given(path); };
  for (const char* path : {"fluid.inlet.rate_Pa_s", "fluid.inlet.rate_m2_s", "fracture.growth"}) {
    if (!checks.entries.sound(path)) return;
  }
  const bool fed = checks.scene.fluid.rate_m2_s.has_value();
  if (!fed && !given("fluid.inlet.start_Pa") && !given("fluid.inlet.rate_Pa_s")) return;
  const bool by_inlet = given("stop.inlet_Pa"), by_tip = given("stop.tip_y_m");
  if (given("stop.time_s") || (!by_inlet && !by_tip)) return;
  const double rate_Pa_s = checks.scene.fluid.rate_Pa_s;
  const bool grows = checks.scene.fracture->growth != Fracture::Growth::none;
  const bool rises = fed ? !grows : rate_Pa_s > 0.0;
  if ((by_inlet && rises) || (by_tip && grows && (fed || rises))) return;
  const std::string still =
      fmt::format("the inlet pressure does not rise (fluid.inlet.rate_Pa_s = {})", number_text(rate_Pa_s));
  checks.refuse(by_inlet ? "stop.inlet_Pa" : "stop.tip_y_m", "the run could never end: {}. Give stop.time_s too.",
                rises ? "the fracture does not grow (fracture.growth = \"none\")"
                : fed ? "the pressure of a fracture fed at a rate falls as it grows"
                      : still.c_str());
}

void check_stop(const SceneChecks& checks) {
  if (checks.scene.fracture) {
    check_stop_values(checks);
    check_end(checks);
    return;
  }
  for (const char* path : {"stop.tip_y_m", "stop.inlet_Pa"}) {
    if (!checks.entries.given(path)) continue;
    checks.refuse(path, "{} cannot be reached: the scene has no [fracture]. Use stop.time_s.", path);
  }
}

// Keys that are sound each by itself but do not go together.

// What one of the two mechanics cannot do.
void check_mechanics(const SceneChecks& checks) {
  if (!checks.entries.sound("numerics.mechanics")) return;
  const Scene& scene = checks.scene;
  const bool rests = scene.numerics.mechanics == Numerics::Mechanics::quasistatic, moves = !rests;
  const Fracture fracture = scene.fracture.value_or(Fracture());
  const bool gimp_in_place = scene.numerics.shape == Numerics::Shape::gimp && scene.numerics.keeps_places();
  const std::string in_place = rests ? "mechanics = \"quasistatic\"" : "kinematics = \"total\"";
  struct Refusal {
    bool applies;
    std::string_view key;
    std::string why;
  };
  const std::string without = "needs mechanics = \"quasistatic\", but mechanics = \"explicit\"";
  for (const auto& [applies, key, why] : {
           Refusal{moves && fracture.growth == Fracture::Growth::energy, "fracture.growth",
                   " = \"energy\" compares equilibria and " + without + ". Use growth = \"J\" or \"none\"."},
           Refusal{moves && fracture.order == Fracture::Order::larger_margin, "fracture.order",
                   " = \"larger_margin\" asks what goes first at one load and " + without +
                       ", where either takes its time. Use order = \"interfaces\"."},
           Refusal{moves && scene.fluid.law == Fluid::Law::reynolds, "fluid.law",
                   " = \"reynolds\" is solved together with the rock's equilibrium and " + without +
                       ". Use law = \"paper\" or \"uniform\"."},
           Refusal{moves && scene.stop.time_s == 0.0, "stop.time_s",
                   " = 0 asks for one equilibrium and " + without + ". Give a time above 0, or use quasistatic."},
           Refusal{rests && scene.initial.velocity_m_s.has_value(), "initial.velocity_m_s",
                   " moves the block at time 0, which needs inertia, but mechanics = \"quasistatic\". Use mechanics = "
                   "\"explicit\", or leave it out."},
           // uGIMP weights follow particles that move.
           Refusal{gimp_in_place, "numerics.shape",
                   " = \"gimp\" is for moving points only, but " + in_place +
                       " leaves them in their reference place, where it is linear. Use shape = \"bspline2\" or "
                       "\"linear\"."},
       }) {
    if (applies && checks.entries.sound(key)) checks.refuse(key, std::string(key) + why);
  }
}

// The middle one of three stands on the border of two spans: at a loaded edge, which halves a span, its weights do not
// integrate the derivative of a B-spline, and a uniform stress would not be in equilibrium.
void check_nine_points(const SceneChecks& checks, std::string_view key, double value) {
  if (checks.scene.numerics.particles_per_cell != 9 || !checks.entries.sound("numerics.particles_per_cell")) return;
  checks.refuse("numerics.particles_per_cell",
                "numerics.particles_per_cell = 9 is for uniform grids, but {} = {} grades this one. Use 4 or 16, or "
                "leave {} out.",
                key, value, key.substr(key.find('.') + 1));
}

void check_beyond(const SceneChecks& checks) {
  const double beyond = checks.scene.domain.beyond_m, cell = checks.scene.numerics.cell_m;
  if (beyond == 0.0 || !checks.usable("domain.beyond_m", "numerics.cell_m")) return;
  // Shorter, cells would shrink.
  const double least = 2.0 * std::max(cell, checks.scene.numerics.far_cell_m.value_or(cell));
  if (beyond < least) {
    checks.refuse("domain.beyond_m",
                  "domain.beyond_m = {} is less than two of the cells at the block's edges. Give at least {}, or 0: "
                  "the rock ends there.",
                  beyond, least);
  }
  check_nine_points(checks, "domain.beyond_m", beyond);
}

void check_far_cell(const SceneChecks& checks) {
  if (!checks.usable("numerics.far_cell_m", "numerics.cell_m")) return;
  const double cell = checks.scene.numerics.cell_m, far = *checks.scene.numerics.far_cell_m;
  if (far > cell) check_nine_points(checks, "numerics.far_cell_m", far);
  if (far >= cell) return;
  checks.refuse("numerics.far_cell_m",
                "numerics.far_cell_m = {} is below numerics.cell_m = {}: cells grow away from the fracture. Give at "
                "least cell_m, or leave it out.",
                far, cell);
}

// Ends of the fine cells: on the far side of the initial fracture, and of a graded grid.
void check_fine_ends(const SceneChecks& checks) {
  if (!checks.scene.fracture) return;
  const Numerics& n = checks.scene.numerics;
  struct End {
    std::string_view key;
    const std::optional<double>& at;
    std::size_t axis;
    bool is_least;
  };
  for (const End& end :
       {End{"numerics.fine_left_m", n.fine_left_m, 0, true}, End{"numerics.fine_right_m", n.fine_right_m, 0, false},
        End{"numerics.fine_bottom_m", n.fine_bottom_m, 1, true}, End{"numerics.fine_top_m", n.fine_top_m, 1, false}}) {
    if (!checks.usable(end.key)) continue;
    if (!checks.entries.given("numerics.far_cell_m")) {
      checks.refuse(end.key,
                    "{} = {} says where a graded grid is fine, but numerics.far_cell_m is missing: all cells are of "
                    "cell_m. Give it, or leave {} out.",
                    end.key, *end.at, end.key.substr(end.key.find('.') + 1));
    }
    if (!checks.usable("fracture.path_m")) continue;
    const auto [low, high] =
        std::ranges::minmax_element(checks.scene.fracture->path_m, {}, [&](const auto& x) { return x[end.axis]; });
    const double fracture = (end.is_least ? *low : *high)[end.axis];
    if (end.is_least ? *end.at <= fracture : *end.at >= fracture) continue;
    checks.refuse(end.key, "{} = {} lies within the initial fracture, which reaches to {}. Give at {} that.", end.key,
                  *end.at, fracture, end.is_least ? "most" : "least");
  }
}

void check_fluid(const SceneChecks& checks) {
  const Fluid& fluid = checks.scene.fluid;
  if (!checks.scene.fracture || !checks.entries.sound("fluid.law")) return;
  if (fluid.rate_m2_s && fluid.law != Fluid::Law::reynolds) {
    checks.refuse("fluid.inlet.rate_m2_s",
                  "fluid.inlet.rate_m2_s = {} needs a law that conserves the fluid's mass, but fluid.law = \"{}\". Use "
                  "law = \"reynolds\", or inlet = {{start_Pa, rate_Pa_s}}.",
                  *fluid.rate_m2_s, word_of(fluid.law));
  }
  const bool sound = checks.entries.sound("fluid.cavitation_Pa") && checks.usable("fluid.inlet.start_Pa");
  if (sound && !fluid.rate_m2_s && fluid.cavitation_Pa > fluid.start_Pa) {
    checks.refuse("fluid.cavitation_Pa",
                  "fluid.cavitation_Pa = {} is above fluid.inlet.start_Pa = {}, but no pressure may be below it. Lower "
                  "it, or start higher.",
                  fluid.cavitation_Pa, fluid.start_Pa);
  }
}

// What a state holds at most: a bit for each surface, a byte for a particle's rock.
void check_numbers(const SceneChecks& checks) {
  constexpr std::size_t most_surfaces = 31, most_rocks = 255;
  const Scene& scene = checks.scene;
  const auto with_laws = std::ranges::count_if(scene.strata.interfaces, [&](const InterfacePlace& place) {
    return scene.laws[place.law].kind != InterfaceLaw::Kind::perfect;
  });
  const std::size_t surfaces = static_cast<std::size_t>(with_laws) + (scene.fracture ? 1 : 0);
  if (surfaces > most_surfaces) {
    checks.refuse("strata.interfaces",
                  "strata.interfaces: {} surfaces{} are more than {}. Make some interfaces perfect.", surfaces,
                  scene.fracture ? ", the fracture and all interfaces that are not perfect," : "", most_surfaces);
  }
  if (scene.rocks.size() > most_rocks) {
    checks.refuse("rock", "there are {} rocks, more than {}. Remove those that no layer uses, or let layers share.",
                  scene.rocks.size(), most_rocks);
  }
}

}  // namespace

void check_scene(const SceneChecks& checks) {
  bool cells_sound = checks.usable("numerics.cell_m") && checks.entries.sound("numerics.particles_per_cell");
  if (cells_sound && checks.usable("domain.width_m", "domain.height_m")) cells_sound = check_cells(checks);
  const bool along_y = checks.scene.strata.along == Strata::Along::y;
  const bool layers_sound = checks.usable("strata.layers", along_y ? "domain.height_m" : "domain.width_m") &&
                            checks.entries.sound("strata.along");
  if (cells_sound && layers_sound) check_interfaces(checks);
  if (checks.scene.fracture) check_fracture(checks, cells_sound);
  check_stop(checks);
  check_mechanics(checks);
  check_far_cell(checks);
  check_fine_ends(checks);
  check_beyond(checks);
  check_fluid(checks);
  check_numbers(checks);
}

}  // namespace strata
