#include "quasistatic/falling_cohesion.hpp"

#include <Eigen/LU>
#include <catch2/catch.hpp>

using namespace strata;

namespace {

constexpr double k = 1e10;  // of contact, against 1 of the body: rigid but for 1e-10

// One place with jumps w_n, w_t that starts at rest: K w = f + r.
PathEquations one_place(const Eigen::Matrix2d& K, const Vec2& f, double friction) {
  InterfaceLaw law;
  law.kind = InterfaceLaw::Kind::friction;
  law.coefficient = friction;
  PathEquations equations;
  equations.lines = {lines_of(law, k, LawStart{}, 0.0)};
  equations.solve = [K, f](const Answers& answers) {
    const LawAnswer& r = answers.front();
    Eigen::Matrix2d T = K;
    T.row(0) -= Eigen::RowVector2d(r.dn_dn, 0.0);
    T.row(1) -= Eigen::RowVector2d(r.dt_dn, r.dt_dt);
    if (std::abs(T.determinant()) < 1e-6) return Eigen::VectorXd();
    return Eigen::VectorXd(T.fullPivLu().solve(f + Vec2{r.n_0, r.t_0}));
  };
  equations.jump = [](std::size_t, const Eigen::VectorXd& j) { return Vec2{j[0], j[1]}; };
  return equations;
}

// Where the path ends that begins with the place closed and stuck.
CohesionPath path_of(const Eigen::Matrix2d& K, const Vec2& f, double friction) {
  const PathEquations equations = one_place(K, f, friction);
  return follow_falling_cohesion(equations, equations.solve({answer_on(equations.lines[0], {true, 0}, 0.0)}));
}

Eigen::Matrix2d coupled(double q) {
  return (Eigen::Matrix2d() << 1.0, -q, -q, 1.0).finished();
}

}  // namespace

// Requires, of one place whose opening and slip are coupled by q (K = 1, -q; -q, 1; load f), what follows by hand:
// stuck w = 0 while |f_t| <= -mu f_n; slid w_t = f_t - mu n, n = -(q f_t + f_n)/(1 - q mu). Mutations that fail: no
// friction on closed faces, shear at its bound with the other sign, margins of the other way.
TEST_CASE("a place sticks or slides as its cohesion falls") {
  const CohesionPath stuck = path_of(coupled(0.5), {-1.0, 0.4}, 0.5);
  CHECK((stuck.cohesion == 0.0 && stuck.changes == 0 && stuck.j.norm() < 1e-9));
  for (const double way : {1.0, -1.0}) {
    const double q = 0.5 * way;
    const CohesionPath slid = path_of(coupled(q), {-1.0, 0.9 * way}, 0.5);
    const double n = (1.0 - 0.45) / 0.75;
    CAPTURE(slid.j, slid.changes);
    CHECK((slid.cohesion == 0.0 && slid.changes == 1));
    CHECK(slid.j[1] == Approx(way * (0.9 - 0.5 * n)).epsilon(1e-8));
    CHECK(std::abs(slid.j[0]) < 1e-9);
  }
}

// Requires that the path turns round where the place would jam: above the critical friction, q mu = 1.5, slip at
// n = 1.5 - c begins at c = 0.5 and goes back with c rising to 1.5, where the faces part, held by the cohesion still;
// from there it falls to the only equilibrium, open: w = K^-1 f. With a smaller shear there are three, and the place
// stays stuck. Mutations that fail: a cohesion that only falls, shear at its bound with the other sign, margins of the
// other way, no cohesion on open faces.
TEST_CASE("the path turns round where friction jams") {
  const CohesionPath open = path_of(coupled(0.5), {-1.0, 3.5}, 3.0);
  CAPTURE(open.j, open.cohesion, open.changes);
  CHECK((open.cohesion == 0.0 && open.changes == 2));
  CHECK(open.j[0] == Approx(1.0).epsilon(1e-8));
  CHECK(open.j[1] == Approx(4.0).epsilon(1e-8));
  CHECK(path_of(coupled(0.5), {-1.0, 2.5}, 3.0).j.norm() < 1e-9);
  const LawAnswer held = answer_on(one_place(coupled(0.5), Vec2::Zero(), 3.0).lines[0], {false, -1}, 1.5);
  CHECK((held.n_0 == 0.0 && held.dn_dn == 0.0 && held.t_0 == -1.5 && held.dt_dn == 0.0 && held.dt_dt == 0.0));
}

// Requires that what nothing but friction holds against sliding is said to need the cohesion that is missing: the load
// less mu n, and 1 % more of it where the path begins. Mutation that fails: 0 returned.
TEST_CASE("a cohesion that holds a free place cannot fall") {
  const CohesionPath path = path_of((Eigen::Matrix2d() << 1.0, 0.0, 0.0, 0.0).finished(), {-1.0, 2.0}, 0.5);
  CHECK(path.cohesion == Approx(1.5).epsilon(1e-8));
}
