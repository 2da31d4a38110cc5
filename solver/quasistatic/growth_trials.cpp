#include "quasistatic/growth_trials.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "fracture/growth.hpp"

namespace strata {
namespace {

// How many points the trial's fracture has before those of the state's own.
std::ptrdiff_t shift_of(const State& state, const GrowthTrial& trial) {
  if (state.tips[trial.tip].at_back) return 0;
  return std::ssize(trial.state.fracture().points) - std::ssize(state.fracture().points);
}

// The trial's load: the state's own and, on a new segment, the pressure of the tip (it is wetted).
void load_trial(const Fluid& fluid, const State& state, GrowthTrial& trial) {
  auto& tried = trial.state.fracture().points;
  const auto& points = state.fracture().points;
  const std::ptrdiff_t shift = shift_of(state, trial);
  const Tip& tip = state.tips[trial.tip];
  const double tip_P = tip.at_back ? state.fluid.P.back() : state.fluid.P.front(), tip_y = tip_position(state, tip).y();
  for (std::ptrdiff_t q = 0; q < std::ssize(tried); ++q) {
    const std::ptrdiff_t own = q - shift;
    const bool old = own >= 0 && own < std::ssize(points);
    SurfacePoint& s = tried[static_cast<std::size_t>(q)];
    s.P = old ? points[static_cast<std::size_t>(own)].P : fluid.at_rest(tip_P, s.x.y() - tip_y);
  }
}

// Friction's memory of the trial: that of the state it starts from.
void inherit_friction(const State& state, const Places& places, GrowthTrial& trial) {
  const std::ptrdiff_t shift = shift_of(state, trial);
  for (ContactPlace& place : trial.model.places) {
    if (place.tie >= 0) continue;
    const auto same = std::find_if(places.begin(), places.end(), [&](const ContactPlace& other) {
      const auto at = static_cast<std::ptrdiff_t>(other.point) + (other.surface == 0 ? shift : 0);
      return other.tie < 0 && other.surface == place.surface && at == static_cast<std::ptrdiff_t>(place.point);
    });
    if (same == places.end()) continue;
    place.start = same->start;
  }
}

// Makes the fracture of a trial longer or shorter; false where there is not a whole piece to take away.
bool change_length(const Scene& scene, double length, GrowthTrial& trial) {
  Tip& tip = trial.state.tips[trial.tip];
  trial.length = length > 0.0 ? extend_tip(scene, trial.state, tip, length) : -shorten_tip(trial.state, tip, -length);
  return trial.length != 0.0;
}

// The jumps of what parts begin where its neighbours' parting has brought them.
void begin_parting(const State& state, const QuasistaticModel& model, const Equilibrium& equilibrium,
                   GrowthTrial& trial) {
  for (ContactPlace& place : trial.model.places) {
    if (place.tie >= 0 || state.surfaces[place.surface].points[place.point].split) continue;
    if (place.surface > 0 || !state.has_fracture)
      place.bonded = jump_at(model.condensed, state.point_stencils[place.surface][place.point], equilibrium.j);
  }
}

// The tip nearest to a place (m).
std::size_t nearest_tip(const State& state, const Vec2& x) {
  const auto far = [&](const Tip& tip) { return (tip_position(state, tip) - x).norm(); };
  return static_cast<std::size_t>(std::ranges::min_element(state.tips, {}, far) - state.tips.begin());
}

double energy_of(const QuasistaticModel& model, const Equilibrium& equilibrium) {
  return equilibrium.energy + dissipated_by_friction(model, equilibrium);
}

}  // namespace

bool may_grow(const Scene& scene, const State& state, const Tip& tip) {
  return scene.fracture->growth != Fracture::Growth::none && tip.growing && what_stops(scene, state, tip).empty();
}

std::vector<GrowthTrial> build_trials(const Scene& scene, const Rocks& rocks, State& state,
                                      const QuasistaticModel& model, bool halve) {
  std::vector<GrowthTrial> trials;
  const auto begin = [&](std::size_t tip) -> GrowthTrial& {
    GrowthTrial& trial = trials.emplace_back();
    trial.tip = tip;
    static_cast<SavedState&>(trial.state) = state;
    return trial;
  };
  const auto prepare = [&](GrowthTrial& trial) {
    trial.turn = state.tips[trial.tip].turn;
    trial.model.body = model.body;
    trial.model.condensed = model.condensed;
    update_equations(scene, rocks, trial.state, trial.model, halve);
    if (!scene.body.acceleration_m_s2) trial.state.particles = {}, trial.state.bins = {};  // they have said all
  };
  for (std::size_t k = 0; k < state.tips.size(); ++k) {
    Tip& tip = state.tips[k];
    if (!may_grow(scene, state, tip)) continue;
    tip.criterion = criterion_of(scene, state, tip);
    std::vector<double> lengths;
    if (tip.criterion == Criterion::energy) lengths = {increment_of(scene, tip)};
    if (tip.criterion == Criterion::slope)
      lengths = {state.grid.h, -std::min(state.grid.h, past_open_interface(scene, state, tip))};
    for (const double length : lengths) {
      GrowthTrial& trial = begin(k);
      if (change_length(scene, length, trial)) {
        prepare(trial);
      } else {
        trials.pop_back();
      }
    }
  }
  for (Parting& parting : next_partings(scene, rocks, state, model.bonds)) {
    GrowthTrial& trial = begin(nearest_tip(state, parting.from[0]));
    trial.length = parting.length;
    for (const auto& [surface, column] : parting.columns) {
      for (SurfacePoint& s : trial.state.surfaces[surface].points)
        s.split = s.split || (s.column == column && (s.sides & parting.mask) == parting.sides);
    }
    trial.parting = std::move(parting);
    prepare(trial);
  }
  return trials;
}

double energy_release(const Scene& scene, const State& state, const QuasistaticModel& model,
                      const Equilibrium& equilibrium, GrowthTrial& trial) {
  load_trial(scene.fluid, state, trial);
  inherit_friction(state, model.places, trial);
  if (trial.parts()) begin_parting(state, model, equilibrium, trial);
  const double there = energy_of(trial.model, find_equilibrium(scene, state.time, trial.state, trial.model));
  return (energy_of(model, equilibrium) - there) / trial.length;
}

double energy_release(const Scene& scene, const State& state, const QuasistaticModel& model,
                      const Equilibrium& equilibrium, std::size_t tip, std::vector<GrowthTrial>& trials) {
  double sum = 0.0, weights = 0.0;  // of two trials each counts by the other's length
  for (GrowthTrial& trial : trials) {
    if (trial.tip != tip || trial.parts()) continue;
    const double G = energy_release(scene, state, model, equilibrium, trial);
    sum += G / std::abs(trial.length), weights += 1.0 / std::abs(trial.length);
  }
  return weights > 0.0 ? sum / weights : 0.0;
}

bool trials_hold(const Scene& scene, const State& state, const std::vector<GrowthTrial>& trials) {
  return scene.fracture->direction != Fracture::Direction::max_hoop ||
         std::ranges::all_of(trials, [&](const GrowthTrial& trial) {
           return std::abs(trial.turn - state.tips[trial.tip].turn) <= 1e-12;
         });
}

}  // namespace strata
