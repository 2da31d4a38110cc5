// Lubrication flow along the fracture that conserves mass, solved in one system with the rock that the fluid opens.
//
//   d(theta w)/dt + d(theta q)/ds = inlet - leak-off,  q = -(w^3/(12 mu)) d(P + rho g y)/ds
//   theta = phi (1 + (P - P_c)/M),  P >= P_c,  0 <= phi <= 1,  (P - P_c)(1 - phi) = 0
// which is (w/M) dP/dt + dw/dt = d/ds(w^3/(12 mu) dP/ds) + inlet where the fracture is full (Batchelor 1967,
// section 4.8) and a fluid front where it is not (mass-conserving cavitation: Jakobsson & Floberg 1957; Elrod 1981).
// theta is the fluid's density over that at the cavitation pressure P_c, phi the part of the opening that fluid fills;
// rho g is that of the scene, whatever the pressure.
//
// Finite volumes: a cell is a segment of the fracture, with P, phi and the opening w at its middle, where the rock
// feels P and where the fluid is stored. Backward Euler. What a cell holds, theta w A, is part of the state: it stays
// what it was when growth changes the openings, so nothing is lost or made between steps.
// Leak-off: a cell loses over a step what the rock has taken since the cell was wet less what was lost before; of a
// cell that fluid fills in part that part loses, and what is missing is lost once the cell is full.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <vector>

#include "flow/reynolds_line.hpp"
#include "scene/scene.hpp"
#include "state/fluid_line.hpp"

namespace strata {

// The rock under a pressure: the opening at the fracture's points (m; about 0 where faces touch), and its change per
// pressure at the points (m/Pa), row: opening, column: pressure; and what tells how a pressure within a cell parts its
// faces, E/(1 - nu^2) and the closing stress there (Pa), or nothing where they part by cells alone; what a rock that
// takes up fluid has taken, as volume at the pressure of the fracture; and up to how much its openings follow from
// pressures by their digits.
struct RockResponse {
  Eigen::VectorXd w;
  Eigen::MatrixXd dw_dP;
  Eigen::VectorXd E_prime = {}, closing = {};
  Eigen::VectorXd lost = {};   // by both faces of each cell until the step's end (m^2), or nothing where none leak
  Eigen::VectorXd front = {};  // front_conductances(), or none
  Eigen::VectorXd most = {};   // that flows to a front, signed, or no number: see limit_to_front()
  Eigen::VectorXd rise = {};   // rho g times each cell's height above the inlet (Pa), or nothing: without weight
  double cancels = 0.0;        // the largest of the stresses whose difference holds faces (Pa)
};
using RockModel = std::function<RockResponse(const Eigen::VectorXd& P)>;  // P absolute, one a point (Pa)

// What rough faces hold between them when they just touch (m), 1e-4 of the study's openings; under load less, nothing
// at the closing stress. Between rigid faces a closed cell would take up no fluid on the way from no pressure to that
// which parts them, and its balance could not tell how far it is.
constexpr double roughness = 1e-7;

// The opening (m) whose cube stands for all between the middles of two cells, the mean of the arithmetic and the
// harmonic mean of theirs. Against the exact 1/int 12 mu/w^3 ds behind a tip it is 3.5 % low for w ~ x^(1/2) and 0.7 %
// high for x^(2/3), where the cube of the arithmetic mean is 8 and 22 % high. A cell that growth has just added, still
// closed, gets 1/64 of its neighbour's cube: a wedge's would leave it to the floor, and the fracture's speed with it.
template <class Opening>
Opening opening_between(const Opening& a, const Opening& b) {
  return 0.25 * (a + b) + a * b / (a + b);
}

// What drives the flow at the inlet vertex, at the end of the step.
struct Inlet {
  enum class Drive { pressure, rate };
  Drive drive = Drive::pressure;
  double value = 0.0;  // pressure (Pa), or what enters the modelled domain (m^2/s, at the pressure of its first cell)
};

struct StepReport {
  bool converged = false;  // where false nothing was changed, and reason says why
  std::string reason;
  int iterations = 0;
  double inlet_Pa = 0.0;  // pressure at the inlet vertex
  double error_w = 0.0;   // error of this step's opening, relative to the largest opening; 0 where it is not known
};

struct ReynoldsOptions {
  int max_iterations = 100;   // a fifth as many first, then as many again from another start
  bool filled_first = false;  // the start that is tried first: every cell full, or what was before the step
  double tolerance = 1e-12;   // of a cell's imbalance, relative to the fluid in the fracture; not below round-off
};

/// One step dt (s) of flow and rock together: Newton's method on the balance of each cell, with P free in full cells
/// and phi in others. Changes line and balance only where it converges; throws what the rock throws.
StepReport step_reynolds(const Fluid& fluid, const Inlet& inlet, double dt, const RockModel& rock, ReynoldsLine& line,
                         FluidBalance& balance, const ReynoldsOptions& options = {});

}  // namespace strata
