#include "scene/memory_need.hpp"

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

constexpr double gigabyte = 1e9;

struct Cells {
  double x = 0.0, y = 0.0;  // along each axis; doubles, since a slip of the finger may ask for more than an int holds
};

// Cells of h q, h q^2, ... that fill a length.
double endless_cells(double length, double h, double q) {
  return std::log1p(length * (q - 1.0) / (q * h)) / std::log(q);
}

// Cells over a length from one end of which they grow from h to `far`: k of them with h (q + ... + q^k) = L, q = 1.2,
// until h q^k = far.
double growing_cells(double length, double h, double far) {
  const double most = std::log(far / h) / std::log(span_growth);
  const double sum = h * span_growth * (far / h - 1.0) / (span_growth - 1.0);
  if (length > sum) return most + (length - sum) / far;
  return endless_cells(length, h, span_growth);
}

// Along an axis of `extent` m; cells grow from both ends of a gap between fine stretches.
double graded_cells(const Scene& scene, int axis, double extent, double far) {
  const double h = scene.numerics.cell_m;
  double cells = 0.0, at = 0.0;
  for (const Stretch& fine : fine_stretches(scene, axis)) {
    const double gap = fine.from - at;
    cells +=
        (at > 0.0 ? 2.0 * growing_cells(0.5 * gap, h, far) : growing_cells(gap, h, far)) + (fine.to - fine.from) / h;
    at = fine.to;
  }
  return cells + growing_cells(extent - at, h, far);
}

// Counted without making the grid, which may be the one that does not fit.
Cells cells_of(const Scene& scene) {
  const double h = scene.numerics.cell_m, far = scene.numerics.far_cell_m.value_or(h);
  const Domain& domain = scene.domain;
  const double beyond = endless_cells(domain.beyond_m, h, span_growth_beyond);
  const double ends = domain.bottom == Edge::symmetry ? 1.0 : 2.0;
  const bool graded = far > h;
  return {2.0 * beyond + (graded ? graded_cells(scene, 0, domain.width_m, far) : domain.width_m / h),
          ends * beyond + (graded ? graded_cells(scene, 1, domain.height_m, far) : domain.height_m / h)};
}

// Length of the fracture at the end (m): of its path and of the ways of its tips. One equilibrium lets none grow.
double longest_fracture(const Scene& scene) {
  const auto& path = scene.fracture->path_m;
  double length = 0.0;
  for (std::size_t k = 1; k < path.size(); ++k)
    length += std::hypot(path[k][0] - path[k - 1][0], path[k][1] - path[k - 1][1]);
  if (scene.stop.time_s == 0.0) return length;
  for (const GrowthWay& way : ways_of_growth(scene)) length += way.length;
  return length;
}

// Cells along an interface.
double cells_along(const Scene& scene, const Cells& cells) {
  return scene.strata.along == Strata::Along::y ? cells.x : cells.y;
}

// Jumps across the fracture at the end and interfaces that part from the start: six a cell. How much of a bonded one
// fails is not known.
double jumps_of(const Scene& scene, const Cells& cells) {
  double parted = scene.fracture ? longest_fracture(scene) / scene.numerics.cell_m : 0.0;
  for (const InterfacePlace& place : scene.strata.interfaces) {
    if (scene.laws[place.law].apart_at_start()) parted += cells_along(scene, cells);
  }
  return 6.0 * parted * (mirror_symmetric(scene) ? 0.5 : 1.0);
}

// Whether equilibria decide about growth somewhere: an interface that does something may come near a tip.
bool weighs_growth(const Scene& scene) {
  if (!scene.fracture || scene.fracture->growth == Fracture::Growth::none) return false;
  if (scene.fracture->growth == Fracture::Growth::energy) return true;
  bool any = false;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) any = any || scene.changes_at(k);
  return any && scene.fracture->crossing == Fracture::Crossing::energy;
}

// Bytes without inertia, of a point and of n log n of n unknowns: that of bodies which are factored anew on the way is
// smaller, since what the first one left serves the others; where trials of a path that turns have other points, they
// have bodies of their own.
struct Bytes {
  double point, factor;
};

Bytes bytes_of(const Scene& scene) {
  const bool weighs = weighs_growth(scene);
  if (!may_turn(scene)) return weighs ? Bytes{1000.0, 820.0} : Bytes{330.0, 705.0};
  return {1090.0, weighs ? 1200.0 : 475.0};
}

}  // namespace

double points_of(const Scene& scene) {
  const Cells cells = cells_of(scene);
  return cells.x * cells.y * std::pow(points_across(scene), 2);
}

double memory_need(const Scene& scene) {
  const double points = points_of(scene);
  const bool inertia = scene.numerics.mechanics != Numerics::Mechanics::quasistatic;
  const double moving = inertia ? 1250.0 * points : 0.0;
  if (inertia && !weighs_growth(scene)) return 20e6 + moving;
  const Cells cells = cells_of(scene);
  const double share = mirror_symmetric(scene) && !inertia ? 1.0 : 2.0;
  const double n = 2.0 * (0.5 * cells.x * share + 1.0) * (cells.y + 1.0);
  // Factors by nested dissection fill up as n log n (George 1973); jumps have some dense matrices. Fitted to the peaks
  // of all variants of the experiments: 30 to 173 MB at 1 m cells, 187 to 1369 MB at 0.25 m.
  const Bytes bytes = bytes_of(scene);
  const double dense = 28.0 * std::pow(jumps_of(scene, cells) * (inertia && mirror_symmetric(scene) ? 2.0 : 1.0), 2);
  return 20e6 + moving + points * bytes.point + bytes.factor * n * std::log2(n) + dense;
}

std::optional<std::string> too_large(const Scene& scene, double available) {
  const double need = memory_need(scene);
  if (need <= available) return std::nullopt;
  const Cells cells = cells_of(scene);
  return fmt::format(
      "too large for this machine: about {:.2g} cells of numerics.cell_m = {} m need about {:.3g} GB, and {:.3g} GB "
      "are available. Use larger cells, or grade them with numerics.far_cell_m.",
      cells.x * cells.y, scene.numerics.cell_m, need / gigabyte, available / gigabyte);
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
