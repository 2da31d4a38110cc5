#include "state/shape_functions.hpp"

#include <catch2/catch.hpp>

using namespace strata;

namespace {

struct Moments {
  double N = 0.0, linear = 0.0, dN = 0.0, d_linear = 0.0;
};

Moments moments(const Weights& w) {
  Moments sum;
  for (std::size_t a = 0; a < 3; ++a) {
    const double x = static_cast<double>(a) - 1.0;
    sum.N += w.N[a], sum.linear += x * w.N[a];
    sum.dN += w.dN[a], sum.d_linear += x * w.dN[a];
  }
  return sum;
}

double hat(double x) {
  return std::max(0.0, 1.0 - std::abs(x));
}

// Largest difference between dN and the central difference of N.
template <class Shape>
double derivative_error(double f, double half) {
  const double d = 1e-6;
  const Weights w = uniform_weights<Shape>(f, half), up = uniform_weights<Shape>(f + d, half),
                down = uniform_weights<Shape>(f - d, half);
  double most = 0.0;
  for (std::size_t a = 0; a < 3; ++a) most = std::max(most, std::abs(w.dN[a] - (up.N[a] - down.N[a]) / (2.0 * d)));
  return most;
}

}  // namespace

// Requires of every shape that N sums up to 1 and reproduces f, and their derivatives sum up to 0 and 1, for all places
// in a bin and a thousandth of a cell beyond, where particles may still be. Mutations that fail: a hat
// function's weight left out, its derivatives of the other sign; uGIMP's weights doubled; f^2 doubled in the B-spline,
// its derivative 5 % off.
TEMPLATE_TEST_CASE("weights reproduce constants and linear fields", "", QuadraticBspline, Linear, Ugimp) {
  for (const double half : {0.25, 1.0 / 6.0, 0.125, 0.0625}) {
    for (int k = -501; k <= 501; ++k) {
      const double f = 1e-3 * k;
      const Moments sum = moments(uniform_weights<TestType>(f, half));
      CHECK(sum.N == Approx(1.0).epsilon(1e-14));
      CHECK(sum.linear == Approx(f).margin(1e-15));
      CHECK(sum.dN == Approx(0.0).margin(1e-13));
      CHECK(sum.d_linear == Approx(1.0).epsilon(1e-13));
    }
  }
}

// Requires that dN is the derivative of N: central differences agree to 1e-9 away from corners.
TEMPLATE_TEST_CASE("derivatives are those of the weights", "", QuadraticBspline, Linear, Ugimp) {
  for (const double f : {-0.47, -0.31, -0.1, 0.04, 0.22, 0.36, 0.49}) CHECK(derivative_error<TestType>(f, 0.25) < 1e-9);
}

// Requires that a particle which passes from the bin of one node to the next keeps the weights of the nodes they share
// and none of the others: N is continuous at |f| = 1/2, and dN is for B-splines and uGIMP (and for hat functions, whose
// corners are at the nodes).
TEMPLATE_TEST_CASE("weights are continuous from bin to bin", "", QuadraticBspline, Linear, Ugimp) {
  for (const double half : {0.25, 0.125}) {
    const Weights left = uniform_weights<TestType>(0.5, half), right = uniform_weights<TestType>(-0.5, half);
    for (std::size_t a = 0; a < 2; ++a) {
      CHECK(left.N[a + 1] == Approx(right.N[a]).epsilon(1e-14));
      CHECK(left.dN[a + 1] == Approx(right.dN[a]).epsilon(1e-14));
    }
    CHECK(left.N[0] == Approx(0.0).margin(1e-15));
    CHECK(left.dN[0] == Approx(0.0).margin(1e-15));
    CHECK(right.N[2] == Approx(0.0).margin(1e-15));
    CHECK(left.N[1] > 0.4);
  }
}

// Requires the values by hand: the B-spline at its node and at half a cell, hat functions at a third, uGIMP with a
// quarter on both sides at its node, 1 - 1/8, and at half a cell, where it is the hat function.
TEST_CASE("values by hand") {
  const Weights spline = uniform_weights<QuadraticBspline>(0.0, 0.0),
                edge = uniform_weights<QuadraticBspline>(0.5, 0.0);
  CHECK(spline.N[0] == 0.125);
  CHECK(spline.N[1] == 0.75);
  CHECK(spline.dN[0] == -0.5);
  CHECK(spline.dN[2] == 0.5);
  CHECK(edge.N[1] == 0.5);
  CHECK(edge.dN[1] == -1.0);
  const Weights third = uniform_weights<Linear>(-1.0 / 3.0, 0.0);
  CHECK(third.N[0] == Approx(1.0 / 3.0));
  CHECK(third.N[1] == Approx(2.0 / 3.0));
  CHECK(third.dN[0] == -1.0);
  CHECK(third.dN[1] == 1.0);
  const Weights gimp = uniform_weights<Ugimp>(0.0, 0.25), between = uniform_weights<Ugimp>(0.5, 0.25);
  CHECK(gimp.N[1] == Approx(0.875));
  CHECK(gimp.N[0] == Approx(0.0625));
  CHECK(gimp.dN[0] == Approx(-0.5));
  CHECK(gimp.dN[1] == Approx(0.0).margin(1e-15));
  CHECK(between.N[1] == Approx(0.5));
  CHECK(between.dN[1] == Approx(-1.0));
}

// Requires that uGIMP's weights are hat functions averaged over the particle: against midpoint sums of 20000 pieces,
// and keep their digits where a particle just touches a node.
TEST_CASE("uGIMP averages hat functions") {
  for (const double half : {0.25, 0.125}) {
    for (const double f : {-0.5, -0.42, -0.2, 0.0, 0.11, 0.3, 0.5}) {
      const Weights w = uniform_weights<Ugimp>(f, half);
      for (int a = 0; a < 3; ++a) {
        double mean = 0.0;
        constexpr int n = 20000;
        for (int k = 0; k < n; ++k) mean += hat(f - (a - 1) - half + 2.0 * half * (k + 0.5) / n) / n;
        CHECK(w.N[static_cast<std::size_t>(a)] == Approx(mean).margin(1e-8));
      }
    }
  }
  // Overlap of 1e-9: (1e-9)^2/2 over the length 1/2.
  CHECK(uniform_weights<Ugimp>(0.25 + 1e-9, 0.25).N[0] == 0.0);
  CHECK(uniform_weights<Ugimp>(0.25 - 1e-9, 0.25).N[0] == Approx(1e-18).epsilon(1e-6));
}

// Requires that each scene's shape is the one that is used: at f = 0 their middle weights are 0.75, 1 and 0.875.
TEST_CASE("the scene's shape is taken") {
  const auto middle = [](Numerics::Shape shape) {
    return with_shape(shape, [](auto s) { return uniform_weights<decltype(s)>(0.0, 0.25).N[1]; });
  };
  CHECK(middle(Numerics::Shape::bspline2) == 0.75);
  CHECK(middle(Numerics::Shape::linear) == 1.0);
  CHECK(middle(Numerics::Shape::gimp) == Approx(0.875));
}
