#include "state/light_copies.hpp"

#include <algorithm>
#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numbers>
#include <vector>

#include "state/shape_functions.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

constexpr double p_net = 0.3e6;

// A crack of 10 m that leans by `slope` and passes x = 20 + offset at mid-height, in a block of 40 m.
Scene leaning(double slope, double offset, Numerics::Shape shape = Numerics::Shape::bspline2) {
  Scene scene = block(40, 40);
  scene.numerics.shape = shape;
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  add_fracture(scene, {{20.0 + offset - 5.0 * slope, 15.0}, {20.0 + offset + 5.0 * slope, 25.0}}, p_net);
  return scene;
}

// Stencils of points that tell the sides of a node apart, less those that do so for a node where both sides have
// particles.
int joined(const State& state) {
  int sum = 0;
  const Surface& s = state.fracture();
  for (std::size_t k = 0; k < s.points.size(); ++k) {
    const SurfaceStencil& stencil = state.point_stencils[0][k];
    for (int n = 0; n < 9; ++n) {
      const int node = state.grid.node(stencil.i + n % 3 - 1, stencil.j + n / 3 - 1);
      const int plus = record_of(state.copies, node, s.points[k].sides | s.mask());
      const int minus = record_of(state.copies, node, s.points[k].sides);
      const auto at = static_cast<std::size_t>(n);
      if (plus >= 0 && minus >= 0 && plus != minus && stencil.plus[at] == stencil.minus[at]) ++sum;
    }
  }
  return sum;
}

// Largest change of stress of a particle over the net pressure, and largest opening over the middle's in an infinite
// plane.
std::pair<double, double> stress_and_opening(double slope, double offset) {
  Statics statics(leaning(slope, offset));
  press(statics.state(), Surface::Kind::fracture, p_net);
  statics.solve();
  const Elasticity& rock = statics.run.rocks[0];
  const Particles& p = statics.state().particles;
  double stress = 0.0, opening = 0.0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Stress s = stress_of(rock, p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
    stress = std::max({stress, std::abs(s.xx), std::abs(s.yy), std::abs(s.xy)});
  }
  for (const SurfacePoint& s : statics.state().fracture().points) opening = std::max(opening, s.opening());
  const double a = 5.0 * std::hypot(1.0, slope);
  return {stress / p_net, opening / (4.0 * p_net * a / rock.E_prime)};
}

}  // namespace

TEST_CASE("a fracture that passes a column of particles at a small angle loads no copy beyond what its rock can bear") {
  // Without it: 100 times the pressure as stress, 30 times the opening at (0.03, 0.375).
  const auto [slope, offset] =
      GENERATE(table<double, double>({{0.1, 0.2}, {0.1, 0.3}, {0.1, 0.5}, {0.2, 0.4}, {0.03, 0.375}}));
  CAPTURE(slope, offset);
  const auto [stress, opening] = stress_and_opening(slope, offset);
  CHECK(stress > 1.0);
  CHECK(stress < 3.0);
  CHECK(opening == Approx(1.08997).epsilon(0.004));  // strata-reference block_crack: 40 m block, a = 5 m
}

TEST_CASE("a straight fracture along the grid keeps all that it parts") {
  const double offset = GENERATE(0.0, 0.1, 0.2, 0.249, 0.3, 0.374, 0.45, 0.5);
  const auto shape = GENERATE(Numerics::Shape::bspline2, Numerics::Shape::linear);
  // Nearer than the first particles to where hat functions end there is no copy worth anything to be kept.
  if (shape == Numerics::Shape::linear && offset == 0.1) return;
  CAPTURE(offset, static_cast<int>(shape));
  CHECK(joined(Run(leaning(0.0, offset, shape)).state) == 0);
}

namespace {

// Master of a node's copy on some sides, -1 where it has no particles.
int master_at(const State& state, int node, SideWord sides) {
  const int record = record_of(state.copies, node, sides);
  return record < 0 ? -1 : state.masters[static_cast<std::size_t>(record)].record;
}

// Which of a surface's copies are light, by sums of their own over its points and over all particles.
std::vector<bool> light_copies(const Run& run, std::size_t surface) {
  const State& state = run.state;
  const Surface& s = state.surfaces[surface];
  const Particles& p = state.particles;
  std::vector<double> worth(state.masters.size(), 0.0), reached(state.masters.size(), 0.0);
  for (const Bin& bin : state.bins) {
    for (int q = bin.first; q < bin.last; q += bin.stride) {
      const auto k = static_cast<std::size_t>(q);
      const Gradients g = gradients_at(run.scene, state.grid, bin.i, bin.j, {p.x[k], p.y[k]}, p.half(k));
      for (std::size_t n = 0; n < 9; ++n) {
        const auto record = static_cast<std::size_t>(bin.record[n]);
        worth[static_cast<std::size_t>(state.masters[record].record)] +=
            p.V[k] * std::sqrt(g.N_x[n] * g.N_x[n] + g.N_y[n] * g.N_y[n]);
      }
    }
  }
  for (std::size_t k = 0; k < s.points.size(); ++k) {
    const SurfaceStencil& stencil = state.point_stencils[surface][k];
    const Gradients g = gradients_at(run.scene, state.grid, stencil.i, stencil.j, s.points[k].x, Vec2::Zero());
    for (int n = 0; n < 9 && s.points[k].split; ++n) {
      const int node = state.grid.node(stencil.i + n % 3 - 1, stencil.j + n / 3 - 1);
      const int plus = master_at(state, node, s.points[k].sides | s.mask());
      const int minus = master_at(state, node, s.points[k].sides & ~s.mask());
      if (plus < 0 || minus < 0 || plus == minus) continue;
      for (const int record : {plus, minus})
        reached[static_cast<std::size_t>(record)] += s.points[k].A * g.N[static_cast<std::size_t>(n)];
    }
  }
  std::vector<bool> light(worth.size(), false);
  for (std::size_t r = 0; r < light.size(); ++r)
    light[r] = reached[r] > (reached[r] < state.grid.h / 128.0 ? 1.0 : 2.5) * worth[r];
  return light;
}

// Requires of a surface that no stencil of a point or vertex tells light copies apart; returns how many would.
std::size_t check_no_light_copies(const Run& run, std::size_t surface) {
  const std::vector<bool> light = light_copies(run, surface);
  std::size_t wrong = 0;
  for (const auto* stencils : {&run.state.point_stencils[surface], &run.state.vertex_stencils[surface]}) {
    for (const SurfaceStencil& stencil : *stencils) {
      for (std::size_t n = 0; n < 9; ++n) {
        for (const int record : {stencil.plus[n], stencil.minus[n]}) {
          if (stencil.plus[n] == stencil.minus[n]) continue;
          if (light[static_cast<std::size_t>(run.state.masters[static_cast<std::size_t>(record)].record)]) ++wrong;
        }
      }
    }
  }
  CHECK(wrong == 0);
  return static_cast<std::size_t>(std::count(light.begin(), light.end(), true));
}

}  // namespace

// Mutations that fail: either bound left out, either side or the stencils of vertices left as they were, |dN/dx| alone.
TEST_CASE("copies that bear more than they are worth are joined at all places, whichever side they are on") {
  const double slope = GENERATE(0.03, 0.1, -0.1, 0.2, 0.45);
  std::size_t light = 0;
  int apart = 0;
  for (const double offset : {0.0, 0.1, 0.2, 0.3, 0.375, 0.4, 0.5}) {
    CAPTURE(slope, offset);
    const Run run(leaning(slope, offset));
    light += check_no_light_copies(run, 0);
    apart += joined(run.state);
  }
  CHECK(light > 0);
  CHECK(apart > 0);
}

namespace {

// A crack of 12 m whose middle is on an interface with springs (Pa/m), at an angle to it (degrees), in a block of 40 m.
Scene through_springs(double degrees, double D) {
  Scene scene = block(40, 40);
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  add_interface(scene, soft_law(D, D, InterfaceLaw::Compression::spring), 20.0);
  const double angle = degrees * std::numbers::pi / 180.0, dx = 6.0 * std::cos(angle), dy = 6.0 * std::sin(angle);
  add_fracture(scene, {{20.0 - dx, 20.0 - dy}, {20.0 + dx, 20.0 + dy}}, p_net);
  return scene;
}

// Mean of K_I of both tips.
double K_I(const Scene& scene) {
  Statics statics(scene);
  press(statics.state(), Surface::Kind::fracture, p_net);
  statics.solve();
  return 0.5 * (statics.state().tips[0].K_I + statics.state().tips[1].K_I);
}

std::size_t joined_corners(const State& state) {
  std::size_t sum = 0;
  for (const CutNode& cut : state.copies.cut) sum += cut.joined.size();
  return sum;
}

}  // namespace

TEST_CASE("a crack through stiff springs at an angle is no mechanism, and K_I is that without them") {
  const double degrees = GENERATE(45.0, 30.0, 135.0);
  CAPTURE(degrees);
  Scene bonded = through_springs(degrees, 1e13);
  bonded.strata.interfaces[0].law = 0;  // perfect
  const double K = K_I(bonded);
  CHECK(K == Approx(p_net * std::sqrt(6.0 * std::numbers::pi)).epsilon(0.15));
  CHECK(K_I(through_springs(degrees, 1e13)) == Approx(K).epsilon(0.01));
  CHECK(joined_corners(Run(through_springs(degrees, 1e13)).state) > 0);
}

// Requires just those corners to be joined that have less than 1/128 of their node's rock, each with the largest one of
// those that an interface alone parts from it, where that is larger. Mutations that fail: 0.3 or 1e-9 instead of 1/128,
// the smallest one, none where both are so small.
TEST_CASE("corners with hardly any rock are joined with the largest one beside them") {
  const double degrees = GENERATE(10.0, 20.0, 25.0, 30.0, 45.0, 70.0, 110.0, 160.0);
  const double second = GENERATE(0.0, 20.5, 21.0);
  Scene scene = through_springs(degrees, 1e9);
  if (second > 0.0)
    add_interface(scene, scene.laws.back(), second);  // nodes that both part have more than one corner beside
  const Run run(scene);
  CAPTURE(degrees, second);
  const State& state = run.state;
  const Particles& p = state.particles;
  std::map<int, std::map<SideWord, double>> worth;  // of the corners of each cut node
  for (std::size_t q = 0; q < p.size(); ++q) {
    const int i = state.grid.column_at(p.x[q]), j = state.grid.row_at(p.y[q]);
    const Gradients g = gradients_at(run.scene, state.grid, i, j, {p.x[q], p.y[q]}, p.half(q));
    for (int n = 0; n < 9; ++n) {
      const auto node = static_cast<std::size_t>(state.grid.node(i + n % 3 - 1, j + n / 3 - 1));
      const int c = state.copies.cut_of_node[node];
      if (c < 0) continue;
      CutNode cut = state.copies.cut[static_cast<std::size_t>(c)];
      cut.joined.clear();
      const auto at = static_cast<std::size_t>(n);
      worth[c][cut.key(p.sides[q])] += p.V[q] * std::hypot(g.N_x[at], g.N_y[at]);
    }
  }
  std::size_t wrong = 0, small = 0;
  for (const auto& [c, corners] : worth) {
    const CutNode& cut = state.copies.cut[static_cast<std::size_t>(c)];
    std::map<SideWord, SideWord> expected;
    double all = 0.0;
    for (const auto& [key, own] : corners) all += own;
    for (const auto& [key, own] : corners) {
      if (cut.fracture == 0 || corners.size() < 3 || own >= all / 128.0) continue;
      double most = own;
      for (const auto& [other, its] : corners) {
        if (std::popcount(key ^ other) == 1 && (key ^ other) != cut.fracture && its > most)
          expected[key] = other, most = its;
      }
    }
    std::map<SideWord, SideWord> found;
    for (const auto& [from, into] : cut.joined) found[from] = into;
    if (found != expected) ++wrong;
    small += found.size();
  }
  CHECK(wrong == 0);
  if (degrees < 70.0) CHECK(small > 0);
}

TEST_CASE("where a fracture along the grid crosses an interface all corners stay") {
  const Run run(through_springs(90.0, 1e9));
  CHECK(joined_corners(run.state) == 0);
}

TEST_CASE("springs of an interface pull at no light copies where a crack crosses it") {
  const double degrees = GENERATE(20.0, 30.0, 45.0, 60.0);
  CAPTURE(degrees);
  const Run run(through_springs(degrees, 1e9));
  const std::size_t light = check_no_light_copies(run, 0) + check_no_light_copies(run, 1);
  if (degrees != 45.0) CHECK(light > 0);  // there all light ones are corners that have joined
}

TEST_CASE("a layer of one or half a cell between two interfaces is held by its springs") {
  const double thickness = GENERATE(0.5, 1.0);
  Scene scene = block(4, 8);
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  hold_edges(scene);
  add_interface(scene, soft_law(1e9, 1e9, InterfaceLaw::Compression::spring), 4.0);
  add_interface(scene, soft_law(1e9, 1e9, InterfaceLaw::Compression::spring), 4.0 + thickness);
  Statics statics(scene);
  press(statics.state(), Surface::Kind::interface, 0.0);
  REQUIRE_NOTHROW(statics.solve());
  CHECK(statics.state().particles.size() == 4 * 8 * 16);
  CHECK(Run(block(4, 8)).state.particles.size() == 4 * 8 * 4);
}
