#include "quasistatic/body_load.hpp"

#include <fmt/format.h>

#include <cmath>

#include "state/body_force.hpp"

namespace strata {

namespace {

// Corners that stand in for edges that hold nothing would have to carry what a force pushes the whole block with.
void require_balance(const Scene& scene, const State& state) {
  constexpr double balanced = 1e-9;  // of the sum of sizes: round-off leaves 1e-12 of forces that cancel
  const Particles& p = state.particles;
  const Vec2 centre{0.5 * scene.domain.width_m, 0.5 * scene.domain.height_m};
  Vec2 sum = Vec2::Zero(), size = Vec2::Zero();
  double turn = 0.0, turns = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 f = p.m[q] * state.body[q], arm = Vec2{p.x[q], p.y[q]} - centre;
    sum += f, size += f.cwiseAbs();
    turn += cross(arm, f), turns += arm.norm() * f.norm();
  }
  const bool free_x = !scene.domain.holds_x(), free_y = !scene.domain.holds_y();
  const auto refuse = [](const char* what, double value, const char* unit, const char* advice) {
    throw NumericalFailure(
        fmt::format("the body force {} the whole block with {} {} per metre, and no edge holds it. Use "
                    "{}, or a force without resultant",
                    what, value, unit, advice));
  };
  if (free_x && std::abs(sum.x()) > balanced * size.x()) refuse("pushes", sum.x(), "N", "domain.sides = \"fixed\"");
  if (free_y && std::abs(sum.y()) > balanced * size.y())
    refuse("lifts", sum.y(), "N", "domain.bottom = \"symmetry\" or top = \"fixed\"");
  if (free_x && free_y && std::abs(turn) > balanced * turns) refuse("turns", turn, "N m", "domain.sides = \"fixed\"");
}

}  // namespace

void load_body(const Scene& scene, double time, const IntactBody& body, State& state, Condensed& condensed) {
  BodyLoad& load = condensed.load;
  if (!scene.body.acceleration_m_s2 || (!load.empty() && load.time == time)) return;
  set_body_acceleration(scene, time, state);
  require_balance(scene, state);
  const Particles& p = state.particles;
  load.time = time;
  load.intact = Eigen::VectorXd::Zero(body.unknowns());
  load.jumps = Eigen::VectorXd::Zero(condensed.size());
  for (const Bin& bin : state.bins) {
    for (const std::size_t q : bin) {
      const Gradients g = gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
      for (std::size_t n = 0; n < 9; ++n) {
        const int node = state.copies.node_of_record[static_cast<std::size_t>(bin.record[n])];
        for (int component = 0; component < 2; ++component) {
          const double f = g.N[n] * p.m[q] * state.body[q][component];
          const Unknown base = unknown_of(body.masters(), node, component);
          const Unknown jump = jump_unknown(condensed, bin.record[n], component);
          if (base.index >= 0) load.intact[base.index] += base.factor * f;
          if (jump.index >= 0) load.jumps[jump.index] += jump.factor * f;
        }
      }
    }
  }
  const Eigen::VectorXd u_0 = body.factor().solve(load.intact);
  for (std::size_t k = 0; k < condensed.columns.size(); ++k) {
    const SparseVector& G = condensed.columns[k]->G;
    for (std::size_t e = 0; e < G.index.size(); ++e)
      load.jumps[static_cast<Eigen::Index>(k)] -= G.value[e] * u_0[G.index[e]];
  }
  load.strain = 0.5 * load.intact.dot(u_0);
}

}  // namespace strata
