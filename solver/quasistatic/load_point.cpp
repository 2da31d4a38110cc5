#include "quasistatic/load_point.hpp"

#include <algorithm>
#include <tuple>

namespace strata {
namespace {

// What a state and a load point have both.
template <class AnyState>
auto load_of(AnyState& at) {
  return std::tie(at.time, at.fluid, at.reynolds, at.balance, at.surfaces, at.tips);
}

}  // namespace

LoadPoint load_point(const State& state) {
  LoadPoint point;
  load_of(point) = load_of(state);
  if (state.body.empty()) return point;
  const Particles& p = state.particles;
  point.u.resize(static_cast<std::size_t>(p.next_id), Vec2::Zero());
  point.body = point.u;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const auto id = static_cast<std::size_t>(p.id[q]);
    point.u[id] = {p.u_x[q], p.u_y[q]};
    point.body[id] = state.body[q];
  }
  return point;
}

void return_to(const LoadPoint& from, State& state) {
  load_of(state) = load_of(from);
}

double work_of_loads(const State& state, const LoadPoint& before, bool loaded, double& in_situ) {
  double fluid = 0.0;
  in_situ = 0.0;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const auto &now = state.surfaces[k].points, &then = before.surfaces[k].points;
    // The fracture may have become longer at its front; its older points stay where they were.
    const auto same =
        std::find_if(now.begin(), now.end(), [&](const SurfacePoint& s) { return s.x == then.front().x; });
    const auto shift = static_cast<std::size_t>(same - now.begin());
    for (std::size_t q = 0; q < now.size(); ++q) {
      const SurfacePoint& s = now[q];
      if (!s.split) continue;
      const bool is_new = q < shift || q - shift >= then.size();
      const SurfacePoint& old = is_new ? s : then[q - shift];
      const Vec2 dw = is_new || !old.split ? s.w : Vec2{s.w - old.w};
      const bool parts = loaded && (s.n.dot(s.reaction) > 0.0) != (s.n.dot(old.reaction) > 0.0);
      const bool counts = state.surfaces[k].kind == Surface::Kind::fracture && (parts || state.reynolds.size() > 0);
      const double held = counts ? s.n.dot(s.reaction + old.reaction) : 0.0;
      fluid += s.A * 0.5 * (s.P + old.P + held) * s.n.dot(dw);
      in_situ -= s.A * (0.5 * (s.in_situ + old.in_situ)).dot(dw);
    }
  }
  return fluid;
}

double work_of_body(const State& state, const LoadPoint& before) {
  const Particles& p = state.particles;
  double work = 0.0;
  for (std::size_t q = 0; q < state.body.size(); ++q) {
    const auto id = static_cast<std::size_t>(p.id[q]);
    work += p.m[q] * 0.5 * (before.body[id] + state.body[q]).dot(Vec2{p.u_x[q], p.u_y[q]} - before.u[id]);
  }
  return work;
}

}  // namespace strata
