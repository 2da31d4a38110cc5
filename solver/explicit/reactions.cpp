#include "explicit/reactions.hpp"

#include <fmt/format.h>
#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "interfaces/surface_law.hpp"

namespace strata {

// A component of a place's reaction that a stiffness holds: w . along + compliance r = rest.
struct Held {
  std::size_t place = 0;
  Vec2 along;               // normal or tangent
  double compliance = 0.0;  // 1/k or 1/D (m/Pa)
  double rest = 0.0;        // m
};

// The factor of some components, which it was made for.
struct HeldFactor {
  std::vector<Held> of;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solve;

  bool is_for(const std::vector<Held>& held) const {
    return std::ranges::equal(of, held, [](const Held& a, const Held& b) {
      return a.place == b.place && a.along == b.along && a.compliance == b.compliance;
    });
  }
};

namespace {

using Laws = std::vector<LawLines>;  // of the places in a step

// Places share nodes with about six neighbours, so plain Gauss-Seidel (1) is slow: 327 sweeps a step in Experiment 1
// soft, to a tolerance of 1e-9, where 1.5 with today's tolerance takes 52. 1.5 was not tuned further.
constexpr double over_relaxation = 1.5;

constexpr std::size_t none = SIZE_MAX;

// Adds the weight N of a record in the jump of a place.
void weigh(int record, double N, const SpreadArray& mass, SplitPlace& place, State& state) {
  SplitPlaces& split = state.split;
  const auto r = static_cast<std::size_t>(record);
  const Master& master = state.masters[r];
  const auto at = static_cast<std::size_t>(master.record);
  std::size_t& node = split.node_at[at];
  if (node == none) node = split.nodes.size(), split.nodes.push_back({at, mass[at]});
  auto entry = std::ranges::find(place.entries, node, &SplitPlace::Entry::node);
  if (entry == place.entries.end()) entry = place.entries.insert(entry, {node});
  entry->c += N * Vec2{master.x, master.y};
}

// What a traction at the place, whose point is s, does to its nodes and its own jump.
void find_answers(const SurfacePoint& s, const State& state, SplitPlace& place) {
  Vec2 a = Vec2::Zero();
  for (SplitPlace::Entry& e : place.entries) {
    const double per_mass = state.dt * s.A / state.split.nodes[e.node].m;
    e.d = per_mass * e.c;
    a += (state.dt * per_mass * e.c).cwiseProduct(e.c);
  }
  place.per_n = s.n.x() * s.n.x() * a.x() + s.n.y() * s.n.y() * a.y();
  place.per_t = s.n.y() * s.n.y() * a.x() + s.n.x() * s.n.x() * a.y();
}

// The point of a surface, or the spring of a tip, that a place is.
template <class AnyState>
auto& point_of(AnyState& state, const SplitPlace& place) {
  return place.surface < 0 ? state.ties[place.point].s
                           : state.surfaces[static_cast<std::size_t>(place.surface)].points[place.point];
}

// What a traction at each place does to the jump rates of those that share nodes with it.
void find_neighbours(SplitPlaces& split) {
  std::vector<std::vector<std::pair<std::size_t, Vec2>>> of_node(split.nodes.size());  // places, and their c
  for (std::size_t k = 0; k < split.places.size(); ++k) {
    for (const SplitPlace::Entry& e : split.places[k].entries) of_node[e.node].emplace_back(k, e.c);
  }
  std::vector<std::size_t> at(split.places.size(), none);
  for (SplitPlace& place : split.places) {
    for (const SplitPlace::Entry& e : place.entries) {
      for (const auto& [other, c] : of_node[e.node]) {
        if (at[other] == none) at[other] = place.neighbours.size(), place.neighbours.push_back({other});
        place.neighbours[at[other]].per += c.cwiseProduct(e.d);
      }
    }
    for (const SplitPlace::Neighbour& neighbour : place.neighbours) at[neighbour.place] = none;
  }
}

// Rate of a place's jump (m/s).
Vec2 rate_by_nodes(const SplitPlace& place, const State& state) {
  Vec2 rate = Vec2::Zero();
  for (const SplitPlace::Entry& e : place.entries) rate += e.c.cwiseProduct(state.split.nodes[e.node].v);
  return rate;
}

// The same within a step's sweeps: what stays for many steps knows what each place does to its neighbours.
Vec2 jump_rate(const SplitPlace& place, const State& state) {
  return place.neighbours.empty() ? rate_by_nodes(place, state) : place.rate;
}

// What a traction (Pa, on the + face) at a place gives its nodes in a step.
void push(const SplitPlace& place, const Vec2& traction, State& state) {
  for (const SplitPlace::Entry& e : place.entries) {
    const Vec2 dv = e.d.cwiseProduct(traction);
    state.split.nodes[e.node].v += dv, state.split.nodes[e.node].dv += dv;
  }
}

// Adds `change` (Pa, on the + face) to the reaction of a place.
void add_reaction(const SplitPlace& place, const Vec2& change, State& state) {
  for (const SplitPlace::Neighbour& other : place.neighbours)
    state.split.places[other.place].rate += other.per.cwiseProduct(change);
  if (place.neighbours.empty()) push(place, change, state);
  point_of(state, place).reaction += change;
}

// --- what stiffnesses hold, solved together

std::vector<Held> find_held(const Laws& laws, const State& state) {
  std::vector<Held> held;
  for (std::size_t p = 0; p < laws.size(); ++p) {
    const auto hold = [&](const LawLine& line, const Vec2& along) {
      if (line.D > 0.0) held.push_back({p, along, 1.0 / line.D, line.w_0 + line.r_0 / line.D});
    };
    const LawLines& law = laws[p];
    const SurfacePoint& s = point_of(state, state.split.places[p]);
    const Vec2 tangent = tangent_of(s.n);
    const double r_n = s.reaction.dot(s.n);
    hold(law.holding(r_n), s.n);
    constexpr double sticks = 1.0 - 1e-9;  // of the bound, at which sliding places stand but for round-off
    if (std::abs(s.reaction.dot(tangent)) < sticks * law.bound(r_n)) hold(law.shear, tangent);
  }
  return held;
}

std::shared_ptr<const HeldFactor> make_factor(const std::vector<Held>& held, const State& state) {
  const std::vector<SplitPlace>& places = state.split.places;
  auto factor = std::make_shared<HeldFactor>();
  factor->of = held;
  std::vector<std::vector<int>> of_place(places.size());
  for (std::size_t a = 0; a < held.size(); ++a) of_place[held[a].place].push_back(static_cast<int>(a));
  std::vector<Eigen::Triplet<double>> entries;
  for (std::size_t b = 0; b < held.size(); ++b) {
    const auto column = static_cast<int>(b);
    for (const SplitPlace::Neighbour& other : places[held[b].place].neighbours) {
      const Vec2 moved = state.dt * point_of(state, places[other.place]).A * other.per.cwiseProduct(held[b].along);
      for (const int a : of_place[other.place])
        entries.emplace_back(a, column, held[static_cast<std::size_t>(a)].along.dot(moved));
    }
    entries.emplace_back(column, column, point_of(state, places[held[b].place]).A * held[b].compliance);
  }
  const auto n = static_cast<Eigen::Index>(held.size());
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  factor->solve.compute(matrix);
  return factor;
}

// Gives what is held its reactions; false where the matrix is not positive but for round-off: sweeps do without.
bool solve(const std::vector<Held>& held, State& state) {
  SplitPlaces& split = state.split;
  if (!split.held || !split.held->is_for(held)) split.held = make_factor(held, state);
  if (split.held->solve.info() != Eigen::Success) return false;
  Eigen::VectorXd off(static_cast<Eigen::Index>(held.size()));
  for (std::size_t a = 0; a < held.size(); ++a) {
    const Held& h = held[a];
    const SplitPlace& place = split.places[h.place];
    const SurfacePoint& s = point_of(std::as_const(state), place);
    const Vec2 w = s.w + state.dt * jump_rate(place, state);
    off[static_cast<Eigen::Index>(a)] = s.A * (h.rest - h.compliance * s.reaction.dot(h.along) - w.dot(h.along));
  }
  const Eigen::VectorXd change = split.held->solve.solve(off);
  for (std::size_t a = 0; a < held.size(); ++a)
    add_reaction(split.places[held[a].place], change[static_cast<Eigen::Index>(a)] * held[a].along, state);
  return true;
}

// Brings back what is now beyond what a law allows: contact that pulls opens, friction beyond its bound slides. Returns
// whether any did.
bool release_inadmissible(const std::vector<Held>& held, const Laws& laws, State& state) {
  bool any = false;
  for (const Held& h : held) {
    const SplitPlace& place = state.split.places[h.place];
    const LawLines& law = laws[h.place];
    const SurfacePoint& s = point_of(std::as_const(state), place);
    const Vec2 tangent = tangent_of(s.n);
    const Reaction now{s.reaction.dot(s.n), s.reaction.dot(tangent)}, allowed = law.admissible(now);
    const bool parts = now.n < 0.0 && h.compliance == 1.0 / law.contact.D;  // on to what else the law has
    const bool beyond = allowed.n != now.n || allowed.t != now.t;
    any = any || parts || beyond;
    if (beyond) add_reaction(place, allowed.n * s.n + allowed.t * tangent - s.reaction, state);
  }
  return any;
}

// Brings a step's sweeps near their end: places stay closed, open, stuck or sliding as their reactions r say, and
// those that are held by a stiffness k (contact, stick) or D (springs) get the reactions that solve, with w the jump
// at the step's end, linear in all reactions of the step,
//   w + r/k = rest of the law
// along the normal, the tangent or both. Places that then pull or are beyond friction's bound open or slide, and the
// rest is solved again (an active set that only shrinks, Nocedal & Wright 2006, 16.5; 8 times at most). Sweeps from
// here find out where a place closes or sticks again. (A D M^-1 D^T + A/k, small, banded and positive definite, is
// factored anew only where a place changes.)
void solve_held_reactions(const Laws& laws, State& state) {
  constexpr int most_rounds = 8;  // bounds the work of a step: sweeps go on from what is then held
  for (int round = 0; round < most_rounds; ++round) {
    const std::vector<Held> held = find_held(laws, state);
    if (held.empty() || !solve(held, state) || !release_inadmissible(held, laws, state)) return;
  }
}

// --- sweeps

// One visit of successive over-relaxation: past the law's reaction given all others, but never out of what the law
// allows; returns how much the reaction changed (Pa).
double relax(const SplitPlace& place, const LawLines& law, State& state) {
  const SurfacePoint& s = point_of(std::as_const(state), place);
  const Vec2 tangent = tangent_of(s.n), w = s.w + state.dt * jump_rate(place, state);
  const Reaction now{s.reaction.dot(s.n), s.reaction.dot(tangent)};
  const Reaction r = law.at_end_of_step(
      {w.dot(s.n) - place.per_n * now.n, w.dot(tangent) - place.per_t * now.t, place.per_n, place.per_t});
  const Reaction next =
      law.admissible({now.n + over_relaxation * (r.n - now.n), now.t + over_relaxation * (r.t - now.t)});
  if (next.n == now.n && next.t == now.t) return 0.0;
  const Vec2 change = next.n * s.n + next.t * tangent - s.reaction;
  add_reaction(place, change, state);
  return change.norm();
}

// stays: places are those of the last step, so that a factor of what they hold serves many steps.
void find_reactions(bool stays, const Laws& laws, State& state) {
  // With fewer, what the tolerance leaves keeps nodes trembling: a bar on a stiff spring came to rest at a kinetic
  // energy of 3e-17 J instead of 7e-33 J.
  const int least_sweeps = stays ? 4 : 1;
  // What holds is solved again after some sweeps: solved once, 96 steps of Experiment 6 soft and 2895 of friction run
  // out of sweeps, so 0 and 441. Places that open and close in turn are left to the sweeps in the end.
  constexpr int solved_every = 8, solved_until = 64;
  const std::vector<SplitPlace>& places = state.split.places;
  if (places.empty()) return;
  int sweeps = 0;
  const auto goes_on = [&](double change, double largest) {
    if (sweeps < least_sweeps) return change > 0.0;
    return sweeps < most_sweeps && change > reaction_tolerance * std::max(largest, 1.0);
  };
  double change = 1.0, largest = 0.0;
  for (; goes_on(change, largest); ++sweeps) {
    if (stays && sweeps % solved_every == 0 && sweeps <= solved_until) solve_held_reactions(laws, state);
    change = largest = 0.0;
    for (std::size_t k = 0; k < laws.size(); ++k) {
      change = std::max(change, relax(places[k], laws[k], state));
      largest = std::max(largest, point_of(state, places[k]).reaction.norm());
    }
  }
  note_sweeps(sweeps, change, largest, state.monitors);
  require_settled(sweeps, change, largest, state);
}

// The place's jump changes by dw (m) under its reaction: slip (m), work, and the monitored penetration and pressure.
void add_jump(const InterfaceLaw& law, const Vec2& dw, SurfacePoint& s, State& state) {
  const double before = spring_energy_at(law, s);
  s.w += dw;
  remember(law, s.opening(), dw.dot(tangent_of(s.n)), s.memory);
  const double stored = spring_energy_at(law, s) - before;
  state.ledger.friction -= s.A * s.reaction.dot(dw) + stored;
  state.ledger.fluid_work += s.A * s.P * s.n.dot(dw);
  state.ledger.in_situ_work -= s.A * s.in_situ.dot(dw);
  if (law.takes_all_compression()) return;
  note_largest(state.monitors.largest_penetration, -s.opening());
  note_largest(state.monitors.largest_contact_Pa, s.reaction.dot(s.n));
}

// Reactions and jumps of the step from the velocities without what places exert, which net tractions join under
// kinematics = "total".
void find_motion(bool total, State& state) {
  std::vector<SplitPlace>& places = state.split.places;
  thread_local Laws laws;  // keeps its memory: steps allocate nothing
  laws.clear();
  for (SplitPlace& place : places) {
    const SurfacePoint& s = point_of(std::as_const(state), place);
    laws.push_back(lines_of(state.split.laws[place.law], place.k, start_of(s), s.closing_stress() - s.P));
    place.r_start = s.reaction;
    push(place, total ? Vec2{s.P * s.n - s.in_situ + s.reaction} : s.reaction, state);
  }
  for (SplitPlace& place : places) place.rate = rate_by_nodes(place, state);
  find_reactions(total, laws, state);
  for (const SplitPlace& place : places) {
    if (total) push(place, point_of(state, place).reaction - place.r_start, state);
  }
  for (const SplitPlace& place : places) {
    const Vec2 dw = state.dt * rate_by_nodes(place, state);
    add_jump(state.split.laws[place.law], dw, point_of(state, place), state);
  }
}

}  // namespace

void find_split_places(const Scene& scene, const Rocks& rocks, State& state) {
  SplitPlaces& out = state.split;
  const SpreadArray& mass = state.total.op ? state.total.m : state.sums.m;
  for (const SplitNode& node : out.nodes) out.node_at[node.at] = none;  // of which there are few
  out.node_at.resize(mass.size(), none);
  out.nodes.clear();
  out.laws = scene.laws;
  out.laws.push_back(face_law(scene));
  out.held.reset();
  std::size_t found = 0;  // places keep the memory of the last ones
  const auto add = [&](int surface, std::size_t point, std::size_t law, double k, const SurfaceStencil& at) {
    if (found == out.places.size()) out.places.emplace_back();
    SplitPlace& place = out.places[found];
    place.surface = surface, place.point = point, place.law = law, place.k = k;
    place.entries.clear(), place.neighbours.clear();
    for (std::size_t n = 0; n < 9; ++n) {
      if (at.plus[n] == at.minus[n]) continue;
      weigh(at.plus[n], at.N[n], mass, place, state), weigh(at.minus[n], -at.N[n], mass, place, state);
    }
    const auto massless = [&](const SplitPlace::Entry& e) { return !(out.nodes[e.node].m > 0.0); };
    if (place.entries.empty() || std::ranges::any_of(place.entries, massless)) return;
    find_answers(point_of(std::as_const(state), place), state, place);
    ++found;
  };
  for (std::size_t k = 0; k < state.ties.size(); ++k) {
    SurfaceStencil pair;  // one node's two copies
    pair.plus[0] = state.ties[k].plus, pair.minus[0] = state.ties[k].minus, pair.N[0] = 1.0;
    out.laws.push_back(tie_law(state.ties[k]));
    add(-1, k, out.laws.size() - 1, 0.0, pair);
  }
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const Surface& surface = state.surfaces[k];
    const std::size_t law = surface.kind == Surface::Kind::fracture ? scene.laws.size() : surface.law;
    const double stiffness = contact_stiffness(out.laws[law], rocks, state.grid);
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      if (surface.points[q].split) add(static_cast<int>(k), q, law, stiffness, state.point_stencils[k][q]);
    }
  }
  out.places.resize(found);
  if (state.total.op) find_neighbours(out);
}

void solve_reactions(const Scene& scene, const Rocks& rocks, State& state) {
  find_split_places(scene, rocks, state);
  NodalMotion& motion = state.motion;
  for (SplitNode& n : state.split.nodes)
    n.v = {motion.v_x[n.at], motion.v_y[n.at]}, n.dv = {motion.dv_x[n.at], motion.dv_y[n.at]};
  find_motion(false, state);
  for (const SplitNode& n : state.split.nodes) motion[n.at] = NodeMotion{n.v.x(), n.v.y(), n.dv.x(), n.dv.y()};
}

double push_split_places(double keep, State& state) {
  TotalMotion& t = state.total;
  for (SplitNode& n : state.split.nodes) {
    n.v = {keep * t.v_x[n.at] + state.dt * t.a_x[n.at], keep * t.v_y[n.at] + state.dt * t.a_y[n.at]};
    n.dv.setZero();
  }
  find_motion(true, state);
  double power = 0.0;
  for (const SplitNode& n : state.split.nodes) {
    const Vec2 a = n.dv / state.dt;
    t.a_x[n.at] += a.x(), t.a_y[n.at] += a.y();
    power += n.m * n.v.dot(a);
  }
  return power;
}

void note_sweeps(int sweeps, double change, double largest, Monitors& monitors) {
  monitors.contact_sweeps += sweeps;
  if (sweeps < most_sweeps) return;
  ++monitors.contact_unconverged;
  note_largest(monitors.contact_left, change / std::max(largest, 1.0));
}

void require_settled(int sweeps, double change, double largest, const State& state) {
  if (sweeps < most_sweeps) return;
  double traction = std::max(largest, 1.0);
  for (const Surface& surface : state.surfaces) {
    for (const SurfacePoint& s : surface.points) {
      if (s.split) traction = std::max({traction, std::abs(s.P), s.in_situ.norm()});
    }
  }
  if (change <= most_left * traction) return;
  throw NumericalFailure(
      fmt::format("step {}: contact, friction and springs were not solved: after {} sweeps a reaction still changed by "
                  "{:.3g} Pa, the largest traction being {:.3g} Pa. Use a smaller coefficient of friction",
                  state.step, sweeps, change, traction));
}

}  // namespace strata
