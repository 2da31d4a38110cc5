#include "scene/inlet.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strata {
namespace {

// The table's value at a time, linear between rows and the last one's after them.
double table_value(const Fluid& fluid, double time) {
  const auto& table = fluid.table;
  const auto after = std::ranges::find_if(table, [&](const auto& row) { return row[0] > time; });
  if (after == table.end()) return table.back()[1];
  if (after == table.begin()) return table.front()[1];
  const auto& [t_0, v_0] = *(after - 1);
  const auto& [t_1, v_1] = *after;
  return v_0 + (v_1 - v_0) * (time - t_0) / (t_1 - t_0);
}

}  // namespace

double inlet_pressure(const Fluid& fluid, double time) {
  return fluid.table.empty() ? fluid.start_Pa + fluid.rate_Pa_s * time : table_value(fluid, time);
}

double inlet_rate(const Fluid& fluid, double time) {
  return fluid.table.empty() ? *fluid.rate_m2_s : table_value(fluid, time);
}

double fastest_change(const Fluid& fluid) {
  double fastest = std::abs(fluid.rate_Pa_s);
  for (std::size_t k = 1; k < fluid.table.size() && !fluid.rate_m2_s; ++k) {
    const auto& [t_0, P_0] = fluid.table[k - 1];
    const auto& [t_1, P_1] = fluid.table[k];
    fastest = std::max(fastest, std::abs(P_1 - P_0) / (t_1 - t_0));
  }
  return fastest;
}

double next_row(const Fluid& fluid, double time) {
  if (fluid.table.empty()) return std::numeric_limits<double>::infinity();
  const double slack = 1e-9 * fluid.table.back()[0];  // a step that ends at a row may miss it by round-off
  const auto after = std::ranges::find_if(fluid.table, [&](const auto& row) { return row[0] > time + slack; });
  return after == fluid.table.end() ? std::numeric_limits<double>::infinity() : (*after)[0];
}

}  // namespace strata
