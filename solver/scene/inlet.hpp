// What the inlet prescribes at a time (s since the start): by start and rate, or by the rows of a table.
#pragma once

#include "scene/scene.hpp"

namespace strata {

/// Pressure prescribed at a time (Pa), P = start_Pa + rate_Pa_s t or the table's. Throws nothing.
double inlet_pressure(const Fluid& fluid, double time);

/// What the whole fracture is fed at a time (m^2/s), of a fluid fed at a rate. Throws nothing.
double inlet_rate(const Fluid& fluid, double time);

/// The fastest change of a prescribed pressure (Pa/s), at least 0. Throws nothing.
double fastest_change(const Fluid& fluid);

/// The time of the table's next row after `time` (s), infinite after the last and without a table: between rows what is
/// prescribed is linear in time. Throws nothing.
double next_row(const Fluid& fluid, double time);

}  // namespace strata
