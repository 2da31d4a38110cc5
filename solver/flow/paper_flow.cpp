#include "flow/paper_flow.hpp"

#include <algorithm>
#include <string>

namespace strata {
namespace {

void require_stable(const Channel& channel, double mobility, double dt) {
  for (std::size_t k = 0; k < channel.length.size(); ++k) {
    const double limit = 0.5 * channel.length[k] * channel.length[k] / (mobility * channel.permeability[k]);
    if (dt <= limit) continue;
    throw NumericalFailure(
        "explicit flow is unstable: its step " + std::to_string(dt) +
        " s exceeds ds^2/(2 kappa) = " + std::to_string(limit) +
        " s. Use fluid.time_rule = \"trapezoid\" or \"backward-euler\", or a smaller courant number");
  }
}

}  // namespace

void diffuse(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt, int count,
             const std::function<double(int)>& inlet_Pa, std::vector<double>& P) {
  const double theta = rule == Fluid::TimeRule::trapezoid ? 0.5 : (rule == Fluid::TimeRule::backward_euler ? 1.0 : 0.0);
  if (theta == 0.0) require_stable(channel, mobility, dt);
  const std::size_t n = P.size(), inlet = channel.inlet;
  std::vector<double> before(n, 0.0), after(n, 0.0);  // M: what a vertex takes of the differences to its neighbours
  for (std::size_t k = 0; k + 1 < n; ++k) {
    const double conductance = dt * mobility * channel.permeability[k] / channel.length[k];
    const double beside = k > 0 ? channel.length[k - 1] : 0.0, behind = k + 2 < n ? channel.length[k + 1] : 0.0;
    after[k] = conductance / (0.5 * (beside + channel.length[k]));
    before[k + 1] = conductance / (0.5 * (channel.length[k] + behind));
  }
  before[inlet] = after[inlet] = 0.0;
  // Elimination without pivoting: the matrix is diagonally dominant.
  std::vector<double> factor(n, 0.0), inverse(n), upper(n), z(n);
  for (std::size_t k = 0; k < n; ++k) {
    if (k > 0) factor[k] = theta * before[k] * inverse[k - 1];
    inverse[k] = 1.0 / (1.0 + theta * (before[k] + after[k] - (k > 0 ? factor[k] * after[k - 1] : 0.0)));
    upper[k] = theta * after[k] * inverse[k];
  }
  for (int step = 1; step <= count; ++step) {
    P[inlet] = theta * inlet_Pa(step) + (1.0 - theta) * P[inlet];
    z[0] = P[0];
    for (std::size_t k = 1; k < n; ++k) z[k] = P[k] + factor[k] * z[k - 1];
    z[n - 1] *= inverse[n - 1];
    for (std::size_t k = n - 1; k-- > 0;) z[k] = z[k] * inverse[k] + upper[k] * z[k + 1];
    // P - M z, and where z is the mean theta P_new + (1 - theta) P what follows from that, without a way from k to k
    // + 1.
    for (std::size_t k = 0; theta > 0.0 && k < n; ++k) P[k] = (z[k] - (1.0 - theta) * P[k]) / theta;
    for (std::size_t k = 0; theta == 0.0 && k + 1 < n; ++k) {
      P[k] += after[k] * (z[k + 1] - z[k]);
      P[k + 1] -= before[k + 1] * (z[k + 1] - z[k]);
    }
    P[inlet] = inlet_Pa(step);
  }
}

Channel channel_of(const Scene& scene, const State& state, std::span<const double> openings) {
  Channel channel;
  channel.inlet = state.fluid.inlet;
  const auto& points = state.fracture().points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double w = std::max(openings[k], scene.fluid.minimum_opening_m);
    channel.length.push_back(points[k].A);
    channel.permeability.push_back(w * w / 12.0);
  }
  return channel;
}

std::vector<double> openings_of(const Surface& fracture) {
  std::vector<double> w;
  for (const SurfacePoint& s : fracture.points) w.push_back(s.opening());
  return w;
}

double inflow(const Scene& scene, const State& state) {
  if (!state.has_fracture || scene.fluid.law != Fluid::Law::paper) return 0.0;
  const FluidLine& line = state.fluid;
  const auto& points = state.fracture().points;
  double q = 0.0;
  const auto add_side = [&](std::size_t segment, std::size_t next) {
    const double w = std::max(points[segment].opening(), scene.fluid.minimum_opening_m);
    q += w * w * w / (12.0 * scene.fluid.viscosity_Pa_s) * (line.P[line.inlet] - line.P[next]) / points[segment].A;
  };
  if (line.inlet < points.size()) add_side(line.inlet, line.inlet + 1);
  if (line.inlet > 0) add_side(line.inlet - 1, line.inlet - 1);
  return q;
}

void advance_pressure(const Scene& scene, State& state) {
  if (!state.has_fracture) return;
  const Fluid& fluid = scene.fluid;
  FluidLine& line = state.fluid;
  line.inlet_Pa = fluid.inlet_pressure(state.time + state.dt);
  if (fluid.law == Fluid::Law::uniform) {
    rest_fluid(fluid, state);
  } else {
    diffuse(
        channel_of(scene, state, openings_of(state.fracture())), fluid.bulk_modulus_Pa / fluid.viscosity_Pa_s,
        fluid.time_rule, state.dt, 1, [&](int) { return line.inlet_Pa; }, line.P);
  }
  pass_to_points(state);
  state.monitors.delivered_m2 += state.dt * inflow(scene, state);
}

}  // namespace strata
