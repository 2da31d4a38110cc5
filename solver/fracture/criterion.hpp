// What decides whether a tip grows where it stands.
#pragma once

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// What decides about a tip: with growth = "energy" always energy, with crossing = "J" always J. Else, of interfaces
/// with a law or another stiffness beyond:
///   one whose faces are apart at the tip itself: energy, since a tip there has no length in the rock ahead;
///   one ahead, nearer than the crossing increment: energy;
///   one behind whose faces are apart, nearer than rings need: K or, within three cells, where K is some per cent off
///   between unlike rocks, the slope of the energy;
///   any other one nearer than the crossing increment: energy; else J.
/// In place of J, K where the in-situ stress jumps within the tip's rings. Throws nothing.
Criterion criterion_of(const Scene& scene, const State& state, const Tip& tip);

/// How far a tip grows at once (m): by what decides about it. Throws nothing.
inline double increment_of(const Scene& scene, const Tip& tip) {
  return tip.criterion == Criterion::energy ? scene.fracture->crossing_increment() : scene.fracture->increment_m;
}

/// Whether its J decided where an interface or a border of rocks is too near for it. Throws nothing.
inline bool doubtful(const Tip& tip) {
  return tip.criterion == Criterion::J && at_interface(tip);
}

/// What events and summaries call it: "J", "K" or "energy".
const char* name_of(Criterion criterion);

/// Distance (m) along a tip's direction from the nearest interface that it is on or past, less than 8 cells away, and
/// whose faces are apart where the fracture has come through: 0 on it, infinite where there is none. Throws nothing.
double past_open_interface(const Scene& scene, const State& state, const Tip& tip);

/// Whether the faces of an interface (index into Scene::strata) are apart within a cell of a place (m). Throws nothing.
bool apart_at(const Scene& scene, const State& state, std::size_t interface, const Vec2& x);

/// What drives a tip (N/m), by its criterion; 0 for a closed tip but by energy.
///   energy, slope: tip.G_trial. K: (K_I^2 + K_II^2)/E'.
///   J: J, but away from interfaces no more than twice that of K: where faces have just touched, or stand under a dry
///   fluid, J may be several J_c while K is next to nothing, and is no energy release rate.
/// Throws nothing.
double driving(const Elasticity& rock, const Tip& tip);

}  // namespace strata
