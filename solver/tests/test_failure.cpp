#include "interfaces/failure.hpp"

#include <catch2/catch.hpp>

#include "output/suspect.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;
using Shape = Numerics::Shape;

// Requires the study's eq. 5 for weak places, tension alone counting as N, and |t|/(mu n) for friction, by hand.
// Mutations that fail: compression counted, strengths swapped, mu left out, friction in tension at 0.
TEST_CASE("how near a place is to failure") {
  const InterfaceLaw weak = weak_law(2e6, 0.5e6), friction = friction_law(0.5);
  CHECK(failure_index(weak, 5e6, 0.0) == 0.0);
  CHECK(failure_index(weak, 5e6, -1e6) == Approx(0.5));
  CHECK(failure_index(weak, -0.3e6, 1.6e6) == Approx(1.0));
  CHECK(failure_index(friction, 2e6, 0.0) == 0.0);
  CHECK(failure_index(friction, 2e6, -1e6) == Approx(1.0));
  CHECK(std::isinf(failure_index(friction, -1.0, 0.0)));
  CHECK(failure_index(soft_law(1e9, 1e9), -1e9, 1e9) == 0.0);
}

// Requires that under a uniform stress every bonded place carries exactly that traction (1e-12), shear included and
// with both signs: grid line and mid-cell, both ways of stacking, hats and splines, a block with a fracture that ends
// on the interface under a net pressure that the stress balances. Mutations that fail: the side's sign, the length
// of an edge's column doubled, the fracture's faces left out or their sign.
TEST_CASE("bonded places carry the traction of a uniform stress") {
  for (const auto along : {Strata::Along::y, Strata::Along::x}) {
    for (const double at : {5.0, 4.5}) {
      for (const auto& [cracked, shape] : {std::pair{false, Shape::bspline2},
                                           {true, Shape::bspline2},
                                           {false, Shape::linear},
                                           {true, Shape::linear}}) {
        if (shape == Shape::linear && at == 4.5) continue;
        Scene scene = block(10, 10);
        scene.in_situ = {3e6, 2e6};
        scene.strata.along = along;
        scene.numerics.shape = shape;
        add_interface(scene, weak_law(1e6, 1e6), at);
        if (cracked && along == Strata::Along::y) add_fracture(scene, {{5.0, 2.0}, {5.0, at}}, 2.3e6);
        Statics s(scene);
        REQUIRE(s.model.bonds.places.size() >= 20);
        // A fracture along y disturbs no stress whose traction on its faces is the net pressure.
        const Stress added = cracked ? Stress{-0.3e6, -0.7e6, 0.0} : Stress{0.4e6, -0.7e6, 0.3e6};
        Particles& p = s.state().particles;
        for (std::size_t q = 0; q < p.size(); ++q) strain(s.state(), q, gradient_of(scene.rocks[0], added));
        find_forces(s.run.rocks, s.state(), s.model.bonds);
        judge_bonds(scene, s.state(), s.model.bonds);
        for (const BondedPlace& place : s.model.bonds.places) {
          const SurfacePoint& point = s.state().surfaces[place.surface].points[place.point];
          const Vec2 expected = point.in_situ - added.on(point.n);
          CAPTURE(at, static_cast<int>(along), cracked, place.point);
          CHECK((place.carried - expected).norm() < 1e-10 * expected.norm());
        }
      }
    }
  }
}

// Requires of an interface that has failed in part to be marked by two cells over its failure_length_m, 4 m here: cells
// of 1 m at the fracture mark nothing, coarser ones where it stops do within two lengths of the fracture, and not
// beyond; nor does one that has failed whole. Mutations that fail: the cell at the fracture alone, the smallest cell,
// the length of the fracture left out.
TEST_CASE("what fails is judged by the cells where it stops") {
  Scene scene = graded_block();
  InterfaceLaw weak = weak_law(0.5e6, 0.5e6);
  weak.failure_length_m = 4.0;
  add_interface(scene, weak, 26.0);
  scene.fracture->path_m = {{20.0, 6.0}, {20.0, 26.0}};
  State state = initialise(scene, make_elasticities(scene));
  const auto value = [&](double from, double to) {
    for (SurfacePoint& s : state.surfaces.back().points) s.split = s.x.x() > from && s.x.x() < to;
    for (const Watched& one : watched(scene, state))
      if (one.monitor == "failure_length_unresolved") return one.value;
    return 0.0;
  };
  CHECK(value(0.0, 60.0) == 0.0);
  CHECK(value(19.0, 21.0) == Approx(0.5));
  const double coarse = value(19.0, 50.0);
  CHECK(coarse > 1.0);
  CHECK(value(0.0, 50.0) == coarse);
  scene.fracture->path_m = {{20.0, 24.0}, {20.0, 26.0}};
  state = initialise(scene, make_elasticities(scene));
  CHECK(value(19.0, 50.0) == Approx(0.5));
}
