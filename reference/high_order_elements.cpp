#include "high_order_elements.hpp"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_legendre.h>

#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

// Ends and roots of P_order', by Newton's method from Chebyshev's points; P' and P'' from P and Legendre's equation.
Eigen::VectorXd lobatto_points(int order) {
  Eigen::VectorXd points(order + 1);
  points(0) = -1, points(order) = 1;
  for (int i = 1; i < order; ++i) {
    double x = -std::cos(std::numbers::pi * i / order);
    for (int step = 0; step < 30; ++step) {
      const double P = gsl_sf_legendre_Pl(order, x), before = gsl_sf_legendre_Pl(order - 1, x);
      const double slope = order * (before - x * P) / (1 - x * x);
      const double curvature = (2 * x * slope - order * (order + 1) * P) / (1 - x * x);
      x -= slope / curvature;
    }
    points(i) = x;
  }
  return points;
}

}  // namespace

LineBasis::LineBasis(int order) : order(order) {
  if (order < 2 || order > 16) throw std::invalid_argument("the elements' order is outside [2, 16]");
  nodes = lobatto_points(order);
  const int n = order + 1;
  weights = Eigen::VectorXd::Zero(n);
  mass = stiffness = mixed = Eigen::MatrixXd::Zero(n, n);
  const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> rule(
      gsl_integration_glfixed_table_alloc(std::size_t(n)), gsl_integration_glfixed_table_free);
  for (int q = 0; q < n; ++q) {
    double xi = 0, weight = 0;
    gsl_integration_glfixed_point(-1, 1, std::size_t(q), &xi, &weight, rule.get());
    const Eigen::VectorXd N = values(xi), dN = slopes(xi);
    weights += weight * N;
    mass += weight * N * N.transpose();
    stiffness += weight * dN * dN.transpose();
    mixed += weight * dN * N.transpose();
  }
}

Eigen::VectorXd LineBasis::values(double xi) const {
  Eigen::VectorXd N = Eigen::VectorXd::Ones(order + 1);
  for (int i = 0; i <= order; ++i)
    for (int k = 0; k <= order; ++k)
      if (k != i) N(i) *= (xi - nodes(k)) / (nodes(i) - nodes(k));
  return N;
}

Eigen::VectorXd LineBasis::slopes(double xi) const {
  Eigen::VectorXd dN = Eigen::VectorXd::Zero(order + 1);
  for (int i = 0; i <= order; ++i)
    for (int m = 0; m <= order; ++m) {
      if (m == i) continue;
      double product = 1 / (nodes(i) - nodes(m));
      for (int k = 0; k <= order; ++k)
        if (k != i && k != m) product *= (xi - nodes(k)) / (nodes(i) - nodes(k));
      dN(i) += product;
    }
  return dN;
}

Eigen::MatrixXd element_stiffness(const LineBasis& line, const Rock& rock, double h_x, double h_y, bool per_stretch) {
  const double mu = rock.shear_modulus(), lambda = 2 * mu * rock.poisson_ratio / (1 - 2 * rock.poisson_ratio);
  const double bulk = lambda + 2 * mu, ratio = h_y / h_x;
  const double with_A = per_stretch ? -1 : 1, with_C = per_stretch ? 0 : 1;
  const Eigen::MatrixXd &M = line.mass, &A = line.stiffness, &C = line.mixed;
  const int n = line.order + 1;
  Eigen::MatrixXd K(2 * n * n, 2 * n * n);
  for (int l = 0; l < n; ++l)
    for (int k = 0; k < n; ++k)
      for (int j = 0; j < n; ++j)
        for (int i = 0; i < n; ++i) {
          const int row = 2 * (i + n * j), column = 2 * (k + n * l);
          const double AM = ratio * A(i, k) * M(j, l), MA = with_A / ratio * M(i, k) * A(j, l);
          K(row, column) = bulk * AM + mu * MA;
          K(row + 1, column + 1) = mu * AM + bulk * MA;
          K(row, column + 1) = with_C * (lambda * C(i, k) * C(l, j) + mu * C(k, i) * C(j, l));
          K(row + 1, column) = with_C * (lambda * C(k, i) * C(j, l) + mu * C(i, k) * C(l, j));
        }
  return K;
}

Eigen::Vector3d element_stress(const LineBasis& line, const Rock& rock, double h_x, double h_y,
                               const Eigen::VectorXd& u, double xi, double eta) {
  const Eigen::Index n = line.order + 1;
  const Eigen::VectorXd X = line.values(xi), Y = line.values(eta), dX = line.slopes(xi), dY = line.slopes(eta);
  Eigen::Vector2d along_x(0, 0), along_y(0, 0);  // derivatives of the displacement
  for (Eigen::Index j = 0; j < n; ++j)
    for (Eigen::Index i = 0; i < n; ++i) {
      along_x += 2 / h_x * dX(i) * Y(j) * u.segment<2>(2 * (i + n * j));
      along_y += 2 / h_y * X(i) * dY(j) * u.segment<2>(2 * (i + n * j));
    }
  const double mu = rock.shear_modulus(), nu = rock.poisson_ratio;
  const double mean = 2 * mu * nu / (1 - 2 * nu) * (along_x(0) + along_y(1));
  return {mean + 2 * mu * along_x(0), mean + 2 * mu * along_y(1), mu * (along_x(1) + along_y(0))};
}

std::vector<double> graded_lines(double from, double to, bool fine_from, bool fine_to, double finest) {
  constexpr double kGrading = 0.15;
  const double length = fine_from && fine_to ? 0.5 * (to - from) : to - from;
  finest = std::min(finest, 0.5 * length);
  const int steps = int(std::ceil(std::log(finest / length) / std::log(kGrading)));
  std::vector<double> lines{from};
  // Element k of a graded end reaches to finest (length/finest)^(k/steps).
  const auto reach = [&](int k) { return finest * std::pow(length / finest, double(k) / steps); };
  if (fine_from)
    for (int k = 0; k < steps; ++k) lines.push_back(from + reach(k));
  if (fine_from && fine_to) lines.push_back(from + length);
  if (fine_to)
    for (int k = steps - 1; k >= 0; --k) lines.push_back(to - reach(k));
  return lines;
}

std::vector<Eigen::MatrixXd> BlockTridiagonal::solve(std::vector<Eigen::MatrixXd> loads) && {
  const std::size_t blocks = diagonal.size();
  for (std::size_t r = 0; r < blocks; ++r) {
    const Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> factor(diagonal[r]);
    if (factor.info() != Eigen::Success) throw std::runtime_error("the elements' equations are not positive definite");
    loads[r] = factor.solve(loads[r]);
    if (r + 1 == blocks) break;
    const Eigen::MatrixXd coupled = std::move(above[r]);
    const auto first = coupled.cols();
    loads[r + 1].topRows(first) -= coupled.transpose() * loads[r];
    above[r] = factor.solve(coupled);
    diagonal[r + 1].topLeftCorner(first, first).noalias() -= coupled.transpose() * above[r];
  }
  for (std::size_t r = blocks - 1; r-- > 0;) loads[r] -= above[r] * loads[r + 1].topRows(above[r].cols());
  return loads;
}

}  // namespace strata::reference
