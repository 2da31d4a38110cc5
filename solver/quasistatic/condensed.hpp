// Elasticity of the block condensed onto the jumps across its split surfaces.
//
// A copy c of a split node moves with u_c = u + j_c, where u is the motion that the uncut node would have and j_c a
// jump of its own. With u as unknowns the stiffness of the cut block is that of the intact one, whatever is split, and
// a jump adds a row: K_uj = G = sum_p V_p B^T C B over the particles that belong to the copy. Where surfaces carry all
// loads the rows of u have none (see load_body() in model.cpp for those of a body force), u = -K^-1 G j, and
//   S j = D^T t A,  S = K_jj - G^T K^-1 G = K_jj - Y^T Y,  Y = L^-1 P G.
// The block is factored once; a fracture that grows, or an interface that fails, adds a few columns.
#pragma once

#include <Eigen/Core>
#include <array>
#include <compare>
#include <cstdint>
#include <memory>
#include <vector>

#include "quasistatic/intact_body.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"
#include "state/stiffness.hpp"

namespace strata {

// A jump unknown: a component of a copy of a node, told by the particles that belong to the copy. What depends on these
// alone is kept while the fracture grows elsewhere.
struct JumpKey {
  int node = 0;
  int component = 0;
  std::uint64_t particles = 0;                       // fingerprint of the set
  auto operator<=>(const JumpKey&) const = default;  // NOLINT(modernize-use-nullptr)
};

struct JumpColumn {
  JumpKey key;
  SparseVector G;
  SparseVector Y;  // in rows of the factor
};

// The load of a body force at one time (see load_body()).
struct BodyLoad {
  double time = 0.0;       // s
  Eigen::VectorXd intact;  // on the unknowns of the intact block (N/m); none where there is no body force
  Eigen::VectorXd jumps;   // what the jumps feel of it (N/m)
  double strain = 0.0;     // strain energy under it where no surface gives way (J/m)
  bool empty() const { return intact.size() == 0; }
};

struct Condensed {
  std::vector<Master> masters;                             // of the state's records, the mirror's ties included
  std::vector<std::array<int, 2>> jump_of_record;          // a master record's own jump unknowns; -1: none
  std::vector<std::shared_ptr<const JumpColumn>> columns;  // one a jump unknown
  Eigen::MatrixXd S;                                       // N/m per metre of thickness
  TreeFactor::Branches loaded;                             // what of the intact body's factor jumps load
  BodyLoad load;                                           // none until it is loaded
  Eigen::Index size() const { return S.rows(); }
};

/// The condensed operator of a state whose copies are built and whose nodes have their masses (state.sums). Columns and
/// entries that `before` has for the same particles are taken from there. Sums have an order of their own, so that the
/// result has the same digits whatever came before. Throws nothing.
Condensed condense(const Scene& scene, const Rocks& rocks, const State& state, const IntactBody& body,
                   const Condensed* before);

/// The jump unknown that a record's component is a multiple of; index -1: it moves with the uncut node.
Unknown jump_unknown(const Condensed& condensed, int record, int component);

// Records whose displacements are asked for, and what of the intact body's factor they need.
struct Asked {
  std::vector<int> records;
  TreeFactor::Branches blocks;
};

/// What it takes to find the displacements of the records of some bins. Where an edge leaves a rigid motion free all
/// others take part in what is taken out.
Asked ask_for(const Scene& scene, const State& state, const IntactBody& body, const std::vector<std::size_t>& bins);

/// All records.
Asked ask_for_all(const State& state, const IntactBody& body);

/// Displacements (m) of all records, 0 where they were not asked for, for the jumps j (m): u = K^-1 (f_u - G j), and
/// the copies' jumps on top; rigid motion that no edge holds is taken out (zero mean displacement and rotation of the
/// particles). The digits do not depend on what else is asked for.
std::vector<Vec2> displacements(const Scene& scene, const State& state, const IntactBody& body,
                                const Condensed& condensed, const Eigen::VectorXd& j, const Asked& asked);

}  // namespace strata
