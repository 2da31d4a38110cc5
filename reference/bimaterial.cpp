#include "bimaterial.hpp"

#include <gsl/gsl_errno.h>
#include <gsl/gsl_roots.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;
using Complex = std::complex<double>;

void check_rocks(const Rock& rock_1, const Rock& rock_2) {
  if (!(rock_1.youngs_modulus > 0) || !(rock_2.youngs_modulus >= 0))
    throw std::invalid_argument("Young's moduli must be positive (that beyond the interface may be 0)");
  for (const Rock& rock : {rock_1, rock_2})
    if (!(rock.poisson_ratio >= 0 && rock.poisson_ratio < 0.5))
      throw std::invalid_argument("poisson_ratio is outside [0, 0.5)");
}

Complex on_crack(const BondedCrack::Geometry& geometry, double s) {
  return Complex(0, geometry.centre_distance) + std::polar(s, geometry.inclination);
}

BondedCrack::Geometry checked(const BondedCrack::Geometry& geometry) {
  const double reach = geometry.half_length * std::abs(std::sin(geometry.inclination));
  if (!(geometry.half_length > 0) || !(geometry.centre_distance > reach))
    throw std::invalid_argument("half_length must be positive and the crack clear of the interface");
  return geometry;
}

// A of phi = A ln(z - z_0), psi = conj(A) ln(z - z_0) - A conj(z_0)/(z - z_0) for a dislocation that adds `jump` =
// (opening, slip) per unit E'/(4 pi): A = i E' jump/(8 pi), the jump turned to global axes.
Complex strength(double opening, double slip, double inclination) {
  return Complex(0, 0.5) * std::polar(1.0, inclination) * Complex(slip, opening);
}

}  // namespace

BondedMirror bonded_mirror(const Rock& rock_1, const Rock& rock_2) {
  check_rocks(rock_1, rock_2);
  const double m = rock_2.shear_modulus() / rock_1.shear_modulus();
  return {(m - 1) / (1 + rock_1.kappa() * m), (rock_1.kappa() * m - rock_2.kappa()) / (rock_2.kappa() + m)};
}

Eigen::Matrix2d BondedCrack::kernel(const Geometry& geometry, const BondedMirror& mirror, double t, double x) {
  const Complex z = on_crack(geometry, x);
  const Complex z_0 = on_crack(geometry, t);
  const Complex turn = std::polar(1.0, 2 * geometry.inclination);
  const Complex r = z - std::conj(z_0);  // from the mirror image of the dislocation
  const Complex depth = z_0 - std::conj(z_0);
  Eigen::Matrix2d k;
  for (int column = 0; column < 2; ++column) {
    const Complex A = strength(column == 0 ? 1 : 0, column == 1 ? 1 : 0, geometry.inclination);
    const Complex Phi = mirror.Pi * (A / r + std::conj(A) * depth / (r * r));
    const Complex dPhi = mirror.Pi * (-A / (r * r) - 2.0 * std::conj(A) * depth / (r * r * r));
    const Complex dOmega = mirror.La * std::conj(A) / r;
    const Complex traction = 2 * Phi.real() + turn * ((std::conj(z) - z) * dPhi + dOmega - Phi);
    k(0, column) = traction.real();
    k(1, column) = traction.imag();
  }
  return k;
}

BondedCrack::BondedCrack(const Geometry& geometry, const Rock& rock_1, const Rock& rock_2, const LineSolver& line)
    : geometry_(checked(geometry)),
      rock_1_(rock_1),
      rock_2_(rock_2),
      mirror_(bonded_mirror(rock_1, rock_2)),
      line_(line([this](double t, double x) { return kernel(geometry_, mirror_, t, x); })) {}

BondedCrack::BondedCrack(const Geometry& geometry, const Rock& rock_1, const Rock& rock_2, const Function& p, int n)
    : BondedCrack(geometry, rock_1, rock_2, [&](const CrackKernel& kernel) {
        const auto load = [&p](double x) { return Eigen::Vector2d(p(x), 0); };
        return CrackLine(geometry.half_length, rock_1.E_prime(), kernel, CrackLoad(load), n);
      }) {}

BondedCrack::BondedCrack(const Geometry& geometry, const Rock& rock_1, const Rock& rock_2, const PressureKnots& p,
                         int n)
    : BondedCrack(geometry, rock_1, rock_2, [&](const CrackKernel& kernel) {
        return CrackLine(geometry.half_length, rock_1.E_prime(), kernel, p, n);
      }) {}

BondedCrack::Field BondedCrack::field(double x, double y) const {
  return evaluate({x, y}, y >= 0);
}

BondedCrack::Field BondedCrack::field_in_rock_2(double x, double y) const {
  return evaluate({x, y}, false);
}

BondedCrack::Field BondedCrack::evaluate(Complex z, bool in_rock_1) const {
  Complex phi, dphi, ddphi, omega, domega;
  const double unit = rock_1_.E_prime() / (4 * pi);
  const Complex axis = std::polar(1.0, geometry_.inclination);
  for (Eigen::Index j = 0; j < line_.nodes().size(); ++j) {
    const Complex A = unit * strength(line_.strengths()(0, j), line_.strengths()(1, j), geometry_.inclination);
    const Complex A_bar = std::conj(A);
    const Complex z_0 = on_crack(geometry_, line_.nodes()(j));
    const Complex depth = z_0 - std::conj(z_0);
    const Complex r = z - z_0;
    // The cut of every logarithm runs back along the crack, beyond whose end they cancel.
    const Complex L = std::log(r / axis);
    const Complex phi_0 = A * L;
    const Complex omega_0 = A_bar * L + A * (z - std::conj(z_0)) / r;
    const Complex domega_0 = A_bar / r - A * depth / (r * r);
    if (in_rock_1) {
      const Complex q = z - std::conj(z_0);
      const Complex L_bar = std::log(q * axis);
      phi += phi_0 + mirror_.Pi * (A * L_bar + A_bar * (z - z_0) / q);
      dphi += A / r + mirror_.Pi * (A / q + A_bar * depth / (q * q));
      ddphi += -A / (r * r) + mirror_.Pi * (-A / (q * q) - 2.0 * A_bar * depth / (q * q * q));
      omega += omega_0 + mirror_.La * A_bar * L_bar;
      domega += domega_0 + mirror_.La * A_bar / q;
    } else {
      phi += (1 + mirror_.La) * phi_0;
      dphi += (1 + mirror_.La) * A / r;
      ddphi += -(1 + mirror_.La) * A / (r * r);
      omega += (1 + mirror_.Pi) * omega_0;
      domega += (1 + mirror_.Pi) * domega_0;
    }
  }
  const Rock& rock = in_rock_1 ? rock_1_ : rock_2_;
  // s_yy + i s_xy = 2 Re phi' + conj(z) phi'' + psi', psi' = omega' - phi' - z phi''.
  const Complex traction = 2 * dphi.real() + (std::conj(z) - z) * ddphi + domega - dphi;
  const Complex u = rock.kappa() * phi + (std::conj(z) - z) * std::conj(dphi) - std::conj(omega);
  const double two_mu = 2 * rock.shear_modulus();
  return {4 * dphi.real() - traction.real(), traction.real(), traction.imag(), u.real() / two_mu, u.imag() / two_mu};
}

double bonded_tip_exponent(const Rock& rock_1, const Rock& rock_2) {
  BondedMirror mirror = bonded_mirror(rock_1, rock_2);
  if (rock_2.youngs_modulus == 0) throw std::invalid_argument("a free surface leaves no singularity at the tip");
  const auto f = [](double lambda, void* data) {
    const auto& [Pi, La] = *static_cast<const BondedMirror*>(data);
    return std::cos(pi * lambda) + 2 * Pi * (1 - lambda) * (1 - lambda) - 0.5 * (La + Pi);
  };
  gsl_function function{f, &mirror};
  const std::unique_ptr<gsl_root_fsolver, void (*)(gsl_root_fsolver*)> solver(
      gsl_root_fsolver_alloc(gsl_root_fsolver_brent), gsl_root_fsolver_free);
  // f > 0 near 0 and f < 0 at 1: 1 + 2 Pi - (La + Pi)/2 and -1 - (La + Pi)/2.
  gsl_root_fsolver_set(solver.get(), &function, 1e-9, 1.0);
  double low = 0.0, high = 1.0;
  while (high - low > 1e-15 * high) {
    const double width = high - low;
    gsl_root_fsolver_iterate(solver.get());
    low = gsl_root_fsolver_x_lower(solver.get());
    high = gsl_root_fsolver_x_upper(solver.get());
    if (high - low == width) break;
  }
  return gsl_root_fsolver_root(solver.get());
}

}  // namespace strata::reference
