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

// A 2 x 2 block of -M^-1 K (1/s^2), of the record `offset` ahead of its row's.
struct StencilEntry {
  int offset = 0;
  double xx = 0.0, xy = 0.0, yx = 0.0, yy = 0.0;
};

// Blocks of as many records in a row as there are lanes, from `offset` ahead on.
struct alignas(64) StencilSegment {
  std::array<double, most_lanes> xx{}, xy{}, yx{}, yy{};
  int offset = 0;
};

// The blocks [entry, entry + full) of a row and, without xy and yx, the next `diagonal` ones; the same as segments.
struct StencilRow {
  std::size_t entry = 0, full = 0, diagonal = 0, segment = 0, segments = 0;
};

// Records [first, last) that share a row.
struct StencilRun {
  std::size_t first = 0, last = 0, row = 0;
};

// -M^-1 K of the masters.
struct StencilOperator {
  std::vector<StencilEntry> entries;
  std::vector<StencilSegment> segments;
  std::vector<StencilRow> rows;
  std::vector<StencilRun> runs;
};

// The force of the rock of a sample of bonded places (see BondSample): `base` + sum of T u + m a over masters.
struct BondSensor {
  struct Entry {
    std::size_t master = 0;
    Eigen::Matrix2d T = Eigen::Matrix2d::Zero();  // Pa
    double m = 0.0;                               // kg/m
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
  SpreadArray m;                              // kg/m, of the masters, as all that follows
  SpreadArray base_x, base_y;                 // acceleration at the base (m/s^2)
  SpreadArray a_x, a_y;                       // and now
  SpreadArray v_x, v_y;                       // velocity (m/s)
  SpreadArray u_x, u_y;                       // displacement since the base (m)
  std::vector<BondSensor> bonds;
};

}  // namespace strata
