#include "quasistatic/contact_equilibrium.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "quasistatic/falling_cohesion.hpp"

namespace strata {
namespace {

void add_to_row(SparseRow& row, const Unknown& unknown, double weight) {
  if (unknown.index < 0) return;
  for (auto& [index, value] : row) {
    if (index != unknown.index) continue;
    value += weight * unknown.factor;
    return;
  }
  row.emplace_back(unknown.index, weight * unknown.factor);
}

double times(const SparseRow& row, const Eigen::VectorXd& j) {
  double sum = 0.0;
  for (const auto& [index, value] : row) sum += value * j[index];
  return sum;
}

// D j of a place (m).
Vec2 jump_of(const ContactPlace& place, const Eigen::VectorXd& j) {
  return {times(place.D[0], j), times(place.D[1], j)};
}

LawLines lines_at(const State& state, const ContactPlace& place) {
  return lines_of(place.law, place.k, place.start, place.in_situ.dot(place.n) - point_of(state, place).P);
}

LawAnswer answer_at(const State& state, const ContactPlace& place, const Vec2& w) {
  return lines_at(state, place).at(w.dot(place.n), w.dot(place.t()), place.bound);
}

void add_force(const ContactPlace& place, const Vec2& traction, Eigen::VectorXd& f) {
  for (std::size_t c = 0; c < 2; ++c) {
    for (const auto& [index, value] : place.D[c]) f[index] += place.A * value * traction[static_cast<Eigen::Index>(c)];
  }
}

Vec2 net_load(const State& state, const ContactPlace& place) {
  return point_of(state, place).P * place.n - place.in_situ;
}

// The body force's share of the loads on the jumps.
Eigen::VectorXd body_load(const Condensed& condensed) {
  return condensed.load.empty() ? Eigen::VectorXd::Zero(condensed.size()) : condensed.load.jumps;
}

// Jumps and what the laws answer to them; returns their share of the energy less the work of the loads (J/m).
double answer(const State& state, const Places& places, Equilibrium& at) {
  at.answers.resize(places.size());
  at.w.resize(places.size());
  at.pieces.resize(places.size());
  double energy = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    at.w[k] = jump_of(place, at.j) - place.bonded;
    const LawAnswer& r = at.answers[k] = answer_at(state, place, at.w[k]);
    at.pieces[k] = r.piece;
    energy += place.A * (r.energy - net_load(state, place).dot(at.w[k]));
  }
  return energy;
}

void evaluate(const State& state, const Condensed& condensed, const Places& places, Equilibrium& at) {
  const double of_laws = answer(state, places, at);
  Eigen::VectorXd load = body_load(condensed), reaction = Eigen::VectorXd::Zero(condensed.size());
  at.energy =
      -load.dot(at.j) - 2.0 * condensed.load.strain;  // strain of the intact block under the body force, less its work
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    const LawAnswer& r = at.answers[k];
    add_force(place, net_load(state, place), load);
    add_force(place, place.along(r.n, r.t), reaction);
  }
  const Eigen::VectorXd inner = condensed.S.selfadjointView<Eigen::Lower>() * at.j;
  at.strain = 0.5 * at.j.dot(inner) + condensed.load.strain;
  at.energy += of_laws + at.strain;
  const double scale = std::max(load.lpNorm<Eigen::Infinity>(), inner.lpNorm<Eigen::Infinity>());
  at.unbalanced = load + reaction - inner;
  at.residual = scale > 0.0 ? at.unbalanced.lpNorm<Eigen::Infinity>() / scale : 0.0;
}

// Whether the forces are in balance: to 1e-9 of the load, or to the round-off of S j where a soft spring lets parts
// move so far as bodies that the products of S cancel. A load on a motion that only the stiffening of factor_tangent()
// holds is out of balance by far more than that: j is 1e9 loads over S, and their round-off 1e-5 of the load.
bool in_balance(const Condensed& condensed, const Equilibrium& at) {
  constexpr double of_load = 1e-9, of_products = 64.0 * std::numeric_limits<double>::epsilon();
  if (at.residual <= of_load) return true;
  const double products = (condensed.S.cwiseAbs() * at.j.cwiseAbs()).lpNorm<Eigen::Infinity>();
  return at.residual < 1e-4 && at.unbalanced.lpNorm<Eigen::Infinity>() <= of_products * products;
}

// The solution as if all places stayed on the pieces that `answers` describe.
Eigen::VectorXd solve_on_pieces(const State& state, const Condensed& condensed, const Places& places,
                                const Answers& answers, const TangentFactor& factor) {
  Eigen::VectorXd f = body_load(condensed);
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    const LawAnswer& r = answers[k];
    add_force(place,
              net_load(state, place) + r.n_0 * place.n + r.t_0 * place.t() - tangent_matrix(place, r) * place.bonded,
              f);
  }
  return factor.solve(f);
}

bool slips(const Answers& answers) {
  return std::any_of(answers.begin(), answers.end(), [](const LawAnswer& r) { return r.dt_dn != 0.0; });
}

[[noreturn]] void report_mechanism(const State& state, const Places& places) {
  int interfaces = 0;
  for (const Surface& surface : state.surfaces) interfaces += surface.kind == Surface::Kind::interface ? 1 : 0;
  throw NumericalFailure(
      "the block has become a mechanism: parts that its surfaces cut off move freely, since nothing on " +
      std::to_string(places.size()) + " split places (of a fracture and " + std::to_string(interfaces) +
      " interfaces) and on the edges holds them. Use domain.sides = \"fixed\", friction, or a stiffer interface; where "
      "a fracture turns sharply or runs into an edge, smaller cells or an earlier stop");
}

// How many unknowns take part in the softest motion of a tangent whose factor is at hand (inverse iteration).
int unknowns_that_move(const TangentFactor& factor, Eigen::Index n) {
  constexpr double takes_part = 0.05;  // of the largest
  Eigen::VectorXd v = Eigen::VectorXd::LinSpaced(n, 1.0, 2.0);
  // In unknowns scaled to a unit diagonal: factor.solve() undoes the scaling.
  for (int k = 0; k < 6; ++k) {
    const Eigen::VectorXd x = factor.solve(v.cwiseQuotient(factor.scale()));
    v = x.cwiseQuotient(factor.scale()).normalized();
  }
  return static_cast<int>((v.array().abs() > takes_part * v.lpNorm<Eigen::Infinity>()).count());
}

// Factors the tangent at `at` unless `factor` has it already; false where parts of the block move freely. On the way to
// a solution they may for a while, so the factor is then that of a tangent slightly stiffer. A sliver of rock with
// fewer particles than its copies of nodes have unknowns (between a fracture and an interface that it meets, or in a
// sharp turn) has motions without strain, too; no load drives them, and the same stiffening holds them.
bool factor_tangent(const Condensed& condensed, const Places& places, const Answers& answers, const State& state,
                    TangentFactor& factor) {
  constexpr double stiffening = 1e-9;
  constexpr double on_the_way = 1e-6;  // parts that come to rest later: a step that does not leave all sight of it
  constexpr int sliver =
      24;  // unknowns: fewer than the copies of 3 x 3 nodes have with one jump each, and some to spare
  const Pieces pieces = pieces_of(answers);
  const bool holds = factor.holds(condensed.size());
  if (holds && factor.pieces == pieces) return true;
  factor.pieces = pieces;
  if (holds && factor.follow(places, answers)) return true;
  // The coupling of tangential and normal reactions of few sliding places costs less as a change of a symmetric tangent
  // than in a factorisation that is not symmetric: that takes n^3/3 more, a change 2 n^2, which is n/6 of them; an
  // eighth leaves some for what changes later.
  Answers first = answers;
  Eigen::Index sliding = 0;
  for (LawAnswer& r : first) sliding += std::exchange(r.dt_dn, 0.0) != 0.0 ? 1 : 0;
  if (sliding > 0 && 8 * sliding < condensed.size()) {
    if (factor.factorise(tangent(condensed.S, places, first), places, first) && factor.follow(places, answers))
      return true;
  }
  Eigen::MatrixXd T = tangent(condensed.S, places, answers);
  if (factor.factorise(T, places, answers)) return true;
  T.diagonal() *= 1.0 + stiffening;
  if (!factor.factorise(T, places, answers, true)) report_mechanism(state, places);
  if (unknowns_that_move(factor, condensed.size()) <= sliver) return true;
  T.diagonal() *= 1.0 + on_the_way;
  factor.factorise(T, places, answers, true);
  factor.pieces.clear();
  return false;
}

// Force out of balance over the load that counts as none: places on the border of two pieces may change by round-off
// for ever.
constexpr double least_unbalanced = 1e-9;

// Slope (J/m) along a step of what the laws hold less the work of the loads on surfaces: at the jumps w (m) of places,
// which change by dw (m) along it.
double slope(const State& state, const Places& places, const std::vector<Vec2>& w, const std::vector<Vec2>& dw,
             double length) {
  double sum = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    const LawAnswer r = answer_at(state, place, w[k] + length * dw[k]);
    const Vec2 traction = net_load(state, place) + r.n * place.n + r.t * place.t();
    sum -= place.A * traction.dot(dw[k]);
  }
  return sum;
}

// Newton's step shortened to the minimum of the energy along it, where its slope, which only rises, is 0. The whole
// step where the slope there is still down, or next to nothing.
double step_length(const State& state, const Condensed& condensed, const Places& places, const Equilibrium& from,
                   const Eigen::VectorXd& to) {
  constexpr double flat = 1e-3;  // of the slope at the start
  const Eigen::VectorXd d = to - from.j, S_d = condensed.S.selfadjointView<Eigen::Lower>() * d;
  const double at_start = from.j.dot(S_d) - body_load(condensed).dot(d), rise = d.dot(S_d);
  std::vector<Vec2> dw(places.size());
  for (std::size_t k = 0; k < places.size(); ++k) dw[k] = jump_of(places[k], d);
  const auto slope_at = [&](double length) {
    return at_start + length * rise + slope(state, places, from.w, dw, length);
  };
  const double first = slope_at(0.0);
  if (slope_at(1.0) <= flat * std::abs(first)) return 1.0;
  double low = 0.0, high = 1.0;
  for (int halving = 0; halving < 120 && high - low > 1e-9 * high; ++halving) {
    const double middle = 0.5 * (low + high);
    (slope_at(middle) <= 0.0 ? low : high) = middle;
  }
  return high;
}

// Whether what is out of balance of the solution on `pieces` is what a factor that followed changes lost of the digits:
// corrections by it then bring them back. Leaves `at` as it was where they do not.
bool refine(const State& state, const Condensed& condensed, const Places& places, const TangentFactor& factor,
            const Pieces& pieces, Equilibrium& at) {
  constexpr int corrections = 2;
  Equilibrium better = at;
  for (int k = 0; k < corrections && better.pieces == pieces; ++k) {
    better.j += factor.solve(better.unbalanced);
    evaluate(state, condensed, places, better);
    if (better.pieces != pieces || !in_balance(condensed, better)) continue;
    at = std::move(better);
    return true;
  }
  return false;
}

// Newton's method on the pieces from at.j; false where it does not end within its iterations. bounds_held: the problem
// is convex and any state in balance its solution.
bool iterate(const State& state, const Condensed& condensed, const Places& places, TangentFactor& factor,
             bool bounds_held, Equilibrium& at) {
  constexpr int most_iterations = 200;
  constexpr int plain_iterations = 15;  // without line search it ends within some 5 where it does
  constexpr int solved_from = 5;        // from this iteration on balance counts, whatever the pieces
  constexpr double lost_digits = 1e-4;  // no more is out of balance for the digits that a factor has lost
  if (bounds_held) {
    evaluate(state, condensed, places, at);
    if (at.residual < least_unbalanced) return true;
  } else {
    answer(state, places, at);
  }
  bool singular = false, stays = false;
  Pivoting pivoting{first_pieces(places, at.answers, !at.j.isZero(0.0))};
  for (at.iterations = 1; at.iterations <= most_iterations; ++at.iterations) {
    const bool search = at.iterations > plain_iterations && !slips(at.answers);
    if (search) {
      pivoting.on = at.answers;
    } else if (at.iterations > 1) {
      pivot(places, at.answers, pivoting);
    }
    const Pieces pieces = pieces_of(pivoting.on);
    if (slips(pivoting.on) && at.iterations > 2 * plain_iterations) return false;
    singular = !factor_tangent(condensed, places, pivoting.on, state, factor);
    // A tangent that was stiffened does not solve its pieces at once: from there on by what is out of balance.
    const Eigen::VectorXd next = stays ? Eigen::VectorXd(at.j + factor.solve(at.unbalanced))
                                       : solve_on_pieces(state, condensed, places, pivoting.on, factor);
    const double length = search ? step_length(state, condensed, places, at, next) : 1.0;
    at.j = length == 1.0 ? next : Eigen::VectorXd(at.j + length * (next - at.j));
    if (!at.j.allFinite()) report_mechanism(state, places);
    answer(state, places, at);
    if (!bounds_held && at.pieces != pieces && at.iterations < solved_from) continue;
    evaluate(state, condensed, places, at);
    // Places on the border of two pieces go by digits that a factor which has followed changes lost.
    if (length == 1.0 && at.pieces != pieces && factor.changed() && at.residual > least_unbalanced &&
        at.residual < lost_digits) {
      at.j += factor.solve(at.unbalanced);
      evaluate(state, condensed, places, at);
    }
    stays = bounds_held && length < 1.0 && at.pieces == pieces;
    const bool solved =
        at.residual < least_unbalanced && (bounds_held || (length == 1.0 && at.iterations >= solved_from));
    const bool settled = solved || (length == 1.0 && at.pieces == pieces);
    if (!settled) continue;
    if (singular && !bounds_held) report_mechanism(state, places);
    if (in_balance(condensed, at)) return true;
    if (factor.changed()) {  // perhaps for the digits that it lost
      if (refine(state, condensed, places, factor, pieces, at)) return true;
      factor = TangentFactor{};
      continue;
    }
    if (bounds_held) report_mechanism(state, places);
    return false;
  }
  if (bounds_held && singular) report_mechanism(state, places);  // the energy falls without end
  return false;
}

// Whether the jumps of `at` are an equilibrium; makes the tangent that follows from it.
bool ends_at(const State& state, const Condensed& condensed, const Places& places, TangentFactor& factor,
             Equilibrium& at) {
  evaluate(state, condensed, places, at);
  factor.pieces.clear();  // bounds that follow the normal reaction have another tangent
  if (!(at.residual < 1e-8)) return false;
  if (!factor_tangent(condensed, places, at.answers, state, factor)) report_mechanism(state, places);
  return true;
}

// Friction by bounds that are held while the jumps are found, from at.j on, and renewed from the normal reactions;
// false where that does not end, and then at.residual is the force out of balance.
bool solve_with_fixed_bounds(const State& state, const Condensed& condensed, Places places, TangentFactor& factor,
                             Equilibrium& at) {
  constexpr int most_rounds = 400;
  constexpr int fewest_to_half = 40;  // rounds in which the change of bounds falls to half, where it falls at all
  constexpr double renewed = 1e-10;   // change of a bound against the largest
  evaluate(state, condensed, places, at);
  factor.pieces.clear();
  double least = HUGE_VAL;
  for (int round = 0, least_in = 0; round < most_rounds; ++round) {
    double largest = 0.0, change = 0.0;
    for (std::size_t k = 0; k < places.size(); ++k) {
      ContactPlace& place = places[k];
      if (!place.law.slides()) continue;
      const double bound = place.law.friction() * std::max(0.0, at.answers[k].n);
      change = std::max(change, std::abs(bound - std::max(0.0, place.bound)));
      largest = std::max(largest, bound);
      place.bound = bound;
    }
    if (round > 0 && change <= renewed * largest) break;
    if (change < 0.5 * least) least = change, least_in = round;
    if (round - least_in > fewest_to_half) break;
    if (iterate(state, condensed, places, factor, true, at)) continue;
    at.j.setZero();  // from the last round it went round: the problem is convex, so any start will do
    factor = TangentFactor{};
    if (!iterate(state, condensed, places, factor, true, at)) break;
  }
  for (ContactPlace& place : places) place.bound = -1.0;
  return ends_at(state, condensed, places, factor, at);
}

// The equilibrium that a cohesion leads to as it falls to nothing; the cohesion (Pa) that is left where it does not
// fall so far: 0 at an equilibrium.
double solve_by_falling_cohesion(const State& state, const Condensed& condensed, const Places& places,
                                 TangentFactor& factor, Equilibrium& at) {
  Places stuck = places;
  for (ContactPlace& place : stuck) place.bound = place.law.slides() ? HUGE_VAL : -1.0;
  at.j = Eigen::VectorXd::Zero(condensed.size());
  factor = TangentFactor{};
  if (!iterate(state, condensed, stuck, factor, true, at)) return HUGE_VAL;
  PathEquations equations;
  for (const ContactPlace& place : places) equations.lines.push_back(lines_at(state, place));
  equations.solve = [&](const Answers& answers) {
    const bool follows = factor.holds(condensed.size()) && factor.follow(places, answers);
    if (!follows && !factor.factorise(tangent(condensed.S, places, answers), places, answers)) return Eigen::VectorXd();
    return solve_on_pieces(state, condensed, places, answers, factor);
  };
  equations.jump = [&](std::size_t k, const Eigen::VectorXd& j) {
    const Vec2 w = jump_of(places[k], j) - places[k].bonded;
    return Vec2{w.dot(places[k].n), w.dot(places[k].t())};
  };
  factor = TangentFactor{};
  const CohesionPath path = follow_falling_cohesion(equations, at.j);
  at.j = path.j;
  factor = TangentFactor{};
  if (path.cohesion > 0.0) return path.cohesion;
  if (iterate(state, condensed, places, factor, false, at)) return 0.0;  // with the digits that the path has lost
  at.j = path.j;
  return ends_at(state, condensed, places, factor, at) ? 0.0 : HUGE_VAL;
}

// Where Newton's steps go round: other ways to the same equations, one after the other.
void solve_otherwise(const State& state, const Condensed& condensed, const Places& places, TangentFactor& factor,
                     Equilibrium& at) {
  std::string why;
  try {
    if (solve_with_fixed_bounds(state, condensed, places, factor, at)) return;
  } catch (const NumericalFailure& mechanism) {  // of the bounds, perhaps not of the laws
    why = mechanism.what();
  }
  const double out_of_balance = at.residual, cohesion = solve_by_falling_cohesion(state, condensed, places, factor, at);
  if (cohesion == 0.0) return;
  if (!why.empty()) throw NumericalFailure(why);
  throw NumericalFailure(
      fmt::format("no equilibrium of the surfaces was found; the force out of balance is {:.2g} of the load{}. "
                  "Use less friction or a smaller load step",
                  out_of_balance,
                  std::isfinite(cohesion) ? fmt::format(", and faces held by a cohesion slide on when that has fallen "
                                                        "to {:.4g} Pa: with so much friction there may be none",
                                                        cohesion)
                                          : ""));
}

}  // namespace

std::array<SparseRow, 2> jump_rows(const Condensed& condensed, const SurfaceStencil& stencil) {
  std::array<SparseRow, 2> rows;
  for (std::size_t n = 0; n < 9; ++n) {
    if (stencil.plus[n] == stencil.minus[n]) continue;
    for (int component = 0; component < 2; ++component) {
      SparseRow& row = rows[static_cast<std::size_t>(component)];
      add_to_row(row, jump_unknown(condensed, stencil.plus[n], component), stencil.N[n]);
      add_to_row(row, jump_unknown(condensed, stencil.minus[n], component), -stencil.N[n]);
    }
  }
  return rows;
}

Vec2 jump_at(const Condensed& condensed, const SurfaceStencil& stencil, const Eigen::VectorXd& j) {
  const std::array<SparseRow, 2> rows = jump_rows(condensed, stencil);
  return {times(rows[0], j), times(rows[1], j)};
}

Places contact_places(const Scene& scene, const Rocks& rocks, const State& state, const Condensed& condensed) {
  Places places;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const Surface& surface = state.surfaces[k];
    const InterfaceLaw law = law_of(scene, surface);
    const double stiffness = contact_stiffness(law, rocks, state.grid);
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      const SurfacePoint& s = surface.points[q];
      if (!s.split) continue;
      places.push_back({k, q, -1, law, stiffness, s.A, s.n, s.in_situ, s.bonded, -1.0, start_of(s),
                        jump_rows(condensed, state.point_stencils[k][q])});
    }
  }
  for (std::size_t k = 0; k < state.ties.size(); ++k) {
    const TipTie& tie = state.ties[k];
    SurfaceStencil stencil;
    stencil.plus[0] = tie.plus, stencil.minus[0] = tie.minus, stencil.N[0] = 1.0;
    ContactPlace& place = places.emplace_back();
    place.tie = static_cast<int>(k), place.law = tie_law(tie), place.A = 1.0, place.n = tie.s.n;
    place.D = jump_rows(condensed, stencil);
  }
  return places;
}

Equilibrium solve_equilibrium(const State& state, const Condensed& condensed, const Places& places,
                              const Eigen::VectorXd& start, TangentFactor& factor) {
  Equilibrium at;
  const Eigen::VectorXd first =
      start.size() == condensed.size() ? start : Eigen::VectorXd(Eigen::VectorXd::Zero(condensed.size()));
  at.j = first;
  if (iterate(state, condensed, places, factor, false, at)) return at;
  at = Equilibrium{};
  at.j = first;
  solve_otherwise(state, condensed, places, factor, at);
  return at;
}

Eigen::MatrixXd opening_per_pressure(const State& state, const Condensed& condensed, const Places& places,
                                     const Equilibrium& equilibrium, const TangentFactor& factor) {
  const auto n = static_cast<Eigen::Index>(state.fracture().points.size());
  // Rows of the openings; on a closed face the reaction gives way as much as the pressure rises, and with it what
  // friction holds where the face slides.
  Eigen::MatrixXd opening = Eigen::MatrixXd::Zero(condensed.size(), n), load = opening;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    if (place.tie >= 0 || place.surface != 0) continue;
    const auto column = static_cast<Eigen::Index>(place.point);
    for (std::size_t c = 0; c < 2; ++c) {
      for (const auto& [index, value] : place.D[c])
        opening(index, column) += value * place.n[static_cast<Eigen::Index>(c)];
    }
    const LawAnswer& r = equilibrium.answers[k];
    if (r.piece == LawAnswer::Piece::open) load.col(column) = place.A * opening.col(column);
    if (r.dt_dn == 0.0) continue;
    const Vec2 less = -place.A * r.dt_dn / r.dn_dn * place.t();
    for (std::size_t c = 0; c < 2; ++c) {
      for (const auto& [index, value] : place.D[c]) load(index, column) += value * less[static_cast<Eigen::Index>(c)];
    }
  }
  return opening.transpose() * factor.solve(load);
}

}  // namespace strata
