// The same blocks with Coulomb friction on the interface, under a pressure that rises from 0 in steps.
//
// At each point of the interface |q| <= mu n, n = s_n w - t > 0 the force that presses (in-situ stress s_n times the
// point's share w, less the net pull t of the elements); where it slides q = -mu n against the slip's increment, else
// that increment is 0. Slip and t are linear in p and q (CutBlocks::Influence), so each step is a linear
// complementarity problem, solved by exchanging sets until none changes (Klarbring 1986, Ing.-Arch. 56, 529).
#pragma once

#include "cut_blocks.hpp"

namespace strata::reference {

struct SlidingBlocks {
  double work = 0;           // of the pressure, int p dV, J/m
  double stored = 0;         // elastic energy of the whole width, J/m
  double friction_work = 0;  // dissipated on the interface on both sides, J/m
  double K_I = 0;            // of the tip, Pa sqrt(m)
  double mouth_opening = 0;  // at y = 0, m
  double largest_slip = 0;   // of the lower rock over the upper one, m
  double slid_to = 0;        // the farthest point that has slid, m from the fracture
};

// Net pressure (Pa) rises to `pressure` in equal steps; friction mu, compression s_n in Pa. The block's slipped and
// shear_stiffness are not used; its widest element sets how well the ends of sliding are found. Throws
// std::invalid_argument as CutBlocks, for fresh = 0 and for values that are not positive, std::runtime_error if the
// interface opens or a step finds no state.
SlidingBlocks sliding_blocks(const CutBlock& block, double friction, double compression, double pressure, int steps,
                             int order = 4);

}  // namespace strata::reference
