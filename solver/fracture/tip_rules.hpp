// J and K of tips whose rock does not move: what they take of the fields is worked out once.
#pragma once

#include <array>
#include <vector>

#include "fracture/tip_rings.hpp"

namespace strata {

// Of each particle that a ring of a tip weighs, in arrays. With g its displacement gradient, s and W its stress and
// strain energy, e the tip's first axis and u_1 = g e, a ring's J takes (s u_1 - W e) . V grad q of it, a quadratic
// form, and K_I and K_II, means over the rings, take c : g.
struct TipRule {
  TipGeometry at;
  std::vector<FacePlace> faces;
  std::vector<std::size_t> particle;
  std::vector<double> lambda, mu;                                       // Pa
  std::array<std::vector<double>, ring_fractions.size()> V_q_x, V_q_y;  // V grad q (m)
  std::array<std::array<std::vector<double>, 4>, 2> c;  // of I_1 and I_2, mean over rings; of g_xx, g_xy, g_yx and g_yy
};

/// The rules of all tips, good as long as particles and surfaces stay where they are. Throws nothing.
std::vector<TipRule> make_tip_rules(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state);

/// What measure_tips() computes, but for round-off, of rock without inertia and body force: the same equations with all
/// that particles' places say taken from `rules`, one a tip. Throws as it does.
void measure_tips(const Scene& scene, const std::vector<TipRule>& rules, State& state);

}  // namespace strata
