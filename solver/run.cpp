#include "run.hpp"

#include <fmt/format.h>
#include <omp.h>
#include <sched.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdlib>
#include <optional>
#include <vector>

#include "explicit/advance.hpp"
#include "explicit/total/total_base.hpp"
#include "force_balance.hpp"
#include "initialise.hpp"
#include "interfaces/monitors.hpp"
#include "output/recorder.hpp"
#include "output/terminal.hpp"
#include "quasistatic/load_steps.hpp"
#include "quasistatic/resting_rock.hpp"
#include "scene/derived.hpp"
#include "scene/toml_reader.hpp"

namespace strata {

namespace {

constexpr int done = 0, bad_input = 2, numerics_failed = 3, interrupted = 130;

// Of a run without inertia, whose steps are long: some seconds at 0.25 m cells. After each the contact's tangent is
// factored whole, as a resumed run does.
constexpr std::int64_t steps_between_copies = 100;

// A signal handler has nothing else to write to.
volatile std::sig_atomic_t looks_at_signals = 0;
volatile std::sig_atomic_t asked_to_stop = 0;

// The first signal of a run that goes on lets it end its step; before that there is nothing to save, and a second
// signal means at once. Files are whole at any time.
extern "C" void ask_to_stop(int /*signal*/) {
  if (looks_at_signals == 0 || asked_to_stop != 0) {
    constexpr char text[] =
        "interrupted at once; `strata resume` goes on from the last checkpoint, or from the start\n";
    [[maybe_unused]] const ssize_t written = ::write(STDERR_FILENO, text, sizeof text - 1);
    ::_exit(interrupted);
  }
  asked_to_stop = 1;
}

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) {
  return std::chrono::duration<double>(Clock::now() - start).count();
}

bool is_quasistatic(const Scene& scene) {
  return scene.numerics.mechanics == Numerics::Mechanics::quasistatic;
}

// Why the run is over, or nothing.
std::optional<std::string> reason_to_stop(const Scene& scene, const State& state) {
  const Stop& stop = scene.stop;
  const double slack = is_quasistatic(scene) ? 1e-9 * expected_duration(scene).value_or(1.0) : 0.5 * state.dt;
  if (stop.time_s && state.time >= *stop.time_s - slack) return fmt::format("time reached {} s", *stop.time_s);
  if (stop.inlet_Pa && state.has_fracture && state.fluid.inlet_Pa >= *stop.inlet_Pa * (1.0 - 1e-12))
    return fmt::format("inlet pressure reached {} Pa", *stop.inlet_Pa);
  const Tip* tip = leading_tip(state);
  if (stop.tip_y_m && tip != nullptr && tip_position(state, *tip).y() >= *stop.tip_y_m - 1e-3 * state.grid.h) {
    return fmt::format("tip reached y = {} m", *stop.tip_y_m);
  }
  const bool stuck =
      !state.tips.empty() && std::none_of(state.tips.begin(), state.tips.end(), [](const Tip& t) { return t.growing; });
  if (stuck && !stop.time_s && !stop.inlet_Pa) return "no tip can grow any further: " + state.tips.front().stopped_by;
  return std::nullopt;
}

// What a run holds while it goes on.
struct Run {
  const Scene& scene;
  const std::vector<Elasticity>& rocks;
  Recorder& recorder;
  Clock::time_point start;      // of the process
  Checkpoint good;              // the last state that was known to be sound, and how far the output had come then
  State state = good.state;     // the present one
  std::int64_t saved_step = 0;  // of the state that a resumed run would find
  double interval = 0.0;        // of output times (s)
  double particle_steps = 0.0;  // of this process
  std::optional<Quasistatic> statics{};  // of a run without inertia
  WeighGrowth weigh{};                   // of one with inertia

  double next_output() const { return static_cast<double>(recorder.outputs()) * interval; }
};

void add_stop_event(State& state) {
  const Tip* tip = leading_tip(state);
  const Vec2 at = tip != nullptr ? tip_position(state, *tip) : Vec2{Vec2::Zero()};
  state.events.push_back(
      {"stop", state.time, state.fluid.inlet_Pa, at.x(), at.y(), tip != nullptr && at_interface(*tip), ""});
}

std::size_t fracture_points(const State& state) {
  return state.has_fracture ? state.fracture().points.size() : 0;
}

// Strain energy and fields as they are now; without inertia only those that decide what happens next are kept.
void complete_fields(Run& run) {
  if (run.statics) {
    set_all_particles(run.scene, run.state, run.statics->model);
    watch_forces(run.scene, run.rocks, run.state);
  } else {
    bring_up_to_date(run.scene, run.state);
    run.state.ledger.strain = strain_energy(run.rocks, run.state.particles);
  }
  require_finite(run.state);
  watch_row(run.scene, run.state);
  watch_deformation(run.state);
}

void output(Run& run) {
  if (run.state.time == run.recorder.last_output_s()) return;
  complete_fields(run);
  run.recorder.output(run.scene, run.state);
}

// How far a step without inertia may go (s): to the next output, or to the end.
double next_stop(const Run& run) {
  return std::min(run.next_output(), expected_duration(run.scene).value_or(HUGE_VAL));
}

// Whether the step of inertia that begins ends at an output or with the run, so that a row of the history follows.
bool row_follows(const Run& run) {
  const State& state = run.state;
  const Stop& stop = run.scene.stop;
  const double end = state.time + state.dt, slack = 0.5 * state.dt;
  if (end >= run.next_output() - slack) return true;
  if (stop.time_s && end >= *stop.time_s - slack) return true;
  const Fluid& fluid = run.scene.fluid;
  return stop.inlet_Pa && fluid.start_Pa + fluid.rate_Pa_s * end >= *stop.inlet_Pa * (1.0 - 1e-9);
}

// Whether all interfaces carry what they can: until then a state is neither written nor the last.
bool settled(const Run& run) {
  return !run.statics || !failure_due(*run.statics);
}

// One step and what it leaves to write: fields at output times, a row of the history after growth.
void step_and_record(Run& run) {
  const std::size_t points = fracture_points(run.state);
  if (run.statics) {
    advance_quasistatic(run.scene, run.rocks, next_stop(run), run.state, *run.statics);
  } else {
    advance(run.scene, run.rocks, run.state, run.weigh, row_follows(run));
  }
  run.particle_steps += static_cast<double>(run.state.particles.size());
  const double slack = run.statics ? 1e-9 * run.interval : 0.5 * run.state.dt;
  if (settled(run) && run.state.time >= run.next_output() - slack) {
    output(run);
  } else if (fracture_points(run.state) != points) {
    if (!run.statics) run.state.ledger.strain = strain_energy(run.rocks, run.state.particles);
    watch_row(run.scene, run.state);
    run.recorder.row(run.scene, run.state);
  }
}

void save_good_state(Run& run) {
  if (run.good.state.step <= run.saved_step) return;
  run.recorder.checkpoint(run.scene, run.good.state, run.good.mark);
  run.saved_step = run.good.state.step;
}

// Keeps the state where it is as a resumed run finds it.
void keep_if_sound(Run& run) {
  const bool total = run.scene.numerics.kinematics == Numerics::Kinematics::total;
  const std::int64_t steps = run.statics ? steps_between_copies : total ? steps_between_bases : steps_between_rebuilds;
  if (run.state.step % steps != 0 || run.state.step <= run.good.state.step) return;
  run.good = {run.state, run.recorder.mark()};
  if (run.statics) restart_quasistatic(run.scene, run.rocks, run.state, *run.statics);  // as a resumed run starts
  run.weigh = growth_weighing(run.scene, run.rocks);
}

// Steps from run.state to the end of the run: why it is over, or nothing where it is interrupted.
std::optional<std::string> march(Run& run, double checkpoint_every_s, Progress& progress) {
  Clock::time_point last_checkpoint = Clock::now();
  while (true) {
    if (settled(run) && run.recorder.outputs() == 0) output(run);
    if (auto reason = reason_to_stop(run.scene, run.state); reason && settled(run)) {
      add_stop_event(run.state);
      output(run);
      return reason;
    }
    keep_if_sound(run);
    const bool stop = asked_to_stop != 0;
    if (stop || seconds_since(last_checkpoint) > checkpoint_every_s) {
      save_good_state(run);
      last_checkpoint = Clock::now();
    }
    if (stop) {
      complete_fields(run);  // for what is said of them
      return std::nullopt;
    }
    step_and_record(run);
    progress.show(run.scene, run.state);
  }
}

// The command by which a run goes on, and from where.
std::string resume_text(const Run& run, const RunFolder& folder) {
  return fmt::format("`strata resume {}` goes on from {}", folder.path.string(),
                     run.saved_step > 0 ? fmt::format("step {}", run.saved_step) : "the start");
}

// The run to its end, its failure or its interruption: the exit status. The last leaves no summary.
int run_to_end(Run& run, const RunFolder& folder, const RunOptions& options, RunRecord& record) {
  Progress progress(run.scene, run.state, options.quiet);
  int exit = done;
  try {
    if (is_quasistatic(run.scene)) start_quasistatic(run.scene, run.rocks, run.state, run.statics.emplace());
    run.good.state = run.state;
    looks_at_signals = 1;
    const std::optional<std::string> reason = march(run, options.checkpoint_every_s, progress);
    if (!reason) exit = interrupted, record.status = "interrupted";
    record.reason = reason ? *reason : resume_text(run, folder);
  } catch (const NumericalFailure& failure) {
    exit = numerics_failed, record.status = "failed";
    record.reason =
        fmt::format("{}. The last good state, of step {}, is in checkpoint.bin.", failure.what(), run.good.state.step);
    run.state = run.good.state;
    run.recorder.checkpoint(run.scene, run.good.state, run.good.mark);
  }
  record.wall_s = seconds_since(run.start);
  record.particle_steps = run.particle_steps;
  if (exit == interrupted) return exit;
  run.recorder.finish();
  atomic_write(folder.summary(), summary_json(run.scene, run.state, record));
  return exit;
}

RunRecord make_record(const Scene& scene) {
  RunRecord record;
  record.scene_name = scene.title.empty() ? scene.name : scene.title;
  record.threads = omp_get_max_threads();
  record.status = "completed";
  return record;
}

// What to do where the disc or the folder fails in the middle of a run.
std::string after_output_failure(const OutputFailure& failure, const Run& run, const RunFolder& folder) {
  const std::string where =
      fmt::format("{}.\nThe run ends at step {}, t = {:.6g} s.", failure.what(), run.state.step, run.state.time);
  std::error_code error;
  if (!std::filesystem::exists(folder.scene(), error)) {
    return fmt::format("{} Its folder {} is gone. Put it back and `strata resume` it, or run the scene again.", where,
                       folder.path.string());
  }
  return fmt::format("{} What was written before is whole: once the folder can be written, {}.", where,
                     resume_text(run, folder));
}

int run_from(Run run, const RunFolder& folder, const RunOptions& options) {
  run.saved_step = run.state.step;
  run.interval = run.scene.output.fields_every_s.value_or(expected_duration(run.scene).value_or(1.0) / 50.0);
  run.weigh = growth_weighing(run.scene, run.rocks);
  RunRecord record = make_record(run.scene);
  int exit = done;
  try {
    exit = run_to_end(run, folder, options, record);
  } catch (const OutputFailure& failure) {
    fmt::print(stderr, "{}\n", after_output_failure(failure, run, folder));
    return bad_input;
  }
  if (!options.quiet) {
    fmt::print(stderr, "{}", closing_lines(run.scene, run.state, record, folder.path));
  } else if (exit != done) {
    fmt::print(stderr, "{}{}\n", exit == interrupted ? "interrupted; " : "", record.reason);
  }
  return exit;
}

// The summary of a run that fails before it has a first state.
int fail_at_start(const Scene& scene, const RunFolder& folder, const NumericalFailure& failure,
                  Clock::time_point start) {
  RunRecord record = make_record(scene);
  record.status = "failed";
  record.reason = fmt::format("{}. The run has no state yet.", failure.what());
  record.wall_s = seconds_since(start);
  fmt::print(stderr, "{}\n", record.reason);
  try {
    atomic_write(folder.summary(), summary_json(scene, State(), record));
  } catch (const OutputFailure& also) {
    fmt::print(stderr, "{}\n", also.what());
  }
  return numerics_failed;
}

// Threads that the system moves between processors wait for each other's caches at every step. Each is kept on its own
// processor, but only where the run has as many threads as the process may use processors: runs side by side with fewer
// threads each would otherwise meet on the first ones. What the user says of places (OMP_PROC_BIND, OMP_PLACES) counts.
void pin_threads() {
  const int threads = omp_get_max_threads();
  if (threads < 2 || std::getenv("OMP_PROC_BIND") != nullptr || std::getenv("OMP_PLACES") != nullptr) return;
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) != threads) return;
  std::vector<std::size_t> processors;
  for (std::size_t k = 0; k < CPU_SETSIZE; ++k) {
    if (CPU_ISSET(k, &allowed)) processors.push_back(k);
  }
#pragma omp parallel num_threads(threads)
  {
    cpu_set_t own;
    CPU_ZERO(&own);
    CPU_SET(processors[static_cast<std::size_t>(omp_get_thread_num())], &own);
    sched_setaffinity(0, sizeof own, &own);  // a thread that cannot be kept runs where it is put
  }
}

void set_up(const Scene& scene, const RunOptions& options) {
  if (options.threads > 0) omp_set_num_threads(options.threads);
  if (is_quasistatic(scene)) omp_set_num_threads(1);  // its loops over particles are short; threads would only wait
  Eigen::setNbThreads(1);  // equilibria have the same digits whatever the threads of the steps
  pin_threads();
  for (const int signal : {SIGINT, SIGTERM}) std::signal(signal, ask_to_stop);
  // Errors of writing are told by what is written: a file that may not grow, a terminal that is gone.
  for (const int signal : {SIGXFSZ, SIGPIPE}) std::signal(signal, SIG_IGN);
}

// From a checkpoint or, without one, from the initial state.
int run_on(const Scene& scene, const RunFolder& folder, const RunOptions& options, Clock::time_point start,
           Recorder& recorder, std::optional<Checkpoint> from) {
  const std::vector<Elasticity> rocks = make_elasticities(scene);
  try {
    if (from) {
      restore(scene, from->state);
    } else {
      from = Checkpoint{initialise(scene, rocks), recorder.mark()};
    }
    return run_from({scene, rocks, recorder, start, std::move(*from)}, folder, options);
  } catch (const NumericalFailure& failure) {
    return fail_at_start(scene, folder, failure, start);
  }
}

int run_anew(const Scene& scene, const RunOptions& options, const std::filesystem::path& path, bool replace,
             Clock::time_point start) {
  const RunFolder folder = clear_run_folder(path, replace);
  atomic_write(folder.scene(), scene.resolved_toml);
  Recorder recorder(folder);
  return run_on(scene, folder, options, start, recorder, std::nullopt);
}

}  // namespace

int run_scene(const Scene& scene, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  set_up(scene, options);
  const Descriptor lock = make_run_folder(options.out);
  if (!options.quiet)
    fmt::print(stderr, "{:.2g} points, {:.2g} GB by estimate\n", points_of(scene), 1e-9 * memory_need(scene));
  return run_anew(scene, options, options.out, options.replace, start);
}

int resume_run(const std::filesystem::path& dir, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  const Descriptor lock = lock_folder(dir);
  const RunFolder folder{dir};
  const ReadResult read = read_scene(folder.scene(), "", {});
  for (const std::string& error : read.errors) fmt::print(stderr, "{}\n", error);
  if (!read.scene) return bad_input;
  const Scene& scene = *read.scene;
  require_unchanged_scene(folder, scene);
  if (std::filesystem::exists(folder.summary())) {
    if (!options.quiet) fmt::print(stderr, "{}\n", how_it_ended(folder));
    return done;
  }
  const std::string begun_by = made_with(folder.result()).version;
  if (!begun_by.empty() && begun_by != version()) {
    fmt::print(stderr, "{}: begun by strata {}, goes on with {}, whose digits may differ\n", dir.string(), begun_by,
               version());
  }
  set_up(scene, options);
  std::optional<Checkpoint> checkpoint;
  std::optional<Recorder> recorder;
  try {
    checkpoint = load_checkpoint(folder.checkpoint(), scene);
    recorder.emplace(folder, checkpoint->mark);
  } catch (const OutputFailure&) {
    throw;
  } catch (const std::runtime_error& error) {  // nothing to go on from, or files that hold less than it says
    fmt::print(stderr, "{} The run starts anew.\n", error.what());
    return run_anew(scene, options, dir, true, start);
  }
  return run_on(scene, folder, options, start, *recorder, std::move(checkpoint));
}

}  // namespace strata
