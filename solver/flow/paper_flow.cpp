#include "flow/paper_flow.hpp"

#include <algorithm>
#include <string>

namespace strata {

namespace {

std::vector<double> lengths_at_vertices(const Channel& channel) {
  std::vector<double> at(channel.length.size() + 1, 0.0);
  for (std::size_t k = 0; k < channel.length.size(); ++k) {
    at[k] += 0.5 * channel.length[k];
    at[k + 1] += 0.5 * channel.length[k];
  }
  return at;
}

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

Diffusion::Diffusion(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt) : inlet_(channel.inlet) {
  const double theta = rule == Fluid::TimeRule::trapezoid ? 0.5 : (rule == Fluid::TimeRule::backward_euler ? 1.0 : 0.0);
  if (theta == 0.0) require_stable(channel, mobility, dt);
  const std::vector<double> at = lengths_at_vertices(channel);
  const std::size_t n = at.size();
  for (std::size_t k = 0; k + 1 < n; ++k) conductance_.push_back(channel.permeability[k] / channel.length[k]);
  share_.resize(n), factor_.resize(n), inverse_.resize(n), upper_.resize(n);
  for (std::size_t k = 0; k < n; ++k) {
    share_[k] = (1.0 - theta) * dt * mobility / at[k];
    double lower = k > 0 ? -theta * dt * mobility * conductance_[k - 1] / at[k] : 0.0;
    double upper = k + 1 < n ? -theta * dt * mobility * conductance_[k] / at[k] : 0.0;
    double diagonal = 1.0 - lower - upper;
    if (k == inlet_) lower = upper = 0.0, diagonal = 1.0;
    // Elimination without pivoting: the matrix is diagonally dominant.
    if (k > 0) factor_[k] = lower * inverse_[k - 1], diagonal -= lower * upper_[k - 1];
    inverse_[k] = 1.0 / diagonal;
    upper_[k] = upper * inverse_[k];
  }
}

void Diffusion::step(double inlet_Pa, std::vector<double>& P) {
  double flux = 0.0;  // from the segment before
  for (std::size_t k = 0; k < P.size(); ++k) {
    const double next = k + 1 < P.size() ? conductance_[k] * (P[k + 1] - P[k]) : 0.0;
    const double explicit_part = k == inlet_ ? inlet_Pa : P[k] + share_[k] * (next - flux);
    flux = next;
    P[k] = k > 0 ? explicit_part - factor_[k] * P[k - 1] : explicit_part;
  }
  P.back() *= inverse_.back();
  for (std::size_t k = P.size() - 1; k-- > 0;) P[k] = P[k] * inverse_[k] - upper_[k] * P[k + 1];
}

void diffuse(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt, double inlet_Pa,
             std::vector<double>& P) {
  Diffusion(channel, mobility, rule, dt).step(inlet_Pa, P);
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
  Surface& fracture = state.fracture();
  FluidLine& line = state.fluid;
  line.inlet_Pa = fluid.start_Pa + fluid.rate_Pa_s * (state.time + state.dt);
  if (fluid.law == Fluid::Law::uniform) {
    std::fill(line.P.begin(), line.P.end(), line.inlet_Pa);
  } else {
    diffuse(channel_of(scene, state, openings_of(fracture)), fluid.bulk_modulus_Pa / fluid.viscosity_Pa_s,
            fluid.time_rule, state.dt, line.inlet_Pa, line.P);
  }
  for (std::size_t k = 0; k < fracture.points.size(); ++k) fracture.points[k].P = 0.5 * (line.P[k] + line.P[k + 1]);
  state.monitors.delivered_m2 += state.dt * inflow(scene, state);
}

}  // namespace strata
