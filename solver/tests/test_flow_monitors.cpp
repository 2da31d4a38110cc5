#include "flow/flow_monitors.hpp"

#include <catch2/catch.hpp>
#include <numbers>
#include <optional>
#include <utility>

#include "flow/moving_front.hpp"
#include "fracture/growth.hpp"
#include "output/suspect.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

constexpr double closing = 2e6;  // Pa

// A fracture of 10 cells of 0.5 m from the inlet on the symmetry line, open by 1 mm and full of fluid at 5 MPa.
struct Bench {
  Run run;
  State& state = run.state;
  std::vector<SurfacePoint>& points = state.fracture().points;
  explicit Bench(Fluid::Law law) : run(scene_of(law)) {
    state.fluid.inlet_Pa = 5e6;
    state.fluid.P.assign(points.size() + 1, 5e6);
    state.reynolds.w.assign(points.size(), 1e-3);
    state.reynolds.length.assign(points.size(), 0.5);
    state.reynolds.wet_s.assign(points.size(), 0.0);
    state.reynolds.phi.assign(points.size(), 1.0);
    for (SurfacePoint& s : points) s.P = 5e6, s.w = 1e-3 * s.n;
  }
  static Scene scene_of(Fluid::Law law) {
    Scene scene = block(10, 12);
    hold_edges(scene);
    add_fracture(scene, {{5.0, 0.0}, {5.0, 5.0}}, closing);
    scene.in_situ.horizontal_Pa = closing;
    scene.fluid.law = law;
    return scene;
  }
  void narrow(std::size_t k, double w) { points[k].w = w * points[k].n, state.reynolds.w[k] = w; }
  std::vector<std::string> marks() const {
    std::vector<std::string> names;
    for (const Watched& mark : suspicions(run.scene, state)) names.push_back(mark.monitor);
    return names;
  }
};
using Names = std::vector<std::string>;

}  // namespace

// Requires of a net pressure of 3 MPa that falls to 1 and to -1 MPa in the first two cells: gone after 0.5 + 0.5 cells;
// and of one that falls by 0.5 MPa in all of 9.5 cells. Mutations that fail: the closing stress left out, the first
// half cell counted whole, no interpolation.
TEST_CASE("fall of the pressure in a cell") {
  Bench bench(Fluid::Law::reynolds);
  CHECK(fall_in_a_cell(bench.state) == 0.0);
  for (SurfacePoint& s : bench.points) s.P = 1e6;
  bench.points[0].P = 3e6;
  CHECK(fall_in_a_cell(bench.state) == Approx(3e6 / (0.5 + 0.5)));
  for (SurfacePoint& s : bench.points) s.P = 4.5e6;
  CHECK(fall_in_a_cell(bench.state) == Approx(0.5e6 / 9.5));
  bench.state.fluid.inlet_Pa = 1.9e6;
  CHECK(fall_in_a_cell(bench.state) == 0.0);
}

// Requires of a fall of 0.3 MPa where both laws conduct by a floor of twice the opening (4 times as much by the square,
// 8 times by the cube) 0.9 and 2.1 MPa more, of 3 MPa net, on the share of the crack's K_I beyond 2 m of 5; nothing
// where the floor is below all openings; of new cells behind a moving front 0.3 MPa (2 times as much); no more than
// takes the pressure beyond to cavitation; nothing beyond faces that touch. Mutations that fail: another power, the
// share of K_I left out, its angle's complement.
TEST_CASE("what the pressure owes to the floor of the opening") {
  const auto [law, more] =
      GENERATE(table<Fluid::Law, double>({{Fluid::Law::paper, 0.9e6}, {Fluid::Law::reynolds, 2.1e6}}));
  Bench bench(law);
  State& state = bench.state;
  bench.narrow(3, 0.5e-4), bench.narrow(4, 0.5e-4);
  for (std::size_t k = 4; k < 10; ++k) bench.points[k].P = 4.7e6, state.fluid.P[k] = 4.7e6;
  state.fluid.P[10] = 4.7e6;
  const auto share = [&] {
    const auto [before, behind] = floor_share(bench.run.scene, state);
    CHECK(before == 0.0);
    return behind;
  };
  CHECK(share() == Approx(more / 3e6 * 2.0 / std::numbers::pi * std::acos(0.4)).epsilon(1e-12));
  if (law == Fluid::Law::reynolds) {
    state.grown.line.length = {1.0};
    for (std::size_t k = 4; k < 10; ++k) state.reynolds.wet_s[k] = 1.0;
    CHECK(share() == Approx(0.3 / 3.0 * 2.0 / std::numbers::pi * std::acos(0.4)).epsilon(1e-12));
    state.grown = {};
  }
  bench.run.scene.fluid.minimum_opening_m = 0.5e-4;
  CHECK(share() == 0.0);
  bench.run.scene.fluid.minimum_opening_m = 1.0;  // 2e4 times the opening
  CHECK(share() == Approx(4.7e6 / 3e6 * 2.0 / std::numbers::pi * std::acos(0.4)).epsilon(1e-12));
  for (std::size_t k = 0; k < 5; ++k) bench.narrow(k, 0.0);
  CHECK(share() == 0.0);
}

// Requires the largest fall since the growth before to count where the pressure is given and the last one where a rate
// is, both at growth alone, and the mean of what the floor decides.
TEST_CASE("a flow is judged by what it was at growth") {
  const auto law = GENERATE(Fluid::Law::paper, Fluid::Law::reynolds);
  const bool by_rate = law == Fluid::Law::reynolds && GENERATE(false, true);
  Bench bench(law);
  if (by_rate) bench.run.scene.fluid.rate_m2_s = 1e-4;
  State& state = bench.state;
  Monitors& m = state.monitors;
  bench.points[0].P = 3e6, bench.points[1].P = 1e6;
  watch_flow(bench.run.scene, state);
  CHECK(m.flow_fall == Approx(1.0));
  CHECK(bench.marks() == Names{});  // nothing has grown
  bench.points[0].P = bench.points[1].P = 5e6;
  watch_flow(bench.run.scene, state);
  CHECK(m.flow_fall == (by_rate ? Approx(0.0) : Approx(1.0)));
  Tip tip;
  note_growth(state, tip);
  CHECK(m.largest_flow_fall == (by_rate ? Approx(0.0) : Approx(1.0)));
  CHECK(bench.marks() == (law == Fluid::Law::paper ? Names{"flow_fall"} : Names{}));
  watch_flow(bench.run.scene, state);
  CHECK(m.flow_fall == 0.0);  // counted anew
  m.floor_share = {0.7, 0.3};
  note_growth(state, tip);
  CHECK(m.floor_share_sum == Approx(0.3));
  m.largest_flow_fall = 0.7;
  const bool judged = by_rate || law == Fluid::Law::paper;
  CHECK(bench.marks() == (judged ? Names{"flow_fall", "floor_share"} : Names{"floor_share"}));
}

// Requires (K(h) - K_Ic)/(p sqrt(pi a)) of a tip; 0 before growth and where the fluid does not fill the last cell.
// Noted at growth as it was before, in rock with toughness, but where openings decide. Mutations that fail: the rock's
// own K not taken off, the whole pressure for the net one, half the length, the other side's, noted where openings
// decide or without toughness, not noted under a given pressure, at first growth or where energy decides.
TEST_CASE("what a viscous fluid takes up within a cell of the tip") {
  Bench bench(Fluid::Law::reynolds);
  Scene& scene = bench.run.scene;
  State& state = bench.state;
  const Rocks rocks = make_elasticities(scene);
  const TipRock rock = tip_rock(scene, rocks, state, true);
  CHECK(rock.K_Ic == Approx(scene.rocks[0].toughness_Pa_sqrt_m));
  const auto share = [&] { return viscous_tip(state, scene.fluid, true, rock); };
  state.time = 10.0;
  CHECK(share() == 0.0);
  state.reynolds.wet_s[9] = 6.0;
  const double K = toughness_from(scene.fluid, state.reynolds, true, rock, 10.0, state.grid.h);
  const double expected = (K - rock.K_Ic) / (3e6 * std::sqrt(5.0 * std::numbers::pi));
  CHECK(expected > 0.01);
  CHECK(share() == Approx(expected));
  const auto noted = [&](bool by_rate, bool has_grown, Criterion criterion) {
    scene.fluid.rate_m2_s = by_rate ? std::optional(1e-4) : std::nullopt;
    state.tips[0].has_grown = has_grown, state.tips[0].criterion = criterion;
    watch_flow(scene, state);
    CHECK(state.monitors.viscous_tip[0] == 0.0);
    return state.monitors.viscous_tip[1];
  };
  CHECK(noted(true, true, Criterion::J) == 0.0);
  CHECK(noted(false, true, Criterion::J) == Approx(expected));
  CHECK(noted(true, false, Criterion::J) == Approx(expected));
  const double toughness = std::exchange(scene.rocks[0].toughness_Pa_sqrt_m, 0.0);
  CHECK(noted(false, true, Criterion::J) == 0.0);
  scene.rocks[0].toughness_Pa_sqrt_m = toughness;
  CHECK(noted(true, true, Criterion::energy) == Approx(expected));
  Tip tip;
  note_growth(state, tip);
  CHECK(state.monitors.viscous_at_growth == Approx(expected));
  state.reynolds.phi[9] = 0.5;
  CHECK(share() == 0.0);
}
