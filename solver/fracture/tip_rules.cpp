#include "fracture/tip_rules.hpp"

#include <algorithm>

namespace strata {

namespace {

constexpr auto rings = static_cast<double>(ring_fractions.size());

// What the interaction with one of Williams' fields, in global axes, takes of a particle's displacement gradient:
//   [s_ij a_i,1 + s^a_ij u_i,1 - s^a : g e_j] Q_j = (C : sym(a_1 Q) + (s^a Q) e - (e . Q) s^a) : g,  Q = V grad q.
std::array<double, 4> interaction(const Elasticity& rock, const Frame& frame, const AuxiliaryFields& aux,
                                  const Vec2& Q) {
  const Vec2 &e = frame.e_1, &f = frame.e_2;
  const Vec2 a = aux.u_1.x() * e + aux.u_1.y() * f;
  const Vec2 local = frame.local(Q);
  const Vec2 on = aux.s.on(local).x() * e + aux.s.on(local).y() * f;  // s^a Q
  const auto turned = [&](Eigen::Index i, Eigen::Index j) {
    return aux.s.xx * e[i] * e[j] + aux.s.yy * f[i] * f[j] + aux.s.xy * (e[i] * f[j] + f[i] * e[j]);
  };
  const Stress own = stress_of(rock, a.x() * Q.x(), a.x() * Q.y(), a.y() * Q.x(), a.y() * Q.y());
  const double along = e.dot(Q);
  return {own.xx + on.x() * e.x() - along * turned(0, 0), own.xy + on.x() * e.y() - along * turned(0, 1),
          own.xy + on.y() * e.x() - along * turned(1, 0), own.yy + on.y() * e.y() - along * turned(1, 1)};
}

void add_particle(const Elasticity& rock, const Frame& frame, const Particles& p, std::size_t q, SideWord fracture_bit,
                  const std::array<Weight, ring_fractions.size()>& weights, TipRule& rule) {
  const Vec2 at = frame.local(Vec2{p.x[q], p.y[q]} - frame.tip);
  const double theta = angle_at(at, ((p.sides[q] & fracture_bit) != 0) == (frame.sign > 0.0));
  Vec2 mean = Vec2::Zero();
  for (std::size_t k = 0; k < weights.size(); ++k) {
    const Vec2 Q = p.V[q] * (weights[k].grad.x() * frame.e_1 + weights[k].grad.y() * frame.e_2);
    rule.V_q_x[k].push_back(Q.x()), rule.V_q_y[k].push_back(Q.y());
    mean += Q / rings;
  }
  for (std::size_t mode = 0; mode < 2; ++mode) {
    const auto c = interaction(rock, frame, williams(rock, static_cast<int>(mode), at.norm(), theta), mean);
    for (std::size_t k = 0; k < c.size(); ++k) rule.c[mode][k].push_back(c[k]);
  }
  rule.particle.push_back(q);
  rule.lambda.push_back(rock.lambda), rule.mu.push_back(rock.mu);
}

void add_bin(const std::vector<Elasticity>& rocks, const State& state, const Bin& bin, TipRule& rule) {
  std::array<NodalWeights, ring_fractions.size()> nodes;
  if (!weigh_bin(state.grid, rule.at, bin, nodes)) return;
  const Particles& p = state.particles;
  for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
       q += static_cast<std::size_t>(bin.stride)) {
    std::array<Weight, ring_fractions.size()> weights;
    bool flat = true;  // q is 1 all around, or 0
    for (std::size_t k = 0; k < weights.size(); ++k) {
      weights[k] = weight_at(state.grid, rule.at.frame, nodes[k], bin.i, bin.j, {p.x[q], p.y[q]});
      flat = flat && std::equal(nodes[k].begin() + 1, nodes[k].end(), nodes[k].begin());
    }
    if (!flat) add_particle(rocks[p.rock[q]], rule.at.frame, p, q, state.fracture().mask(), weights, rule);
  }
}

// The particles' part: J of each ring, and the means over them of both interactions.
struct DomainSums {
  std::array<double, ring_fractions.size()> J{};
  double I_1 = 0.0, I_2 = 0.0;
};

DomainSums domain_of(const TipRule& rule, const Particles& p) {
  const double e_x = rule.at.frame.e_1.x(), e_y = rule.at.frame.e_1.y();
  const auto &c_1 = rule.c[0], &c_2 = rule.c[1];
  double J_0 = 0.0, J_1 = 0.0, J_2 = 0.0, I_1 = 0.0, I_2 = 0.0;
  static_assert(ring_fractions.size() == 3);
#pragma omp simd reduction(+ : J_0, J_1, J_2, I_1, I_2)
  for (std::size_t k = 0; k < rule.particle.size(); ++k) {
    const std::size_t q = rule.particle[k];
    const double g_xx = p.g_xx[q], g_xy = p.g_xy[q], g_yx = p.g_yx[q], g_yy = p.g_yy[q];
    const double trace = rule.lambda[k] * (g_xx + g_yy), mu = rule.mu[k];
    const double s_xx = trace + 2.0 * mu * g_xx, s_yy = trace + 2.0 * mu * g_yy, s_xy = mu * (g_xy + g_yx);
    const double W = 0.5 * (s_xx * g_xx + s_yy * g_yy + s_xy * (g_xy + g_yx));
    const double u_x = g_xx * e_x + g_xy * e_y, u_y = g_yx * e_x + g_yy * e_y;
    const double flux_x = s_xx * u_x + s_xy * u_y - W * e_x, flux_y = s_xy * u_x + s_yy * u_y - W * e_y;
    J_0 += flux_x * rule.V_q_x[0][k] + flux_y * rule.V_q_y[0][k];
    J_1 += flux_x * rule.V_q_x[1][k] + flux_y * rule.V_q_y[1][k];
    J_2 += flux_x * rule.V_q_x[2][k] + flux_y * rule.V_q_y[2][k];
    I_1 += c_1[0][k] * g_xx + c_1[1][k] * g_xy + c_1[2][k] * g_yx + c_1[3][k] * g_yy;
    I_2 += c_2[0][k] * g_xx + c_2[1][k] * g_xy + c_2[2][k] * g_yx + c_2[3][k] * g_yy;
  }
  return {{J_0, J_1, J_2}, I_1, I_2};
}

}  // namespace

std::vector<TipRule> make_tip_rules(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state) {
  std::vector<TipRule> rules;
  for (const Tip& tip : state.tips) {
    TipRule& rule = rules.emplace_back();
    rule.at = tip_geometry(scene, rocks, state, tip);
    for (std::size_t k = 0; k < state.fracture().points.size(); ++k) {
      if (const auto place = face_place(state, rule.at, tip.at_back, k)) rule.faces.push_back(*place);
    }
    for (const Bin& bin : state.bins) add_bin(rocks, state, bin, rule);
  }
  return rules;
}

void measure_tips(const Scene& scene, const std::vector<TipRule>& rules, State& state) {
  for (std::size_t t = 0; t < rules.size(); ++t) {
    const TipRule& rule = rules[t];
    const DomainSums domain = domain_of(rule, state.particles);
    RingSums sums{};
    for (std::size_t k = 0; k < sums.size(); ++k) sums[k] = {domain.J[k], {domain.I_1, domain.I_2}};
    for (const FacePlace& place : rule.faces) add_face(state.fracture(), rule.at.frame, place, sums);
    finish_tip(scene, rule.at, state, sums, state.tips[t]);
  }
}

}  // namespace strata
