#include "quasistatic/contact_equilibrium.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "quasistatic/contact_pieces.hpp"

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
double answer(const State& state, const std::vector<ContactPlace>& places, Equilibrium& at) {
  at.answers.resize(places.size());
  at.w.resize(places.size());
  at.pieces.resize(places.size());
  double energy = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    at.w[k] = jump_of(place, at.j) - place.bonded;
    const LawAnswer& r = at.answers[k] = lines_at(state, place).at(at.w[k].dot(place.n), at.w[k].dot(place.t()));
    at.pieces[k] = r.piece;
    energy += place.A * (r.energy - net_load(state, place).dot(at.w[k]));
  }
  return energy;
}

void evaluate(const State& state, const Condensed& condensed, const std::vector<ContactPlace>& places,
              Equilibrium& at) {
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
Eigen::VectorXd solve_on_pieces(const State& state, const Condensed& condensed, const std::vector<ContactPlace>& places,
                                const std::vector<LawAnswer>& answers, const TangentFactor& factor) {
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

bool slips(const std::vector<LawAnswer>& answers) {
  return std::any_of(answers.begin(), answers.end(), [](const LawAnswer& r) { return r.dt_dn != 0.0; });
}

[[noreturn]] void report_mechanism(const State& state, const std::vector<ContactPlace>& places) {
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

constexpr double stiffening = 1e-9;

// Factors the tangent at `at` unless `factor` has it already; false where parts of the block move freely. On the way to
// a solution they may for a while, so the factor is then that of a tangent slightly stiffer. A sliver of rock with
// fewer particles than its copies of nodes have unknowns (between a fracture and an interface that it meets, or in a
// sharp turn) has motions without strain, too; no load drives them, and the same stiffening holds them.
bool factor_tangent(const Condensed& condensed, const std::vector<ContactPlace>& places,
                    const std::vector<LawAnswer>& answers, const State& state, TangentFactor& factor) {
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
  std::vector<LawAnswer> first = answers;
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
double slope(const State& state, const std::vector<ContactPlace>& places, const std::vector<Vec2>& w,
             const std::vector<Vec2>& dw, double length) {
  double sum = 0.0;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    const LawAnswer r =
        lines_at(state, place).at((w[k] + length * dw[k]).dot(place.n), (w[k] + length * dw[k]).dot(place.t()));
    const Vec2 traction = net_load(state, place) + r.n * place.n + r.t * place.t();
    sum -= place.A * traction.dot(dw[k]);
  }
  return sum;
}

// Newton's step shortened to the minimum of the energy along it, where its slope, which only rises, is 0. The whole
// step where the slope there is still down, or next to nothing.
double step_length(const State& state, const Condensed& condensed, const std::vector<ContactPlace>& places,
                   const Equilibrium& from, const Eigen::VectorXd& to) {
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
bool refine(const State& state, const Condensed& condensed, const std::vector<ContactPlace>& places,
            const TangentFactor& factor, const Pieces& pieces, Equilibrium& at) {
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

// Newton's method on the pieces from at.j; false where it does not end within its iterations. Without sliding places
// the laws have an energy, along which steps are shortened.
bool iterate(const State& state, const Condensed& condensed, const std::vector<ContactPlace>& places,
             TangentFactor& factor, Equilibrium& at) {
  constexpr int most_iterations = 200;
  constexpr int plain_iterations = 15;  // without line search it ends within some 5 where it does
  constexpr int solved_from = 5;        // from this iteration on balance counts, whatever the pieces
  constexpr double lost_digits = 1e-4;  // no more is out of balance for the digits that a factor has lost
  answer(state, places, at);
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
    const bool singular = !factor_tangent(condensed, places, pivoting.on, state, factor);
    const Eigen::VectorXd next = solve_on_pieces(state, condensed, places, pivoting.on, factor);
    const double length = search ? step_length(state, condensed, places, at, next) : 1.0;
    at.j = length == 1.0 ? next : Eigen::VectorXd(at.j + length * (next - at.j));
    if (!at.j.allFinite()) report_mechanism(state, places);
    answer(state, places, at);
    if (at.pieces != pieces && at.iterations < solved_from) continue;
    evaluate(state, condensed, places, at);
    // Places on the border of two pieces go by digits that a factor which has followed changes lost.
    if (length == 1.0 && at.pieces != pieces && factor.changed() && at.residual > least_unbalanced &&
        at.residual < lost_digits) {
      at.j += factor.solve(at.unbalanced);
      evaluate(state, condensed, places, at);
    }
    const bool solved = at.residual < least_unbalanced && at.iterations >= solved_from;
    if (length < 1.0 || (!solved && at.pieces != pieces)) continue;
    if (singular) report_mechanism(state, places);
    if (in_balance(condensed, at)) return true;
    if (!factor.changed()) return false;
    if (refine(state, condensed, places, factor, pieces, at)) return true;  // the digits that it lost
    factor = TangentFactor{};
  }
  return false;
}

// A border of a piece (see LawLines::inside()) that is met after some change of the confinement (Pa).
struct Border {
  std::size_t place = std::numeric_limits<std::size_t>::max(), which = 0;
  double away = HUGE_VAL;
};

// Places pressed together by a confinement c (Pa) beside what presses them anyway: laws and pieces of all, and, as long
// as no piece changes, their jumps w + c per_c.
struct Confined {
  std::vector<LawLines> lines;  // without confinement
  Pieces on;
  std::vector<Vec2> w, per_c;  // m, m/Pa

  // Not quite the same everywhere, so that places that are alike give way one after the other.
  static double share(std::size_t k) { return 1.0 + 1e-3 * std::sin(1.0 + static_cast<double>(k)); }

  LawLines law(std::size_t k, double c) const {
    LawLines of = lines[k];
    of.contact.r_0 += c * share(k);
    return of;
  }

  std::array<double, 3> inside(const std::vector<ContactPlace>& places, std::size_t k, double c) const {
    const Vec2 at = w[k] + c * per_c[k];
    return law(k, c).inside(on[k], at.dot(places[k].n), at.dot(places[k].t()));
  }
};

// Everything that can be closed and sticks.
Confined all_held(const State& state, const std::vector<ContactPlace>& places) {
  using Piece = LawAnswer::Piece;
  Confined at;
  at.w.resize(places.size()), at.per_c.resize(places.size());
  for (const ContactPlace& place : places) {
    const LawLines& law = at.lines.emplace_back(lines_at(state, place));
    at.on.push_back(law.friction > 0.0 ? Piece::stick : law.contact.D > 0.0 ? Piece::closed : Piece::open);
  }
  return at;
}

// The jumps on the present pieces without confinement, which are returned, and how those of places go with it.
Eigen::VectorXd solve_confined(const State& state, const Condensed& condensed, const std::vector<ContactPlace>& places,
                               TangentFactor& factor, Confined& at) {
  std::vector<LawAnswer> answers;
  Eigen::VectorXd f = Eigen::VectorXd::Zero(condensed.size());
  for (std::size_t k = 0; k < places.size(); ++k) {
    const LawAnswer &r = answers.emplace_back(at.lines[k].on(at.on[k])), pressed = at.law(k, 1.0).on(at.on[k]);
    if (at.lines[k].contact.D > 0.0)
      add_force(places[k], places[k].along(pressed.n_0 - r.n_0 - Confined::share(k), pressed.t_0 - r.t_0), f);
  }
  if (!factor_tangent(condensed, places, answers, state, factor)) report_mechanism(state, places);
  const Eigen::VectorXd j = solve_on_pieces(state, condensed, places, answers, factor), per_c = factor.solve(f);
  for (std::size_t k = 0; k < places.size(); ++k)
    at.w[k] = jump_of(places[k], j) - places[k].bonded, at.per_c[k] = jump_of(places[k], per_c);
  return j;
}

// The border that comes first as c changes by steps of `step` (Pa); the last one that was crossed aside.
Border next_border(const std::vector<ContactPlace>& places, const Confined& at, double c, double step,
                   const Border& last) {
  Border next;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const auto here = at.inside(places, k, c), there = at.inside(places, k, c + step);
    for (std::size_t b = 0; b < here.size(); ++b) {
      const double lost = here[b] - there[b];
      if (!(lost > 0.0) || (k == last.place && b == last.which)) continue;
      const double away = std::max(0.0, here[b]) / lost * std::abs(step);
      if (away < next.away) next = {k, b, away};
    }
  }
  return next;
}

// The piece on the other side of a border; held: what shear would be if the place stuck (Pa).
LawAnswer::Piece beyond(LawAnswer::Piece piece, std::size_t border, const LawLines& law, double held) {
  using Piece = LawAnswer::Piece;
  if (border > 0) return piece != Piece::stick ? Piece::stick : border == 1 ? Piece::slip_plus : Piece::slip_minus;
  if (piece != Piece::open) return Piece::open;
  return law.friction == 0.0 ? Piece::closed : held > 0.0 ? Piece::slip_plus : Piece::slip_minus;
}

// Coulomb's law by a confinement c of all places that falls to nothing. A large one holds everything, and from there on
// the jumps are linear in c from one change of a place's piece to the next. c may rise on the way, but the path cannot
// turn back to where all is held, of which there is one, and jumps stay finite: it ends at c = 0 (Lemke's method; that
// there is an equilibrium whatever the friction: Klarbring & Pang, SIAM J. Optim. 8, 1998), or something moves freely.
// `held`: the body, or with slivers of rock held a little all the way.
Equilibrium release(const State& state, const Condensed& condensed, const Condensed& held,
                    const std::vector<ContactPlace>& places, TangentFactor& factor) {
  Equilibrium at;
  Confined path = all_held(state, places);
  factor = TangentFactor{};
  double c = 0.0, step = -1e6;  // Pa; any, for slopes
  Border last;
  for (std::size_t changes = 0; changes < 20 * places.size(); ++changes) {
    at.iterations = static_cast<int>(changes);
    at.j = solve_confined(state, held, places, factor, path);
    const auto inside = [&](double at_c) { return path.inside(places, last.place, at_c)[last.which]; };
    if (changes > 0) {
      if (inside(c + step) < inside(c)) step = -step;  // into the piece that the last change leads to
    } else {
      for (std::size_t k = 0; k < places.size(); ++k) {
        const auto none = path.inside(places, k, 0.0), some = path.inside(places, k, 1e6);
        for (std::size_t b = 0; b < none.size(); ++b)
          if (some[b] > none[b]) c = std::max(c, 1e6 * none[b] / (none[b] - some[b]));
      }
    }
    last = next_border(places, path, c, step, last);
    if (step < 0.0 && last.away >= c) {
      evaluate(state, condensed, places, at);
      at.j += factor.solve(at.unbalanced);  // without what `held` holds too much
      factor = TangentFactor{};
      for (int correction = 0; correction < 5; ++correction) {  // of places that have come to stand beyond a border
        evaluate(state, condensed, places, at);
        if (!factor_tangent(condensed, places, at.answers, state, factor)) report_mechanism(state, places);
        if (in_balance(condensed, at)) return at;
        at.j += factor.solve(at.unbalanced);
      }
      report_mechanism(state, places);
    }
    if (last.away == HUGE_VAL) report_mechanism(state, places);
    c += std::copysign(last.away, step);
    LawAnswer::Piece& piece = path.on[last.place];
    const LawLines& law = path.lines[last.place];
    const Vec2 w = path.w[last.place] + c * path.per_c[last.place];
    piece = beyond(piece, last.which, law, law.shear.at(w.dot(places[last.place].t())));
  }
  throw NumericalFailure("no equilibrium of the surfaces was found within " + std::to_string(20 * places.size()) +
                         " changes of places that stick, slide or open. Use less friction or larger cells");
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

std::vector<ContactPlace> contact_places(const Scene& scene, const Rocks& rocks, const State& state,
                                         const Condensed& condensed) {
  std::vector<ContactPlace> places;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const Surface& surface = state.surfaces[k];
    const InterfaceLaw law = law_of(scene, surface);
    const double stiffness = contact_stiffness(law, rocks, state.grid);
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      const SurfacePoint& s = surface.points[q];
      if (!s.split) continue;
      places.push_back({k, q, -1, law, stiffness, s.A, s.n, s.in_situ, s.bonded, start_of(s),
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

Equilibrium solve_equilibrium(const State& state, const Condensed& condensed, const std::vector<ContactPlace>& places,
                              const Eigen::VectorXd& start, TangentFactor& factor) {
  Equilibrium at;
  const Eigen::VectorXd first =
      start.size() == condensed.size() ? start : Eigen::VectorXd(Eigen::VectorXd::Zero(condensed.size()));
  at.j = first;
  if (iterate(state, condensed, places, factor, at)) return at;
  try {
    return release(state, condensed, condensed, places, factor);
  } catch (const NumericalFailure&) {
    Condensed held = condensed;
    held.S.diagonal() *= 1.0 + stiffening;
    return release(state, condensed, held, places, factor);
  }
}

Eigen::MatrixXd opening_per_pressure(const State& state, const Condensed& condensed,
                                     const std::vector<ContactPlace>& places, const Equilibrium& equilibrium,
                                     const TangentFactor& factor) {
  const auto n = static_cast<Eigen::Index>(state.fracture().points.size());
  // Rows of the openings; on a closed face the reaction gives way as much as the pressure rises.
  Eigen::MatrixXd opening = Eigen::MatrixXd::Zero(condensed.size(), n), load = opening;
  for (std::size_t k = 0; k < places.size(); ++k) {
    const ContactPlace& place = places[k];
    if (place.tie >= 0 || place.surface != 0) continue;
    const auto column = static_cast<Eigen::Index>(place.point);
    for (std::size_t c = 0; c < 2; ++c) {
      for (const auto& [index, value] : place.D[c])
        opening(index, column) += value * place.n[static_cast<Eigen::Index>(c)];
    }
    if (equilibrium.pieces[k] == LawAnswer::Piece::open) load.col(column) = place.A * opening.col(column);
  }
  return opening.transpose() * factor.solve(load);
}

}  // namespace strata
