// The load that a step without inertia starts from, and the work done since.
#pragma once

#include <vector>

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

/// The load of a state as it is. Throws nothing.
LoadPoint load_point(const State& state);

/// Takes a state back to the load it had, on the same surfaces; its fields do not follow. Throws nothing.
void return_to(const LoadPoint& from, State& state);

/// Work of the fluid from one state to the next, as if its pressure and what surfaces have released of the in-situ
/// traction had changed with the jumps (J/m): sum A (P + P')/2 n . (w' - w); the traction's in `in_situ`. The fracture
/// may have become longer in between. Throws nothing.
double work_of_loads(const State& state, const LoadPoint& before, double& in_situ);

/// Work of the body force from one state to the next, as if it had changed with the displacements (J/m):
/// sum m (b + b')/2 . (u' - u). Throws nothing.
double work_of_body(const State& state, const LoadPoint& before);

}  // namespace strata
