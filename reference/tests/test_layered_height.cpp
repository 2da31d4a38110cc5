// Heights through layers against the closed form of a symmetric barrier, Griffith's crack, and K at the tips that rest.
// Changes that were made to the solution and fail here: K_Ic or S doubled or left out, S's sign, the layer behind a tip
// taken for that ahead, the two tips' S exchanged, weight with the wrong sign, the tip with the larger P_c growing.
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "griffith.hpp"
#include "layered_height.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

constexpr double middle_stress = 2e6, more = 0.75e6, K_Ic = 1e6;
const StressLayers barrier{{-10, 10}, {middle_stress + more, middle_stress, middle_stress + more}, {K_Ic, K_Ic, K_Ic}};
constexpr CrackEnds start{-5, 5}, far{-1e3, 1e3};

}  // namespace

TEST_CASE("a symmetric barrier holds the crack at Simonson's height") {
  // p = D (1 - (2/pi) asin(H/h)) + K_Ic/sqrt(pi h/2) above the middle layer's stress, H = 20 m; and as printed.
  for (const auto& [h, printed] : {std::pair{22.0, 0.3753e6}, {40.0, 0.6262e6}, {100.0, 0.7337e6}}) {
    const double p = more * (1 - 2 / pi * std::asin(20 / h)) + K_Ic / std::sqrt(pi * h / 2);
    CHECK(p == near(printed, 2e-4));
    const CrackEnds rest = grown_to_rest(barrier, start, middle_stress + p, far);
    CHECK(rest.top == near(h / 2, 1e-10));
    CHECK(rest.bottom == near(-h / 2, 1e-10));
    CHECK(pressure_to_pass(barrier, start, h / 2, far) == near(middle_stress + p, 1e-11));
  }
  // Between the end of unstable growth in the middle layer and the barrier's own K the tips stay at the borders.
  const double griffith = middle_stress + griffith_critical_pressure(5, K_Ic);
  CHECK(grown_to_rest(barrier, start, griffith - 1, far).top == 5.0);
  CHECK(grown_to_rest(barrier, start, griffith + 1, far).top > 10.0);
}

TEST_CASE("tips at rest have K_Ic of the rock ahead, or less at a border and at a limit") {
  // Six layers of any stress and toughness, weight and slope: K by quadrature, from the profile as a function.
  const StressLayers layers{{-30, -12, 4, 9, 25},
                            {4.1e6, 3.2e6, 2.0e6, 2.6e6, 2.2e6, 3.6e6},
                            {2e6, 0.7e6, 1e6, 3e6, 0.4e6, 1.5e6},
                            -9e3,
                            9.81e3};
  const CrackEnds from{-6, -2};
  const auto layer_at = [&](double y) {
    std::size_t k = 0;
    while (k < layers.border.size() && y > layers.border[k]) ++k;
    return k;
  };
  CrackEnds before = from;
  int at_K_Ic = 0, held = 0;
  for (double P = 2.0e6; P < 3.4e6; P += 0.02e6) {
    const CrackEnds rest = grown_to_rest(layers, from, P, {-60, 60});
    REQUIRE(rest.top >= before.top);
    REQUIRE(rest.bottom <= before.bottom);
    before = rest;
    if (rest.top == from.top && rest.bottom == from.bottom) continue;
    const double a = 0.5 * (rest.top - rest.bottom), middle = 0.5 * (rest.top + rest.bottom);
    std::vector<double> kinks;
    for (const double border : layers.border) kinks.push_back(border - middle);
    const PressurisedCrack crack(
        a, 1.0,
        [&](double x) { return P - 9.81e3 * (x + middle) - layers.stress[layer_at(x + middle)] + 9e3 * (x + middle); },
        kinks);
    const TipIntensities K = crack.K_I();
    const auto judge = [&](double tip, double K_tip, double K_ahead, double limit, double origin) {
      const bool border = std::ranges::any_of(layers.border, [&](double y) { return y == tip; });
      INFO("tip " << tip << " K " << K_tip << " of " << K_ahead << " at P " << P);
      if (tip == limit) return;
      CHECK(K_tip <= K_ahead * (1 + 1e-9));
      if (border || tip == origin) {
        held += border;
      } else {
        CHECK(K_tip == near(K_ahead, 1e-7));  // the other tip's last piece may have unloaded it
        ++at_K_Ic;
      }
    };
    judge(rest.top, K.plus, layers.toughness[layer_at(std::nextafter(rest.top, 1e9))], 60, from.top);
    judge(rest.bottom, K.minus, layers.toughness[layer_at(rest.bottom)], -60, from.bottom);
  }
  CHECK(at_K_Ic > 20);
  CHECK(held > 3);
}

TEST_CASE("of two tips the one that needs less pressure grows") {
  // Heavy fluid opens the lower tip, one lighter than the rock's slope the upper one. One rock: nothing holds them, and
  // limits are so near that the other tip does not yet follow.
  const CrackEnds near_by{-5.01, 5.01};
  StressLayers rock{{0}, {2e6, 2e6}, {K_Ic, K_Ic}, 0.0, 1e3};
  const CriticalPressures critical = critical_pressures(rock, start);
  // int w y over the crack: S = -+ w sqrt(pi a) a/2.
  CHECK(critical.top - 2e6 == near(griffith_critical_pressure(5, K_Ic) + 1e3 * 2.5, 1e-12));
  CHECK(critical.bottom - 2e6 == near(griffith_critical_pressure(5, K_Ic) - 1e3 * 2.5, 1e-12));
  const CrackEnds down = grown_to_rest(rock, start, critical.bottom + 1, near_by);
  CHECK(down.top == 5.0);
  CHECK(down.bottom == near_by.bottom);
  rock.stress_slope = -3e3;
  const CrackEnds up = grown_to_rest(rock, start, critical_pressures(rock, start).top + 1, near_by);
  CHECK(up.top == near_by.top);
  CHECK(up.bottom == -5.0);
}

TEST_CASE("what is no crack in layers is refused") {
  CHECK_THROWS_AS(critical_pressures(barrier, {5, -5}), std::invalid_argument);
  CHECK_THROWS_AS(critical_pressures({{1, 0}, {1, 1, 1}, {1, 1, 1}}, start), std::invalid_argument);
  CHECK_THROWS_AS(critical_pressures({{0}, {1, 1, 1}, {1, 1, 1}}, start), std::invalid_argument);
  CHECK_THROWS_AS(critical_pressures({{0}, {1, 1}, {1, -1}}, start), std::invalid_argument);
  CHECK_THROWS_AS(grown_to_rest(barrier, start, 1e6, {-1, 100}), std::invalid_argument);
  CHECK_THROWS_AS(pressure_to_pass(barrier, start, 4.0, far), std::invalid_argument);
}
