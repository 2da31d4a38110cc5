#include <catch2/catch.hpp>
#include <vector>

#include "output/checkpoint.hpp"
#include "output/run_folder.hpp"
#include "output_state.hpp"

using namespace strata;
using namespace strata::test;

namespace {

const Written written{{{0.1 / 3, 2.0}, {0.2 / 3, 4.0}}, {0.1 / 7}};

}  // namespace

// Every member of what is saved is listed, or checkpoint.cpp does not compile: equal bytes are equal states.
TEST_CASE("a checkpoint gives the state back to the same digits") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  State state = made_state();
  state.surfaces[0].vertices[1].u = {1e-3, -2e-3};
  Numbers number{900};
  state.tips.push_back(made_tip(false, number));
  state.reynolds.leaked = {number.next(), number.next()};
  for (int k = 0; k < 3; ++k) state.total.velocity.push_back({number.next(), number.next()});
  save_checkpoint(file, made_scene(), {state, written});
  const Checkpoint checkpoint = load_checkpoint(file, made_scene());
  CHECK(checkpoint.written.rows == written.rows);
  CHECK(checkpoint.written.output_times == written.output_times);
  CHECK(checkpoint.state.time == state.time);
  CHECK(checkpoint.state.particles.g_xy == state.particles.g_xy);
  CHECK(checkpoint.state.surfaces[1].points[2].w == state.surfaces[1].points[2].w);
  CHECK(checkpoint.state.reynolds.leaked == state.reynolds.leaked);
  CHECK(checkpoint.state.tips[1].reached == state.tips[1].reached);
  CHECK(checkpoint.state.events[1].by == "energy");
  CHECK(checkpoint.state.events[1].tip == "lower");
  CHECK(checkpoint.state.ledger.largest == state.ledger.largest);
  CHECK(checkpoint.state.monitors.mirror == 1);
  CHECK(checkpoint.state.total.velocity == state.total.velocity);
  const std::string before = content_of(file);
  save_checkpoint(file, made_scene(), checkpoint);
  CHECK(content_of(file) == before);
}

TEST_CASE("an empty state and numbers that are not finite survive a checkpoint") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  State state;
  state.ledger.strain = std::numeric_limits<double>::infinity();
  state.ledger.kinetic = -0.0;
  save_checkpoint(file, made_scene(), {state, {}});
  const Checkpoint checkpoint = load_checkpoint(file, made_scene());
  CHECK(checkpoint.state.ledger.strain == state.ledger.strain);
  CHECK(checkpoint.state.particles.size() == 0);
  CHECK(std::signbit(checkpoint.state.ledger.kinetic));
}

TEST_CASE("a checkpoint that was cut short or changed anywhere is refused") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  save_checkpoint(file, made_scene(), {made_state(), written});
  const std::string whole = content_of(file);
  for (std::size_t n = 0; n < whole.size(); n += n < 80 ? 1 : 97) {
    INFO("cut to " << n << " of " << whole.size() << " bytes");
    std::ofstream(file, std::ios::binary) << whole.substr(0, n);
    CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("checkpoint.bin: is "));
  }
  for (std::size_t n = 0; n < whole.size(); n += n < 80 ? 1 : 97) {
    INFO("byte " << n << " changed");
    std::string changed = whole;
    changed[n] = static_cast<char>(changed[n] ^ 4);
    std::ofstream(file, std::ios::binary) << changed;
    CHECK_THROWS_AS(load_checkpoint(file, made_scene()), std::runtime_error);
  }
  std::ofstream(file, std::ios::binary) << whole << "more";
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("is torn"));
}

TEST_CASE("a checkpoint of another scene, another format or none at all is refused by name") {
  const TemporaryFolder folder;
  const auto file = folder.path / "checkpoint.bin";
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("checkpoint.bin: cannot be opened"));
  std::ofstream(file) << "something else altogether, and long enough to be one, if only its beginning were right";
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("is no checkpoint of strata"));

  save_checkpoint(file, made_scene(), {made_state(), written});
  Scene other = made_scene();
  other.resolved_toml += "height_m = 7.0\n";
  CHECK_THROWS_WITH(load_checkpoint(file, other), Catch::Contains("belongs to another scene"));

  std::string bytes = content_of(file);
  bytes[std::string("strata-checkpoint ").size()] = '9';
  std::ofstream(file, std::ios::binary) << bytes;
  CHECK_THROWS_WITH(load_checkpoint(file, made_scene()), Catch::Contains("has another version's format"));
}
