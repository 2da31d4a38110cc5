// What growth would release: the equilibria of the same particles with the fracture a little longer or shorter.
#pragma once

#include <vector>

#include "fracture/criterion.hpp"
#include "interfaces/parting.hpp"
#include "quasistatic/model.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

struct GrowthTrial {
  std::size_t tip = 0;  // that grows, or that is nearest to what parts
  double length = 0.0;  // the fracture is so much longer at the tip (m), shorter where negative; or what parts
  double turn = 0.0;    // of the tip when it was made (rad)
  Parting parting;      // instead of growth: an interface that parts; columns: none where the fracture grows
  State state;
  QuasistaticModel model;

  bool parts() const { return !parting.columns.empty(); }
};

/// Whether a tip may grow at all: growth is asked for and nothing has stopped it. Throws nothing.
bool may_grow(const Scene& scene, const State& state, const Tip& tip);

/// Notes what decides about each tip where it now stands, and makes the trials that this needs: for a finite increment
/// one with the fracture longer by it, for the slope of the energy one a cell longer and, where a whole piece can be
/// taken away, one a cell shorter, less where an interface is nearer; and one for each that next_partings() has.
/// `model` is the state's own; halve: as in update_equations(), and throws as it does.
std::vector<GrowthTrial> build_trials(const Scene& scene, const Rocks& rocks, State& state,
                                      const QuasistaticModel& model, bool halve = true);

/// Energy (N/m) that tip number `tip` would release per length at the present pressures, the new segment under the
/// pressure of the tip, less what friction would dissipate: over the increment of its trial; with two trials, the slope
/// of the parabola through the three energies. 0 without a trial. Throws as find_equilibrium() does.
double energy_release(const Scene& scene, const State& state, const QuasistaticModel& model,
                      const Equilibrium& equilibrium, std::size_t tip, std::vector<GrowthTrial>& trials);

/// The same of one trial over its own length; what parts is dry, and bears what the interface's law lets it bear.
/// Throws as find_equilibrium() does.
double energy_release(const Scene& scene, const State& state, const QuasistaticModel& model,
                      const Equilibrium& equilibrium, GrowthTrial& trial);

/// Whether the trials are those of the directions that the tips would now take. Throws nothing.
bool trials_hold(const Scene& scene, const State& state, const std::vector<GrowthTrial>& trials);

}  // namespace strata
