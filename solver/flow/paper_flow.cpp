#include "flow/paper_flow.hpp"

#include <algorithm>
#include <string>

namespace strata {

namespace {

// Flux divergence at each vertex, sum of k (P_neighbour - P)/length (Pa m).
std::vector<double> net_inflow(const Channel& channel, const std::vector<double>& P) {
  std::vector<double> sum(P.size(), 0.0);
  for (std::size_t k = 0; k + 1 < P.size(); ++k) {
    const double flux = channel.permeability[k] * (P[k + 1] - P[k]) / channel.length[k];
    sum[k] += flux;
    sum[k + 1] -= flux;
  }
  return sum;
}

std::vector<double> lengths_at_vertices(const Channel& channel) {
  std::vector<double> at(channel.length.size() + 1, 0.0);
  for (std::size_t k = 0; k < channel.length.size(); ++k) {
    at[k] += 0.5 * channel.length[k];
    at[k + 1] += 0.5 * channel.length[k];
  }
  return at;
}

// Solves a tridiagonal system in place by elimination without pivoting: diagonally dominant here.
void solve_tridiagonal(std::vector<double>& lower, std::vector<double>& diagonal, std::vector<double>& upper,
                       std::vector<double>& x) {
  for (std::size_t k = 1; k < x.size(); ++k) {
    const double factor = lower[k] / diagonal[k - 1];
    diagonal[k] -= factor * upper[k - 1];
    x[k] -= factor * x[k - 1];
  }
  x.back() /= diagonal.back();
  for (std::size_t k = x.size() - 1; k-- > 0;) x[k] = (x[k] - upper[k] * x[k + 1]) / diagonal[k];
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

void diffuse(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt, double inlet_Pa,
             std::vector<double>& P) {
  const double theta = rule == Fluid::TimeRule::trapezoid ? 0.5 : (rule == Fluid::TimeRule::backward_euler ? 1.0 : 0.0);
  if (theta == 0.0) require_stable(channel, mobility, dt);
  const std::vector<double> at = lengths_at_vertices(channel), inflow = net_inflow(channel, P);
  const std::size_t n = P.size();
  std::vector<double> lower(n, 0.0), diagonal(n, 1.0), upper(n, 0.0);
  for (std::size_t k = 0; k < n; ++k) {
    P[k] += (1.0 - theta) * dt * mobility * inflow[k] / at[k];
    if (k > 0) lower[k] = -theta * dt * mobility * channel.permeability[k - 1] / (channel.length[k - 1] * at[k]);
    if (k + 1 < n) upper[k] = -theta * dt * mobility * channel.permeability[k] / (channel.length[k] * at[k]);
    diagonal[k] -= lower[k] + upper[k];
  }
  lower[channel.inlet] = upper[channel.inlet] = 0.0;
  diagonal[channel.inlet] = 1.0;
  P[channel.inlet] = inlet_Pa;
  solve_tridiagonal(lower, diagonal, upper, P);
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
    Channel channel;
    channel.inlet = line.inlet;
    for (const SurfacePoint& s : fracture.points) {
      const double w = std::max(s.opening(), fluid.minimum_opening_m);
      channel.length.push_back(s.A);
      channel.permeability.push_back(w * w / 12.0);
    }
    diffuse(channel, fluid.bulk_modulus_Pa / fluid.viscosity_Pa_s, fluid.time_rule, state.dt, line.inlet_Pa, line.P);
  }
  for (std::size_t k = 0; k < fracture.points.size(); ++k) fracture.points[k].P = 0.5 * (line.P[k] + line.P[k + 1]);
}

}  // namespace strata
