// Manufactured motions put into the equations of motion: derivatives by central differences, laws evaluated anew.
#include <catch2/catch.hpp>
#include <cmath>
#include <functional>
#include <numbers>

#include "dynamics.hpp"
#include "manufactured.hpp"

using namespace strata::reference;
using Eigen::Matrix2d;
using Eigen::Vector2d;
using std::numbers::pi;

namespace {

const Rock stiff;
constexpr double kDensity = 2500;

Approx near(double value, double relative) {
  return Approx(value).epsilon(relative).margin(0);
}

// d/ds of f at 0 by central differences of the sixth order.
template <class Value>
Value slope(const std::function<Value(double)>& f, double step) {
  const Value a = f(step) - f(-step), b = f(2 * step) - f(-2 * step), c = f(3 * step) - f(-3 * step);
  return (45.0 * a - 9.0 * b + c) / (60.0 * step);
}

double lambda_of(const Rock& rock) {
  return rock.youngs_modulus * rock.poisson_ratio / ((1 + rock.poisson_ratio) * (1 - 2 * rock.poisson_ratio));
}

// Displacement gradient of a motion at a point by differences, plus I.
template <class Motion>
Matrix2d gradient(const Motion& motion, const Vector2d& X, double t, double step) {
  Matrix2d F = Matrix2d::Identity();
  for (int j = 0; j < 2; ++j)
    F.col(j) += slope<Vector2d>([&](double s) -> Vector2d { return motion.at(X + s * Vector2d::Unit(j), t).u; }, step);
  return F;
}

// Velocity and acceleration are the rates of u and v; returns b rho_0 - (rho_0 u_tt - DIV P), with P(F) given and F
// by differences, over the largest of its terms.
template <class Motion>
double residual(const Motion& motion, const std::function<Matrix2d(const Matrix2d&)>& P, const Vector2d& X, double t) {
  const double step = 2e-3, dt = 2e-3 / motion.angular_frequency;
  const MotionAt point = motion.at(X, t);
  const Vector2d v = slope<Vector2d>([&](double s) -> Vector2d { return motion.at(X, t + s).u; }, dt);
  const Vector2d a = slope<Vector2d>([&](double s) -> Vector2d { return motion.at(X, t + s).v; }, dt);
  CHECK((v - point.v).norm() < 1e-8 * (v.norm() + 1e-12));
  CHECK((a - point.a).norm() < 1e-8 * (a.norm() + 1e-12));
  CHECK((gradient(motion, X, t, step) - point.F).norm() < 1e-9);
  Vector2d div = Vector2d::Zero();
  for (int j = 0; j < 2; ++j)
    div += slope<Vector2d>(
        [&](double s) -> Vector2d { return P(gradient(motion, X + s * Vector2d::Unit(j), t, step)).col(j); }, step);
  const double size = std::max({div.norm(), kDensity * a.norm(), kDensity * point.b.norm()});
  return (div + kDensity * point.b - kDensity * a).norm() / size;
}

// Hooke's law of small strain.
Matrix2d hooke(const Matrix2d& F) {
  const Matrix2d e = 0.5 * (F + F.transpose()) - Matrix2d::Identity();
  return lambda_of(stiff) * e.trace() * Matrix2d::Identity() + 2 * stiff.shear_modulus() * e;
}

// P = J sigma F^-T from the principal stretches: J sigma = lambda ln J I + 2 mu ln V.
Matrix2d hencky(const Matrix2d& F) {
  const Eigen::SelfAdjointEigenSolver<Matrix2d> V2(F * F.transpose());
  const Vector2d ln_V = 0.5 * V2.eigenvalues().array().log();
  const Vector2d tau = lambda_of(stiff) * Vector2d::Constant(ln_V.sum()) + 2 * stiff.shear_modulus() * ln_V;
  return V2.eigenvectors() * tau.asDiagonal() * V2.eigenvectors().transpose() * F.inverse().transpose();
}

// P as the slope of the stored energy W = lambda (ln J)^2/2 - mu ln J + mu (tr F^T F - 2)/2 with respect to F.
Matrix2d neo_hookean(const Matrix2d& F) {
  const auto W = [](const Matrix2d& G) {
    const double ln_J = std::log(G.determinant()), mu = stiff.shear_modulus();
    return 0.5 * lambda_of(stiff) * ln_J * ln_J - mu * ln_J + 0.5 * mu * (G.squaredNorm() - 2);
  };
  Matrix2d P;
  for (int i = 0; i < 2; ++i)
    for (int j = 0; j < 2; ++j)
      P(i, j) = slope<double>(
          [&](double s) {
            Matrix2d G = F;
            G(i, j) += s;
            return W(G);
          },
          2e-3);
  return P;
}

const Vector2d kPlaces[] = {{0.11, 0.23}, {0.37, 0.81}, {0.62, 0.44}, {0.93, 0.07}};

}  // namespace

TEST_CASE("standing waves of small strain solve the equation of motion, with their body force") {
  for (const bool sine : {false, true}) {
    const StandingMotion motion{stiff, kDensity, 1.3, 2, {1e-3, -0.4e-3}, 9000, sine};
    for (const Vector2d& X : kPlaces) {
      CHECK(residual(motion, hooke, X, 2.1e-4) < 1e-7);
      const MotionAt point = motion.at(X, 2.1e-4);
      CHECK((hooke(point.F) - point.sigma).norm() < 1e-12 * point.sigma.norm());
    }
  }
}

TEST_CASE("standing waves: hand numbers, rollers and the motions that need no force") {
  // k = 2 pi/2 m, a static amplitude in x alone: b = k^2 (lambda + 3 mu) A/rho, and what Poisson's ratio makes of it in
  // y.
  const StandingMotion still{stiff, kDensity, 2, 1, {1e-3, 0}, 0, false};
  CHECK(still.body_amplitude().x() == near(pi * pi * (2.5e9 / 0.9 + 12.5e9) * 1e-3 / 2500, 1e-12));
  CHECK(still.body_amplitude().y() == near(pi * pi * (2.5e9 / 0.9 + 12.5e9 / 3) * 1e-3 / 2500, 1e-12));
  CHECK(still.at({0.5, 0}, 0).u.x() == near(1e-3, 1e-14));
  CHECK(still.at({0.5, 0}, 0).b.x() == near(still.body_amplitude().x(), 1e-12));
  // rollers: no normal displacement, no shear
  for (const double side : {0.0, 2.0}) {
    CHECK(std::abs(still.at({side, 0.3}, 0).u.x()) < 1e-18);
    CHECK(std::abs(still.at({side, 0.3}, 0).sigma(0, 1)) < 1e-6 * still.at({0.5, 0.5}, 0).sigma.norm());
  }
  const StandingWaves f = standing_waves(stiff, kDensity, 1);
  for (const double sign : {1.0, -1.0}) {
    const double w = 2 * pi * (sign > 0 ? f.dilatation : f.shear);
    const StandingMotion mode{stiff, kDensity, 1, 1, {1e-3, sign * 1e-3}, w, false};
    CHECK(mode.body_amplitude().norm() < 1e-12 * w * w * 1e-3);
  }
}

TEST_CASE("stretching along the axes solves DIV P + rho b = rho a for both laws") {
  for (const double phase : {0.0, pi, 0.7}) {
    AxisMotion motion{stiff, FiniteLaw::hencky, kDensity, 1, 2, 0.05, 6000, phase};
    for (const Vector2d& X : kPlaces) {
      CHECK(residual(motion, hencky, X, 2.1e-4) < 1e-7);
      motion.law = FiniteLaw::neo_hookean;
      CHECK(residual(motion, neo_hookean, X, 2.1e-4) < 1e-6);
      motion.law = FiniteLaw::hencky;
    }
  }
}

TEST_CASE("Cauchy's stress is that of the law, and small amplitudes give small strain") {
  AxisMotion motion{stiff, FiniteLaw::hencky, kDensity, 1, 2, 0.05, 6000, 0.7};
  for (const Vector2d& X : kPlaces) {
    for (const FiniteLaw law : {FiniteLaw::hencky, FiniteLaw::neo_hookean}) {
      motion.law = law;
      const MotionAt point = motion.at(X, 2.1e-4);
      const Matrix2d P = law == FiniteLaw::hencky ? hencky(point.F) : neo_hookean(point.F);
      CHECK((P * point.F.transpose() / point.F.determinant() - point.sigma).norm() < 1e-8 * point.sigma.norm());
    }
  }
  // u_x = A sin(n pi X/side) alone: sigma_xx = (lambda + 2 mu) u_x', b = a + (lambda + 2 mu) k^2 u_x/rho
  const double M = 10e9 * 0.8 / (1.2 * 0.6), k = 2 * pi, A = 1e-9;
  for (const FiniteLaw law : {FiniteLaw::hencky, FiniteLaw::neo_hookean}) {
    const MotionAt point = AxisMotion{stiff, law, kDensity, 1, 2, A, pi, 0}.at({0.125, 0.25}, 0.5);
    CHECK(point.u.x() == near(A * std::sqrt(0.5), 1e-12));
    CHECK(point.sigma(0, 0) == near(M * A * k * std::sqrt(0.5), 1e-6));
    CHECK(point.b.x() == near((k * k * M / kDensity - pi * pi) * point.u.x(), 1e-6));
  }
}

TEST_CASE("the vortex solves DIV P + rho b = rho a and leaves what is around it at rest") {
  const VortexMotion motion{stiff, kDensity, 0.75, 1.25, 0.8, 1500};
  for (const Vector2d& X : {Vector2d{0.9, 0.2}, Vector2d{-0.3, 1.05}, Vector2d{-0.8, -0.75}}) {
    CHECK(residual(motion, neo_hookean, X, 6e-4) < 1e-6);
    const MotionAt point = motion.at(X, 6e-4);
    const Matrix2d P = neo_hookean(point.F);
    CHECK((P * point.F.transpose() - point.sigma).norm() < 1e-8 * point.sigma.norm());
    CHECK(point.F.determinant() == near(1, 1e-13));
    CHECK((X + point.u).norm() == near(X.norm(), 1e-13));
  }
  // the middle circle turns by G sin(wt)
  const MotionAt point = motion.at({1, 0}, 6e-4);
  CHECK(std::atan2(point.u.y(), 1 + point.u.x()) == near(0.8 * std::sin(0.9), 1e-12));
  const double largest = motion.at({0.9, 0.2}, 6e-4).sigma.norm();
  for (const Vector2d& X : {Vector2d{0.75, 0}, Vector2d{0, -1.25}}) {
    CHECK(motion.at((X.norm() > 1 ? 0.9999999 : 1.0000001) * X, 6e-4).sigma.norm() < 1e-4 * largest);
    CHECK(motion.at(X, 6e-4).u.norm() == 0);
    CHECK(motion.at(2 * X, 6e-4).b.norm() == 0);
  }
}

TEST_CASE("motions that cannot be meant are refused") {
  CHECK_THROWS_AS((StandingMotion{{0, 0.2}, kDensity, 1, 1, {1, 1}, 0, false}.at({0, 0}, 0)), std::invalid_argument);
  CHECK_THROWS_AS((StandingMotion{stiff, kDensity, 0, 1, {1, 1}, 0, false}.at({0, 0}, 0)), std::invalid_argument);
  CHECK_THROWS_AS((AxisMotion{stiff, FiniteLaw::hencky, kDensity, 1, 2, 0.16, 1, 0}.at({0, 0}, 0)),
                  std::invalid_argument);
  CHECK_THROWS_AS((VortexMotion{stiff, kDensity, 1, 1, 1, 1}.at({0, 0}, 0)), std::invalid_argument);
}
