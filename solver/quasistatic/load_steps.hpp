// Steps of a run without inertia: from event to event.
#pragma once

#include "fracture/j_integral.hpp"
#include "quasistatic/growth_trials.hpp"
#include "quasistatic/model.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// What a quasi-static run holds beside its state. All of it follows from the state, so a run can be resumed from that.
struct Quasistatic {
  QuasistaticModel model;
  Equilibrium equilibrium;
  std::vector<TipRule> rules;       // of all tips
  std::vector<GrowthTrial> trials;  // of the tips that energy decides about
  double margin = 0.0;              // the nearest event: it happens at 1
  double tip_margin = 0.0;          // the nearest growth
  double parting_margin = 0.0;      // the nearest interface that parts by energy
  std::size_t parting = 0;          // and its trial
};

/// Equilibrium of a state that was initialised or read back; builds what `run` holds. Throws NumericalFailure where
/// there is none.
void start_quasistatic(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run);

/// The same of a state that `run` was built for and has been at since: what a resumed run finds there, digit by digit,
/// without building anew what has not changed. Throws as start_quasistatic() does.
void restart_quasistatic(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run);

/// Whether a bonded place carries more than it can at the present load, or parts by energy and no tip is nearer to
/// growth: the next step lets it go before anything else happens, and the state is no equilibrium of its interfaces'
/// laws yet. Throws nothing.
bool failure_due(const Quasistatic& run);

/// One step. Where something is due at the present load (the worst bonded column fails, a tip grows; in the order that
/// fracture.order says) it happens, and the load stays. Else time goes on, at most to `until` (s), and no further than
/// to the load at which the next thing happens: growth where J or the energy released over a finite increment reaches
/// J_c of the rock ahead, failure where an interface's strength is reached or, by energy, its J_c. Throws
/// NumericalFailure where there is no equilibrium: parts of the block move freely.
void advance_quasistatic(const Scene& scene, const Rocks& rocks, double until, State& state, Quasistatic& run);

}  // namespace strata
