#include "quasistatic/load_steps.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "flow/flow_monitors.hpp"
#include "flow/paper_flow.hpp"
#include "fracture/growth.hpp"
#include "interfaces/failure.hpp"
#include "interfaces/monitors.hpp"
#include "quasistatic/event_margin.hpp"
#include "quasistatic/fluid_step.hpp"
#include "quasistatic/load_point.hpp"

namespace strata {
namespace {

constexpr double event_tolerance = 1e-4;  // of an event's margin: 0.01 % in K
constexpr double first_flow_step = 1e-3;  // s, after each event; steps then grow as the margin's change allows

// A trial step shorter than this (s) that is not found ends the run, and one that is found is taken however rough it
// is. Of flow and rock in one system a step is of shortest_coupled_step at least, whatever is tried.
constexpr double shortest_trial = 1e-7;

// Equilibrium at the state's pressures and its fields.
void come_to_rest(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  run.equilibrium = find_equilibrium(scene, state.time, state, run.model);
  set_fields(scene, state, run.model, run.equilibrium);
  measure_tips(scene, rocks, run.rules, state);
}

// The same, and how near the next event is.
void equilibrate(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  come_to_rest(scene, rocks, state, run);
  if (!trials_hold(scene, state, run.trials)) run.trials = build_trials(scene, rocks, state, run.model);
  run.margin = margin_of(scene, rocks, state, run);
}

// Energy bookkeeping of an accepted change of load or geometry; surface: what new surface takes (J/m).
enum class Change { load, growth, failure };

void close_ledger(const Quasistatic& run, const LoadPoint& before, Change change, double surface, State& state) {
  Ledger& ledger = state.ledger;
  double in_situ = 0.0;
  const double fluid = work_of_loads(state, before, change == Change::load, in_situ);
  const double stored = ledger.strain + ledger.interface_strain, body = work_of_body(state, before);
  ledger.fluid_work += fluid;
  ledger.in_situ_work += in_situ;
  ledger.body_work += body;
  ledger.strain = run.equilibrium.strain;
  ledger.interface_strain = stored_in_surfaces(run.model, run.equilibrium);
  const double released = fluid + in_situ + body - (ledger.strain + ledger.interface_strain - stored);
  const double friction = dissipated_by_friction(run.model, run.equilibrium, change == Change::load);
  ledger.friction += friction;
  if (change == Change::failure) ledger.failure += released - friction;
  if (change == Change::growth) ledger.excess += released - friction - surface;
  ledger.fracture += surface;
  ledger.note_scale();
  require_finite(state);
}

void accept(const Scene& scene, const LoadPoint& before, Change change, State& state, Quasistatic& run,
            double surface = 0.0) {
  close_ledger(run, before, change, surface, state);
  remember(state, run.model, run.equilibrium);
  Monitors& monitors = state.monitors;
  monitors.contact_sweeps += run.equilibrium.iterations;
  note_largest(monitors.contact_residual, run.equilibrium.residual);
  note_largest(monitors.largest_imbalance, std::abs(monitors.volume_balance));
  monitors.delivered_m2 += (state.time - before.time) * inflow(scene, state);
  if (change == Change::load) watch_flow(scene, state);
  watch_tips(scene, state);
  ++state.step;
  watch_row(scene, state);
}

void rebuild_all(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  const double excess = state.ledger.excess;
  run.trials.clear();  // two bodies are not to be held at a time
  update_model(scene, rocks, state, run.model);
  state.monitors.mirror = run.model.body->halved;
  run.rules = make_tip_rules(scene, rocks, state);
  state.ledger.excess = excess;  // what springs of tips give back is in the difference of stored energy already
  run.trials = build_trials(scene, rocks, state, run.model);
}

// Lets what fails or parts go; where half a block answers for the whole, with its mirror image, which is as bad but for
// round-off.
void let_columns_go(Columns columns, const Quasistatic& run, State& state, SideWord mask = 0, SideWord sides = 0) {
  if (run.model.body->halved) {
    for (const auto& [surface, column] : Columns{columns}) columns.emplace(surface, state.grid.nx - column);
  }
  let_go(columns, run.model.bonds, state, mask, sides);
  for (const BondedPlace& place : run.model.bonds.places) {
    SurfacePoint& s = state.surfaces[place.surface].points[place.point];
    if (s.split)
      s.bonded = jump_at(run.model.condensed, state.point_stencils[place.surface][place.point], run.equilibrium.j);
  }
}

// A tip that grows: J and pressure that it had.
struct Growing {
  std::size_t tip = 0;
  double increment = 0.0;  // m
  double J = 0.0;          // N/m
  double P = 0.0;          // Pa
  double J_c = 0.0;        // of the rock ahead (N/m)
  double last_s = 0.0;     // time of the growth before
};

std::vector<Growing> tips_that_grow(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  std::vector<Growing> due;
  for (std::size_t k = 0; k < state.tips.size(); ++k) {
    Tip& tip = state.tips[k];
    if (!may_grow(scene, state, tip) || tip_margin(scene, rocks, state, run, k) < 1.0) continue;
    due.push_back({k, increment_of(scene, tip), tip.J, tip.at_back ? state.fluid.P.back() : state.fluid.P.front(),
                   rocks[rock_ahead(scene, state, tip)].J_c, std::max(0.0, tip.last_growth_s)});
  }
  return due;
}

void lengthen(const Scene& scene, std::vector<Growing>& growing, State& state) {
  for (Growing& g : growing) {
    Tip& tip = state.tips[g.tip];
    const std::size_t points = state.fracture().points.size();
    const double y = tip_position(state, tip).y();
    note_growth(state, tip);
    g.increment = extend_tip(scene, state, tip, g.increment);
    const std::size_t added = state.fracture().points.size() - points;
    add_fluid_cells(scene, tip.at_back, added, state);
    auto& all = state.fracture().points;
    for (std::size_t q = 0; q < added; ++q) {
      SurfacePoint& s = all[tip.at_back ? points + q : q];
      s.P = scene.fluid.at_rest(g.P, s.x.y() - y);  // wetted, to measure the release
    }
  }
}

// Two measures of what growth has released, independent of each other: the difference of potential energy over the
// increment, and the mean of J over it (K linear between its ends, the new segment under the pressure that the tip
// had). Where the tip all but closes on the way, under a pressure that falls off towards it, two values do not tell the
// mean.
void measure_release(const Scene& scene, const Rocks& rocks, double energy_before, const std::vector<Growing>& growing,
                     State& state, Quasistatic& run) {
  come_to_rest(scene, rocks, state, run);
  const double energy = run.equilibrium.energy + dissipated_by_friction(run.model, run.equilibrium);
  double length = 0.0;
  for (const Growing& g : growing) length += g.increment;
  for (const Growing& g : growing) {
    constexpr double least_J = 0.25;  // of J before: K halved
    Tip& tip = state.tips[g.tip];
    tip.G = (energy_before - energy) / length;
    tip.G_by_J = tip.K_I > 0.0 && tip.J > least_J * g.J ? (g.J + std::sqrt(g.J * tip.J) + tip.J) / 3.0 : 0.0;
  }
}

[[noreturn]] void throw_no_solution(const char* when, double time, const std::string& reason) {
  throw NumericalFailure(fmt::format("at t = {:.6g} s, {}: {}", time, when, reason));
}

// Whether a failure by strength that is due goes before what energy decides: all margins are shares of the load that
// each takes.
bool failure_goes_first(const Scene& scene, const Quasistatic& run) {
  const bool by_margin = scene.fracture && scene.fracture->order == Fracture::Order::larger_margin;
  const double worst = run.model.bonds.worst;
  return worst >= 1.0 && (!by_margin || worst >= std::max(run.tip_margin, run.parting_margin));
}

// Whether an interface parts by energy before a tip grows.
bool parts_first(const Quasistatic& run) {
  return run.parting_margin >= 1.0 && run.parting_margin >= run.tip_margin;
}

// What is due at the present load: the worst bonded column fails, an interface parts or tips grow.
void grow_or_fail(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  const LoadPoint before = load_point(state);
  std::vector<Growing> growing;
  double energy_before = 0.0, surface = 0.0;
  if (failure_goes_first(scene, run)) {
    let_columns_go(failing_columns(scene, state, run.model.bonds), run, state);
  } else if (parts_first(run)) {
    const Parting& parting = run.trials[run.parting].parting;
    surface = parting.J_c * parting.length;
    let_columns_go(parting.columns, run, state, parting.mask, parting.sides);
  } else {
    if (fronts_go_on(scene, rocks, first_flow_step, state)) {
      state.dt = state.grown.took;
      run.margin = margin_of(scene, rocks, state, run);
      return;
    }
    growing = tips_that_grow(scene, rocks, state, run);
    energy_before = find_equilibrium(scene, state.time, state, run.model).energy;  // against friction's present memory
    lengthen(scene, growing, state);
  }
  rebuild_all(scene, rocks, state, run);
  if (!growing.empty()) measure_release(scene, rocks, energy_before, growing, state, run);
  state.grown = {};
  const FluidStep fluid = advance_fluid(scene, 0.0, state, run.model);
  if (!fluid.found) throw_no_solution("just after growth or failure", state.time, fluid.reason);
  equilibrate(scene, rocks, state, run);
  for (const Growing& g : growing) surface += g.J_c * g.increment;
  accept(scene, before, surface == 0.0 && growing.empty() ? Change::failure : Change::growth, state, run, surface);
  state.dt = first_flow_step;
  state.fluid.w_rate.clear();
  if (growing.empty() || scene.fluid.law != Fluid::Law::reynolds) return;
  if (std::ranges::any_of(growing, [&](const Growing& g) { return state.tips[g.tip].no_length; })) return;
  state.dt = std::max(state.dt, state.time - growing[0].last_s);
  start_fronts(state.dt, state);
}

// From `from` to the load a time dt later: run.margin is the margin there. Under law = "reynolds" there may be no
// solution within the iterations allowed.
FluidStep try_step(const Scene& scene, const Rocks& rocks, const LoadPoint& from, double dt, State& state,
                   Quasistatic& run, double there = 0.0) {
  return_to(from, state);
  try {
    FluidStep fluid = advance_fluid(scene, dt, state, run.model, there);
    if (fluid.found) equilibrate(scene, rocks, state, run);
    return fluid;
  } catch (const NumericalFailure& failure) {  // perhaps only beyond the next event
    run.model.factor = TangentFactor{};
    for (GrowthTrial& trial : run.trials) trial.model.factor = TangentFactor{};
    return {false, 0.0, failure.what()};
  }
}

bool flows(const Scene& scene, const State& state) {
  return scene.fluid.law != Fluid::Law::uniform && state.has_fracture;
}

// Whether a step of the fluid takes openings midway that are foreseen.
bool foresees_openings(const Scene& scene, const State& state) {
  return scene.fluid.law == Fluid::Law::paper && state.has_fracture;
}

// A step that was taken: its length (s), by how much the margin changed, its error against what is allowed, and when
// (s) fronts that are on their way at its end are at their tips.
struct LoadStep {
  double dt = 0.0, change = 0.0, error = 0.0, there = 0.0;
};

// When (s) the fronts of the last growth will be at their tips if they take as long as those before; 0: what the first
// growth took says nothing of the next.
double expected_there(const State& state) {
  const GrownFluid& grown = state.grown;
  return grown.took < grown.time ? grown.time + grown.took : 0.0;
}

// Of the time that the growth before took; then the tip waits for something else.
constexpr double patience = 4.0;

// Where no flow brings the front to a tip within dt: a step (s) that does, the shortest of those that are tried, which
// the state has then made; 0: none. Tried are as long as the growth before took, or twice as long again until one is
// found, and between that and dt.
double front_comes_later(const Scene& scene, const Rocks& rocks, const LoadPoint& from, double dt, State& state,
                         Quasistatic& run) {
  constexpr int most = 6;  // halvings: what brings the front within a 64th more than dt is not looked for
  const double since = from.time - state.grown.time, took = state.grown.took;
  const double longest = std::min(patience * took - since, scene.fluid.next_row(from.time) - from.time);
  double later = std::max(took - since, 2.0 * dt), shortest = 0.0;
  while (later <= longest && !try_step(scene, rocks, from, later, state, run).found) later *= 2.0;
  if (later > longest) return 0.0;
  for (int k = 0; k < most; ++k) {
    shortest = later;
    if (run.margin < 1.0) return shortest;
    later = 0.5 * (dt + later);
    if (!try_step(scene, rocks, from, later, state, run).found) break;
  }
  try_step(scene, rocks, from, shortest, state, run);
  return shortest;
}

// The step to the next growth, or as far as is left (s), by flow that is solved anew from the last growth on; it is
// sought from dt on. No length where none is found.
LoadStep step_from_growth(const Scene& scene, const Rocks& rocks, const LoadPoint& from, double dt, double left,
                          State& state, Quasistatic& run) {
  // Not sooner or later, or else rows would decide when flow begins to be followed step by step.
  const double given_up = state.grown.time + patience * state.grown.took - from.time, margin = run.margin;
  if (given_up < 1e-9 * state.grown.took) return {};
  left = std::min(left, given_up), dt = std::min(dt, left);
  const auto step = [&](double length, double there) {
    return LoadStep{length, std::abs(run.margin - margin), 0.0, there};
  };
  for (bool shorter = false; dt > std::min(shortest_trial, 0.5 * left);
       dt = shorter ? 0.5 * dt : std::min(2.0 * dt, left)) {
    const bool found = try_step(scene, rocks, from, dt, state, run).found;
    if (found && (shorter || dt == left || run.margin >= 1.0)) return step(dt, expected_there(state));
    const double later = found || shorter ? 0.0 : front_comes_later(scene, rocks, from, dt, state, run);
    if (later > 0.0 && later <= left) return step(later, expected_there(state));
    if (later > left) {  // after a row, at which the front is on its way
      const double known = expected_there(state), there = known > from.time + left ? known : from.time + later;
      const bool row = try_step(scene, rocks, from, left, state, run, there).found;
      run.margin = margin;
      if (row) return step(left, there);
    }
    shorter = !found;
  }
  return {};
}

// Takes the step of state.dt or, where nothing flows, of all the time that is left (s), halved until it is found, its
// error is allowed and the margin does not change too much before an event.
LoadStep find_step(const Scene& scene, const Rocks& rocks, const LoadPoint& from, double left, State& state,
                   Quasistatic& run) {
  const bool flowing = flows(scene, state), foresees = foresees_openings(scene, state);
  const double margin = run.margin;
  double dt = flowing ? std::min(state.dt, left) : left;
  if (state.grown.line.size() > 0) {
    if (const LoadStep found = step_from_growth(scene, rocks, from, dt, left, state, run); found.dt > 0.0) return found;
    state.grown = {};
  }
  for (;; dt *= 0.5) {
    FluidStep fluid = try_step(scene, rocks, from, dt, state, run);
    if (!fluid.found) {
      if (dt < shortest_trial) throw_no_solution("in any step", from.time, fluid.reason);
      continue;
    }
    if (foresees) {
      const double third = lag_error(scene, from.fluid, openings_of(from.surfaces.front()), from.time, state) /
                           scene.numerics.flow_error;
      fluid.error = std::cbrt(third * third);  // as if it went by the second power of the step
    }
    const double change = std::abs(run.margin - margin);
    const bool gentle = !flowing || run.margin >= 1.0 || change < 2.0 * scene.numerics.flow_change;
    if ((gentle && fluid.error < 4.0) || dt < shortest_trial) return {dt, change, fluid.error};
  }
}

// The next step (s) by how fast the margin changes and how large the error is.
double next_step(const Scene& scene, const LoadStep& step) {
  const double by_margin = step.change > 0.0 ? scene.numerics.flow_change / step.change : 2.0;
  const double by_error = step.error > 0.0 ? 0.8 / std::sqrt(step.error) : 2.0;
  return step.dt * std::clamp(std::min(by_margin, by_error), 0.3, 2.0);
}

// The step at whose end the margin is 1 or hardly more, no longer than `high`, at which it is larger: regula falsi,
// which turns the end that stays onto the slope of the parabola through the last three (Anderson and Bjorck, BIT 13,
// 1973), and bisection where the margin has no size. False where flow from the last growth on has no solution there.
bool locate_event(const Scene& scene, const Rocks& rocks, const LoadPoint& from, double margin_low, double high,
                  State& state, Quasistatic& run) {
  const double aim = 1.0 + 0.5 * event_tolerance;
  double low = 0.0, f_low = margin_low - aim, f_high = run.margin - aim;
  int side = 0;
  for (int iteration = 0; iteration < 100 && high - low > 1e-12 * high; ++iteration) {
    const double share = std::isfinite(f_high) && iteration < 50 ? -f_low / (f_high - f_low) : 0.5;
    const double middle = low + (high - low) * std::clamp(share, 1e-3, 1.0 - 1e-3);
    const bool found = try_step(scene, rocks, from, middle, state, run).found;
    const double margin = found ? run.margin : HUGE_VAL;  // what has no solution lies beyond the event
    if (margin >= 1.0 && margin <= 1.0 + event_tolerance) return true;
    const bool beyond = margin > aim;
    double &f_same = beyond ? f_high : f_low, &f_other = beyond ? f_low : f_high;
    if (side == (beyond ? 1 : -1)) {
      const double less = 1.0 - (margin - aim) / f_same;
      f_other *= less > 0.0 ? less : 0.5;
    }
    (beyond ? high : low) = middle;
    f_same = margin - aim;
    side = beyond ? 1 : -1;
  }
  const FluidStep last = try_step(scene, rocks, from, high, state, run);
  if (!last.found && state.grown.line.size() == 0) throw_no_solution("before the next event", from.time, last.reason);
  return last.found;
}

// What is written between two growths: fronts on their way. Tips stay as near to growth as with fronts that have come
// to them, which events are sought with.
void show_front(const Scene& scene, const Rocks& rocks, const LoadPoint& from, const LoadStep& step, State& state,
                Quasistatic& run) {
  const double margin = run.margin;
  const std::vector<Tip> tips = state.tips;
  const bool found = try_step(scene, rocks, from, step.dt, state, run, step.there).found;
  if (!found || failure_due(run)) try_step(scene, rocks, from, step.dt, state, run);
  run.margin = margin;
  state.tips = tips;
}

}  // namespace

bool failure_due(const Quasistatic& run) {
  return run.model.bonds.worst >= 1.0 || parts_first(run);
}

void start_quasistatic(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  run.model.factor = TangentFactor{}, run.trials.clear();  // digits go by the state alone
  rebuild_all(scene, rocks, state, run);
  if (state.step == 0) fill_fracture(scene, state, run.model);
  equilibrate(scene, rocks, state, run);
  if (state.step > 0) return;
  require_dry_tips_at_rest(scene, rocks, state);
  state.dt = first_flow_step;
  state.ledger = Ledger{};
  // The in-situ state: the fluid holds the fracture's faces against the stress across it, bonds carry all the rest and
  // give it up as they give way. The work of either, and of friction, is then half of its last value times the jump,
  // and what rock and springs store is as much (Clapeyron).
  const LoadPoint unloaded = [&] {
    LoadPoint point = load_point(state);
    std::fill(point.u.begin(), point.u.end(), Vec2::Zero());
    point.body = point.u;
    for (Surface& surface : point.surfaces) {
      for (SurfacePoint& s : surface.points) {
        const bool fracture = surface.kind == Surface::Kind::fracture;
        s.w = Vec2::Zero();
        if (fracture) s.P = s.closing_stress();
        s.in_situ = fracture ? Vec2{s.P * s.n} : Vec2{Vec2::Zero()};
      }
    }
    return point;
  }();
  for (ContactPlace& place : run.model.places) place.start.r_n = 0.0;
  close_ledger(run, unloaded, Change::load, 0.0, state);
  remember(state, run.model, run.equilibrium);
}

void restart_quasistatic(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  forget_solution(scene, rocks, state, run.model);
  if (std::ranges::any_of(run.trials, [&](const GrowthTrial& t) { return t.turn != state.tips[t.tip].turn; }))
    run.trials = build_trials(scene, rocks, state, run.model);
  for (GrowthTrial& trial : run.trials) forget_solution(scene, rocks, trial.state, trial.model);
  equilibrate(scene, rocks, state, run);
}

void advance_quasistatic(const Scene& scene, const Rocks& rocks, double until, State& state, Quasistatic& run) {
  if (run.margin >= 1.0) {
    grow_or_fail(scene, rocks, state, run);
    for (Tip& tip : state.tips) stop_at_edge(scene, state, tip);
    return;
  }
  const LoadPoint from = load_point(state);
  const double margin = run.margin;
  if (scene.fluid.next_row(state.grown.time) <= from.time) state.grown = {};
  const double left = std::min(until, scene.fluid.next_row(from.time)) - from.time;
  const LoadStep step = find_step(scene, rocks, from, left, state, run);
  if (run.margin > 1.0 + event_tolerance && !locate_event(scene, rocks, from, margin, step.dt, state, run)) {
    return_to(from, state);
    run.margin = margin;
    state.grown = {};
    return advance_quasistatic(scene, rocks, until, state, run);
  }
  const bool fed = !scene.fluid.rate_m2_s || scene.fluid.inlet_rate(from.time) > 0.0;  // as fast as before
  if (fed && state.grown.line.size() > 0 && run.margin < 1.0 && scene.fluid.next_row(from.time) > until)
    show_front(scene, rocks, from, step, state, run);
  if (foresees_openings(scene, state)) note_rates(openings_of(from.surfaces.front()), state.time - from.time, state);
  accept(scene, from, Change::load, state, run);
  state.dt = next_step(scene, step);
}

}  // namespace strata
