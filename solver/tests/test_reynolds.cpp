#include <catch2/catch.hpp>
#include <channel_flow.hpp>

#include "crack_kernel.hpp"

using namespace strata;
using namespace strata::test;
using Eigen::Index;
using Eigen::VectorXd;

namespace {

constexpr double a = 5.0;                // half-length of the crack (m)
constexpr double E_prime = 10e9 / 0.96;  // of the study's stiff rock (Pa)

Fluid study_fluid(double floor = 0.0) {
  Fluid fluid;
  fluid.law = Fluid::Law::reynolds;
  fluid.minimum_opening_m = floor;
  return fluid;
}

std::vector<double> equal(std::size_t n, double length) {
  return std::vector<double>(n, length / static_cast<double>(n));
}

VectorXd as_eigen(const std::vector<double>& x) {
  return Eigen::Map<const VectorXd>(x.data(), static_cast<Index>(x.size()));
}

RockModel rigid(const VectorXd& w) {
  return [w](const VectorXd&) { return RockResponse{w, Eigen::MatrixXd::Zero(w.size(), w.size())}; };
}

double sum(const std::vector<double>& x) {
  return as_eigen(x).sum();
}

// Requires of a line what the law says of each cell.
void require_lawful(const ReynoldsLine& line, const Fluid& fluid) {
  for (std::size_t k = 0; k < line.size(); ++k) {
    REQUIRE(std::isfinite(line.P[k]));
    REQUIRE(std::isfinite(line.content[k]));
    REQUIRE(line.P[k] >= fluid.cavitation_Pa);
    REQUIRE(line.phi[k] >= 0.0);
    REQUIRE(line.phi[k] <= 1.0);
    REQUIRE((line.phi[k] == 1.0 || line.P[k] == fluid.cavitation_Pa));
  }
}

double order(double coarse, double fine) {
  return std::log2(coarse / fine);
}

// A rigid channel of the study under a ramp of 350 Pa/s from rest: P/M stays so small that the law is linear.
constexpr double ramp_Pa_s = 350.0;
ReynoldsLine ramped(const VectorXd& w, double length, int steps, double t) {
  const Fluid fluid = study_fluid();
  FluidBalance balance;
  ReynoldsLine line = full_line(fluid, equal(static_cast<std::size_t>(w.size()), length), 0, 0.0, w, balance);
  ReynoldsOptions exact;
  exact.tolerance = 1e-15;
  for (int k = 1; k <= steps; ++k)
    REQUIRE(step_reynolds(fluid, {Inlet::Drive::pressure, ramp_Pa_s * t * k / steps}, t / steps, rigid(w), line,
                          balance, exact)
                .converged);
  CHECK(std::abs(balance.closure()) < 1e-12);
  return line;
}

double error_in_channel(std::size_t cells, int steps, double t) {
  const ReynoldsLine line = ramped(VectorXd::Constant(static_cast<Index>(cells), 1e-4), a, steps, t);
  const reference::Channel channel{a, 1e-4, 0.1, 1e9, ramp_Pa_s};
  double most = 0.0;
  for (std::size_t k = 0; k < cells; ++k) {
    const double x = a * (static_cast<double>(k) + 0.5) / static_cast<double>(cells);
    most = std::max(most, std::abs(line.P[k] - ramped_channel(channel, reference::FarEnd::no_flux, x, t)));
  }
  return most / (ramp_Pa_s * t);
}

// Half a crack of 20 cells under the study's horizontal stress, open by 0.96 mm in its middle.
constexpr double closing = 2e6, steady_Pa = 2.5e6;
struct Bench {
  Fluid fluid = study_fluid();
  CrackKernel kernel{E_prime, closing, equal(20, a), true};
  RockModel rock = [this](const VectorXd& P) { return kernel(P); };
  FluidBalance balance;
  ReynoldsLine line;
  Bench() { restart(VectorXd::Constant(20, steady_Pa)); }
  void restart(const VectorXd& P) {
    line = full_line(fluid, equal(20, a), 0, steady_Pa, kernel(P).w, balance);
    for (std::size_t k = 0; k < 20; ++k) {
      line.P[k] = P(static_cast<Index>(k));
      line.content[k] = (1.0 + line.P[k] / fluid.bulk_modulus_Pa) * line.w[k] * line.length[k];
    }
    balance = {};
    balance.stored = balance.stored_at_start = sum(line.content);
  }
  StepReport step(double dt, const RockModel& with) {
    ReynoldsOptions exact;
    exact.tolerance = 1e-15;
    return step_reynolds(fluid, {Inlet::Drive::pressure, steady_Pa}, dt, with, line, balance, exact);
  }
  // Size of the error of P, by the energy that it stores in rock and fluid: e . (C + w/M) e.
  double off() const {
    const VectorXd e = as_eigen(line.P).array() - steady_Pa;
    return std::sqrt(e.dot(kernel.compliance() * e) + e.dot(as_eigen(line.w).cwiseProduct(e)) / fluid.bulk_modulus_Pa);
  }
};

VectorXd disturbed(double by) {
  VectorXd P = VectorXd::Constant(20, steady_Pa);
  for (Index k = 0; k < 20; ++k) P(k) += by * (k % 3 == 0 ? 1.0 : 0.2);
  return P;
}

// Growth of an error in the third step of the staggered scheme: flow with the opening and its rate of the step before,
// then opening from the new pressure.
double staggered_growth(double dt) {
  Bench bench;
  VectorXd w_old = bench.kernel(VectorXd::Constant(20, steady_Pa)).w, P = disturbed(1e-4);
  double before = 0.0, after = 0.0;
  for (int k = 0; k < 3; ++k) {
    const VectorXd w = bench.kernel(P).w;
    bench.restart(P);
    REQUIRE(bench.step(dt, rigid(2.0 * w - w_old)).converged);
    before = after;
    after = bench.off();
    w_old = w;
    P = as_eigen(bench.line.P);
  }
  return after / before;
}

}  // namespace

// Requires second order in space, where the solution is r t + f(x) and backward Euler exact, first order in time, and
// 3e-4 of the inlet's pressure from the closed form on the finest. Mutations that fail: conductance or storage doubled,
// distance to the inlet vertex a whole cell, no flow.
TEST_CASE("a rigid channel of constant opening") {
  const double coarse = error_in_channel(10, 60, 30.0), fine = error_in_channel(20, 60, 30.0);
  CAPTURE(coarse, fine);
  CHECK(order(coarse, fine) == Approx(2.0).margin(0.02));
  const double slow = error_in_channel(80, 40, 1.0), quick = error_in_channel(80, 80, 1.0);
  CAPTURE(slow, quick);
  CHECK(order(slow, quick) == Approx(1.0).margin(0.05));
  CHECK(error_in_channel(40, 4000, 1.0) < 3e-4);
}

// Requires the pressure of a rigid wedge that fills steadily, w^3/(12 mu) P' = -(r/M) int_x^L w, at second order, by
// the integral of the closed form. Mutations that fail: the mean of two openings off by 1 %, w of the one side only.
TEST_CASE("a rigid wedge") {
  const auto deficit = [](Index n) {
    VectorXd w(n);
    for (Index k = 0; k < n; ++k) w(k) = 1e-4 * (1.0 - 0.8 * (static_cast<double>(k) + 0.5) / static_cast<double>(n));
    return ramp_Pa_s * 400.0 - ramped(w, a, 400, 400.0).P.back();
  };
  const auto slope = [](double x) {
    const double w = 1.0 - 0.8 * x / a, ahead = (a - x) - 0.4 * (a * a - x * x) / a;
    return ramp_Pa_s / 1e9 * 12.0 * 0.1 * ahead / (1e-8 * w * w * w);
  };
  const auto exact = [&](Index n) {  // at the last cell's middle, midpoint rule
    const double to = a * (1.0 - 0.5 / static_cast<double>(n));
    double P = 0.0;
    for (int k = 0; k < 20000; ++k) P += slope(to * (k + 0.5) / 20000) * to / 20000;
    return P;
  };
  const double coarse = deficit(20) / exact(20) - 1.0, fine = deficit(40) / exact(40) - 1.0;
  CAPTURE(coarse, fine);
  CHECK(std::abs(coarse) < 0.02);
  CHECK(order(std::abs(coarse), std::abs(fine)) == Approx(2.0).margin(0.2));
}

// Requires of a crack fed for 2 s and shut in: balance to 1e-10 at every step, then one pressure all along, Sneddon's
// for the volume, V = 2 pi p a^2/E' both wings, to 0.1 %; and that the inlet lies above the first cell by q A/(2 k).
// Mutations that fail: storage without dw/dt or without compression, rate doubled, balance from the rate asked for
// in place of the flow.
TEST_CASE("a crack of fixed length fed at a rate") {
  Bench bench;
  const double rate = 5e-5, dt = 0.05;
  for (int k = 0; k < 40; ++k) {
    const double before = bench.balance.injected, density = 1.0 + bench.line.P[0] / bench.fluid.bulk_modulus_Pa;
    const StepReport r =
        step_reynolds(bench.fluid, {Inlet::Drive::rate, rate}, dt, bench.rock, bench.line, bench.balance);
    REQUIRE(r.converged);
    CHECK(r.iterations <= 6);
    CHECK(bench.balance.injected - before == Approx(dt * density * rate).epsilon(1e-10));
    const double w = bench.line.w[0], drop = rate * 12.0 * 0.1 / (w * w * w) * 0.5 * bench.line.length[0];
    CHECK(r.inlet_Pa - bench.line.P[0] == Approx(drop).epsilon(1e-6));
    REQUIRE(std::abs(bench.balance.closure()) < 1e-10);
  }
  CHECK(bench.balance.injected == Approx(rate * 2.0 * (1.0 + 2.8e6 / 1e9)).epsilon(1e-3));
  for (int k = 0; k < 100; ++k)
    REQUIRE(
        step_reynolds(bench.fluid, {Inlet::Drive::rate, 0.0}, 1.0, bench.rock, bench.line, bench.balance).converged);
  REQUIRE(std::abs(bench.balance.closure()) < 1e-10);
  const double P = bench.line.P[0], stored = sum(bench.line.content);
  for (const double p : bench.line.P) CHECK(p == Approx(P).epsilon(1e-9));
  CHECK((1.0 + P / 1e9) * std::numbers::pi * (P - closing) * a * a / E_prime == Approx(stored).epsilon(1e-3));
}

// Requires that the estimate of a step's error is what the step is off by: against 64 small ones, within a third.
TEST_CASE("the estimated error of a step") {
  Bench start;
  for (int k = 0; k < 8; ++k)
    REQUIRE(
        step_reynolds(start.fluid, {Inlet::Drive::rate, 5e-5}, 0.25, start.rock, start.line, start.balance).converged);
  ReynoldsLine one = start.line, many = start.line;
  FluidBalance balance = start.balance;
  const StepReport r = step_reynolds(start.fluid, {Inlet::Drive::rate, 5e-5}, 0.25, start.rock, one, balance);
  CHECK(r.error_w > 0.0);
  for (int k = 0; k < 64; ++k)
    step_reynolds(start.fluid, {Inlet::Drive::rate, 5e-5}, 0.25 / 64, start.rock, many, balance);
  const double off = (as_eigen(one.w) - as_eigen(many.w)).cwiseAbs().maxCoeff() / as_eigen(one.w).maxCoeff();
  CAPTURE(r.error_w, off);
  CHECK(r.error_w > 0.67 * off);
  CHECK(r.error_w < 1.5 * off);
}

// Documents why flow and rock are one system: pressure first with the opening's last rate, opening from it afterwards,
// multiplies an error at every step: measured 1883 times at 0.1 ms, 1614, 869, 163 and 18.7 times at 1 s. The coupled
// step never lets it grow, at any of these steps; and the longer the step, the less is left. Mutations that fail: dw_dP
// given to the coupled step as zero or twice what it is (no convergence), the rock left rigid in it.
TEST_CASE("a staggered step amplifies an error, the coupled one damps it") {
  double shorter = 1.0;
  for (const double dt : {1e-4, 1e-3, 1e-2, 1e-1, 1.0}) {
    const double growth = staggered_growth(dt);
    Bench bench;
    bench.restart(disturbed(1e4));
    const double start = bench.off();
    double before = start, first = 0.0, worst = 0.0;
    for (int k = 0; k < 20; ++k) {
      REQUIRE(bench.step(dt, bench.rock).converged);
      worst = std::max(worst, bench.off() / before);
      before = bench.off();
      if (k == 0) first = before / start;
    }
    CAPTURE(dt, growth, first, worst);
    CHECK(growth > (dt < 2e-3 ? 1000.0 : 10.0));
    CHECK(worst <= 1.0);
    CHECK(first < shorter);
    shorter = first;
  }
}

// Requires of cells that appear at once ahead of the fluid, in a crack that stays open under a low stress: empty at
// first, then filled from the inlet's side, one after the other; never below the cavitation pressure; balance to 1e-10.
// Mutations that fail: cells born full, outflow from cells that are not full, content not kept over growth.
TEST_CASE("sudden growth leaves empty cells that fill") {
  const Fluid fluid = study_fluid();
  std::vector<double> h = equal(10, 2.5);
  CrackKernel kernel(E_prime, 1e5, h, true);
  const RockModel rock = [&kernel](const VectorXd& P) { return kernel(P); };
  FluidBalance balance;
  ReynoldsLine line = full_line(fluid, h, 0, 2e6, kernel(VectorXd::Constant(10, 2e6)).w, balance);
  std::vector<double> held = line.content;
  held.resize(16, 0.0);
  for (int k = 0; k < 6; ++k) {
    grow(line, fluid, true, 0.25);
    h.push_back(0.25);
  }
  kernel = CrackKernel(E_prime, 1e5, h, true);
  CHECK(line.content == held);
  double emptiest = 1.0;
  bool filled = false;
  for (int step = 0; step < 3000 && !filled; ++step) {
    const StepReport r = step_reynolds(fluid, {Inlet::Drive::rate, 2e-4}, 2e-3, rock, line, balance);
    REQUIRE(r.converged);
    CHECK((r.error_w > 0.0) == (step > 0));
    require_lawful(line, fluid);
    REQUIRE(std::abs(balance.closure()) < 1e-10);
    REQUIRE(sum(line.content) == Approx(balance.stored).epsilon(1e-10));
    for (std::size_t k = 11; k < 16; ++k)
      if (line.phi[k] > 1e-9) CHECK(line.phi[k - 1] > 0.999);
    if (step == 0) emptiest = line.phi.back();
    filled = line.phi.back() == 1.0;
  }
  CHECK(emptiest == 0.0);
  CHECK(filled);
  CHECK(line.P.back() < line.P.front());
}

// Requires that a step right after growth converges and is lawful, whatever its length from 0.1 ms to 1 s, from a fluid
// like gas to one like honey, in short and long fractures under a closing stress that shuts the new cell; in 12
// iterations on average. Mutation that fails: no second start (a thin fluid then stalls in front of the closed cell).
TEST_CASE("a step of any length after growth") {
  int steps = 0, iterations = 0, most = 0;
  for (const double mu : {1e-5, 1e-4, 1e-3, 1e-2, 0.1, 10.0}) {
    for (const std::size_t n : std::initializer_list<std::size_t>{3, 4, 5, 8, 20}) {
      for (const double floor : {0.0, 1e-5, 1e-4}) {
        Fluid fluid = study_fluid(floor);
        fluid.viscosity_Pa_s = mu;
        const double cell = 0.25, length = cell * static_cast<double>(n);
        const double P = 20e6 + 1.45e6 / std::sqrt(std::numbers::pi * length);
        const CrackKernel short_one(E_prime, 20e6, std::vector<double>(n, cell), true);
        const CrackKernel kernel(E_prime, 20e6, std::vector<double>(n + 1, cell), true);
        for (double dt = 1e-4; dt < 1.1; dt *= std::sqrt(10.0)) {
          FluidBalance balance;
          ReynoldsLine line = full_line(fluid, std::vector<double>(n, cell), 0, P,
                                        short_one(VectorXd::Constant(static_cast<Index>(n), P)).w, balance);
          grow(line, fluid, true, cell);
          const StepReport r = step_reynolds(
              fluid, {Inlet::Drive::rate, 5e-5}, dt, [&](const VectorXd& p) { return kernel(p); }, line, balance);
          CAPTURE(mu, n, floor, dt, r.reason);
          ++steps;
          iterations += r.iterations;
          most = std::max(most, r.iterations);
          CHECK(r.converged);
          require_lawful(line, fluid);
          CHECK(std::abs(balance.closure()) < 1e-10);
        }
      }
    }
  }
  CAPTURE(steps, iterations, most);
  CHECK(iterations < 12 * steps);
}

// Requires that a crack fed in its middle is twice the half that symmetry leaves, at half the rate, also while both of
// its tips grow. Mutations that fail: the inlet's vertex not moved when the first cell is new, the rate given to one
// side.
TEST_CASE("an inlet between two cells") {
  const Fluid fluid = study_fluid(1e-5);
  std::vector<double> h = equal(8, 2.0), both_h = equal(16, 4.0);
  CrackKernel half(E_prime, closing, h, true), both(E_prime, closing, both_h, false);
  FluidBalance half_balance, balance;
  ReynoldsLine one = full_line(fluid, h, 0, closing, VectorXd::Zero(8), half_balance);
  ReynoldsLine two = full_line(fluid, both_h, 8, closing, VectorXd::Zero(16), balance);
  for (int step = 0; step < 40; ++step) {
    if (step % 10 == 9) {
      grow(one, fluid, true, 0.25);
      grow(two, fluid, true, 0.25);
      grow(two, fluid, false, 0.25);
      half = CrackKernel(E_prime, closing, one.length, true);
      both = CrackKernel(E_prime, closing, two.length, false);
    }
    const auto rock = [](const CrackKernel& k) { return [&k](const VectorXd& P) { return k(P); }; };
    const StepReport r = step_reynolds(fluid, {Inlet::Drive::rate, 5e-5}, 0.02, rock(half), one, half_balance);
    const StepReport s = step_reynolds(fluid, {Inlet::Drive::rate, 1e-4}, 0.02, rock(both), two, balance);
    REQUIRE((r.converged && s.converged));
    CHECK(s.inlet_Pa == Approx(r.inlet_Pa).epsilon(1e-7));
    const std::size_t n = one.size();
    for (std::size_t k = 0; k < n; ++k) {
      CHECK(two.P[n + k] == Approx(one.P[k]).epsilon(1e-7));
      CHECK(two.P[n - 1 - k] == Approx(one.P[k]).epsilon(1e-7));
    }
  }
  CHECK(two.inlet == 12);
  CHECK(balance.injected == Approx(2.0 * half_balance.injected).epsilon(1e-9));
  CHECK(std::abs(balance.closure()) < 1e-10);
}

// Requires finite, lawful steps from 0.1 ms to 1 s while the inlet's pressure rises through the closing stress and
// falls again, the faces closed at first and at the end, floor or not; and that the fluid that is there comes out
// again.
TEST_CASE("a crack that opens and closes") {
  for (const double floor : {0.0, 1e-5, 1e-4}) {
    for (const double dt : {1e-4, 1e-2, 1.0}) {
      const Fluid fluid = study_fluid(floor);
      const CrackKernel kernel(E_prime, closing, equal(12, a), true);
      FluidBalance balance;
      ReynoldsLine line = full_line(fluid, equal(12, a), 0, 0.0, VectorXd::Zero(12), balance);
      double widest = 0.0;
      for (int k = 1; k <= 30; ++k) {
        const double P = 3e6 * std::sin(std::numbers::pi * k / 30.0);
        const StepReport r = step_reynolds(
            fluid, {Inlet::Drive::pressure, P}, dt, [&](const VectorXd& p) { return kernel(p); }, line, balance);
        CAPTURE(floor, dt, k, r.reason, r.iterations);
        REQUIRE(r.converged);
        require_lawful(line, fluid);
        REQUIRE(std::abs(balance.closure()) < 1e-10);
        widest = std::max(widest, line.w[0]);
      }
      if (floor == 1e-4 && dt == 1.0) CHECK(widest > 2e-5);
    }
  }
}

// Requires pressures at vertices that are exact for a linear pressure in uneven cells, the inlet's own at the inlet and
// the last cell's at a closed end.
TEST_CASE("pressures at the vertices") {
  ReynoldsLine line;
  line.length = {1.0, 3.0, 2.0};
  line.P = {0.5, 2.5, 5.0};
  line.inlet_Pa = 7.0;
  CHECK(vertex_pressures(line) == std::vector<double>{7.0, 1.0, 4.0, 5.0});
  line.inlet = 2;
  CHECK(vertex_pressures(line) == std::vector<double>{0.5, 1.0, 7.0, 5.0});
}

// Requires that a step that fails says so and leaves everything as it was.
TEST_CASE("a step that fails changes nothing") {
  Bench bench;
  const std::vector<double> P = bench.line.P;
  const RockModel bad = [](const VectorXd& p) {
    return RockResponse{VectorXd::Constant(p.size(), std::nan("")), Eigen::MatrixXd::Zero(p.size(), p.size())};
  };
  const StepReport r = bench.step(0.1, bad);
  CHECK_FALSE(r.converged);
  CHECK_THAT(r.reason, Catch::Contains("not finite"));
  CHECK(bench.line.P == P);
  CHECK(bench.balance.injected == 0.0);
  ReynoldsOptions none;
  none.max_iterations = 0;
  const StepReport s =
      step_reynolds(bench.fluid, {Inlet::Drive::rate, 1e-3}, 0.1, bench.rock, bench.line, bench.balance, none);
  CHECK_FALSE(s.converged);
  CHECK_THAT(s.reason, Catch::Contains("did not converge"));
  CHECK(bench.line.P == P);
}

// Requires that a step whose rock tells openings to 1e-13 m alone, as its stiff contact has lost digits, is found where
// the rock says so, with the pressure that exact openings give, and not else. Mutation that fails: no such digits.
TEST_CASE("a balance is solved to the digits that its rock has") {
  const auto stepped = [](double noise, double cancels, StepReport& report) {
    Bench bench;
    int calls = 0;
    const RockModel rock = [&](const VectorXd& P) {
      RockResponse r = bench.rock(P);
      for (Index k = 0; k < P.size(); ++k) r.w(k) += noise * std::sin(7.0 * static_cast<double>(++calls));
      r.cancels = cancels;
      return r;
    };
    report = step_reynolds(bench.fluid, {Inlet::Drive::rate, 1e-3}, 0.1, rock, bench.line, bench.balance);
    return bench.line.P.front();
  };
  StepReport report;
  const double P = stepped(0.0, 0.0, report);
  REQUIRE(report.converged);
  stepped(1e-13, 0.0, report);
  CHECK_FALSE(report.converged);
  CHECK(stepped(1e-13, 1e13, report) == Approx(P).epsilon(1e-7));
  CHECK(report.converged);
}

// Requires that what says where to look names a floor that is above all openings, with both, and only then.
TEST_CASE("a floor above all openings is named where a step fails") {
  const auto reason = [](double floor) {
    Bench bench;
    bench.fluid.minimum_opening_m = floor;
    return bench
        .step(0.1,
              [](const VectorXd& P) {
                return RockResponse{VectorXd::Constant(P.size(), std::nan("")),
                                    Eigen::MatrixXd::Zero(P.size(), P.size())};
              })
        .reason;
  };
  CHECK_THAT(reason(1.0), Catch::Contains("minimum_opening_m = 1 is above all openings, ") &&
                              Catch::Contains("lower it below the openings"));
  CHECK_THAT(reason(1e-6), !Catch::Contains("above all openings"));
}
