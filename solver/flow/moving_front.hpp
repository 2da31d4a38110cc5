// The fluid's front, which goes through the cells that growth has added while the tip of the rock stands at their end.
//
// At a speed V, which is their length over the time since growth, the rock behind it opens by toughness, viscosity and
// leak-off together (Garagash, Detournay & Adachi 2011, in the form of Dontsov & Peirce 2015), x = u^2 behind the
// front:
//   w = u W,  3 W^3/(W + e) dW = d du,  W(0) = c = 8 K_Ic/(E' sqrt(2 pi)),  d = 2 3^(5/2) 12 mu V/E',
//   e = 4 C_L/sqrt(V),  q = V (w + e u),  dP/dx = 12 mu q/w^3
// (W + e stands for their W + 0.991 e; without leak-off W^3 = c^3 + d u).
#pragma once

#include <Eigen/Core>
#include <vector>

#include "scene/scene.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// The rock at a tip: E/(1 - nu^2) (Pa), toughness (Pa sqrt(m)), leak-off of a face (m/s^(1/2)).
struct TipRock {
  double E_prime = 0.0, K_Ic = 0.0, C_L = 0.0;
};

/// The rock of the fracture's last point (at_back) or first. Throws nothing.
TipRock tip_rock(const Scene& scene, const Rocks& rocks, const State& state, bool at_back);

/// What faces between cells conduct by the opening of the cell on the tip's side (m/(Pa s)), a value a face, below 0
/// where that is the cell before; 0 where no front is near. The tip is at the line's last cell (at_back) or first, and
/// the front is there at a time (s) after its last growth. While the front goes through new cells of together L,
/// (int_0^x w dx + 2/3 e x^(3/2)) V/L passes a face at x on average: what stands and what has leaked beyond. A cell
/// stands for P at its middle, the last one for the even pressure with as much K_I.
Eigen::VectorXd front_conductances(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock,
                                   double time);

/// Sets the most that flows into the cells that a tip's last growth has added (m^2/s, from the first cell to the last)
/// while the front, which is at the tip at a time `there` (s), is a share f of their length L on its way: what is lost
/// of them (m^2) and what they hold. The rock ahead of the front holds them together, evenly over L: far from the tip
/// as if it were at f L where they hold (9 f - 1)/8 of int_0^L w dx (by point forces on a half-infinite crack, w ~
/// x^(1/2)).
void limit_to_front(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time,
                    double there, const Eigen::VectorXd& lost, Eigen::VectorXd& most);

/// What the cells hold that the front came to last, over what they hold when it is at their end at a time (s),
/// int_0^L w dx at the speed V with which it has then gone through them: 1 when it is there.
double front_filling(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time);

/// What the cells between two distances (m) behind a tip hold, or those from half of the way to the inlet on, over what
/// they hold when the front is at the tip, int w sqrt(1 - x/l) dx: l is the fracture's length, or twice that where it
/// begins at the inlet, and the root what an even pressure makes of w ~ x^(1/2). 1 where growth has added no cells.
double opening_behind(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time,
                      double from, double to);

/// The K (Pa sqrt(m)) that the opening stands for at a distance x (m) behind a front which is at the tip at a time (s),
/// w = 8 K/E' sqrt(x/(2 pi)): the toughness, and what the fall of the fluid's pressure from there to the tip takes up.
/// The toughness alone where growth has added no cells.
double toughness_from(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time,
                      double x);

/// When the front at an end came to the start of the cells that it is in (s): growth, or the way through the initial
/// fracture.
double last_wet(const ReynoldsLine& line, bool at_back);

/// Whether a cell is one of those that a tip's last growth has added.
bool is_new(const ReynoldsLine& line, bool at_back, std::size_t cell);

/// When the front came by the middle of each cell (s): through the cells of a tip's last growth it goes evenly from
/// their start to a time (s) at which it is at the tip; for the tips at the first and at the last cell that are asked
/// for.
std::vector<double> wet_times(const ReynoldsLine& line, double time, bool at_front, bool at_back);

}  // namespace strata
