#include "manufactured.hpp"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using Eigen::Matrix2d;
using Eigen::Vector2d;
using std::numbers::pi;

double lame(const Rock& rock) {
  return 2 * rock.shear_modulus() * rock.poisson_ratio / (1 - 2 * rock.poisson_ratio);
}

void require_rock(const Rock& rock, double density) {
  if (!(rock.youngs_modulus > 0 && density > 0)) throw std::invalid_argument("E and density must be positive");
  if (!(rock.poisson_ratio >= 0 && rock.poisson_ratio < 0.5))
    throw std::invalid_argument("poisson_ratio is outside [0, 0.5)");
}

void require_square(double side, int waves) {
  if (!(side > 0 && waves > 0)) throw std::invalid_argument("side and number of waves must be positive");
}

}  // namespace

Vector2d StandingMotion::body_amplitude() const {
  require_rock(rock, density);
  require_square(side, waves);
  const double lambda = lame(rock), mu = rock.shear_modulus();
  const double k = 2 * pi * waves / side, w = angular_frequency;
  const Vector2d other{amplitude.y(), amplitude.x()};
  return (k * k / density) * ((lambda + 3 * mu) * amplitude + (lambda + mu) * other) - w * w * amplitude;
}

MotionAt StandingMotion::at(const Vector2d& place, double time) const {
  const Vector2d body = body_amplitude();
  const double lambda = lame(rock), mu = rock.shear_modulus();
  const double k = 2 * pi * waves / side, w = angular_frequency;
  const double c = std::cos(w * time), s = std::sin(w * time);
  const double T = sine ? s : c, T_t = w * (sine ? c : -s);
  const double sx = std::sin(k * place.x()), cx = std::cos(k * place.x());
  const double sy = std::sin(k * place.y()), cy = std::cos(k * place.y());
  const Vector2d shape{amplitude.x() * sx * cy, amplitude.y() * cx * sy};
  MotionAt point;
  point.u = T * shape;
  point.v = T_t * shape;
  point.a = -w * w * point.u;
  const double e_x = amplitude.x() * k * cx * cy * T, e_y = amplitude.y() * k * cx * cy * T;
  const double g_xy = -amplitude.x() * k * sx * sy * T, g_yx = -amplitude.y() * k * sx * sy * T;
  point.F << 1 + e_x, g_xy, g_yx, 1 + e_y;
  const double shear = mu * (g_xy + g_yx);
  point.sigma << (lambda + 2 * mu) * e_x + lambda * e_y, shear, shear, lambda * e_x + (lambda + 2 * mu) * e_y;
  point.b = T * Vector2d{body.x() * sx * cy, body.y() * cx * sy};
  return point;
}

MotionAt AxisMotion::at(const Vector2d& place, double time) const {
  require_rock(rock, density);
  require_square(side, halves);
  const double lambda = lame(rock), mu = rock.shear_modulus(), w = angular_frequency;
  const double k = pi * halves / side;
  if (!(k * std::abs(amplitude) < 1)) throw std::invalid_argument("n pi |A|/side must be below 1");
  MotionAt point;
  Vector2d stretch, slope;  // F_xx, F_yy, and how each changes along its axis
  for (int i = 0; i < 2; ++i) {
    const double angle = w * time + (i == 1 ? phase : 0.0);
    const double s = std::sin(k * place[i]), T = std::sin(angle);
    point.u[i] = amplitude * s * T;
    point.v[i] = amplitude * s * w * std::cos(angle);
    point.a[i] = -w * w * point.u[i];
    stretch[i] = 1 + amplitude * k * std::cos(k * place[i]) * T;
    slope[i] = -amplitude * k * k * s * T;
  }
  const double J = stretch.x() * stretch.y();
  const double volumetric = lambda * std::log(J);
  for (int i = 0; i < 2; ++i) {
    const double F = stretch[i], F2 = F * F;
    const bool hencky = law == FiniteLaw::hencky;
    const double tau = volumetric + mu * (hencky ? 2 * std::log(F) : F2 - 1);
    const double div_P =
        hencky ? slope[i] * (lambda + 2 * mu - tau) / F2 : slope[i] * ((lambda - volumetric) / F2 + mu * (1 + 1 / F2));
    point.F(i, i) = F;
    point.sigma(i, i) = tau / J;
    point.b[i] = point.a[i] - div_P / density;
  }
  return point;
}

MotionAt VortexMotion::at(const Vector2d& place, double time) const {
  require_rock(rock, density);
  if (!(inner > 0 && outer > inner)) throw std::invalid_argument("0 < inner < outer is required");
  MotionAt point;
  const double R = place.norm();
  if (R <= inner || R >= outer) return point;
  const double mu = rock.shear_modulus(), w = angular_frequency;
  const double q_R = 2 / (outer - inner), q = q_R * (R - 0.5 * (inner + outer)), p = 1 - q * q;
  const double s = turn * std::sin(w * time), c = turn * w * std::cos(w * time);
  const double h = p * p, h_R = -4 * q * p * q_R, h_RR = (12 * q * q - 4) * q_R * q_R;
  const double alpha = h * s, alpha_t = h * c, alpha_R = h_R * s, alpha_RR = h_RR * s;
  const Matrix2d Q = Eigen::Rotation2Dd(alpha).toRotationMatrix();
  const Vector2d e_R = place / R, e_T{-e_R.y(), e_R.x()};
  const Vector2d e_r = Q * e_R, e_t = Q * e_T;
  const double g = R * alpha_R;
  point.u = R * (e_r - e_R);
  point.v = R * alpha_t * e_t;
  point.a = -R * alpha_t * alpha_t * e_r - R * w * w * alpha * e_t;
  point.F = Q * (Matrix2d::Identity() + g * e_T * e_R.transpose());
  point.sigma = mu * (g * (e_r * e_t.transpose() + e_t * e_r.transpose()) + g * g * e_t * e_t.transpose());
  const Vector2d div_sigma = -mu * R * alpha_R * alpha_R * e_r + mu * (3 * alpha_R + R * alpha_RR) * e_t;
  point.b = point.a - div_sigma / density;
  return point;
}

}  // namespace strata::reference
