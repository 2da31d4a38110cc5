#include <catch2/catch.hpp>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <sstream>

#include "output/history.hpp"
#include "output_state.hpp"

using namespace strata;
using namespace strata::test;

TEST_CASE("history.csv starts with the columns of the contract, in its order") {
  REQUIRE(history_header() ==
          "time_s,inlet_Pa,tip_x_m,tip_y_m,height_m,J_N_m,K_I_Pa_sqrt_m,K_II_Pa_sqrt_m,mouth_opening_m,"
          "fracture_volume_m2,kinetic_J,strain_J,interface_strain_J,fluid_work_J,in_situ_work_J,edge_work_J,damping_J,"
          "transfer_J,integration_J,friction_J,failure_J,fracture_J,excess_J,energy_closure,J_spread,kink_deg,at_"
          "interface,ring_m,"
          "G_N_m,G_by_J_N_m,fluid_volume_balance,body_work_J,initial_kinetic_J,near,"
          "lower_tip_y_m,lower_tip_K_I_Pa_sqrt_m,lower_tip_K_II_Pa_sqrt_m\n");
}

TEST_CASE("a row says of the state what the state says") {
  const Scene scene = made_scene();
  const State state = made_state();
  const HistoryRow row = history_row(scene, state);
  const Tip& tip = state.tips[0];
  CHECK(of(row, "time_s") == state.time);
  CHECK(of(row, "inlet_Pa") == state.fluid.inlet_Pa);
  CHECK(of(row, "tip_x_m") == 4.0);
  CHECK(of(row, "tip_y_m") == 2.0);
  CHECK(of(row, "height_m") == 2.0);
  CHECK(of(row, "J_N_m") == tip.J);
  CHECK(of(row, "K_I_Pa_sqrt_m") == tip.K_I);
  CHECK(of(row, "K_II_Pa_sqrt_m") == tip.K_II);
  CHECK(of(row, "J_spread") == tip.J_spread);
  CHECK(of(row, "ring_m") == tip.ring_m);
  CHECK(of(row, "at_interface") == 1.0);
  CHECK(of(row, "near") == 2.0);
  CHECK(of(row, "kink_deg") * std::numbers::pi / 180.0 == Approx(tip.kink).epsilon(1e-14));
  CHECK(of(row, "kinetic_J") == state.ledger.kinetic);
  CHECK(of(row, "strain_J") == state.ledger.strain);
  CHECK(of(row, "interface_strain_J") == state.ledger.interface_strain);
  CHECK(of(row, "fluid_work_J") == state.ledger.fluid_work);
  CHECK(of(row, "in_situ_work_J") == state.ledger.in_situ_work);
  CHECK(of(row, "edge_work_J") == state.ledger.edge_work);
  CHECK(of(row, "body_work_J") == state.ledger.body_work);
  CHECK(of(row, "initial_kinetic_J") == state.ledger.initial_kinetic);
  CHECK(of(row, "damping_J") == state.ledger.damping);
  CHECK(of(row, "transfer_J") == state.ledger.transfer);
  CHECK(of(row, "integration_J") == state.ledger.integration);
  CHECK(of(row, "friction_J") == state.ledger.friction);
  CHECK(of(row, "failure_J") == state.ledger.failure);
  CHECK(of(row, "fracture_J") == state.ledger.fracture);
  CHECK(of(row, "excess_J") == state.ledger.excess);
  CHECK(of(row, "energy_closure") == state.ledger.closure());
}

TEST_CASE("opening is face to face along the normal, volume its integral") {
  State state = made_state();
  Surface& fracture = state.fracture();
  // The normal of an upward path points to -x: the + side moves there when the fracture opens.
  fracture.vertices[0].w = {-3e-3, 5e-4};
  fracture.vertices[1].w = {-4e-3, 7e-4};
  fracture.vertices[2].w = {1e-3, 0.0};
  fracture.points[0].w = {-2e-3, 9.0};
  fracture.points[1].w = {-1e-3, 9.0};
  fracture.points[1].A = 0.5;
  CHECK(mouth_opening(state) == Approx(3e-3));  // at the vertex on y = 0, although the next one is wider
  CHECK(fracture_volume(state) == Approx(2e-3 * 1.0 + 1e-3 * 0.5));

  SECTION("the symmetry line may be at the other end") {
    fracture.vertices[0].x.y() = 2.0;
    fracture.vertices[2].x.y() = 0.0;
    CHECK(mouth_opening(state) == Approx(-1e-3));
  }
  SECTION("away from the symmetry line it is the largest one") {
    for (SurfacePoint& s : fracture.vertices) s.x.y() += 1.0;
    CHECK(mouth_opening(state) == Approx(4e-3));
  }
}

TEST_CASE("the tip reported is the highest one") {
  State state = made_state();
  Numbers number{500};
  state.tips.push_back(made_tip(false, number));
  CHECK(leading_tip(state) == &state.tips[0]);
  CHECK(of(history_row(made_scene(), state), "lower_tip_y_m") == 0.0);  // closed: without numbers, as a leading one
  CHECK(std::isnan(of(history_row(made_scene(), state), "lower_tip_K_I_Pa_sqrt_m")));
  state.fracture().vertices[0].x = {7.0, 3.0};
  CHECK(leading_tip(state) == &state.tips[1]);
  const HistoryRow row = history_row(made_scene(), state);
  CHECK(of(row, "tip_x_m") == 7.0);
  CHECK(of(row, "height_m") == 3.0);
  CHECK(of(row, "ring_m") == state.tips[1].ring_m);
  CHECK(of(row, "at_interface") == 0.0);
  CHECK(of(row, "lower_tip_y_m") == 2.0);
  CHECK(of(row, "lower_tip_K_I_Pa_sqrt_m") == state.tips[0].K_I);
  CHECK(of(row, "lower_tip_K_II_Pa_sqrt_m") == state.tips[0].K_II);
}

// Requires all that is told of the upper tip near its growth of the lower one too, by the lower tip's own numbers, and
// no such column for a single tip. Mutations that fail: the upper tip's numbers in a lower column; columns of a single
// tip.
TEST_CASE("the lower of two tips has columns of its own") {
  State state = made_state();
  Scene scene = made_scene();
  const auto column = [&](const std::string& name) {
    for (const HistoryColumn& one : history_columns(scene, state))
      if (one.name == name) return std::optional(one.value);
    return std::optional<double>();
  };
  for (const char* name : {"lower_tip_x_m", "lower_tip_J_N_m", "lower_tip_G_N_m", "lower_tip_near"})
    CHECK_FALSE(column(name));
  scene.domain.bottom = Edge::traction;
  CHECK(history_columns(scene).size() == history_columns(scene, state).size());  // those of the header
  CHECK(history_columns(scene).size() == history_columns().size() + 4);
  Numbers number{500};
  state.tips.push_back(made_tip(false, number));
  state.fracture().vertices[0].x = {7.0, -3.0};
  Tip& lower = state.tips[1];
  lower.closed = lower.crossed = false, lower.near = Obstacle::edge, lower.G = 17.0, lower.J = 31.0;
  state.tips[0].G = 19.0;
  CHECK(column("lower_tip_x_m") == 7.0);
  CHECK(column("lower_tip_y_m") == -3.0);
  CHECK(column("lower_tip_J_N_m") == 31.0);
  CHECK(column("lower_tip_G_N_m") == 17.0);
  CHECK(column("lower_tip_near") == 4.0);
  CHECK(column("G_N_m") == 19.0);
  CHECK_FALSE(column("lower_tip_G_along_N_m"));
  scene.laws[1].toughness_Pa_sqrt_m = 1e6;
  lower.G_along = 23.0, lower.G_trial = 29.0, lower.criterion = Criterion::energy;
  CHECK(column("lower_tip_G_along_N_m") == 23.0);
  CHECK(column("lower_tip_G_crossing_N_m") == 29.0);
}

// Requires the names of two tips by where they lie, left and right where they are level to half a cell, whichever end
// of the path they are at. Mutation that fails: the sign turned.
TEST_CASE("tips are told apart by where they lie") {
  State state = made_state();
  CHECK(tip_name(state, state.tips[0]) == std::string());
  Numbers number{500};
  state.tips.push_back(made_tip(false, number));
  const auto names = [&](const Vec2& front, const Vec2& back) {
    state.fracture().vertices.front().x = front, state.fracture().vertices.back().x = back;
    return tip_name(state, state.tips[0]) + std::string(" ") + tip_name(state, state.tips[1]);
  };
  CHECK(names({4.0, 0.0}, {4.0, 2.0}) == "upper lower");
  CHECK(names({4.0, 2.0}, {6.0, 0.0}) == "lower upper");
  CHECK(names({4.0, 2.0}, {6.0, 2.4}) == "right left");
  CHECK(names({6.0, 2.0}, {4.0, 2.4}) == "left right");
  CHECK(names({4.0, 2.0}, {6.0, 2.6}) == "upper lower");
}

TEST_CASE("without a fracture what belongs to a tip is nan, volume and opening are 0") {
  State state = made_state();
  state.has_fracture = false;
  state.surfaces.erase(state.surfaces.begin());
  state.tips.clear();
  const HistoryRow row = history_row(made_scene(), state);
  const std::set<std::string> absent = {"tip_x_m",
                                        "tip_y_m",
                                        "height_m",
                                        "J_N_m",
                                        "K_I_Pa_sqrt_m",
                                        "K_II_Pa_sqrt_m",
                                        "J_spread",
                                        "kink_deg",
                                        "at_interface",
                                        "ring_m",
                                        "G_N_m",
                                        "G_by_J_N_m",
                                        "near",
                                        "lower_tip_y_m",
                                        "lower_tip_K_I_Pa_sqrt_m",
                                        "lower_tip_K_II_Pa_sqrt_m"};
  for (std::size_t c = 0; c < row.size(); ++c) {
    INFO(history_columns()[c].name);
    CHECK(std::isnan(row[c]) == absent.contains(history_columns()[c].name));
  }
  CHECK(of(row, "mouth_opening_m") == 0.0);
  CHECK(of(row, "fracture_volume_m2") == 0.0);
  CHECK(of(row, "inlet_Pa") == 0.0);
}

// Requires of a row's text the same numbers, to the sign of zero and what is not finite.
TEST_CASE("a row's line has numbers that read back to the same digits") {
  Numbers number;
  HistoryRow row;
  for (std::size_t c = 0; c < history_columns().size(); ++c) row.push_back(std::exp(40.0 * number.next()));
  row[0] = -std::numeric_limits<double>::infinity(), row[1] = 5e-324, row[2] = -0.0;
  row[3] = -std::numeric_limits<double>::quiet_NaN();
  std::istringstream line(history_line(row));
  for (std::size_t c = 0; c < row.size(); ++c) {
    std::string cell;
    REQUIRE(std::getline(line, cell, c + 1 < row.size() ? ',' : '\n'));
    const double read = std::strtod(cell.c_str(), nullptr);
    CHECK(std::signbit(read) == (c != 3 && std::signbit(row[c])));
    CHECK((read == row[c] || (c == 3 && cell == "nan")));
  }
  CHECK(line.peek() == std::char_traits<char>::eof());
}
