#include "state/copies.hpp"

#include <catch2/catch.hpp>
#include <set>

#include "explicit/transfers.hpp"
#include "small_scenes.hpp"
#include "state/rebuild.hpp"

using namespace strata;
using namespace strata::test;

namespace {

Scene cut_block(const Path& path, Numerics::Shape shape = Numerics::Shape::bspline2, bool held = true) {
  Scene scene = block(12, 12);
  if (held) hold_edges(scene);
  scene.numerics.shape = shape;
  add_fracture(scene, path);
  return scene;
}

// Number of copies of the node in column i and row j, 1 where nothing splits it.
std::size_t copies_at(const State& state, int i, int j) {
  const int c = state.copies.cut_of_node[static_cast<std::size_t>(state.grid.node(i, j))];
  return c < 0 ? 1 : state.copies.cut[static_cast<std::size_t>(c)].keys.size();
}

bool split(const State& state, int i, int j) {
  return state.copies.cut_of_node[static_cast<std::size_t>(state.grid.node(i, j))] >= 0;
}

// Columns of row j that are split, ghosts too.
std::vector<int> split_columns(const State& state, int j) {
  std::vector<int> columns;
  for (int i = -1; i <= state.grid.nx + 1; ++i) {
    if (split(state, i, j)) columns.push_back(i);
  }
  return columns;
}

// Rows of column i that are split, ghosts too.
std::pair<int, int> split_rows(const State& state, int i) {
  std::pair<int, int> rows{99, -99};
  for (int j = -1; j <= state.grid.ny + 1; ++j) {
    if (split(state, i, j)) rows = {std::min(rows.first, j), std::max(rows.second, j)};
  }
  return rows;
}

// The tip rule by itself: a straight fracture from a to b splits a node if any of it lies within the square that the
// node's shape function covers and the node projects strictly between its tips.
bool should_split(const Vec2& a, const Vec2& b, const Vec2& x, double support) {
  const Vec2 along = (b - a).normalized();
  const double arc = (x - a).dot(along), L = (b - a).norm();
  if (arc <= 0.02 || arc >= L - 0.02) return false;
  for (int k = 0; k <= 4000; ++k) {
    const Vec2 off = a + (b - a) * (k / 4000.0) - x;
    if (std::max(std::abs(off.x()), std::abs(off.y())) < support - 0.02) return true;
  }
  return false;
}

// Interfaces through the middle that have failed all along, with a fracture to `tip_y`.
Run crossing(double at, double tip_y) {
  Scene scene = block(12, 12);
  hold_edges(scene);
  add_interface(scene, friction_law(0.5), at);
  add_fracture(scene, {{6.0, 0.0}, {6.0, tip_y}});
  Run run(scene);
  for (SurfacePoint& s : run.state.surfaces[1].points) s.split = true;
  run.rebuild();
  return run;
}

std::vector<Run> all_kinds() {
  std::vector<Run> runs;
  runs.emplace_back(block(12, 12));
  for (const auto shape : shapes) {
    runs.emplace_back(cut_block({{6.0, 0.0}, {6.0, 5.0}}, shape));
    runs.emplace_back(cut_block({{5.5, 0.0}, {5.5, 5.3}}, shape));
    runs.emplace_back(cut_block({{3.2, 3.3}, {8.7, 6.8}}, shape, false));
  }
  runs.push_back(crossing(6.0, 9.0));
  runs.push_back(crossing(5.5, 9.0));
  runs.push_back(crossing(6.0, 6.0));
  return runs;
}

SideWord key_of_record(const State& state, int record) {
  const int node = state.copies.node_of_record[static_cast<std::size_t>(record)];
  const int c = state.copies.cut_of_node[static_cast<std::size_t>(node)];
  if (c < 0) return 0;
  const CutNode& cut = state.copies.cut[static_cast<std::size_t>(c)];
  for (std::size_t k = 0; k < cut.keys.size(); ++k) {
    if (cut.records[k] == record) return cut.keys[k];
  }
  return ~SideWord{0};
}

}  // namespace

// Requires that a fracture splits the columns whose shape functions it lies in: three on a grid line for B-splines and
// two at mid-cell; one and two for hat functions and uGIMP.
TEST_CASE("columns that a vertical fracture splits") {
  using Columns = std::vector<int>;
  const auto columns = [](double x, Numerics::Shape shape) {
    return split_columns(Run(cut_block({{x, 0.0}, {x, 5.0}}, shape)).state, 3);
  };
  CHECK(columns(6.0, Numerics::Shape::bspline2) == Columns{5, 6, 7});
  CHECK(columns(5.5, Numerics::Shape::bspline2) == Columns{5, 6});
  for (const auto shape : {Numerics::Shape::linear, Numerics::Shape::gimp}) {
    CHECK(columns(6.0, shape) == Columns{6});
    CHECK(columns(5.5, shape) == Columns{5, 6});
  }
}

// Requires the tip rule (mutation that fails: the node at the tip split too): nodes strictly behind the tip are split,
// one at the tip is not; below a symmetry line ghosts are split like the nodes they mirror. A fracture within the block
// obeys it at both tips.
TEST_CASE("rows that a vertical fracture splits") {
  const auto rows = [](const Path& path) { return split_rows(Run(cut_block(path)).state, 6); };
  CHECK(rows({{6.0, 0.0}, {6.0, 5.0}}) == std::pair{-1, 4});
  CHECK(rows({{6.0, 0.0}, {6.0, 5.1}}) == std::pair{-1, 5});
  CHECK(rows({{6.0, 0.0}, {6.0, 5.9}}) == std::pair{-1, 5});
  CHECK(rows({{6.0, 3.0}, {6.0, 7.0}}) == std::pair{4, 6});
  CHECK(rows({{6.0, 2.9}, {6.0, 7.1}}) == std::pair{3, 7});
}

// Requires of inclined fractures that exactly the nodes of the tip rule are split, each node checked against a search
// along the fracture.
TEST_CASE("nodes that an inclined fracture splits") {
  for (const Path& path : {Path{{3.2, 3.3}, {8.7, 6.8}}, Path{{8.1, 2.6}, {4.4, 9.3}}, Path{{3.0, 4.0}, {9.0, 4.7}}}) {
    for (const auto shape : shapes) {
      const Run run(cut_block(path, shape, false));
      const Vec2 a{path[0][0], path[0][1]}, b{path[1][0], path[1][1]};
      const double support = shape == Numerics::Shape::bspline2 ? 1.5 : 1.0;
      int found = 0;
      for (int j = 0; j <= 12; ++j) {
        for (int i = 0; i <= 12; ++i) {
          CAPTURE(i, j, static_cast<int>(shape));
          const bool expected = should_split(a, b, {i * 1.0, j * 1.0}, support);
          CHECK(split(run.state, i, j) == expected);
          if (expected) CHECK(copies_at(run.state, i, j) <= 2U);
          found += expected ? 1 : 0;
        }
      }
      CHECK(found > 6);
    }
  }
}

// Requires two copies beside a fracture or a failed interface, and four where the one passes through the other.
TEST_CASE("copies where a fracture crosses a failed interface") {
  for (const double at : {6.0, 5.5}) {
    const Run run = crossing(at, 9.0);
    const int row = static_cast<int>(at);
    CHECK(copies_at(run.state, 6, row) == 4U);
    CHECK(copies_at(run.state, 2, row) == 2U);
    CHECK(copies_at(run.state, 6, 2) == 2U);
    CHECK(copies_at(run.state, 2, 2) == 1U);
    CHECK(copies_at(run.state, 6, 11) == 1U);
  }
}

// Requires that a fracture whose tip stands on a failed interface splits what lies below it only, and all of that, also
// where it belongs to nodes on and beyond the tip's row: three copies. Mutations that fail: the rule of entered sides
// left out; the rock behind split up to the tip's row only.
TEST_CASE("copies where a fracture has reached a failed interface") {
  const Run run = crossing(6.0, 6.0);
  for (const int i : {5, 6, 7}) {
    for (const int j : {5, 6, 7}) CHECK(copies_at(run.state, i, j) == 3U);
    CHECK(copies_at(run.state, i, 4) == 2U);
  }
  const Run beyond = crossing(6.0, 7.0);
  CHECK(copies_at(beyond.state, 6, 5) == 4U);
  CHECK(copies_at(beyond.state, 6, 7) == 3U);
}

// Requires that a soft interface splits from the start, a bonded weak one not at all, a perfect one is no surface.
TEST_CASE("interfaces split by their law") {
  for (const auto& law : {soft_law(1e9, 1e9), weak_law(1e6, 1e6), InterfaceLaw{}}) {
    Scene scene = block(8, 8);
    add_interface(scene, law, 4.0);
    const Run run(scene);
    CHECK(run.state.surfaces.size() == (law.kind == InterfaceLaw::Kind::perfect ? 0U : 1U));
    for (int j = -1; j <= 9; ++j)
      CHECK(copies_at(run.state, 4, j) == (law.kind == InterfaceLaw::Kind::soft && j >= 3 && j <= 5 ? 2U : 1U));
  }
}

// Requires that every ghost beyond a held edge is tied to the mirrored node's copy with the same sides, with the sign
// of the component across the edge turned, and nodes on the edge hold that component.
// Mutation that fails: the sign not turned.
TEST_CASE("ghosts mirror the copies inside") {
  for (const Run& run : all_kinds()) {
    const State& state = run.state;
    const Grid& g = state.grid;
    const bool held = run.scene.domain.sides == Edge::fixed;
    REQUIRE(state.masters.size() == static_cast<std::size_t>(state.copies.records()));
    for (int r = 0; r < state.copies.records(); ++r) {
      const Master& master = state.masters[static_cast<std::size_t>(r)];
      const SideWord key = key_of_record(state, r);
      if (key == ~SideWord{0}) continue;  // not in use
      const int node = state.copies.node_of_record[static_cast<std::size_t>(r)];
      const int i = g.column(node), j = g.row(node);
      const auto mirror = [&](int k, int n) { return !held ? k : (k < 0 ? 1 : (k > n ? n - 1 : k)); };
      const int m = state.copies.node_of_record[static_cast<std::size_t>(master.record)];
      CHECK(g.column(m) == mirror(i, g.nx));
      CHECK(g.row(m) == mirror(j, g.ny));
      CHECK(key_of_record(state, master.record) == key);
      const auto factor = [&](int k, int n) {
        return !held ? 1.0 : (k < 0 || k > n ? -1.0 : (k == 0 || k == n ? 0.0 : 1.0));
      };
      CHECK(master.x == factor(i, g.nx));
      CHECK(master.y == factor(j, g.ny));
    }
  }
}

// Requires that the masses of all copies of a node sum up to that of the node when nothing is cut, and no mass is lost.
TEST_CASE("copies share out the mass") {
  for (Run& run : all_kinds()) {
    particles_to_grid(run.scene, run.rocks, run.state);
    Run whole = run;
    whole.state.surfaces.clear();
    whole.state.tips.clear();
    whole.state.has_fracture = false;
    rebuild_copies(whole.scene, whole.state);
    particles_to_grid(whole.scene, whole.rocks, whole.state);
    std::vector<double> m(static_cast<std::size_t>(run.state.grid.nodes()), 0.0);
    for (int r = 0; r < run.state.copies.records(); ++r)
      m[static_cast<std::size_t>(run.state.copies.node_of_record[static_cast<std::size_t>(r)])] +=
          run.state.sums[static_cast<std::size_t>(r)].m;
    double total = 0.0;
    for (std::size_t n = 0; n < m.size(); ++n) {
      CHECK(m[n] == Approx(whole.state.sums[n].m).epsilon(1e-12).margin(1e-9));
      total += m[n];
    }
    CHECK(total == Approx(2500.0 * 144.0).epsilon(1e-12));
  }
}

// Requires that a particle's mass goes to copies of its own side alone: marked with velocity 1 on the + side of the
// fracture and 0 on the other, every copy has a velocity of 1 or 0, and both occur.
TEST_CASE("copies belong to one side") {
  for (Run& run : all_kinds()) {
    if (!run.state.has_fracture || run.state.surfaces.size() > 1) continue;
    Particles& p = run.state.particles;
    for (std::size_t q = 0; q < p.size(); ++q) p.v_x[q] = (p.sides[q] & 1U) != 0 ? 1.0 : 0.0;
    particles_to_grid(run.scene, run.rocks, run.state);
    int plus = 0, minus = 0;
    for (const CutNode& cut : run.state.copies.cut) {
      for (std::size_t k = 0; k < cut.records.size(); ++k) {
        const NodeSums& s = run.state.sums[static_cast<std::size_t>(cut.records[k])];
        if (s.m == 0.0) continue;
        CHECK(s.mom_x == Approx((cut.keys[k] & 1U) != 0 ? s.m : 0.0).margin(1e-12 * s.m));
        ((cut.keys[k] & 1U) != 0 ? plus : minus) += 1;
      }
    }
    CHECK(plus > 4);
    CHECK(minus > 4);
  }
}

// Requires that bins hold every particle once, in its cell of nodes, with nine records of the stencil's own nodes.
TEST_CASE("bins partition the particles") {
  for (const Run& run : all_kinds()) {
    const State& state = run.state;
    std::vector<int> held(state.particles.size(), 0);
    for (const Bin& bin : state.bins) {
      CHECK(bin.last > bin.first);
      for (int q = bin.first; q < bin.last; q += bin.stride) {
        ++held[static_cast<std::size_t>(q)];
        CHECK(std::abs(state.particles.x[static_cast<std::size_t>(q)] - bin.i) <= 0.5);
        CHECK(std::abs(state.particles.y[static_cast<std::size_t>(q)] - bin.j) <= 0.5);
      }
      for (int n = 0; n < 9; ++n) {
        const int node = state.copies.node_of_record[static_cast<std::size_t>(bin.record[static_cast<std::size_t>(n)])];
        CHECK(node == state.grid.node(bin.i + n % 3 - 1, bin.j + n / 3 - 1));
      }
    }
    CHECK(std::count(held.begin(), held.end(), 1) == static_cast<std::ptrdiff_t>(held.size()));
  }
}

// Requires that strips cover the bins in order and that no two strips of one colour share a record. Mutation
// that fails: strips of one row.
TEST_CASE("strips of a colour share no record") {
  for (const Run& run : all_kinds()) {
    const State& state = run.state;
    int next = 0;
    for (const Strip& strip : state.strips) {
      CHECK(strip.first == next);
      next = strip.last;
    }
    CHECK(next == static_cast<int>(state.bins.size()));
    CHECK(state.strips.size() > 2);
    for (std::size_t colour : {0U, 1U}) {
      std::set<int> taken;
      for (std::size_t k = colour; k < state.strips.size(); k += 2) {
        std::set<int> own;
        for (int b = state.strips[k].first; b < state.strips[k].last; ++b)
          own.insert(state.bins[static_cast<std::size_t>(b)].record.begin(),
                     state.bins[static_cast<std::size_t>(b)].record.end());
        for (const int record : own) CHECK(taken.insert(record).second);
      }
    }
  }
}

// Requires that particles in any order come out in that of row, column, sides and id, each with what belonged to it.
// Mutations that fail: cells left as they are, a cell's particles in the order in which they came, arrays not
// reordered.
TEST_CASE("particles of any order are sorted by cell, sides and id") {
  Scene scene = block(8, 8);
  add_fracture(scene, {{2.6, 2.3}, {5.2, 5.7}}, 1e6);
  scene.numerics.kernels = Numerics::Kernels::plain;
  Run run(scene);
  State& state = run.state;
  const Particles sorted = state.particles;
  Particles& p = state.particles;
  const std::size_t n = p.size();
  for_each_array(p, [n](auto& array) {
    const auto old = array;
    for (std::size_t k = 0; k < n; ++k) array[k] = old[(k * 7919 + 13) % n];  // a prime: every one once
  });
  REQUIRE(p.id != sorted.id);
  rebuild_copies(scene, state);
  CHECK(p.id == sorted.id);
  CHECK(p.x == sorted.x);
  CHECK(p.y == sorted.y);
  CHECK(p.sides == sorted.sides);
  CHECK(p.V == sorted.V);
  int row = 0, column = 0;
  for (const Bin& bin : state.bins) {
    CHECK((bin.j > row || (bin.j == row && bin.i >= column)));
    row = bin.j, column = bin.i;
    for (int q = bin.first + 1; q < bin.last; ++q)
      CHECK(p.id[static_cast<std::size_t>(q - 1)] < p.id[static_cast<std::size_t>(q)]);
  }
}
