// Cracks of any path beside a bonded interface: straight limits, the arc, small turns, another discretisation,
// residuals.
//
// Mutations run against these checks: sign of the images' terms (bonded cracks), Pi and Lambda exchanged (bonded
// cracks), half of E'/(4 pi) (all), slip of the mirror image unreversed (mirrored path), tip elements without their
// lead (all), load's shear left out (small turns under unequal stress).
#include <catch2/catch.hpp>
#include <cmath>
#include <numbers>

#include "arc_crack.hpp"
#include "bimaterial.hpp"
#include "curved_crack.hpp"

using namespace strata::reference;
using std::numbers::pi;

namespace {

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

const Rock stiff{10e9, 0.2};
const Rock soft{5e9, 0.2};
constexpr double p0 = 1e6;
const double unit = p0 * std::sqrt(5 * pi);
const PathLoad pressure = in_situ_load([](double) { return p0; }, 0, 0);
const CrackPlane one_rock{stiff, {}, 0, false};

// Within `relative` of the exact K's size, or of `least` where this is more.
void check_K(const CrackLine::Intensities& K, const CrackLine::Intensities& exact, double relative, double least = 0) {
  const double size = std::max(least, std::hypot(exact.K_I, exact.K_II));
  CHECK(std::abs(K.K_I - exact.K_I) < relative * size);
  CHECK(std::abs(K.K_II - exact.K_II) < relative * size);
}

// A polygon in an arc of radius 10 m, symmetric about y; its short end pieces are tangent to the arc.
std::vector<Point> arc(double half_angle, int pieces) {
  const double step = 2 * half_angle / pieces;
  const Point left = std::polar(10.0, pi / 2 + half_angle);
  std::vector<Point> path{left, left + std::polar(2.5 * step, half_angle)};
  for (int i = 1; i < pieces; ++i) path.push_back(std::polar(10.0, pi / 2 + half_angle - i * step));
  path.emplace_back(-path[1].real(), path[1].imag());
  path.emplace_back(-left.real(), left.imag());
  return path;
}

// K at the end of a crack with one kink by another method: point dislocations at the middles, equations at the ends, of
// equal steps of an angle whose square is the distance near the tips, and its cube that from the kink (as Gauss and
// Chebyshev's rule without the kink); nothing is shared with the elements but the potentials of one dislocation.
class KinkedByQuadrature {
 public:
  KinkedByQuadrature(Point from, Point kink, Point to, int n)
      : from_(from), kink_(kink), to_(to), n_(n), middle_((0.5 * (n - n % 2) + 0.25) * pi / n) {
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(2 * n, 2 * n);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(2 * n);
    for (int k = 1; k < n; ++k) {
      const double angle = k * pi / n;
      const Point axis = angle < middle_ ? unit_of(kink - from) : unit_of(to - kink);
      for (int j = 0; j < n; ++j)
        for (int along_y = 0; along_y < 2; ++along_y) {
          const Point traction = sent(place(angle) - place((j + 0.5) * pi / n), axis, along_y != 0);
          A(2 * (k - 1), 2 * j + along_y) = traction.real();
          A(2 * (k - 1) + 1, 2 * j + along_y) = traction.imag();
        }
      b(2 * (k - 1)) = -4 * pi / stiff.E_prime() * p0;
    }
    for (int j = 0; j < n; ++j) A.block<2, 2>(2 * (n - 1), 2 * j).setIdentity();
    jumps_ = A.partialPivLu().solve(b);
  }

  // At `to`: the jump is r^(1/2) there, and r = 3 L (angle/wide)^2.
  CrackLine::Intensities last() const {
    // Strength at the tip: even polynomial of degree 6 through the last four nodes.
    Eigen::Vector2d at_tip = Eigen::Vector2d::Zero();
    for (int i = 0; i < 4; ++i) {
      double weight = 1;
      for (int m = 0; m < 4; ++m)
        if (m != i) weight *= (m + 0.5) * (m + 0.5) / ((m + 0.5) * (m + 0.5) - (i + 0.5) * (i + 0.5));
      at_tip += weight * jumps_.segment<2>(2 * (n_ - 1 - i)) * n_ / pi;
    }
    const Point axis = unit_of(to_ - kink_);
    const Point local = -Point(at_tip(0), at_tip(1)) * std::conj(axis);  // slip + i opening
    const double scale =
        stiff.E_prime() * std::sqrt(2 * pi) * (pi - middle_) / (8 * std::sqrt(3 * std::abs(to_ - kink_)));
    return {scale * local.imag(), scale * local.real()};
  }

 private:
  static Point unit_of(Point z) { return z / std::abs(z); }
  Point place(double angle) const {
    const bool before = angle < middle_;
    const double part = before ? angle / middle_ : (pi - angle) / (pi - middle_);
    const double left = std::pow(1 - part * part, 3);
    return before ? kink_ + left * (from_ - kink_) : kink_ + left * (to_ - kink_);
  }
  static Point sent(Point r, Point axis, bool along_y) {
    const Point A = along_y ? Point(-0.5, 0) : Point(0, 0.5);
    return 2 * (A / r).real() + axis * axis * (-A * std::conj(r) / (r * r) + std::conj(A) / r);
  }

  Point from_, kink_, to_;
  int n_;
  double middle_;  // angle of the kink, a quarter of a step from the nearest place
  Eigen::VectorXd jumps_;
};

}  // namespace

TEST_CASE("straight cracks: alone, parallel, inclined and normal to the interface, whole or mirrored") {
  const CurvedCrack alone({Point(0, -5), Point(0, 5)}, one_rock);
  const auto plain = alone.solve(pressure);
  check_K(plain.last, {unit, 0}, 3e-5);
  check_K(plain.first, {unit, 0}, 3e-5);
  CHECK(alone.jump(plain, 8)(0) == near(4 * p0 / stiff.E_prime() * 4, 3e-5));
  CHECK(alone.volume(plain) == near(2 * pi * p0 * 25 / stiff.E_prime(), 3e-5));
  CHECK(alone.error(pressure) < 1e-4);

  const Function p = [](double) { return p0; };
  const auto parallel = BondedCrack({5, 2.5, 0}, soft, stiff, p).line();
  // The interface on the left or on the right; the tip at the top is +a of a crack above its interface, or -a.
  const CrackPlane right{soft, stiff, 2.5, false}, left{soft, stiff, -2.5, false};
  check_K(CurvedCrack({Point(0, -5), Point(0, 5)}, right).solve(pressure).last, parallel.at_plus(), 5e-5);
  check_K(CurvedCrack({Point(0, -5), Point(0, 5)}, left).solve(pressure).last, parallel.at_minus(), 5e-5);
  const CrackPlane mirrored{soft, stiff, 2.5, true};
  const CurvedCrack half({Point(0, 0), Point(0, 5)}, mirrored);
  check_K(half.solve(pressure).last, parallel.at_plus(), 5e-5);
  CHECK(half.elements() < CurvedCrack({Point(0, -5), Point(0, 5)}, right).elements());
  CHECK(half.solve(pressure).last.K_II / unit == Approx(-0.04328).epsilon(1e-3));

  const auto inclined = BondedCrack({5, 7, 0.6}, soft, stiff, p).line();
  const Point along = std::polar(5.0, 0.6 - pi / 2);
  const auto turned = CurvedCrack({7.0 - along, 7.0 + along}, {soft, stiff, 0, false}).solve(pressure);
  check_K(turned.first, inclined.at_minus(), 5e-5);
  check_K(turned.last, inclined.at_plus(), 5e-5);

  for (const double d : {1.0, 0.1}) {
    const auto normal = BondedCrack({5, 5 + d, pi / 2}, stiff, soft, p).line();
    const auto tips = CurvedCrack({Point(d, 0), Point(d + 10, 0)}, {stiff, soft, 0, false}).solve(pressure);
    check_K(tips.first, normal.at_minus(), 1e-4);
    check_K(tips.last, normal.at_plus(), 5e-5);
  }
}

TEST_CASE("two mirrored cracks are the two of the whole problem") {
  // Cracks on 2 < y < 8 and their image attract each other: Tada's two collinear cracks, k' from the gap of 4 in 16.
  const auto two = CurvedCrack({Point(0, 2), Point(0, 8)}, {stiff, {}, 0, true}).solve(pressure);
  const double b = 2, a = 8, k = std::sqrt(1 - b * b / (a * a));
  const double ratio = std::comp_ellint_2(k) / std::comp_ellint_1(k);
  const double outer = p0 * std::sqrt(pi / a) * (a * a - a * a * ratio) / std::sqrt(a * a - b * b);
  const double inner = p0 * std::sqrt(pi / b) * (a * a * ratio - b * b) / std::sqrt(a * a - b * b);
  check_K(two.last, {outer, 0}, 5e-5);
  check_K(two.first, {inner, 0}, 5e-5);
}

TEST_CASE("crack along an arc: closed form, under pressure and either remote stress") {
  for (const double half_angle : {0.3, 0.8}) {
    const CurvedCrack crack(arc(half_angle, 96), one_rock);
    const double arc_unit = p0 * std::sqrt(pi * 10 * std::sin(half_angle));
    for (const ArcLoad& load : {ArcLoad{p0, 0, 0}, ArcLoad{0, 0, p0}, ArcLoad{0, p0, 0}}) {
      const auto solution = crack.solve(in_situ_load([&](double) { return load.pressure; }, load.s_xx, load.s_yy));
      const auto exact = arc_crack(10, half_angle, load);
      check_K(solution.last, exact, 1e-4, arc_unit);
      check_K(solution.first, {exact.K_I, -exact.K_II}, 1e-4, arc_unit);
    }
  }
  // Small arcs are straight cracks; the closed form under all-round stress is that under pressure.
  check_K(arc_crack(1000, 0.005, {p0, 0, 0}), {p0 * std::sqrt(5 * pi), 0}, 3e-3);
  CHECK(arc_crack(10, 1, {0, p0, p0}).K_II == near(arc_crack(10, 1, {p0, 0, 0}).K_II, 1e-12));
  CHECK_THROWS_AS(arc_crack(10, 4, {}), std::invalid_argument);
}

TEST_CASE("small turns: Cotterell and Rice's first order") {
  // Under pressure alone K_I is that of the chord and K_II half of K_I times the tip's angle from the chord.
  const double rise = 0.01;
  for (const double at : {2.0, 5.0, 8.0}) {
    const auto K = CurvedCrack({Point(0, 0), Point(at, rise), Point(10, 0)}, one_rock).solve(pressure);
    CHECK(K.last.K_I == near(unit, 2e-4));
    CHECK(K.last.K_II == near(-0.5 * rise / (10 - at) * unit, 5e-3));
    CHECK(K.first.K_II == near(0.5 * rise / at * unit, 5e-3));
  }
  // Unequal in-situ stress shears the turned pieces by q = slope (s_yy - s_xx):
  // K_II += (pi a)^(-1/2) int q sqrt((a + x)/(a - x)) dx, for a kink in the middle q = +-q0 and that is -+ 2 a q0.
  const PathLoad sheared = in_situ_load([](double) { return 2 * p0; }, -3 * p0, -p0);
  const auto K = CurvedCrack({Point(0, 0), Point(5, rise), Point(10, 0)}, one_rock).solve(sheared);
  const double q0 = rise / 5 * 2 * p0;
  CHECK(K.last.K_II == near(-0.5 * rise / 5 * unit - 2 * 5 * q0 / std::sqrt(5 * pi), 5e-3));
  // A short kink (Cotterell & Rice 1980): k_I = c_11 K_I, k_II = c_21 K_I to first order in its length and about the
  // fourth in its angle.
  for (const double turn : {-0.2, 0.5}) {
    const Point kink(10, 0);
    const auto k = CurvedCrack({Point(0, 0), kink, kink + std::polar(1e-3, turn)}, one_rock).solve(pressure).last;
    CHECK(k.K_I == near((3 * std::cos(turn / 2) + std::cos(3 * turn / 2)) / 4 * unit, 5e-3));
    CHECK(k.K_II == near((std::sin(turn / 2) + std::sin(3 * turn / 2)) / 4 * unit, 1.5e-2));
  }
}

TEST_CASE("kinks of any angle agree with another discretisation") {
  // Singular fields at a kink cost the more the sharper it is.
  for (const auto& [turn, error] : {std::pair(0.1, 1e-4), std::pair(-0.5, 5e-4), std::pair(1.2, 1.2e-3)})
    for (const double piece : {4.0, 0.5}) {
      const Point kink(10, 0), end = kink + std::polar(piece, turn);
      const auto fine = KinkedByQuadrature(0, kink, end, 320).last();
      INFO("turn " << turn << " piece " << piece);
      check_K(KinkedByQuadrature(0, kink, end, 160).last(), fine, error);
      check_K(CurvedCrack({0, kink, end}, one_rock).solve(pressure).last, fine, 2 * error);
      check_K(CurvedCrack({0, kink, end}, one_rock, 3).solve(pressure).last, fine, error);
    }
}

TEST_CASE("faces carry the load between the equations too, and stresses fall as of a closed jump") {
  const PathLoad load = in_situ_load([](double s) { return 3 * p0 * (1 - s / 20); }, -2 * p0, -p0);
  const CurvedCrack crack({Point(0, 0), Point(0, 5), Point(1, 7), Point(2.5, 8)}, {stiff, soft, 4, true}, 4);
  const auto solution = crack.solve(load);
  double squares = 0;
  int count = 0;
  while (0.11 + 0.137 * count < crack.length()) {
    const double s = 0.11 + 0.137 * count;
    const double along = s < 5 ? pi / 2 : s < 5 + std::sqrt(5.0) ? std::atan2(2, 1) : std::atan2(1, 1.5);
    squares += (crack.crack_traction(solution, s) + load(s, along)).squaredNorm() / (p0 * p0);
    ++count;
  }
  CHECK(std::sqrt(squares / count) < 0.02);
  // A net dislocation would send tractions that fall as 1/r; those of a closed jump fall as 1/r^2.
  const CurvedCrack alone({Point(0, 0), Point(3, 1), Point(4, 3)}, one_rock);
  const auto closed = alone.solve(pressure);
  const double near_by = alone.traction(closed, Point(1e3, 2e3), 0.3).norm();
  CHECK(near_by / alone.traction(closed, Point(1e4, 2e4), 0.3).norm() == near(100, 0.01));
}

TEST_CASE("curved cracks that cannot be meant are refused") {
  CHECK_THROWS_AS(CurvedCrack({Point(0, 0)}, one_rock), std::invalid_argument);
  CHECK_THROWS_AS(CurvedCrack({Point(0, 0), Point(0, 0)}, one_rock), std::invalid_argument);
  CHECK_THROWS_AS(CurvedCrack({Point(0, 0), Point(0, 5), Point(0, 1)}, one_rock), std::invalid_argument);
  CHECK_THROWS_AS(CurvedCrack({Point(0, 0), Point(6, 5)}, {soft, stiff, 5, false}), std::invalid_argument);
  CHECK_THROWS_AS(CurvedCrack({Point(0, -1), Point(0, 5)}, {soft, {}, 5, true}), std::invalid_argument);
  CHECK_THROWS_AS(CurvedCrack({Point(0, 0), Point(0, 5)}, one_rock, 0), std::invalid_argument);
  const CurvedCrack crack({Point(0, 0), Point(0, 5)}, one_rock);
  CHECK_THROWS_AS(crack.jump(crack.solve(pressure), 6), std::invalid_argument);
}
