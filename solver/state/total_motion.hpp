// What kinematics = "total" keeps at the nodes. Particles, surfaces, weights, masses and copies stay as they are from
// one event (growth, failure) to the next, so that the rock's force is one fixed linear operator of the nodal
// displacement u_i since the last time the particles were brought up to date, the base:
//   a_i = a_i at the base - (M^-1 K u)_i.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <vector>

#include "scene/scene.hpp"
#include "state/lanes.hpp"
#include "state/spread_array.hpp"
#include "state/types.hpp"

namespace strata {

// Nodal arrays are indexed by slots. Slots of a plane are laid out as the grid is, with two more rings of nodes around
// the block than it has cells' corners; the k-th copy of a node stands in plane k. Neighbours are thus the same number
// of slots away wherever the same surfaces are beside them.
struct Slots {
  static constexpr int ring = 2;
  int stride = 0;              // slots of a row
  int plane = 0;               // slots of a plane
  int size = 0;                // of all planes and what vectors may read beyond
  std::vector<int> of_record;  // slot of each record's master
};

struct SlotRange {
  int first = 0, last = 0;  // slots [first, last)
};

// A 2 x 2 block of -M^-1 K (1/s^2), of the slot `offset` slots ahead of its row's.
struct StencilEntry {
  int offset = 0;
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;
};

// Slots in a row that share the blocks [entry, entry + full) and, without xy and yx, the next `diagonal` ones.
struct StencilRun {
  SlotRange slots;
  int entry = 0, full = 0, diagonal = 0;
};

// Blocks of as many slots in a row as there are lanes, from `offset` slots ahead on.
struct alignas(64) StencilSegment {
  std::array<double, most_lanes> xx{}, xy{}, yx{}, yy{};
  int offset = 0;
};

// A slot in no run, with the segments [first, last) of its row, which all slots with the same row share.
struct SingleSlot {
  int slot = 0, first = 0, last = 0;
};

// -M^-1 K of the masters, by slots.
struct StencilOperator {
  Slots slots;
  std::vector<StencilEntry> entries;
  std::vector<StencilRun> runs;
  std::vector<StencilSegment> segments;
  std::vector<SingleSlot> singles;
  std::vector<SlotRange> ranges;  // slots in use, a row of a plane each
};

// The force of the rock of a sample of bonded places (see BondSample): `base` + sum of T u + m a over slots.
struct BondSensor {
  struct Entry {
    int slot = 0;
    double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;  // Pa
    double m = 0.0;                                 // kg/m
  };
  Vec2 base = Vec2::Zero();  // N/m
  std::vector<Entry> entries;
};

struct TotalMotion {
  // Saved: velocities of the records when the particles were last brought up to date (m/s); empty: the particles'.
  std::vector<Vec2> velocity;

  // Derived.
  bool based = false;                         // whether what follows belongs to the particles as they are
  std::shared_ptr<const StencilOperator> op;  // none: the copies have changed
  SpreadArray m;                              // kg/m, by slots as all that follows
  SpreadArray base_x, base_y;                 // acceleration at the base (m/s^2)
  SpreadArray a_x, a_y;                       // and now
  SpreadArray v_x, v_y;                       // velocity (m/s)
  SpreadArray u_x, u_y;                       // displacement since the base (m)
  std::vector<BondSensor> bonds;
};

}  // namespace strata
