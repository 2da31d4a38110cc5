#include "output/progress.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>

#include "output/history.hpp"

namespace strata {

namespace {

// Way from `from` to `to` that is done at `now`, 0 to 1; a bound that is already reached is 1.
double way(double from, double to, double now) {
  if (now >= to) return 1.0;
  return std::clamp((now - from) / (to - from), 0.0, 1.0);
}

double initial_tip_y(const Fracture& fracture) {
  double y = fracture.path_m.front()[1];
  for (const auto& x : fracture.path_m) y = std::max(y, x[1]);
  return y;
}

}  // namespace

double fraction_done(const Scene& scene, const State& state) {
  const Stop& stop = scene.stop;
  double done = 0.0;
  if (stop.time_s) done = std::max(done, way(0.0, *stop.time_s, state.time));
  if (!state.has_fracture || !scene.fracture) return done;
  if (stop.inlet_Pa) done = std::max(done, way(scene.fluid.start_Pa, *stop.inlet_Pa, state.fluid.inlet_Pa));
  const Tip* tip = leading_tip(state);
  if (stop.tip_y_m && tip) {
    done = std::max(done, way(initial_tip_y(*scene.fracture), *stop.tip_y_m, tip_position(state, *tip).y()));
  }
  return done;
}

std::string duration_text(double seconds) {
  if (!std::isfinite(seconds) || seconds < 0.0 || seconds > 1e9) return "?";
  const long s = std::lround(seconds);
  if (s >= 3600) return fmt::format("{} h {:02} min", s / 3600, s % 3600 / 60);
  if (s >= 60) return fmt::format("{} min {:02} s", s / 60, s % 60);
  return fmt::format("{} s", s);
}

std::string progress_text(const State& state, double fraction, double left_s) {
  std::string text = fmt::format("{:3.0f} %  t = {:.4g} s", std::floor(100.0 * fraction), state.time);
  if (state.has_fracture) text += fmt::format("  P = {:.3f} MPa", 1e-6 * state.fluid.inlet_Pa);
  if (const Tip* tip = leading_tip(state)) text += fmt::format("  tip at {:.2f} m", tip_position(state, *tip).y());
  return text + "  left " + duration_text(left_s);
}

Progress::Progress(const Scene& scene, const State& start, bool quiet)
    : quiet_(quiet),
      terminal_(::isatty(STDERR_FILENO) == 1),
      start_fraction_(fraction_done(scene, start)),
      start_(Clock::now()),
      last_(start_) {}

Progress::~Progress() {
  clear();
}

void Progress::show(const Scene& scene, const State& state) {
  if (quiet_) return;
  const Clock::time_point now = Clock::now();
  if (now - last_ < (terminal_ ? std::chrono::milliseconds(200) : std::chrono::seconds(10))) return;
  last_ = now;
  const double fraction = fraction_done(scene, state);
  const double elapsed = std::chrono::duration<double>(now - start_).count();
  const double done = fraction - start_fraction_;  // by this process, which may have gone on from a checkpoint
  const double left = done > 0.0 ? elapsed * (1.0 - fraction) / done : std::numeric_limits<double>::quiet_NaN();
  const std::string text = progress_text(state, fraction, left);
  if (terminal_) {
    constexpr int width = 24;
    const int full = static_cast<int>(width * fraction);
    fmt::print(stderr, "\r[{:#<{}}{:.<{}}] {}\x1b[K", "", full, "", width - full, text);
    std::fflush(stderr);
    drawn_ = true;
  } else {
    fmt::print(stderr, "{}\n", text);
  }
}

void Progress::clear() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
  drawn_ = false;
}

}  // namespace strata
