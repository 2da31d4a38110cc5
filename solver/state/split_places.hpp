// Places on surfaces where two sides of the rock exist and a law acts between them, and the springs of tips.
#pragma once

#include <cstddef>
#include <memory>
#include <vector>

#include "scene/scene.hpp"
#include "state/types.hpp"

namespace strata {

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
  std::vector<Entry> entries;
  std::vector<Neighbour> neighbours;  // itself among them
};

struct HeldFactor;

// All of them. Nodes are records or, under kinematics = "total", slots.
struct SplitPlaces {
  std::vector<std::size_t> nodes;  // that places reach
  std::vector<SplitPlace> places;
  std::vector<InterfaceLaw> laws;          // the scene's, of tips' springs, and of the fracture's faces
  std::vector<Vec2> free, v;               // of these nodes: velocity without and with what places exert (m/s)
  std::vector<Vec2> rate;                  // of each place's jump (m/s)
  std::vector<double> r_t_start;           // tangential reaction at the step's start (Pa)
  std::shared_ptr<const HeldFactor> held;  // of the places held last (solve_held_reactions())
};

}  // namespace strata
