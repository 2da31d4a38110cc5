#include "state/body_force.hpp"

#include <fmt/format.h>

#include <cmath>

#include "scene/formula.hpp"

namespace strata {
namespace {

// Formulas of the places where particles start, from which what has moved since is their displacement.
std::vector<Vec2> evaluate(const char* key, const Formulas& formulas, const Scene& scene, const Particles& p,
                           const double* time) {
  const std::size_t n = p.size();
  std::vector<double> X(p.x.begin(), p.x.end()), Y(p.y.begin(), p.y.end());
  for (std::size_t q = 0; q < n && !scene.numerics.keeps_places(); ++q) X[q] -= p.u_x[q], Y[q] -= p.u_y[q];
  const std::vector<double> t(time != nullptr ? n : 0, time != nullptr ? *time : 0.0);
  std::vector<FormulaVariable> variables{{"X", X}, {"Y", Y}};
  if (time != nullptr) variables.push_back({"t", t});
  std::vector<Vec2> out(n);
  for (std::size_t k = 0; k < formulas.size(); ++k) {
    const std::vector<double> values = evaluate_formula(formulas[k], variables);
    for (std::size_t q = 0; q < n; ++q) {
      out[q][static_cast<Eigen::Index>(k)] = values[q];
      if (std::isfinite(values[q])) continue;
      throw NumericalFailure(fmt::format(
          "{}[{}] = \"{}\" is {} at X = {} m, Y = {} m{}: give a formula that is finite in the whole block", key, k,
          formulas[k], values[q], X[q], Y[q], time != nullptr ? fmt::format(", t = {} s", *time) : ""));
    }
  }
  return out;
}

}  // namespace

void set_body_acceleration(const Scene& scene, double time, State& state) {
  if (!scene.body.acceleration_m_s2) return;
  state.body = evaluate("body.acceleration_m_s2", *scene.body.acceleration_m_s2, scene, state.particles, &time);
}

void set_initial_velocity(const Scene& scene, State& state) {
  if (!scene.initial.velocity_m_s && !scene.body.acceleration_m_s2) return;
  Particles& p = state.particles;
  std::vector<Vec2> v(p.size(), Vec2::Zero());
  if (scene.initial.velocity_m_s) v = evaluate("initial.velocity_m_s", *scene.initial.velocity_m_s, scene, p, nullptr);
  set_body_acceleration(scene, 0.0, state);
  for (std::size_t q = 0; q < state.body.size(); ++q) v[q] -= 0.5 * state.dt * state.body[q];
  Ledger& ledger = state.ledger;
  for (std::size_t q = 0; q < p.size(); ++q) {
    p.v_x[q] = v[q].x(), p.v_y[q] = v[q].y();
    ledger.kinetic += 0.5 * p.m[q] * v[q].squaredNorm();
  }
  ledger.initial_kinetic = ledger.largest = ledger.kinetic;
}

}  // namespace strata
