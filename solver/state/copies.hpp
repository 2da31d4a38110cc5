// Copies of nodes. Seen from a node near surfaces, particles on different sides of them belong to different velocity
// fields (CRAMP, Nairn 2003): such a node has a copy for each combination of sides that occurs. Nodes away from split
// surfaces have one record. Particles that share a node stencil and a side word form a bin, so that the transfer loops
// see nine record indices and a range of particles, cut or not.
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "scene/scene.hpp"
#include "state/grid.hpp"
#include "state/spread_array.hpp"
#include "state/surfaces.hpp"

namespace strata {

struct CutNode {
  SideWord mask = 0;              // the surfaces that split this node
  std::vector<SideWord> entered;  // with interfaces too: the sides of them on which the fracture splits it, those that
                                  // it has entered; ahead of a tip only those behind an interface that is apart
  SideWord fracture = 0;          // the fracture's bit, where it splits this node
  std::vector<std::array<SideWord, 2>>
      joined;                  // a corner with hardly any rock, and the one that its particles belong to
  std::vector<SideWord> keys;  // the side combinations that occur
  std::vector<int> records;    // and the record of each

  SideWord key(SideWord sides) const;

  // That of one of its records; none where the record is not in use.
  std::optional<SideWord> key_of(int record) const;
};

struct Copies {
  std::vector<int> cut_of_node;  // index into cut, or -1: the node has the one record of its own index
  std::vector<CutNode> cut;
  std::vector<int> node_of_record;  // grid node of each record; records beyond Grid::nodes() are further copies
  int records() const { return static_cast<int>(node_of_record.size()); }
  int node(int record) const { return node_of_record[static_cast<std::size_t>(record)]; }

  // What a node is cut into; nullptr: nothing.
  const CutNode* cut_at(int node) const {
    const int c = cut_of_node[static_cast<std::size_t>(node)];
    return c < 0 ? nullptr : &cut[static_cast<std::size_t>(c)];
  }
};

// Neighbouring bins of a row whose records are neighbours too may form a block: each is a lane of vectors (see
// lanes.hpp), and the k-th particles of all of them, of the same rock, stand side by side. A bin of a block of n has
// every n-th particle from its first one on; its bins follow each other, each with stride n. A bin takes a line of
// memory of its own: sweeps read the first of each block alone.
struct alignas(line_bytes) Bin {
  int first = 0, last = 0;      // particles first, first + stride, ... below last
  int stride = 1;               // bins of its block
  int i = 0, j = 0;             // column and row of the middle node of the 3 x 3 stencil
  std::array<int, 9> record{};  // records of the stencil's nodes, row by row from the lower left

  // for (const std::size_t q : bin) goes through its particles.
  struct Iterator {
    int at, stride;
    std::size_t operator*() const { return static_cast<std::size_t>(at); }
    bool operator!=(const Iterator& end) const { return at < end.at; }
    void operator++() { at += stride; }
  };
  Iterator begin() const { return {first, stride}; }
  Iterator end() const { return {last, stride}; }
};
static_assert(sizeof(Bin) == line_bytes);

// Bins of a few neighbouring rows. Strips of the same colour (even or odd) share no record, so threads may work on them
// at the same time and every sum has one fixed order.
struct Strip {
  int first = 0, last = 0;  // bins [first, last)
};

// Symmetric and fixed edges tie records together: the velocity of a record is that of its master, component by
// component times x and y. Most records are their own master with factors 1; a ghost outside the edge mirrors a record
// inside (one factor -1), and a node on the edge has a factor 0 across it.
struct Master {
  int record = 0;
  double x = 1.0, y = 1.0;

  double of(int component) const { return component == 0 ? x : y; }
};

// The nodes that a place on a surface reaches: D w = sum_i N_i (u[plus_i] - u[minus_i]).
struct SurfaceStencil {
  int i = 0, j = 0;  // column and row of the middle node
  std::array<int, 9> plus{}, minus{};
  std::array<double, 9> N{};
};

/// The copy of a node that a place with these sides belongs to: index of its record, or -1 where no such copy exists.
int record_of(const Copies& copies, int node, SideWord sides);

/// Reactions (Pa) of a surface's points as nodes carry them: r(s) = sum N_i R_i/sum N_i over the nodes that tell its
/// sides apart, R_i = sum A N_i r/sum A N_i. The points of a cell share its jump, so what one of them takes of the
/// force on a node is not determined. A split point without such a node, at a tip, has what the next one has.
std::vector<Vec2> nodal_reactions(const Surface& surface, const std::vector<SurfaceStencil>& stencils);

}  // namespace strata
