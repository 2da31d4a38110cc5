// What a run shows of itself: while it works a bar on a terminal, elsewhere a line now and then; and when it has ended
// the lines of a summary that is read at once.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include "output/run_folder.hpp"
#include "output/summary.hpp"

namespace strata {

/// How much of the run is done, 0 to 1: the largest of the fractions towards time, inlet pressure and tip at which the
/// scene stops, counted from time 0, the start pressure and the initial fracture; throws nothing.
double fraction_done(const Scene& scene, const State& state);

/// Time (s) as "3 h 05 min", "4 min 10 s" or "12 s", "?" where it is none or negative; throws std::bad_alloc only.
std::string duration_text(double seconds);

/// Time of the run, inlet pressure, height of the tip or of both and time left (s; "?" if nan) as text; throws
/// std::bad_alloc only.
std::string progress_text(const State& state, double fraction, double left_s);

// Cheap enough to be told of every step.
class Progress {
 public:
  /// quiet: show nothing at all.
  Progress(const Scene& scene, const State& start, bool quiet);
  Progress(const Progress&) = delete;
  Progress& operator=(const Progress&) = delete;
  ~Progress();  // takes the bar off the terminal

  /// Shows the state if it is time to: every 0.2 s on a terminal, elsewhere every 10 s; throws nothing of its own.
  void show(const Scene& scene, const State& state);

 private:
  using Clock = std::chrono::steady_clock;
  bool quiet_;
  bool terminal_;
  bool drawn_ = false;
  double start_fraction_;
  Clock::time_point start_ = Clock::now();
  Clock::time_point last_ = start_;
};

/// Lines: how the run ended and why; start, arrests and restarts with pressure and height, and its tips, where it has a
/// fracture; monitors that mark it, where it has a state; where the results are. Throws std::bad_alloc only.
std::string closing_lines(const Scene& scene, const State& state, const RunRecord& record,
                          const std::filesystem::path& folder);

/// That the run has ended and is left as it is, and how it ended by its summary. Throws nothing but std::bad_alloc.
std::string how_it_ended(const RunFolder& folder);

}  // namespace strata
