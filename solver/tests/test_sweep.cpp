// The fast loops over particles against the plain ones, and what keeps them fast.
#include <catch2/catch.hpp>

#include <atomic>
#include <cstdlib>
#include <map>
#include <new>
#include <numeric>

#include "explicit/transfers.hpp"
#include "random_scene.hpp"
#include "state/blocks.hpp"
#include "state/spread_array.hpp"

using namespace strata;
using namespace strata::test;

namespace {

std::atomic<long> allocations{0};

}  // namespace

// The thread sanitizer brings its own operator new: there nothing is counted.
#if !STRATA_TESTS_RACES
// Counts what is allocated through new in this program. Not inlined: the compiler would see free() of what came from
// new.
[[gnu::noinline]] void* operator new(std::size_t size) {
  ++allocations;
  if (void* p = std::malloc(size)) return p;
  throw std::bad_alloc();
}
// Catch asks for this one, and gives back by delete.
[[gnu::noinline]] void* operator new(std::size_t size, const std::nothrow_t& /*none*/) noexcept {
  ++allocations;
  return std::malloc(size);
}
// Arrays of particles and nodes start where SpreadAllocator says, in pages of their own.
[[gnu::noinline]] void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  const auto unit = static_cast<std::size_t>(alignment);
  if (void* p = std::aligned_alloc(unit, (size + unit - 1) / unit * unit)) return p;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* p, std::align_val_t /*alignment*/) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t, std::align_val_t) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p) noexcept {
  std::free(p);
}
[[gnu::noinline]] void operator delete(void* p, std::size_t) noexcept {
  std::free(p);
}
#endif

namespace {

// An explicit scene with a random shape, transfer and number of points.
Scene random_explicit(unsigned seed) {
  Scene scene = random_scene(seed);
  Dice dice(seed + 77U);
  scene.numerics.mechanics = Numerics::Mechanics::explicit_dynamics;
  scene.numerics.shape = shapes[static_cast<std::size_t>(dice.below(3))];
  scene.numerics.transfer = transfers[static_cast<std::size_t>(dice.below(3))];
  scene.numerics.particles_per_cell = std::array{4, 9, 16}[static_cast<std::size_t>(dice.below(3))];
  scene.numerics.damping_1_s = dice.chance(0.5) ? 0.0 : 30.0;
  if (scene.fracture) {
    scene.fracture->growth = Fracture::Growth::none;
    scene.fracture->crossing = Fracture::Crossing::J;
  }
  if (dice.chance(0.5) && scene.numerics.particles_per_cell != 9) scene.domain.beyond_m = dice.uniform(3.0, 40.0);
  return scene;
}

Scene with(Scene scene, Numerics::Kernels kernels) {
  scene.numerics.kernels = kernels;
  return scene;
}

// Places up to 2 mm off the lattice, velocities (m/s), strains and displacements (m) that depend on a particle's place
// alone. (Where particles of uGIMP just touch a node, f/m there is as large as its digits are few.)
void set_by_place(Run& run, unsigned seed) {
  Particles& p = run.state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    Dice dice(seed + static_cast<unsigned>(std::lround(1e3 * p.x[q]) + 100003 * std::lround(1e3 * p.y[q])));
    p.x[q] += dice.uniform(-2e-3, 2e-3), p.y[q] += dice.uniform(-2e-3, 2e-3);
    p.v_x[q] = dice.uniform(-0.2, 0.3), p.v_y[q] = dice.uniform(-0.2, 0.2);
    p.u_x[q] = dice.uniform(-1e-5, 1e-5), p.u_y[q] = dice.uniform(-1e-5, 1e-5);
    for (auto* g : {&p.g_xx, &p.g_xy, &p.g_yx, &p.g_yy}) (*g)[q] = dice.uniform(-1e-4, 1e-4);
  }
  run.rebuild();
}

// Ids of the particles in the order of their places: refinement numbers them in the order in which they are kept.
std::vector<std::int32_t> ids_by_place(const Particles& p) {
  std::vector<std::size_t> order(p.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(),
            [&](std::size_t q, std::size_t r) { return std::pair(p.y[q], p.x[q]) < std::pair(p.y[r], p.x[r]); });
  std::vector<std::int32_t> ids;
  for (const std::size_t q : order) ids.push_back(p.id[q]);
  return ids;
}

std::vector<double> by_ids(const Particles& p, const SpreadArray& field, const std::vector<std::int32_t>& ids) {
  std::vector<double> of_id(p.size()), out;
  for (std::size_t q = 0; q < p.size(); ++q) of_id[static_cast<std::size_t>(p.id[q])] = field[q];
  for (const std::int32_t id : ids) out.push_back(of_id[static_cast<std::size_t>(id)]);
  return out;
}

// The same scene in fast and in plain loops.
struct Both {
  Run fast, plain;
  std::vector<std::int32_t> fast_ids, plain_ids;

  Both(const Scene& scene, unsigned seed)
      : fast(with(scene, Numerics::Kernels::fast)), plain(with(scene, Numerics::Kernels::plain)) {
    set_by_place(fast, seed), set_by_place(plain, seed);
    fast_ids = ids_by_place(fast.state.particles), plain_ids = ids_by_place(plain.state.particles);
  }
  void advance() { fast.advance(1), plain.advance(1); }

  // The largest difference between the particles, each field of its own largest value.
  double difference() const {
    const Particles &a = fast.state.particles, &b = plain.state.particles;
    REQUIRE(a.size() == b.size());
    double worst = 0.0;
    for (const auto field : {&Particles::x, &Particles::y, &Particles::u_x, &Particles::u_y, &Particles::v_x,
                             &Particles::v_y, &Particles::g_xx, &Particles::g_xy, &Particles::g_yx, &Particles::g_yy}) {
      const std::vector<double> f = by_ids(a, a.*field, fast_ids), g = by_ids(b, b.*field, plain_ids);
      double most = 0.0, largest = 0.0;
      for (std::size_t k = 0; k < f.size(); ++k) {
        most = std::isfinite(f[k]) ? std::max(most, std::abs(f[k] - g[k])) : HUGE_VAL;
        largest = std::max(largest, std::abs(g[k]));
      }
      REQUIRE(largest > 0.0);
      worst = std::max(worst, most / largest);
    }
    return worst;
  }
};

double difference(const Ledger& a, const Ledger& b) {
  const double scale = std::max(b.kinetic, b.largest);
  return std::max({std::abs(a.kinetic - b.kinetic), std::abs(a.transfer - b.transfer),
                   std::abs(a.integration - b.integration), std::abs(a.body_work - b.body_work),
                   std::abs(a.fluid_work - b.fluid_work), std::abs(a.friction - b.friction)}) /
         scale;
}

// Share of a state's particles that are swept as lanes.
double share_in_lanes(const State& state) {
  std::size_t in_lanes = 0;
  for (const Bin& bin : state.bins) {
    if (bin.stride > 1) in_lanes += static_cast<std::size_t>((bin.last - bin.first) / bin.stride);
  }
  return static_cast<double>(in_lanes) / static_cast<double>(state.particles.size());
}

}  // namespace

// Requires that the fast loops give what plain ones give, to 1e-10 of each field's largest value, for one step and for
// two (whose second one starts from sums of the first one's sweep), in 150 random scenes: cracks at any angle, layers,
// interfaces that have failed, all edges, shapes, transfers and numbers of points, uniform and graded grids.
TEST_CASE("fast loops give what plain loops give") {
  double in_lanes = 0.0;
  int graded = 0;
  constexpr unsigned scenes = 150;
  for (unsigned seed = 0; seed < scenes; ++seed) {
    const Scene scene = random_explicit(seed);
    Both both(scene, seed);
    const State &fast = both.fast.state, &plain = both.plain.state;
    in_lanes += share_in_lanes(fast) / scenes;
    graded += fast.grid.x_knots.empty() ? 0 : 1;
    CHECK(share_in_lanes(plain) == 0.0);
    for (int step = 1; step <= 2; ++step) {
      both.advance();
      CAPTURE(seed, step, static_cast<int>(scene.numerics.shape), static_cast<int>(scene.numerics.transfer),
              scene.numerics.particles_per_cell);
      CHECK(both.difference() < 1e-10);
      CHECK(difference(fast.ledger, plain.ledger) < 1e-10);
      CHECK(fast.monitors.largest_particle_velocity == Approx(plain.monitors.largest_particle_velocity).epsilon(1e-10));
    }
  }
  CHECK(in_lanes > 0.6);
  CHECK(graded > 30);
}

// Requires that nearly all particles are swept as lanes: beside the fracture, edges and an interface that has failed
// too. Of a row of 81 bins one is left over.
TEST_CASE("particles are in lanes") {
  constexpr double left_over = 1.0 / 80.0;
  Scene scene = block(80, 80);
  hold_edges(scene);
  CHECK(share_in_lanes(Run(scene).state) > 0.99 - left_over);
  add_fracture(scene, {{40.0, 0.0}, {40.0, 5.0}});
  CHECK(share_in_lanes(Run(scene).state) > 0.98 - left_over);
  add_interface(scene, soft_law(1e9, 1e9), 20.0);
  CHECK(share_in_lanes(Run(scene).state) > 0.97 - left_over);
}

// Requires that 15 arrays at equal steps of pages, whatever the step, ask no line of the page for more than 8 of them.
// Mutations that fail: spread once only (steps of 610 pages have all in one line), not at all.
TEST_CASE("arrays of all sizes start in different lines") {
  for (std::uint64_t step = 1; step < 3000; ++step) {
    std::map<std::size_t, int> in_line;
    for (std::uint64_t k = 0; k < 15; ++k) ++in_line[SpreadAllocator<double>::start(0x7f12345 + k * step)];
    for (const auto& [line, count] : in_line) {
      CAPTURE(step, line, count);
      REQUIRE(line < page_bytes);
      REQUIRE(line % line_bytes == 0);
      REQUIRE(count <= 8);
    }
  }
}

// Requires that arrays of the same size start at different places of their pages, each at the start of a line, so that
// going through 15 of them side by side no set of a cache is asked for more of them than it has ways (8 of 64 lines).
// Mutation that fails: all start with the page.
TEST_CASE("arrays that are read side by side start in different lines") {
  for (const std::size_t n : {std::size_t{512}, std::size_t{25600}, std::size_t{102400}, std::size_t{25601}}) {
    std::vector<SpreadArray> arrays(15, SpreadArray(n));
    std::map<std::size_t, int> in_line;
    for (SpreadArray& array : arrays) {
      const auto address = reinterpret_cast<std::uintptr_t>(array.data());
      CHECK(address % line_bytes == 0);
      ++in_line[address % page_bytes];
      array.front() = 1.0, array.back() = 2.0;
    }
    int most = 0;
    for (const auto& [line, count] : in_line) most = std::max(most, count);
    CAPTURE(n, most);
    CHECK(most <= 8);
    SpreadArray moved = arrays[3];
    moved.resize(2 * n, 5.0);
    CHECK(moved[n - 1] == 2.0);
    CHECK(moved.back() == 5.0);
  }
}

// Requires that a fracture that grows through a weak interface does so at the same times and places in fast and plain
// loops, to round-off, on a uniform and on a graded grid.
TEST_CASE("fast and plain loops lead to the same events") {
  const double beyond = GENERATE(0.0, 50.0);
  Scene scene = block(16, 24);
  scene.domain.beyond_m = beyond;
  hold_edges(scene);
  scene.in_situ.horizontal_Pa = 1e6, scene.in_situ.vertical_Pa = 2e6;
  add_interface(scene, weak_law(4e5, 4e5, 0.3), 10.0);
  add_fracture(scene, {{8.0, 0.0}, {8.0, 5.0}}, 1.2e6);
  scene.fracture->growth = Fracture::Growth::J;
  scene.fluid.rate_Pa_s = 2e6;
  Run fast(with(scene, Numerics::Kernels::fast)), plain(with(scene, Numerics::Kernels::plain));
  fast.advance(1500), plain.advance(1500);
  REQUIRE(fast.state.events.size() == plain.state.events.size());
  CHECK(fast.state.events.size() > 1);
  for (std::size_t k = 0; k < fast.state.events.size(); ++k) {
    const Event &a = fast.state.events[k], &b = plain.state.events[k];
    CAPTURE(k, a.kind, a.time_s, b.time_s);
    CHECK(a.kind == b.kind);
    CHECK(a.time_s == Approx(b.time_s).epsilon(1e-12));
    CHECK(a.inlet_Pa == Approx(b.inlet_Pa).epsilon(1e-12));
    CHECK(std::hypot(a.tip_x_m - b.tip_x_m, a.tip_y_m - b.tip_y_m) < 1e-9);
  }
  const auto &a = fast.state.fracture().vertices, &b = plain.state.fracture().vertices;
  REQUIRE(a.size() == b.size());
  CHECK(a.size() > 8);
  CHECK(difference(fast.state.ledger, plain.state.ledger) < 1e-6);
}

// Requires that no step between two rebuilds allocates memory: a pressurised fracture, a soft and a bonded interface,
// by every transfer.
TEST_CASE("a step allocates nothing") {
  if (STRATA_TESTS_RACES) {
    WARN("skipped: the thread sanitizer has its own operator new, so that allocations cannot be counted");
    return;
  }
  for (const auto transfer : transfers) {
    Scene scene = block(16, 24);
    hold_edges(scene);
    add_interface(scene, soft_law(1e9, 1e9), 10.0);
    add_interface(scene, weak_law(4e8, 4e8, 0.3), 15.0);
    add_fracture(scene, {{8.0, 0.0}, {8.0, 5.0}}, 1e5);
    scene.numerics.transfer = transfer;
    Run run(scene);
    run.advance(3);
    const long before = allocations;
    run.advance(100);
    const long made = allocations - before;  // Catch allocates too
    CAPTURE(static_cast<int>(transfer));
    CHECK(made == 0);
  }
}
