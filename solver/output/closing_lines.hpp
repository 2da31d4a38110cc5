// What a run says of itself when it has ended: the lines of a summary that is read at once.
#pragma once

#include <filesystem>
#include <string>

#include "output/summary.hpp"

namespace strata {

/// Five lines: how the run ended and why; start, arrests and restarts with pressure and height; its tips; the monitor
/// that is nearest to its threshold, or all that mark the run; where the results are. Without a fracture the second and
/// third are left out, without a state the fourth, too. folder: of the run. Throws nothing but std::bad_alloc.
std::string closing_lines(const Scene& scene, const State& state, const RunRecord& record,
                          const std::filesystem::path& folder);

}  // namespace strata
