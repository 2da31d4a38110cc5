// Equilibrium with friction where steps on the pieces of the laws go round: the one that a cohesion leads to as it
// falls to nothing.
#pragma once

#include <functional>
#include <vector>

#include "quasistatic/tangent_factor.hpp"

namespace strata {

// The linear piece that a place is on while its bound of friction is mu n + c, also on open faces.
struct Branch {
  bool closed = false;
  int slides = 0;  // 1, -1: the reaction is its bound, so signed; 0: it sticks, or there is no friction
};

/// The linear piece of a law on a branch, at a cohesion c (Pa). Throws nothing.
LawAnswer answer_on(const LawLines& lines, const Branch& branch, double c);

// Where such a path has come to.
struct CohesionPath {
  Eigen::VectorXd j;      // jumps (m) there
  double cohesion = 0.0;  // Pa; 0: at the equilibrium
  int changes = 0;        // of pieces on the way
};

// What the path needs of an equilibrium's equations: the lines of each place's law, the jumps j that solve them on
// linear pieces (none where these are singular), and the normal and tangential jump w of a place (m) for j.
struct PathEquations {
  std::vector<LawLines> lines;
  std::function<Eigen::VectorXd(const Answers&)> solve;
  std::function<Vec2(std::size_t place, const Eigen::VectorXd& j)> jump;
};

/// Follows the equilibrium from jumps j (m), at which all that rubs sticks, while a cohesion c falls from what that
/// takes. Jumps are linear in c as long as all places stay on their branches; where one leaves, it goes over to the
/// next, and c turns round if that asks for it (Lemke, Management Sci. 11, 1965, with c as the artificial variable).
/// Ends at c = 0, or where no place ever leaves: then faces slide on without end at the c that is returned. Throws
/// nothing.
CohesionPath follow_falling_cohesion(const PathEquations& equations, const Eigen::VectorXd& stuck);

}  // namespace strata
