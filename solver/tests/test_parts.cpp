// Parts of records that threads share a step by: each is done once, and blocks with enough nodes for threads
// end with the same digits on any number of them.
#include <algorithm>
#include <catch2/catch.hpp>

#include "explicit/total/total_base.hpp"
#include "small_scenes.hpp"
#include "state/parts.hpp"

using namespace strata;
using namespace strata::test;

namespace {

// A block with held edges, a fracture and an interface, of more nodes than threads are worth.
Scene busy_block() {
  Scene scene = block(50, 60);
  hold_edges(scene);
  add_interface(scene, soft_law(5e9, 2e9), 40.0);
  add_fracture(scene, {{25.0, 20.3}, {25.0, 39.1}}, 1e6);
  scene.body.acceleration_m_s2 = Formulas{"100*sin(X)*cos(500*t)", "-30*Y"};
  return scene;
}

State after(const Scene& scene, int threads, int steps) {
  Run run(scene);
  omp_set_num_threads(threads);
  stir(run.state, {0.0, 0.0}, 0.01);
  run.advance(steps);
  omp_set_num_threads(threads_of_tests);
  return run.state;
}

}  // namespace

// Mutations that fail: a part that ends a line earlier, parts that begin anywhere.
TEST_CASE("parts are all records, each once, and begin at whole lines of memory") {
  for (const std::size_t n : {0U, 1U, 7U, 255U, 256U, 257U, 6561U, 100000U}) {
    std::size_t next = 0;
    for (std::size_t k = 0; k < record_parts; ++k) {
      const Part part = part_of(n, k);
      CHECK(part.first == next);
      CHECK((part.first % (line_bytes / sizeof(double)) == 0 || part.first == n));
      next = part.last;
    }
    CHECK(next == n);
  }
}

// Mutation that fails: the last record of a run left out.
TEST_CASE("runs of the operator are all nodes, each once") {
  Scene scene = busy_block();
  scene.numerics.kinematics = Numerics::Kinematics::total;
  Run run(scene);
  start_base(run.scene, run.rocks, run.state);
  const StencilOperator& op = *run.state.total.op;
  const State& state = run.state;
  std::vector<int> written(state.masters.size(), 0);
  for (const StencilRun& of : op.runs) {
    for (std::size_t r = of.first; r < of.last; ++r) ++written[r];
  }
  for (std::size_t r = 0; r < state.masters.size(); ++r) {
    const Master& master = state.masters[r];
    if (master.record != static_cast<int>(r) || !(state.total.m[r] > 0.0)) continue;
    CHECK(written[r] == (master.x == 0.0 && master.y == 0.0 ? 0 : 1));  // corners are held
  }
  CHECK(std::ranges::count(written, 1) > 3000);
  CHECK(std::ranges::none_of(written, [](int times) { return times > 1; }));
}

// Requires the same digits from one, two and three threads; the thread sanitizer looks for races here. Mutations that
// fail: a power that knows the number of threads, and, with the sanitizer, threads that do not wait until all sums are
// 0.
TEST_CASE("enough nodes for threads: their number does not change a digit") {
  using Transfer = Numerics::Transfer;
  using Kinematics = Numerics::Kinematics;
  for (const auto& [kinematics, transfer] :
       {std::pair{Kinematics::updated, Transfer::flip}, std::pair{Kinematics::updated, Transfer::xpic2},
        std::pair{Kinematics::total, Transfer::flip}}) {
    Scene scene = busy_block();
    scene.numerics.kinematics = kinematics;
    scene.numerics.transfer = transfer;
    const State one = after(scene, 1, 40);
    CHECK(one.masters.size() > worth_threads);
    CHECK(one.ledger.kinetic > 0.0);
    for (const int threads : {2, 3}) {
      const State more = after(scene, threads, 40);
      CAPTURE(static_cast<int>(kinematics), static_cast<int>(transfer), threads);
      CHECK(one.particles.x == more.particles.x);
      CHECK(one.particles.v_x == more.particles.v_x);
      CHECK(one.particles.v_y == more.particles.v_y);
      CHECK(one.particles.g_yy == more.particles.g_yy);
      CHECK(one.ledger.kinetic == more.ledger.kinetic);
      CHECK(one.ledger.integration == more.ledger.integration);
      CHECK(one.ledger.body_work == more.ledger.body_work);
    }
  }
}
