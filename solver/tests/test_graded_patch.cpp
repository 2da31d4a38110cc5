// Uniform stress on graded grids: in equilibrium with loaded edges and along interfaces.
#include <catch2/catch.hpp>

#include "interfaces/surface_tractions.hpp"
#include "small_scenes.hpp"
#include "state/grid.hpp"
#include "state/shape_functions.hpp"

using namespace strata;
using namespace strata::test;

namespace {

constexpr std::array fixed_shapes{Numerics::Shape::bspline2, Numerics::Shape::linear};

// sum_p V_p of N and its derivatives with the scene's shape, node by node.
struct NodalIntegrals {
  std::vector<double> N, N_x, N_y;
};

NodalIntegrals integrals(const Scene& scene, const State& state) {
  const Grid& g = state.grid;
  const Particles& p = state.particles;
  const auto n = static_cast<std::size_t>(g.nodes());
  NodalIntegrals sum{std::vector<double>(n), std::vector<double>(n), std::vector<double>(n)};
  for (std::size_t q = 0; q < p.size(); ++q) {
    const int i = g.column_at(p.x[q]), j = g.row_at(p.y[q]);
    const Gradients at = gradients_at(scene, g, i, j, {p.x[q], p.y[q]}, p.half(q));
    for (int k = 0; k < 9; ++k) {
      const auto node = static_cast<std::size_t>(g.node(i + k % 3 - 1, j + k / 3 - 1));
      const auto a = static_cast<std::size_t>(k);
      sum.N[node] += p.V[q] * at.N[a], sum.N_x[node] += p.V[q] * at.N_x[a], sum.N_y[node] += p.V[q] * at.N_y[a];
    }
  }
  return sum;
}

// Integral of N over the edges, by the points along them, with the outward normal: what sum_p V_p grad N_i has to be.
NodalIntegrals edge_integrals(const Scene& scene, const State& state) {
  const Grid& g = state.grid;
  const auto n = static_cast<std::size_t>(g.nodes());
  NodalIntegrals sum{{}, std::vector<double>(n), std::vector<double>(n)};
  const int across = static_cast<int>(std::lround(std::sqrt(scene.numerics.particles_per_cell)));
  const auto add = [&](const Vec2& x, double length, std::vector<double>& to) {
    const int i = std::min(g.column_at(x.x()), g.nx), j = std::min(g.row_at(x.y()), g.ny);
    const Gradients at = gradients_at(scene, g, i, j, x, Vec2::Constant(0.1));
    for (int k = 0; k < 9; ++k)
      to[static_cast<std::size_t>(g.node(i + k % 3 - 1, j + k / 3 - 1))] += length * at.N[static_cast<std::size_t>(k)];
  };
  for (const GridPoint& s : points_along(g, Axis::y, across)) {
    add({0.0, s.at}, -s.length, sum.N_x);
    add({scene.domain.width_m, s.at}, s.length, sum.N_x);
  }
  for (const GridPoint& s : points_along(g, Axis::x, across)) {
    add({s.at, 0.0}, -s.length, sum.N_y);
    add({s.at, scene.domain.height_m}, s.length, sum.N_y);
  }
  return sum;
}

// Largest relative difference between the particles' in-situ stress and -(sh, sv).
double loaded_error(Scene scene) {
  scene.in_situ = {3e6, 2e6, InSitu::Initialise::loaded};
  const Run run(scene);
  double most = 0.0;
  for (const Stress& s : run.state.particles.in_situ)
    most = std::max({most, std::abs(s.xx + 2e6), std::abs(s.yy + 3e6), std::abs(s.xy)});
  return most / 3e6;
}

}  // namespace

// Requires the patch test on a graded grid: sum_p V_p grad N_i is 0 at nodes inside and the integral of N_i along the
// edges at theirs, to 1e-12 of the block's length, for both shapes with 4 and 16 points a cell. Mutation that fails:
// points at quarters of cells instead of quarters of spans.
TEST_CASE("graded patch test") {
  for (const auto shape : fixed_shapes) {
    for (const int points : {4, 16}) {
      Scene scene = graded_block();
      scene.numerics.shape = shape;
      scene.numerics.particles_per_cell = points;
      const Run run(scene);
      const NodalIntegrals sum = integrals(scene, run.state), edge = edge_integrals(scene, run.state);
      const Grid& g = run.state.grid;
      double inside = 0.0, all = 0.0, at_edges = 0.0;
      for (std::size_t k = 0; k < sum.N_x.size(); ++k) {
        const int i = g.column(static_cast<int>(k)), j = g.row(static_cast<int>(k));
        const double most = std::max(std::abs(sum.N_x[k]), std::abs(sum.N_y[k]));
        if (i > 1 && i < g.nx - 1 && j > 1 && j < g.ny - 1) inside = std::max(inside, most);
        all = std::max({all, std::abs(sum.N_x[k] - edge.N_x[k]), std::abs(sum.N_y[k] - edge.N_y[k])});
        at_edges = std::max(at_edges, most);
      }
      CAPTURE(static_cast<int>(shape), points);
      CHECK(inside < 1e-12 * 60.0);
      CHECK(all < 1e-12 * 60.0);
      CHECK(at_edges > 1.0);
    }
  }
}

// Requires that the loaded in-situ state of one rock is uniform, to 1e-9 on a graded and on a uniform grid, all
// shapes, 4 and 16 points a cell, with the bottom loaded or a symmetry line, with and without rock beyond the block.
// Mutations that fail: edges loaded at two
// points a cell with 16 (16 %), at quarters of cells where they are graded (1e-3).
TEST_CASE("loaded in-situ stress of one rock is uniform") {
  for (const auto shape : shapes) {
    for (const int points : {4, 16}) {
      for (const bool graded : {true, false}) {
        Scene scene = graded_block(40, 36, 4.0);
        scene.domain.bottom = points == 4 ? Edge::symmetry : Edge::traction;
        if (!graded) scene.numerics.far_cell_m.reset();
        scene.numerics.shape = shape;
        scene.numerics.particles_per_cell = points;
        for (const double beyond : {0.0, 12.0, 200.0}) {
          scene.domain.beyond_m = beyond;
          CAPTURE(static_cast<int>(shape), points, graded, beyond);
          CHECK(loaded_error(scene) < 1e-9);
        }
      }
    }
  }
}

// Requires that layers side by side share the vertical load by stiffness: both have the same strain e_yy,
// s_yy = -E' e + nu/(1 - nu) s_xx with s_xx = -sh, and sum s_yy thickness = -sv W. In the middle of a high block, 3
// thicknesses from its loaded ends, to 0.5 % of sv three cells and more away from the border; mirrored layers (soft,
// stiff, soft) do not bend. The unlayered -sv is wrong by 20 % and more.
TEST_CASE("loaded in-situ stress of layers") {
  Scene scene = block(40, 120);
  scene.numerics.far_cell_m = 6.0;
  scene.domain.bottom = Edge::symmetry;
  scene.in_situ = {3e6, 2e6, InSitu::Initialise::loaded};
  scene.rocks.push_back({"soft", 4e9, 0.3, 2500.0, 1e6});
  scene.strata.along = Strata::Along::x;
  scene.strata.layers = {{1, 0.0, 12.0}, {0, 12.0, 28.0}, {1, 28.0, 40.0}};
  scene.strata.interfaces = {{0, 12.0}, {0, 28.0}};
  const Run run(scene);
  CHECK(run.state.grid.ny < 40);
  const double stiff = 10e9 / (1.0 - 0.04), soft = 4e9 / (1.0 - 0.09), thick = 16.0, thin = 24.0;
  const double poisson = -2e6 * (0.25 * thick + 0.3 / 0.7 * thin);
  const double e = (3e6 * 40.0 + poisson) / (stiff * thick + soft * thin);
  const double of_stiff = -stiff * e - 0.25 * 2e6, of_soft = -soft * e - 0.3 / 0.7 * 2e6;
  REQUIRE(of_stiff * thick + of_soft * thin == Approx(-3e6 * 40.0));
  const Particles& p = run.state.particles;
  int seen = 0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    if (p.y[q] > 20.0 || std::abs(p.x[q] - 12.0) < 3.0 || std::abs(p.x[q] - 28.0) < 3.0) continue;
    const double right = p.rock[q] == 0 ? of_stiff : of_soft;
    ++seen;
    CAPTURE(p.x[q], p.y[q]);
    CHECK(p.in_situ[q].yy == Approx(right).margin(0.005 * 3e6));
    CHECK(p.in_situ[q].xx == Approx(-2e6).margin(0.005 * 3e6));
  }
  CHECK(seen > 200);
  CHECK(std::abs(of_stiff + 3e6) > 0.9e6);
  CHECK(std::abs(of_soft + 3e6) > 0.6e6);
}

// A soft interface along columns that grow from 1 to 5 m, in a block that carries the traction (s_xy, s_yy).
struct GradedInterface {
  static constexpr double D_n = 2e9, D_t = 5e9;
  Run run;
  GradedInterface(double at, Numerics::Shape shape, int points, const Stress& s) : run(scene(at, shape, points)) {
    Particles& p = run.state.particles;
    for (std::size_t q = 0; q < p.size(); ++q) strain(run.state, q, gradient_of(run.scene.rocks[p.rock[q]], s));
    for (SurfacePoint& point : run.state.surfaces[0].points) point.reaction = -Vec2{s.xy, s.yy};
    gather();
    update_stencil_weights(run.scene, run.state);
  }
  static Scene scene(double at, Numerics::Shape shape, int points) {
    Scene s = block(60, 30);
    s.numerics.far_cell_m = 5.0;
    s.numerics.shape = shape;
    s.numerics.particles_per_cell = points;
    s.rocks.push_back({"light", 5e9, 0.3, 2000.0, 1e6});
    add_interface(s, soft_law(D_n, D_t, InterfaceLaw::Compression::spring), at, 1);
    return s;
  }
  // Masses and internal forces of all records.
  void gather() {
    State& state = run.state;
    const Particles& p = state.particles;
    for (const Bin& bin : state.bins) {
      for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
           q += static_cast<std::size_t>(bin.stride)) {
        const Stress s = stress_of(run.rocks[p.rock[q]], p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
        const Gradients g = gradients_at(run.scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
        for (std::size_t n = 0; n < 9; ++n) {
          const NodalSums::Record sum = state.sums[static_cast<std::size_t>(bin.record[n])];
          sum.m += p.m[q] * g.N[n];
          sum.f_x -= p.V[q] * (s.xx * g.N_x[n] + s.xy * g.N_y[n]);
          sum.f_y -= p.V[q] * (s.xy * g.N_x[n] + s.yy * g.N_y[n]);
        }
      }
    }
  }
  // Largest force (N/m) of a record whose node is two cells or more inside.
  double largest_force() const {
    const State& state = run.state;
    double most = 0.0;
    for (int r = 0; r < state.copies.records(); ++r) {
      const int node = state.copies.node_of_record[static_cast<std::size_t>(r)];
      const int i = state.grid.column(node), j = state.grid.row(node);
      if (i < 2 || i > state.grid.nx - 2 || j < 2 || j > state.grid.ny - 2) continue;
      const NodeSums& s = state.sums[static_cast<std::size_t>(r)];
      most = std::max(most, std::hypot(s.f_x, s.f_y));
    }
    return most;
  }
  void add_reactions() {
    State& state = run.state;
    for (std::size_t q = 0; q < state.surfaces[0].points.size(); ++q) {
      const SurfacePoint& s = state.surfaces[0].points[q];
      add_traction(state.point_stencils[0][q], s.reaction, s.A, state.sums);
    }
  }
};

// Requires that the reactions of an interface along graded columns balance uniform stress at every node: exactly, 1e-12
// of sigma h, with 4 points a cell, and to 3e-3 of it with 16, B-splines,, on a grid line and at mid-cell, both shapes.
// Two points a cell, each in the column whose span holds it, their lengths the block's width. Mutation that fails:
// equal spacing along the interface.
TEST_CASE("a soft interface passes traction on along growing cells") {
  const Stress s{0.0, 2e6, -1.5e6};
  for (const auto shape : fixed_shapes) {
    for (const int points : {4, 16}) {
      for (const double at : {15.0, 14.5}) {
        GradedInterface soft(at, shape, points, s);
        const State& state = soft.run.state;
        const Surface& surface = state.surfaces[0];
        CAPTURE(static_cast<int>(shape), points, at);
        CHECK(surface.points.size() == 2 * static_cast<std::size_t>(state.grid.nx));
        CHECK(surface.length() == Approx(60.0).epsilon(1e-14));
        for (std::size_t q = 0; q < surface.points.size(); ++q)
          CHECK(surface.points[q].column == static_cast<int>(q + 1) / 2);
        CHECK(soft.largest_force() > 1e5);
        soft.add_reactions();
        CHECK(soft.largest_force() < (points == 4 ? 1e-12 : 3e-3) * 5.0 * 2e6);
      }
    }
  }
}
