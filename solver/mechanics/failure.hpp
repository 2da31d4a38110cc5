// When bonded places of interfaces let go.
#pragma once

#include <vector>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// How the traction on a bonded place follows from the rock on one side of it. A column of the grid, moved with the
// weight Phi = sum N_i over the nodes that the interface would split, is in balance:
//   int t Phi ds = sum_p (V_p sigma_p grad Phi - m_p b_p Phi) - sum_faces A Phi t_face,
// the force that a split node's copy would need to stay where it is. Beside a fracture that ends on the interface the
// rock on its two sides moves apart, and each has a column of its own: stress there rises as 1/sqrt(r) and changes sign
// across the fracture, so that a mean over both sides, or of points above and below, sees next to nothing of it.
struct BondSample {
  struct Share {
    std::size_t index = 0;       // particle, or point of the fracture
    Vec2 weight = Vec2::Zero();  // V_p grad Phi (m); of a face: its A Phi (m) with the face's sign, in x
    double Phi = 0.0;            // at the particle
  };
  std::vector<Share> particles, faces;
  std::vector<Share> loose;  // points of the interface that have let go already: A Phi (m) in x
  double length = 0.0;       // int Phi ds where it is bonded (m)
  double sign = 1.0;         // of the outward normal against the surface's: 1 for the rock on the - side
};

// A bonded place: from which samples its traction is taken (mean of them), and what came of it.
struct BondedPlace {
  std::size_t surface = 0, point = 0;
  std::vector<std::size_t> samples;
  double index = 0.0;           // how near it is to failure (1: fails)
  Vec2 carried = Vec2::Zero();  // what it carries, on the + face (Pa)
};

struct Bonds {
  std::vector<BondSample> samples;
  std::vector<BondedPlace> places;
};

/// How near a bonded place is to failure under normal and tangential reaction n (compression positive) and t (Pa): 1
/// where it fails. weak: sqrt((S/Sc)^2 + (N/Nc)^2), N in tension only (the study's eq. 5); friction: |t|/(mu n),
/// infinite in tension; other laws: 0.
double failure_index(const InterfaceLaw& law, double n, double t);

/// The bonded places of a state's weak and friction interfaces, with their samples; its copies must be built.
Bonds find_bonds(const Scene& scene, const State& state);

/// What bonded places carry under the particles' present stress and the present tractions on the fracture, and how near
/// each is to failure.
void load_bonds(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state, Bonds& bonds);

}  // namespace strata
