#include "quasistatic/resting_rock.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "fracture/growth.hpp"
#include "quasistatic/growth_trials.hpp"

namespace strata {
namespace {

// The rock of a run with inertia as it would be at rest. All of it follows from the state.
struct RestingRock {
  Scene scene;  // the run's, without inertia
  State state;
  QuasistaticModel model;
  std::vector<GrowthTrial> trials;
  std::vector<double> P;      // of the fracture's points when it was last looked at (Pa)
  double nearest = 0.0;       // sqrt(G/J_c) of the tip nearest to growth then
  bool without_rest = false;  // there is no equilibrium
};

using Resting = std::unique_ptr<RestingRock>;  // made where it is first needed

std::ptrdiff_t split_points(const State& state) {
  std::ptrdiff_t n = 0;
  for (const Surface& surface : state.surfaces)
    n += std::ranges::count_if(surface.points, [](const SurfacePoint& s) { return s.split; });
  return n;
}

// The same particles without inertia.
Scene without_inertia(const Scene& scene) {
  Scene resting = scene;
  resting.numerics.mechanics = Numerics::Mechanics::quasistatic;
  resting.numerics.particles_per_cell = 16;
  // uGIMP particles weigh as points do where they have not moved.
  if (scene.numerics.shape == Numerics::Shape::gimp) resting.numerics.shape = Numerics::Shape::linear;
  return resting;
}

// Splits particles beside what tips would grow by, in the state itself: then the trials' stiffness is its own.
void refine_beside_growth(const Scene& scene, State& state) {
  for (std::size_t k = 0; k < state.tips.size(); ++k) {
    if (!weighs_energy(state.tips[k]) || !may_grow(scene, state, state.tips[k])) continue;
    State longer = state;
    extend_tip(scene, longer, longer.tips[k], increment_of(scene, state.tips[k]));
    const std::size_t old = state.fracture().points.size(), all = longer.fracture().points.size();
    const bool at_back = state.tips[k].at_back;
    const Surface own = std::exchange(state.fracture(), longer.fracture());
    refine_particles(scene, state, at_back ? old : 0, at_back ? all : all - old);
    state.fracture() = own;
  }
}

// Equations and trials of resting.state, which is that of the run. What holds of those of `before` (or none), of the
// same particles in the same places, is taken over, and the rest let go: two are not to be held at a time.
void build_resting_rock(const Scene& scene, const Rocks& rocks, Resting before, RestingRock& resting) {
  resting.scene = without_inertia(scene);
  State& own = resting.state;
  own.total = {};
  own.bonds = {};
  own.dt = 1.0;  // J's inertia divides by it; there is none
  refine_beside_growth(resting.scene, own);
  if (before && before->state.particles.x == own.particles.x && before->state.particles.y == own.particles.y)
    resting.model = std::move(before->model);
  before.reset();
  update_equations(resting.scene, rocks, own, resting.model, false);
  resting.trials = build_trials(resting.scene, rocks, own, resting.model, false);
}

// Takes over what the run's surfaces bear now, and what friction remembers of it.
void follow(const State& state, RestingRock& resting) {
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    auto& own = resting.state.surfaces[k].points;
    for (std::size_t q = 0; q < own.size(); ++q) {
      own[q].P = state.surfaces[k].points[q].P;
      own[q].w = state.surfaces[k].points[q].w, own[q].reaction = state.surfaces[k].points[q].reaction;
    }
  }
  for (ContactPlace& place : resting.model.places) {
    if (place.tie < 0) place.start = start_of(state.surfaces[place.surface].points[place.point]);
  }
  resting.state.fluid = state.fluid;
  resting.state.time = state.time;
  resting.state.tips = state.tips;
}

// Whether the pressures have come far enough since the last look.
bool is_due(const State& state, const RestingRock& resting) {
  // G goes about as the square of the net pressure: a restart comes within 0.2 % of it, and what frees a part of the
  // fracture on the way is seen after 10 % at most.
  constexpr double least = 2e-3, most = 0.1, of_the_rest = 1.0 / 3.0;
  if (resting.P.empty() || resting.scene.body.acceleration_m_s2) return true;
  double change = 0.0, net = 0.0;
  const auto& points = state.fracture().points;
  for (std::size_t q = 0; q < points.size(); ++q) {
    change = std::max(change, std::abs(points[q].P - resting.P[q]));
    net = std::max(net, std::abs(points[q].P - points[q].closing_stress()));
  }
  const double missing = resting.nearest > 0.0 ? std::max(0.0, 1.0 / resting.nearest - 1.0) : 1.0;
  return change >= std::clamp(of_the_rest * missing, least, most) * net && change > 0.0;
}

// Whether something could be done with the rock at rest: inertia holds what has no equilibrium.
template <class Do>
bool finds_rest(Do something, RestingRock& resting) {
  try {
    something();
  } catch (const NumericalFailure&) {
    resting.without_rest = true;
  }
  return !resting.without_rest;
}

// G of the tips that energy decides about, at the present pressures.
void weigh(const Scene& scene, const Rocks& rocks, State& state, RestingRock& resting) {
  follow(state, resting);
  if (!trials_hold(scene, resting.state, resting.trials))
    resting.trials = build_trials(resting.scene, rocks, resting.state, resting.model, false);
  const Equilibrium rest = find_equilibrium(resting.scene, state.time, resting.state, resting.model);
  resting.nearest = 0.0;
  for (std::size_t k = 0; k < state.tips.size(); ++k) {
    Tip& tip = state.tips[k];
    if (!weighs_energy(tip)) continue;
    tip.G_trial = energy_release(resting.scene, resting.state, resting.model, rest, k, resting.trials);
    const double J_c = rocks[rock_ahead(scene, state, tip)].J_c;
    if (J_c > 0.0) resting.nearest = std::max(resting.nearest, std::sqrt(std::max(0.0, tip.G_trial) / J_c));
  }
}

void weigh_growth(const Scene& scene, const Rocks& rocks, State& state, Resting& resting) {
  for (Tip& tip : state.tips) {
    tip.criterion = criterion_of(scene, state, tip);
    if (weighs_energy(tip)) stop_at_edge(scene, state, tip);
    if (!weighs_energy(tip)) tip.G_trial = 0.0;
  }
  const auto weighed = [&](const Tip& tip) { return weighs_energy(tip) && tip.growing; };
  if (std::ranges::none_of(state.tips, weighed)) return resting.reset();
  const auto same = [&](const State& other) {
    return other.fracture().points.size() == state.fracture().points.size() &&
           split_points(other) == split_points(state) &&
           std::ranges::equal(other.tips, state.tips, {}, &Tip::criterion, &Tip::criterion);
  };
  if (!resting || !same(resting->state)) {
    Resting before = std::exchange(resting, std::make_unique<RestingRock>());
    resting->state = state;
    const auto make = [&] { build_resting_rock(scene, rocks, std::move(before), *resting); };
    if (!finds_rest(make, *resting)) ++state.monitors.growth_unweighed;
  }
  if (!resting->without_rest && is_due(state, *resting)) {
    if (!finds_rest([&] { weigh(scene, rocks, state, *resting); }, *resting)) ++state.monitors.growth_unweighed;
    resting->P.clear();
    for (const SurfacePoint& s : state.fracture().points) resting->P.push_back(s.P);
  }
  for (Tip& tip : state.tips) {
    if (resting->without_rest && weighs_energy(tip)) tip.criterion = Criterion::K;
  }
}

}  // namespace

std::function<void(State&)> growth_weighing(const Scene& scene, const Rocks& rocks) {
  return [&scene, &rocks, resting = std::make_shared<Resting>()](State& state) {
    weigh_growth(scene, rocks, state, *resting);
  };
}

}  // namespace strata
