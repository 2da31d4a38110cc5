// J-integral and stress intensity factors of a fracture tip from domain integrals over particles.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

/// Computes J, K_I, K_II, the next growth direction and how far they can be trusted for every tip, from the fields at
/// the end of a step (state.motion holds the motion of that step).
///   J = int [sigma_ij u_i,1 - (W + T) d_1j] q_,j + rho ((a_i - b_i) u_i,1 - v_i v_i,1) q dA + int w . d(t q)/ds ds
/// (Shih, Moran & Nakamura 1986, with inertia and the body force b per mass; face term by parts, t the net face
/// traction), q falling from 1 to 0 over a ring; K_I and K_II by the interaction integral with Williams' fields (Yau,
/// Wang & Corten 1980), whose face term is integrated analytically up to the tip. Several rings: J is their mean,
/// J_spread their (max - min)/mean. Kink angle by maximum hoop stress (Erdogan & Sih 1963). Throws NumericalFailure
/// where K is not finite.
void measure_tips(const Scene& scene, const std::vector<Elasticity>& rocks, State& state);

/// Maximum hoop stress: tan(th/2) = (K_I - sqrt(K_I^2 + 8 K_II^2))/(4 K_II) (rad); 0 for K_II = 0.
double kink_angle(double K_I, double K_II);

}  // namespace strata
