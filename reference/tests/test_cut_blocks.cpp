// The cut blocks against closed forms, Muskhelishvili's block (finite_plate), Irwin's relation, limits and convergence.
// Values 38302, 38313.1, 38475.4, 1.0771, 1.0683, 1.0577, 1.0794: other elements (order 4, springs of 0.5 MPa/m).
// Changes that were made and fail here: A and M exchanged in K_xx, a factor of K_xy, the stretch below or above the tip
// or the load's left out, springs of one sign or twice, the lower corner held, E' of the other rock, the last element's
// or the slipped side's part of the mean traction, the stress of one side, energy, volume or opening halved or doubled.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "cut_blocks.hpp"
#include "finite_plate.hpp"
#include "quadrature.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {

constexpr double kSprings = 0.5e6;  // the study's, Pa/m
constexpr double kMPa2 = 1e12;

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

CutBlock crossed(double fresh, double springs = 0) {
  CutBlock block;
  block.fresh = fresh, block.shear_stiffness = springs;
  return block;
}

double F(const CutBlock& block, int order = 8) {
  return CutBlocks(block, order).K_I() / std::sqrt(pi * block.fresh);
}

// Muskhelishvili's solution of a block with held sides, symmetric about the crack's middle.
BlockCrack held_block(double width, double half_height, double a) {
  return BlockCrack({width, half_height, a, EdgeHold::fixed, EdgeHold::traction, 0.2});
}

}  // namespace

TEST_CASE("tip on the interface: the lower block is uniformly compressed, whatever lies above") {
  for (const Rock& above : {Rock{10e9, 0.2}, Rock{2e9, 0.35}})
    for (const CutBlock& size : {CutBlock{80, 80, 10}, CutBlock{30, 100, 40}, CutBlock{120, 60, 5}}) {
      CutBlock block = size;
      block.below = {7e9, 0.3}, block.above = above;
      const double E_prime = 7e9 / 0.91;
      const CutBlocks blocks(block, 4);
      CHECK(blocks.energy() == near(0.5 * block.width * block.interface / E_prime, 1e-8));
      CHECK(blocks.volume() == near(block.width * block.interface / E_prime, 1e-8));
      for (const double y : {0.0, 0.3, 0.999})
        CHECK(blocks.opening(y * block.interface) == near(block.width / E_prime, 1e-6));
      CHECK(blocks.opening(1.001 * block.interface) == 0);
      CHECK(std::abs(blocks.largest_tension()) < 1e-5);
    }
  CHECK(CutBlocks(crossed(0)).energy() * kMPa2 == near(38400, 1e-8));
}

TEST_CASE("springs along the interface take D p^2 width^3/(24 E'^2) from the energy, to first order") {
  const double E_prime = Rock{}.E_prime();
  for (const double D : {1e4, 1e5}) {
    const double lost = 38400 - CutBlocks(crossed(0, D), 6).energy() * kMPa2;
    CHECK(lost == near(D * 80 * 80 * 80 / (24 * E_prime * E_prime) * kMPa2, 2e-3));
  }
  CHECK(CutBlocks(crossed(0, kSprings)).energy() * kMPa2 == near(38302, 1e-5));
  CHECK(CutBlocks(crossed(0, kSprings)).energy() * 0.36e6 * 0.36e6 == near(4964, 1e-4));
}

TEST_CASE("past the interface with the study's springs: other elements' values") {
  for (const auto& [d, expected] : {std::pair{0.25, 1.0771}, std::pair{1.0, 1.0683}, std::pair{2.0, 1.0577}})
    CHECK(F(crossed(d, kSprings), 6) == near(expected, 2e-4));
  CHECK(CutBlocks(crossed(0.25, kSprings), 6).energy() * kMPa2 == near(38313.1, 3e-6));
  CHECK(CutBlocks(crossed(1, kSprings), 6).energy() * kMPa2 == near(38475.4, 3e-6));
  CHECK(crossing_pressure(crossed(0, kSprings), 1, 1.45e6, 6) == near(1.0794e6, 3e-4));
  CHECK(1.45e6 / CutBlocks(crossed(1, kSprings), 6).K_I() == near(0.766e6, 1e-3));
  CHECK(1.45e6 / CutBlocks(crossed(2, kSprings), 6).K_I() == near(0.547e6, 1e-3));
  // Own values without springs, settled to 1e-5.
  CHECK(F(crossed(1)) == near(1.06093, 2e-5));
  CHECK(F(crossed(20)) == near(0.79086, 2e-5));
}

TEST_CASE(
    "limits: a soft lower block leaves a half-plane's edge crack, a rigid one the middle of a crack twice as long") {
  CutBlock block = crossed(0.1);
  block.below.poisson_ratio = 0;  // its end does not lift the upper block
  block.below.youngs_modulus = 1e6;
  CHECK(F(block) == near(1.1215, 1e-4));
  for (const double d : {0.5, 20.0}) {
    CutBlock rigid = crossed(d);
    rigid.below.youngs_modulus = 1e15;
    CHECK(F(rigid) == near(held_block(80, 70, d).F(), 2e-5));
  }
}

TEST_CASE("the largest tension on the interface: on a stiff lower block that on the middle of a crack twice as long") {
  CutBlock stiff = crossed(20);
  stiff.below.youngs_modulus = 1e13;
  const BlockCrack exact = held_block(80, 70, 20);
  double largest = 0;
  for (int i = 1; i < 80; ++i) largest = std::max(largest, exact.field(0.5 * i, 0).s_yy);
  CHECK(CutBlocks(stiff).largest_tension() == near(largest, 0.01));
}

TEST_CASE("bonded all along it is the block without an interface") {
  CutBlock block;
  block.slipped = 0;
  for (const double d : {0.0, 3.0}) {
    block.fresh = d;
    const CutBlocks blocks(block);
    const double a = 10 + d;
    const BlockCrack exact = held_block(80, 80, a);
    CHECK(blocks.K_I() == near(exact.K_I(1), 2e-5));
    CHECK(blocks.volume() == near(0.5 * exact.volume(1, Rock{}.E_prime()), 1e-5));
    for (const double y : {0.0, 5.0, a - 0.1})
      CHECK(blocks.opening(y) == near(exact.opening(y, 1, Rock{}.E_prime()), 1e-4));
  }
  // Mean traction ahead of a tip on the interface, r^(-1/2) taken out by x = r^2.
  block.fresh = 0;
  const BlockCrack exact = held_block(80, 80, 10);
  for (const double length : {0.2, 1.0, 5.0}) {
    block.ahead = length;
    const auto mean = CutBlocks(block).mean_traction_ahead();
    const auto average = [&](auto member) {
      return integrate([&](double r) { return 2 * r * exact.field(r * r, 10).*member; }, 1e-6, std::sqrt(length), {},
                       1e-8)
                 .value /
             length;
    };
    CHECK(mean.shear == near(average(&BlockCrack::Field::s_xy), 3e-5));
    CHECK(mean.normal == near(average(&BlockCrack::Field::s_yy), 1e-3));
  }
}

TEST_CASE("Irwin: the energy grows by K^2/E' of the rock that breaks, and the opening at the tip has that K") {
  for (const Rock& above : {Rock{10e9, 0.2}, Rock{5e9, 0.3}})
    for (const double d : {0.25, 20.0}) {
      CutBlock block = crossed(d, kSprings);
      block.above = above;
      const auto U = [&](double fresh) {
        CutBlock other = block;
        other.fresh = fresh;
        return CutBlocks(other, 6).energy();
      };
      const double h = 0.2 * d;
      const double rate = (8 * (U(d + h) - U(d - h)) - (U(d + 2 * h) - U(d - 2 * h))) / (12 * h);
      const CutBlocks blocks(block, 6);
      const double K = blocks.K_I(), E_prime = above.E_prime();
      CHECK(K * K / E_prime == near(rate, 2e-3));
      // w = (8 K/E') sqrt(r/(2 pi)) + O(r^(3/2)), which the second point takes out.
      const auto from = [&](double r) {
        return blocks.opening(block.interface + d - r) * E_prime / 8 * std::sqrt(2 * pi / r);
      };
      CHECK(2 * from(0.01 * d) - from(0.02 * d) == near(K, 3e-3));
    }
}

TEST_CASE("the finite increment: mean of K^2/E' over it equals J_c") {
  for (const double da : {0.1, 4.0}) {
    const auto G = [](double d) { return std::pow(CutBlocks(crossed(d, kSprings), 5).K_I(), 2); };
    // Simpson's rule; K^2/d is smooth, so K^2 from 0.
    const double mean = (4 * G(0.25 * da) + 2 * G(0.5 * da) + 4 * G(0.75 * da) + G(da)) / 12;
    CHECK(crossing_pressure(crossed(0, kSprings), da, 1.45e6, 6) == near(1.45e6 / std::sqrt(mean), 1e-3));
  }
  CHECK_THROWS_AS(crossing_pressure(crossed(0), 0, 1e6), std::invalid_argument);
}

TEST_CASE("slip on a weak interface: mean shear ahead, and the energy that the slip's end takes") {
  // Other elements' 1.612, 1.740, 1.372 are 0.4 % low, as is their 1.499 at l = 0, where the series has 1.5073.
  CutBlock block;
  block.ahead = 1;
  for (const auto& [l, own, other] : {std::tuple{0.0, 1.50731, 1.499}, std::tuple{1.0, 1.61844, 1.612},
                                      std::tuple{8.0, 1.74695, 1.740}, std::tuple{24.0, 1.37760, 1.372}}) {
    block.slipped = l;
    const double shear = -CutBlocks(block, 6).mean_traction_ahead().shear;
    CHECK(shear == near(own, 1e-4));
    CHECK(shear == near(other, 6e-3));
  }
  // dU/dl = 2 K_II^2/E' of the two ends; K_II = mean sqrt(2 pi a)/2 for a small length a.
  for (const double l : {1.0, 24.0}) {
    block.slipped = l, block.ahead = 0.002 * l;
    const double K_II = CutBlocks(block, 5).mean_traction_ahead().shear * std::sqrt(2 * pi * block.ahead) / 2;
    const auto U = [&](double slipped) {
      CutBlock other;
      other.slipped = slipped;
      return CutBlocks(other, 4).energy();
    };
    const double rate = (U(1.02 * l) - U(0.98 * l)) / (0.04 * l);
    CHECK(2 * K_II * K_II / Rock{}.E_prime() == near(rate, 1e-2));
  }
}

TEST_CASE("the error falls with the order") {
  const double exact = held_block(80, 80, 13).F() * std::sqrt(13.0 / 3);
  CutBlock block = crossed(3);
  block.slipped = 0;
  double before = 1;
  for (const int order : {3, 5, 7}) {
    const double error = std::abs(F(block, order) / exact - 1);
    CHECK(error < 0.3 * before);
    before = error;
  }
  CHECK(before < 3e-5);
}

TEST_CASE("cut blocks that cannot be meant are refused") {
  CHECK_THROWS_AS(CutBlocks(CutBlock{0, 80, 10}), std::invalid_argument);
  CHECK_THROWS_AS(CutBlocks(CutBlock{80, 80, 80}), std::invalid_argument);
  CHECK_THROWS_AS(CutBlocks(crossed(70)), std::invalid_argument);
  CHECK_THROWS_AS(CutBlocks(crossed(-1)), std::invalid_argument);
  CHECK_THROWS_AS(CutBlocks(crossed(1, -1)), std::invalid_argument);
  CHECK_THROWS_AS(CutBlocks(crossed(1), 1), std::invalid_argument);
  CHECK_THROWS_AS(CutBlocks(crossed(0), 4).K_I(), std::invalid_argument);
  CHECK_THROWS_AS(CutBlocks(crossed(1), 4).mean_traction_ahead(), std::invalid_argument);
  CutBlock far = crossed(0);
  far.slipped = 24, far.ahead = 16;
  CHECK_THROWS_AS(CutBlocks(far), std::invalid_argument);
}
