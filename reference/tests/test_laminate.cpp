// Layers that share a load.
#include <catch2/catch.hpp>
#include <cmath>
#include <stdexcept>

#include "laminate.hpp"

using namespace strata::reference;

namespace {
Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}
}  // namespace

// 10 m and 70 m, E' = 10.41667 and 5.208333 GPa, nu/(1 - nu) = 1/4, under 2 and 3 MPa:
// (104.1667 + 364.5833) GPa m e = -160 MPa m + 60 MPa m: e = -2.133333e-4.
TEST_CASE("layers by hand") {
  const Laminate state = loaded_laminate({{{10e9, 0.2}, 10}, {{5e9, 0.2}, 70}}, 2e6, 3e6);
  CHECK(state.strain_xx == near(-2.1333333e-4, 1e-7));
  CHECK(state.stress_xx[0] == near(-2.9722222e6, 1e-7));
  CHECK(state.stress_xx[1] == near(-1.8611111e6, 1e-7));
}

TEST_CASE("one rock throughout has the stress of its edges, and nothing comes of nothing") {
  const Laminate state = loaded_laminate({{{7e9, 0.3}, 3}, {{7e9, 0.3}, 1}}, 2e6, 5e6);
  for (const double stress : state.stress_xx) CHECK(stress == near(-2e6, 1e-14));
  CHECK(loaded_laminate({{{7e9, 0.3}, 3}}, 0, 0).strain_xx == 0);
}

// Into the equations: Hooke's law by Lame's constants gives both stresses back from the strains, the strain along the
// layers is one, and the side's force is that of the layers.
TEST_CASE("the state satisfies Hooke's law and balance of force") {
  const std::vector<Ply> plies{{{10e9, 0.2}, 4}, {{3e9, 0.35}, 1.5}, {{25e9, 0.0}, 2}, {{1e9, 0.49}, 0.25}};
  const double p_h = 2.5e6, p_v = -1.5e6;
  const Laminate state = loaded_laminate(plies, p_h, p_v);
  double force = 0, height = 0;
  for (std::size_t k = 0; k < plies.size(); ++k) {
    const double E = plies[k].rock.youngs_modulus, nu = plies[k].rock.poisson_ratio;
    const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = plies[k].rock.shear_modulus();
    const double trace = state.strain_xx + state.strain_yy[k];
    CHECK(lambda * trace + 2 * mu * state.strain_xx == near(state.stress_xx[k], 1e-11));
    CHECK(lambda * trace + 2 * mu * state.strain_yy[k] == near(-p_v, 1e-11));
    force += plies[k].thickness * state.stress_xx[k];
    height += plies[k].thickness;
  }
  CHECK(force == near(-p_h * height, 1e-13));
}

TEST_CASE("layers that are none are refused") {
  CHECK_THROWS_AS(loaded_laminate({}, 1, 1), std::invalid_argument);
  CHECK_THROWS_AS(loaded_laminate({{{1e9, 0.5}, 1}}, 1, 1), std::invalid_argument);
  CHECK_THROWS_AS(loaded_laminate({{{1e9, 0.2}, 0}}, 1, 1), std::invalid_argument);
  CHECK_THROWS_AS(loaded_laminate({{{-1e9, 0.2}, 1}}, 1, 1), std::invalid_argument);
}
