#include "mechanics/intact_body.hpp"

#include <cholmod.h>

#include <Eigen/CholmodSupport>
#include <algorithm>
#include <cmath>
#include <numeric>

#include "mechanics/stiffness.hpp"
#include "state/rebuild.hpp"

namespace strata {

namespace {

// The node across the mirror line x = width/2.
int mirror_node(const Grid& g, int node) {
  return g.node(g.nx - g.column(node), g.row(node));
}

// The record across the mirror line: the other side of the fracture, the same side of everything else.
int mirror_record(const State& state, int record) {
  const Copies& copies = state.copies;
  const int node = copies.node_of_record[static_cast<std::size_t>(record)];
  const int c = copies.cut_of_node[static_cast<std::size_t>(node)];
  if (c < 0) return mirror_node(state.grid, node);
  const CutNode& cut = copies.cut[static_cast<std::size_t>(c)];
  const auto at = std::find(cut.records.begin(), cut.records.end(), record);
  if (at == cut.records.end()) return record;  // not in use
  const SideWord key = cut.keys[static_cast<std::size_t>(at - cut.records.begin())];
  const int found = record_of(copies, mirror_node(state.grid, node), key ^ cut.fracture);
  if (found < 0) throw std::logic_error("a record has no image across the mirror line");
  return found;
}

// The particles that stand for the block: all of them, or the left half twice.
std::vector<double> weights_of(const Scene& scene, const State& state, bool halved) {
  std::vector<double> weight(state.particles.size(), 1.0);
  if (!halved) return weight;
  for (std::size_t q = 0; q < weight.size(); ++q)
    weight[q] = state.particles.x[q] < 0.5 * scene.domain.width_m ? 2.0 : 0.0;
  return weight;
}

// Ties the corner unknowns that rigid motion needs held, so that K is regular.
void hold_rigid_motion(const Scene& scene, const Grid& grid, bool halved, std::vector<Master>& masters) {
  const bool x_held = halved || scene.domain.holds_x(), y_held = scene.domain.holds_y();
  const auto hold = [&](int node, bool x) {
    for (Master& master : masters) {
      if (master.record == node) (x ? master.x : master.y) = 0.0;
    }
  };
  if (!x_held) hold(grid.node(0, 0), true);
  if (!y_held) hold(grid.node(0, 0), false);
  if (!x_held && !y_held) hold(grid.node(grid.nx, 0), false);
}

}  // namespace

bool mirror_symmetric(const Scene& scene, const State& state) {
  if (!scene.fracture || scene.strata.along != Strata::Along::y) return false;
  if (scene.body.acceleration_m_s2) return false;  // its formulas need not be symmetric
  if (scene.domain.sides != Edge::fixed || scene.fracture->direction != Fracture::Direction::straight) return false;
  const double middle = 0.5 * scene.domain.width_m, h = state.grid.h;
  const double halves = 2.0 * middle / h;
  if (std::abs(halves - std::round(halves)) > 1e-6) return false;
  return std::all_of(scene.fracture->path_m.begin(), scene.fracture->path_m.end(),
                     [&](const auto& point) { return std::abs(point[0] - middle) < 1e-9 * h; });
}

std::vector<Master> mirrored(const State& state, std::vector<Master> masters) {
  const Grid& g = state.grid;
  const std::vector<Master> edges = masters;
  for (Master& master : masters) {
    const int node = state.copies.node_of_record[static_cast<std::size_t>(master.record)];
    const int column = g.column(node);
    if (2 * column < g.nx) continue;
    const int image = mirror_record(state, master.record);
    if (image == master.record) {  // on the line and not split by the fracture
      if (2 * column == g.nx) master.x = 0.0;
    } else if (2 * column > g.nx || master.record > image) {
      const Master& beyond = edges[static_cast<std::size_t>(image)];  // may itself be tied to an edge
      master = {beyond.record, -master.x * beyond.x, master.y * beyond.y};
    }
  }
  return masters;
}

struct IntactBody::Factor {
  mutable cholmod_common common{};
  cholmod_factor* blocks = nullptr;   // supernodal: whole solves
  cholmod_factor* columns = nullptr;  // simplicial: solves along branches
  std::vector<int> place;             // where the factor's ordering puts an unknown

  Factor() { cholmod_start(&common); }
  Factor(const Factor&) = delete;
  Factor& operator=(const Factor&) = delete;
  ~Factor() {
    cholmod_free_factor(&blocks, &common);
    cholmod_free_factor(&columns, &common);
    cholmod_finish(&common);
  }
};

IntactBody::~IntactBody() = default;
IntactBody::IntactBody(IntactBody&&) noexcept = default;
IntactBody& IntactBody::operator=(IntactBody&&) noexcept = default;

IntactBody::IntactBody(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state, bool halved)
    : factor_(std::make_unique<Factor>()), particles_(state.particles.size()), halved_(halved) {
  State intact;
  intact.grid = state.grid;
  intact.particles = state.particles;
  const std::vector<double> weight = weights_of(scene, state, halved);
  for (std::size_t q = 0; q < weight.size(); ++q) intact.particles.V[q] *= weight[q];
  rebuild_copies(scene, intact);
  masters_ = halved ? mirrored(intact, intact.masters) : intact.masters;
  hold_rigid_motion(scene, state.grid, halved, masters_);
  const Eigen::SparseMatrix<double> K = assemble_stiffness(scene, rocks, intact, masters_);
  cholmod_sparse view = Eigen::viewAsCholmod(K.selfadjointView<Eigen::Lower>());
  cholmod_common& common = factor_->common;
  common.print = 0;
  common.supernodal = CHOLMOD_SUPERNODAL;
  factor_->blocks = cholmod_analyze(&view, &common);
  cholmod_factorize(&view, factor_->blocks, &common);
  if (common.status != CHOLMOD_OK)
    throw NumericalFailure("the stiffness of the intact block is singular: its edges leave a motion free");
  factor_->columns = cholmod_copy_factor(factor_->blocks, &common);
  cholmod_change_factor(CHOLMOD_REAL, 1, 0, 1, 1, factor_->columns, &common);
  const int* order = static_cast<const int*>(factor_->columns->Perm);
  factor_->place.resize(factor_->columns->n);
  for (std::size_t k = 0; k < factor_->place.size(); ++k)
    factor_->place[static_cast<std::size_t>(order[k])] = static_cast<int>(k);
}

Eigen::VectorXd IntactBody::solve(const Eigen::VectorXd& f) const {
  Eigen::VectorXd load = f;
  cholmod_dense view = Eigen::viewAsCholmod(load);
  cholmod_dense* x = cholmod_solve(CHOLMOD_A, factor_->blocks, &view, &factor_->common);
  Eigen::VectorXd u = Eigen::Map<const Eigen::VectorXd>(static_cast<const double*>(x->x), f.size());
  cholmod_free_dense(&x, &factor_->common);
  return u;
}

SparseVector IntactBody::forward(const SparseVector& g) const {
  const std::size_t n = factor_->place.size();
  cholmod_common& common = factor_->common;
  cholmod_dense* b = cholmod_zeros(n, 1, CHOLMOD_REAL, &common);
  cholmod_sparse* pattern = cholmod_allocate_sparse(n, 1, g.index.size(), 0, 1, 0, CHOLMOD_PATTERN, &common);
  std::vector<int> at(g.index.size());
  for (std::size_t k = 0; k < at.size(); ++k) {
    at[k] = factor_->place[static_cast<std::size_t>(g.index[k])];
    static_cast<double*>(b->x)[at[k]] = g.value[k];
  }
  std::sort(at.begin(), at.end());
  std::copy(at.begin(), at.end(), static_cast<int*>(pattern->i));
  static_cast<int*>(pattern->p)[0] = 0;
  static_cast<int*>(pattern->p)[1] = static_cast<int>(at.size());
  cholmod_dense *x = nullptr, *y = nullptr, *e = nullptr;
  cholmod_sparse* reached = nullptr;
  cholmod_solve2(CHOLMOD_L, factor_->columns, b, pattern, &x, &reached, &y, &e, &common);
  const int count = static_cast<const int*>(reached->p)[1];
  SparseVector out;
  out.index.assign(static_cast<const int*>(reached->i), static_cast<const int*>(reached->i) + count);
  std::sort(out.index.begin(), out.index.end());
  for (const int k : out.index) out.value.push_back(static_cast<const double*>(x->x)[k]);
  for (auto** dense : {&b, &x, &y, &e}) cholmod_free_dense(dense, &common);
  for (auto** sparse : {&pattern, &reached}) cholmod_free_sparse(sparse, &common);
  return out;
}

}  // namespace strata
