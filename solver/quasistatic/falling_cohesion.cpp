#include "quasistatic/falling_cohesion.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace strata {
namespace {

// What keeps a place on its branch, linear in the cohesion: at none, and by it. Not below 0 while it stays.
struct Margin {
  double at_none = HUGE_VAL, by_c = 0.0;
  double at(double c) const { return at_none + by_c * c; }
};

using Margins = std::array<Margin, 3>;  // of contact, and of shear at its bound one way and the other

bool rubs(const LawLines& lines) {
  return lines.slides && lines.friction > 0.0;
}

// Margins of a place whose jump is w_n, w_t at no cohesion and changes by dw_n, dw_t with it (m, m/Pa).
Margins margins_of(const LawLines& lines, const Branch& branch, const Vec2& w, const Vec2& dw) {
  Margins all;
  const LawLine &contact = lines.contact, &own = lines.own;
  const double sign = branch.closed ? 1.0 : -1.0;
  if (contact.D > 0.0) all[0] = {sign * (contact.at(w.x()) - own.at(w.x())), -sign * (contact.D - own.D) * dw.x()};
  if (!rubs(lines)) return all;
  const double mu = branch.closed ? lines.friction : 0.0;
  const Margin bound{mu * contact.at(w.x()), 1.0 - mu * contact.D * dw.x()};
  const Margin held{lines.shear.at(w.y()), -lines.shear.D * dw.y()};
  for (const int way : {1, -1}) {
    if (branch.slides == -way) continue;
    const double to = branch.slides == 0 ? 1.0 : -1.0;  // beyond the bound, it slides
    all[way > 0 ? 1 : 2] = {to * ((mu > 0.0 ? bound.at_none : 0.0) - way * held.at_none),
                            to * (bound.by_c - way * held.by_c)};
  }
  return all;
}

// Goes over to what is beyond one of its margins.
void leave(Branch& branch, std::size_t margin) {
  if (margin == 0)
    branch.closed = !branch.closed;
  else
    branch.slides = branch.slides != 0 ? 0 : margin == 1 ? 1 : -1;
}

// The least cohesion (Pa) that holds all places, stuck at their jumps.
double holding_cohesion(const PathEquations& equations, const Eigen::VectorXd& stuck) {
  double c = 0.0;
  for (std::size_t k = 0; k < equations.lines.size(); ++k) {
    const LawLines& lines = equations.lines[k];
    const Vec2 w = equations.jump(k, stuck);
    if (rubs(lines)) c = std::max(c, std::abs(lines.shear.at(w.y())) - lines.bound(lines.contact.at(w.x())));
  }
  return c;
}

// A margin of a place, and how far the cohesion may go until it is none (Pa).
struct Leaving {
  std::size_t place = 0, margin = 0;
  double way = HUGE_VAL;
};

// The first to leave from a cohesion c (Pa) on as it falls (sense 1) or rises (-1).
Leaving first_to_leave(const std::vector<Margins>& margins, double c, double sense) {
  Leaving next;
  for (std::size_t k = 0; k < margins.size(); ++k) {
    for (std::size_t m = 0; m < margins[k].size(); ++m) {
      const double loss = sense * margins[k][m].by_c;
      const double way = loss > 0.0 ? std::max(0.0, margins[k][m].at(c)) / loss : HUGE_VAL;
      if (way < next.way) next = {k, m, way};
    }
  }
  return next;
}

std::vector<Branch> stuck_branches(const PathEquations& equations, const Eigen::VectorXd& stuck) {
  std::vector<Branch> branches(equations.lines.size());
  for (std::size_t k = 0; k < branches.size(); ++k) {
    const LawLines& lines = equations.lines[k];
    const double w_n = equations.jump(k, stuck).x();
    branches[k].closed = lines.contact.at(w_n) > lines.own.at(w_n);
  }
  return branches;
}

// Jumps on branches at a cohesion c (Pa).
Eigen::VectorXd jumps_on(const PathEquations& equations, const std::vector<Branch>& branches, double c) {
  Answers answers;
  for (std::size_t k = 0; k < branches.size(); ++k) answers.push_back(answer_on(equations.lines[k], branches[k], c));
  return equations.solve(answers);
}

}  // namespace

LawAnswer answer_on(const LawLines& lines, const Branch& branch, double c) {
  LawAnswer r;
  const LawLine& normal = branch.closed ? lines.contact : lines.own;
  r.piece = normal.piece, r.n_0 = normal.at(0.0), r.dn_dn = -normal.D;
  if (lines.slides && !rubs(lines)) return r;
  if (branch.slides == 0) {
    if (lines.slides) r.set(LawAnswer::Shear::sticks);
    r.t_0 = lines.shear.at(0.0), r.dt_dt = -lines.shear.D;
    return r;
  }
  const double mu = branch.closed ? branch.slides * lines.friction : 0.0;
  r.set(branch.slides > 0 ? LawAnswer::Shear::slips_plus : LawAnswer::Shear::slips_minus);
  r.t_0 = mu * r.n_0 + branch.slides * c, r.dt_dn = mu * r.dn_dn;
  return r;
}

CohesionPath follow_falling_cohesion(const PathEquations& equations, const Eigen::VectorXd& stuck) {
  constexpr double above = 1.01;  // of the cohesion that holds all, so that no place begins at its bound
  // Longer paths, which have not been seen, go round by round-off: every place changes a few times at most.
  const auto most = 20 * static_cast<int>(equations.lines.size()) + 100;
  const double first = above * holding_cohesion(equations, stuck);
  CohesionPath path{stuck, first, 0};
  std::vector<Branch> branches = stuck_branches(equations, stuck);
  std::vector<Margins> margins(branches.size());
  Leaving last{branches.size(), 0};
  for (double sense = 1.0; path.cohesion > 0.0 && path.changes < most;) {
    const Eigen::VectorXd j = jumps_on(equations, branches, 0.0), j_first = jumps_on(equations, branches, first);
    if (j.size() == 0 || j_first.size() == 0) return path;
    for (std::size_t k = 0; k < branches.size(); ++k) {
      const Vec2 w = equations.jump(k, j), dw = (equations.jump(k, j_first) - w) / first;
      margins[k] = margins_of(equations.lines[k], branches[k], w, dw);
    }
    if (last.place < branches.size()) sense = margins[last.place][last.margin].by_c > 0.0 ? -1.0 : 1.0;
    last = first_to_leave(margins, path.cohesion, sense);
    const double way = sense > 0.0 ? std::min(last.way, path.cohesion) : last.way;
    if (way == HUGE_VAL) return path;
    path.cohesion -= sense * way;
    path.j = j + path.cohesion / first * (j_first - j);
    if (path.cohesion > 0.0) leave(branches[last.place], last.margin), ++path.changes;
  }
  return path;
}

}  // namespace strata
