#include "flow/paper_flow.hpp"

#include <algorithm>
#include <string>
#include <utility>

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

Diffusion::Diffusion(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt)
    : inlet_(channel.inlet),
      theta_(rule == Fluid::TimeRule::trapezoid ? 0.5 : (rule == Fluid::TimeRule::backward_euler ? 1.0 : 0.0)) {
  const std::vector<double> length = lengths_at_vertices(channel);
  const std::size_t n = length.size();
  std::vector<double> before(n + 1, 0.0), after(n + 1, 0.0);  // what a vertex takes from its neighbours in an explicit
  for (std::size_t k = 0; k + 1 < n; ++k) {                   // step, per difference of pressure
    const double conductance = dt * mobility * channel.permeability[k] / channel.length[k];
    after[k] = conductance / length[k], before[k + 1] = conductance / length[k + 1];
  }
  before[inlet_] = after[inlet_] = 0.0;
  if (theta_ == 0.0) {
    require_stable(channel, mobility, dt);
    before_ = std::move(before), after_ = std::move(after);
    return;
  }
  // Elimination without pivoting: the matrix is diagonally dominant.
  middle_ = n / 2;
  factor_.resize(middle_ + 1), inverse_.resize(middle_), upper_.resize(middle_), rhs_.resize(middle_),
      P_.resize(middle_);
  Two inverse = Two::Zero(), upper = Two::Zero();  // of the vertices before
  for (std::size_t k = 0; k <= middle_; ++k) {
    const std::size_t mirror = 2 * middle_ - k;  // n is the closed vertex
    const Two outward = theta_ * Two{before[k], after[mirror]}, inward = theta_ * Two{after[k], before[mirror]};
    factor_[k] = outward * inverse;
    const Two less = outward * upper;
    if (k == middle_) {
      inverse_middle_ = 1.0 / (1.0 + theta_ * (before[k] + after[k]) - less.sum());
      break;
    }
    inverse = 1.0 / (1.0 + outward + inward - less);
    inverse_[k] = inverse, upper_[k] = upper = inward * inverse;
  }
}

double& Diffusion::at(std::size_t vertex) {
  if (vertex == middle_) return P_middle_;
  return vertex < middle_ ? P_[vertex][0] : P_[2 * middle_ - vertex][1];
}

void Diffusion::step_explicitly(double inlet_Pa, std::vector<double>& P) const {
  double last = P.front();
  for (std::size_t k = 0; k < P.size(); ++k) {
    const double own = P[k], next = k + 1 < P.size() ? P[k + 1] : own;
    P[k] = own + after_[k] * (next - own) - before_[k] * (own - last);
    last = own;
  }
  P[inlet_] = inlet_Pa;
}

void Diffusion::step_implicitly(double inlet_Pa) {
  const double old_share = 1.0 - theta_, per_theta = 1.0 / theta_;
  double& inlet = at(inlet_);
  inlet = theta_ * inlet_Pa + old_share * inlet;
  Two z = Two::Zero();
  for (std::size_t k = 0; k < middle_; ++k) rhs_[k] = z = P_[k] + factor_[k] * z;
  const double middle = (P_middle_ + (factor_[middle_] * z).sum()) * inverse_middle_;
  P_middle_ = per_theta * (middle - old_share * P_middle_);
  z = middle;
  for (std::size_t k = middle_; k-- > 0;) {
    z = rhs_[k] * inverse_[k] + upper_[k] * z;
    P_[k] = per_theta * (z - old_share * P_[k]);
  }
  inlet = inlet_Pa;
}

void Diffusion::steps(int count, const std::function<double(int)>& inlet_Pa, std::vector<double>& P) {
  if (theta_ == 0.0) {
    for (int k = 1; k <= count; ++k) step_explicitly(inlet_Pa(k), P);
    return;
  }
  for (Two& pair : P_) pair.setZero();
  for (std::size_t k = 0; k < P.size(); ++k) at(k) = P[k];
  for (int k = 1; k <= count; ++k) step_implicitly(inlet_Pa(k));
  for (std::size_t k = 0; k < P.size(); ++k) P[k] = at(k);
}

void diffuse(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt, double inlet_Pa,
             std::vector<double>& P) {
  Diffusion(channel, mobility, rule, dt)
      .steps(
          1, [inlet_Pa](int) { return inlet_Pa; }, P);
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
