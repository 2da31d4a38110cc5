// The whole state of a run as plain data: what a checkpoint saves, what follows from it, and what a step works in.
#pragma once

#include <cmath>
#include <cstdint>
#include <iterator>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "state/copies.hpp"
#include "state/fluid_line.hpp"
#include "state/grid.hpp"
#include "state/monitors.hpp"
#include "state/nodal.hpp"
#include "state/particles.hpp"
#include "state/places.hpp"
#include "state/surfaces.hpp"
#include "state/total_motion.hpp"

namespace strata {

// A spring between the two copies of a node less than a cell behind a tip (see interfaces/tip_ties.hpp).
struct TipTie {
  int node = 0;
  int plus = -1, minus = -1;  // records
  double stiffness = 0.0;     // Pa per metre of thickness
  SurfacePoint s;             // its jump and reaction
};

// What may stand in the way of the rings on which J and K of a tip are measured: an interface whose faces have come
// apart, a bonded border of two rocks, the symmetry line or an edge of the block, another part of the fracture.
enum class Obstacle { none, interface, rock_border, symmetry_line, edge, fracture };

// What decides whether a tip grows. J: the J-integral. K: (K_I^2 + K_II^2)/E', as the interaction integral has it or,
// nearer to an interface than that can tell, as the slope of the energy with the fracture's length. energy: what a
// finite increment releases.
enum class Criterion { J, K, slope, energy };

struct Tip {
  bool at_back = true;  // at the last vertex of the fracture, or at the first
  bool growing = true;  // false once it may not grow any more (see stopped_by)
  std::string stopped_by;
  double K_I = 0.0, K_II = 0.0;    // stress intensity factors (Pa sqrt(m)); K_I of a closed tip is 0
  double J = 0.0;                  // J-integral, mean over rings (N/m)
  double J_spread = 0.0;           // (max - min)/mean over rings
  double ring_m = 0.0;             // outer radius of the widest ring (m)
  double kink = 0.0;               // next growth direction from the present one (rad), counter-clockwise positive
  double turn = 0.0;               // what the next increment turns by (rad)
  bool closed = false;             // the faces touch: no direction to open into
  Obstacle near = Obstacle::none;  // what is so near that J and K are not to be trusted
  bool crossed = false;            // it is within the rings: J and K are no numbers of the tip
  bool no_length = false;          // the tip stands on an interface that is apart: it has no length in the rock ahead
  double last_growth_s = -1.0;     // time of its last growth, -1 before the first
  double last_growth_Pa = 0.0;     // inlet pressure then
  double due_s = -1.0;             // explicit: no increment before this time (s), since Rayleigh waves are no faster
  double runs_until_s = -1.0;      // and until then J still answers to the last one
  double G_trial = 0.0;            // what growth by energy would release now, by the increment's length (N/m)
  double G_along = 0.0;            // the same where an interface would part from there on; no number: none would
  double G = 0.0;                  // what its last increment released, by its length (N/m)
  double G_by_J = 0.0;             // the same from J along it (N/m); 0 where that does not tell
  Criterion criterion = Criterion::J;  // what decides its growth where it stands
  std::string grew_by;                 // and what decided its last growth: "J", "K" or "energy"
  bool has_grown = false;
  bool arrested = false;
  std::vector<int> reached;  // interfaces (index into Scene::strata) already reported as reached
};

struct Event {
  std::string kind;  // "start", "reach_interface", "arrest", "restart", "stop"
  double time_s = 0.0;
  double inlet_Pa = 0.0;
  double tip_x_m = 0.0, tip_y_m = 0.0;
  bool at_interface = false;  // decided by a J too near to an interface to be trusted
  std::string by;             // what decided it: "J", "K" or "energy"
  std::string tip = {};       // which of two tips, by tip_name()
};

// Energy per metre of thickness (J/m) since the start: what each is says `ledger_energies`. Work done on the rock is
// positive, and so is dissipation.
struct Ledger {
  double kinetic = 0.0, strain = 0.0, interface_strain = 0.0;
  double fluid_work = 0.0, in_situ_work = 0.0, body_work = 0.0, initial_kinetic = 0.0, edge_work = 0.0;
  double damping = 0.0, transfer = 0.0, integration = 0.0, friction = 0.0, failure = 0.0, fracture = 0.0, excess = 0.0;
  double largest = 0.0;  // largest fluid, in-situ or body work or kinetic energy so far, the scale for closure()

  double supplied() const { return fluid_work + in_situ_work + edge_work + body_work + initial_kinetic; }
  double stored() const { return kinetic + strain + interface_strain; }
  double dissipated() const { return damping + transfer + integration + friction + failure + fracture + excess; }
  double open() const { return stored() + dissipated() - supplied(); }
  double closure() const { return largest == 0.0 ? 0.0 : open() / largest; }
  bool finite() const { return std::isfinite(open()) && std::isfinite(largest); }

  // Takes up what has been done so far as the scale; a number that is none stays.
  void note_scale() {
    for (const double work : {fluid_work, in_situ_work, body_work}) note_largest(largest, std::abs(work));
    note_largest(largest, kinetic);
  }
};

// An energy of the ledger by its name.
struct LedgerEnergy {
  const char* name;
  double Ledger::*value;
  const char* description;
};

// All of them, those that are stored first, then what was supplied and what was dissipated.
inline constexpr LedgerEnergy ledger_energies[] = {
    {"kinetic", &Ledger::kinetic, "kinetic energy of the particles, now"},
    {"strain", &Ledger::strain, "strain energy of the change from the in-situ state, now"},
    {"interface_strain", &Ledger::interface_strain, "energy in the springs of soft interfaces and of tips, now"},
    {"fluid_work", &Ledger::fluid_work, "work of the fluid on the rock: integral of P dV"},
    {"in_situ_work", &Ledger::in_situ_work, "work of the in-situ tractions released on surfaces"},
    {"edge_work", &Ledger::edge_work,
     "work of the edges' tractions beyond the in-situ ones: none, edges keep these or do not move"},
    {"body_work", &Ledger::body_work, "work of the body force"},
    {"initial_kinetic", &Ledger::initial_kinetic, "kinetic energy that particles start with"},
    {"damping", &Ledger::damping, "dissipated by damping"},
    {"transfer", &Ledger::transfer, "dissipated between particles and grid"},
    {"integration", &Ledger::integration,
     "lost by the time step itself, most of it at shocks: sum of dt^2 (f M^-1 f - v K v)/2"},
    {"friction", &Ledger::friction, "dissipated by sliding and the implicit step of springs"},
    {"failure", &Ledger::failure, "released by bonded places that let go"},
    {"fracture", &Ledger::fracture, "what new surface takes: J_c times its length"},
    // Also from springs of tips (TipTie). With inertia surface costs the motion nothing: all is lacking.
    {"excess", &Ledger::excess, "released by growth beyond that, which nothing takes up; negative: what growth lacked"},
};
static_assert(sizeof(Ledger) == (std::size(ledger_energies) + 1) * sizeof(double), "all but the scale are listed");

// What a checkpoint writes.
struct SavedState {
  double time = 0.0;  // s
  std::int64_t step = 0;
  double dt = 0.0;  // the time step of runs with inertia; without, the step that a flow tries next (s)
  Grid grid;
  Particles particles;
  std::vector<Surface> surfaces;  // the fracture first, where there is one
  bool has_fracture = false;
  FluidLine fluid;
  ReynoldsLine reynolds;  // of law = "reynolds" only
  FluidBalance balance;   // the same
  GrownFluid grown;       // the same
  std::vector<Tip> tips;
  std::vector<TipTie> ties;
  std::vector<Event> events;
  Ledger ledger;
  Monitors monitors;

  const Surface& fracture() const { return surfaces.front(); }
  Surface& fracture() { return surfaces.front(); }
};

// What follows from it, by rebuild_copies() but for the last two.
struct DerivedState {
  Copies copies;
  std::vector<Bin> bins;
  std::vector<std::size_t> cut_bins;  // of which a node is cut
  std::vector<Strip> strips;
  std::vector<Master> masters;  // of each record
  std::vector<int> tied;        // those whose master is another one or has a factor 0
  std::vector<std::vector<SurfaceStencil>> point_stencils, vertex_stencils;  // of each surface
  SpanTable x_spans, y_spans;
  Bonds bonds;             // of runs with inertia, see interfaces/failure.hpp
  SplitPlaces split;       // of runs with inertia: of the last step or, under kinematics = "total", the base
  std::vector<Vec2> body;  // force per mass of each particle (m/s^2), set anew at each time; empty: none
};

// What a step works in; all but sums and motion is kept for its memory alone, so that no step allocates any.
struct ScratchState {
  NodalSums sums;
  NodalMotion motion;
  bool gathered = false;                // sweep_particles() has left in sums what the particles now give
  NodalSums body_sums;                  // what the body force gives the nodes: f_x, f_y
  NodalSums filtered;                   // of XPIC(2)
  SpreadArray take_x, take_y;           // the same
  std::vector<ParticleReport> reports;  // of each strip
};

struct State : SavedState, DerivedState, ScratchState {
  TotalMotion total;  // of kinematics = "total" only: its velocity is saved, the rest derived
};

/// Whether equilibria decide about a tip's growth. Throws nothing.
inline bool weighs_energy(const Tip& tip) {
  return tip.criterion == Criterion::energy || tip.criterion == Criterion::slope;
}

/// Whether an interface or a border of rocks is so near to a tip that its J is not to be trusted; throws nothing.
inline bool at_interface(const Tip& tip) {
  return tip.near == Obstacle::interface || tip.near == Obstacle::rock_border;
}

/// Where a tip is (m): the fracture's last vertex or its first; throws nothing.
inline Vec2 tip_position(const State& state, const Tip& tip) {
  return tip.at_back ? state.fracture().vertices.back().x : state.fracture().vertices.front().x;
}

/// Which of two tips one is: "upper" or "lower"; "left" or "right" where they are level to half a cell; "" of a single
/// one. Throws nothing.
inline const char* tip_name(const State& state, const Tip& tip) {
  if (state.tips.size() < 2) return "";
  const auto& v = state.fracture().vertices;
  const Vec2 off = (tip.at_back ? 1.0 : -1.0) * (v.back().x - v.front().x);  // from the other tip
  if (std::abs(off.y()) < 0.5 * state.grid.h) return off.x() > 0.0 ? "right" : "left";
  return off.y() > 0.0 ? "upper" : "lower";
}

/// Sets the pressure at the fracture's vertices to that of a fluid at rest under its inlet's; throws nothing.
inline void rest_fluid(const Fluid& fluid, State& state) {
  const auto& at = state.fracture().vertices;
  for (std::size_t k = 0; k < at.size(); ++k)
    state.fluid.P[k] = fluid.at_rest(state.fluid.inlet_Pa, at[k].x.y() - at[state.fluid.inlet].x.y());
}

/// Sets the pressure of the fracture's points to the mean of the vertices beside; throws nothing.
inline void pass_to_points(State& state) {
  auto& points = state.fracture().points;
  for (std::size_t k = 0; k < points.size(); ++k) points[k].P = 0.5 * (state.fluid.P[k] + state.fluid.P[k + 1]);
}

// How far ahead of a tip its rock is looked up (cells). A tip that stands on an interface follows the rock, by about a
// millimetre per MPa, while the layers' borders stay: the rock ahead must not be taken for the one behind.
constexpr double ahead_cells = 0.1;

/// A place (m) in the rock that a tip is about to enter; throws nothing.
inline Vec2 place_ahead(const State& state, const Tip& tip) {
  return tip_position(state, tip) + ahead_cells * state.grid.h * tip_direction(state.fracture(), tip.at_back);
}

/// Displacement of a record since the base (m), under kinematics = "total", or velocity (m/s): its master's of x and y.
/// Throws nothing.
inline Vec2 of_master(const State& state, int record, const SpreadArray& x, const SpreadArray& y) {
  const Master& master = state.masters[static_cast<std::size_t>(record)];
  const auto at = static_cast<std::size_t>(master.record);
  return {master.x * x[at], master.y * y[at]};
}
inline Vec2 total_displacement(const State& state, int record) {
  return of_master(state, record, state.total.u_x, state.total.u_y);
}
inline Vec2 total_velocity(const State& state, int record) {
  return of_master(state, record, state.total.v_x, state.total.v_y);
}

}  // namespace strata
