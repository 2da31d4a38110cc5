#include "output/terminal.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <nlohmann/json.hpp>
#include <system_error>
#include <vector>

#include "output/history.hpp"
#include "output/suspect.hpp"
#include "scene/messages.hpp"

namespace strata {
namespace {

// What an event or a tip of two is told apart by: "upper tip ", or nothing of a single one.
std::string which(const std::string& tip) {
  return tip.empty() ? "" : tip + " tip ";
}

// Where a tip is along the axis on which two lie apart.
std::string place(const std::string& tip, double x, double y) {
  const bool level = tip == "left" || tip == "right";
  return fmt::format("{} = {:.2f} m", level ? 'x' : 'y', level ? x : y);
}

// Where the fracture started, stayed and went on: all that fits into a line.
std::string growth_line(const State& state) {
  constexpr std::size_t most = 6;
  std::vector<std::string> parts;
  for (const Event& event : state.events) {
    if (event.kind == "start" || event.kind == "arrest" || event.kind == "restart")
      parts.push_back(fmt::format("{}{} {:.4g} MPa at {}", which(event.tip), event.kind, 1e-6 * event.inlet_Pa,
                                  place(event.tip, event.tip_x_m, event.tip_y_m)));
  }
  if (parts.size() > most) {
    const std::string rest = fmt::format("{} more in summary.json", parts.size() - most);
    parts.resize(most), parts.push_back(rest);
  }
  return fmt::format("growth: {}", parts.empty() ? "none" : fmt::format("{}", fmt::join(parts, "; ")));
}

// Without round-off, and so without a sign that is none.
std::string number_or_none(double value, int decimals) {
  const double rounded = std::round(value * std::pow(10.0, decimals));
  return std::isfinite(value) ? fmt::format("{:.{}f}", rounded == 0.0 ? 0.0 : value, decimals) : "none";
}

std::string tip_line(const Scene& scene, const State& state) {
  std::vector<std::string> parts;
  for (const Tip& tip : state.tips) {
    const Vec2 x = tip_position(state, tip);
    const TipNumbers told = tip_numbers(scene, tip);
    std::string note = told.reason;
    if (note.empty() && tip.near != Obstacle::none)
      note = fmt::format("near {}: K and J are not to be trusted", name_of(tip.near));
    if (!tip.stopped_by.empty())
      note += fmt::format("{}may not grow: it is {}", note.empty() ? "" : "; ", tip.stopped_by);
    parts.push_back(fmt::format("{}x = {:.2f} m, y = {:.2f} m, K_I {} and K_II {} MPa sqrt(m), J {} N/m{}",
                                which(tip_name(state, tip)), x.x(), x.y(), number_or_none(1e-6 * told.K_I_Pa_sqrt_m, 3),
                                number_or_none(1e-6 * told.K_II_Pa_sqrt_m, 3), number_or_none(told.J_N_m, 1),
                                note.empty() ? "" : " (" + note + ")"));
  }
  return fmt::format("{}: {}; inlet {:.4g} MPa", parts.size() > 1 ? "tips" : "tip", fmt::join(parts, "; and "),
                     1e-6 * state.fluid.inlet_Pa);
}

std::string monitor_line(const Scene& scene, const State& state) {
  std::vector<std::string> parts;
  for (const Watched& mark : suspicions(scene, state)) {
    const std::string above = mark.threshold ? fmt::format(", above {:.3g}", *mark.threshold) : "";
    parts.push_back(fmt::format("{} = {:.3g}{}: {}", mark.monitor, mark.value, above, mark.why));
  }
  return parts.empty() ? "monitors: none suspect" : fmt::format("SUSPECT: {}", fmt::join(parts, "; "));
}

}  // namespace

double fraction_done(const Scene& scene, const State& state) {
  double done = 0.0;
  const auto towards = [&](const std::optional<double>& stop, double start, double now) {
    if (stop) done = std::max(done, *stop == start ? 1.0 : std::clamp((now - start) / (*stop - start), 0.0, 1.0));
  };
  towards(scene.stop.time_s, 0.0, state.time);
  if (!state.has_fracture || !scene.fracture) return done;
  towards(scene.stop.inlet_Pa, scene.fluid.start_Pa, state.fluid.inlet_Pa);
  const auto [low, high] = std::ranges::minmax(scene.fracture->path_m, {}, [](const auto& x) { return x[1]; });
  if (const Tip* tip = leading_tip(state)) towards(scene.stop.tip_y_m, high[1], tip_position(state, *tip).y());
  if (const Tip* tip = lower_tip(state)) towards(scene.stop.lower_tip_y_m, low[1], tip_position(state, *tip).y());
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
  const Tip *tip = leading_tip(state), *lower = lower_tip(state);
  if (tip && !lower) text += fmt::format("  tip at {:.2f} m", tip_position(state, *tip).y());
  if (lower) {
    const Vec2 one = tip_position(state, *lower), other = tip_position(state, *tip);
    const std::string name = tip_name(state, *lower);
    const bool level = name == "left" || name == "right";
    const auto [low, high] = std::minmax(level ? one.x() : one.y(), level ? other.x() : other.y());
    text += fmt::format("  tips at {}{:.2f} and {:.2f} m", level ? "x = " : "", low, high);
  }
  return text + "  left " + duration_text(left_s);
}

Progress::Progress(const Scene& scene, const State& start, bool quiet)
    : quiet_(quiet), terminal_(::isatty(STDERR_FILENO) == 1), start_fraction_(fraction_done(scene, start)) {}

Progress::~Progress() {
  if (!drawn_) return;
  std::fputs("\r\x1b[K", stderr);
  std::fflush(stderr);
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
  if (!terminal_) {
    tell("{}\n", text);
    return;
  }
  constexpr int width = 24;
  const int full = static_cast<int>(width * fraction);
  tell("\r[{:#<{}}{:.<{}}] {}\x1b[K", "", full, "", width - full, text);
  std::fflush(stderr);
  drawn_ = true;
}

std::string closing_lines(const Scene& scene, const State& state, const RunRecord& record,
                          const std::filesystem::path& folder) {
  std::string lines = fmt::format("{} at step {}, t = {:.4g} s, after {}: {}\n", record.status, state.step, state.time,
                                  duration_text(record.wall_s), record.reason);
  if (state.has_fracture) lines += growth_line(state) + '\n' + tip_line(scene, state) + '\n';
  if (state.particles.size() > 0) lines += monitor_line(scene, state) + '\n';
  std::vector<std::string> files{"summary.json", "history.csv", "result.h5", "result.xdmf", "checkpoint.bin"};
  std::error_code error;
  std::erase_if(files, [&](const std::string& file) { return !std::filesystem::exists(folder / file, error); });
  return fmt::format("{}results in {}: {}\n", lines, folder.string(), fmt::join(files, ", "));
}

std::string how_it_ended(const RunFolder& folder) {
  std::string how = "its summary cannot be read";
  try {
    const auto summary = nlohmann::json::parse(read_whole(folder.summary()));
    how = fmt::format("{}: {}", summary.at("status").get<std::string>(), summary.at("reason").get<std::string>());
  } catch (const std::exception&) {  // said already
  }
  return fmt::format("{}: has ended and is left as it is ({})", folder.path.string(), how);
}

}  // namespace strata
