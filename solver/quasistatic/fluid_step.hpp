// The fluid's part of a step without inertia, under each of the three laws.
#pragma once

#include <span>
#include <string>

#include "quasistatic/model.hpp"
#include "state/state.hpp"

namespace strata {

/// Fills the fracture at the start: at the inlet's start pressure or, where a rate drives the flow, at its closing
/// stress; where it grows it is then dry but for an increment on either side of the inlet, and the fluid's front goes
/// on through it as behind a tip without toughness. `model` must be up to date. Throws NumericalFailure as
/// find_equilibrium() does.
void fill_fracture(const Scene& scene, State& state, QuasistaticModel& model);

// What a step of the fluid says: whether it was found, and its error against what is allowed (1: just so).
struct FluidStep {
  bool found = true;
  double error = 0.0;
  std::string reason;  // why none was found
};

// The shortest step of flow and rock together (s). After growth the pressure drops at once, but for what flows
// meanwhile.
constexpr double shortest_coupled_step = 1e-6;

/// Pressures at the end of a step dt (s), in state.fluid, at the fracture's points and, under law = "reynolds", in
/// state.reynolds; state.time moves on. uniform: the inlet's. paper: the study's diffusion in steps that resolve it,
/// with the openings midway, foreseen from the rates of the step before (state.fluid.w_rate) or by a trial step.
/// reynolds: flow and rock in one system, over shortest_coupled_step at least. dt = 0: only what growth changed.
/// at_tips: when (s) the fronts of the last growth are at their tips, if later than the step's end. Throws
/// NumericalFailure as find_equilibrium() and diffuse() do.
FluidStep advance_fluid(const Scene& scene, double dt, State& state, QuasistaticModel& model, double at_tips = 0.0);

/// What a step of the study's law from `before` and its openings (m, one a point) at a time (s) owes to openings midway
/// that were foreseen, after the equilibrium at its end: half of what the mean of the openings of its ends would have
/// changed of any pressure, over the largest net pressure; it goes by the third power of the step. Throws nothing.
double lag_error(const Scene& scene, const FluidLine& before, std::span<const double> w_before, double time,
                 const State& state);

/// Notes at what rates openings have changed from w_before (m, one a point) in a step dt (s) that ends at `state`.
void note_rates(std::span<const double> w_before, double dt, State& state);

/// From a growth on, which took a time (s): steps of the flow begin here, with fronts in the new cells, until
/// state.grown is emptied or the next growth.
void start_fronts(double took, State& state);

/// How near the fluid's front in an initial fracture that is dry ahead of it is to going on (1: it does): see
/// front_filling().
double front_margin(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip);

/// How near a tip that by J is `by_K` near is to growth (1: it grows), in rock of toughness K_Ic (Pa sqrt(m)). Where
/// openings_tell() also by opening_behind() 2 to 4 cells behind the tip, where a grid's openings are right to half a
/// per cent. K is off by 5 viscous_tip()^4 or so, more where the rock leaks, so that K counts where that is small,
/// openings where it is large. Throws nothing.
double fed_margin(const Scene& scene, const Rocks& rocks, const State& state, const Tip& tip, double K_Ic, double by_K);

/// Whether such fronts go on, by an increment, which is then done: no load changes by it. Each took the time since it
/// last went on, at least `least_s` (s).
bool fronts_go_on(const Scene& scene, const Rocks& rocks, double least_s, State& state);

/// How near the tip of a rock without toughness is to growth (1: it grows). It grows as soon as the fracture is open
/// there: where K_I, and the K that each opening within two cells behind the tip stands for (w = 8 K/E' sqrt(x/(2
/// pi))), exceed what a cell resolves of the net pressure's own. Fluid that has just wetted the last cells would let
/// the tip run ahead of the open fracture otherwise. E_prime Pa.
double toughless_margin(const State& state, double E_prime, const Tip& tip);

/// The new cells of a fracture that has grown by `added` points at a tip, empty (law = "reynolds").
void add_fluid_cells(const Scene& scene, bool at_back, std::size_t added, State& state);

}  // namespace strata
