// What to watch in a run, as plain data that a checkpoint keeps: each quantity says by itself whether the run did what
// its equations say. output/suspect.hpp judges them.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>

namespace strata {

// "At rows" below: whenever a row of the history is due, since the strain energy of runs with inertia is only known
// then. Energies are per metre of thickness (J/m). Largest values are taken by note_largest(), which keeps a number
// that is none.
struct Monitors {
  double largest_courant = 0.0;            // c_P dt / h
  double largest_penetration = 0.0;        // of closed contact (m)
  std::int64_t contact_sweeps = 0;         // Gauss-Seidel sweeps, or Newton's iterations without inertia, summed
  std::int64_t contact_unconverged = 0;    // steps whose contact solve ran out of sweeps
  double largest_particle_velocity = 0.0;  // m/s
  double contact_residual = 0.0;           // largest force out of balance in an equilibrium, over the largest load
  double volume_balance = 0.0;             // fluid missing now, over what was injected (law = "reynolds")
  std::int64_t mirror = 0;                 // 1: solved on half of a mirror-symmetric block

  double largest_open_J = 0.0;     // |stored + dissipated - supplied| of the ledger, at rows
  double largest_made_J = 0.0;     // energy that the time step and the transfer have made, net (watch_made)
  double largest_strain_J = 0.0;   // strain energy of rock and interfaces, at rows
  double largest_kinetic_J = 0.0;  // at rows, too

  double expected_x = 0.0, expected_y = 0.0;  // momentum of the block by its start, body force and damping (kg/s)
  double largest_drift = 0.0;                 // of the momentum from that along axes that no edge holds, at rows (kg/s)
  double largest_momentum = 0.0;              // sum m |v|, at rows (kg/s)

  double force_balance = 0.0;      // largest force out of balance at any node over the largest load, at output times
  double largest_imbalance = 0.0;  // of |volume_balance| so far
  double delivered_m2 = 0.0;       // what the pressure's slope at the inlet has let in (law = "paper", m^2)

  std::int64_t growths = 0;           // of tips away from interfaces, where J is to be trusted
  std::int64_t growths_apart = 0;     // of tips so near to one that J is not
  std::int64_t growth_unweighed = 0;  // times that energy should have decided, and the rock at rest had no equilibrium
  double J_spread_sum = 0.0;          // of (max - min)/mean of J over its rings, at the former
  double largest_J_spread = 0.0;

  double contact_left = 0.0;        // largest change of a reaction in a step's last sweep, over its largest reaction
  double largest_contact_Pa = 0.0;  // normal reaction of any place
  double largest_tension_Pa = 0.0;  // of a place that carries none by its law

  double largest_strain = 0.0;    // principal strain of a particle, at output times
  double largest_rotation = 0.0;  // (du_y/dx - du_x/dy)/2 of a particle (rad), at output times
  double largest_jump = 0.0;      // opening or slip of faces (m), at output times
  double net_at_start_Pa = 0.0;   // how far the fluid's first pressure exceeds the closing stress
  double largest_net_Pa = 0.0;    // how far its pressure anywhere in the fracture has, at rows

  // Of the flow at growth: see flow/flow_monitors.hpp.
  std::int64_t flow_growths = 0;           // all growth when it was last looked at
  double flow_fall_Pa = 0.0;               // largest fall of the pressure in a cell since then (by rate: the last)
  double flow_fall = 0.0;                  // the same over the inlet's net pressure as it is now,
  double largest_flow_fall = 0.0;          // and the largest at growth
  std::array<double, 2> floor_share = {};  // what the pressure owes to the floor of the opening now, by sides,
  double floor_share_sum = 0.0;            // and summed over growths, of the side that grew
  std::array<double, 2> viscous_tip = {};  // what the fluid takes up within a cell of a tip now, by sides,
  double viscous_at_growth = 0.0;          // and at the last growth, of the side that grew
};

/// Takes up a value that is larger than the largest so far. One that is no number stays: no later one hides it.
inline void note_largest(double& largest, double value) {
  if (!std::isnan(largest) && !(value <= largest)) largest = value;
}

}  // namespace strata
