#include "run.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <optional>

#include "advance.hpp"
#include "initialise.hpp"
#include "output/progress.hpp"
#include "output/recorder.hpp"
#include "output/summary.hpp"
#include "scene/toml_reader.hpp"

namespace strata {

namespace {

constexpr int done = 0, bad_input = 2, numerics_failed = 3, interrupted = 130;

// Copies are rebuilt at these steps in every run, and checkpoints are written at no others, so that a resumed run
// starts from exactly what an uninterrupted one holds there.
constexpr std::int64_t steps_between_rebuilds = 250;
constexpr double seconds_between_checkpoints = 60.0;

// A signal handler has nothing else to write to.
volatile std::sig_atomic_t asked_to_stop = 0;
extern "C" void ask_to_stop(int /*signal*/) {
  asked_to_stop = 1;
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

// Length of the run (s) as far as the scene tells it: to the stop time or to the inlet's last pressure; 1 s without
// either.
double expected_duration(const Scene& scene) {
  double duration = scene.stop.time_s.value_or(HUGE_VAL);
  if (scene.stop.inlet_Pa && scene.fluid.rate_Pa_s > 0.0) {
    duration = std::min(duration, (*scene.stop.inlet_Pa - scene.fluid.start_Pa) / scene.fluid.rate_Pa_s);
  }
  return std::isfinite(duration) ? duration : 1.0;
}

double output_interval(const Scene& scene) {
  return scene.output.fields_every_s.value_or(expected_duration(scene) / 50.0);
}

// Why the run is over, or nothing.
std::optional<std::string> reason_to_stop(const Scene& scene, const State& state) {
  const Stop& stop = scene.stop;
  const double slack = 0.5 * state.dt;
  if (stop.time_s && state.time >= *stop.time_s - slack) return fmt::format("time reached {} s", *stop.time_s);
  if (stop.inlet_Pa && state.has_fracture && state.fluid.inlet_Pa >= *stop.inlet_Pa)
    return fmt::format("inlet pressure reached {} Pa", *stop.inlet_Pa);
  const Tip* tip = leading_tip(state);
  if (stop.tip_y_m && tip != nullptr && tip_position(state, *tip).y() >= *stop.tip_y_m - 1e-3 * state.grid.h) {
    return fmt::format("tip reached y = {} m", *stop.tip_y_m);
  }
  return std::nullopt;
}

struct Outcome {
  int exit = done;
  std::string reason;
  double particle_steps = 0.0;
};

void add_stop_event(State& state) {
  const Tip* tip = leading_tip(state);
  const Vec2 at = tip != nullptr ? tip_position(state, *tip) : Vec2{Vec2::Zero()};
  state.events.push_back(
      {"stop", state.time, state.fluid.inlet_Pa, at.x(), at.y(), tip != nullptr && tip->at_interface});
}

std::size_t fracture_points(const State& state) {
  return state.has_fracture ? state.fracture().points.size() : 0;
}

// Steps from `state` to the end of the run; `good` keeps the last state that was known to be sound.
Outcome march(const Scene& scene, const std::vector<Elasticity>& rocks, Recorder& recorder, Progress& progress,
              State& state, State& good) {
  Outcome outcome;
  const double interval = output_interval(scene);
  Clock::time_point last_checkpoint = Clock::now();
  const auto output = [&] {
    state.ledger.strain = strain_energy(rocks, state.particles);
    recorder.output(scene, state);
  };
  if (recorder.outputs() == 0) output();
  while (true) {
    if (auto reason = reason_to_stop(scene, state)) {
      add_stop_event(state);
      output();
      outcome.reason = *reason;
      return outcome;
    }
    if (state.step % steps_between_rebuilds == 0 && state.step > good.step) {
      rebuild(scene, rocks, state);
      good = state;
      const bool stop = asked_to_stop != 0;
      if (stop || seconds_since(last_checkpoint) > seconds_between_checkpoints) {
        recorder.checkpoint(scene, state);
        last_checkpoint = Clock::now();
      }
      if (stop) return {interrupted, "interrupted; `strata resume` goes on from here", outcome.particle_steps};
    }
    const std::size_t points = fracture_points(state);
    advance(scene, rocks, state);
    outcome.particle_steps += static_cast<double>(state.particles.size());
    const bool grown = fracture_points(state) != points;
    if (state.time >= static_cast<double>(recorder.outputs()) * interval - 0.5 * state.dt) {
      output();
    } else if (grown) {
      state.ledger.strain = strain_energy(rocks, state.particles);
      recorder.row(scene, state);
    }
    progress.show(scene, state);
  }
}

int run_from(const Scene& scene, const std::vector<Elasticity>& rocks, const RunFolder& folder, Recorder& recorder,
             State state, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  State good = state;
  RunRecord record;
  record.scene_name = scene.title;
  record.threads = omp_get_max_threads();
  Outcome outcome;
  Progress progress(scene, state, options.quiet);
  try {
    outcome = march(scene, rocks, recorder, progress, state, good);
    record.status = outcome.exit == done ? "completed" : "failed";
  } catch (const NumericalFailure& failure) {
    outcome = {numerics_failed,
               fmt::format("{} The last good state is that of step {}, in result.h5.", failure.what(), good.step), 0.0};
    record.status = "failed";
    state = good;
    recorder.output(scene, state);
  }
  progress.clear();
  recorder.finish();
  record.reason = outcome.reason;
  record.wall_s = seconds_since(start);
  record.particle_steps = outcome.particle_steps;
  if (outcome.exit != interrupted) write_summary(folder.summary(), scene, state, record);
  if (outcome.exit != done) fmt::print(stderr, "{}\n", outcome.reason);
  return outcome.exit;
}

void set_up(const RunOptions& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  std::signal(SIGINT, ask_to_stop);
  std::signal(SIGTERM, ask_to_stop);
}

}  // namespace

int run_scene(const Scene& scene, const RunOptions& options) {
  set_up(options);
  const std::vector<Elasticity> rocks = make_elasticities(scene);
  std::optional<RunFolder> folder;
  try {
    folder = create_run_folder(options.out);
    atomic_write(folder->scene(), scene.resolved_toml);
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return bad_input;
  }
  Recorder recorder(*folder);
  try {
    return run_from(scene, rocks, *folder, recorder, initialise(scene, rocks), options);
  } catch (const NumericalFailure& failure) {
    fmt::print(stderr, "{}\n", failure.what());
    return numerics_failed;
  }
}

int resume_run(const std::filesystem::path& dir, const RunOptions& options) {
  const RunFolder folder{dir};
  const ReadResult read = read_scene(folder.scene(), "", {});
  if (!read.scene) {
    for (const std::string& error : read.errors) fmt::print(stderr, "{}\n", error);
    return bad_input;
  }
  if (std::filesystem::exists(folder.summary())) return done;
  RunOptions same = options;
  same.out = dir;
  if (!std::filesystem::exists(folder.checkpoint())) return run_scene(*read.scene, same);
  set_up(options);
  try {
    Checkpoint checkpoint = load_checkpoint(folder.checkpoint(), *read.scene);
    const std::vector<Elasticity> rocks = make_elasticities(*read.scene);
    rebuild(*read.scene, rocks, checkpoint.state);
    Recorder recorder(folder, checkpoint.mark);
    return run_from(*read.scene, rocks, folder, recorder, std::move(checkpoint.state), options);
  } catch (const NumericalFailure&) {
    throw;
  } catch (const std::runtime_error& error) {
    fmt::print(stderr, "{}\n", error.what());
    return bad_input;
  }
}

}  // namespace strata
