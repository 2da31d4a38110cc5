// Whether the cells resolve a flow and whether the floor of the opening decides about it, as the monitors keep it.
#pragma once

#include <array>

#include "flow/moving_front.hpp"
#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

/// What the pressure falls by in a cell, on average from the inlet to where it no longer exceeds the closing stress, or
/// to the tip (Pa): (P_inlet - t_n)/n with n cells, or parts of them, on the way; of two sides of the inlet the
/// steeper. 0 where the inlet's pressure does not exceed the closing stress. Throws nothing.
double fall_in_a_cell(const State& state);

/// What the fracture's pressure owes to minimum_opening_m, as the even pressure that would change K_I of a straight
/// crack as much, over the inlet's net pressure: where openings w are below the floor w_f the same flow would lose
/// DP ((w_f/w)^n - 1) more (n = 2 by the study's diffusion, 3 by lubrication; at most what leaves the cavitation
/// pressure), and a pressure missing beyond x in a crack of length a is worth (2/pi) acos(x/a) of one missing
/// everywhere (e.g. Tada, Paris & Irwin). Faces that touch are left out; behind a moving front n is 1, since its
/// asymptote conducts by the opening. A value for the side of the inlet before it, and one for that behind it (tips
/// that are at_back): what one tip's new cells hold does not decide about the other. Throws nothing.
std::array<double, 2> floor_share(const Scene& scene, const State& state);

/// What the viscous fluid takes up within a cell of a tip, of the pressure at the inlet: (K(h) - K_Ic)/(p sqrt(pi a)),
/// K(h) by toughness_from() a cell behind the tip, p the inlet's net pressure, a the length from there to the tip; rock
/// whose toughness decides leaves 0. 0 where nothing has grown, and where fluid does not fill the last cell, which then
/// draws the faces together no more than the cavitation pressure does. Throws nothing.
double viscous_tip(const State& state, const Fluid& fluid, bool at_back, const TipRock& rock);

/// Whether openings behind a tip tell how near it is to growth: fed at a rate it has grown before, and J would decide.
/// Throws nothing.
inline bool openings_tell(const Scene& scene, const Tip& tip) {
  return scene.fluid.rate_m2_s && tip.has_grown && tip.criterion == Criterion::J;
}

/// Notes all at the end of a step of the load, viscous_tip() where K or energy decides alone in a rock with toughness.
/// Where the inlet's pressure is given, what the flow lags behind is in the pressure of the next growth: the largest
/// fall since the growth before counts. A given rate makes up for it: the fall at growth counts. Throws nothing.
void watch_flow(const Scene& scene, State& state);

}  // namespace strata
