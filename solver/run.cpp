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
#include "output/fields.hpp"
#include "output/recorder.hpp"
#include "output/summary.hpp"
#include "output/terminal.hpp"
#include "quasistatic/load_steps.hpp"
#include "quasistatic/resting_rock.hpp"
#include "scene/derived.hpp"
#include "scene/keys.hpp"
#include "scene/messages.hpp"
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

// Why a run is over, and the tip that ended it; or the leading one, or none.
struct Ending {
  std::string reason;
  const Tip* tip;
};

// How the run is over, or nothing.
std::optional<Ending> ending_of(const Scene& scene, const State& state) {
  const Stop& stop = scene.stop;
  const double slack = is_quasistatic(scene) ? 1e-9 * expected_duration(scene).value_or(1.0) : 0.5 * state.dt;
  const Tip *tip = leading_tip(state), *lower = lower_tip(state);
  if (stop.time_s && state.time >= *stop.time_s - slack) return {{fmt::format("time reached {} s", *stop.time_s), tip}};
  if (stop.inlet_Pa && state.has_fracture && state.fluid.inlet_Pa >= *stop.inlet_Pa * (1.0 - 1e-12))
    return {{fmt::format("inlet pressure reached {} Pa", *stop.inlet_Pa), tip}};
  const double near = 1e-3 * state.grid.h;
  if (stop.tip_y_m && tip && tip_position(state, *tip).y() >= *stop.tip_y_m - near)
    return {{fmt::format("{}tip reached y = {} m", lower ? "upper " : "", *stop.tip_y_m), tip}};
  if (stop.lower_tip_y_m && lower && tip_position(state, *lower).y() <= *stop.lower_tip_y_m + near)
    return {{fmt::format("lower tip reached y = {} m", *stop.lower_tip_y_m), lower}};
  const bool stuck = !state.tips.empty() && std::ranges::none_of(state.tips, &Tip::growing);
  if (stuck && !stop.time_s && !stop.inlet_Pa)
    return {{"no tip can grow any further: " + state.tips.front().stopped_by, tip}};
  return std::nullopt;
}

// What a run holds while it goes on.
struct Run {
  const Scene& scene;
  const RunFolder& folder;
  const RunOptions& options;
  Clock::time_point start;  // of the process
  Recorder recorder;
  Checkpoint good;  // the last state that was known to be sound, and what had been written then; or none yet
  Rocks rocks = make_elasticities(scene);
  double interval = scene.output.fields_every_s.value_or(expected_duration(scene).value_or(1.0) / 50.0);  // s
  State state = State();                              // the present one
  std::int64_t saved_step = good.state.step;          // of the state that a resumed run would find
  double particle_steps = 0.0;                        // of this process
  std::optional<Quasistatic> statics{};               // of a run without inertia
  WeighGrowth weigh = growth_weighing(scene, rocks);  // of one with inertia

  const std::vector<double>& output_times() const { return recorder.written().output_times; }
  // Where no time or pressure bounds the run its length is not known: from ten intervals on each output is a tenth
  // later than the one before, so that a run a thousand times as long writes 72 more.
  double next_output() const {
    const std::vector<double>& times = output_times();
    const bool even = scene.output.fields_every_s || expected_duration(scene) || times.empty();
    return even ? static_cast<double>(times.size()) * interval : times.back() + std::max(interval, 0.1 * times.back());
  }
};

// The first state, or that of a checkpoint made whole; both as a resumed run finds them.
void begin(Run& run) {
  if (run.good.state.particles.size() == 0) {
    run.good.state = initialise(run.scene, run.rocks);
  } else {
    restore(run.scene, run.good.state);
  }
  run.state = run.good.state;
  if (is_quasistatic(run.scene)) start_quasistatic(run.scene, run.rocks, run.state, run.statics.emplace());
  run.good.state = run.state;
}

// Of the tip that ended the run, or the leading one.
void add_stop_event(State& state, const Tip* tip) {
  const Vec2 at = tip != nullptr ? tip_position(state, *tip) : Vec2{Vec2::Zero()};
  const bool near = tip != nullptr && at_interface(*tip);
  state.events.push_back({"stop", state.time, state.fluid.inlet_Pa, at.x(), at.y(), near, "",
                          tip != nullptr ? tip_name(state, *tip) : ""});
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
  if (!run.output_times().empty() && run.output_times().back() == run.state.time) return;
  complete_fields(run);
  run.recorder.output(run.scene, run.state);
}

// Whether the step of inertia that begins ends at an output or with the run, so that a row of the history follows.
bool row_follows(const Run& run) {
  const State& state = run.state;
  const Stop& stop = run.scene.stop;
  const double end = state.time + state.dt, slack = 0.5 * state.dt;
  if (end >= run.next_output() - slack) return true;
  if (stop.time_s && end >= *stop.time_s - slack) return true;
  return stop.inlet_Pa && run.scene.fluid.inlet_pressure(end) >= *stop.inlet_Pa * (1.0 - 1e-9);
}

// Whether all interfaces carry what they can: until then a state is neither written nor the last.
bool settled(const Run& run) {
  return !run.statics || !failure_due(*run.statics);
}

// One step and what it leaves to write: fields at output times, a row of the history after growth.
void step_and_record(Run& run) {
  const auto points = [&] { return run.state.has_fracture ? run.state.fracture().points.size() : 0; };
  const std::size_t before = points();
  if (run.statics) {
    const double stop = std::min(run.next_output(), expected_duration(run.scene).value_or(HUGE_VAL));
    advance_quasistatic(run.scene, run.rocks, stop, run.state, *run.statics);
  } else {
    advance(run.scene, run.rocks, run.state, run.weigh, row_follows(run));
  }
  run.particle_steps += static_cast<double>(run.state.particles.size());
  const double slack = run.statics ? 1e-9 * run.interval : 0.5 * run.state.dt;
  if (settled(run) && run.state.time >= run.next_output() - slack) {
    output(run);
  } else if (points() != before) {
    if (!run.statics) run.state.ledger.strain = strain_energy(run.rocks, run.state.particles);
    watch_row(run.scene, run.state);
    run.recorder.row(run.scene, run.state);
  }
}

// Keeps the state where it is as a resumed run finds it.
void keep_if_sound(Run& run) {
  const bool total = run.scene.numerics.kinematics == Numerics::Kinematics::total;
  const std::int64_t steps = run.statics ? steps_between_copies : total ? steps_between_bases : steps_between_rebuilds;
  if (run.state.step % steps != 0 || run.state.step <= run.good.state.step) return;
  run.good = {run.state, run.recorder.written()};
  if (run.statics) restart_quasistatic(run.scene, run.rocks, run.state, *run.statics);  // as a resumed run starts
  run.weigh = growth_weighing(run.scene, run.rocks);
}

// Steps to the end of the run: why it is over, or nothing where it is interrupted.
std::optional<std::string> march(Run& run) {
  Progress progress(run.scene, run.state, run.options.quiet);
  Clock::time_point last_checkpoint = Clock::now();
  while (true) {
    if (settled(run) && run.output_times().empty()) output(run);
    if (auto ending = ending_of(run.scene, run.state); ending && settled(run)) {
      add_stop_event(run.state, ending->tip);
      output(run);
      return ending->reason;
    }
    keep_if_sound(run);
    const bool stop = asked_to_stop != 0;
    if (stop || seconds_since(last_checkpoint) > run.options.checkpoint_every_s) {
      if (run.good.state.step > run.saved_step) run.recorder.checkpoint(run.scene, run.good);
      run.saved_step = run.good.state.step;
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
std::string resume_text(const Run& run) {
  return fmt::format("`strata resume {}` goes on from {}", run.folder.path.string(),
                     run.saved_step > 0 ? fmt::format("step {}", run.saved_step) : "the start");
}

// The run to its end, its failure or its interruption: the exit status, and what is to be said of it.
int march_to_end(Run& run, RunRecord& record) {
  try {
    begin(run);
    looks_at_signals = 1;
    if (const std::optional<std::string> reason = march(run)) {
      record.status = "completed", record.reason = *reason;
      return done;
    }
    record.status = "interrupted", record.reason = resume_text(run);
    return interrupted;
  } catch (const NumericalFailure& failure) {
    const bool begun = run.good.state.particles.size() > 0;
    record.status = "failed";
    record.reason =
        fmt::format("{}. {}", failure.what(),
                    begun ? fmt::format("The last good state, of step {}, is in checkpoint.bin.", run.good.state.step)
                          : "The run has no state yet.");
    run.state = run.good.state;
    if (begun) run.recorder.checkpoint(run.scene, run.good);
    return numerics_failed;
  }
}

// Steps, writes what is left to write, and says how it went; the exit status. An interrupted run has no summary.
int run_to_end(Run run) {
  RunRecord record;
  record.scene_name = run.scene.title.empty() ? run.scene.name : run.scene.title;
  record.threads = omp_get_max_threads();
  int exit = done;
  try {
    exit = march_to_end(run, record);
    record.wall_s = seconds_since(run.start);
    record.particle_steps = run.particle_steps;
    run.recorder.gather();
    if (exit != interrupted) {
      atomic_write(run.folder.summary(), summary_json(run.scene, run.state, record));
      remove_file(run.folder.all_fields());
    }
  } catch (const OutputFailure& failure) {
    tell(
        "{}.\nThe run ends at step {}, t = {:.6g} s. What was written before is whole: once its folder is there "
        "and can be written, {}.\n",
        failure.what(), run.state.step, run.state.time, resume_text(run));
    return bad_input;
  }
  if (!run.options.quiet) {
    const std::string lines = closing_lines(run.scene, run.state, record, run.folder.path);
    tell("{}", in_colour(lines, {{"^()(completed)", "32"}, {"^()(failed)", "31"}, {"(\n)(SUSPECT)", "31"}}));
  } else if (exit != done) {
    tell("{}{}\n", exit == interrupted ? "interrupted; " : "", record.reason);
  }
  return exit;
}

// Threads that the system moves between processors wait for each other's caches at every step. Each is kept on its own
// processor, but only where the run has as many threads as the process may use processors: runs side by side with fewer
// threads each would otherwise meet on the first ones. What the user says of places (OMP_PROC_BIND, OMP_PLACES) counts.
void pin_threads() {
  const int threads = omp_get_max_threads();
  cpu_set_t allowed;
  CPU_ZERO(&allowed);
  if (threads < 2 || std::getenv("OMP_PROC_BIND") != nullptr || std::getenv("OMP_PLACES") != nullptr ||
      sched_getaffinity(0, sizeof allowed, &allowed) != 0 || CPU_COUNT(&allowed) != threads)
    return;
#pragma omp parallel num_threads(threads)
  {
    std::size_t processor = 0;  // the thread's own: as many come before it as threads do
    for (int before = omp_get_thread_num(); before > 0 || !CPU_ISSET(processor, &allowed); ++processor)
      before -= CPU_ISSET(processor, &allowed) ? 1 : 0;
    cpu_set_t own;
    CPU_ZERO(&own);
    CPU_SET(processor, &own);
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

int run_anew(const Scene& scene, const RunOptions& options, const RunFolder& folder, bool replace,
             Clock::time_point start) {
  clear_run_folder(folder, replace);
  atomic_write(folder.scene(), scene.resolved_toml);
  return run_to_end({scene, folder, options, start, Recorder(folder, {}, scene), Checkpoint()});
}

}  // namespace

int run_scene(const Scene& scene, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  set_up(scene, options);
  const RunFolder folder{options.out};
  make_folder(folder.path);
  const fmt::file lock = lock_folder(folder.path);
  if (!options.quiet) tell("{}\n", announce(scene));
  return run_anew(scene, options, folder, options.replace, start);
}

int resume_run(const std::filesystem::path& dir, const RunOptions& options) {
  const Clock::time_point start = Clock::now();
  const RunFolder folder{dir};
  const fmt::file lock = lock_folder(dir);
  const ReadResult read = read_scene(folder.scene(), "", {});
  for (const std::string& error : read.errors) tell("{}\n", error_in_colour(error));
  if (!read.scene) return bad_input;
  const Scene& scene = *read.scene;
  require_unchanged_scene(folder, scene);
  if (std::filesystem::exists(folder.summary())) {
    remove_file(folder.all_fields());  // of a process that was killed after its last word
    if (!options.quiet) tell("{}\n", how_it_ended(folder));
    return done;
  }
  const std::string begun_by = made_with(folder).version;
  if (!begun_by.empty() && begun_by != version()) {
    tell("{}: begun by strata {}, goes on with {}, whose digits may differ\n", dir.string(), begun_by, version());
  }
  set_up(scene, options);
  std::optional<Run> run;
  try {
    Checkpoint from = load_checkpoint(folder.checkpoint(), scene);
    Recorder recorder(folder, from.written, scene);
    run.emplace(Run{scene, folder, options, start, std::move(recorder), std::move(from)});
  } catch (const OutputFailure&) {
    throw;
  } catch (const std::runtime_error& error) {  // nothing to go on from, or fields are missing
    tell("{} The run starts anew.\n", error.what());
    return run_anew(scene, options, folder, true, start);
  }
  return run_to_end(std::move(*run));
}

}  // namespace strata
