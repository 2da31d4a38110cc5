#include "benchmarks/shop.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "initialise.hpp"
#include "scene/toml_reader.hpp"

namespace strata::bench {

Workpiece& Shop::get(const Order& order) {
  const std::string name = fmt::format("{} {}", order.variant, fmt::join(order.settings, " "));
  if (work_ && name == name_) return *work_;
  work_.reset();
  const ReadResult read = read_scene(scene_, order.variant, order.settings);
  if (!read.scene) throw std::runtime_error(fmt::format("{}", fmt::join(read.errors, "\n")));
  auto work = std::make_unique<Workpiece>();
  work->scene = *read.scene;
  work->rocks = make_elasticities(work->scene);
  work->state = initialise(work->scene, work->rocks);
  name_ = name;
  work_ = std::move(work);
  return *work_;
}

Rates Shop::rates(int threads) {
  return calibrations_.try_emplace(threads, threads).first->second.measure();
}

namespace {

void tell(benchmark::State& bench, const About& about, const Rates& before, const Rates& after) {
  bench.SetLabel(about.label);
  bench.counters["threads_used"] = about.threads;
  bench.counters["units"] = about.units;
  bench.counters["flop_a_unit"] = about.flop;
  bench.counters["byte_a_unit"] = about.bytes;
  bench.counters["peak_flop_s"] = 0.5 * (before.flop_s + after.flop_s);
  bench.counters["stream_B_s"] = 0.5 * (before.byte_s + after.byte_s);
  bench.counters["round_trip_s"] = 0.5 * (before.round_trip_s + after.round_trip_s);
}

}  // namespace

void time_work(benchmark::State& bench, Shop& shop, const About& about, const std::function<void()>& work) {
  omp_set_num_threads(about.threads);
  const Rates before = shop.rates(about.threads);
  work();
  for ([[maybe_unused]] auto _ : bench) work();
  tell(bench, about, before, shop.rates(about.threads));
}

void time_part(benchmark::State& bench, Shop& shop, const About& about, const std::function<double()>& work) {
  omp_set_num_threads(about.threads);
  const Rates before = shop.rates(about.threads);
  work();
  for ([[maybe_unused]] auto _ : bench) bench.SetIterationTime(work());
  tell(bench, about, before, shop.rates(about.threads));
}

benchmark::internal::Benchmark* add(const std::string& name, std::int64_t iterations,
                                    const std::function<void(benchmark::State&)>& run) {
  const auto guarded = [run](benchmark::State& bench) {
    try {
      run(bench);
    } catch (const std::exception& error) {
      bench.SkipWithError(error.what());
    }
  };
  return benchmark::RegisterBenchmark(name.c_str(), guarded)->Iterations(iterations)->Unit(benchmark::kSecond);
}

double median(std::vector<double> values) {
  if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

std::string cell_setting(int cells) {
  return fmt::format("numerics.cell_m={}", 80.0 / cells);
}

}  // namespace strata::bench
