// Graded grids: which cells they have, the shape functions on them, and where their particles are.
#include <catch2/catch.hpp>

#include <numeric>
#include <random>

#include "fracture/growth.hpp"
#include "scene/graded_cells.hpp"
#include "small_scenes.hpp"
#include "state/grid.hpp"
#include "state/shape_functions.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// Lengths of the spans of the nodes 0 ... n of an axis.
std::vector<double> spans_of(const std::vector<double>& t) {
  std::vector<double> s;
  for (std::size_t k = 1; k + 2 < t.size(); ++k) s.push_back(t[k + 1] - t[k]);
  return s;
}

// Sum of N and of a derivative over a graded axis at one place, with the positions and with their squares.
struct AxisMoments {
  double N = 0.0, x = 0.0, dN = 0.0, dx = 0.0;
};

template <class Shape>
AxisMoments axis_moments(const Grid& g, double x) {
  const int i = g.column_at(x);
  const Weights w = weights_along<Shape>(g.x_knots, g.h, i, x, 0.0);
  AxisMoments sum;
  for (int a = 0; a < 3; ++a) {
    const auto k = static_cast<std::size_t>(a);
    sum.N += w.N[k], sum.x += w.N[k] * g.x(i + a - 1);
    sum.dN += w.dN[k] / g.span_x(i), sum.dx += w.dN[k] / g.span_x(i) * g.x(i + a - 1);
  }
  return sum;
}

// Value (or derivative per m) of the function of the node in column c at x.
template <class Shape>
double function_of(const Grid& g, int c, double x, bool derivative) {
  const int i = std::clamp(g.column_at(x), 0, g.nx);
  if (std::abs(i - c) > 1) return 0.0;
  const Weights w = weights_along<Shape>(g.x_knots, g.h, i, x, 0.0);
  const auto k = static_cast<std::size_t>(c - i + 1);
  return derivative ? w.dN[k] / g.span_x(i) : w.N[k];
}

}  // namespace

// Requires of many axes that nodes stand on both edges, spans fill the block, no span is more than 1.2 times a
// neighbour, none is longer than far or shorter than h, all those of the fine stretches are h with nodes at multiples
// of h, and the ghosts' are those they mirror. Mutations that fail: the half span at the edge counted whole; growth
// 1.25; far without bound; the stretch rounded inwards.
TEST_CASE("growing cells fill the block") {
  const std::vector<std::vector<Stretch>> cases{{},
                                                {{30.0, 42.0}},
                                                {{0.0, 15.0}},
                                                {{61.0, 80.0}},
                                                {{1.0, 12.0}},
                                                {{10.3, 20.1}, {24.0, 30.0}, {70.0, 78.0}},
                                                {{10.0, 20.0}, {21.0, 30.0}},
                                                {{10.0, 20.0}, {50.0, 60.0}},
                                                {{0.0, 80.0}},
                                                {{39.0, 41.0}, {43.0, 44.0}}};
  for (const double h : {1.0, 0.5, 0.1}) {
    for (const double far : {1.1 * h, 2.0 * h, 5.0 * h, 40.0 * h}) {
      for (const auto& fine : cases) {
        const std::vector<double> t = graded_knots({80.0, h, far, fine}), s = spans_of(t);
        CAPTURE(h, far, fine.size(), s.size());
        CHECK(t[1] == -t[2]);
        CHECK(0.5 * (t[t.size() - 3] + t[t.size() - 2]) == Approx(80.0).epsilon(1e-15));
        CHECK(std::accumulate(s.begin(), s.end(), 0.0) - 0.5 * (s.front() + s.back()) == Approx(80.0).epsilon(1e-14));
        for (std::size_t k = 0; k + 1 < s.size(); ++k) {
          CHECK(std::max(s[k] / s[k + 1], s[k + 1] / s[k]) < 1.2 * (1.0 + 1e-9));
          CHECK(s[k] < far * (1.0 + 1e-9));
          CHECK(s[k] > h * (1.0 - 1e-9));
        }
        for (std::size_t k = 0; k < s.size(); ++k) {
          const double x = 0.5 * (t[k + 1] + t[k + 2]);
          for (const Stretch& f : fine) {
            if (x < f.from || x > f.to) continue;
            CHECK(s[k] == Approx(h).epsilon(1e-11));
            CHECK(std::abs(x / h - std::round(x / h)) < 1e-9);
          }
        }
        CHECK(t[1] - t[0] == Approx(s[1]).epsilon(1e-12));
        CHECK(t[t.size() - 1] - t[t.size() - 2] == Approx(s[s.size() - 2]).epsilon(1e-12));
      }
    }
  }
}

// Requires of axes whose rock goes on beyond the block that nodes stand where it ends, spans fill it, within the block
// none is more than 1.2 times a neighbour or longer than far, beyond it none more than 1.5 times and never shorter than
// the one before, the fine ones are untouched, and the last is long: their number is that
// of a geometric series.
TEST_CASE("cells grow on beyond the block") {
  for (const double h : {1.0, 0.5}) {
    for (const double far : {h, 5.0 * h}) {
      for (const auto& fine : std::vector<std::vector<Stretch>>{{{0.0, 80.0}}, {{30.0, 42.0}}, {{0.0, 15.0}}}) {
        for (const double beyond : {2.0 * far, 40.0, 1600.0}) {
          for (const double below : {0.0, beyond}) {
            const std::vector<double> t = graded_knots({80.0, h, far, fine, below, beyond}), s = spans_of(t);
            CAPTURE(h, far, beyond, below, s.size());
            CHECK(t[1] + t[2] == Approx(-2.0 * below).epsilon(1e-12));
            CHECK(0.5 * (t[t.size() - 3] + t[t.size() - 2]) == Approx(80.0 + beyond).epsilon(1e-14));
            std::size_t past = 0;
            for (std::size_t k = 0; k + 1 < s.size(); ++k) {
              const double x = t[k + 2];  // between spans k and k + 1
              const double ratio = x > 40.0 ? s[k + 1] / s[k] : s[k] / s[k + 1];
              const bool within = x > -0.4 * h && x < 80.0 + 0.4 * h;
              CHECK(std::max(ratio, 1.0 / ratio) < (within ? 1.2 : 1.5) * (1.0 + 1e-9));
              if (within) CHECK(s[k] < far * (1.0 + 1e-9));
              if (!within) CHECK(ratio > 1.0 - 1e-9);
              past += x > 80.0 + 0.4 * h ? 1 : 0;
            }
            CHECK(static_cast<double>(past) < 2.0 + std::log1p(beyond * 0.5 / (1.5 * h)) / std::log(1.5));
            for (std::size_t k = 0; k < s.size(); ++k) {
              const double x = 0.5 * (t[k + 1] + t[k + 2]);
              for (const Stretch& f : fine) {
                if (x >= f.from && x <= f.to) CHECK(s[k] == Approx(h).epsilon(1e-11));
              }
            }
          }
        }
      }
    }
  }
}

// Requires that far cells are reached and save what they are for: 80 m with 12 m of fine cells of 0.5 m and far ones
// of 5 m take less than 0.4 of the uniform grid's 160 cells, and the longest span is of 5 m within a tenth.
TEST_CASE("cells become as long as asked for") {
  const std::vector<double> s = spans_of(graded_knots({80.0, 0.5, 5.0, {{34.0, 46.0}}}));
  CHECK(s.size() < 64);
  CHECK(*std::max_element(s.begin(), s.end()) > 4.5);
}

using Ends = std::vector<double>;

// Both ends of each fine stretch (m).
Ends stretches(const Scene& scene, std::size_t axis) {
  Ends ends;
  for (const Stretch& s : fine_stretches(scene, axis)) ends.insert(ends.end(), {s.from, s.to});
  return ends;
}

// Requires where the fine cells are: 10 cells around the fracture and its straight way to stop.tip_y_m, with every
// interface on it; to the edge without one; the initial fracture alone where nothing grows; mirrored for two tips; 4
// cells around interfaces and borders elsewhere, none where neither law nor rock changes.
TEST_CASE("fine cells where the scene needs them") {
  Scene scene = block(200, 200, 0.5);
  scene.domain.bottom = Edge::symmetry;
  add_fracture(scene, {{40.0, 0.0}, {40.0, 5.0}});
  CHECK(stretches(scene, 0) == Ends{35.0, 45.0});
  CHECK(stretches(scene, 1) == Ends{0.0, 10.0});
  scene.fracture->growth = Fracture::Growth::J;
  CHECK(stretches(scene, 1) == Ends{0.0, 100.0});
  scene.stop.tip_y_m = 20.0;
  CHECK(stretches(scene, 1) == Ends{0.0, 25.0});
  add_interface(scene, friction_law(0.6), 15.0);
  CHECK(stretches(scene, 1) == Ends{0.0, 25.0});
  add_interface(scene, friction_law(0.6), 60.0);
  CHECK(stretches(scene, 1) == Ends{0.0, 25.0, 58.0, 62.0});
  CHECK(stretches(scene, 0) == Ends{35.0, 45.0});
  scene.laws.back().kind = InterfaceLaw::Kind::perfect;
  CHECK(stretches(scene, 1) == Ends{0.0, 25.0});
  scene.rocks.push_back({"soft", 2e9, 0.3, 2000.0, 1e6});
  scene.strata.layers.back().rock = 1;
  CHECK(stretches(scene, 1) == Ends{0.0, 25.0, 58.0, 62.0});
  scene.strata.along = Strata::Along::x;
  CHECK(stretches(scene, 0) == Ends{13.0, 17.0, 35.0, 45.0, 58.0, 62.0});
  CHECK(stretches(scene, 1) == Ends{0.0, 25.0});
  scene.domain.bottom = Edge::traction;
  scene.strata.along = Strata::Along::y;
  scene.fracture->path_m = {{40.0, 38.0}, {40.0, 42.0}};
  scene.stop.tip_y_m = 48.0;
  CHECK(stretches(scene, 1) == Ends{13.0, 17.0, 27.0, 53.0, 58.0, 62.0});
}

// Requires that a scene's own ends of the fine cells around its fracture take the place of those by its straight way,
// each alone, and leave those of interfaces. Mutations that fail: an end of the other axis, or of the other side.
TEST_CASE("a scene says itself where fine cells end") {
  Scene scene = block(80, 80);
  scene.domain.bottom = Edge::symmetry;
  add_fracture(scene, {{40.0, 0.0}, {40.0, 5.0}}, 2.4e6);
  scene.fracture->growth = Fracture::Growth::J;
  scene.stop.tip_y_m = 60.0;
  const Ends x = stretches(scene, 0), y = stretches(scene, 1);
  REQUIRE(x == Ends{30.0, 50.0});
  REQUIRE(y == Ends{0.0, 70.0});
  scene.numerics.fine_right_m = 80.0;
  scene.numerics.fine_top_m = 40.0;
  CHECK(stretches(scene, 0) == Ends{30.0, 80.0});
  CHECK(stretches(scene, 1) == Ends{0.0, 40.0});
  scene.numerics.fine_left_m = 20.0;
  scene.numerics.fine_bottom_m = 3.0;
  CHECK(stretches(scene, 0) == Ends{20.0, 80.0});
  CHECK(stretches(scene, 1) == Ends{3.0, 40.0});
  add_interface(scene, friction_law(0.6), 60.0);
  CHECK(stretches(scene, 1) == Ends{3.0, 40.0, 56.0, 64.0});
}

// Requires that a scene counts as mirror-symmetric exactly where the columns of its grid are their own mirror image:
// random ends of the fine cells on either side of a fracture in the middle, alike or not, with rock beyond the block or
// not. Mutation that fails: columns not looked at.
TEST_CASE("a scene is symmetric where its columns are") {
  std::mt19937 random(7);
  std::array<int, 2> found{};
  for (int trial = 0; trial < 200; ++trial) {
    Scene scene = graded_block(60, 50);
    scene.domain.sides = Edge::fixed;
    scene.fracture->path_m = {{30.0, 24.0}, {30.0, 26.0}};
    if (trial % 2 == 0) scene.domain.beyond_m = 40.0;
    const auto cells = [&] { return 0.25 * static_cast<double>(1 + random() % 116); };
    const double left = cells(), right = random() % 2 == 0 ? left : cells();
    if (random() % 8 != 0) scene.numerics.fine_left_m = 30.0 - left;
    if (random() % 8 != 0) scene.numerics.fine_right_m = 30.0 + right;
    const Grid g = make_grid(scene);
    bool mirrored = true;
    for (int i = -1; i <= g.nx + 1; ++i) mirrored = mirrored && std::abs(g.x(i) + g.x(g.nx - i) - 60.0) < 1e-9;
    CAPTURE(trial, left, right);
    CHECK(mirror_symmetric(scene) == mirrored);
    ++found[mirrored ? 1 : 0];
  }
  CHECK(found[0] > 50);
  CHECK(found[1] > 50);
}

// Requires that a scene without far_cell_m, or with one of cell_m, has today's uniform grid, and that a grid graded
// around a fracture in the middle of the block, on a grid line or at mid-cell, is its own mirror image to 1e-12.
TEST_CASE("which grid a scene has") {
  Scene scene = graded_block();
  for (const double x : {30.0, 29.5}) {
    if (x < 30.0) scene.domain.width_m = 59.0;
    scene.fracture->path_m = {{x, 24.0}, {x, 26.0}};
    const Grid g = make_grid(scene);
    CHECK(g.nx < 45);
    for (int i = -1; i <= g.nx + 1; ++i) CHECK(g.x(i) + g.x(g.nx - i) == Approx(2.0 * x).epsilon(1e-12));
  }
  scene.numerics.far_cell_m = 1.0;
  CHECK(make_grid(scene).x_knots.empty());
  scene.numerics.far_cell_m.reset();
  CHECK(make_grid(scene).y_knots.empty());
  CHECK(make_grid(scene).nx == 59);
}

// Requires that a place is looked up in the span that holds it, ghosts' included, and that fine_around() tells where
// all spans are fine. Mutation that fails: a lookup off by one.
TEST_CASE("places are found in their spans") {
  const Grid g = make_grid(graded_block());
  for (int i = -1; i <= g.nx + 1; ++i) {
    for (const double f : {-0.499, 0.0, 0.499}) CHECK(g.column_at(g.x(i) + f * g.span_x(i)) == i);
  }
  for (int j = 0; j <= g.ny; ++j) CHECK(g.row_at(g.y(j) + 0.49 * g.span_y(j)) == j);
  for (int i = 0; i <= g.nx; ++i) {
    for (int guess = 0; guess <= g.nx; ++guess)
      CHECK(g.column_at(g.x(i) - 0.49 * g.span_x(i), guess) + g.column_at(g.x(i) + 0.49 * g.span_x(i), guess) == 2 * i);
  }
  CHECK(g.row_at(g.y(-1), 0) == -1);
  CHECK(g.fine_around(20.0, 25.0, 10.0));
  CHECK_FALSE(g.fine_around(20.0, 25.0, 12.0));
  CHECK_FALSE(g.fine_around(28.0, 25.0, 4.0));
}

// Requires of both shapes on a graded axis that N sums up to 1 and reproduces x to 1e-14 of the block's length, and
// their derivatives 0 and 1, at 3000 places across all spans. Mutations that fail: a span before and after exchanged;
// 2 left out of a derivative; the middle function without one of the others.
TEMPLATE_TEST_CASE("graded weights reproduce constants and linear fields", "", QuadraticBspline, Linear) {
  const Grid g = make_grid(graded_block());
  for (int k = 0; k < 3000; ++k) {
    const AxisMoments sum = axis_moments<TestType>(g, 60.0 * (k + 0.5) / 3000.0);
    CHECK(sum.N == Approx(1.0).epsilon(1e-14));
    CHECK(sum.x == Approx(60.0 * (k + 0.5) / 3000.0).margin(60.0 * 1e-14));
    CHECK(sum.dN == Approx(0.0).margin(1e-14));
    CHECK(sum.dx == Approx(1.0).epsilon(1e-13));
  }
}

// Requires that the derivative of each function is that of its values, by central differences, to 1e-8 away from
// corners, and that values are continuous everywhere (so are derivatives of the B-spline): a function is one function
// across the spans it lives on.
TEMPLATE_TEST_CASE("graded functions and their derivatives", "", QuadraticBspline, Linear) {
  const Grid g = make_grid(graded_block());
  const bool spline = std::is_same_v<TestType, QuadraticBspline>;
  constexpr double d = 1e-6;
  for (int c = 0; c <= g.nx; ++c) {
    for (int i = std::max(0, c - 1); i <= std::min(g.nx, c + 1); ++i) {
      for (const double f : {-0.41, -0.13, 0.27, 0.44}) {
        const double x = g.x(i) + f * g.span_x(i);
        const double difference =
            (function_of<TestType>(g, c, x + d, false) - function_of<TestType>(g, c, x - d, false)) / (2.0 * d);
        CHECK(function_of<TestType>(g, c, x, true) == Approx(difference).margin(1e-8));
      }
    }
    for (std::size_t k = 1; k < g.x_knots.size() - 1; ++k) {
      const double t = g.x_knots[k];
      if (t < 0.0 || t > 60.0) continue;
      for (const bool derivative : {false, true}) {
        const double below = function_of<TestType>(g, c, t - 1e-12, derivative);
        CHECK(function_of<TestType>(g, c, t + 1e-12, derivative) ==
              Approx(below).margin(!derivative || spline ? 1e-10 : 1e9));
      }
    }
  }
}

// Requires that the weights of three equal spans are those of the uniform grid to round-off.
TEMPLATE_TEST_CASE("graded weights of equal spans are uniform ones", "", QuadraticBspline, Linear) {
  for (const double f : {-0.5, -0.3, 0.0, 0.2, 0.5}) {
    const Weights uniform = uniform_weights<TestType>(f, 0.0), graded = graded_weights<TestType>(f, 1.0, 1.0, 0.0);
    for (std::size_t a = 0; a < 3; ++a) {
      CHECK(graded.N[a] == Approx(uniform.N[a]).margin(1e-15));
      CHECK(graded.dN[a] == Approx(uniform.dN[a]).margin(1e-15));
    }
  }
}

// Requires that the lattice of particles is today's where the grid is uniform, to the last digit for the spans' rule
// too, and that the particles fill a graded block: sum V to 1e-13, all of them inside, as many as cells ask for.
TEST_CASE("particles of a graded grid") {
  for (const int points : {4, 16}) {
    Scene scene = graded_block();
    scene.numerics.particles_per_cell = points;
    const Run run(scene);
    const Particles& p = run.state.particles;
    CHECK(p.size() == static_cast<std::size_t>(points * run.state.grid.nx * run.state.grid.ny));
    CHECK(std::accumulate(p.V.begin(), p.V.end(), 0.0) == Approx(60.0 * 50.0).epsilon(1e-13));
    CHECK(std::accumulate(p.m.begin(), p.m.end(), 0.0) == Approx(2500.0 * 60.0 * 50.0).epsilon(1e-13));
    CHECK(*std::min_element(p.x.begin(), p.x.end()) > 0.0);
    CHECK(*std::max_element(p.y.begin(), p.y.end()) < 50.0);
    const int across = points == 4 ? 2 : 4;
    Grid even{6, 6, 0.5}, same = even;
    for (int k = -1; k <= 8; ++k) same.x_knots.push_back((k - 0.5) * 0.5);
    const auto lattice = points_along(even, Axis::x, across), by_spans = points_along(same, Axis::x, across);
    REQUIRE(lattice.size() == by_spans.size());
    for (std::size_t k = 0; k < lattice.size(); ++k) {
      CHECK(lattice[k].at == by_spans[k].at);
      CHECK(lattice[k].length == by_spans[k].length);
    }
  }
}

// Requires that a tip that turns off its straight way stops 5 cells before the coarse ones and says so, and does not on
// a uniform grid. J and K are set by hand.
TEST_CASE("a tip stops before coarse cells") {
  for (const bool graded : {true, false}) {
    Scene scene = graded_block();
    if (!graded) scene.numerics.far_cell_m.reset();
    scene.fracture->path_m = {{20.0, 24.0}, {22.0, 26.0}};
    scene.fracture->growth = Fracture::Growth::J;
    scene.stop.tip_y_m = 26.5;
    scene.fracture->direction = Fracture::Direction::max_hoop;
    Run run(scene);
    Tip& tip = run.state.tips.back();
    tip.turn = -0.25 * std::acos(-1.0);
    run.state.tips.front().growing = false;
    for (int k = 0; k < 20; ++k) {
      tip.J = tip.K_I = 1e9;
      run.state.time += 1.0;
      grow(run.scene, run.rocks, run.state);
      tip.turn = 0.0;
    }
    const Vec2 at = tip_position(run.state, tip);
    CAPTURE(graded, at.x());
    CHECK(at.y() == Approx(26.0));
    CHECK((tip.stopped_by.find("coarser") != std::string::npos) == graded);
    CHECK(run.state.grid.fine_around(at.x() - 1.0, at.y(), 5.0));
    if (graded) CHECK_FALSE(run.state.grid.fine_around(at.x(), at.y(), 5.0));
  }
}
