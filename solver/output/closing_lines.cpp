#include "output/closing_lines.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <system_error>
#include <vector>

#include "output/progress.hpp"
#include "output/suspect.hpp"
#include "output/tip_numbers.hpp"

namespace strata {

namespace {

// Where the fracture started, stayed and went on: all that fits into a line.
std::string growth_line(const State& state) {
  constexpr std::size_t most = 6;
  std::vector<std::string> parts;
  std::size_t more = 0;
  for (const Event& event : state.events) {
    if (event.kind != "start" && event.kind != "arrest" && event.kind != "restart") continue;
    if (parts.size() == most) {
      ++more;
    } else {
      parts.push_back(fmt::format("{} {:.4g} MPa at y = {:.2f} m", event.kind, 1e-6 * event.inlet_Pa, event.tip_y_m));
    }
  }
  if (parts.empty()) return "growth: none";
  return fmt::format("growth: {}{}", fmt::join(parts, "; "),
                     more > 0 ? fmt::format("; {} more in summary.json", more) : "");
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
    parts.push_back(fmt::format("x = {:.2f} m, y = {:.2f} m, K_I {} and K_II {} MPa sqrt(m), J {} N/m{}", x.x(), x.y(),
                                number_or_none(1e-6 * told.K_I_Pa_sqrt_m, 3),
                                number_or_none(1e-6 * told.K_II_Pa_sqrt_m, 3), number_or_none(told.J_N_m, 1),
                                told.reason.empty() ? "" : fmt::format(" ({})", told.reason)));
  }
  return fmt::format("tip: {}; inlet {:.4g} MPa", fmt::join(parts, "; and "), 1e-6 * state.fluid.inlet_Pa);
}

// How near a figure is to marking the run; 1 is at the threshold.
double nearness(const Watched& watched) {
  if (!std::isfinite(watched.value)) return std::numeric_limits<double>::infinity();
  if (*watched.threshold > 0.0) return watched.value / *watched.threshold;
  return watched.value > 0.0 ? std::numeric_limits<double>::infinity() : 0.0;
}

std::string monitor_line(const Scene& scene, const State& state) {
  std::vector<std::string> parts;
  for (const Watched& mark : suspicions(scene, state)) {
    const std::string above = mark.threshold ? fmt::format(", above {:.3g}", *mark.threshold) : "";
    parts.push_back(fmt::format("{} = {:.3g}{}: {}", mark.monitor, mark.value, above, mark.why));
  }
  if (!parts.empty()) return fmt::format("SUSPECT: {}", fmt::join(parts, "; "));
  std::vector<Watched> judged = watched(scene, state);
  std::erase_if(judged, [](const Watched& w) { return !w.threshold; });
  const auto worst = std::ranges::max_element(judged, {}, nearness);
  if (worst == judged.end()) return "monitors: none";
  return fmt::format("monitors: none suspect; nearest is {} = {:.3g}, which above {:.3g} would mean: {}",
                     worst->monitor, worst->value, *worst->threshold, worst->why);
}

}  // namespace

std::string closing_lines(const Scene& scene, const State& state, const RunRecord& record,
                          const std::filesystem::path& folder) {
  std::string lines = fmt::format("{} at step {}, t = {:.4g} s, after {}: {}\n", record.status, state.step, state.time,
                                  duration_text(record.wall_s), record.reason);
  if (state.has_fracture) lines += growth_line(state) + '\n' + tip_line(scene, state) + '\n';
  if (state.particles.size() > 0) lines += monitor_line(scene, state) + '\n';
  std::string files;
  for (const char* file : {"summary.json", "history.csv", "result.h5", "result.xdmf", "checkpoint.bin"}) {
    std::error_code error;
    if (std::filesystem::exists(folder / file, error)) files += fmt::format("{}{}", files.empty() ? "" : ", ", file);
  }
  return fmt::format("{}results in {}: {}\n", lines, folder.string(), files);
}

}  // namespace strata
