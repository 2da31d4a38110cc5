// What the inlet prescribes at a time: by start and rate, or by the rows of a table.

#include <algorithm>
#include <cmath>
#include <limits>

#include "scene/scene.hpp"

namespace strata {
namespace {

// The table's value at a time, linear between rows and the last one's after them.
double table_value(const Path& table, double time) {
  const auto after = std::ranges::find_if(table, [&](const auto& row) { return row[0] > time; });
  if (after == table.end()) return table.back()[1];
  if (after == table.begin()) return table.front()[1];
  const auto& [t_0, v_0] = *(after - 1);
  const auto& [t_1, v_1] = *after;
  return v_0 + (v_1 - v_0) * (time - t_0) / (t_1 - t_0);
}

}  // namespace

double Fluid::inlet_pressure(double time) const {
  return table.empty() ? start_Pa + rate_Pa_s * time : table_value(table, time);
}

double Fluid::inlet_rate(double time) const {
  return table.empty() ? *rate_m2_s : table_value(table, time);
}

double Fluid::fastest_change() const {
  double fastest = std::abs(rate_Pa_s);
  for (std::size_t k = 1; k < table.size() && !rate_m2_s; ++k) {
    const auto& [t_0, P_0] = table[k - 1];
    const auto& [t_1, P_1] = table[k];
    fastest = std::max(fastest, std::abs(P_1 - P_0) / (t_1 - t_0));
  }
  return fastest;
}

double Fluid::next_row(double time) const {
  if (table.empty()) return std::numeric_limits<double>::infinity();
  const double slack = 1e-9 * table.back()[0];  // a step that ends at a row may miss it by round-off
  const auto after = std::ranges::find_if(table, [&](const auto& row) { return row[0] > time + slack; });
  return after == table.end() ? std::numeric_limits<double>::infinity() : (*after)[0];
}

}  // namespace strata
