// The fluid of law = "reynolds" in the fracture's cells: how it is there to begin with, and what cells it gets.
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.hpp"
#include "state/fluid_line.hpp"

namespace strata {

// The roughness that keeps faces apart (m): contact lets w go to about -1e-8 m, and a cell that holds nothing at any
// pressure would leave its balance without an unknown. 1e-4 of the study's openings.
constexpr double thinnest = 1e-8;

/// The opening (m) that holds fluid where faces are w (m) apart, or touch.
double storage_opening(double w);

/// Density of the fluid at P (Pa), by that at the cavitation pressure.
template <class T>
T density(const Fluid& fluid, const T& P) {
  return T(1.0) + (P - T(fluid.cavitation_Pa)) / fluid.bulk_modulus_Pa;
}

/// A fracture full of fluid at P (Pa) throughout, or less by its weight over the cells' rise above the inlet, rho g y
/// (Pa), with openings w (m) in cells of the given lengths (m) and the inlet at a vertex, wet from time 0 on; sets
/// `balance` to nothing injected.
ReynoldsLine full_line(const Fluid& fluid, const std::vector<double>& length, std::size_t inlet, double P,
                       const Eigen::VectorXd& w, FluidBalance& balance, const Eigen::VectorXd& rise = {});

/// Fills the cells of a line anew at the pressures and filled parts that they have, in rock with other openings w (m);
/// nothing is injected by it.
void fill_openings(const Fluid& fluid, const Eigen::VectorXd& w, ReynoldsLine& line, FluidBalance& balance);

/// Takes the fluid out of a cell that has not been wet yet: nothing flows to it until wet_s is finite.
void leave_dry(const Fluid& fluid, std::size_t cell, ReynoldsLine& line, FluidBalance& balance);

/// Adds an empty cell (phi = 0, P = P_c) of the given length (m), wet from `time` (s) on, after the last one (at_back)
/// or before the first, where the inlet's vertex moves up by one.
void grow(ReynoldsLine& line, const Fluid& fluid, bool at_back, double length, double time = 0.0);

/// Pressure at the vertices (Pa, one more than cells): linear between the cells' middles, the inlet's own at the inlet,
/// the last cell's at a closed end, through which nothing flows.
std::vector<double> vertex_pressures(const ReynoldsLine& line);

}  // namespace strata
