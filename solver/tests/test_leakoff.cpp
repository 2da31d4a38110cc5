// Leak-off of the flow that conserves mass: what a full cell loses, what one in part full does, and its balance.
#include <catch2/catch.hpp>
#include <cmath>

#include "crack_kernel.hpp"

using namespace strata;
using namespace strata::test;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

Fluid thin_fluid() {
  Fluid fluid;
  fluid.law = Fluid::Law::reynolds;
  fluid.minimum_opening_m = 0.0;
  fluid.viscosity_Pa_s = 1e-3;
  return fluid;
}

// Rigid walls w (m) apart whose rock has taken `lost` of each cell (m^2).
RockModel walls(const VectorXd& w, const VectorXd& lost) {
  return [w, lost](const VectorXd&) {
    RockResponse rock{w, Eigen::MatrixXd::Zero(w.size(), w.size())};
    rock.lost = lost;
    return rock;
  };
}

double sum(const std::vector<double>& x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size())).sum();
}

}  // namespace

// Requires of a channel that stays full by its inlet's pressure that each cell loses what the rock takes, whatever the
// steps, and that the inlet brings it: to 1e-12. Mutations that fail: the loss of the whole time in every step, none,
// twice, a gain, the balance without it.
TEST_CASE("full cells lose what the rock takes, and the inlet replaces it") {
  const Fluid fluid = thin_fluid();
  const VectorXd w = VectorXd::Constant(8, 1e-3);
  for (const int steps : {1, 7, 40}) {
    FluidBalance balance;
    ReynoldsLine line = full_line(fluid, std::vector<double>(8, 0.5), 0, 1e6, w, balance);
    const double held = balance.stored_at_start;
    VectorXd lost;
    for (int k = 1; k <= steps; ++k) {
      lost = 1e-5 * std::sqrt(1.0 * k / steps) * VectorXd::LinSpaced(8, 1.0, 2.0);
      REQUIRE(
          step_reynolds(fluid, {Inlet::Drive::pressure, 1e6}, 10.0 / steps, walls(w, lost), line, balance).converged);
    }
    for (Index k = 0; k < 8; ++k) {
      CHECK(line.phi[static_cast<std::size_t>(k)] == 1.0);
      CHECK(line.leaked[static_cast<std::size_t>(k)] == Approx(lost(k)).epsilon(1e-12));
    }
    // The fluid is 0.1 % denser at 1 MPa than at the cavitation pressure, at which the balance counts.
    CHECK(balance.leaked == Approx(1.001 * lost.sum()).epsilon(1e-5));
    CHECK(balance.injected == Approx(balance.leaked + sum(line.content) - held).epsilon(1e-9));
    CHECK(std::abs(balance.closure()) < 1e-12);
    for (std::size_t k = 1; k < 8; ++k) CHECK(line.P[k] < line.P[k - 1]);
  }
}

// Requires of a channel that is shut in that the fluid goes down to the cavitation pressure and then leaves the cells
// in part: phi = held/(w A + loss), since the part that is wet loses; nothing is negative or made. Once fed again,
// cells that are full have lost all that the rock takes. Mutations that fail: the loss of a cell in part full taken
// whole (no solution), its derivative left out, what is missing forgotten.
TEST_CASE("cells in part full lose in part, and the rest once they are full") {
  const Fluid fluid = thin_fluid();
  const VectorXd w = VectorXd::Constant(4, 1e-4);
  FluidBalance balance;
  ReynoldsLine line = full_line(fluid, std::vector<double>(4, 0.5), 0, 1e5, w, balance);
  const double wA = 0.5e-4, first = 0.3 * wA, much = 5.0 * wA;
  REQUIRE(step_reynolds(fluid, {Inlet::Drive::rate, 0.0}, 1.0, walls(w, VectorXd::Constant(4, first)), line, balance)
              .converged);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(line.P[k] == fluid.cavitation_Pa);
    CHECK(line.phi[k] == Approx((1.0 + 1e-4) * wA / (wA + (1.0 + 1e-4) * first)).epsilon(1e-9));
    CHECK(line.leaked[k] == Approx(line.phi[k] * first).epsilon(1e-9));
  }
  for (int k = 0; k < 5; ++k) {
    REQUIRE(step_reynolds(fluid, {Inlet::Drive::rate, 0.0}, 1.0, walls(w, VectorXd::Constant(4, much)), line, balance)
                .converged);
    CHECK(line.phi[0] > 0.0);
    CHECK(std::abs(balance.closure()) < 1e-12);
  }
  CHECK(line.phi[0] < 1e-3);
  REQUIRE(step_reynolds(fluid, {Inlet::Drive::pressure, 1e6}, 1e3, walls(w, VectorXd::Constant(4, much)), line, balance)
              .converged);
  for (std::size_t k = 0; k < 4; ++k) {
    CHECK(line.phi[k] == 1.0);
    CHECK(line.leaked[k] == Approx(much).epsilon(1e-12));
  }
  CHECK(std::abs(balance.closure()) < 1e-12);
}

TEST_CASE("a new cell is wet from its own time on, and has lost nothing") {
  const Fluid fluid = thin_fluid();
  FluidBalance balance;
  ReynoldsLine line = full_line(fluid, {0.5, 0.5}, 0, 1e6, VectorXd::Constant(2, 1e-3), balance);
  line.leaked = {1e-6, 2e-6};
  grow(line, fluid, true, 0.5, 3.0);
  grow(line, fluid, false, 0.5, 4.0);
  CHECK(line.wet_s == std::vector<double>{4.0, 0.0, 0.0, 3.0});
  CHECK(line.leaked == std::vector<double>{0.0, 1e-6, 2e-6, 0.0});
}
