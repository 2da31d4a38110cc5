// Blocks that slide with friction: limits, the balance of energy, other elements' values, monotony.
// Changes that were made and fail here: slip of the wrong sign, friction's work doubled, no net pull across, shares of
// the interface doubled, shear on the wrong face, the volume that shear takes halved.
#include <catch2/catch.hpp>
#include <cmath>

#include "finite_plate.hpp"
#include "sliding_blocks.hpp"

using namespace strata::reference;

namespace {

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

CutBlock study() {
  CutBlock block;
  block.fresh = 5, block.widest = 0.1;
  return block;
}

}  // namespace

TEST_CASE("friction 0.1 under 3 MPa at 1 MPa net: other elements' work and K, and the balance of energy") {
  const SlidingBlocks end = sliding_blocks(study(), 0.1, 3e6, 1e6, 40, 5);
  CHECK(end.friction_work == near(134.8, 0.01));
  CHECK(end.K_I == near(5.91e6, 1e-3));
  // What the pressure did is stored or rubbed away; of the difference of large numbers 1 % of the friction's work.
  CHECK(end.work - end.stored == near(end.friction_work, 0.01));
  CHECK(end.largest_slip > 0);
  CHECK(end.slid_to > 10);
  CHECK(end.slid_to < 16);
}

TEST_CASE("no friction to speak of leaves cut blocks, much of it a block without an interface") {
  const CutBlocks free(study(), 4);
  const SlidingBlocks smooth = sliding_blocks(study(), 1e-6, 3e6, 1e6, 2);
  CHECK(smooth.K_I == near(free.K_I() * 1e6, 1e-4));
  CHECK(smooth.stored == near(free.energy() * 1e12, 1e-4));
  CHECK(smooth.mouth_opening == near(free.opening(0) * 1e6, 1e-4));
  CHECK(smooth.slid_to > 39);
  // Its small work is that of s_n on the free slip, 2 mu s_n int slip dx, but for the net pressure across.
  const auto influence = CutBlocks::influence(study(), 4);
  CHECK(smooth.largest_slip == near(influence.slip.col(0).maxCoeff() * 1e6, 1e-3));
  CHECK(smooth.friction_work == near(2 * 1e-6 * 3e6 * influence.weights.dot(influence.slip.col(0)) * 1e6, 0.1));

  const SlidingBlocks rough = sliding_blocks(study(), 10, 3e6, 1e6, 2);
  const BlockCrack whole({80, 80, 15, EdgeHold::fixed, EdgeHold::traction, 0.2});
  CHECK(std::abs(rough.friction_work) < 1e-6);
  CHECK(rough.K_I == near(whole.K_I(1e6), 5e-3));
  CHECK(rough.stored == near(0.25 * whole.volume(1e6, Rock{}.E_prime()) * 1e6, 1e-3));
}

TEST_CASE("more friction shields the tip less and stores less; at no pressure to speak of nothing slides") {
  double K = 0, stored = 1e12;
  for (const double friction : {0.05, 0.2}) {
    const SlidingBlocks end = sliding_blocks(study(), friction, 3e6, 1e6, 4);
    CHECK(end.stored < stored);
    K = end.K_I, stored = end.stored;
  }
  CHECK(K > 0);
  // Everything scales with pressure and compression together.
  const SlidingBlocks one = sliding_blocks(study(), 0.1, 3e6, 1e6, 4), two = sliding_blocks(study(), 0.1, 6e6, 2e6, 4);
  CHECK(two.K_I == near(2 * one.K_I, 1e-6));
  CHECK(two.friction_work == near(4 * one.friction_work, 1e-6));
  CHECK(sliding_blocks(study(), 0.1, 3e6, 1e3, 1).friction_work < 1e-9);
}

TEST_CASE("what cannot be meant is refused, and an interface that opens is no answer") {
  CHECK_THROWS_AS(sliding_blocks(CutBlock{}, 0.1, 3e6, 1e6, 1), std::invalid_argument);
  for (const int zero : {0, 1, 2, 3})
    CHECK_THROWS_AS(
        sliding_blocks(study(), zero == 0 ? 0 : 0.1, zero == 1 ? 0 : 3e6, zero == 2 ? 0 : 1e6, zero == 3 ? 0 : 1),
        std::invalid_argument);
  CHECK_THROWS_AS(sliding_blocks(study(), 0.1, 1e3, 1e6, 1), std::runtime_error);
}
