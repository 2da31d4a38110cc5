// One-dimensional flow along the fracture by the study's law: dP/dt = (M/mu) d/ds(k dP/ds), k = w^2/12 (its eqs 3 and
// 4).
#pragma once

#include <Eigen/Core>
#include <functional>
#include <span>
#include <vector>

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

// A channel between vertices: segment lengths (m), their permeabilities (m^2), and where the pressure is prescribed.
struct Channel {
  std::vector<double> length;
  std::vector<double> permeability;
  std::size_t inlet = 0;  // vertex index
};

/// One step dt (s) of P (Pa, one a vertex) with diffusivity mobility * k, mobility = M/mu (1/s), central differences
/// and no flux through the ends; P[inlet] becomes inlet_Pa. Trapezoid is second order, backward Euler and explicit
/// first. Throws NumericalFailure where the explicit rule is unstable at this step.
void diffuse(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt, double inlet_Pa,
             std::vector<double>& P);

/// The channel of a state's fracture with these openings (m, one a point), at least minimum_opening_m. Throws nothing.
Channel channel_of(const Scene& scene, const State& state, std::span<const double> openings);

/// Openings (m) of a fracture's points, at least 0. Throws nothing.
std::vector<double> openings_of(const Surface& fracture);

// diffuse() for many steps of one length through one channel: the matrix of its implicit part is factored once. With M
// the diffusion over a step and theta the rule's weight of its end, z = theta P_new + (1 - theta) P_old solves
// (1 + theta M) z = P_old. Elimination goes from both ends to the middle and back: the two sides wait for themselves
// alone.
class Diffusion {
 public:
  /// As diffuse(), and throws as that.
  Diffusion(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt);

  /// `count` steps of P (Pa, one a vertex); P[inlet] becomes inlet_Pa(k) at the end of the k-th, from 1.
  void steps(int count, const std::function<double(int)>& inlet_Pa, std::vector<double>& P);

 private:
  // Two vertices, one as far from the first as the other is from the last; an even number gets a closed one behind it.
  using Two = Eigen::Array2d;
  double& at(std::size_t vertex);
  void step_explicitly(double inlet_Pa, std::vector<double>& P) const;
  void step_implicitly(double inlet_Pa);

  std::size_t inlet_ = 0, middle_ = 0;
  double theta_ = 0.0;
  // Parts of the differences to its neighbours that a vertex takes in an explicit step.
  std::vector<double> before_, after_;
  std::vector<Two> factor_, inverse_, upper_, rhs_, P_;  // of elimination (upper over its pivot), and the pressures
  double inverse_middle_ = 1.0, P_middle_ = 0.0;
};

/// What the pressure's slope beside the inlet drives into the fracture by the flow that (3) balances, q = -(w^3/(12
/// mu)) dP/ds, both ways (m^2/s), with openings of at least minimum_opening_m; 0 under other laws. Throws nothing.
double inflow(const Scene& scene, const State& state);

/// Pressure at the end of the step state.dt: the inlet's ramp, and along the fracture by the scene's law with the
/// opening of the step's start, at least minimum_opening_m; passes vertex pressures on to the fracture's points.
/// Throws as diffuse().
void advance_pressure(const Scene& scene, State& state);

}  // namespace strata
