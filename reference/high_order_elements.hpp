// Rectangular plane-strain elements of high order, and the equations of rows of them stacked upwards.
//
// On an element of width h_x and height h_y the displacement is sum_ij u_ij N_i(xi) N_j(eta), N the Lagrange
// polynomials of the Gauss-Lobatto-Legendre points. With the line's integrals M = int N_i N_k, A = int N_i' N_k',
// C = int N_i' N_k over [-1, 1], exact,
//   K_xx = (lambda+2mu)(h_y/h_x) A x M + mu (h_x/h_y) M x A,   K_yy with x and y exchanged,
//   K_xy = lambda C x C^T + mu C^T x C   (first factor along x, second along y).
// Source: Szabo & Babuska 1991, Finite element analysis; points and weights: Karniadakis & Sherwin 2005, appendix B.
#pragma once

#include <Eigen/Dense>
#include <vector>

#include "rock.hpp"

namespace strata::reference {

// The polynomials N_0 .. N_order on [-1, 1] and their integrals.
struct LineBasis {
  // Throws std::invalid_argument for an order below 2 or above 16.
  explicit LineBasis(int order);

  int order;
  Eigen::VectorXd nodes;                   // from -1 to 1
  Eigen::VectorXd weights;                 // int N_i
  Eigen::MatrixXd mass, stiffness, mixed;  // M, A, C

  Eigen::VectorXd values(double xi) const;  // N_i(xi)
  Eigen::VectorXd slopes(double xi) const;  // N_i'(xi)
};

// Stiffness matrix of an element, Pa, or its derivative with respect to ln h_y: what a stretch along y does to it.
// Freedom 2 (i + (order+1) j) + component, i along x; sizes in m.
Eigen::MatrixXd element_stiffness(const LineBasis& line, const Rock& rock, double h_x, double h_y,
                                  bool per_stretch = false);

// Plane-strain stress (s_xx, s_yy, s_xy), Pa, at (xi, eta) in [-1, 1]^2 of an element that is displaced by u (m).
Eigen::Vector3d element_stress(const LineBasis& line, const Rock& rock, double h_x, double h_y,
                               const Eigen::VectorXd& u, double xi, double eta);

// Lines from `from` to `to` (m) with elements of size `finest` at the ends that are asked for, growing geometrically by
// 1/0.15 or less (Gui & Babuska 1986: best for r^(1/2)); to the middle where both ends are asked for. Without `to`.
std::vector<double> graded_lines(double from, double to, bool fine_from, bool fine_to, double finest);

// Symmetric equations whose block r couples to block r + 1 alone, and there to its first `above[r].cols()` unknowns.
struct BlockTridiagonal {
  std::vector<Eigen::MatrixXd> diagonal;  // D_r, square
  std::vector<Eigen::MatrixXd> above;     // rows of block r, first columns of block r + 1; one fewer

  // Solves for loads given by block, columns side by side; uses the matrices up (Cholesky block by block).
  // Throws std::runtime_error if a block is not positive definite.
  std::vector<Eigen::MatrixXd> solve(std::vector<Eigen::MatrixXd> loads) &&;
};

}  // namespace strata::reference
