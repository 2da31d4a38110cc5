#include "scene/scene_checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/keys.hpp"
#include "scene/path_geometry.hpp"

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
bool check_cells(const Scene& scene, const Positions& positions, Faults& faults) {
  const double cell_m = scene.numerics.cell_m;
  const double width_m = scene.domain.width_m;
  const double height_m = scene.domain.height_m;
  if (is_whole(width_m / cell_m) && is_whole(height_m / cell_m) && width_m > cell_m / 2 && height_m > cell_m / 2)
    return true;
  const double columns = width_m / cell_m;
  std::vector<std::string> sizes;
  for (const double step : {1.0, -1.0}) {
    const double wanted = step > 0.0 ? std::max(1.0, std::ceil(columns)) : std::floor(columns);
    const double fitting = cells_that_fit(width_m, height_m, wanted, step);
    if (fitting > 0.0) sizes.push_back(number_text(width_m / fitting));
  }
  const std::string advice = sizes.empty() ? " Give width and height a common divisor."
                                           : fmt::format(" The nearest sizes that do: {}.", fmt::join(sizes, " and "));
  faults.add(where_is(positions, "numerics.cell_m"),
             fmt::format("numerics.cell_m = {} does not divide the block of {} m x {} m into whole cells.{}",
                         number_text(cell_m), number_text(width_m), number_text(height_m), advice));
  return false;
}

bool on_grid_line(double at_m, double cell_m) {
  return is_whole(at_m / cell_m);
}
bool at_mid_cell(double at_m, double cell_m) {
  return is_whole(at_m / cell_m - 0.5);
}

// With 3 x 3 particles a cell one row of them lies at mid-cell, on a surface that is there.
bool particles_at_mid_cell(const Scene& scene) {
  return scene.numerics.particles_per_cell % 2 == 1;
}

void check_interfaces(const Scene& scene, const Positions& positions, Faults& faults) {
  const double cell_m = scene.numerics.cell_m;
  const char* axis = scene.strata.along == Strata::Along::y ? "y" : "x";
  const double extent_m = scene.strata.layers.back().to_m;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    const double at_m = scene.strata.interfaces[k].at_m;
    if (at_m >= extent_m) return;  // layers that do not fit are reported as such
    const Where where = where_is(positions, fmt::format("strata.layers[{}]", k));
    const std::string place = fmt::format("strata.layers[{}] ends at {} = {} m", k, axis, number_text(at_m));
    if (!on_grid_line(at_m, cell_m) && !at_mid_cell(at_m, cell_m)) {
      const double nearest =
          std::clamp(std::round(2.0 * at_m / cell_m), 1.0, std::round(2.0 * extent_m / cell_m) - 1.0);
      faults.add(where,
                 fmt::format("{}, neither on a grid line nor at mid-cell of cells of {} m. The nearest place for the "
                             "interface: {} m.",
                             place, number_text(cell_m), number_text(nearest * cell_m / 2.0)));
    } else if (at_mid_cell(at_m, cell_m) && particles_at_mid_cell(scene)) {
      faults.add(
          where,
          fmt::format("{}, where a row of 3 x 3 particles a cell lies. Use particles_per_cell = 4 or 16, or put the "
                      "interface on a grid line.",
                      place));
    }
  }
}

std::string point_text(const Point& point) {
  return fmt::format("[{}, {}]", number_text(point[0]), number_text(point[1]));
}

// How y is counted, for those who count depths.
std::string upwards(double height_m) {
  return fmt::format(" y is counted upwards from the block's lower edge: a point d below its top has y = {} - d.",
                     number_text(height_m));
}

void check_point(const Scene& scene, std::size_t k, const Where& where, Faults& faults) {
  const auto& path_m = scene.fracture->path_m;
  const Point& point = path_m[k];
  const double width_m = scene.domain.width_m;
  const double height_m = scene.domain.height_m;
  const std::string text = "fracture.path_m: the point " + point_text(point);
  const bool is_end = k == 0 || k + 1 == path_m.size();
  if (point[0] < 0.0 || point[0] > width_m || point[1] < 0.0 || point[1] > height_m) {
    const bool in_y = point[1] < 0.0 || point[1] > height_m;
    faults.add(where, fmt::format("{} is outside the block of {} m x {} m.{}", text, number_text(width_m),
                                  number_text(height_m),
                                  in_y ? upwards(height_m) : " x is counted from the block's left edge."));
  } else if (point[0] <= 0.0 || point[0] >= width_m || point[1] >= height_m) {
    faults.add(where, text + " is on an edge. A fracture may end only on the symmetry line or inside the block.");
  } else if (point[1] <= 0.0 && scene.domain.bottom != Edge::symmetry) {
    faults.add(
        where,
        text + " is on the bottom, which is no symmetry line. Use bottom = \"symmetry\", or end inside the block.");
  } else if (point[1] <= 0.0 && !is_end) {
    faults.add(where, text + " is on the symmetry line, but only an end may be there.");
  }
}

void check_shape(const Scene& scene, const Positions& positions, Faults& faults) {
  const auto& path_m = scene.fracture->path_m;
  const double tolerance_m = 1e-9 * std::max(scene.domain.width_m, scene.domain.height_m);
  bool distinct = true;
  for (std::size_t k = 0; k + 1 < path_m.size(); ++k) {
    if (std::hypot(path_m[k + 1][0] - path_m[k][0], path_m[k + 1][1] - path_m[k][1]) > tolerance_m) continue;
    distinct = false;
    faults.add(where_is(positions, fmt::format("fracture.path_m[{}]", k + 1)),
               fmt::format("fracture.path_m: the point {} is repeated. Remove it: a segment has a length.",
                           point_text(path_m[k])));
  }
  if (!distinct) return;
  if (const auto contact = self_contact(path_m, tolerance_m)) {
    faults.add(
        where_is(positions, "fracture.path_m"),
        fmt::format("fracture.path_m meets itself: the segments from {} and from {} cross, touch or double back.",
                    point_text(path_m[contact->first]), point_text(path_m[contact->second])));
  }
  const bool both = path_m.front()[1] == 0.0 && path_m.back()[1] == 0.0;
  if (both && scene.domain.bottom == Edge::symmetry) {
    faults.add(where_is(positions, "fracture.path_m"),
               "fracture.path_m has both ends on the symmetry line; one may be there. A fracture that cuts out a piece "
               "of rock has no tip.");
  }
}

// A straight piece of fracture along an axis may not lie on particles, nor on an interface that has a law.
void check_lie(const Scene& scene, const Positions& positions, Faults& faults) {
  const auto& path_m = scene.fracture->path_m;
  const double cell_m = scene.numerics.cell_m;
  const std::size_t across = scene.strata.along == Strata::Along::y ? 1 : 0;
  for (std::size_t k = 0; k + 1 < path_m.size(); ++k) {
    for (const std::size_t axis : {std::size_t{0}, std::size_t{1}}) {
      const double at_m = path_m[k][axis];
      if (std::abs(path_m[k + 1][axis] - at_m) > round_off * cell_m) continue;
      const std::string text = fmt::format("fracture.path_m: the segment from {} lies", point_text(path_m[k]));
      if (particles_at_mid_cell(scene) && at_mid_cell(at_m, cell_m)) {
        faults.add(
            where_is(positions, "fracture.path_m"),
            text + " at mid-cell, where a row of 3 x 3 particles a cell lies. Use particles_per_cell = 4 or 16.");
      }
      for (const InterfacePlace& place : scene.strata.interfaces) {
        const bool perfect = scene.laws[place.law].kind == InterfaceLaw::Kind::perfect;
        if (axis != across || perfect || std::abs(place.at_m - at_m) > round_off * cell_m) continue;
        faults.add(where_is(positions, "fracture.path_m"),
                   fmt::format("{} on the interface \"{}\". Make that interface perfect, or move the fracture.", text,
                               scene.laws[place.law].name));
      }
    }
  }
}

void check_fracture(const Scene& scene, const Positions& positions, bool cells_sound, Faults& faults) {
  const bool block_sound = positions.usable("domain.width_m") && positions.usable("domain.height_m");
  if (!positions.usable("fracture.path_m") || !block_sound || !positions.sound("domain.bottom")) return;
  for (std::size_t k = 0; k < scene.fracture->path_m.size(); ++k) {
    check_point(scene, k, where_is(positions, fmt::format("fracture.path_m[{}]", k)), faults);
  }
  check_shape(scene, positions, faults);
  if (cells_sound) check_lie(scene, positions, faults);
}

// Stops that have no meaning, or that the start has passed already.
void check_stop_values(const Scene& scene, const Positions& positions, Faults& faults) {
  const double height_m = scene.domain.height_m;
  if (positions.usable("stop.tip_y_m") && positions.usable("domain.height_m") && *scene.stop.tip_y_m >= height_m) {
    faults.add(where_is(positions, "stop.tip_y_m"),
               fmt::format("stop.tip_y_m = {} is not below the top of the block at {} m.{}",
                           number_text(*scene.stop.tip_y_m), number_text(height_m), upwards(height_m)));
  }
  if (positions.usable("stop.tip_y_m") && positions.usable("fracture.path_m")) {
    const double tip_m = std::max(scene.fracture->path_m.front()[1], scene.fracture->path_m.back()[1]);
    if (*scene.stop.tip_y_m <= tip_m) {
      faults.add(
          where_is(positions, "stop.tip_y_m"),
          fmt::format("stop.tip_y_m = {} ends the run before it starts: a tip is at y = {} m. Give more than that.",
                      number_text(*scene.stop.tip_y_m), number_text(tip_m)));
    }
  }
  if (positions.usable("stop.inlet_Pa") && !scene.fluid.rate_m2_s && positions.sound("fluid.inlet.start_Pa") &&
      scene.fluid.start_Pa >= *scene.stop.inlet_Pa) {
    faults.add(
        where_is(positions, "stop.inlet_Pa"),
        fmt::format("stop.inlet_Pa = {} ends the run before it starts: fluid.inlet.start_Pa = {}. Give more than that.",
                    number_text(*scene.stop.inlet_Pa), number_text(scene.fluid.start_Pa)));
  }
}

// Whether one of the stops given is sure to be reached: a fracture under a pressure that does not rise may stay; one
// that is fed at a rate grows, or takes ever more pressure where it may not.
void check_end(const Scene& scene, const Positions& positions, Faults& faults) {
  for (const char* path : {"fluid.inlet.rate_Pa_s", "fluid.inlet.rate_m2_s", "fracture.growth"}) {
    if (!positions.sound(path)) return;
  }
  const bool fed = scene.fluid.rate_m2_s.has_value();
  if (!fed && !positions.given("fluid.inlet.start_Pa") && !positions.given("fluid.inlet.rate_Pa_s")) return;
  const bool by_inlet = positions.given("stop.inlet_Pa");
  const bool by_tip = positions.given("stop.tip_y_m");
  if (positions.given("stop.time_s") || (!by_inlet && !by_tip)) return;
  const bool grows = scene.fracture->growth != Fracture::Growth::none;
  const bool rises = fed ? !grows : scene.fluid.rate_Pa_s > 0.0;
  if ((by_inlet && rises) || (by_tip && grows && (fed || rises))) return;
  const std::string reason = rises ? "the fracture does not grow (fracture.growth = \"none\")"
                             : fed ? "the pressure of a fracture fed at a rate falls as it grows"
                                   : fmt::format("the inlet pressure does not rise (fluid.inlet.rate_Pa_s = {})",
                                                 number_text(scene.fluid.rate_Pa_s));
  faults.add(where_is(positions, by_inlet ? "stop.inlet_Pa" : "stop.tip_y_m"),
             fmt::format("the run could never end: {}. Give stop.time_s too.", reason));
}

void check_stop(const Scene& scene, const Positions& positions, Faults& faults) {
  if (scene.fracture) {
    check_stop_values(scene, positions, faults);
    check_end(scene, positions, faults);
    return;
  }
  for (const char* path : {"stop.tip_y_m", "stop.inlet_Pa"}) {
    if (!positions.given(path)) continue;
    faults.add(where_is(positions, path),
               fmt::format("{} cannot be reached: the scene has no [fracture]. Use stop.time_s.", path));
  }
}

}  // namespace

void check_scene(const Scene& scene, const Positions& positions, Faults& faults) {
  bool cells_sound = positions.usable("numerics.cell_m") && positions.sound("numerics.particles_per_cell");
  if (cells_sound && positions.usable("domain.width_m") && positions.usable("domain.height_m")) {
    cells_sound = check_cells(scene, positions, faults);
  }
  const bool along_y = scene.strata.along == Strata::Along::y;
  const bool layers_sound = positions.usable("strata.layers") && positions.sound("strata.along") &&
                            positions.usable(along_y ? "domain.height_m" : "domain.width_m");
  if (cells_sound && layers_sound) check_interfaces(scene, positions, faults);
  if (scene.fracture) check_fracture(scene, positions, cells_sound, faults);
  check_stop(scene, positions, faults);
  check_combinations(scene, positions, faults);
}

}  // namespace strata
