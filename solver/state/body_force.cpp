#include "state/body_force.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/formula.hpp"

namespace strata {

namespace {

// The places where particles start (m): what has moved since is their displacement.
struct StartPlaces {
  std::vector<double> X, Y;
};

StartPlaces start_places(const Scene& scene, const Particles& p) {
  StartPlaces start{{p.x.begin(), p.x.end()}, {p.y.begin(), p.y.end()}};
  if (scene.numerics.keeps_places()) return start;
  for (std::size_t q = 0; q < p.size(); ++q) start.X[q] -= p.u_x[q], start.Y[q] -= p.u_y[q];
  return start;
}

std::vector<Vec2> evaluate(const char* key, const Formulas& formulas, const StartPlaces& start, const double* time) {
  const std::size_t n = start.X.size();
  const std::vector<double> t(time != nullptr ? n : 0, time != nullptr ? *time : 0.0);
  std::vector<FormulaVariable> variables{{"X", start.X}, {"Y", start.Y}};
  if (time != nullptr) variables.push_back({"t", t});
  std::vector<Vec2> out(n);
  for (std::size_t k = 0; k < formulas.size(); ++k) {
    const std::vector<double> values = evaluate_formula(formulas[k], variables);
    for (std::size_t q = 0; q < n; ++q) {
      out[q][static_cast<Eigen::Index>(k)] = values[q];
      if (std::isfinite(values[q])) continue;
      const std::string when = time != nullptr ? fmt::format(", t = {} s", *time) : "";
      throw NumericalFailure(
          fmt::format("{}[{}] = \"{}\" is {} at X = {} m, Y = {} m{}: give a formula that is finite in "
                      "the whole block",
                      key, k, formulas[k], values[q], start.X[q], start.Y[q], when));
    }
  }
  return out;
}

}  // namespace

void set_body_acceleration(const Scene& scene, double time, State& state) {
  if (!scene.body.acceleration_m_s2) return;
  state.body =
      evaluate("body.acceleration_m_s2", *scene.body.acceleration_m_s2, start_places(scene, state.particles), &time);
}

void set_initial_velocity(const Scene& scene, State& state) {
  if (!scene.initial.velocity_m_s && !scene.body.acceleration_m_s2) return;
  Particles& p = state.particles;
  std::vector<Vec2> v(p.size(), Vec2::Zero());
  if (scene.initial.velocity_m_s)
    v = evaluate("initial.velocity_m_s", *scene.initial.velocity_m_s, start_places(scene, p), nullptr);
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
