#include "output/suspect.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "output/history.hpp"

namespace strata {

namespace {

// a/b where both are sums of the same kind; 0 where there is nothing of either.
double share(double a, double b) {
  if (a == 0.0 && !std::isnan(b)) return 0.0;
  return b != 0.0 ? a / b : std::numeric_limits<double>::infinity();
}

// What a per cent of the energy stands for in results: K and openings go with its root, so half a per cent of them.
constexpr double energy_threshold = 0.01;

void watch_energy(const Scene& scene, const State& state, std::vector<Watched>& out) {
  const Monitors& m = state.monitors;
  const bool inertia = scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics;
  double open = m.largest_open_J;
  note_largest(open, std::abs(state.ledger.open()));
  out.push_back({"energy_closure", share(open, state.ledger.largest), energy_threshold,
                 "the energy ledger stayed open by more than 1 % of the largest energy exchanged"});
  if (!inertia) return;
  // With a step beyond its limit modes grow that no work has fed, and contact that does not converge can feed them,
  // too; what the step and the transfer make shows as dissipation below zero.
  out.push_back({"energy_made", share(m.largest_made_J, state.ledger.largest), energy_threshold,
                 "the time step and the transfer made more than 1 % of the largest energy exchanged out of nothing"});
  // Free vibration has as much of one energy as of the other, a suddenly loaded body less of the kinetic; more comes of
  // parts that fly. Below, inertia is the physics of unstable growth: a figure that tells how far from the quasi-static
  // answer a run may be, and no fault. Blocks that a scene itself throws or pulls are not judged.
  const bool thrown = scene.initial.velocity_m_s || scene.body.acceleration_m_s2;
  if (thrown && m.largest_strain_J == 0.0) return;
  out.push_back({"kinetic_share", share(m.largest_kinetic_J, m.largest_strain_J),
                 thrown ? std::nullopt : std::optional(1.0),
                 "the largest kinetic energy exceeded the largest strain energy: parts of the block fly freely"});
}

// Share of the particles that are in another cell than they started in. Where they are now says enough: a motion that
// carried them back has left its mark on the energy.
double share_crossed(const State& state) {
  const Particles& p = state.particles;
  const Grid& g = state.grid;
  std::size_t crossed = 0;
  for (std::size_t q = 0; q < p.size(); ++q) {
    crossed += g.cell_along_x(p.x[q]) != g.cell_along_x(p.x[q] - p.u_x[q]) ||
               g.cell_along_y(p.y[q]) != g.cell_along_y(p.y[q] - p.u_y[q]);
  }
  return p.size() > 0 ? static_cast<double>(crossed) / static_cast<double>(p.size()) : 0.0;
}

void watch_motion(const Scene& scene, const State& state, std::vector<Watched>& out) {
  const Monitors& m = state.monitors;
  const double limit = courant_limit(scene.numerics.shape);
  if (scene.numerics.mechanics == Numerics::Mechanics::quasistatic) {
    // What Newton's method on the pieces solves to (1e-9 of the load), with some room for round-off.
    out.push_back({"contact_residual", m.contact_residual, 1e-8,
                   "forces at surfaces were out of balance by more than 1e-8 of the load"});
    out.push_back({"force_balance", m.force_balance, 1e-6,
                   "forces at the nodes were out of balance by more than 1e-6 of the load"});
    return;
  }
  out.push_back(
      {"largest_courant", m.largest_courant, limit, "no block of such a shape is stable with so long a time step"});
  // Gradients of hat functions jump between cells, and with them what a point's stress exerts (Steffen, Kirby & Berzins
  // 2008); one point is enough.
  if (scene.numerics.shape == Numerics::Shape::linear && scene.numerics.kinematics == Numerics::Kinematics::updated)
    out.push_back({"cells_crossed", share_crossed(state), 0.0,
                   "particles went into other cells under linear functions, whose gradients jump there: use bspline2"});
  // Each step keeps momentum to round-off, 1e-16 of it; 1e6 steps that all erred to one side make 1e-10.
  if (!scene.domain.holds_x() || !scene.domain.holds_y())
    out.push_back({"momentum", share(m.largest_drift, m.largest_momentum), 1e-8,
                   "momentum along an axis that no edge holds is not what started the block and the body force gave"});
}

void watch_fluid(const Scene& scene, const State& state, std::vector<Watched>& out) {
  const Monitors& m = state.monitors;
  if (!state.has_fracture) return;
  if (scene.fluid.law == Fluid::Law::reynolds) {
    double imbalance = m.largest_imbalance;
    note_largest(imbalance, std::abs(m.volume_balance));
    out.push_back({"fluid_imbalance", imbalance, 1e-8, "more than 1e-8 of the fluid is missing or was made"});
  }
  // The study's law (3) has no dw/dt: the fracture takes what opening it needs whatever has come in. The figure says by
  // how much; no run of this law can do better, so it marks none.
  if (scene.fluid.law == Fluid::Law::paper) {
    const double opened = fracture_volume(state);
    if (!(opened <= 0.0)) out.push_back({"fluid_imbalance", (opened - m.delivered_m2) / opened, std::nullopt, ""});
  }
}

void watch_growth(const State& state, std::vector<Watched>& out) {
  const Monitors& m = state.monitors;
  if (m.growths == 0) return;
  const auto n = static_cast<double>(m.growths);
  // A tenth of J is a twentieth of K, and of the pressure at which a tip grows.
  out.push_back({"J_spread_mean", m.J_spread_sum / n, 0.1,
                 "J differed between its rings by more than a tenth at growth, on average away from interfaces"});
  out.push_back({"J_spread_largest", m.largest_J_spread, std::nullopt, ""});
}

void watch_contact(const Scene& scene, const State& state, std::vector<Watched>& out) {
  const Monitors& m = state.monitors;
  double stiffest = 0.0;  // E' (Pa)
  for (const Rock& rock : scene.rocks)
    stiffest = std::max(stiffest, rock.youngs_modulus_Pa / (1.0 - rock.poisson_ratio * rock.poisson_ratio));
  // By the laws' contact stiffness faces overlap by 1e-4 of what a cell deforms under the same pressure: a hundred
  // times as much is no longer the law's, and a per cent of what a cell does is where results would show it.
  const double overlap = m.largest_penetration * stiffest / state.grid.h;
  out.push_back({"penetration_share", share(overlap, m.largest_contact_Pa), 0.01,
                 "closed faces overlapped by more than 1 % of what a cell deforms under the largest contact pressure"});
  out.push_back({"tension_share", share(m.largest_tension_Pa, m.largest_contact_Pa), 1e-9,
                 "faces that carry no tension by their law carried some"});
  if (scene.numerics.mechanics != Numerics::Mechanics::explicit_dynamics) return;
  out.push_back({"contact_left", m.contact_left, 0.01,
                 "a step's contact ran out of sweeps while a reaction still changed by more than 1 % of the largest"});
}

// Functions of low order lock where rock hardly changes its volume: a crack opens too little, by 2.9 % with hat
// functions at nu = 0.45 (20 cells along it) and by 1.8 % with quadratic B-splines at 0.495 (10 cells). Told as the
// ratio (lambda + mu)/mu = 1/(1 - 2 nu).
void watch_locking(const Scene& scene, std::vector<Watched>& out) {
  double most = 0.0;
  for (const Rock& rock : scene.rocks) most = std::max(most, 1.0 / (1.0 - 2.0 * rock.poisson_ratio));
  constexpr double spline_limit = 101.0, hat_limit = 10.1;  // nu = 0.495, 0.45
  out.push_back({"incompressibility", most,
                 scene.numerics.shape == Numerics::Shape::bspline2 ? spline_limit : hat_limit,
                 "rock is so nearly incompressible that functions of this order lock: it is too stiff"});
}

// Quadratic B-splines carry the kink of strain at a bonded border of two rocks over three cells. What they miss there,
// times the stiff rock's modulus, is stress: 2 % of a layer's mean at a contrast of 10 (4 cells a layer), of the size
// of the stress itself beside the border at 100, where K_I of a crack 8 cells away is 1.3 % off. Hat functions kink on
// grid lines.
void watch_contrast(const Scene& scene, std::vector<Watched>& out) {
  if (scene.numerics.shape != Numerics::Shape::bspline2) return;
  double most = 1.0;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    if (scene.laws[scene.strata.interfaces[k].law].kind != InterfaceLaw::Kind::perfect) continue;
    const double a = scene.rocks[scene.strata.layers[k].rock].youngs_modulus_Pa;
    const double b = scene.rocks[scene.strata.layers[k + 1].rock].youngs_modulus_Pa;
    most = std::max({most, a / b, b / a});
  }
  out.push_back({"stiffness_contrast", most, 30.0,
                 "rocks bonded to each other differ so much in stiffness that stresses within three cells of their "
                 "border are of no worth"});
}

}  // namespace

double courant_limit(Numerics::Shape shape) {
  return shape == Numerics::Shape::bspline2 ? 1.71 : 1.04;
}

std::vector<Watched> watched(const Scene& scene, const State& state) {
  std::vector<Watched> out;
  watch_energy(scene, state, out);
  watch_motion(scene, state, out);
  watch_fluid(scene, state, out);
  watch_growth(state, out);
  watch_contact(scene, state, out);
  watch_locking(scene, out);
  watch_contrast(scene, out);
  return out;
}

std::vector<Watched> suspicions(const Scene& scene, const State& state) {
  std::vector<Watched> all = watched(scene, state);
  std::erase_if(all, [](const Watched& w) {
    return std::isfinite(w.value) && !(w.threshold && w.value > *w.threshold);  // a figure that is none marks, too
  });
  for (Watched& w : all) {
    if (!std::isfinite(w.value)) w.why = w.monitor + " is not a finite number";
  }
  return all;
}

}  // namespace strata
