// A fracture that grows, fed at a constant rate: the coupled step with Sneddon's crack as its rock against the two
// self-similar limits of the plane-strain hydraulic fracture, and against the one with leak-off.
#include <catch2/catch.hpp>
#include <kgd_leakoff.hpp>

#include "crack_kernel.hpp"

using namespace strata;
using namespace strata::test;
using Eigen::VectorXd;

namespace {

constexpr double E_prime = 10e9 / 0.96;  // E = 10 GPa, nu = 0.2 (Pa)
constexpr double closing = 20e6;         // Pa
constexpr double rate = 1e-4;            // both wings (m^2/s)

struct Setting {
  double viscosity, toughness;
  double cell;           // m
  double leakoff = 0.0;  // C_L, m/sqrt(s)
};

// Half of the fracture by symmetry, with what its numbers are off by, relative to the limit's at the same time.
struct Growing {
  Setting setting;
  Fluid fluid;
  std::vector<double> h;
  CrackKernel kernel;
  FluidBalance balance;
  ReynoldsLine line;
  double time = 0.0;
  int failures = 0;

  explicit Growing(const Setting& s) : setting(s), h(3, s.cell), kernel(E_prime, closing, h, true) {
    fluid.viscosity_Pa_s = s.viscosity;
    fluid.minimum_opening_m = 1e-6;
    line = full_line(fluid, h, 0, closing, VectorXd::Zero(3), balance);
  }
  VectorXd P() const { return Eigen::Map<const VectorXd>(line.P.data(), static_cast<Eigen::Index>(line.size())); }
  StepReport step(double dt) {
    const auto rock = [&](const VectorXd& p) {
      RockResponse response = kernel(p);
      if (setting.leakoff > 0.0) response.lost = VectorXd::Zero(p.size());
      for (Eigen::Index k = 0; k < response.lost.size(); ++k)
        response.lost(k) =
            4.0 * setting.leakoff * setting.cell * std::sqrt(time + dt - line.wet_s[static_cast<std::size_t>(k)]);
      return response;
    };
    return step_reynolds(fluid, {Inlet::Drive::rate, 0.5 * rate}, dt, rock, line, balance);
  }
  void extend() {
    h.push_back(setting.cell);
    kernel = CrackKernel(E_prime, closing, h, true);
    grow(line, fluid, true, setting.cell, time);
  }
};

// Steps to the next moment at which the tip's K reaches the toughness, within 0.1 % of it (0: at which the tip opens,
// within 0.01 MPa sqrt(m)), by shortening the step that passes it; keeps the opening's error below 0.1 % a step.
void to_growth(Growing& g, double& dt) {
  const double K_c = std::max(g.setting.toughness, 1e-3);
  const double slack = g.setting.toughness > 0.0 ? 1e-3 * g.setting.toughness : 1e4;
  for (int step = 0; step < 3000; ++step) {
    const ReynoldsLine line = g.line;
    const FluidBalance balance = g.balance;
    const double K_before = g.kernel.K_I(g.P());
    const StepReport r = g.step(dt);
    if (!r.converged) ++g.failures;
    const double K = r.converged ? g.kernel.K_I(g.P()) : 0.0;
    double shorter = r.converged && !(r.error_w > 1e-3) ? 1.0 : 0.5;
    if (K > K_c + slack) shorter = std::min(shorter, std::clamp(1.02 * (K_c - K_before) / (K - K_before), 0.1, 0.8));
    if (shorter < 1.0 && dt > 1e-5) {
      g.line = line;
      g.balance = balance;
      dt *= shorter;
      continue;
    }
    g.time += dt;
    if (K >= K_c) return;
    dt = std::min(1.0, r.error_w < 3e-4 ? 1.5 * dt : dt);
  }
  FAIL("no growth after 3000 steps, t = " << g.time);
}

struct Off {
  double length, mouth, inlet;
};

// Grows from three cells until 100 s have passed and the next growth is due; checks each step's balance on the way.
Off run(const Setting& setting, const std::function<reference::KgdState(double)>& limit) {
  Growing g(setting);
  double dt = 1e-4;
  to_growth(g, dt);
  while (g.time < 100.0) {
    g.extend();
    dt = std::max(1e-4, 0.1 * dt);
    to_growth(g, dt);
    REQUIRE(std::abs(g.balance.closure()) < 1e-10);
  }
  const reference::KgdState exact = limit(g.time);
  CHECK(g.failures <= (setting.leakoff > 0.0 ? 3 : 0));  // a closed cell that leaks may ask for a shorter step
  // The fluid came in at between 20 and some 22 MPa: 2 % denser than at no pressure, not more.
  CHECK(g.balance.injected == Approx(0.5 * rate * g.time * (1.0 + g.line.inlet_Pa / 1e9)).epsilon(2e-3));
  return {g.kernel.half_length() / exact.half_length - 1.0, g.kernel.opening(g.P(), 0.0) / exact.mouth_opening - 1.0,
          (g.line.inlet_Pa - closing) / exact.inlet_pressure - 1.0};
}

}  // namespace

// Requires the toughness limit (K_m = 26) within 0.3 % at about 30 cells, in length, mouth and inlet's net pressure.
// Measured -0.01, 0.02, 0.03 %. Mutations that fail: rate or compliance doubled, fluid lost at growth, an inlet that
// gives no fluid.
TEST_CASE("a fracture dominated by toughness") {
  const double mu = 1e-5, K_c = 1.45e6;
  CHECK(reference::kgd_toughness_number(E_prime, rate, mu, K_c) > 4.0);
  const auto limit = [&](double t) { return reference::kgd_toughness(E_prime, rate, t, K_c); };
  const Off off = run({mu, K_c, limit(100.0).half_length / 30}, limit);
  CAPTURE(off.length, off.mouth, off.inlet);
  CHECK(std::abs(off.length) < 3e-3);
  CHECK(std::abs(off.mouth) < 3e-3);
  CHECK(std::abs(off.inlet) < 3e-3);
}

// Requires the viscosity limit (K_Ic = 0) within 2 % in length and 2.5 % in mouth and inlet's net pressure at 30 cells,
// and less in the latter two at 60. Measured: length -0.9 and -0.8 %, mouth 1.3 and 0.9 %, inlet 1.9 and 1.3 %.
// Mutations that fail: conductance doubled (length) or halved, cube of the arithmetic mean at a face (length 5 %), that
// of a wedge (mouth 70 %), cells born full.
TEST_CASE("a fracture dominated by viscosity") {
  const double mu = 0.1;
  const reference::KgdShape shape(0, 120);
  const auto limit = [&](double t) { return reference::kgd_fracture(shape, E_prime, rate, t, mu); };
  Off before{1.0, 1.0, 1.0};
  for (const int cells : {30, 60}) {
    const Off off = run({mu, 0.0, limit(100.0).half_length / cells}, limit);
    CAPTURE(cells, off.length, off.mouth, off.inlet);
    CHECK(std::abs(off.length) < 0.02);
    CHECK(std::abs(off.mouth) < std::min(0.025, 0.8 * std::abs(before.mouth)));
    CHECK(std::abs(off.inlet) < std::min(0.025, 0.8 * std::abs(before.inlet)));
    before = off;
  }
}

// Requires a fracture of which toughness, viscosity and leak-off all count (efficiency 0.64 and 0.08 at 100 s) within 2
// % in length, 2.5 % in mouth and inlet's net pressure of the reference at 60 cells. Measured: 1.4, -1.7, -1.5 % and
// -0.3, -0.5, 1.1 % (30 cells: 0.4, -0.5, 0.7 % and -1.2, 3.6, 5.9 %). Mutations that fail: leak-off halved or doubled,
// cells wet from time 0 on.
TEST_CASE("a fracture that leaks off") {
  const double mu = 0.01, K_c = 1e6;
  for (const double C_L : {1e-5, 1e-4}) {
    const auto exact = [&](double t) { return reference::kgd_leakoff_once(E_prime, rate, t, mu, K_c, C_L, 80, 24); };
    const Off off = run({mu, K_c, exact(100.0).half_length / 60, C_L}, exact);
    CAPTURE(C_L, off.length, off.mouth, off.inlet);
    CHECK(std::abs(off.length) < 0.02);
    CHECK(std::abs(off.mouth) < 0.025);
    CHECK(std::abs(off.inlet) < 0.025);
  }
}
