// Copies of nodes of whose rock hardly anything is left, where a fracture passes a column or row of particles at a
// small angle: the particle or two in them cannot carry what the fracture's faces there exert.
#pragma once

#include "state/state.hpp"

namespace strata {

// What faces exert on a copy is balanced by the stress in its rock: int grad N_i dV = -+ int N_i n ds, of which
// particles and points are quadratures. Their ratio is at most 2.25 where whole columns of 4 x 4 particles a cell
// belong to a copy, and 1 for 2 x 2 at a grid line or mid-cell. More of it: a corner with few particles is all there
// is.
constexpr double most_load = 2.5;

// int N_i ds in cells from which on a straight fracture finds a column of 4 x 4 particles in the copy: (1/2) (1/8)^2. A
// copy that less reaches may not bear more than its particles are worth.
constexpr double least_reach = 1.0 / 128.0;

/// Where int N_i ds over a surface's split points is more than most_load (of copies below least_reach: 1) times sum_p
/// V_p |grad N_i| over the particles of a copy, the surface's stencils no longer tell its two sides apart at that node:
/// neither tractions nor jumps reach it (D and D^T alike). Needs bins, masters and stencils of `state`, changes its
/// stencils. Throws nothing.
void join_light_copies(const Scene& scene, State& state);

// Of sum_p V_p |grad N_i| around a node, what a corner between a leaning fracture and an interface needs to be a copy.
// With more, corners of soft interfaces that do slip are held: K_I of a crack at 45 degrees through springs of E'/a is
// 1.4 % off with 1/128, 2.3 % with 1/16. With less, stiff springs hold the thin wedges of a crack at 20 degrees.
constexpr double least_corner = 1.0 / 128.0;

/// Where a fracture that does not lie along the grid crosses an interface, nodes have a copy for each of up to four
/// corners, and the one or two particles at the point of a corner cannot hold those of several nodes. A corner that has
/// less than least_corner of its node's sum_p V_p |grad N_i| becomes part of the largest one that a single interface
/// parts from it (CutNode::joined), if that is larger. order: which particle of the arrays is the k-th of the bins.
/// Changes the cut nodes and bins of `state`, before blocks, masters and stencils are made. Throws nothing.
void join_corners(const Scene& scene, const std::vector<std::size_t>& order, State& state);

}  // namespace strata
