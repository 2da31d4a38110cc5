#include "scene/time_need.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/graded_cells.hpp"
#include "scene/memory_need.hpp"

namespace strata {
namespace {

// Points times steps a second.
double rate(const Numerics& numerics) {
  if (numerics.mechanics == Numerics::Mechanics::quasistatic) return 1.0e7;
  if (numerics.kinematics == Numerics::Kinematics::total) return 1.0e8;
  return numerics.kernels == Numerics::Kernels::fast ? 2.0e7 : 3.0e6;
}

// Plane strain: c_P^2 = E (1 - nu)/((1 + nu)(1 - 2 nu) rho).
double fastest_wave(const Scene& scene) {
  double c2 = 0.0;
  for (const Layer& layer : scene.strata.layers) {
    const Rock& rock = scene.rocks[layer.rock];
    const double nu = rock.poisson_ratio;
    c2 = std::max(c2, rock.youngs_modulus_Pa * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu) * rock.density_kg_m3));
  }
  return std::sqrt(c2);
}

// Increments of all tips to where growth ends at the latest.
double increments(const Scene& scene) {
  double length = 0.0;
  for (const GrowthWay& way : ways_of_growth(scene)) length += way.length;
  return length > 0.0 ? length / scene.fracture->increment_m : 0.0;
}

std::optional<double> steps_of(const Scene& scene) {
  const std::optional<double> duration = expected_duration(scene);
  if (scene.numerics.mechanics == Numerics::Mechanics::quasistatic) {
    if (scene.stop.time_s && *scene.stop.time_s == 0.0) return 1.0;
    const double outputs = duration && scene.output.fields_every_s ? *duration / *scene.output.fields_every_s : 50.0;
    return 8.0 * increments(scene) + 3.0 * outputs;
  }
  if (!duration) return std::nullopt;
  return *duration * fastest_wave(scene) / (scene.numerics.courant * scene.numerics.cell_m);
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

std::optional<double> time_need(const Scene& scene) {
  const std::optional<double> steps = steps_of(scene);
  if (!steps) return std::nullopt;
  return *steps * points_of(scene) / rate(scene.numerics);
}

std::optional<std::string> too_long(const Scene& scene) {
  const std::optional<double> need = time_need(scene);
  if (!need || *need <= longest_run_s) return std::nullopt;
  return fmt::format(
      "would take too long: about {:.2g} steps of {:.2g} points, some {:.2g} days on one thread. Use larger cells or "
      "an earlier stop, or --any-time to run it all the same.",
      *steps_of(scene), points_of(scene), *need / 86400.0);
}

}  // namespace strata
