// What happens now and then in a run: growth, equilibria, steps of flow and rock together, checkpoints, output.
#include <fmt/format.h>
#include <unistd.h>

#include <vector>

#include "benchmarks/shop.hpp"
#include "explicit/advance.hpp"
#include "output/recorder.hpp"
#include "quasistatic/fluid_step.hpp"
#include "quasistatic/load_steps.hpp"
#include "quasistatic/resting_rock.hpp"

namespace strata::bench {

namespace {

std::size_t fracture_points(const State& state) {
  return state.fracture().points.size();
}

// Steps from the order's start until the fracture has grown so often; how long those steps took in which it grew, and
// the others (s, medians). `step` takes one.
struct Growth {
  double with = 0.0, without = 0.0;
};

template <class Step>
Growth grow_on(State& state, int times, Step step) {
  constexpr int most_steps = 2000;
  std::vector<double> with, without;
  for (int k = 0; k < most_steps && with.size() < static_cast<std::size_t>(times); ++k) {
    const std::size_t before = fracture_points(state);
    const Clock::time_point start = Clock::now();
    step();
    (fracture_points(state) != before ? with : without).push_back(seconds_since(start));
  }
  if (with.size() < static_cast<std::size_t>(times)) throw std::runtime_error("the fracture did not grow");
  return {median(with), without.empty() ? 0.0 : median(without)};
}

constexpr int growths = 4;

// Adds an event that happens to a copy of an order's state; event(work, state) says how long (s) it took.
template <class Event>
void add_event(Shop& shop, const std::string& name, const Order& order, const std::string& label, Event event) {
  add(name, 1, [&shop, order, label, event](benchmark::State& bench) {
    const Workpiece& work = shop.get(order);
    time_part(bench, shop, {label, 1, 1.0, 0.0, 0.0}, [&] {
      State state = work.state;
      return event(work, state);
    });
  })->UseManualTime();
}

// An increment in a run with inertia: what the step in which it happens takes beyond the others.
void add_explicit_growth(Shop& shop, const std::string& kinematics) {
  add_event(shop, "growth/explicit/" + kinematics, {"growing", {"numerics.kinematics=" + kinematics}},
            "mechanics=explicit kinematics=" + kinematics, [](const Workpiece& work, State& state) {
              const Growth taken = grow_on(state, growths, [&] {
                advance(work.scene, work.rocks, state, growth_weighing(work.scene, work.rocks));
              });
              return taken.with - taken.without;
            });
}

// An increment in a run without inertia: the whole step in which it happens, with the equilibrium that follows. And the
// start of one: factor of the block, condensation, first equilibrium.
void add_quasistatic_events(Shop& shop, int cells) {
  const std::vector<std::string> settings{"numerics.mechanics=quasistatic", cell_setting(cells)};
  const std::string label = fmt::format("mechanics=quasistatic cells={}", cells);
  add_event(shop, fmt::format("growth/quasistatic/cells{}", cells), {"growing", settings}, label,
            [](const Workpiece& work, State& state) {
              Quasistatic run;
              start_quasistatic(work.scene, work.rocks, state, run);
              const auto step = [&] { advance_quasistatic(work.scene, work.rocks, 1.0, state, run); };
              return grow_on(state, growths, step).with;
            });
  add_event(shop, fmt::format("start/quasistatic/cells{}", cells), {"", settings}, label,
            [](const Workpiece& work, State& state) {
              Quasistatic run;
              const Clock::time_point start = Clock::now();
              start_quasistatic(work.scene, work.rocks, state, run);
              return seconds_since(start);
            });
}

// Changes the pressure on the fracture (Pa) up and down in turn.
void change_pressure(State& state, double by) {
  for (SurfacePoint& s : state.fracture().points) s.P += by;
}

void add_equilibrium(Shop& shop, const std::string& variant, int cells) {
  const Order order{variant, {"numerics.mechanics=quasistatic", cell_setting(cells)}};
  const std::string name = fmt::format("contact/quasistatic/{}/cells{}", variant.empty() ? "crack" : variant, cells);
  add(name, 10, [&shop, order, variant](benchmark::State& bench) {
    const Workpiece& work = shop.get(order);
    State state = work.state;
    Quasistatic run;
    start_quasistatic(work.scene, work.rocks, state, run);
    const std::size_t places = run.model.places.size();
    const About about{fmt::format("variant={} places={}", variant, places), 1, 1.0, 0.0, 0.0};
    double by = 0.2e6;
    time_work(bench, shop, about, [&] {
      change_pressure(state, by);
      by = -by;
      find_equilibrium(work.scene, state.time, state, run.model);
    });
    bench.counters["places"] = static_cast<double>(places);
  });
}

// A step of flow and rock in one system, from the start of the run; only the step itself is timed.
void add_reynolds(Shop& shop, int cells) {
  const Order order{"reynolds", {cell_setting(cells)}};
  add(fmt::format("flow/reynolds/cells{}", cells), 5, [&shop, order](benchmark::State& bench) {
    const Workpiece& work = shop.get(order);
    State ready = work.state;
    Quasistatic run;
    start_quasistatic(work.scene, work.rocks, ready, run);
    const About about{fmt::format("law=reynolds vertices={}", ready.fracture().vertices.size()), 1, 1.0, 0.0, 0.0};
    time_part(bench, shop, about, [&] {
      State state = ready;
      const Clock::time_point start = Clock::now();
      const FluidStep step = advance_fluid(work.scene, 1e-3, state, run.model);
      const double seconds = seconds_since(start);
      if (!step.found) throw std::runtime_error(step.reason);
      return seconds;
    });
  })->UseManualTime();
}

// A folder of this process for what is written, removed at the end.
class ScratchFolder {
 public:
  ScratchFolder() : path_(std::filesystem::temp_directory_path() / fmt::format("strata_bench_{}", getpid())) {
    std::filesystem::create_directories(path_);
  }
  ScratchFolder(const ScratchFolder&) = delete;
  ScratchFolder& operator=(const ScratchFolder&) = delete;
  ~ScratchFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

void add_writing(Shop& shop, const std::string& what) {
  add("write/" + what, 5, [&shop, what](benchmark::State& bench) {
    const Workpiece& work = shop.get({"", {}});
    const ScratchFolder scratch;
    const RunFolder folder{scratch.path()};
    clear_run_folder(folder, true);
    Recorder recorder(folder);
    recorder.output(work.scene, work.state);
    const About about{"what=" + what, 1, 1.0, 0.0, 0.0};
    time_work(bench, shop, about, [&] {
      if (what == "checkpoint") {
        recorder.checkpoint(work.scene, {work.state, recorder.written()});
      } else {
        recorder.output(work.scene, work.state);
      }
    });
  });
}

}  // namespace

void add_events(Shop& shop) {
  for (const std::string kinematics : {"updated", "total"}) add_explicit_growth(shop, kinematics);
  for (const int cells : {80, 160}) {
    add_quasistatic_events(shop, cells);
    for (const std::string variant : {"", "soft"}) add_equilibrium(shop, variant, cells);
    add_reynolds(shop, cells);
  }
  add_writing(shop, "checkpoint");
  add_writing(shop, "output");
}

}  // namespace strata::bench
