#include "scene/in_situ.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/formula.hpp"

namespace strata {
namespace {

using KeyFault = std::pair<std::string, std::string>;

std::vector<double> values_of(const Field& field, const std::vector<Point>& places) {
  if (field.formula.empty()) return std::vector<double>(places.size(), field.number);
  std::vector<double> X, Y;
  for (const Point& x : places) X.push_back(x[0]), Y.push_back(x[1]);
  return evaluate_formula(field.formula, {{"X", X}, {"Y", Y}});
}

// Whether the field says itself how it changes with Y.
bool has_Y(const Field& field) {
  return !field.formula.empty() && fault_in_formula(field.formula, {"X"}).has_value();
}

// Mass above a place up to the block's top, per horizontal area (kg/m^2).
double mass_above(const Scene& scene, const Point& x) {
  const double top = scene.domain.height_m;
  const auto& layers = scene.strata.layers;
  const auto rho = [&](std::size_t k) { return scene.rocks[layers[k].rock].density_kg_m3; };
  const std::size_t own = layer_at(scene, x);
  if (!scene.strata.upwards() || own + 1 == layers.size()) return rho(own) * (top - x[1]);
  double mass = rho(own) * (layers[own].to_m - x[1]);
  for (std::size_t k = own + 1; k < layers.size(); ++k) mass += rho(k) * (layers[k].to_m - layers[k].from_m);
  return mass;
}

// The stress that a layer has along the interfaces beside it, which it may have of its own.
const std::optional<Field>& own_stress(const Scene& scene, const Layer& layer) {
  return scene.strata.upwards() ? layer.horizontal_Pa : layer.vertical_Pa;
}

// A key of the scene and what it was given.
struct Looked {
  std::string key;
  const Field& field;
};

std::string typed(const Looked& of) {
  return of.field.formula.empty() ? of.key : fmt::format("{} = \"{}\"", of.key, of.field.formula);
}

// Places in layer k, 65 in rows along the axis (0: x) on which a stress must be in equilibrium, and one just beyond
// each border with a neighbour: so near that the neighbour's weight does not count, so far that the place is not in the
// layer.
std::vector<Point> places_in(const Scene& scene, std::size_t k, std::size_t axis) {
  const Layer& layer = scene.strata.layers[k];
  const std::size_t stacked = scene.strata.upwards() ? 1 : 0;
  constexpr double beyond = 1e-6;
  const auto at = [&](std::size_t of, double n, double count) {
    const double share = std::clamp((n + 0.5) / count, -beyond, 1.0 + beyond);
    return of == stacked ? layer.from_m + share * (layer.to_m - layer.from_m) : share * scene.domain.extent_m(of);
  };
  constexpr int along = 65, across = 9;
  std::vector<Point> out;
  for (int row = 0; row < across; ++row) {
    for (int n = -1; n <= along; ++n) {
      Point x;
      x[axis] = at(axis, n, along), x[1 - axis] = at(1 - axis, row, across);
      if (x[axis] > 0.0 && x[axis] < scene.domain.extent_m(axis)) out.push_back(x);
    }
  }
  return out;
}

// The worst imbalance of a stress of layer k along an axis; nothing where round-off, or a thousandth of the rock's
// weight for another g, explains it.
std::optional<KeyFault> imbalance(const Scene& scene, std::size_t k, std::size_t axis, const Looked& of) {
  const std::vector<Point> places = places_in(scene, k, axis);
  const std::vector<InSituStress> stress = in_situ_stress(scene, places);
  const double weight = axis == 1 && scene.in_situ.weight
                            ? scene.rocks[scene.strata.layers[k].rock].density_kg_m3 * standard_gravity
                            : 0.0;
  const auto value = axis == 0 ? &InSituStress::horizontal : &InSituStress::vertical;
  double worst = 0.0, slope = 0.0;
  Point at{};
  for (std::size_t n = 0; n < places.size(); ++n) {
    const double here = stress[n].*value;
    if (!std::isfinite(here))
      return KeyFault{of.key,
                      fmt::format("{} is {} at X = {:.6g} m, Y = {:.6g} m. Give a formula that is finite in the block.",
                                  typed(of), here, places[n][0], places[n][1])};
    if (n == 0 || places[n][axis] <= places[n - 1][axis]) continue;
    const double distance = places[n][axis] - places[n - 1][axis], change = (here - stress[n - 1].*value) / distance;
    const double off = std::abs(change + weight) - 1e-3 * weight - 1e-9 * std::abs(here) / distance;
    if (off > worst) worst = off, slope = change, at = places[n];
  }
  if (worst == 0.0) return std::nullopt;
  const std::string advice =
      axis == 0 ? "which nothing balances. Let it depend on Y alone."
      : weight == 0.0
          ? "which nothing balances. For the rock's weight give the stress at the block's top and in_situ.weight = "
            "true."
          : fmt::format("and the rock's weight asks for {:.6g}. Give the stress at the block's top as a number.",
                        -weight);
  return KeyFault{of.key, fmt::format("{} changes by {:.6g} Pa/m along {} at X = {:.6g} m, Y = {:.6g} m, {}", typed(of),
                                      slope, axis == 0 ? "X" : "Y", at[0], at[1], advice)};
}

}  // namespace

std::vector<InSituStress> in_situ_stress(const Scene& scene, const std::vector<Point>& places) {
  const bool upwards = scene.strata.upwards();
  std::vector<double> horizontal = values_of(scene.in_situ.horizontal_Pa, places),
                      vertical = values_of(scene.in_situ.vertical_Pa, places);
  std::vector<char> weighs(places.size(), scene.in_situ.weight && !has_Y(scene.in_situ.vertical_Pa) ? 1 : 0);
  for (std::size_t k = 0; k < scene.strata.layers.size(); ++k) {
    const auto& own = own_stress(scene, scene.strata.layers[k]);
    if (!own) continue;
    const std::vector<double> values = values_of(*own, places);
    const char own_weighs = scene.in_situ.weight && !has_Y(*own) ? 1 : 0;
    for (std::size_t q = 0; q < places.size(); ++q) {
      if (layer_at(scene, places[q]) != k) continue;
      (upwards ? horizontal : vertical)[q] = values[q];
      if (!upwards) weighs[q] = own_weighs;
    }
  }
  std::vector<InSituStress> out;
  for (std::size_t q = 0; q < places.size(); ++q) {
    if (weighs[q] != 0) vertical[q] += standard_gravity * mass_above(scene, places[q]);
    out.push_back({horizontal[q], vertical[q], scene.in_situ.shear_Pa});
  }
  return out;
}

double largest_in_situ(const Scene& scene) {
  std::vector<Point> ends;
  for (const Layer& layer : scene.strata.layers) {
    const double inside = 1e-9 * (layer.to_m - layer.from_m);
    for (const double along : {layer.from_m, layer.to_m - inside}) {
      for (const double share : {0.0, 1.0}) {
        ends.push_back(scene.strata.upwards() ? Point{share * scene.domain.width_m, along}
                                              : Point{along, share * scene.domain.height_m});
      }
    }
  }
  double largest = 0.0;
  for (const InSituStress& s : in_situ_stress(scene, ends))
    largest = std::max({largest, std::abs(s.horizontal), std::abs(s.vertical), std::abs(s.shear)});
  return largest;
}

std::vector<KeyFault> in_situ_faults(const Scene& scene) {
  std::vector<KeyFault> out;
  const InSitu& in_situ = scene.in_situ;
  const bool upwards = scene.strata.upwards();
  const Looked horizontal{"in_situ.horizontal_Pa", in_situ.horizontal_Pa},
      vertical{"in_situ.vertical_Pa", in_situ.vertical_Pa};
  if (in_situ.shear_Pa != 0.0 && scene.domain.bottom == Edge::symmetry)
    out.emplace_back("in_situ.shear_Pa",
                     "in_situ.shear_Pa cannot act on a symmetry line. Use domain.bottom = \"traction\".");
  if (in_situ.initialise == InSitu::Initialise::loaded) {
    for (const Looked& of : {horizontal, vertical}) {
      if (!of.field.formula.empty())
        out.emplace_back(of.key, typed(of) +
                                     ": edges are loaded by one stress each. Give a number, or stresses by layer, "
                                     "or use initialise = \"uniform\".");
    }
  }
  const std::string own_key = upwards ? "horizontal" : "vertical", other_key = upwards ? "vertical" : "horizontal";
  bool said[2] = {false, false};  // of the stress of all layers
  for (std::size_t k = 0; k < scene.strata.layers.size(); ++k) {
    const Layer& layer = scene.strata.layers[k];
    const std::string path = fmt::format("strata.layers[{}].", k);
    if (upwards ? layer.vertical_Pa.has_value() : layer.horizontal_Pa.has_value())
      out.emplace_back(
          path + other_key + "_Pa",
          fmt::format("{0}{1}_Pa: neighbours press on each other with one {1} stress. Give {2}_Pa here and "
                      "in_situ.{1}_Pa for all.",
                      path, other_key, own_key));
    for (const std::size_t axis : {0UL, 1UL}) {
      const bool is_own = (axis == 0) == upwards && own_stress(scene, layer);
      if (!is_own && said[axis]) continue;
      const Looked of = is_own      ? Looked{path + own_key + "_Pa", *own_stress(scene, layer)}
                        : axis == 0 ? horizontal
                                    : vertical;
      const auto fault = imbalance(scene, k, axis, of);
      if (fault) out.push_back(*fault);
      said[axis] = said[axis] || (fault && !is_own);
    }
  }
  return out;
}

}  // namespace strata
