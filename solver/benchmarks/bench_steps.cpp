// Explicit steps as runs take them: advance() over the block with a pressurised crack.
#include <fmt/format.h>

#include <algorithm>

#include "benchmarks/shop.hpp"
#include "explicit/advance.hpp"
#include "quasistatic/resting_rock.hpp"

namespace strata::bench {

namespace {

struct StepCase {
  std::string kinematics = "updated", shape = "bspline2", transfer = "flip", kernels = "fast";
  int points = 4;  // a cell
  int cells = 80;  // along each side of the block
  int threads = 1;
};

// Flop that a particle asks for in a step, counted by hand on the formulas of explicit/transfers.hpp, an addition or
// multiplication each, divisions and comparisons none, whatever the code really does (diagnostics, padded vectors):
//   functions of both axes      B-spline 28, uGIMP 28 (middle piece), linear 8
//   stress and times volume     11
//   to the nodes                m v 2; a row of nodes 7; a node 14 (m 2, m v 4, f 8)
//   from the nodes              a row of r nodes: 6 (2 r - 1) for v, dv and slopes of v; all rows together 8 (2 r - 1)
//   its own                     v 4, x 4, u 4, g 8
double flop_a_particle(const std::string& shape) {
  const double r = shape == "linear" ? 2.0 : 3.0, functions = shape == "linear" ? 8.0 : 28.0, runs = 2.0 * r - 1.0;
  const double to_nodes = 2.0 + r * 7.0 + r * r * 14.0;
  const double from_nodes = r * 6.0 * runs + 8.0 * runs;
  return functions + 11.0 + to_nodes + from_nodes + 20.0;
}

// Bytes that a particle-step moves at least where nothing stays in a cache: x, u, v, g read and written (10 doubles)
// and its rock read (mass, area and half size are alike in most blocks and read once); of each node, shared by the
// points of a cell, sums written and read and motion too.
double bytes_a_particle(int points) {
  return 10 * 16.0 + 1.0 + (2 * sizeof(NodeSums) + 2 * sizeof(NodeMotion)) / static_cast<double>(points);
}

// Steps that are timed together: a period of what is done now and then (rebuild() every 250 steps, particles brought up
// to date every 500 under kinematics = "total") where particles are few, else what takes about a second.
std::int64_t steps_of(const StepCase& c) {
  const bool total = c.kinematics == "total";
  const double enough = total ? 6e7 : 2e7;  // particle-steps
  const double particles = static_cast<double>(c.cells) * c.cells * c.points;
  return std::clamp(static_cast<std::int64_t>(enough / particles), std::int64_t{5},
                    (total ? 2 : 1) * steps_between_rebuilds);
}

void add_step(Shop& shop, const std::string& group, const StepCase& c) {
  const std::string name = fmt::format("{}/{}/{}/{}/{}/points{}/cells{}/threads{}", group, c.kinematics, c.shape,
                                       c.transfer, c.kernels, c.points, c.cells, c.threads);
  const Order order{"",
                    {"numerics.kinematics=" + c.kinematics, "numerics.shape=" + c.shape,
                     "numerics.transfer=" + c.transfer, "numerics.kernels=" + c.kernels,
                     fmt::format("numerics.particles_per_cell={}", c.points), cell_setting(c.cells)}};
  const std::string label = fmt::format(
      "kinematics={} shape={} transfer={} kernels={} points_per_cell={} cells={} threads={} precision=double",
      c.kinematics, c.shape, c.transfer, c.kernels, c.points, c.cells, c.threads);
  add(name, steps_of(c), [&shop, order, label, c](benchmark::State& bench) {
    Workpiece& work = shop.get(order);
    const auto particles = static_cast<double>(work.state.particles.size());
    const About about{label, c.threads, particles, flop_a_particle(c.shape), bytes_a_particle(c.points)};
    time_work(bench, shop, about,
              [&] { advance(work.scene, work.rocks, work.state, growth_weighing(work.scene, work.rocks), false); });
    bench.counters["particles"] = particles;
  });
}

}  // namespace

void add_steps(Shop& shop) {
  for (const std::string kinematics : {"updated", "total"}) {
    for (const std::string shape : {"bspline2", "gimp", "linear"}) {
      if (kinematics == "total" && shape == "gimp") continue;  // refused: points that stay need no extent
      for (const std::string kernels : {"fast", "plain"}) {
        for (const int threads : {1, 2}) {
          add_step(shop, "step", {.kinematics = kinematics, .shape = shape, .kernels = kernels, .threads = threads});
        }
      }
    }
    for (const std::string transfer : {"pic", "xpic2"})
      add_step(shop, "step", {.kinematics = kinematics, .transfer = transfer});
    for (const int points : {9, 16}) add_step(shop, "step", {.kinematics = kinematics, .points = points});
    // The crack is 5 m of 80 m at all sizes, so its places grow as the root of the points.
    for (const int cells : {50, 160, 320, 640, 1000}) {
      add_step(shop, "scaling", {.kinematics = kinematics, .cells = cells});
      if (cells == 320) add_step(shop, "scaling", {.kinematics = kinematics, .cells = cells, .threads = 2});
    }
  }
}

}  // namespace strata::bench
