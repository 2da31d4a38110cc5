#include "fracture/j_integral.hpp"

#include <catch2/catch.hpp>
#include <limits>
#include <numbers>

#include "fracture/growth.hpp"
#include "small_scenes.hpp"

using namespace strata;
using namespace strata::test;

namespace {

using std::numbers::pi;

struct Intensity {
  double K_I = 0.0, K_II = 0.0;
};

// Displacement near a tip in its own frame (crack along the negative first axis), plane strain: Anderson 2005, table
// 2.2.
Vec2 near_tip(const Elasticity& rock, const Intensity& K, double r, double theta) {
  const double kappa = 3.0 - 4.0 * rock.nu, c = std::cos(0.5 * theta), s = std::sin(0.5 * theta);
  const double scale = std::sqrt(r / (2.0 * pi)) / (2.0 * rock.mu);
  return scale * (K.K_I * Vec2{c * (kappa - 1.0 + 2.0 * s * s), s * (kappa + 1.0 - 2.0 * c * c)} +
                  K.K_II * Vec2{s * (kappa + 1.0 + 2.0 * c * c), -c * (kappa - 1.0 - 2.0 * s * s)});
}

struct Frame {
  Vec2 tip, e_1, e_2;
  Frame(const State& state, bool at_back) {
    const auto& v = state.fracture().vertices;
    tip = at_back ? v.back().x : v.front().x;
    e_1 = (tip - (at_back ? v.front().x : v.back().x)).normalized();
    e_2 = {-e_1.y(), e_1.x()};
  }
  Vec2 local(const Vec2& x) const { return {x.dot(e_1), x.dot(e_2)}; }
  Vec2 global(const Vec2& x) const { return x.x() * e_1 + x.y() * e_2; }
};

Vec2 displacement(const Elasticity& rock, const Intensity& K, const Frame& frame, const Vec2& x) {
  const Vec2 at = frame.local(x - frame.tip);
  return frame.global(near_tip(rock, K, at.norm(), std::atan2(at.y(), at.x())));
}

// Lays the near-tip field of one tip on all particles and the fracture's points, with a uniform pressure on the faces
// and the uniform stress -p n n that goes with it, which has no intensity of its own.
void impose(Run& run, bool at_back, const Intensity& K, double pressure = 0.0) {
  State& state = run.state;
  const Elasticity& rock = run.rocks[0];
  const Frame frame(state, at_back);
  const Vec2 n = state.fracture().points[0].n;
  const auto uniform = gradient_of(run.scene.rocks[0],
                                   {-pressure * n.x() * n.x(), -pressure * n.y() * n.y(), -pressure * n.x() * n.y()});
  Particles& p = state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 x{p.x[q], p.y[q]};
    const double d = 1e-5 * (x - frame.tip).norm();
    const auto u = [&](double a, double b) { return displacement(rock, K, frame, x + Vec2{a, b}); };
    const Vec2 by_x = (u(d, 0.0) - u(-d, 0.0)) / (2.0 * d), by_y = (u(0.0, d) - u(0.0, -d)) / (2.0 * d);
    strain(state, q, {by_x.x() + uniform[0], by_y.x() + uniform[1], by_x.y() + uniform[2], by_y.y() + uniform[3]});
  }
  for (SurfacePoint& s : state.fracture().points) {
    const double r = (s.x - frame.tip).norm();
    const Vec2 jump = near_tip(rock, K, r, pi) - near_tip(rock, K, r, -pi);
    s.w = (at_back ? 1.0 : -1.0) * frame.global(jump);  // u(+) - u(-); + is on the left of the way to the back
    s.P = pressure;
    s.reaction = Vec2::Zero();
  }
}

struct Measured {
  double K_I, K_II, J;
};

const Tip& tip_of(const State& state, bool at_back) {
  return *std::find_if(state.tips.begin(), state.tips.end(), [&](const Tip& tip) { return tip.at_back == at_back; });
}

Measured measure(Run& run, bool at_back) {
  measure_tips(run.scene, run.rocks, run.state);
  const Tip& tip = tip_of(run.state, at_back);
  return {tip.K_I, tip.K_II, tip.J};
}

Run cracked(const std::vector<std::array<double, 2>>& path, int points = 4) {
  Scene scene = block(20, 20);
  scene.numerics.particles_per_cell = points;
  add_fracture(scene, path);
  return Run(scene);
}

constexpr double K_unit = 1e6;  // Pa sqrt(m)
const std::vector<Intensity> mixes{
    {K_unit, 0.0}, {K_unit, 0.3 * K_unit}, {K_unit, -0.3 * K_unit}, {0.2 * K_unit, K_unit}};

// Largest errors of K (over |K|) and of J, for all mixes at one end, with and without pressure.
struct Errors {
  double K = 0.0, J = 0.0;
};

Errors errors(Run& run, bool at_back) {
  Errors most;
  for (const Intensity& K : mixes) {
    for (const double pressure : {0.0, 3e5}) {
      impose(run, at_back, K, pressure);
      const Measured m = measure(run, at_back);
      const double size2 = K.K_I * K.K_I + K.K_II * K.K_II, J = size2 / run.rocks[0].E_prime;
      most.K =
          std::max({most.K, std::abs(m.K_I - K.K_I) / std::sqrt(size2), std::abs(m.K_II - K.K_II) / std::sqrt(size2)});
      most.J = std::max(most.J, std::abs(m.J - J) / J);
    }
  }
  return most;
}

}  // namespace

// Requires that an increment turns by a third of the kink for each of its cells, and by no more than turn_share of it.
TEST_CASE("an increment turns by its share of the kink") {
  Run run = cracked({{10.0, 4.0}, {10.0, 16.0}});
  impose(run, true, {K_unit, 0.3 * K_unit});
  for (const double share : {1.0, 0.5, 0.2}) {
    for (const double increment : {0.3, 0.9, 1.8, 6.0}) {
      run.scene.fracture->turn_share = share, run.scene.fracture->increment_m = increment;
      measure(run, true);
      const Tip& tip = tip_of(run.state, true);
      CAPTURE(share, increment, tip.kink);
      CHECK(tip.kink < -0.3);
      CHECK(tip.turn == Approx(std::min(share, increment / 3.0) * tip.kink).epsilon(1e-12));
    }
  }
}

// Requires K_I, K_II and J of an imposed near-tip field, with free faces and with pressure on them, at both ends of a
// fracture on a grid line and at mid-cell, along and across the grid. Measured: K 0.04 % and J 0.04 % on a grid
// line, 0.09 % and 0.12 % at mid-cell.
// Mutations that fail: the face term left out, doubled or of the other sign (pressure); K_II of the other
// sign; the same frame at both ends; the strain energy left out of J.
TEST_CASE("K and J of a straight fracture") {
  for (const auto& path : std::vector<std::vector<std::array<double, 2>>>{
           {{10.0, 4.0}, {10.0, 16.0}}, {{9.5, 4.0}, {9.5, 16.0}}, {{16.0, 10.0}, {4.0, 10.0}}}) {
    Run run = cracked(path);
    for (const bool at_back : {true, false}) {
      const Errors e = errors(run, at_back);
      CAPTURE(path[0][0], path[0][1], at_back, e.K, e.J);
      CHECK(e.K < 0.002);
      CHECK(e.J < 0.0025);
    }
  }
}

// Requires the same of inclined fractures, whose particles are refined to 16 points a cell. Measured:
// K 0.12 to 0.37 %, J 0.2 to 1.5 % (the exact field is in no equilibrium with the grid's functions).
TEST_CASE("K and J of an inclined fracture") {
  for (const auto& path : std::vector<std::vector<std::array<double, 2>>>{
           {{5.2, 5.4}, {14.7, 13.9}}, {{13.3, 4.4}, {6.1, 15.8}}, {{4.3, 9.2}, {15.9, 11.3}}}) {
    Run run = cracked(path);
    for (const bool at_back : {true, false}) {
      const Errors e = errors(run, at_back);
      CAPTURE(path[0][0], path[0][1], at_back, e.K, e.J);
      CHECK(e.K < 0.006);
      CHECK(e.J < 0.02);
    }
  }
}

// Requires signs and scales: K and the kink change sign with K_II, J does not; K doubles and J quadruples with the
// field; nothing gives nothing. A kink turns a tip clockwise for K_II > 0, as it sees it, at either end. Mutation that
// fails: a closed tip keeps the J of its rings.
TEST_CASE("signs and scales of K") {
  for (const bool at_back : {true, false}) {
    Run run = cracked({{10.0, 4.0}, {10.0, 16.0}});
    impose(run, at_back, {K_unit, 0.3 * K_unit});
    const Measured plus = measure(run, at_back);
    const double kink = tip_of(run.state, at_back).kink;
    CHECK(plus.K_II > 0.2 * K_unit);
    CHECK(kink < -0.4);
    impose(run, at_back, {K_unit, -0.3 * K_unit});
    const Measured minus = measure(run, at_back);
    CHECK(minus.K_II == Approx(-plus.K_II).epsilon(1e-6));
    CHECK(minus.J == Approx(plus.J).epsilon(1e-6));
    CHECK(tip_of(run.state, at_back).kink == Approx(-kink).epsilon(1e-6));
    impose(run, at_back, {2.0 * K_unit, 0.6 * K_unit});
    CHECK(measure(run, at_back).K_I == Approx(2.0 * plus.K_I).epsilon(1e-8));
    CHECK(measure(run, at_back).J == Approx(4.0 * plus.J).epsilon(1e-8));
    impose(run, at_back, {});
    CHECK(measure(run, at_back).K_I == 0.0);
    CHECK(measure(run, at_back).J == 0.0);
    CHECK(tip_of(run.state, at_back).closed);
    // A tip whose faces touch has no K_I, and J and kink of their sliding, K_II^2/E' and that of mode II; none where
    // they stay in place. A K_I below zero is that of closed faces, unless they may pass through each other.
    auto& points = run.state.fracture().points;
    SurfacePoint& last = at_back ? points.back() : points.front();
    for (const double K_II : {0.0, 0.3 * K_unit}) {
      impose(run, at_back, {K_unit, K_II});
      last.reaction = 1.0 * last.n;
      if (K_II == 0.0) last.w = last.w.dot(last.n) * last.n;
      const Measured shut = measure(run, at_back);
      CHECK(shut.K_I == 0.0);
      CHECK(shut.K_II == Approx(K_II).epsilon(0.01));
      CHECK(shut.J == Approx(shut.K_II * shut.K_II / run.rocks[0].E_prime).epsilon(1e-12));
      CHECK(tip_of(run.state, at_back).closed);
      CHECK(tip_of(run.state, at_back).kink == Approx(K_II == 0.0 ? 0.0 : -70.528779 * pi / 180.0).margin(1e-8));
      CHECK(tip_of(run.state, at_back).J_spread == 0.0);
      last.reaction.setZero();
    }
    impose(run, at_back, {-K_unit, 0.0});
    CHECK(measure(run, at_back).K_I == 0.0);
    CHECK(measure(run, at_back).J == Approx(0.0).margin(1e-3));
    CHECK(tip_of(run.state, at_back).closed);
    run.scene.fracture->faces = Fracture::Faces::free;
    CHECK(measure(run, at_back).K_I == Approx(-K_unit).epsilon(0.01));
    CHECK_FALSE(tip_of(run.state, at_back).closed);
  }
}

// Requires that the imposed field is path independent: rings agree to 2 %, and more points a cell do not change K by
// more than 0.5 %.
TEST_CASE("rings and points agree") {
  Run coarse = cracked({{10.0, 5.0}, {10.0, 15.0}}), fine = cracked({{10.0, 5.0}, {10.0, 15.0}}, 16);
  impose(coarse, true, {K_unit, 0.3 * K_unit});
  impose(fine, true, {K_unit, 0.3 * K_unit});
  const Measured a = measure(coarse, true), b = measure(fine, true);
  CAPTURE(a.K_I, b.K_I, a.J, b.J, tip_of(coarse.state, true).J_spread);
  CHECK(tip_of(coarse.state, true).J_spread < 0.02);
  CHECK(tip_of(coarse.state, true).J_spread > 0.0);
  CHECK(tip_of(coarse.state, true).ring_m == Approx(4.0));
  CHECK(b.K_I == Approx(a.K_I).epsilon(0.005));
}

// Requires that J and K do not see a uniform motion of the whole block, with any transfer: accelerations are what
// forces give, whatever the transfer makes of velocities. Taken from the particles' change under PIC, they would be 42
// m/s^2.
TEST_CASE("J does not see uniform motion") {
  for (const auto transfer : transfers) {
    std::vector<Measured> at_rest_and_moving;
    for (const double v : {0.0, 0.01}) {
      Run run = cracked({{10.0, 5.0}, {10.0, 15.0}});
      run.scene.numerics.transfer = transfer;
      impose(run, true, {K_unit, 0.3 * K_unit});
      stir(run.state, {v, 0.7 * v}, 0.0);
      run.advance(1);
      const Tip& tip = tip_of(run.state, true);
      at_rest_and_moving.push_back({tip.K_I, tip.K_II, tip.J});
    }
    const Measured &rest = at_rest_and_moving[0], &moving = at_rest_and_moving[1];
    CAPTURE(static_cast<int>(transfer), rest.J, moving.J, rest.K_II, moving.K_II);
    CHECK(rest.J > 50.0);
    CHECK(moving.J == Approx(rest.J).epsilon(1e-5));
    CHECK(moving.K_I == Approx(rest.K_I).epsilon(1e-5));
    CHECK(moving.K_II == Approx(rest.K_II).epsilon(1e-5));
  }
}

// Requires the maximum-hoop angles by hand: -2 K_II/K_I for little K_II, -70.53 degrees in pure mode II, 0 in pure mode
// I, and that they make the hoop stress stationary: K_I sin(th) + K_II (3 cos(th) - 1) = 0.
TEST_CASE("kink angles") {
  CHECK(kink_angle(1e6, 0.0) == 0.0);
  for (const double sign : {1.0, -1.0}) {
    CHECK(kink_angle(1e6, sign * 1e3) == Approx(-sign * 2e-3).epsilon(1e-4));
    CHECK(kink_angle(0.0, sign) * 180.0 / pi == Approx(-sign * 70.528779).epsilon(1e-7));
    for (const double K_II : {0.1, 0.5, 1.0, 4.0}) {
      const double angle = kink_angle(1.0, sign * K_II);
      CHECK(std::sin(angle) + sign * K_II * (3.0 * std::cos(angle) - 1.0) == Approx(0.0).margin(1e-14));
      CHECK(angle * sign < 0.0);
    }
  }
}

// Requires that a tip's direction points away from its fracture at both ends.
TEST_CASE("tip directions") {
  const Surface s = make_surface(Surface::Kind::fracture, 0, {{1.0, 1.0}, {4.0, 5.0}}, 0.5);
  CHECK((tip_direction(s, true) - Vec2{0.6, 0.8}).norm() < 1e-14);
  CHECK((tip_direction(s, false) + Vec2{0.6, 0.8}).norm() < 1e-14);
}

// Requires that a tip says what is so near that J and K are not to be trusted: an interface whose faces are apart
// within 4 cells of the tip, or another rock, and within 3.5 cells an edge, the symmetry line, the other tip or a part
// of the path that comes back; and that J and K are none nearer than 2 cells, 2.5 to faces that are apart. A bond
// between like rocks is nothing, be it near or failed farther along. Mutations that fail: bonds that count; a limit
// half a cell off.
TEST_CASE("a tip says what its rings are near") {
  struct Found {
    Obstacle near;
    bool crossed;
  };
  const auto upper = [](const Scene& scene, double split_from, double split_to) {
    Run run(scene);
    for (Surface& surface : run.state.surfaces) {
      if (surface.kind == Surface::Kind::fracture) continue;
      for (SurfacePoint& s : surface.points) s.split = s.split || (s.x.x() > split_from && s.x.x() < split_to);
    }
    run.rebuild();
    measure_tips(run.scene, run.rocks, run.state);
    const Tip& tip = tip_of(run.state, true);
    return Found{tip.near, tip.crossed};
  };
  const auto with = [](const InterfaceLaw& law, double at, std::size_t rock) {
    Scene scene = block(20, 30);
    scene.rocks.push_back({"soft", 5e9, 0.2, 2500.0, 1e6});
    add_fracture(scene, {{10.0, 2.0}, {10.0, 14.0}});
    add_interface(scene, law, at, rock);
    return scene;
  };
  const InterfaceLaw bond = weak_law(1e6, 1e6), perfect;
  for (const double off : {1.0, 2.0, 3.0, 3.5, 4.0, 5.0, -2.0, -3.0}) {  // behind the tip, too
    CAPTURE(off);
    const double at = 14.0 + off, distance = std::abs(off);
    const auto is = [&](const Found& found, Obstacle what) {
      return found.near == (distance < 4.0 ? what : Obstacle::none) && found.crossed == (distance < 2.0);
    };
    CHECK(is(upper(with(bond, at, 0), 0.0, 20.0), Obstacle::interface));
    CHECK(is(upper(with(soft_law(1e9, 1e9), at, 0), 0.0, 0.0), Obstacle::interface));
    CHECK(is(upper(with(perfect, at, 1), 0.0, 0.0), Obstacle::rock_border));
    CHECK(is(upper(with(bond, at, 1), 0.0, 0.0), Obstacle::rock_border));
    CHECK(is(upper(with(bond, at, 1), 0.0, 20.0), Obstacle::interface));
    for (const Found& found : {upper(with(bond, at, 0), 0.0, 0.0), upper(with(bond, at, 0), 15.0, 20.0)}) {
      CHECK(found.near == Obstacle::none);
      CHECK_FALSE(found.crossed);
    }
  }
  const auto lone = [](const std::vector<std::array<double, 2>>& path, Edge bottom) {
    Scene scene = block(40, 30);
    scene.domain.bottom = bottom;
    add_fracture(scene, path);
    return scene;
  };
  for (const double off : {1.5, 2.0, 3.0, 4.0}) {
    CAPTURE(off);
    const auto is = [&](const Scene& scene, Obstacle what) {
      const Found found = upper(scene, 0.0, 0.0);
      return found.near == (off < 3.5 ? what : Obstacle::none) && found.crossed == (off < 2.0);
    };
    CHECK(is(lone({{20.0, 0.0}, {20.0, off}}, Edge::symmetry), Obstacle::symmetry_line));
    CHECK(is(lone({{20.0, 14.0}, {20.0, 30.0 - off}}, Edge::traction), Obstacle::edge));
    CHECK(is(lone({{40.0 - off, 8.0}, {40.0 - off, 20.0}}, Edge::traction), Obstacle::edge));
    CHECK(is(lone({{20.0, 10.0}, {20.0, 10.0 + 2.0 * off}}, Edge::symmetry), Obstacle::fracture));
    CHECK(is(lone({{20.0 - off, 6.0}, {20.0 - off, 24.0}, {20.0, 24.0}, {20.0, 14.25}}, Edge::traction),
             Obstacle::fracture));
  }
}

namespace {

// J of each ring and the interactions' means over rings by particles alone, written out in the tip's frame: flux and
// weight as the equations of measure_tips() have them.
TipSums written_out(const Run& run, const TipGeometry& at) {
  const State& state = run.state;
  const Particles& p = state.particles;
  TipSums sums;
  Eigen::Matrix2d e;
  e << at.frame.e_1, at.frame.e_2;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 x{p.x[q], p.y[q]}, local = at.frame.local(x - at.frame.tip);
    const int i = state.grid.column_at(x.x()), j = state.grid.row_at(x.y());
    const auto nodes = ring_nodes(state.grid, at, i, j);
    if (!nodes) continue;
    const RingWeights weights = ring_weights(state.grid, *nodes, i, j, x);
    Eigen::Matrix2d g;
    g << p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q];
    const Eigen::Matrix2d H = e.transpose() * g * e;
    const Elasticity& rock = run.rocks[p.rock[q]];
    const Stress s = stress_of(rock, H(0, 0), H(0, 1), H(1, 0), H(1, 1));
    const auto of_strain = [&](const Stress& t) {
      return t.xx * H(0, 0) + t.yy * H(1, 1) + t.xy * (H(0, 1) + H(1, 0));
    };
    const bool above = ((p.sides[q] & state.fracture().mask()) != 0) == (at.frame.sign > 0.0);
    for (std::size_t k = 0; k < weights.size(); ++k) {
      const Vec2 grad = at.frame.local(weights[k].grad), u_1 = H.col(0);
      sums.J[k] += p.V[q] * (s.on(grad).dot(u_1) - 0.5 * of_strain(s) * grad.x());
      for (int mode = 0; mode < 2; ++mode) {
        const AuxiliaryFields aux = williams(rock, mode, local.norm(), angle_at(local, above));
        sums.I[static_cast<std::size_t>(mode)] +=
            p.V[q] * (s.on(grad).dot(aux.u_1) + aux.s.on(grad).dot(u_1) - of_strain(aux.s) * grad.x()) / 3.0;
      }
    }
  }
  return sums;
}

}  // namespace

// Requires the particles' part to be the sum written out in the tip's frame, to round-off, at both ends of a straight
// and of an inclined fracture, in rock that changes within a ring, under fields of any kind.
// Mutations that fail: the rock's own stress left out of the interaction's xx; Williams' strain energy of the other
// sign; the first ring's weight for the second; e_x for e_y in J's strain energy.
TEST_CASE("integrals are sums over particles") {
  for (const auto& path :
       std::vector<std::vector<std::array<double, 2>>>{{{10.0, 4.0}, {10.0, 16.0}}, {{5.2, 5.4}, {14.7, 13.9}}}) {
    Run run = cracked(path);
    run.scene.fracture->faces = Fracture::Faces::free;  // any field is as good as one that keeps faces apart
    Elasticity other = run.rocks[0];
    other.lambda *= 0.4, other.mu *= 0.7, other.nu = 0.5 * other.lambda / (other.lambda + other.mu);
    run.rocks.push_back(other);
    Particles& p = run.state.particles;
    for (std::size_t q = 0; q < p.size(); ++q) p.rock[q] = p.x[q] > 11.3 ? 1 : 0;
    std::vector<TipRule> rules = make_tip_rules(run.scene, run.rocks, run.state);
    for (TipRule& rule : rules) rule.faces.clear();
    for (const Intensity& K : mixes) {
      impose(run, true, K, 3e5);
      for (std::size_t q = 0; q < p.size(); ++q) p.g_xy[q] += 1e-5 * p.x[q], p.g_yy[q] -= 2e-5 * p.y[q];
      measure_tips(run.scene, run.rocks, rules, run.state);
      for (std::size_t t = 0; t < rules.size(); ++t) {
        const Tip& is = run.state.tips[t];
        const TipSums sums = written_out(run, rules[t].at);
        CAPTURE(path[0][0], t, K.K_I, is.K_I, is.K_II, is.J);
        const double size = std::hypot(is.K_I, is.K_II), half = 0.5 * rules[t].at.rock.E_prime;
        const auto [least, most] = std::minmax_element(sums.J.begin(), sums.J.end());
        const double mean = (sums.J[0] + sums.J[1] + sums.J[2]) / 3.0;
        CHECK(size > 0.0);
        CHECK(std::abs(is.K_I - half * sums.I[0]) <= 1e-12 * size);
        CHECK(std::abs(is.K_II - half * sums.I[1]) <= 1e-12 * size);
        CHECK(is.J == Approx(mean).epsilon(1e-12));
        CHECK(is.J_spread == Approx((*most - *least) / std::abs(mean)).epsilon(1e-9));
      }
    }
  }
}

// Requires that a field that is not finite is reported, not measured.
TEST_CASE("a field that is not finite throws") {
  Run run = cracked({{10.0, 4.0}, {10.0, 16.0}});
  Particles& p = run.state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    if (std::abs(p.x[q] - 10.0) < 4.0 && p.y[q] > 13.0) p.g_xx[q] = std::numeric_limits<double>::quiet_NaN();
  }
  CHECK_THROWS_AS(measure_tips(run.scene, run.rocks, run.state), NumericalFailure);
}
