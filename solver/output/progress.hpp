// What a run shows of itself while it works: a bar on a terminal, elsewhere a line now and then.
#pragma once

#include <chrono>
#include <string>

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

/// How much of the run is done, 0 to 1: the largest of the fractions towards time, inlet pressure and tip at which the
/// scene stops, counted from time 0, the start pressure and the initial fracture; throws nothing.
double fraction_done(const Scene& scene, const State& state);

/// Time (s) as "3 h 05 min", "4 min 10 s" or "12 s", "?" where it is not finite or negative; throws std::bad_alloc
/// only.
std::string duration_text(double seconds);

/// Time of the run, inlet pressure, tip height and time left (s; "?" if nan) as text; throws std::bad_alloc only.
std::string progress_text(const State& state, double fraction, double left_s);

// Cheap enough to be told of every step.
class Progress {
 public:
  /// quiet: show nothing at all.
  Progress(const Scene& scene, const State& start, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();

  /// Shows the state if it is time to: every 0.2 s on a terminal, elsewhere every 10 s; throws nothing of its own.
  void show(const Scene& scene, const State& state);

  /// Takes the bar off the terminal, so that other lines may be printed; throws nothing.
  void clear();

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  double start_fraction_;
  Clock::time_point start_;
  Clock::time_point last_;
};

}  // namespace strata
