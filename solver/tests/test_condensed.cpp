#include "quasistatic/condensed.hpp"

#include <Eigen/Cholesky>
#include <catch2/catch.hpp>
#include <random>

#include "fracture/growth.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// A crack from the symmetric bottom through a soft interface between two rocks, sides held: mirror-symmetric.
Scene through_interface(double crack_x, double interface_y, double tip_y, double width = 8.0, double pressure = 3e6) {
  Scene scene = block(static_cast<int>(width), 8);
  scene.domain.bottom = Edge::symmetry;
  scene.domain.sides = Edge::fixed;
  scene.in_situ.horizontal_Pa = 2e6;
  scene.in_situ.vertical_Pa = 3e6;
  scene.rocks.push_back({"soft", 5e9, 0.25, 2500.0, 1.25e6});
  add_interface(scene, soft_law(2e9, 1e9), interface_y, 1);
  add_fracture(scene, {{crack_x, 0.0}, {crack_x, tip_y}}, pressure);
  return scene;
}

// S of the definition in condensed.hpp from a stiffness of all records, assembled and eliminated without sparse tools.
Eigen::MatrixXd schur_complement(Statics& s) {
  const IntactBody& body = *s.model.body;
  const Condensed& condensed = s.model.condensed;
  State weighted = s.state();
  for (std::size_t q = 0; q < weighted.particles.size() && body.halved; ++q)
    weighted.particles.V[q] *= weighted.particles.x[q] < 0.5 * s.run.scene.domain.width_m ? 2.0 : 0.0;
  const Eigen::MatrixXd lower(assemble_stiffness(s.run.scene, s.run.rocks, weighted, condensed.masters));
  const Eigen::MatrixXd K = lower.selfadjointView<Eigen::Lower>();
  const Eigen::Index base = body.unknowns(), jumps = condensed.size();
  Eigen::MatrixXd T = Eigen::MatrixXd::Zero(K.rows(), base + jumps);  // records from (u, j)
  for (int record = 0; record < s.state().copies.records(); ++record) {
    const auto r = static_cast<std::size_t>(record);
    if (condensed.masters[r].record != record || (is_cut(s.state().copies, record) && s.state().sums[r].m == 0.0))
      continue;
    for (int c = 0; c < 2; ++c) {
      const Unknown u = unknown_of(body.masters, s.state().copies.node_of_record[r], c);
      const int j = condensed.jump_of_record[r][static_cast<std::size_t>(c)];
      if (unknown_of(condensed.masters, record, c).index < 0) continue;
      if (u.index >= 0) T(2 * record + c, u.index) = u.factor;
      if (j >= 0) T(2 * record + c, base + j) = 1.0;
    }
  }
  Eigen::MatrixXd both = T.transpose() * K * T;
  for (Eigen::Index k = 0; k < base; ++k) {
    if (both(k, k) == 0.0) both(k, k) = 1.0;  // held, or a ghost that nothing touches
  }
  const Eigen::MatrixXd K_uj = both.topRightCorner(base, jumps);
  return both.bottomRightCorner(jumps, jumps) - K_uj.transpose() * both.topLeftCorner(base, base).ldlt().solve(K_uj);
}

double largest(const Eigen::MatrixXd& m) {
  return m.cwiseAbs().maxCoeff();
}

}  // namespace

// Requires that S is the Schur complement of a dense stiffness of all records to 1e-11 of its largest entry (measured:
// below 1e-13), and symmetric: whole, halved, with no edge held, a crack in a cell, a crack at an angle. Mutations
// that fail: S = K_jj, S = K_jj + Y^T Y, twice S, the halved block's left half counted once.
TEST_CASE("S is the Schur complement of the stiffness of all records") {
  std::vector<Scene> scenes{through_interface(4.0, 4.0, 3.0), through_interface(4.0, 3.5, 6.0),
                            through_interface(4.5, 4.0, 5.25, 9.0)};
  for (const auto& path : std::vector<std::vector<std::array<double, 2>>>{
           {{4.0, 3.0}, {4.0, 5.25}}, {{3.5, 2.0}, {3.5, 6.0}}, {{2.6, 2.3}, {5.2, 5.7}}}) {
    scenes.push_back(block(8, 8));
    add_fracture(scenes.back(), path, 1e6);
  }
  bool some_halved = false;
  for (const Scene& scene : scenes) {
    for (const bool halve : {true, false}) {
      Statics s(scene, halve);
      some_halved = some_halved || s.model.body->halved;
      const Eigen::MatrixXd expected = schur_complement(s), &S = s.model.condensed.S;
      REQUIRE(S.rows() > 4);
      CHECK(largest(S - S.transpose()) == 0.0);
      CHECK(largest(S - expected) < 1e-11 * largest(expected));
    }
  }
  CHECK(some_halved);
}

// Requires that S has the same digits whether a fracture is there at once or has grown into place, through a
// soft interface and with a tip within a cell, and whether the columns of a weak interface failed from the left or from
// the right. Mutations that fail: fingerprints by node alone, entries of old and new columns not computed.
TEST_CASE("what is condensed does not depend on the way there") {
  Scene scene = through_interface(4.0, 4.0, 2.0, 8.0);
  Statics grown(scene);
  for (const double increment : {1.0, 0.5, 0.5, 1.0, 0.75}) {
    State& state = grown.state();
    extend_tip(scene, state, state.tips.front(), increment);
    state.fluid.P.assign(state.fracture().vertices.size(), 3e6);
    grown.update();
    QuasistaticModel fresh;
    State same = state;
    update_model(grown.run.scene, grown.run.rocks, same, fresh);
    REQUIRE(fresh.condensed.size() == grown.model.condensed.size());
    CHECK((fresh.condensed.S.array() == grown.model.condensed.S.array()).all());
  }
  CHECK(grown.state().fracture().length() == Approx(5.75));

  Scene weak = block(8, 8);
  hold_edges(weak);
  add_interface(weak, weak_law(1e5, 1e5), 4.0);
  Statics left(weak), right(weak);
  REQUIRE(left.model.condensed.size() == 0);
  for (int column = 0; column <= 8; ++column) {
    for (SurfacePoint& s : left.state().surfaces[0].points) s.split = s.split || s.column == column;
    for (SurfacePoint& s : right.state().surfaces[0].points) s.split = s.split || s.column == 8 - column;
    left.update(), right.update();
  }
  REQUIRE(left.model.condensed.size() > 10);
  CHECK((left.model.condensed.S.array() == right.model.condensed.S.array()).all());
}

// Requires that half the block has the jumps, displacements, K and J of the whole to 1e-9, on a grid line and at
// mid-cell, with contact on part of the interface. Measured: 1e-12. Mutations that fail: half counted once, u_x of the
// mirror with the sign of u_y, the mirror line's u_x left free.
TEST_CASE("half a block answers for the whole") {
  for (const double width : {20.0, 21.0}) {
    Scene scene = through_interface(0.5 * width, 4.5, 3.0, width);
    scene.in_situ.vertical_Pa = 0.05e6;
    scene.domain.height_m = 16.0;
    scene.strata.layers.back().to_m = 16.0;
    scene.fracture->path_m = {{0.5 * width, 0.0}, {0.5 * width, 5.25}};
    Statics half(scene, true), whole(scene, false);
    REQUIRE(half.model.body->halved);
    REQUIRE_FALSE(whole.model.body->halved);
    CHECK(10 * half.model.condensed.size() < 6 * whole.model.condensed.size());
    half.solve(), whole.solve();
    REQUIRE(half.at.w.size() == whole.at.w.size());
    double scale = 0.0, off = 0.0;
    std::array<int, 2> pieces{};
    for (std::size_t k = 0; k < half.at.w.size(); ++k) {
      scale = std::max(scale, whole.at.w[k].norm());
      off = std::max(off, (half.at.w[k] - whole.at.w[k]).norm());
      if (whole.model.places[k].surface == 1) ++pieces[whole.at.pieces[k] == LawAnswer::Piece::open ? 0 : 1];
    }
    CHECK(pieces[0] > 0);
    CHECK(pieces[1] > 0);
    CHECK(off < 1e-9 * scale);
    const Particles &p = half.state().particles, &all = whole.state().particles;
    CHECK(largest_difference(p, all) < 1e-9 * largest_displacement(all));
    REQUIRE(whole.state().tips.front().J > 1.0);
    CHECK(half.state().tips.front().J == Approx(whole.state().tips.front().J).epsilon(1e-9));
    CHECK(half.state().tips.front().K_I == Approx(whole.state().tips.front().K_I).epsilon(1e-9));
    CHECK(half.at.energy == Approx(whole.at.energy).epsilon(1e-9));
  }
}

// Requires that the columns of the grid do not change the answer: K_I, J and opening of a crack in the middle under
// random gradings, alike on both sides or not, with a soft interface above it or none, are those of the whole block to
// 1e-9, and to 0.2 % those of a uniform grid (1 m cells; the rings of J reach into growing ones). Mutations that fail:
// columns not looked at (K_I 0 to 3 times as large, or a mechanism), rings' weights by cell_m where cells are longer
// (8 %).
TEST_CASE("columns of any kind give the same K") {
  std::mt19937 random(11);
  const auto width = 40.0;
  for (const bool interface : {false, true}) {
    Scene scene = through_interface(0.5 * width, 14.0, 8.0, width);
    scene.domain.height_m = 24.0;
    scene.strata.layers.back().to_m = 24.0;
    scene.strata.layers.back().rock = 0;
    if (!interface) scene.strata.interfaces[0].law = 0;
    Statics uniform(scene);
    uniform.solve();
    const Tip expected = uniform.state().tips.front();
    REQUIRE(expected.K_I > 1e6);
    scene.numerics.far_cell_m = 4.0;
    std::array<int, 2> halves{};
    for (int trial = 0; trial < 8; ++trial) {
      const double left = static_cast<double>(1 + random() % 18), right = static_cast<double>(1 + random() % 18);
      scene.numerics.fine_left_m = 0.5 * width - left;
      scene.numerics.fine_right_m = 0.5 * width + (trial % 4 == 0 ? left : right);
      Statics any(scene), whole(scene, false);
      any.solve(), whole.solve();
      const Tip &tip = any.state().tips.front(), &of_whole = whole.state().tips.front();
      CAPTURE(interface, left, right);
      CHECK(tip.K_I == Approx(of_whole.K_I).epsilon(1e-9));
      CHECK(tip.J == Approx(of_whole.J).epsilon(1e-9));
      CHECK(tip.K_I == Approx(expected.K_I).epsilon(2e-3));
      CHECK(tip.J == Approx(expected.J).epsilon(2e-3));
      CHECK(std::abs(tip.K_II) < 1e-3 * tip.K_I);
      ++halves[any.model.body->halved ? 1 : 0];
    }
    CHECK(halves[0] > 2);
    CHECK(halves[1] > 1);
  }
}
