#include <catch2/catch.hpp>
#include <numeric>

#include "flow/reynolds_flow.hpp"

using namespace strata;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr std::size_t cells = 8;
constexpr double length = 0.5, opening = 1e-3;  // of a cell (m)

// A rigid channel upwards from its inlet, under a fluid of 1000 kg/m^3.
struct Channel {
  Fluid fluid;
  VectorXd w = VectorXd::Constant(cells, opening), rise = VectorXd(cells);
  FluidBalance balance;
  ReynoldsLine line;

  Channel() {
    fluid.law = Fluid::Law::reynolds;
    fluid.density_kg_m3 = 1000.0;
    for (std::size_t k = 0; k < cells; ++k)
      rise(static_cast<Index>(k)) = fluid.weight() * length * (0.5 + static_cast<double>(k));
    line = full_line(fluid, std::vector<double>(cells, length), 0, 1e6, w, balance);
  }

  bool step(const Inlet& inlet, double dt) {
    const RockModel rigid = [this](const VectorXd&) {
      return RockResponse{.w = w, .dw_dP = Eigen::MatrixXd::Zero(w.size(), w.size()), .rise = rise};
    };
    return step_reynolds(fluid, inlet, dt, rigid, line, balance).converged;
  }
};

}  // namespace

// Requires of a channel under one pressure that its fluid begins to sink by q = w^3/(12 mu) rho g, which the closed top
// alone cannot replace, and comes to rest at P - rho g y. Mutations that fail: no weight, twice, upwards, the inlet's
// half cell without it.
TEST_CASE("a fluid sinks by its weight until its pressure falls by rho g upwards") {
  Channel c;
  const double before = c.line.content.back(), dt = 1e-8, q = 1e-9 / (12.0 * 0.1) * 9806.65;
  REQUIRE(c.step({Inlet::Drive::pressure, 1e6}, dt));
  CHECK((before - c.line.content.back()) / dt == Approx(1.001 * q).epsilon(1e-4));
  for (int k = 0; k < 40; ++k) REQUIRE(c.step({Inlet::Drive::pressure, 1e6}, 1.0));
  for (std::size_t k = 0; k < cells; ++k)
    CHECK(1e6 - c.line.P[k] == Approx(9806.65 * length * (0.5 + static_cast<double>(k))).epsilon(1e-6));
  CHECK(std::abs(c.balance.closure()) < 1e-10);
  CHECK(c.fluid.at_rest(1e6, 2.0) == Approx(1e6 - 2.0 * 9806.65));
  CHECK(c.fluid.at_rest(1e4, 2.0) == 0.0);
}

// Requires of a closed channel that is half full everywhere that the fluid gathers in its lower half, and none of it is
// lost or made. Mutations that fail: cells in part full keep what they hold, or give as full ones do.
TEST_CASE("what fills cells in part drains to the bottom") {
  Channel c;
  for (std::size_t k = 0; k < cells; ++k)
    c.line.P[k] = 0.0, c.line.phi[k] = 0.5, c.line.content[k] = 0.5 * length * opening;
  for (int k = 0; k < 200; ++k) REQUIRE(c.step({Inlet::Drive::rate, 0.0}, 20.0));
  for (std::size_t k = 0; k < cells; ++k) {
    CHECK(c.line.phi[k] == Approx(k < cells / 2 ? 1.0 : 0.0).margin(1e-3));
    CHECK(c.line.phi[k] >= 0.0);
  }
  const double held = std::accumulate(c.line.content.begin(), c.line.content.end(), 0.0);
  CHECK(held == Approx(0.5 * cells * length * opening).epsilon(1e-10));
}
