#include "sliding_blocks.hpp"

#include <cmath>
#include <limits>
#include <stdexcept>

namespace strata::reference {
namespace {

using Index = Eigen::Index;

// What happens at the interface, by point; sign 0 where it sticks, else that of the slip's increment.
struct State {
  Eigen::VectorXd q, slip, normal;
  Eigen::VectorXi sign;
};

// The state at pressure p after `before`.
State stepped(const CutBlocks::Influence& influence, const State& before, double friction, double compression,
              double p) {
  const Index n = influence.x.size();
  const Eigen::MatrixXd C = influence.slip.rightCols(n), T = influence.tension.rightCols(n);
  const Eigen::VectorXd free = p * influence.slip.col(0);
  const Eigen::VectorXd press = compression * influence.weights - p * influence.tension.col(0);  // n + T q
  const double scale = 1 / C.diagonal().cwiseAbs().maxCoeff();
  State state = before;
  for (int exchange = 0; exchange < 200; ++exchange) {
    Eigen::MatrixXd A(n, n);
    Eigen::VectorXd b(n);
    for (Index k = 0; k < n; ++k) {
      if (state.sign(k) == 0) {
        A.row(k) = scale * C.row(k);
        b(k) = scale * (before.slip(k) - free(k));
      } else {
        A.row(k) = -state.sign(k) * friction * T.row(k);
        A(k, k) += 1;
        b(k) = -state.sign(k) * friction * press(k);
      }
    }
    state.q = A.partialPivLu().solve(b);
    state.slip = free + C * state.q;
    state.normal = press - T * state.q;
    const double least = 1e-9 * free.cwiseAbs().maxCoeff();
    bool changed = false;
    for (Index k = 0; k < n; ++k) {
      int sign = state.sign(k);
      if (sign == 0 && std::abs(state.q(k)) > (1 + 1e-9) * friction * state.normal(k)) sign = state.q(k) > 0 ? -1 : 1;
      if (sign != 0 && sign * (state.slip(k) - before.slip(k)) < -least) sign = 0;
      changed = changed || sign != state.sign(k);
      state.sign(k) = sign;
    }
    if (changed) continue;
    if (state.normal.minCoeff() < 0) throw std::runtime_error("the interface opens: less pressure or more compression");
    return state;
  }
  throw std::runtime_error("no state of the sliding interface was found: take more steps");
}

}  // namespace

SlidingBlocks sliding_blocks(const CutBlock& block, double friction, double compression, double pressure, int steps,
                             int order) {
  if (!(friction > 0 && compression > 0 && pressure > 0 && steps > 0))
    throw std::invalid_argument("friction, compression, pressure and steps must be positive");
  if (!(block.fresh > 0)) throw std::invalid_argument("the fracture must have crossed the interface");
  CutBlock free = block;
  free.slipped = std::numeric_limits<double>::infinity(), free.shear_stiffness = 0;
  const CutBlocks::Influence influence = CutBlocks::influence(free, order);
  const Index n = influence.x.size();
  State state{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n), compression * influence.weights,
              Eigen::VectorXi::Zero(n)};
  SlidingBlocks result;
  double p_before = 0, volume = 0;
  for (int step = 1; step <= steps; ++step) {
    const double p = pressure * step / steps;
    const State next = stepped(influence, state, friction, compression, p);
    // Of the whole width. What slides does so at its bound from its first moment on.
    result.friction_work += friction * (next.normal + state.normal).dot((next.slip - state.slip).cwiseAbs());
    const double grown = p * influence.volume + 2 * influence.slip.col(0).dot(next.q);  // reciprocity
    result.work += 0.5 * (p + p_before) * (grown - volume);
    p_before = p, volume = grown;
    state = next;
    for (Index k = 0; k < n; ++k)
      if (state.sign(k) != 0) result.slid_to = std::max(result.slid_to, influence.x(k));
  }
  const CutBlocks at_end(free, order, state.q / pressure);
  result.stored = at_end.energy() * pressure * pressure;
  result.K_I = at_end.K_I() * pressure;
  result.mouth_opening = at_end.opening(0) * pressure;
  result.largest_slip = state.slip.cwiseAbs().maxCoeff();
  return result;
}

}  // namespace strata::reference
