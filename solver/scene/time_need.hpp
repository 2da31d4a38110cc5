// How long a run will take, roughly, so that one that would not end in a lifetime is not begun by a slip of the finger.
#pragma once

#include <optional>
#include <string>

#include "scene/scene.hpp"

namespace strata {

constexpr double longest_run_s = 30.0 * 86400.0;  // refused beyond, unless asked for

/// Length of a run (s of its own time) as far as the scene tells it: to the stop time or to the inlet's last pressure;
/// nothing without either. Throws nothing.
std::optional<double> expected_duration(const Scene& scene);

/// Estimated wall time of a run (s) on one thread of the machine that the rates were measured on (AMD EPYC, Zen 4):
/// points times steps by a rate. Explicit: t c_P/(C h) steps, to the end of the run. Quasi-static: 8 steps an increment
/// up to where the run ends, 3 an output. Nothing where the scene does not say when it ends. Over the six experiments 1
/// to 3 times what they take: a fracture that reaches stop.tip_y_m before the other bounds ends an explicit run sooner.
/// Throws nothing.
std::optional<double> time_need(const Scene& scene);

/// Why the run would take too long, or nothing. Throws nothing but std::bad_alloc.
std::optional<std::string> too_long(const Scene& scene);

}  // namespace strata
