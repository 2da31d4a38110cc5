// The block's F by a second method that shares nothing with the first: the crack as a line of dislocations, the edges
// by point forces outside the block (Kelvin's solution), both by least squares.
// Changes that were made to the first and fail here: K_I halved, a sign in the normal stress, a product's second
// derivative without the factor 2, ends drawn in at a quarter of their distance.
#include <Eigen/Dense>
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>
#include <vector>

#include "finite_plate.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {

struct Stress {
  double xx = 0, yy = 0, xy = 0;
};

// Of an edge dislocation that opens by b in x, at (0, t): D = E' b/(4 pi), here E' b = 1 (Hirth & Lothe 1982).
Stress of_dislocation(double x, double y, double t) {
  const double Y = y - t, r2 = x * x + Y * Y, D = 1 / (4 * pi * r2 * r2);
  return {-D * Y * (3 * x * x + Y * Y), D * Y * (x * x - Y * Y), D * x * (x * x - Y * Y)};
}

// Of a line force (f_x, f_y) at (s, t) in the infinite plane, plane strain, nu = 0.3 (Kelvin).
Stress of_force(double x, double y, double s, double t, double f_x, double f_y) {
  constexpr double kNu = 0.3;
  const double X = x - s, Y = y - t, r2 = X * X + Y * Y;
  const double unit = -1 / (4 * pi * (1 - kNu) * r2), c = 1 - 2 * kNu;
  const double along = 2 * (f_x * X + f_y * Y) / r2;
  return {unit * (c * (f_x * X - f_y * Y) + along * X * X), unit * (c * (f_y * Y - f_x * X) + along * Y * Y),
          unit * (c * (f_x * Y + f_y * X) + along * X * Y)};
}

// The force and its three mirror images in the axes.
Stress of_forces(double x, double y, double s, double t, double f_x, double f_y) {
  Stress sum;
  for (const int i : {1, -1})
    for (const int j : {1, -1}) {
      const Stress one = of_force(x, y, i * s, j * t, i * f_x, j * f_y);
      sum.xx += one.xx;
      sum.yy += one.yy;
      sum.xy += one.xy;
    }
  return sum;
}

struct Point {
  double x, y;
  bool side;
};

// Points of the first quadrant's edges of a rectangle with half-sides b, h, crowded to the corner.
std::vector<Point> edge(double b, double h, int count) {
  std::vector<Point> points;
  for (int i = 0; i < count; ++i) {
    const double s = std::sin((i + 0.5) * pi / (2 * count));
    points.push_back({b, h * s, true});
    points.push_back({b * s, h, false});
  }
  return points;
}

// F = K_I/(p sqrt(pi a)) of the crack x = 0, |y| < a in |x| < b, |y| < h with free edges; n nodes, `sources` a side.
double second_F(double b, double h, double a, int n, int sources) {
  const double off = 0.5 * std::min(b, h);
  const auto places = edge(b + off, h + off, sources), checks = edge(b, h, 3 * sources);
  const auto unknowns = n + 2 * static_cast<Eigen::Index>(places.size());
  const auto rows = n + 2 * static_cast<Eigen::Index>(checks.size());
  Eigen::MatrixXd A = Eigen::MatrixXd::Zero(rows, unknowns);
  Eigen::VectorXd rhs = Eigen::VectorXd::Zero(rows);
  const auto node = [&](int j) { return a * std::cos((2 * j + 1) * pi / (2 * n)); };
  const auto put = [&](Eigen::Index row, double x, double y, auto&& component) {
    for (int j = 0; j < n; ++j) A(row, j) = component(of_dislocation(x, y, node(j)));
    for (std::size_t i = 0; i < places.size(); ++i) {
      const auto column = n + 2 * static_cast<Eigen::Index>(i);
      A(row, column) = b * component(of_forces(x, y, places[i].x, places[i].y, 1, 0));
      A(row, column + 1) = b * component(of_forces(x, y, places[i].x, places[i].y, 0, 1));
    }
  };
  const auto normal = [](bool side) { return [side](const Stress& s) { return side ? s.xx : s.yy; }; };
  for (int k = 1; k < n; ++k) {
    put(k - 1, 0, a * std::cos(k * pi / n), normal(true));
    rhs(k - 1) = -1;
  }
  for (int j = 0; j < n; ++j) A(n - 1, j) = 1 / a;
  Eigen::Index row = n;
  for (const Point& point : checks) {
    put(row++, point.x, point.y, normal(point.side));
    put(row++, point.x, point.y, [](const Stress& s) { return s.xy; });
  }
  const Eigen::VectorXd solution = A.colPivHouseholderQr().solve(rhs);
  double g = 0;  // at the tip, by Krenk's formula
  for (int j = 0; j < n; ++j) {
    const double half = (2 * j + 1) * pi / (4 * n);
    g += solution(j) * std::sin((2 * n - 1) * half) / (std::sin(half) * pi);
  }
  return -0.25 * std::sqrt(pi / a) * g / std::sqrt(pi * a);
}

}  // namespace

// Measured: 1e-6 or less, 9e-6 for a = 50.
TEST_CASE("a second method gives the block's F") {
  // width, half height, half crack
  const double blocks[][3] = {{80, 80, 5},  {80, 80, 10}, {80, 80, 20},  {80, 80, 50},  {40, 80, 30},
                              {80, 40, 20}, {80, 40, 30}, {160, 40, 10}, {400, 400, 50}};
  for (const auto& [width, half_height, a] : blocks) {
    CAPTURE(width, half_height, a);
    const double F = BlockCrack(Block{width, half_height, a}).F();
    const double second = second_F(width / 2, half_height, a, 40, 40);
    CAPTURE(F, second, second / F - 1);
    CHECK(std::abs(second / F - 1) < 2e-5);
  }
}
