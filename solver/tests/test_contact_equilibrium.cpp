#include "quasistatic/contact_equilibrium.hpp"

#include <catch2/catch.hpp>

#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// Modulus of a bar that does not widen (Pa).
double modulus(const Rock& rock) {
  const double nu = rock.poisson_ratio;
  return rock.youngs_modulus_Pa * (1.0 - nu) / ((1.0 + nu) * (1.0 - 2.0 * nu));
}

// Compliance (m/Pa) of all layers in series.
double compliance(const Scene& scene) {
  double sum = 0.0;
  for (const Layer& layer : scene.strata.layers) sum += (layer.to_m - layer.from_m) / modulus(scene.rocks[layer.rock]);
  return sum;
}

// Two rocks stacked along an axis with an interface at `at`, no edge moves.
Scene bars(const InterfaceLaw& law, double at, Strata::Along along = Strata::Along::y) {
  Scene scene = block(8, 8);
  hold_edges(scene);
  scene.rocks.push_back({"soft", 2e9, 0.3, 2500.0, 1.25e6});
  scene.strata.along = along;
  add_interface(scene, law, at, 1);
  return scene;
}

// Largest difference of the jumps of interface 0 from w_n and w_t (m).
double jump_error(const Statics& s, double w_n, double w_t) {
  double most = 0.0;
  for (std::size_t k = 0; k < s.model.places.size(); ++k) {
    const Vec2& n = s.model.places[k].n;
    most = std::max({most, std::abs(s.at.w[k].dot(n) - w_n), std::abs(cross(n, s.at.w[k]) + w_t)});
  }
  return most;
}

// Mean displacement of the whole block, and what its mean rotation moves its far end by (m).
std::array<double, 2> rigid_motion(const Statics& s) {
  const Domain& domain = s.run.scene.domain;
  const Vec2 centre{0.5 * domain.width_m, 0.5 * domain.height_m};
  const Particles& p = s.run.state.particles;
  double area = 0.0, turn = 0.0, polar = 0.0;
  Vec2 mean = Vec2::Zero();
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 u{p.u_x[q], p.u_y[q]}, arm = Vec2{p.x[q], p.y[q]} - centre;
    mean += p.V[q] * u, turn += p.V[q] * cross(arm, u), polar += p.V[q] * arm.squaredNorm(), area += p.V[q];
  }
  return {(mean / area).norm(), std::abs(turn / polar) * centre.y()};
}

}  // namespace

// Requires the exact opening P sum(L/M) of a block cut through, between held edges and under uniform pressure, to 1e-7
// at every place, on a grid line and at mid-cell, for both ways of stacking, equal and different rocks, B-splines and
// hats. Measured: 1e-12. Mutations that fail: no pressure, twice A, the sign of n.
TEST_CASE("uniform pressure on a full cut") {
  for (const auto along : {Strata::Along::y, Strata::Along::x}) {
    for (const double at : {4.0, 3.5, 5.0}) {
      for (const auto shape : {Numerics::Shape::bspline2, Numerics::Shape::linear}) {
        if (shape == Numerics::Shape::linear && at == 3.5) continue;
        Scene scene = bars(weak_law(1e5, 1e5), at, along);
        scene.numerics.shape = shape;
        scene.in_situ = {3e6, 3e6};
        Statics s(scene);
        fail_all(s.state());
        press(s.state(), Surface::Kind::interface, 4e6);
        s.update();
        s.solve();
        const double w = 1e6 * compliance(scene);
        REQUIRE(w > 1e-4);
        CAPTURE(at, static_cast<int>(along), static_cast<int>(shape));
        CHECK(jump_error(s, w, 0.0) < 1e-7 * w);
        CHECK(s.at.energy == Approx(-0.5 * 1e6 * w * 8.0).epsilon(1e-7));
      }
    }
  }
}

// Requires the exact opening of bars in series with a spring, w = T C/(1 + D C) under a tension T that is let go, for D
// from 1e3 to 1e15 Pa/m, to 1e-7: rigid and free limits, grid line and mid-cell, two rocks; with contact (the spring's
// other branch) and without, loaded by the pressure of a fluid; and with T in compression, where contact stays closed
// to 1e-4 of a cell's give and a two-way spring closes by as much. Mutations that fail: D doubled or left out, its
// sign, laws at nodes (each place's jump that of its nearest node), A doubled.
TEST_CASE("bars in series with a soft interface") {
  for (const auto compression : {InterfaceLaw::Compression::contact, InterfaceLaw::Compression::spring}) {
    for (const double at : {4.0, 3.5}) {
      for (double D = 1e3; D < 2e15; D *= 100.0) {
        for (const double T : {1e6, -1e6}) {
          Scene scene = bars(soft_law(D, 0.3 * D, compression), at);
          const bool two_way = compression == InterfaceLaw::Compression::spring;
          if (!two_way) scene.in_situ.vertical_Pa = -T;
          Statics s(scene);
          if (two_way) press(s.state(), Surface::Kind::interface, T);  // goes on carrying the in-situ stress
          s.solve();
          const double C = compliance(scene), w = T * C / (1.0 + D * C);
          CAPTURE(at, D, T, static_cast<int>(compression));
          if (T > 0.0 || two_way) {
            CHECK(jump_error(s, w, 0.0) < 1e-7 * std::abs(w));
          } else {
            CHECK(jump_error(s, 0.0, 0.0) < 1e-4 * std::abs(T) * C);
          }
        }
      }
    }
  }
}

// Requires the exact jump T/D between edges that carry the traction, whatever the rocks, for the same D: to 1e-7, with
// no strain in the rock (its energy 1e-7 of the spring's). Mutations that fail: D doubled or left out, its sign.
TEST_CASE("a soft interface between loaded edges") {
  for (const double at : {4.0, 3.5}) {
    for (double D = 1e3; D < 2e15; D *= 100.0) {
      Scene scene = bars(soft_law(D, D), at);
      scene.domain.top = scene.domain.sides = scene.domain.bottom = Edge::traction;
      scene.in_situ.vertical_Pa = -1e6;
      Statics s(scene);
      s.solve();
      CAPTURE(at, D);
      CHECK(jump_error(s, 1e6 / D, 0.0) < 1e-7 * 1e6 / D);
      CHECK(s.at.strain < 1e-7 * 0.5 * 1e6 * 1e6 / D);
    }
  }
}

// Requires J = 0, w = 0 and no displacement to round-off (1e-12 of those at 0.3 MPa more) at P = s_h: crack on a grid
// line and at mid-cell, through a soft interface, or inside. Mutations that fail: net pressure P, s_v for s_h.
TEST_CASE("nothing happens at the closing stress") {
  for (const double x : {8.0, 8.5}) {
    for (const bool inside : {false, true}) {
      Scene scene = block(16, 16);
      if (!inside) hold_edges(scene);
      scene.in_situ = {3e6, 2e6};
      add_interface(scene, soft_law(1e9, 1e9), 8.0);
      add_fracture(scene, {{x, inside ? 5.0 : 0.0}, {x, 10.0}}, 2e6);
      Statics still(scene), loaded(scene);
      press(loaded.state(), Surface::Kind::fracture, 2.3e6);
      still.solve(), loaded.solve();
      REQUIRE(loaded.state().tips.back().J > 1.0);
      CHECK(std::abs(still.state().tips.back().J) < 1e-12 * loaded.state().tips.back().J);
      const double u = largest_displacement(loaded.state().particles);
      CHECK(largest_displacement(still.state().particles) < 1e-12 * u);
      for (const Vec2& w : still.at.w) CHECK(w.norm() < 1e-12 * u);
    }
  }
}

// Requires that parts that move freely are reported as a mechanism: a cut without friction between loaded edges under
// a load that parts it, one that closes it but lets it slide, a block that a crack through its interface cuts off; and
// that the same with held sides or with friction has a solution. Mutations that fail: smallest_eigenvalue = 1, a
// tangent always stiffened (that it is 0 fails test_random_scenes).
TEST_CASE("a free mechanism is reported") {
  const auto outcome = [](Edge edge, double residual, double P) {
    Scene scene = block(10, 10);
    scene.domain.bottom = Edge::symmetry;
    scene.domain.sides = edge;
    scene.in_situ = {3e6, 2e6};
    add_interface(scene, weak_law(1e5, 1e5, residual), 5.0);
    add_fracture(scene, {{5.0, 0.0}, {5.0, 5.0}}, 2.2e6);
    Statics s(scene);
    fail_all(s.state());
    press(s.state(), Surface::Kind::interface, P);
    s.update();
    try {
      s.solve();
      return std::string("solved");
    } catch (const NumericalFailure& failure) {
      return std::string(failure.what());
    }
  };
  CHECK_THAT(outcome(Edge::traction, 0.0, 0.0), Catch::Contains("mechanism"));
  CHECK_THAT(outcome(Edge::traction, 0.6, 4e6), Catch::Contains("mechanism"));
  CHECK(outcome(Edge::fixed, 0.0, 0.0) == "solved");
  CHECK(outcome(Edge::traction, 0.6, 0.0) == "solved");
}

// Requires that a block that no edge holds is solved, its mean displacement and rotation taken out (1e-12 of the
// largest displacement), crack upright in the middle or askew and off it, all edges loaded; upright with the K and J of
// the block that its symmetric half is. Mutations that fail: mean or rotation left in, one corner unknown more held, or
// one less.
TEST_CASE("rigid motion of the whole block is taken out") {
  Scene scene = block(20, 36);
  add_fracture(scene, {{10.0, 11.0}, {10.0, 25.0}}, 1e6);
  Statics whole(scene);
  Scene upper = block(20, 18);
  upper.domain.bottom = Edge::symmetry;
  add_fracture(upper, {{10.0, 0.0}, {10.0, 7.0}}, 1e6);  // J's rings, 4 cells, stay above the symmetry line
  Statics half(upper);
  whole.solve(), half.solve();
  Scene skew = scene;  // where the corners that are held turn the block
  skew.fracture->path_m = {{4.6, 20.3}, {9.2, 28.7}};
  Statics turned(skew);
  turned.solve();
  for (const Statics* s : {&whole, &turned}) {
    const double u = largest_displacement(s->run.state.particles);
    REQUIRE(u > 1e-4);
    for (const double rigid : rigid_motion(*s)) CHECK(rigid < 1e-12 * u);
  }
  REQUIRE(half.state().tips.size() == 1);
  REQUIRE(whole.state().tips.size() == 2);
  CHECK(half.state().tips.front().J > 1.0);
  for (const Tip& tip : whole.state().tips) {
    CHECK(tip.J == Approx(half.state().tips.front().J).epsilon(1e-9));
    CHECK(tip.K_I == Approx(half.state().tips.front().K_I).epsilon(1e-9));
  }
}

// Requires that a fracture so short that it splits no node (one cell, from node to node) is solved, not a crash:
// nothing opens.
TEST_CASE("a fracture of one cell") {
  Scene scene = block(8, 8);
  hold_edges(scene);
  add_fracture(scene, {{3.0, 4.0}, {3.0, 5.0}}, 1e6);
  Statics s(scene);
  REQUIRE(s.model.condensed.size() == 0);
  s.solve();
  CHECK(largest_displacement(s.state().particles) == 0.0);
}
