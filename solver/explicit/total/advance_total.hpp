// The explicit step under kinematics = "total".
#pragma once

#include <vector>

#include "explicit/advance.hpp"
#include "state/elasticity.hpp"
#include "state/state.hpp"

namespace strata {

// Steps after which particles are brought up to date whatever happens, and a checkpoint may be taken.
constexpr std::int64_t steps_between_bases = 500;

/// One step state.dt of the study's algorithm on nodes that keep their particles. Between events (growth, failure of an
/// interface, output) all that a step needs is fixed, and particles stand still at the last base; see
/// bring_up_to_date(). look: measure the tips at its end; grow: let them grow; weigh: see
/// WeighGrowth. Throws NumericalFailure where the motion is no longer finite.
void advance_total(const Scene& scene, const std::vector<Elasticity>& rocks, bool look, bool grow,
                   const WeighGrowth& weigh, State& state);

}  // namespace strata
