#include "output/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>
#include <numeric>

namespace strata {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
const TipNumbers no_numbers{nan, nan, nan, nan, nan, ""};

}  // namespace

const char* name_of(Obstacle what) {
  constexpr const char* names[] = {"", "interface", "rock border", "symmetry line", "edge", "fracture"};
  return names[static_cast<std::size_t>(what)];
}

TipNumbers tip_numbers(const Scene& scene, const Tip& tip) {
  TipNumbers told{tip.K_I, tip.K_II, tip.J, tip.J_spread, tip.kink * (180.0 / std::numbers::pi), ""};
  const bool shut = tip.closed && tip.J == 0.0;  // whatever is near
  if (tip.crossed && !shut) {
    constexpr const char* crossed[] = {"",
                                       "an interface whose faces have come apart",
                                       "another rock",
                                       "the symmetry line",
                                       "an edge of the block",
                                       "another part of the fracture"};
    told = no_numbers;
    told.reason = tip.no_length
                      ? "the tip stands on an interface whose faces have come apart: it has no length in the rock ahead"
                      : std::string("the rings on which J and K are measured cross ") +
                            crossed[static_cast<std::size_t>(tip.near)];
  } else if (tip.closed) {
    told.kink_deg = nan;
    told.reason = "the tip is closed: it has no direction to open into";
  } else if (tip.near == Obstacle::interface) {
    told.J_N_m = told.J_spread = nan;
    told.reason = "the rings on which J is measured reach over an interface whose faces have come apart";
  } else if (tip.J < 0.0 && scene.numerics.mechanics == Numerics::Mechanics::quasistatic) {
    told.J_N_m = told.J_spread = nan;
    told.reason =
        "J comes out below 0, which no tip at rest has: cells are too coarse for what the pressure does there";
  }
  return told;
}

const Tip* leading_tip(const State& state) {
  if (!state.has_fracture || state.tips.empty()) return nullptr;
  return &*std::ranges::max_element(state.tips, {}, [&](const Tip& tip) { return tip_position(state, tip).y(); });
}

const Tip* lower_tip(const State& state) {
  const Tip* leading = leading_tip(state);
  if (leading == nullptr || state.tips.size() < 2) return nullptr;
  return leading == &state.tips.front() ? &state.tips.back() : &state.tips.front();
}

double mouth_opening(const State& state) {
  if (!state.has_fracture) return 0.0;
  const auto& v = state.fracture().vertices;
  for (const SurfacePoint* end : {&v.front(), &v.back()}) {
    // Vertices follow the rock: one that started on the line may be off it by round-off.
    if (std::abs(end->x.y()) < 1e-6 * state.grid.h) return end->opening();
  }
  return std::ranges::max(v, {}, &SurfacePoint::opening).opening();
}

double fracture_volume(const State& state) {
  if (!state.has_fracture) return 0.0;
  double volume = 0.0;
  for (const SurfacePoint& s : state.fracture().points) volume += s.A * s.opening();
  return volume;
}

double leaked_volume(const State& state) {
  return std::accumulate(state.reynolds.leaked.begin(), state.reynolds.leaked.end(), 0.0);
}

namespace {

TipNumbers numbers_of(const Scene& scene, const Tip* tip) {
  return tip ? tip_numbers(scene, *tip) : no_numbers;
}

Vec2 place_of(const State& state, const Tip* tip) {
  return tip ? tip_position(state, *tip) : Vec2{nan, nan};
}

double crossing(const Tip* tip) {
  return tip && weighs_energy(*tip) ? tip->G_trial : nan;
}

// Whether the fracture of a scene lies within the block, where it has two tips. Columns go by the scene: the header is
// written before there is a state.
bool has_two_tips(const Scene& scene) {
  if (!scene.fracture || scene.fracture->path_m.empty()) return false;
  return scene.domain.bottom != Edge::symmetry || scene.fracture->path_m.front()[1] != 0.0;
}

// Of the lower one of two tips, in every run those that all have had, and the rest where there are two.
void add_lower_tip(const Scene& scene, const State& state, std::vector<HistoryColumn>& all) {
  const Tip* lower = lower_tip(state);
  const TipNumbers told = numbers_of(scene, lower);
  const Vec2 x = place_of(state, lower);
  all.insert(all.end(), {{"lower_tip_y_m", "m", x.y(), "place of the lower one of two tips: y"},
                         {"lower_tip_K_I_Pa_sqrt_m", "Pa m^0.5", told.K_I_Pa_sqrt_m,
                          "K_I of the lower tip, from the interaction integral"},
                         {"lower_tip_K_II_Pa_sqrt_m", "Pa m^0.5", told.K_II_Pa_sqrt_m,
                          "K_II of the lower tip, from the interaction integral"}});
  if (!has_two_tips(scene)) return;
  all.insert(all.end(), {{"lower_tip_x_m", "m", x.x(), "place of the lower tip: x"},
                         {"lower_tip_J_N_m", "N/m", told.J_N_m, "J of the lower tip, from its domain integral"},
                         {"lower_tip_G_N_m", "N/m", lower ? lower->G : nan,
                          "energy released per length over the lower tip's next finite increment"},
                         {"lower_tip_near", "1", lower ? static_cast<double>(lower->near) : nan,
                          "what is too near to the lower tip, as in near"}});
  if (scene.parts_by_energy()) {
    all.push_back({"lower_tip_G_crossing_N_m", "N/m", crossing(lower), "G_crossing_N_m of the lower tip"});
    all.push_back({"lower_tip_G_along_N_m", "N/m", lower ? lower->G_along : nan, "G_along_N_m of the lower tip"});
  }
}

}  // namespace

// Those that the first versions had come first, so that files of all can be laid side by side.
std::vector<HistoryColumn> history_columns(const Scene& scene, const State& state) {
  const Tip* tip = leading_tip(state);
  const Vec2 x = place_of(state, tip);
  const TipNumbers told = numbers_of(scene, tip);
  std::vector<HistoryColumn> all{
      {"time_s", "s", state.time, "time"},
      {"inlet_Pa", "Pa", state.has_fracture ? state.fluid.inlet_Pa : 0.0, "fluid pressure at the inlet"},
      {"tip_x_m", "m", x.x(), "place of the leading tip, the one with the largest y: x"},
      {"tip_y_m", "m", x.y(), "place of the leading tip: y"},
      {"height_m", "m", x.y(), "height of the leading tip above the symmetry line y = 0"},
      {"J_N_m", "N/m", told.J_N_m, "J of the leading tip, from its domain integral"},
      {"K_I_Pa_sqrt_m", "Pa m^0.5", told.K_I_Pa_sqrt_m, "K_I of the leading tip, from the interaction integral"},
      {"K_II_Pa_sqrt_m", "Pa m^0.5", told.K_II_Pa_sqrt_m, "K_II of the leading tip, from the interaction integral"},
      {"mouth_opening_m", "m", mouth_opening(state),
       "opening face to face at the symmetry line, or the largest where the fracture does not reach it"},
      {"fracture_volume_m2", "m^2", fracture_volume(state), "area between the faces in the modelled domain"},
  };
  const auto add_energies = [&](bool first) {
    for (const auto& [name, value, description] : ledger_energies) {
      const bool later = value == &Ledger::body_work || value == &Ledger::initial_kinetic;
      if (first != later) all.push_back({name + std::string("_J"), "J/m", state.ledger.*value, description});
    }
  };
  add_energies(true);
  all.insert(
      all.end(),
      {{"energy_closure", "1", state.ledger.closure(),
        "share of the largest energy that the ledger leaves unexplained"},
       {"J_spread", "1", told.J_spread, "(max - min)/mean of J over its rings"},
       {"kink_deg", "deg", told.kink_deg, "next growth direction from the present one, counter-clockwise positive"},
       {"at_interface", "1", tip ? at_interface(*tip) : nan,
        "1 where an interface or a border of rocks is too near for J and K, else 0"},
       {"ring_m", "m", tip ? tip->ring_m : nan, "outer radius of the widest ring on which J is measured"},
       {"G_N_m", "N/m", tip ? tip->G : nan, "energy released per length over the next finite increment"},
       {"G_by_J_N_m", "N/m", tip ? tip->G_by_J : nan, "the same from J along the increment"},
       {"fluid_volume_balance", "1", state.monitors.volume_balance, "reynolds: fluid missing over fluid injected"}});
  add_energies(false);
  all.push_back({"near", "1", tip ? static_cast<double>(tip->near) : nan,
                 "what is too near to the leading tip: 0 nothing, 1 interface, 2 rock border, 3 symmetry line, 4 edge, "
                 "5 fracture"});
  if (scene.leaks()) all.push_back({"leaked_m2", "m^2", leaked_volume(state), "fluid that the rock has taken"});
  if (scene.parts_by_energy()) {
    all.push_back({"G_crossing_N_m", "N/m", crossing(tip),
                   "energy released per length by going on across, over crossing_increment_m"});
    all.push_back({"G_along_N_m", "N/m", tip ? tip->G_along : nan,
                   "energy released per length by parting the interface, over crossing_increment_m"});
  }
  add_lower_tip(scene, state, all);
  return all;
}

HistoryRow history_row(const Scene& scene, const State& state) {
  HistoryRow row;
  for (const HistoryColumn& column : history_columns(scene, state)) row.push_back(column.value);
  return row;
}

std::string history_header(const std::vector<HistoryColumn>& columns) {
  std::string line;
  for (const HistoryColumn& column : columns) line += (line.empty() ? "" : ",") + column.name;
  return line + '\n';
}

std::string history_line(const HistoryRow& row) {
  fmt::memory_buffer line;
  for (const double value : row) {
    if (line.size() > 0) line.push_back(',');
    fmt::format_to(std::back_inserter(line), "{}", std::isnan(value) ? nan : value);  // nan has no sign in the file
  }
  line.push_back('\n');
  return fmt::to_string(line);
}

}  // namespace strata
