#include "quasistatic/tree_factor.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <catch2/catch.hpp>
#include <cmath>

#include "state/types.hpp"
#include "statics.hpp"

using namespace strata;

namespace {

// A matrix with the pattern of quadratic B-splines on a grid of nx x ny nodes with two unknowns each, diagonally
// dominant, no two of its entries alike.
Eigen::SparseMatrix<double> grid_matrix(int nx, int ny) {
  std::vector<Eigen::Triplet<double>> entries;
  const auto unknown = [nx](int i, int j, int c) { return 2 * (j * nx + i) + c; };
  for (int j = 0; j < ny; ++j) {
    for (int i = 0; i < nx; ++i) {
      for (int k = 0; k < 100; ++k) {
        const int i_2 = i + k % 5 - 2, j_2 = j + k / 5 % 5 - 2, c = k / 25 % 2, c_2 = k / 50;
        if (i_2 < 0 || j_2 < 0 || i_2 >= nx || j_2 >= ny) continue;
        const int row = unknown(i, j, c), column = unknown(i_2, j_2, c_2);
        if (row > column) entries.emplace_back(row, column, std::sin(1.0 + row + 0.37 * column));
        if (row == column) entries.emplace_back(row, row, 60.0 + std::cos(row));
      }
    }
  }
  Eigen::SparseMatrix<double> K(2 * nx * ny, 2 * nx * ny);
  K.setFromTriplets(entries.begin(), entries.end());
  return K;
}

Eigen::VectorXd dense(const SparseVector& v, Eigen::Index n) {
  Eigen::VectorXd x = Eigen::VectorXd::Zero(n);
  for (const auto& [index, value] : v) x[index] = value;
  return x;
}

// Y = L^-1 P g of each g, up to 16 at a time.
std::vector<SparseVector> forward(const TreeFactor& factor, const std::vector<SparseVector>& g) {
  constexpr std::size_t most = TreeFactor::together;
  std::vector<SparseVector> Y;
  for (std::size_t from = 0; from < g.size(); from += most) {
    const auto first = g.begin() + static_cast<std::ptrdiff_t>(from);
    TreeFactor::SideBySide y;
    for (auto& of : factor.forward({first, first + static_cast<std::ptrdiff_t>(std::min(most, g.size() - from))}, y)) {
      for (const auto& [row, value] : of) CHECK(y(row, static_cast<Eigen::Index>(Y.size() - from)) == value);
      Y.push_back(std::move(of));
    }
  }
  return Y;
}

double dot(const SparseVector& a, const SparseVector& b) {
  return dense(a, 10000).dot(dense(b, 10000));
}

// Loads of a few neighbouring unknowns each, more of them than go through the factor together.
std::vector<SparseVector> some_loads(int n) {
  std::vector<SparseVector> loads;
  for (int k = 0; k < 37; ++k) {
    SparseVector& g = loads.emplace_back();
    for (int e = 0; e < 5; ++e) g.emplace_back((17 * k) % (n - 9) + 2 * e, 1.0 + k - 0.3 * e);
  }
  return loads;
}

}  // namespace

// Requires that K x = f to 1e-12 against a dense solve, and that a solve from a few loads for a few unknowns has the
// digits of the whole one there.
TEST_CASE("a solve along branches is the whole solve where it is asked for") {
  const Eigen::SparseMatrix<double> K = grid_matrix(23, 31);
  const Eigen::Index n = K.rows();
  const TreeFactor factor(K, "singular");
  const Eigen::MatrixXd whole = Eigen::MatrixXd(K).selfadjointView<Eigen::Lower>();
  for (const SparseVector& g : some_loads(static_cast<int>(n))) {
    const Eigen::VectorXd f = dense(g, n), x = factor.solve(f);
    CHECK((whole * x - f).lpNorm<Eigen::Infinity>() < 1e-12 * f.lpNorm<Eigen::Infinity>());
    const std::vector<int> asked{g.front().first, static_cast<int>(n) - 1 - g.back().first, 700};
    std::vector<int> pushed;
    for (const auto& [unknown, value] : g) pushed.push_back(unknown);
    const auto loaded = factor.branches(pushed), wanted = factor.branches(asked);
    CHECK(loaded.size() < factor.all().size());
    Eigen::VectorXd part = Eigen::VectorXd::Zero(n);
    for (const int k : pushed) part[factor.row(k)] = f[k];
    factor.solve(loaded, wanted, part);
    for (const int k : asked) CHECK(part[factor.row(k)] == x[k]);
  }
}

// Requires that Y_a . Y_b is g_a K^-1 g_b to 1e-12, and that the digits of Y do not depend on what else is solved for.
TEST_CASE("forward gives one half of the inverse") {
  const Eigen::SparseMatrix<double> K = grid_matrix(19, 24);
  const auto n = static_cast<int>(K.rows());
  const TreeFactor factor(K, "singular");
  const std::vector<SparseVector> g = some_loads(n);
  const std::vector<SparseVector> Y = forward(factor, g);
  const Eigen::LDLT<Eigen::MatrixXd> whole(Eigen::MatrixXd(K).selfadjointView<Eigen::Lower>());
  for (std::size_t a = 0; a < g.size(); ++a) {
    const Eigen::VectorXd x = whole.solve(dense(g[a], n));
    for (std::size_t b = 0; b < g.size(); b += 5) {
      const double product = dot(Y[a], Y[b]), expected = dense(g[b], n).dot(x);
      CHECK(product == Approx(expected).epsilon(1e-11).margin(1e-13));
    }
    const SparseVector alone = forward(factor, {g[a]}).front();
    CHECK(alone == Y[a]);
  }
}

TEST_CASE("a matrix that is not positive definite is refused with the text given") {
  Eigen::SparseMatrix<double> K = grid_matrix(4, 4);
  K.coeffRef(7, 7) = -1.0;
  CHECK_THROWS_WITH(TreeFactor(K, "moves freely"), "moves freely");
}

// Requires that the displacements of a few records have the digits that they have among all, and that between outputs
// the particles which decide what happens next hold the fields that they hold when all do.
TEST_CASE("displacements of a few records are those among all") {
  using namespace strata::test;
  Scene scene = block(16, 16);
  scene.domain.bottom = Edge::symmetry;
  scene.domain.sides = Edge::fixed;
  add_interface(scene, weak_law(1e9, 1e9), 9.0);
  add_fracture(scene, {{8.0, 0.0}, {8.0, 6.0}}, 2e6);
  Statics s(scene);
  s.at = find_equilibrium(s.run.scene, 0.0, s.state(), s.model);
  set_fields(s.run.scene, s.state(), s.model, s.at);
  const Particles few = s.state().particles;
  const IntactBody& body = *s.model.body;
  const auto part = displacements(scene, s.state(), body, s.model.condensed, s.at.j, s.model.asked);
  const auto all = displacements(scene, s.state(), body, s.model.condensed, s.at.j, ask_for_all(s.state(), body));
  REQUIRE(s.model.asked.blocks.size() < body.factor.all().size());
  double largest = 0.0;
  for (const int record : s.model.asked.records) {
    const auto r = static_cast<std::size_t>(record);
    CHECK(part[r] == all[r]);
    largest = std::max(largest, all[r].norm());
  }
  CHECK(largest > 1e-5);
  set_all_particles(s.run.scene, s.state(), s.model);
  std::size_t same = 0;
  for (const std::size_t b : s.model.watched) {
    for (int q = s.state().bins[b].first; q < s.state().bins[b].last; ++q) {
      const auto k = static_cast<std::size_t>(q);
      CHECK(few.g_yy[k] == s.state().particles.g_yy[k]);
      same += few.g_yy[k] != 0.0 ? 1U : 0U;
    }
  }
  CHECK(same > 100);
}
