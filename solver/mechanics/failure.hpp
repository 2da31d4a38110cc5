// When bonded places of interfaces let go.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// A bonded place, how near it is to failure (1: fails) and what it carries, on the + face (Pa).
struct BondedPlace {
  std::size_t surface = 0, point = 0;
  double index = 0.0;
  Vec2 carried = Vec2::Zero();
};

/// How near a bonded place is to failure under normal and tangential reaction n (compression positive) and t (Pa): 1
/// where it fails. weak: sqrt((S/Sc)^2 + (N/Nc)^2), N in tension only (the study's eq. 5); friction: |t|/(mu n),
/// infinite in tension; other laws: 0.
double failure_index(const InterfaceLaw& law, double n, double t);

/// All bonded places of weak and friction interfaces, from the mean total stress of the particles around them.
std::vector<BondedPlace> bonded_places(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state);

}  // namespace strata
