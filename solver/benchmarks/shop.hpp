// What every benchmark needs: a scene made ready, the machine's rates beside it, and numbers told in one way.
#pragma once

#include <benchmark/benchmark.h>

#include <filesystem>
#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "benchmarks/calibration.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata::bench {

// A scene with the state it starts from.
struct Workpiece {
  Scene scene;
  Rocks rocks;
  State state;
};

// Which scene: a variant of verification/benchmarks/block.toml and settings "key.path=value".
struct Order {
  std::string variant;
  std::vector<std::string> settings;
};

class Shop {
 public:
  /// scene: the file all orders are variants of.
  explicit Shop(std::filesystem::path scene) : scene_(std::move(scene)) {}

  /// The ordered scene in the state that initialise() gives it, or as the last benchmark of the same order left it.
  /// Of the latest order only: what it holds may be large. Throws std::runtime_error where the scene is refused.
  Workpiece& get(const Order& order);

  /// Rates of the machine for so many threads. Measured anew at each call.
  Rates rates(int threads);

 private:
  std::filesystem::path scene_;
  std::string name_;  // of the order that work_ is
  std::unique_ptr<Workpiece> work_;
  std::map<int, Calibration> calibrations_;
};

// What a benchmark says of itself beside its time.
struct About {
  std::string label;  // "key=value key=value": what was run
  int threads = 1;
  double units = 1.0;  // what one iteration does: particle-steps, solves, events
  double flop = 0.0;   // of a unit, 0: not counted
  double bytes = 0.0;  // of a unit to and from the caches' other side, 0: not counted
};

/// Times `work` (one iteration) between two measurements of the machine's rates, whose mean is told as counters
/// peak_flop_s, stream_B_s and round_trip_s beside those of `about`. A first call is not timed: caches are cold after a
/// measurement.
void time_work(benchmark::State& bench, Shop& shop, const About& about, const std::function<void()>& work);

/// The same for work that says itself how long (s) the part of it took that counts; needs UseManualTime().
void time_part(benchmark::State& bench, Shop& shop, const About& about, const std::function<double()>& work);

/// Registers a benchmark of a fixed number of iterations. What it throws is told as its error.
benchmark::internal::Benchmark* add(const std::string& name, std::int64_t iterations,
                                    const std::function<void(benchmark::State&)>& run);

/// Median of numbers; NaN of none.
double median(std::vector<double> values);

/// A cell size (m) as the key numerics.cell_m for so many cells across the block's 80 m.
std::string cell_setting(int cells);

void add_calibration(Shop& shop);
void add_steps(Shop& shop);
void add_stages(Shop& shop);
void add_events(Shop& shop);

}  // namespace strata::bench
