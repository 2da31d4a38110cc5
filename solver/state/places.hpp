// Places on surfaces: bonded ones of interfaces, with what they carry and how near they are to failure (see
// interfaces/failure.hpp), and those where two sides of the rock exist and a law acts between them, springs of tips
// among them.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/scene.hpp"
#include "state/types.hpp"

namespace strata {

// How the traction on a bonded place follows from the rock on one side of it. A column of the grid, moved with the
// weight Phi = sum N_i over the nodes that the interface would split, is in balance:
//   int t Phi ds = sum_p (V_p sigma_p grad Phi - m_p b_p Phi) + sum_i m_i a_i - sum_faces A Phi t_face,
// the force that a split node's copy would need to stay where it is. Beside a fracture that ends on the interface the
// rock on its two sides moves apart, and each has a column of its own: stress there rises as 1/sqrt(r) and changes sign
// across the fracture, so that a mean over both sides, or of points above and below, sees next to nothing of it.
struct BondSample {
  struct Share {
    std::size_t index = 0;       // particle, or point of the fracture or of the interface
    Vec2 weight = Vec2::Zero();  // V_p grad Phi (m); of a point: its A Phi (m) with the face's sign, in x
    double Phi = 0.0;            // at the particle
  };
  struct Mass {
    int record = 0;
    double m = 0.0;  // of one side: sum_p m_p N_ip (kg/m)
  };
  std::size_t surface = 0;
  std::vector<Share> particles, faces;
  std::vector<Share> loose;   // points of the interface that have let go already
  std::vector<Mass> inertia;  // of runs with inertia
  double length = 0.0;        // int Phi ds (m)
  double sign = 1.0;          // of the outward normal against the surface's: 1 for the rock on the - side
};

// A bonded place: from which samples its traction is taken (mean of them), and what came of it.
struct BondedPlace {
  std::size_t surface = 0, point = 0;
  std::vector<std::size_t> samples;
  bool begins = false;          // a stretch of bonded places, behind what has let go or a fracture
  Vec2 carried = Vec2::Zero();  // what it carries, on the + face (Pa)
  double index = 0.0;           // how near it is to failure (1: fails)
  // As its stretch is judged: the length that it stands for (m), the force on it (N/m) and its own index.
  double length = 0.0, own = 0.0;
  Vec2 force = Vec2::Zero();
};

struct Bonds {
  std::vector<BondSample> samples;
  std::vector<BondedPlace> places;
  double worst = 0.0;        // the largest index when they were last judged
  std::vector<Vec2> forces;  // of the samples' rock (N/m)
};

/// The length (m) of bonded interface over which the mean traction decides: failure_length_m or, where it is left out,
/// the increment of growth, or the cell where there is no fracture. Throws nothing.
inline double failure_length(const Scene& scene, const InterfaceLaw& law) {
  return law.failure_length_m.value_or(scene.fracture ? scene.fracture->increment_m : scene.numerics.cell_m);
}

// A split place, with its jump over master nodes, w = sum c u.
struct SplitPlace {
  struct Entry {
    std::size_t node = 0;   // index into SplitPlaces::nodes
    Vec2 c = Vec2::Zero();  // weights in the jump
    Vec2 d = Vec2::Zero();  // velocity that a traction of 1 Pa on the + face adds in a step (m/s/Pa)
  };
  struct Neighbour {
    std::size_t place = 0;
    Vec2 per = Vec2::Zero();  // rate of its jump that a traction of 1 Pa here adds in a step (m/s/Pa)
  };
  int surface = -1;                 // -1: a tip's spring
  std::size_t point = 0;            // of the surface, or which spring
  std::size_t law = 0;              // index into SplitPlaces::laws
  double k = 0.0;                   // contact stiffness (Pa/m)
  double per_n = 0.0, per_t = 0.0;  // change of the jump at the step's end per traction (m/Pa)
  Vec2 r_start = Vec2::Zero();      // reaction at the step's start (Pa)
  Vec2 rate = Vec2::Zero();         // of its jump (m/s), where neighbours are known
  std::vector<Entry> entries;
  std::vector<Neighbour> neighbours;  // under kinematics = "total": that share nodes with it, itself among them
};

// A master that split places reach: its mass (kg/m), its velocity and what the places have added to it (m/s).
struct SplitNode {
  std::size_t at = 0;  // record
  double m = 0.0;
  Vec2 v = Vec2::Zero(), dv = Vec2::Zero();
};

struct HeldFactor;

struct SplitPlaces {
  std::vector<SplitPlace> places;
  std::vector<SplitNode> nodes;
  std::vector<std::size_t> node_at;        // index into nodes of each record
  std::vector<InterfaceLaw> laws;          // the scene's, that of the fracture's faces, and of tips' springs
  std::shared_ptr<const HeldFactor> held;  // of the places held last (solve_held_reactions())
};

}  // namespace strata
