#include "scene/run_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string_view>

#include "scene/graded_cells.hpp"
#include "scene/points_across.hpp"

namespace strata {
namespace {

// Cells along x (axis 0) or y (1): those of the grid or, where a slip of the finger asks for too many to be made,
// about as many. Doubles, since these may be more than an int holds.
double cells_along(const Scene& scene, int axis) {
  const double h = scene.numerics.cell_m, far = scene.numerics.far_cell_m.value_or(h);
  const double extent = axis == 0 ? scene.domain.width_m : scene.domain.height_m;
  double fine = 0.0;
  for (const Stretch& stretch : fine_stretches(scene, axis)) fine += stretch.to - stretch.from;
  const double about = fine / h + (extent - fine) / far;
  constexpr double most_made = 1e4;
  const std::vector<double> knots = about < most_made ? scene_knots(scene, axis) : std::vector<double>();
  return knots.empty() ? std::round(about) : static_cast<double>(knots.size()) - 4.0;
}

// Cells along all that is apart at the end: the fracture's path with the ways of its tips (one equilibrium lets none
// grow) and interfaces. How much of a bonded one fails is not known.
double parted_cells(const Scene& scene) {
  double length = 0.0;
  if (scene.fracture) {
    const auto& path = scene.fracture->path_m;
    for (std::size_t k = 1; k < path.size(); ++k)
      length += std::hypot(path[k][0] - path[k - 1][0], path[k][1] - path[k - 1][1]);
    for (const GrowthWay& way : ways_of_growth(scene)) length += scene.stop.time_s == 0.0 ? 0.0 : way.length;
  }
  const auto apart = std::ranges::count_if(
      scene.strata.interfaces, [&](const InterfacePlace& place) { return scene.laws[place.law].apart_at_start(); });
  const int axis = scene.strata.along == Strata::Along::y ? 0 : 1;
  return length / scene.numerics.cell_m + static_cast<double>(apart) * cells_along(scene, axis);
}

// Whether equilibria decide about growth somewhere: an interface that does something may come near a tip.
bool weighs_growth(const Scene& scene) {
  if (!scene.fracture || scene.fracture->growth == Fracture::Growth::none) return false;
  bool any = false;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) any = any || scene.changes_at(k);
  return scene.fracture->growth == Fracture::Growth::energy ||
         (any && scene.fracture->crossing == Fracture::Crossing::energy);
}

}  // namespace

std::optional<double> expected_duration(const Scene& scene) {
  std::optional<double> duration = scene.stop.time_s;
  if (scene.fracture && scene.stop.inlet_Pa && scene.fluid.rate_Pa_s > 0.0) {
    const double ramp = (*scene.stop.inlet_Pa - scene.fluid.start_Pa) / scene.fluid.rate_Pa_s;
    duration = std::min(ramp, duration.value_or(ramp));
  }
  return duration;
}

double points_of(const Scene& scene) {
  return cells_along(scene, 0) * cells_along(scene, 1) * std::pow(points_across(scene), 2);
}

double memory_need(const Scene& scene) {
  const double points = points_of(scene);
  const bool inertia = scene.numerics.mechanics != Numerics::Mechanics::quasistatic;
  const double moving = 20e6 + (inertia ? 1250.0 * points : 0.0);
  if (inertia && !weighs_growth(scene)) return moving;
  const double solved = mirror_symmetric(scene) && !inertia ? 0.5 : 1.0;  // of the block
  const double n = 2.0 * (solved * cells_along(scene, 0) + 1.0) * (cells_along(scene, 1) + 1.0);
  const double jumps = 6.0 * solved * parted_cells(scene);
  return moving + (may_turn(scene) ? 2000.0 : 1000.0) * points + 820.0 * n * std::log2(n) + 28.0 * jumps * jumps;
}

std::optional<std::string> too_large(const Scene& scene, double available) {
  const double need = memory_need(scene);
  if (need <= available) return std::nullopt;
  return fmt::format(
      "too large for this machine: about {:.2g} cells of numerics.cell_m = {} m need about {:.3g} GB, and {:.3g} GB "
      "are available. Use larger cells, or grade them with numerics.far_cell_m.",
      cells_along(scene, 0) * cells_along(scene, 1), scene.numerics.cell_m, 1e-9 * need, 1e-9 * available);
}

double available_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    constexpr std::string_view name = "MemAvailable:";
    if (line.starts_with(name)) return 1024.0 * std::strtod(line.c_str() + name.size(), nullptr);  // given in kB
  }
  return std::numeric_limits<double>::infinity();
}

}  // namespace strata
