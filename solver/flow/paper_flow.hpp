// One-dimensional flow along the fracture by the study's law: dP/dt = (M/mu) d/ds(k dP/ds), k = w^2/12 (its eqs 3 and
// 4).
#pragma once

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

/// `count` steps dt (s) of P (Pa, one a vertex) with diffusivity mobility * k, mobility = M/mu (1/s), central
/// differences and no flux through the ends; P[inlet] becomes inlet_Pa(k) at the end of the k-th step, from 1. With M
/// the diffusion over a step and theta the rule's weight of its end (trapezoid 1/2, of second order; backward Euler 1;
/// explicit 0): (1 + theta M) z = P_old, P_new = P_old - M z. Throws NumericalFailure where the explicit rule is
/// unstable at this step.
void diffuse(const Channel& channel, double mobility, Fluid::TimeRule rule, double dt, int count,
             const std::function<double(int)>& inlet_Pa, std::vector<double>& P);

/// The channel of a state's fracture with these openings (m, one a point), at least minimum_opening_m. Throws nothing.
Channel channel_of(const Scene& scene, const State& state, std::span<const double> openings);

/// Openings (m) of a fracture's points, at least 0. Throws nothing.
std::vector<double> openings_of(const Surface& fracture);

/// What the pressure's slope beside the inlet drives into the fracture by the flow that (3) balances, q = -(w^3/(12
/// mu)) dP/ds, both ways (m^2/s), with openings of at least minimum_opening_m; 0 under other laws. Throws nothing.
double inflow(const Scene& scene, const State& state);

/// Pressure at the end of the step state.dt: the inlet's ramp, and along the fracture by the scene's law with the
/// opening of the step's start, at least minimum_opening_m; passes vertex pressures on to the fracture's points.
/// Throws as diffuse().
void advance_pressure(const Scene& scene, State& state);

}  // namespace strata
