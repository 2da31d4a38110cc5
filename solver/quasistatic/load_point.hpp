// The load that a state without inertia has: what a trial step starts from, and the work of loads since.
#pragma once

#include "state/state.hpp"

namespace strata {

// What a trial step changes and a rejected one takes back. Particles only hold what follows from it.
struct LoadPoint {
  double time = 0.0;
  FluidLine fluid;
  ReynoldsLine reynolds;
  FluidBalance balance;
  std::vector<Surface> surfaces;
  std::vector<Tip> tips;
  std::vector<Vec2> u, body;  // displacement (m) and body force per mass (m/s^2) of particles by id; none without that
};

/// The load of a state. Throws nothing.
LoadPoint load_point(const State& state);

/// Takes a state back to the load it had, on the same surfaces; its fields do not follow. Throws nothing.
void return_to(const LoadPoint& from, State& state);

/// Work of the fluid since an earlier load, as if its pressure and what surfaces have released of the in-situ traction
/// had changed with the jumps (J/m): sum A (P + P')/2 n . (w' - w); the traction's in `in_situ`. The fracture may have
/// become longer in between. What holds its faces counts with P where they part or close under a changing load
/// (`loaded`: they are apart from P + r on) and in a long step of flow that conserves volume. Throws nothing.
double work_of_loads(const State& state, const LoadPoint& before, bool loaded, double& in_situ);

/// Work of the body force as if it had changed with the displacements (J/m): sum m (b + b')/2 . (u' - u). Throws
/// nothing.
double work_of_body(const State& state, const LoadPoint& before);

}  // namespace strata
