#include "layered_height.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "griffith.hpp"

namespace strata::reference {
namespace {

// s + w y over the crack, by places from its middle, with both values at a border.
PressureKnots stress_along(const StressLayers& layers, const CrackEnds& crack) {
  PressureKnots knots;
  const double middle = 0.5 * (crack.bottom + crack.top), slope = layers.stress_slope + layers.fluid_weight;
  const auto add = [&](double y, std::size_t layer) {
    knots.x.push_back(y - middle);
    knots.p.push_back(layers.stress[layer] + slope * y);
  };
  for (std::size_t k = 0; k < layers.stress.size(); ++k) {
    const double from = k == 0 ? crack.bottom : std::max(crack.bottom, layers.border[k - 1]);
    const double to = k == layers.border.size() ? crack.top : std::min(crack.top, layers.border[k]);
    if (from < to) add(from, k), add(to, k);
  }
  return knots;
}

// The layer that a tip breaks next.
std::size_t layer_beyond(const StressLayers& layers, double y, bool up) {
  const auto& border = layers.border;
  const auto at =
      up ? std::upper_bound(border.begin(), border.end(), y) : std::lower_bound(border.begin(), border.end(), y);
  return static_cast<std::size_t>(at - border.begin());
}

// How far a tip may go in one piece: to the next border or limit, and no more than 1/200 of the height.
double stop_of(const StressLayers& layers, const CrackEnds& crack, const CrackEnds& limits, bool up) {
  const double piece = (crack.top - crack.bottom) / 200.0;
  const std::size_t layer = layer_beyond(layers, up ? crack.top : crack.bottom, up);
  if (up) {
    const double end = std::min(crack.top + piece, limits.top);
    return layer < layers.border.size() ? std::min(end, layers.border[layer]) : end;
  }
  const double end = std::max(crack.bottom - piece, limits.bottom);
  return layer > 0 ? std::max(end, layers.border[layer - 1]) : end;
}

}  // namespace

void StressLayers::validate() const {
  if (stress.empty() || toughness.size() != stress.size() || border.size() + 1 != stress.size())
    throw std::invalid_argument("layers need a stress and a toughness each, and a border between each two");
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::ranges::all_of(border, finite) || !std::ranges::all_of(stress, finite) ||
      !std::ranges::all_of(toughness, finite) || !finite(stress_slope) || !finite(fluid_weight))
    throw std::invalid_argument("a number of the layers is not finite");
  if (std::ranges::adjacent_find(border, std::ranges::greater_equal{}) != border.end())
    throw std::invalid_argument("borders between layers must ascend");
  if (std::ranges::any_of(toughness, [](double K) { return K < 0.0; }))
    throw std::invalid_argument("a toughness is negative");
}

CriticalPressures critical_pressures(const StressLayers& layers, const CrackEnds& crack) {
  layers.validate();
  if (!(crack.bottom < crack.top)) throw std::invalid_argument("the crack's bottom must be below its top");
  const double a = 0.5 * (crack.top - crack.bottom), root = std::sqrt(std::numbers::pi * a);
  const TipIntensities S = LinearlyPressurisedCrack(a, 1.0, stress_along(layers, crack)).K_I();
  return {(layers.toughness[layer_beyond(layers, crack.bottom, false)] + S.minus) / root,
          (layers.toughness[layer_beyond(layers, crack.top, true)] + S.plus) / root};
}

CrackEnds grown_to_rest(const StressLayers& layers, const CrackEnds& start, double pressure, const CrackEnds& limits) {
  if (!(limits.bottom <= start.bottom && start.top <= limits.top))
    throw std::invalid_argument("the limits must enclose the crack");
  CrackEnds crack = start;
  const auto needed = [&](const CrackEnds& ends, bool up) {
    const CriticalPressures critical = critical_pressures(layers, ends);
    return up ? critical.top : critical.bottom;
  };
  for (;;) {
    const bool top_may = crack.top<limits.top, bottom_may = crack.bottom> limits.bottom;
    if (!top_may && !bottom_may) return crack;
    const CriticalPressures critical = critical_pressures(layers, crack);
    const bool up = top_may && (!bottom_may || critical.top <= critical.bottom);
    if ((up ? critical.top : critical.bottom) > pressure) return crack;
    const double from = up ? crack.top : crack.bottom, stop = stop_of(layers, crack, limits, up);
    double& tip = up ? crack.top : crack.bottom;
    tip = stop;
    if (needed(crack, up) <= pressure) continue;
    // It comes to rest on the way, or at a border whose far side holds it.
    double moving = from, resting = stop;
    for (int k = 0; k < 60; ++k) {
      tip = 0.5 * (moving + resting);
      (needed(crack, up) <= pressure ? moving : resting) = tip;
    }
    tip = resting;
  }
}

double pressure_to_pass(const StressLayers& layers, const CrackEnds& start, double height, const CrackEnds& limits) {
  if (!(height > start.top && height < limits.top))
    throw std::invalid_argument("the height must lie above the crack and within the limits");
  const auto passes = [&](double pressure) { return grown_to_rest(layers, start, pressure, limits).top > height; };
  const double scale = std::max(1.0, std::abs(critical_pressures(layers, start).top));
  double low = critical_pressures(layers, start).bottom, high = low, step = scale;
  while (passes(low)) low -= step, step *= 2.0;
  for (step = scale; !passes(high); step *= 2.0) high += step;
  while (high - low > 1e-13 * std::max(std::abs(high), scale)) {
    const double middle = 0.5 * (low + high);
    if (middle <= low || middle >= high) break;
    (passes(middle) ? high : low) = middle;
  }
  return high;
}

}  // namespace strata::reference
