#include "quasistatic/fluid_step.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "flow/flow_monitors.hpp"
#include "flow/moving_front.hpp"
#include "flow/paper_flow.hpp"
#include "flow/reynolds_flow.hpp"
#include "fracture/growth.hpp"
#include "quasistatic/growth_trials.hpp"
#include "state/elasticity.hpp"

namespace strata {
namespace {

void set_point_pressures(const Eigen::VectorXd& P, State& state) {
  auto& points = state.fracture().points;
  for (std::size_t k = 0; k < points.size(); ++k) points[k].P = P[static_cast<Eigen::Index>(k)];
}

// Openings (m) of the fracture's points in an equilibrium that the state does not hold yet.
std::vector<double> openings(const State& state, const QuasistaticModel& model, const Equilibrium& at) {
  std::vector<double> w = openings_of(state.fracture());
  for (std::size_t k = 0; k < model.places.size(); ++k) {
    const ContactPlace& place = model.places[k];
    if (place.tie < 0 && place.surface == 0) w[place.point] = std::max(0.0, at.w[k].dot(place.n));
  }
  return w;
}

// The study's law at openings w (m), in equal steps, none longer than some of what its diffusion takes across a
// segment: the trapezoidal rule would ring otherwise.
void diffuse_in_steps(const Scene& scene, const State& state, const std::vector<double>& w, double time, double dt,
                      FluidLine& line) {
  // In ds^2/kappa: the trapezoidal rule hardly rings, the explicit one is stable.
  const double longest = scene.fluid.time_rule == Fluid::TimeRule::explicit_euler ? 0.5 : 2.0;
  constexpr int most = 1000;  // then the rule's own stability has to do
  const Fluid& fluid = scene.fluid;
  const double mobility = fluid.bulk_modulus_Pa / fluid.viscosity_Pa_s;
  const Channel channel = channel_of(scene, state, w);
  double shortest = dt;
  for (std::size_t k = 0; k < w.size(); ++k) {
    const double kappa = mobility * channel.permeability[k];
    if (kappa > 0.0) shortest = std::min(shortest, longest * channel.length[k] * channel.length[k] / kappa);
  }
  const int steps = std::clamp(static_cast<int>(std::ceil(std::min(dt / shortest, 1.0 * most))), 1, most);
  const double step = dt / steps;
  const auto inlet_Pa = [&](int k) { return fluid.inlet_pressure(time + k * step); };
  diffuse(channel, mobility, fluid.time_rule, step, steps, inlet_Pa, line.P);
  line.inlet_Pa = inlet_Pa(steps);
}

// The openings midway through a step dt: those of its start with half of what they change by at the rate of the step
// before or, after an event, by the step taken at the openings of its start (Heun's rule).
std::vector<double> openings_midway(const Scene& scene, double dt, State& state, QuasistaticModel& model) {
  std::vector<double> w = openings_of(state.fracture());
  if (state.fluid.w_rate.size() == w.size()) {
    for (std::size_t k = 0; k < w.size(); ++k) w[k] = std::max(0.0, w[k] + 0.5 * dt * state.fluid.w_rate[k]);
    return w;
  }
  const FluidLine before = state.fluid;
  diffuse_in_steps(scene, state, w, state.time, dt, state.fluid);
  pass_to_points(state);
  const std::vector<double> end = openings(state, model, find_equilibrium(scene, state.time + dt, state, model));
  for (std::size_t k = 0; k < w.size(); ++k) w[k] = 0.5 * (w[k] + end[k]);
  state.fluid = before;
  return w;
}

// Opening of a place as the flow sees it, w + roughness (1 - r_n/t_n), and its derivatives by the pressures.
void add_place(const ContactPlace& place, const LawAnswer& r, double w, RockResponse& rock) {
  const auto k = static_cast<Eigen::Index>(place.point);
  rock.w[k] = w + roughness;
  const double closing = place.in_situ.dot(place.n);
  if (r.piece == LawAnswer::Piece::open || closing <= 0.0) return;
  rock.w[k] -= roughness * std::min(r.n / closing, 1.0);
  if (r.n >= closing) return;
  rock.dw_dP.row(k) *= 1.0 - roughness * r.dn_dn / closing;  // r_n = t_n - P - k w
  rock.dw_dP(k, k) += roughness / closing;
}

// The largest of the stresses whose difference holds a place (Pa): its normal jump is a sum over x and y, of which
// stiff contact answers what is left, and openings beside it follow, also of faces that it has let go. Where faces that
// are not along the grid slide by millimetres, 1e14 Pa/m times that: 1e4 times the round-off of the pressure.
double cancelling(const ContactPlace& place, const LawAnswer& r, const Vec2& w) {
  return place.k * (place.n.cwiseProduct(w).lpNorm<1>() - std::abs(place.n.dot(w))) -
         r.dt_dt * place.t().cwiseProduct(w).lpNorm<1>();
}

// What both faces of each cell have lost to the rock by a time (s), 2 (2 C_L sqrt(t - t_0)) A (m^2; Carter, in Howard &
// Fast 1957), with fronts that are at their tips at a time `there`; nothing where no rock takes up fluid.
Eigen::VectorXd lost_by(const Scene& scene, double time, double there, const State& state) {
  if (!scene.leaks() || state.reynolds.size() == 0) return {};
  Eigen::VectorXd lost(state.fracture().points.size());
  const std::vector<double> wet = wet_times(state.reynolds, there, true, true);
  for (std::size_t k = 0; k < state.reynolds.size(); ++k) {
    const SurfacePoint& s = state.fracture().points[k];
    const double C_L = scene.rocks[rock_at(scene, s.x)].leakoff_m_sqrt_s;
    lost[static_cast<Eigen::Index>(k)] = 4.0 * C_L * std::sqrt(std::max(0.0, time - wet[k])) * s.A;
  }
  return lost;
}

// Whether a tip's front went on when the steps of the flow last began; what is just after that takes a step of its own.
bool went_on(const State& state, const Tip& tip) {
  return state.grown.time - last_wet(state.reynolds, tip.at_back) < 2.0 * shortest_coupled_step;
}

// The rock of a tip, without toughness while the initial fracture is dry ahead of the front.
TipRock rock_at_front(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip) {
  TipRock rock = tip_rock(scene, rocks, state, tip.at_back);
  if (state.reynolds.dry_cells(tip.at_back) > 0) rock.K_Ic = 0.0;
  return rock;
}

// What conducts near the fronts of tips that go on at a time (s) and, where those of the last growth are at their tips
// `there` only, the most that flows to them.
void add_fronts(const Scene& scene, const Rocks& rocks, double time, double there, const State& state,
                RockResponse& of) {
  if (state.grown.line.size() == 0) return;
  const ReynoldsLine& line = state.reynolds;
  of.front = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(line.size()) - 1);
  of.most = Eigen::VectorXd::Constant(of.front.size(), std::nan(""));
  for (const Tip& tip : state.tips) {
    const TipRock rock = rock_at_front(scene, rocks, state, tip);
    const double at_tip = went_on(state, tip) ? there : time;
    of.front += front_conductances(scene.fluid, line, tip.at_back, rock, at_tip);
    if (at_tip > time) limit_to_front(scene.fluid, line, tip.at_back, rock, time, there, of.lost, of.most);
  }
}

// rho g times the height of cells above the inlet (Pa).
Eigen::VectorXd rise_of_cells(const Scene& scene, const State& state) {
  const auto &vertices = state.fracture().vertices, &points = state.fracture().points;
  Eigen::VectorXd rise(points.size());
  for (std::size_t k = 0; k < points.size(); ++k)
    rise[static_cast<Eigen::Index>(k)] = scene.fluid.weight() * (points[k].x.y() - vertices[state.fluid.inlet].x.y());
  return rise;
}

// The rock at a time (s) as the flow sees it: openings and their change with the pressures, in equilibrium with all
// surfaces; fronts of the last growth are at their tips at a time `there`.
RockModel rock_of(const Scene& scene, double time, double there, State& state, QuasistaticModel& model) {
  const auto& points = state.fracture().points;
  RockResponse fixed;  // what no pressure changes
  fixed.E_prime.resize(std::ssize(points)), fixed.closing.resize(std::ssize(points));
  const Rocks rocks = make_elasticities(scene);
  for (Eigen::Index k = 0; k < std::ssize(points); ++k) {
    const SurfacePoint& s = points[static_cast<std::size_t>(k)];
    fixed.E_prime[k] = rocks[rock_at(scene, s.x)].E_prime, fixed.closing[k] = s.closing_stress();
  }
  if (model.dw_dP_of != model.factor.pieces) model.dw_dP.resize(0, 0);
  fixed.lost = lost_by(scene, time, there, state);
  fixed.rise = rise_of_cells(scene, state);
  add_fronts(scene, rocks, time, there, state, fixed);
  return [&scene, time, &state, &model, fixed](const Eigen::VectorXd& P) {
    set_point_pressures(P, state);
    const Equilibrium at = find_equilibrium(scene, time, state, model);
    if (model.dw_dP_of != at.pieces || model.dw_dP.size() == 0) {  // the same as long as no place opens or closes
      model.dw_dP = opening_per_pressure(state, model.condensed, model.places, at, model.factor);
      model.dw_dP_of = at.pieces;
    }
    RockResponse rock = fixed;
    rock.w = Eigen::VectorXd::Zero(P.size()), rock.dw_dP = model.dw_dP;
    for (std::size_t k = 0; k < model.places.size(); ++k) {
      const ContactPlace& place = model.places[k];
      rock.cancels = std::max(rock.cancels, cancelling(place, at.answers[k], at.w[k]));
      if (place.tie < 0 && place.surface == 0) add_place(place, at.answers[k], at.w[k].dot(place.n), rock);
    }
    return rock;
  };
}

// The pressure at the end of a step between two times (s), or the rate midway, which between rows of a table is its
// mean.
Inlet inlet_over(const Scene& scene, const State& state, double start, double end) {
  if (!scene.fluid.rate_m2_s) return {Inlet::Drive::pressure, scene.fluid.inlet_pressure(end)};
  // Half of a fracture that starts on the symmetry line gets half of what the whole is fed.
  const bool half = scene.domain.bottom == Edge::symmetry && state.fracture().vertices.front().x.y() == 0.0;
  return {Inlet::Drive::rate, scene.fluid.inlet_rate(0.5 * (start + end)) * (half ? 0.5 : 1.0)};
}

// Passes the pressures of the line on to the fracture's points and vertices. At closed ends the fluid is at rest.
void pass_on(const Fluid& fluid, State& state) {
  const auto &vertices = state.fracture().vertices, &points = state.fracture().points;
  const std::vector<double>& of_cells = state.reynolds.P;
  set_point_pressures(Eigen::Map<const Eigen::VectorXd>(of_cells.data(), std::ssize(of_cells)), state);
  state.fluid.inlet_Pa = state.reynolds.inlet_Pa;
  std::vector<double>& P = state.fluid.P = vertex_pressures(state.reynolds);
  if (state.fluid.inlet > 0) P.front() = fluid.at_rest(P.front(), vertices.front().x.y() - points.front().x.y());
  if (state.fluid.inlet < points.size())
    P.back() = fluid.at_rest(P.back(), vertices.back().x.y() - points.back().x.y());
}

FluidStep couple(const Scene& scene, double dt, double at_tips, State& state, QuasistaticModel& model) {
  // Of the largest opening, a step: some hundred of them add up to less than a per cent, since what one does wrong the
  // next ones heal.
  const double allowed = scene.numerics.flow_error;
  const double end = state.time + std::max(dt, shortest_coupled_step);
  const bool grown = state.grown.line.size() > 0;
  GrownFluid from = grown ? state.grown : GrownFluid{state.time, 0.0, state.reynolds, state.balance};
  const double there = std::max(end, at_tips);
  const StepReport report =
      step_reynolds(scene.fluid, inlet_over(scene, state, from.time, end), end - from.time,
                    rock_of(scene, end, there, state, model), from.line, from.balance, {.filled_first = grown});
  if (!report.converged) return {false, 0.0, report.reason};
  state.time = end;
  state.reynolds = std::move(from.line);
  state.balance = from.balance;
  pass_on(scene.fluid, state);
  state.monitors.volume_balance = state.balance.closure();
  return {true, report.error_w / allowed, ""};
}

// Lets the front of the fluid into as much (m) of the initial fracture's dry cells ahead of it at an end.
void wet_cells(const Scene& scene, bool at_back, double increment, State& state) {
  ReynoldsLine& line = state.reynolds;
  line.wet_s = wet_times(line, state.time, !at_back, at_back);
  line.rates_known = false;
  double length = 0.0;
  std::size_t dry = line.dry_cells(at_back);
  const auto nearest = [&] { return at_back ? line.size() - dry : dry - 1; };
  for (; dry > 0 && length < (1.0 - 1e-9) * increment; --dry) {
    line.wet_s[nearest()] = state.time;
    line.P[nearest()] = scene.fluid.cavitation_Pa;
    length += line.length[nearest()];
  }
  // The point ahead opens with the front's own cell, whose displacements are linear. In truth its faces touch and carry
  // what is missing: it is held at its closing stress, or else it would be drawn together by all of that.
  if (dry > 0) line.P[nearest()] = state.fracture().points[nearest()].closing_stress();
}

}  // namespace

void fill_fracture(const Scene& scene, State& state, QuasistaticModel& model) {
  if (!state.has_fracture || scene.fluid.law != Fluid::Law::reynolds) return;
  const auto& points = state.fracture().points;
  double P = scene.fluid.start_Pa;
  // A thousandth below the least closing stress, so that contact holds every face: at it all are between open and
  // closed, and Newton's method may go round in circles. Rough faces hold as much less than they would at it.
  constexpr double held = 1e-3;
  const Eigen::VectorXd rise = rise_of_cells(scene, state);
  if (scene.fluid.rate_m2_s) {
    P = HUGE_VAL;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double closing = points[k].closing_stress();
      P = std::min(P, closing - held * std::abs(closing) + rise[static_cast<Eigen::Index>(k)]);
    }
  }
  const RockResponse rock = rock_of(scene, state.time, state.time, state, model)((P - rise.array()).matrix());
  std::vector<double> length;
  for (const SurfacePoint& s : points) length.push_back(s.A);
  state.reynolds = full_line(scene.fluid, length, state.fluid.inlet, P, rock.w, state.balance, rise);
  state.reynolds.inlet_Pa = state.fluid.inlet_Pa = P;
  rest_fluid(scene.fluid, state);
  if (!scene.fluid.rate_m2_s) return;
  for (const Tip& tip : state.tips) {
    if (!may_grow(scene, state, tip)) continue;
    const std::size_t inlet = state.fluid.inlet, side = tip.at_back ? points.size() - inlet : inlet;
    double wet = 0.0;
    for (std::size_t j = 0; j < side; ++j) {
      const std::size_t k = tip.at_back ? inlet + j : inlet - 1 - j;
      if (wet > (1.0 - 1e-9) * increment_of(scene, tip)) leave_dry(scene.fluid, k, state.reynolds, state.balance);
      wet += length[k];
    }
    wet_cells(scene, tip.at_back, 0.0, state);
  }
  if (std::ranges::none_of(state.tips, [&](const Tip& t) { return state.reynolds.dry_cells(t.at_back) > 0; })) return;
  // Where they are dry friction holds the faces: what it has let slide under the pressure of the fluid has not.
  const Eigen::Map<const Eigen::VectorXd> now(state.reynolds.P.data(), std::ssize(points));
  fill_openings(scene.fluid, rock_of(scene, state.time, state.time, state, model)(now).w, state.reynolds,
                state.balance);
  pass_on(scene.fluid, state);
}

double lag_error(const Scene& scene, const FluidLine& before, std::span<const double> w_before, double time,
                 const State& state) {
  double net = 0.0;
  for (const SurfacePoint& s : state.fracture().points) net = std::max(net, std::abs(s.P - s.closing_stress()));
  if (net == 0.0) return 0.0;
  std::vector<double> w = openings_of(state.fracture());
  for (std::size_t k = 0; k < w.size(); ++k) w[k] = 0.5 * (w[k] + w_before[k]);
  FluidLine again = before;
  diffuse_in_steps(scene, state, w, time, state.time - time, again);
  double change = 0.0;
  for (std::size_t k = 0; k < again.P.size(); ++k) change = std::max(change, std::abs(again.P[k] - state.fluid.P[k]));
  return 0.5 * change / net;
}

void note_rates(std::span<const double> w_before, double dt, State& state) {
  const std::vector<double> w = openings_of(state.fracture());
  state.fluid.w_rate.resize(w.size());
  for (std::size_t k = 0; k < w.size(); ++k) state.fluid.w_rate[k] = (w[k] - w_before[k]) / dt;
}

void start_fronts(double took, State& state) {
  state.grown = {state.time, took, state.reynolds, state.balance};
}

double toughless_margin(const State& state, double E_prime, const Tip& tip) {
  constexpr double resolved = 0.1;  // of p sqrt(h)
  constexpr double large_K = 1e8;   // Pa sqrt(m), of which the tolerance of an event is 1e-4
  const Surface& fracture = state.fracture();
  const SurfacePoint& last = tip.at_back ? fracture.points.back() : fracture.points.front();
  double K = tip.K_I;
  for (const SurfacePoint& s : fracture.points) {
    const double x = tip.at_back ? fracture.length() - s.arc : s.arc;
    if (x < 2.0 * state.grid.h) K = std::min(K, E_prime / 8.0 * std::sqrt(2.0 * std::numbers::pi / x) * s.opening());
  }
  const double net = state.fluid.inlet_Pa - last.closing_stress();
  if (net <= 0.0) return 0.0;
  return 1.0 + (K - resolved * net * std::sqrt(state.grid.h)) / large_K;
}

double front_margin(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip) {
  const TipRock rock = rock_at_front(scene, rocks, state, tip);
  return front_filling(scene.fluid, state.reynolds, tip.at_back, rock, state.time);
}

double fed_margin(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip, double K_Ic,
                  double by_K) {
  // viscous_tip() at which both count alike. Of 0.18, 0.13 and 0.1 the last left least of the error of the ladder's
  // leaking fracture (1.4, 0.7 and 0.4 % at 0.25 and 0.125 m); without leak-off 0.18 would do.
  constexpr double alike = 0.1;
  if (!openings_tell(scene, tip)) return by_K;
  TipRock rock = tip_rock(scene, rocks, state, tip.at_back);
  rock.K_Ic = K_Ic;
  const double h = state.grid.h, viscous = viscous_tip(state, scene.fluid, tip.at_back, rock);
  const double by_opening =
      opening_behind(scene.fluid, state.reynolds, tip.at_back, rock, state.time, 2.0 * h, 4.0 * h);
  return by_K + (by_opening - by_K) / (1.0 + std::pow(alike / viscous, 8));
}

bool fronts_go_on(const Scene& scene, const Rocks& rocks, double least_s, State& state) {
  double took = 0.0;
  for (const Tip& tip : state.tips) {
    if (state.reynolds.dry_cells(tip.at_back) == 0 || front_margin(scene, rocks, state, tip) < 1.0) continue;
    took = std::max(least_s, state.time - last_wet(state.reynolds, tip.at_back));
    wet_cells(scene, tip.at_back, increment_of(scene, tip), state);
  }
  if (took > 0.0) start_fronts(took, state);
  return took > 0.0;
}

void add_fluid_cells(const Scene& scene, bool at_back, std::size_t added, State& state) {
  if (scene.fluid.law != Fluid::Law::reynolds) return;
  const auto& points = state.fracture().points;
  state.reynolds.wet_s = wet_times(state.reynolds, state.time, !at_back, at_back);
  for (std::size_t k = 0; k < added; ++k) {
    const std::size_t q = at_back ? points.size() - added + k : added - 1 - k;
    grow(state.reynolds, scene.fluid, at_back, points[q].A, state.time);
  }
}

FluidStep advance_fluid(const Scene& scene, double dt, State& state, QuasistaticModel& model, double at_tips) {
  if (!state.has_fracture) {
    state.time += dt;
    return {};
  }
  if (scene.fluid.law == Fluid::Law::reynolds) return couple(scene, dt, at_tips, state, model);
  if (scene.fluid.law == Fluid::Law::uniform) {
    if (dt > 0.0) state.fluid.inlet_Pa = scene.fluid.inlet_pressure(state.time + dt);
    rest_fluid(scene.fluid, state);
  } else if (dt > 0.0) {
    diffuse_in_steps(scene, state, openings_midway(scene, dt, state, model), state.time, dt, state.fluid);
  }
  state.time += dt;
  pass_to_points(state);
  return {};
}

}  // namespace strata
