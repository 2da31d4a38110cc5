// The stages of an explicit step, each alone, on the block with a pressurised crack.
#include <fmt/format.h>

#include "benchmarks/shop.hpp"
#include "explicit/advance.hpp"
#include "explicit/momentum.hpp"
#include "explicit/reactions.hpp"
#include "explicit/transfers.hpp"
#include "flow/paper_flow.hpp"
#include "fracture/j_integral.hpp"
#include "interfaces/surface_tractions.hpp"
#include "interfaces/tip_ties.hpp"
#include "quasistatic/resting_rock.hpp"

namespace strata::bench {

namespace {

using Stage = std::function<void(Workpiece&)>;

// A stage that may be repeated as it stands: nothing moves while it is timed, since no node does.
void add_stage(Shop& shop, const std::string& stage, const Order& order, int threads, std::int64_t iterations,
               const Stage& run) {
  add(fmt::format("stage/{}/threads{}", stage, threads), iterations, [&shop, order, threads, stage, run](auto& bench) {
    Workpiece& work = shop.get(order);
    advance(work.scene, work.rocks, work.state, growth_weighing(work.scene, work.rocks));
    work.state.motion.clear(work.state.motion.size());
    const auto particles = static_cast<double>(work.state.particles.size());
    const About about{fmt::format("stage={} threads={}", stage, threads), threads, particles, 0.0, 0.0};
    time_work(bench, shop, about, [&] { run(work); });
    bench.counters["particles"] = particles;
  });
}

// What FLIP takes up.
Uptake increments(const State& state) {
  return {1.0, &state.motion.dv_x, &state.motion.dv_y};
}

// Split places of all surfaces and springs of tips: what a contact solve is about.
std::size_t places_of(const State& state) {
  std::size_t places = state.ties.size();
  for (const Surface& surface : state.surfaces) {
    for (const SurfacePoint& s : surface.points) places += s.split ? 1 : 0;
  }
  return places;
}

// A contact solve as in a step, from that step's motion and the last reactions; the rest of the step is not timed.
double solve_once(Workpiece& work) {
  const Scene& scene = work.scene;
  State& state = work.state;
  particles_to_grid(scene, work.rocks, state);
  update_stencil_weights(scene, state);
  add_net_tractions(state);
  fold_to_masters(state, state.sums);
  advance_momentum(scene.numerics.damping_1_s, state);
  const Clock::time_point start = Clock::now();
  solve_reactions(scene, work.rocks, state);
  return seconds_since(start);
}

void add_contact(Shop& shop, const std::string& variant, int cells) {
  const std::string name = fmt::format("contact/explicit/{}/cells{}", variant.empty() ? "crack" : variant, cells);
  const Order order{variant, {cell_setting(cells)}};
  add(name, 10, [&shop, order, variant](benchmark::State& bench) {
    Workpiece& work = shop.get(order);
    const std::size_t places = places_of(work.state);
    const About about{fmt::format("variant={} places={}", variant, places), 1, 1.0, 0.0, 0.0};
    time_part(bench, shop, about, [&] {
      advance(work.scene, work.rocks, work.state,
              growth_weighing(work.scene, work.rocks));  // so that each solve is another step's
      return solve_once(work);
    });
    bench.counters["places"] = static_cast<double>(places);
  })->UseManualTime();
}

void add_flow(Shop& shop, int cells) {
  const Order order{"paper", {cell_setting(cells)}};
  add(fmt::format("flow/paper/cells{}", cells), 2000, [&shop, order](benchmark::State& bench) {
    Workpiece& work = shop.get(order);
    const std::size_t vertices = work.state.fracture().vertices.size();
    const About about{fmt::format("law=paper vertices={}", vertices), 1, 1.0, 0.0, 0.0};
    time_work(bench, shop, about, [&] { advance_pressure(work.scene, work.state); });
  });
}

}  // namespace

void add_stages(Shop& shop) {
  const Order block{"", {}};
  for (const int threads : {1, 2}) {
    add_stage(shop, "particles_to_grid", block, threads, 50,
              [](Workpiece& w) { particles_to_grid(w.scene, w.rocks, w.state); });
    add_stage(shop, "grid_to_particles", block, threads, 50,
              [](Workpiece& w) { grid_to_particles(w.scene, w.rocks, increments(w.state), w.state); });
    add_stage(shop, "sweep_particles", block, threads, 50,
              [](Workpiece& w) { sweep_particles(w.scene, w.rocks, increments(w.state), w.state); });
  }
  add_stage(shop, "momentum", block, 1, 500, [](Workpiece& w) {
    fold_to_masters(w.state, w.state.sums);
    advance_momentum(0.0, w.state);
    grid_energy(w.state);
    spread_to_tied(w.state);
    w.state.motion.clear(w.state.motion.size());
  });
  add_stage(shop, "surfaces", block, 1, 2000, [](Workpiece& w) {
    update_stencil_weights(w.scene, w.state);
    add_net_tractions(w.state);
    follow_surfaces(w.state);
  });
  add_stage(shop, "measure_tips", block, 1, 500, [](Workpiece& w) { measure_tips(w.scene, w.rocks, w.state); });
  add_stage(shop, "rebuild", block, 1, 10, [](Workpiece& w) { rebuild(w.scene, w.rocks, w.state); });
  for (const int cells : {80, 320}) {
    add_contact(shop, "", cells);
    add_contact(shop, "soft", cells);
    add_flow(shop, cells);
  }
}

}  // namespace strata::bench
