#include "explicit/total/held_reactions.hpp"

#include <Eigen/SparseCholesky>
#include <cmath>
#include <memory>
#include <vector>

#include "explicit/interface_laws.hpp"
#include "explicit/total/total_surfaces.hpp"

namespace strata {

namespace {

using Kind = InterfaceLaw::Kind;

// A component of a place's reaction that a stiffness holds: w . along + compliance r = rest.
struct Held {
  std::size_t place = 0;
  Vec2 along;               // normal or tangent
  double compliance = 0.0;  // 1/k or 1/D (m/Pa)
  double rest = 0.0;        // m
  const SurfacePoint* s = nullptr;
};

// Calls hold(along, stiffness, rest) for what holds a place: r = stiffness (rest - w . along).
template <class Hold>
void for_each_held(const TotalPlace& place, const SurfacePoint& s, const InterfaceLaw& law, double r_t_start,
                   Hold hold) {
  const Vec2 tangent = tangent_of(s.n);
  const double r_n = s.reaction.dot(s.n), r_t = s.reaction.dot(tangent), k = place.k;
  const auto close = [&] { hold(s.n, k, (s.closing_stress() - s.P) / k); };
  if (law.kind == Kind::soft) {
    const bool closed = law.compression == InterfaceLaw::Compression::contact && r_n > 0.0;
    if (closed) close();
    if (!closed && law.normal_stiffness_Pa_m > 0.0) hold(s.n, law.normal_stiffness_Pa_m, 0.0);
    if (law.shear_stiffness_Pa_m > 0.0) hold(tangent, law.shear_stiffness_Pa_m, 0.0);
    return;
  }
  if (!(r_n > 0.0)) return;
  close();
  const double bound = r_n * (law.kind == Kind::weak ? law.residual_friction : law.coefficient);
  constexpr double sticks = 1.0 - 1e-9;  // of the bound, at which sliding places stand but for round-off
  if (std::abs(r_t) < sticks * bound) hold(tangent, k, s.w.dot(tangent) + r_t_start / k);
}

std::vector<Held> find_held(const State& state, const TotalSurfaces& surfaces) {
  std::vector<Held> held;
  for (std::size_t k = 0; k < surfaces.places.size(); ++k) {
    const TotalPlace& place = surfaces.places[k];
    const SurfacePoint& s = point_of(state, place);
    for_each_held(place, s, surfaces.laws[place.law], surfaces.r_t_start[k],
                  [&](const Vec2& along, double stiffness, double rest) {
                    held.push_back({k, along, 1.0 / stiffness, rest, &s});
                  });
  }
  return held;
}

}  // namespace

// The factor of some components, which it was made for.
struct HeldFactor {
  std::vector<std::size_t> place;
  std::vector<Vec2> along;
  std::vector<double> compliance;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solve;

  bool is_for(const std::vector<Held>& held) const {
    if (place.size() != held.size()) return false;
    for (std::size_t a = 0; a < held.size(); ++a) {
      if (place[a] != held[a].place || along[a] != held[a].along || compliance[a] != held[a].compliance) return false;
    }
    return true;
  }
};

namespace {

std::shared_ptr<const HeldFactor> make_factor(const std::vector<Held>& held, double dt, const TotalSurfaces& surfaces) {
  auto factor = std::make_shared<HeldFactor>();
  std::vector<std::vector<int>> of_place(surfaces.places.size());
  for (std::size_t a = 0; a < held.size(); ++a) {
    factor->place.push_back(held[a].place), factor->along.push_back(held[a].along);
    factor->compliance.push_back(held[a].compliance);
    of_place[held[a].place].push_back(static_cast<int>(a));
  }
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t b = 0; b < held.size(); ++b) {
    const auto column = static_cast<int>(b);
    for (const TotalPlace::Neighbour& other : surfaces.places[held[b].place].neighbours) {
      const Vec2 moved = dt * Vec2{other.per_x * held[b].along.x(), other.per_y * held[b].along.y()};
      for (const int a : of_place[static_cast<std::size_t>(other.place)]) {
        const Held& row = held[static_cast<std::size_t>(a)];
        entries.emplace_back(a, column, row.s->A * row.along.dot(moved));
      }
    }
    entries.emplace_back(column, column, held[b].s->A * held[b].compliance);
  }
  const auto n = static_cast<Eigen::Index>(held.size());
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor->solve.compute(matrix);
  return factor;
}

// Gives what is held its reactions; false where the matrix is not positive but for round-off: sweeps do without.
bool solve(const std::vector<Held>& held, State& state, TotalSurfaces& surfaces) {
  if (!surfaces.held || !surfaces.held->is_for(held)) surfaces.held = make_factor(held, state.dt, surfaces);
  if (surfaces.held->solve.info() != Eigen::Success) return false;
  Eigen::VectorXd off(static_cast<Eigen::Index>(held.size()));
  for (std::size_t a = 0; a < held.size(); ++a) {
    const Held& h = held[a];
    const Vec2 w = h.s->w + state.dt * Vec2{surfaces.rate_x[h.place], surfaces.rate_y[h.place]};
    off[static_cast<Eigen::Index>(a)] = h.s->A * (h.rest - h.compliance * h.s->reaction.dot(h.along) - w.dot(h.along));
  }
  const Eigen::VectorXd change = surfaces.held->solve.solve(off);
  for (std::size_t a = 0; a < held.size(); ++a) {
    const TotalPlace& place = surfaces.places[held[a].place];
    add_reaction(place, change[static_cast<Eigen::Index>(a)] * held[a].along, point_of(state, place), surfaces);
  }
  return true;
}

// Brings back what is now beyond what a law allows: contact that pulls opens, friction beyond its bound slides. Returns
// whether any did.
bool let_go(const std::vector<Held>& held, State& state, TotalSurfaces& surfaces) {
  bool any = false;
  for (const Held& h : held) {
    const TotalPlace& place = surfaces.places[h.place];
    const InterfaceLaw& law = surfaces.laws[place.law];
    SurfacePoint& s = point_of(state, place);
    const Vec2 tangent = tangent_of(s.n);
    const Reaction now{s.reaction.dot(s.n), s.reaction.dot(tangent)};
    Reaction allowed = admissible(law, now);
    const bool parts = law.kind == Kind::soft && now.n < 0.0 && h.compliance == 1.0 / place.k;
    if (parts && law.normal_stiffness_Pa_m == 0.0) allowed.n = 0.0;  // else on to its spring
    const bool beyond = allowed.n != now.n || allowed.t != now.t;
    any = any || parts || beyond;
    if (beyond) add_reaction(place, allowed.n * s.n + allowed.t * tangent - s.reaction, s, surfaces);
  }
  return any;
}

}  // namespace

void solve_held_reactions(State& state, TotalSurfaces& surfaces) {
  constexpr int most_rounds = 8;  // bounds the work of a step: sweeps go on from what is then held
  for (int round = 0; round < most_rounds; ++round) {
    const std::vector<Held> held = find_held(state, surfaces);
    if (held.empty() || !solve(held, state, surfaces) || !let_go(held, state, surfaces)) return;
  }
}

}  // namespace strata
