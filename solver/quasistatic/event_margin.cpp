#include "quasistatic/event_margin.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fracture/criterion.hpp"
#include "fracture/growth.hpp"
#include "interfaces/failure.hpp"
#include "quasistatic/fluid_step.hpp"

namespace strata {
namespace {

// How near interfaces are to parting by energy: sqrt(G/J_c) of the trial that is nearest, whose G each tip notes.
void weigh_partings(const Scene& scene, State& state, Quasistatic& run) {
  run.parting_margin = 0.0;
  std::vector<double> nearest(state.tips.size(), 0.0);
  for (Tip& tip : state.tips) tip.G_along = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t k = 0; k < run.trials.size(); ++k) {
    GrowthTrial& trial = run.trials[k];
    if (!trial.parts()) continue;
    try {
      const double G = energy_release(scene, state, run.model, run.equilibrium, trial);
      const double margin = std::sqrt(std::max(0.0, G) / trial.parting.J_c);
      if (!(margin < nearest[trial.tip])) nearest[trial.tip] = margin, state.tips[trial.tip].G_along = G;
      if (margin > run.parting_margin) run.parting_margin = margin, run.parting = k;
    } catch (const NumericalFailure&) {  // what parts would move freely
      ++state.monitors.growth_unweighed;
    }
  }
}

}  // namespace

double tip_margin(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run, std::size_t k) {
  Tip& tip = state.tips[k];
  if (state.reynolds.dry_cells(tip.at_back) > 0) return front_margin(scene, rocks, state, tip);
  tip.criterion = criterion_of(scene, state, tip);  // a trial may have had no equilibrium at another load
  const Elasticity& rock = rocks[rock_ahead(scene, state, tip)];
  if (weighs_energy(tip)) {
    try {
      tip.G_trial = energy_release(scene, state, run.model, run.equilibrium, k, run.trials);
    } catch (const NumericalFailure&) {
      ++state.monitors.growth_unweighed;
      tip.criterion = Criterion::K;
    }
  }
  const double G = driving(rock, tip);
  if (rock.J_c > 0.0)
    return fed_margin(scene, rocks, state, tip, std::sqrt(rock.J_c * rock.E_prime),
                      std::sqrt(std::max(0.0, G) / rock.J_c));
  if (weighs_energy(tip)) return G > 0.0 ? 2.0 : 0.0;
  return toughless_margin(state, rock.E_prime, tip);
}

double margin_of(const Scene& scene, const Rocks& rocks, State& state, Quasistatic& run) {
  run.tip_margin = 0.0;
  for (std::size_t k = 0; k < state.tips.size(); ++k) {
    if (may_grow(scene, state, state.tips[k]))
      run.tip_margin = std::max(run.tip_margin, tip_margin(scene, rocks, state, run, k));
  }
  weigh_partings(scene, state, run);
  find_forces(rocks, state, run.model.bonds);
  judge_bonds(scene, state, run.model.bonds);
  bool sound = !std::isnan(run.model.bonds.worst);
  for (const Tip& tip : state.tips) sound = sound && std::isfinite(tip.G_trial);
  if (!sound) throw NumericalFailure("the energy released or the load of a bonded interface is not finite");
  return std::max({run.tip_margin, run.parting_margin, run.model.bonds.worst});
}

void require_dry_tips_at_rest(const Scene& scene, const Rocks& rocks, const State& state) {
  for (const Tip& tip : state.tips) {
    const Elasticity& rock = rocks[rock_ahead(scene, state, tip)];
    const bool at_rest = rock.J_c == 0.0 || tip.K_II * tip.K_II < rock.J_c * rock.E_prime;
    if (state.reynolds.dry_cells(tip.at_back) == 0 || at_rest) continue;
    double holds = 0.0;
    for (const SurfacePoint& s : state.fracture().points)
      holds = std::max(holds, std::abs(s.in_situ.dot(tangent_of(s.n))) / s.closing_stress());
    const Vec2 at = tip_position(state, tip);
    throw NumericalFailure(fmt::format(
        "at t = {:.6g} s the tip at ({:.6g}, {:.6g}) m has K_II = {:.4g} Pa sqrt(m), more than its rock's toughness, "
        "{:.4g}, before the fluid comes to it: the shear of the in-situ stress lets the closed fracture slide, which "
        "would grow without fluid. Use fracture.friction (well above {:.3g}, which just holds dry faces), more "
        "rock.*.toughness_Pa_sqrt_m, a fracture.path_m under less shear, or fracture.growth = \"none\"",
        state.time, at.x(), at.y(), tip.K_II, std::sqrt(rock.J_c * rock.E_prime), holds));
  }
}

}  // namespace strata
