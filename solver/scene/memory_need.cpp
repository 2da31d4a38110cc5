#include "scene/memory_need.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <string_view>

namespace strata {
namespace {

constexpr double gigabyte = 1e9;

struct Cells {
  double x = 0.0, y = 0.0;  // along each axis; doubles, since a slip of the finger may ask for more than an int holds
};

// Cells along an axis of length `extent_m` with fine ones from `from_m` to `to_m`, and beyond them ones that grow
// by 1.2 up to `far`: a piece of length L takes the k cells with h (1.2 + ... + 1.2^k) = L until 1.2^k h = far.
double graded_cells(double extent_m, double from_m, double to_m, double h, double far) {
  constexpr double growth = 1.2;
  from_m = std::clamp(from_m, 0.0, extent_m), to_m = std::clamp(to_m, from_m, extent_m);
  double cells = (to_m - from_m) / h;
  for (const double piece : {from_m, extent_m - to_m}) {
    const double most = std::log(far / h) / std::log(growth);
    const double sum = h * growth * (std::pow(growth, most) - 1.0) / (growth - 1.0);
    cells +=
        piece < sum ? std::log1p(piece * (growth - 1.0) / (growth * h)) / std::log(growth) : most + (piece - sum) / far;
  }
  return cells;
}

Cells cells_of(const Scene& scene) {
  constexpr double margin_cells = 10.0;  // of fine cells around the fracture and its way up to stop.tip_y_m
  const double h = scene.numerics.cell_m;
  const Domain& domain = scene.domain;
  const double far = scene.numerics.far_cell_m.value_or(h);
  if (!scene.fracture || far <= h) return {domain.width_m / h, domain.height_m / h};
  std::array<double, 2> low = scene.fracture->path_m.front(), high = low;
  for (const auto& point : scene.fracture->path_m) {
    for (std::size_t k = 0; k < 2; ++k) low[k] = std::min(low[k], point[k]), high[k] = std::max(high[k], point[k]);
  }
  high[1] = std::max(high[1], scene.stop.tip_y_m.value_or(0.0));
  const double margin = margin_cells * h;
  return {graded_cells(domain.width_m, low[0] - margin, high[0] + margin, h, far),
          graded_cells(domain.height_m, low[1] - margin, high[1] + margin, h, far)};
}

}  // namespace

double memory_need(const Scene& scene) {
  constexpr double bytes_per_particle = 260.0;
  const Cells cells = cells_of(scene);
  const double state = bytes_per_particle * scene.numerics.particles_per_cell * cells.x * cells.y;
  if (scene.numerics.mechanics != Numerics::Mechanics::quasistatic) return state;
  const double n = 2.0 * (cells.x + 1.0) * (cells.y + 1.0);
  return state + 31.0 * n * std::log2(n) / 2.0 * 8.0;
}

std::optional<std::string> too_large(const Scene& scene, double available) {
  const double need = memory_need(scene);
  if (need <= available) return std::nullopt;
  const Cells cells = cells_of(scene);
  return fmt::format(
      "too large for this machine: about {:.2g} cells of numerics.cell_m = {} m need about {:.3g} GB, and {:.3g} GB "
      "are "
      "available. Use larger cells{}.",
      cells.x * cells.y, scene.numerics.cell_m, need / gigabyte, available / gigabyte,
      scene.numerics.mechanics == Numerics::Mechanics::quasistatic ? ", or grade them with numerics.far_cell_m" : "");
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
