#include "flow/flow_monitors.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "flow/reynolds_flow.hpp"
#include "state/elasticity.hpp"

namespace strata {
namespace {

// The points to one side of the inlet, outwards.
struct Side {
  const State& state;
  std::size_t first, count;
  bool onwards;

  std::size_t index(std::size_t k) const { return onwards ? first + k : first - k; }
  const SurfacePoint& operator[](std::size_t k) const { return state.fracture().points[index(k)]; }
};

double net_at_inlet(const State& state) {
  const auto& points = state.fracture().points;
  return state.fluid.inlet_Pa - points[std::min(state.fluid.inlet, points.size() - 1)].closing_stress();
}

// A figure for the sides before and behind the inlet, 0 where there is none.
template <class Figure>
std::array<double, 2> of_sides(const State& state, const Figure& figure) {
  const std::size_t inlet = state.fluid.inlet, points = state.fracture().points.size();
  return {inlet > 0 ? figure(Side{state, inlet - 1, inlet, false}) : 0.0,
          inlet < points ? figure(Side{state, inlet, points - inlet, true}) : 0.0};
}

double fall_along(const Side& side, double net) {
  double cells = 0.0, before = net;
  for (std::size_t k = 0; k < side.count; ++k) {
    const double here = side[k].P - side[k].closing_stress(), way = k == 0 ? 0.5 : 1.0;
    if (here <= 0.0) return net / (cells + way * before / (before - here));
    cells += way, before = here;
  }
  return std::max(0.0, net - before) / cells;
}

// A stretch that fluid flows through: what its pressure falls by and is beyond it (Pa), and what it would fall by, over
// that, without the floor.
struct FlowStretch {
  double fall, beyond, more;
};

FlowStretch flow_stretch(const Scene& scene, const Side& side, std::size_t k) {
  const double floor = scene.fluid.minimum_opening_m;
  if (scene.fluid.law == Fluid::Law::paper) {  // between the vertices of a point
    const std::size_t at = side.index(k);
    const std::vector<double>& P = side.state.fluid.P;
    const double near = P[side.onwards ? at : at + 1], far = P[side.onwards ? at + 1 : at], w = side[k].opening();
    return {near - far, far, std::pow(std::max(w, floor) / w, 2)};
  }
  const std::vector<double>& w = side.state.reynolds.w;  // between the middles of two
  const double a = std::max(w[side.index(k)], roughness), b = std::max(w[side.index(k + 1)], roughness);
  const bool at_front =
      side.state.grown.line.size() > 0 && is_new(side.state.reynolds, side.onwards, side.index(k + 1));
  const double conducts = opening_between(std::max(a, floor), std::max(b, floor)) / opening_between(a, b);
  const double weighs = scene.fluid.weight() * (side[k + 1].x.y() - side[k].x.y());
  return {side[k].P - side[k + 1].P - weighs, side[k + 1].P, at_front ? std::max(b, floor) / b : std::pow(conducts, 3)};
}

double missing_along(const Scene& scene, const Side& side) {
  const bool paper = scene.fluid.law == Fluid::Law::paper;
  double length = 0.0, x = 0.0, lost = 0.0, missing = 0.0;
  for (std::size_t k = 0; k < side.count; ++k) length += side[k].A;
  for (std::size_t k = 0; k + (paper ? 0 : 1) < side.count; ++k) {
    const double open = std::max(side[k].opening(), paper ? 0.0 : side[k + 1].opening());
    if (open <= roughness) break;
    x += side[k].A;
    const auto [fall, beyond, more] = flow_stretch(scene, side, k);
    if (!(fall > 0.0)) continue;
    const double further =
        std::clamp(fall * (more - 1.0), 0.0, std::max(0.0, beyond - scene.fluid.cavitation_Pa - lost));
    lost += further;
    missing += further * 2.0 * std::numbers::inv_pi * std::acos(std::min(1.0, x / length));
  }
  return missing;
}

}  // namespace

double fall_in_a_cell(const State& state) {
  const double net = net_at_inlet(state);
  if (!(net > 0.0)) return 0.0;
  return std::ranges::max(of_sides(state, [&](const Side& side) { return fall_along(side, net); }));
}

std::array<double, 2> floor_share(const Scene& scene, const State& state) {
  const double net = net_at_inlet(state);
  if (!(net > 0.0)) return {};
  return of_sides(state, [&](const Side& side) { return missing_along(scene, side) / net; });
}

double viscous_tip(const State& state, const Fluid& fluid, bool at_back, const TipRock& rock) {
  const double net = net_at_inlet(state);
  const std::vector<double>& phi = state.reynolds.phi;
  if (!(net > 0.0) || phi.empty() || (at_back ? phi.back() : phi.front()) < 1.0) return 0.0;
  const auto [before, behind] = of_sides(state, [](const Side& side) {
    double a = 0.0;
    for (std::size_t k = 0; k < side.count; ++k) a += side[k].A;
    return a;
  });
  const double K = toughness_from(fluid, state.reynolds, at_back, rock, state.time, state.grid.h);
  return (K - rock.K_Ic) / (net * std::sqrt(std::numbers::pi * (at_back ? behind : before)));
}

void watch_flow(const Scene& scene, State& state) {
  if (!state.has_fracture || scene.fluid.law == Fluid::Law::uniform) return;
  Monitors& m = state.monitors;
  const std::int64_t growths = m.growths + m.growths_apart;
  if (scene.fluid.rate_m2_s || growths != m.flow_growths) m.flow_fall_Pa = 0.0;
  m.flow_growths = growths;
  note_largest(m.flow_fall_Pa, fall_in_a_cell(state));
  const double net = net_at_inlet(state);
  m.flow_fall = net > 0.0 ? m.flow_fall_Pa / net : 0.0;
  m.floor_share = floor_share(scene, state);
  m.viscous_tip = {};
  if (scene.fluid.law != Fluid::Law::reynolds) return;
  const Rocks rocks = make_elasticities(scene);
  for (const Tip& tip : state.tips) {
    const TipRock rock = tip_rock(scene, rocks, state, tip.at_back);
    if (!openings_tell(scene, tip) && rock.K_Ic > 0.0)
      m.viscous_tip[tip.at_back ? 1 : 0] = viscous_tip(state, scene.fluid, tip.at_back, rock);
  }
}

}  // namespace strata
