// What the inlet prescribes: a ramp, or rows of a table.
#include <catch2/catch.hpp>
#include <limits>

#include "scene/scene.hpp"

using namespace strata;

namespace {

Fluid with_table(Fluid::TableOf of) {
  Fluid fluid;
  fluid.table = {{0.0, 2.0}, {10.0, 4.0}, {10.5, 0.0}, {20.0, 1.0}};
  fluid.table_of = of;
  if (of == Fluid::TableOf::rate_m2_s) fluid.rate_m2_s = 2.0;
  return fluid;
}

}  // namespace

// Mutations that fail: the last value not held, a row's own value taken up to the next, rows of another pair.
TEST_CASE("a table is linear between its rows and keeps its last value") {
  for (const auto& [time, value] : {std::pair{0.0, 2.0},
                                    {5.0, 3.0},
                                    {10.0, 4.0},
                                    {10.25, 2.0},
                                    {10.5, 0.0},
                                    {15.25, 0.5},
                                    {20.0, 1.0},
                                    {1e6, 1.0}}) {
    CHECK(with_table(Fluid::TableOf::pressure_Pa).inlet_pressure(time) == Approx(value).margin(1e-12));
    CHECK(with_table(Fluid::TableOf::rate_m2_s).inlet_rate(time) == Approx(value).margin(1e-12));
  }
}

TEST_CASE("without a table the inlet has a ramp or one rate") {
  Fluid fluid;
  fluid.start_Pa = 2e6;
  fluid.rate_Pa_s = -3e5;
  CHECK(fluid.inlet_pressure(2.0) == 1.4e6);
  CHECK(fluid.fastest_change() == 3e5);
  fluid.rate_m2_s = 1e-4;
  CHECK(fluid.inlet_rate(7.0) == 1e-4);
  CHECK(fluid.next_row(0.0) == std::numeric_limits<double>::infinity());
}

// Mutation that fails: no slack, so that a step that ends a digit before a row is followed by one of no length.
TEST_CASE("the next row, and the fastest change of a pressure") {
  const Fluid fluid = with_table(Fluid::TableOf::pressure_Pa);
  CHECK(fluid.next_row(0.0) == 10.0);
  CHECK(fluid.next_row(9.9) == 10.0);
  CHECK(fluid.next_row(10.0) == 10.5);
  CHECK(fluid.next_row(10.0 - 1e-14) == 10.5);
  CHECK(fluid.next_row(20.0) == std::numeric_limits<double>::infinity());
  CHECK(fluid.fastest_change() == 8.0);
}
