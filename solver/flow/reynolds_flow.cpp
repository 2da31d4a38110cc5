#include "flow/reynolds_flow.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <unsupported/Eigen/AutoDiff>

namespace strata {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
// A value with its derivatives by P and w of the cell on the left, P and w of the one on the right, P at the inlet.
constexpr int unknowns = 5, inlet_P = 4;
using Dual = Eigen::AutoDiffScalar<Eigen::Matrix<double, unknowns, 1>>;

// A step that is halved until it is of no length has more to it than its length.
std::string what_to_look_at(const Fluid& fluid, const ReynoldsLine& line) {
  const double widest = std::ranges::max(line.w);
  if (fluid.minimum_opening_m <= widest)
    return "Look at fluid.inlet, viscosity_Pa_s, bulk_modulus_Pa and minimum_opening_m, or use smaller cells";
  return fmt::format(
      "fluid.minimum_opening_m = {:g} is above all openings, {:.3g} m at most, so that closed faces conduct as open "
      "ones: lower it below the openings that the fluid makes. Else look at fluid.inlet, viscosity_Pa_s and "
      "bulk_modulus_Pa, or use smaller cells",
      fluid.minimum_opening_m, widest);
}

std::vector<double> as_vector(const VectorXd& x) {
  return {x.data(), x.data() + x.size()};
}

Eigen::Map<const VectorXd> mapped(const std::vector<double>& x) {
  return {x.data(), static_cast<Index>(x.size())};
}

struct Place {
  Dual P, w;
  double A = 0.0;
  double closing = 0.0;     // Pa
  double compliance = 0.0;  // 1/E' (1/Pa); 0: rigid within a cell
  double rise = 0.0;        // rho g times its height above the inlet (Pa)

  Dual level() const { return P + rise; }  // what falls where fluid flows
};

// The opening that conducts: never below the scene's floor.
Dual conducting(const Fluid& fluid, const Place& at) {
  const double floor = std::max(fluid.minimum_opening_m, thinnest);
  return at.w.value() > floor ? at.w : Dual(floor);
}

// Opening within a cell (m) by a fluid that comes from P and has parted its faces over less than that: the rock's
// equilibrium, which knows the pressure at the cell's middle alone, still holds them closed. A fracture without
// toughness from the cell's end to its middle, L = A/2, with a net pressure p at its inlet takes q = L^2 p^4/(2 g^2
// Pi^4 12 mu E'^3) (g = 0.6155, Pi = 0.5448: viscosity vertex of the plane-strain fracture, Adachi & Detournay 2002):
// as much as a channel of 1.233 A p/E' under p/L. p is what of the fall from P to the cell's pressure is above the
// closing stress.
Dual parted(const Dual& P, const Place& at) {
  const Dual below = at.P.value() > at.closing ? at.P : Dual(at.closing);
  constexpr double of_fracture = 1.233;
  return P.value() > below.value() ? Dual(of_fracture * at.A * at.compliance * (P - below)) : Dual(0.0);
}

// Conductance between the middles of two cells (m^2/(Pa s)), w^3/(12 mu) over their distance.
Dual between(const Fluid& fluid, const Place& l, const Place& r) {
  const double rise = r.rise - l.rise;
  const Dual within = l.P.value() > r.P.value() + rise ? parted(Dual(l.P - rise), r) : parted(Dual(r.P + rise), l);
  const Dual w = opening_between(conducting(fluid, l), conducting(fluid, r)) + within;
  return Dual(w * w * w) / (6.0 * fluid.viscosity_Pa_s * (l.A + r.A));
}

// Conductance between a cell's middle and the inlet vertex at P, half a cell of its opening.
Dual from_vertex(const Fluid& fluid, const Dual& P, const Place& at) {
  const Dual w = conducting(fluid, at) + parted(P, at);
  return Dual(w * w * w) / (6.0 * fluid.viscosity_Pa_s * at.A);
}

// Where the iteration stands: cells with P free are full, the others have P = P_c and phi free.
struct Trial {
  VectorXd P, phi;
  std::vector<char> full;
};

struct Balance {
  RockResponse rock;
  VectorXd held, inflow;  // theta w A (m^2), net flow into the cell (m^2/s), both at the cavitation pressure
  VectorXd leak;          // lost to the rock over the step (m^2)
  VectorXd residual;      // held - held before - dt inflow + leak
  // d inflow/d P, d inflow/d w of a cell (rows) by the cell before it, itself and the one behind it (columns).
  Eigen::MatrixX3d by_P, by_w;
  Eigen::MatrixX2d by_phi;  // what a cell that is full in part gives to the one before it and the one behind, by phi
  double inlet_Pa = 0.0;
  double injected = 0.0;  // flow into the fracture at the cavitation pressure (m^2/s)

  bool finite() const {
    return residual.allFinite() && rock.w.allFinite() && rock.dw_dP.allFinite() && std::isfinite(inlet_Pa);
  }
  double merit() const { return residual.lpNorm<1>(); }
};

struct Step {
  const Fluid& fluid;
  const Inlet& inlet;
  double dt;
  const RockModel& rock;
  const ReynoldsLine& line;
  const ReynoldsOptions& options;
};

Place place(const Step& step, const Trial& trial, const Balance& b, Index k, bool left) {
  const int first = left ? 0 : 2;
  Place at{Dual(trial.P(k), unknowns, first), Dual(b.rock.w(k), unknowns, first + 1),
           step.line.length[static_cast<std::size_t>(k)]};
  if (b.rock.rise.size() > 0) at.rise = b.rock.rise(k);
  if (b.rock.E_prime.size() > 0) at.closing = b.rock.closing(k), at.compliance = 1.0 / b.rock.E_prime(k);
  return at;
}

// Conductance from cell k to the next one: near a moving front by the opening on its side.
Dual across(const Step& step, const RockResponse& rock, const Place& l, const Place& r, Index k) {
  const double given = rock.front.size() > 0 ? rock.front(k) : 0.0;
  if (given == 0.0) return between(step.fluid, l, r);
  return std::abs(given) * conducting(step.fluid, given > 0.0 ? r : l);
}

// Adds a flow (m^2/s) into cell `to`, with derivatives by the cells l and r, of which one may be missing (-1).
void add_flow(Balance& b, Index to, const Dual& flow, Index l, Index r) {
  b.inflow(to) += flow.value();
  if (l >= 0) {
    b.by_P(to, l - to + 1) += flow.derivatives()(0);
    b.by_w(to, l - to + 1) += flow.derivatives()(1);
  }
  if (r >= 0) {
    b.by_P(to, r - to + 1) += flow.derivatives()(2);
    b.by_w(to, r - to + 1) += flow.derivatives()(3);
  }
}

// Flow between neighbours, by the fall of P + rho g y. What flows is the fluid of the cell where that is higher, which
// is full: an empty cell is at the lowest pressure there is and gives nothing. But by its weight a cell that is full in
// part gives that part of what it would give if it were full.
void add_faces(const Step& step, const Trial& trial, Balance& b) {
  for (Index k = 0; k + 1 < trial.P.size(); ++k) {
    if (step.line.is_dry(static_cast<std::size_t>(k)) || step.line.is_dry(static_cast<std::size_t>(k) + 1)) continue;
    const Place l = place(step, trial, b, k, true), r = place(step, trial, b, k + 1, false);
    const Dual c = across(step, b.rock, l, r, k);
    const double rise = r.rise - l.rise;
    const bool onwards = trial.P(k) > trial.P(k + 1) + rise;
    const Index from = onwards ? k : k + 1;
    Dual flow = density(step.fluid, onwards ? l.P : r.P) * c * (l.P - r.P - rise);
    if (rise != 0.0 && !trial.full[static_cast<std::size_t>(from)]) {
      b.by_phi(from, onwards ? 1 : 0) = std::abs(flow.value());
      flow = trial.phi(from) * flow;
    }
    // Towards a front no more than there is room for behind it.
    const double most = b.rock.most.size() > 0 ? b.rock.most(k) : std::nan("");
    if (std::copysign(1.0, most) * flow.value() > std::abs(most)) flow = Dual(most);
    add_flow(b, k, -flow, k, k + 1);
    add_flow(b, k + 1, flow, k, k + 1);
  }
}

// What is beside the inlet vertex: up to two cells (-1: none), with conductances that follow the vertex's pressure.
struct Beside {
  Index cell[2];
  Place at[2] = {{Dual(0.0), Dual(0.0)}, {Dual(0.0), Dual(0.0)}};
  Dual c[2] = {Dual(0.0), Dual(0.0)};

  void conduct(const Step& step, const Dual& P) {
    for (int s = 0; s < 2; ++s)
      if (cell[s] >= 0) c[s] = from_vertex(step.fluid, Dual(P - at[s].rise), at[s]);
  }
};

// The inlet's pressure at which the rate flows in, sum c_s(P) (P - P_s) = rate, with its derivatives. The sum rises
// with P and is convex: Newton's method comes down to it from the pressure that a vertex no wider than its cells would
// need. Where all is closed the sum goes by the fourth power of P and each step takes a quarter off, so that 200 are
// enough for any two numbers.
Dual pressure_for(const Step& step, Beside& b) {
  const double rate = step.inlet.value;
  b.conduct(step, Dual(0.0));
  Dual P((rate + (b.c[0] * b.at[0].level() + b.c[1] * b.at[1].level()).value()) / (b.c[0] + b.c[1]).value(), unknowns,
         inlet_P);
  Dual left;
  for (int k = 0; k < 200; ++k) {
    b.conduct(step, P);
    left = b.c[0] * (P - b.at[0].level()) + b.c[1] * (P - b.at[1].level()) - Dual(rate);
    const double change = left.value() / left.derivatives()(inlet_P);
    if (!(change > 1e-15 * P.value())) break;
    P.value() -= change;
  }
  P.derivatives() = left.derivatives() / -left.derivatives()(inlet_P);
  P.derivatives()(inlet_P) = 0.0;
  return P;
}

// Flow from the inlet vertex into the cells beside it, at a pressure given or such that the rate is met.
void add_inlet(const Step& step, const Trial& trial, Balance& b) {
  const Index vertex = static_cast<Index>(step.line.inlet);
  Beside beside{{vertex - 1, vertex < trial.P.size() ? vertex : -1}};
  for (int s = 0; s < 2; ++s)
    if (beside.cell[s] >= 0) beside.at[s] = place(step, trial, b, beside.cell[s], s == 0);
  const bool by_rate = step.inlet.drive == Inlet::Drive::rate;
  const Dual P = by_rate ? pressure_for(step, beside) : Dual(std::max(step.inlet.value, step.fluid.cavitation_Pa));
  beside.conduct(step, P);
  b.inlet_Pa = P.value();
  const auto& [cell, at, c] = beside;
  for (int s = 0; s < 2; ++s) {
    if (cell[s] < 0) continue;
    // By rate in this form and not as c (P - P_s), which loses digits where c is large.
    Dual q = c[s] * (P - at[s].level());
    if (by_rate) q = (Dual(step.inlet.value) + c[1 - s] * (at[1 - s].level() - at[s].level())) * c[s] / (c[0] + c[1]);
    if (at[s].rise != 0.0 && q.value() < 0.0) q = trial.phi(cell[s]) * q;
    // A rate counts at the pressure of the cell before the step: at the one sought, more inflow would raise the
    // pressure and that the inflow again, without a solution where a step brings more than a closed cell holds.
    const Dual entering = by_rate ? Dual(step.line.P[static_cast<std::size_t>(cell[s])]) : P;
    const Dual flow = density(step.fluid, q.value() >= 0.0 ? entering : at[s].P) * q;
    add_flow(b, cell[s], flow, cell[0], cell[1]);
    b.injected += flow.value();
  }
}

// What a full cell loses over the step (m^2 at the cavitation pressure), at its pressure before.
double full_leak(const Step& step, const RockResponse& rock, Index k) {
  const auto cell = static_cast<std::size_t>(k);
  return density(step.fluid, step.line.P[cell]) * (rock.lost(k) - step.line.leaked[cell]);
}

Balance evaluate(const Step& step, const Trial& trial) {
  const Index n = trial.P.size();
  Balance b;
  b.rock = step.rock(trial.P);
  b.held = b.inflow = VectorXd::Zero(n);
  b.by_P = b.by_w = Eigen::MatrixX3d::Zero(n, 3);
  b.by_phi = Eigen::MatrixX2d::Zero(n, 2);
  add_faces(step, trial, b);
  add_inlet(step, trial, b);
  for (Index k = 0; k < n; ++k)
    b.held(k) = trial.phi(k) * density(step.fluid, trial.P(k)) * storage_opening(b.rock.w(k)) *
                step.line.length[static_cast<std::size_t>(k)];
  b.residual = b.held - mapped(step.line.content) - step.dt * b.inflow;
  b.leak = VectorXd::Zero(n);
  for (Index k = 0; k < b.rock.lost.size(); ++k) b.leak(k) = trial.phi(k) * full_leak(step, b.rock, k);
  b.residual += b.leak;
  return b;
}

// d residual/d(unknown): the unknown of a column is P where the cell is full, phi elsewhere.
MatrixXd jacobian(const Step& step, const Trial& trial, const Balance& b) {
  const Index n = trial.P.size();
  Eigen::MatrixX3d by_P = -step.dt * b.by_P, by_w = -step.dt * b.by_w;
  for (Index k = 0; k < n; ++k) {
    by_P(k, 1) += b.held(k) / (density(step.fluid, trial.P(k)) * step.fluid.bulk_modulus_Pa);
    if (b.rock.w(k) > thinnest) by_w(k, 1) += b.held(k) / b.rock.w(k);
  }
  MatrixXd J = MatrixXd::Zero(n, n);
  J.diagonal(-1) = by_P.col(0).tail(n - 1);
  J.diagonal() = by_P.col(1);
  J.diagonal(1) = by_P.col(2).head(n - 1);
  J.bottomRows(n - 1) += by_w.col(0).tail(n - 1).asDiagonal() * b.rock.dw_dP.topRows(n - 1);
  J += by_w.col(1).asDiagonal() * b.rock.dw_dP;
  J.topRows(n - 1) += by_w.col(2).head(n - 1).asDiagonal() * b.rock.dw_dP.bottomRows(n - 1);
  for (Index k = 0; k < n; ++k) {
    if (trial.full[static_cast<std::size_t>(k)]) continue;
    J.col(k).setZero();
    J(k, k) = storage_opening(b.rock.w(k)) * step.line.length[static_cast<std::size_t>(k)];
    if (b.rock.lost.size() > 0) J(k, k) += full_leak(step, b.rock, k);
    J(k, k) += step.dt * b.by_phi.row(k).sum();
    if (k > 0) J(k - 1, k) -= step.dt * b.by_phi(k, 0);
    if (k + 1 < n) J(k + 1, k) -= step.dt * b.by_phi(k, 1);
  }
  return J;
}

// The trial a fraction of the way along dx; a cell whose bound is passed stops there and frees its other unknown.
Trial moved(const Fluid& fluid, const Trial& from, const VectorXd& dx, double fraction) {
  Trial to = from;
  for (Index k = 0; k < dx.size(); ++k) {
    char& full = to.full[static_cast<std::size_t>(k)];
    if (full) {
      to.P(k) += fraction * dx(k);
      if (to.P(k) >= fluid.cavitation_Pa) continue;
      to.P(k) = fluid.cavitation_Pa;
      full = 0;
    } else {
      to.phi(k) = std::max(0.0, to.phi(k) + fraction * dx(k));
      if (to.phi(k) <= 1.0) continue;
      to.phi(k) = 1.0;
      full = 1;
    }
  }
  return to;
}

// Part of a Newton step that changes no pressure by more than half of what is there: a closed fracture seems rigid and
// would be blown up by the pressure that compresses the fluid instead.
double trusted_fraction(const Step& step, const Trial& trial, const VectorXd& dx) {
  double scale = 1e5, change = 0.0;  // an atmosphere, where there is no pressure yet
  scale = std::max(scale, trial.P.maxCoeff() - step.fluid.cavitation_Pa);
  if (step.inlet.drive == Inlet::Drive::pressure) scale = std::max(scale, step.inlet.value - step.fluid.cavitation_Pa);
  for (Index k = 0; k < dx.size(); ++k)
    if (trial.full[static_cast<std::size_t>(k)]) change = std::max(change, std::abs(dx(k)));
  return change > 0.5 * scale ? 0.5 * scale / change : 1.0;
}

// True where every cell's balance, and that of all together, holds as well as the tolerance and the round-off of the
// fluxes allow.
bool balanced(const Step& step, const Trial& trial, const Balance& b, const MatrixXd& J) {
  const double total = std::max(b.held.sum(), step.dt * std::abs(b.injected));
  const double digit = 4.0 * std::numeric_limits<double>::epsilon() * std::max(trial.P.maxCoeff(), b.rock.cancels);
  VectorXd of_cell = VectorXd::Zero(b.residual.size());  // round-off
  double of_whole = 0.0;
  for (Index j = 0; j < b.residual.size(); ++j) {
    if (!trial.full[static_cast<std::size_t>(j)]) continue;
    of_cell += digit * J.col(j).cwiseAbs();
    of_whole += digit * std::abs(J.col(j).sum());
  }
  if ((b.residual.array().abs() > step.options.tolerance * total + of_cell.array()).any()) return false;
  // Flows between cells, whose round-off counts above, are none of the whole's, of which a tenth of what marks a run
  // may be missing.
  constexpr double of_all = 1e-9;
  return std::abs(b.residual.sum()) <= of_all * total + of_whole;
}

struct Iterate {
  Trial trial;
  Balance b;
};

// Halves the step along dx until the imbalance falls; the best of all that were tried, nothing where none is finite.
// Where a cell fills up none may be better than where it came from: the cell's other unknown takes its step next.
std::optional<Iterate> search(const Step& step, const Iterate& from, const VectorXd& dx) {
  std::optional<Iterate> best;
  double fraction = trusted_fraction(step, from.trial, dx);
  for (int halving = 0; halving < 6; ++halving, fraction *= 0.5) {
    Iterate next{moved(step.fluid, from.trial, dx, fraction), {}};
    next.b = evaluate(step, next.trial);
    if (!next.b.finite()) continue;
    const double merit = next.b.merit();
    if (!best || merit < best->b.merit()) best = std::move(next);
    if (merit < (1.0 - 1e-4 * fraction) * from.b.merit()) break;
  }
  return best;
}

// Newton's method from `at`, which becomes the solution; the report says why not otherwise.
StepReport iterate(const Step& step, int max_iterations, Iterate& at) {
  StepReport report;
  at.b = evaluate(step, at.trial);
  for (; at.b.finite(); ++report.iterations) {
    const MatrixXd J = jacobian(step, at.trial, at.b);
    report.converged = balanced(step, at.trial, at.b, J);
    if (report.converged) return report;
    if (report.iterations == max_iterations) {
      report.reason = "the balance of flow and rock did not converge in " + std::to_string(report.iterations) +
                      " iterations. " + what_to_look_at(step.fluid, step.line);
      return report;
    }
    const VectorXd dx = J.partialPivLu().solve(-at.b.residual);
    if (!dx.allFinite()) break;
    std::optional<Iterate> next = search(step, at, dx);
    if (!next) break;
    at = std::move(*next);
  }
  report.reason = "flow and rock gave values that are not finite. " + what_to_look_at(step.fluid, step.line);
  return report;
}

// Where the iteration starts: what was before the step,
Trial before(const ReynoldsLine& line) {
  Trial trial{mapped(line.P), mapped(line.phi), {}};
  for (const double phi : line.phi) trial.full.push_back(phi >= 1.0);
  return trial;
}

// or every cell full at the highest pressure. A thin fluid enters a cell in which the faces touch the faster the more
// it opens them, and least when it has filled it: between the two the flow has a hump over which no descent leads.
Trial filled(const ReynoldsLine& line) {
  Trial trial = before(line);
  const double highest = trial.P.maxCoeff();
  for (std::size_t k = 0; k < line.size(); ++k) {
    if (line.is_dry(k)) continue;
    trial.P(static_cast<Index>(k)) = highest, trial.phi(static_cast<Index>(k)) = 1.0;
    trial.full[k] = 1;
  }
  return trial;
}

// Half the change of the opening's rate over a step is backward Euler's local error over dt, dt^2 w''/2.
double error_of(const Step& step, const VectorXd& w) {
  if (!step.line.rates_known) return 0.0;
  const VectorXd foreseen = mapped(step.line.w) + step.dt * mapped(step.line.w_rate);
  return 0.5 * (w - foreseen).lpNorm<Eigen::Infinity>() / std::max(w.maxCoeff(), thinnest);
}

void accept(const Step& step, const Trial& trial, const Balance& b, ReynoldsLine& line) {
  line.w_rate = as_vector((b.rock.w - mapped(line.w)) / step.dt);
  // By flows and not by what is held: what the iteration leaves over then does not add up from step to step.
  line.content = as_vector(mapped(line.content) + step.dt * b.inflow - b.leak);
  for (std::size_t k = 0; k < static_cast<std::size_t>(b.rock.lost.size()); ++k)
    line.leaked[k] += trial.phi(static_cast<Index>(k)) * (b.rock.lost(static_cast<Index>(k)) - line.leaked[k]);
  line.w = as_vector(b.rock.w);
  line.P = as_vector(trial.P);
  line.phi = as_vector(trial.phi);
  line.inlet_Pa = b.inlet_Pa;
  line.rates_known = true;
}

}  // namespace

StepReport step_reynolds(const Fluid& fluid, const Inlet& inlet, double dt, const RockModel& rock, ReynoldsLine& line,
                         FluidBalance& balance, const ReynoldsOptions& options) {
  const Step step{fluid, inlet, dt, rock, line, options};
  Iterate at{options.filled_first ? filled(line) : before(line), {}};
  StepReport report = iterate(step, options.max_iterations / 5, at);
  if (!report.converged) {
    const int iterations = report.iterations;
    at.trial = options.filled_first ? before(line) : filled(line);
    report = iterate(step, options.max_iterations, at);
    report.iterations += iterations;
  }
  if (!report.converged) return report;
  const Balance& b = at.b;
  report.inlet_Pa = b.inlet_Pa;
  report.error_w = error_of(step, b.rock.w);
  accept(step, at.trial, b, line);
  balance.injected += dt * b.injected;
  balance.largest = std::max(balance.largest, std::abs(balance.injected));
  balance.leaked += b.leak.sum();
  balance.stored = b.held.sum();
  return report;
}

}  // namespace strata
