// Where J and K of a tip are taken: its frame, its rings and their weights, and the fields they are held against.
#pragma once

#include <array>
#include <optional>

#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// Radii of the rings over the widest one's: numerics.ring_cells is 4 by default, and rings of 3.2 to 4 cells are wide
// enough to leave the tip's own error inside.
constexpr std::array<double, 3> ring_fractions{0.8, 0.9, 1.0};

// No ring is smaller than this, since the tip's own error would fill it. J and K are trusted where a ring of that size
// ends a cell before what is nearest, as far as a node's functions reach, and half a cell more before an interface:
// nearer, K_I is off by 0.3 %, within the ring by 0.3 to 0.7 % at 2 cells and by 2 to 17 % at 1.
constexpr double narrowest_ring_cells = 2.5;
constexpr double trusted_cells = narrowest_ring_cells + 1.0;
constexpr double trusted_cells_at_interface = trusted_cells + 0.5;

struct Frame {
  Vec2 tip, e_1, e_2;
  double sign = 1.0;  // + side of the fracture above (1) or below (-1) as the tip looks ahead
  Vec2 local(const Vec2& a) const { return {a.dot(e_1), a.dot(e_2)}; }
};

// The weight q: 1 at nodes inside the inner radius, 0 beyond the outer one, a cosine between; between nodes the same
// B-splines as the fields, whose stress is in equilibrium in their sense only: an analytic q scatters J by 3 %.
struct Ring {
  double inner = 0.0, outer = 0.0;
  double at_node(double r) const;
};

using Rings = std::array<Ring, ring_fractions.size()>;

// q and its gradient (1/m) at a place, by ring.
struct Weight {
  double q = 0.0;
  Vec2 grad = Vec2::Zero();
};
using RingWeights = std::array<Weight, ring_fractions.size()>;

// q at the nine nodes around a place, by ring.
using RingNodes = std::array<std::array<double, 9>, ring_fractions.size()>;

// In the tip's frame.
struct AuxiliaryFields {
  Stress s;  // stress for unit K
  Vec2 u_1;  // derivative of displacement along the fracture
};

// What follows from where surfaces and tips are.
struct TipGeometry {
  Frame frame;
  Rings rings;                     // the widest last
  Obstacle near = Obstacle::none;  // as Tip's
  bool crossed = false, no_length = false;
  Elasticity rock;   // ahead of the tip
  double lag = 0.0;  // of the last increment behind the frame (rad)
};

/// Frame, rings and rock of a tip. Throws nothing.
TipGeometry tip_geometry(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip);

/// q at the nodes around the grid's node (i, j); nothing where no ring reaches them. Throws nothing.
std::optional<RingNodes> ring_nodes(const Grid& g, const TipGeometry& at, int i, int j);

/// q at a place x (m) whose spans are those of that node. Throws nothing.
RingWeights ring_weights(const Grid& g, const RingNodes& nodes, int i, int j, const Vec2& x);

/// Angle of a place from the tip (rad), in the tip's frame (m), on the particle's side of the fracture: behind a kink
/// the side and not the angle tells the face.
double angle_at(const Vec2& local, bool above);

/// Williams' field of mode I (mode = 0) or II (1) for unit K, plane strain, in the tip's frame at r (m), theta (rad).
AuxiliaryFields williams(const Elasticity& rock, int mode, double r, double theta);

// J (N/m) of each ring, and the mean over rings of what the interaction with unit K_I and K_II gives.
struct TipSums {
  std::array<double, ring_fractions.size()> J{};
  std::array<double, 2> I{};
};

/// J, K and the next direction of growth from the sums of all rings. Throws NumericalFailure where they are not finite.
void finish_tip(const Scene& scene, const TipGeometry& at, const State& state, const TipSums& sums, Tip& tip);

/// What a tip turns by in `times` increments at once (rad); in one: tip.turn. Throws nothing.
double turn_over(const Scene& scene, const Tip& tip, double times);

}  // namespace strata
