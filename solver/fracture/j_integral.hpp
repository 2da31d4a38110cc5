// J-integral and stress intensity factors of a fracture tip from domain integrals over particles.
#pragma once

#include <array>
#include <vector>

#include "fracture/tip_rings.hpp"

namespace strata {

// What the integrals take of a particle that rings weigh: of its displacement gradient g, stress s, strain energy W,
// kinetic energy T, velocity v and of a, its acceleration less the body force. With e the tip's first axis and
// u_1 = g e a ring's J takes (s u_1 - (W + T) e) . V grad q + rho (a . u_1 - v . v_1) V q, and K_I and K_II, means over
// the rings, take c : g + rho a . V q u_1 of Williams' fields.
struct RingParticle {
  std::size_t particle = 0, bin = 0;
  RingWeights V;                           // times its area: V q (m^2), V grad q (m)
  std::array<std::array<double, 4>, 2> c;  // of g_xx, g_xy, g_yx and g_yy
  std::array<Vec2, 2> V_q_u_1;             // of unit K
};

// And of a point of the fracture.
struct RingFace {
  std::size_t point = 0, ahead = 0, behind = 0;            // its neighbours towards the tip and away
  double span = 0.0;                                       // between these (m)
  double I = 0.0;                                          // 4/E' q int dr/sqrt(2 pi r) over its piece (sqrt(m)/Pa)
  std::array<double, ring_fractions.size()> q{}, dq_ds{};  // weights and their slope towards the tip (1/m)
};

struct TipRule {
  TipGeometry at;
  std::vector<RingParticle> particles;
  std::vector<RingFace> faces;
};

/// The rules of all tips, good as long as particles and surfaces stay where they are. Throws nothing.
std::vector<TipRule> make_tip_rules(const Scene& scene, const Rocks& rocks, const State& state);

/// Computes J, K_I, K_II, the next growth direction and how far they can be trusted for every tip, from the fields at
/// the end of a step (state.motion holds the motion of that step).
///   J = int [sigma_ij u_i,1 - (W + T) d_1j] q_,j + rho ((a_i - b_i) u_i,1 - v_i v_i,1) q dA + int w . d(t q)/ds ds
/// (Shih, Moran & Nakamura 1986; b the body force per mass, t the net face traction, by parts), the mean over rings,
/// and J_spread their (max - min)/mean; K_I and K_II by the interaction integral with Williams' fields (Yau, Wang &
/// Corten 1980), whose face term, t 4/E' q/sqrt(2 pi r) dr, is exact up to the tip for t constant on a piece. Kink
/// angle by maximum hoop stress (Erdogan & Sih 1963). Throws NumericalFailure where J or K is not finite.
void measure_tips(const Scene& scene, const Rocks& rocks, const std::vector<TipRule>& rules, State& state);

/// The same where particles have moved.
void measure_tips(const Scene& scene, const Rocks& rocks, State& state);

/// Maximum hoop stress: tan(th/2) = (K_I - sqrt(K_I^2 + 8 K_II^2))/(4 K_II) (rad); 0 for K_II = 0.
double kink_angle(double K_I, double K_II);

}  // namespace strata
