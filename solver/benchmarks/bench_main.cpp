// strata_bench: the solver's kernels and events, timed beside the machine's own rates. verification/benchmarks/ runs it
// and reads its JSON; `strata_bench --benchmark_list_tests` lists what there is.
#include <benchmark/benchmark.h>

#include <cstdlib>
#include <filesystem>

#include "benchmarks/shop.hpp"

int main(int argc, char** argv) {
  const char* scene = std::getenv("STRATA_BENCH_SCENE");
  strata::bench::Shop shop(scene != nullptr ? scene : STRATA_BENCH_SCENE);
  benchmark::AddCustomContext("compiler", STRATA_COMPILER);
  benchmark::AddCustomContext("flags", STRATA_FLAGS);
  strata::bench::add_calibration(shop);
  strata::bench::add_steps(shop);
  strata::bench::add_stages(shop);
  strata::bench::add_events(shop);
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  benchmark::Shutdown();
  return 0;
}
