#include "output/suspect.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include "output/history.hpp"
#include "scene/derived.hpp"
#include "state/elasticity.hpp"
#include "state/round_off.hpp"

namespace strata {
namespace {

using Limit = std::optional<double>;
constexpr double infinite = std::numeric_limits<double>::infinity();

// The figures of a run, told one after another.
struct Watch {
  const Scene& scene;
  const State& state;
  const Monitors& m = state.monitors;
  const bool moves = scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics;
  const bool splines = scene.numerics.shape == Numerics::Shape::bspline2;
  const RoundOff nothing = round_off(scene, state);
  std::vector<Watched> out{};

  void note(const char* monitor, double value, Limit threshold, std::string why) {
    out.push_back({monitor, value, threshold, std::move(why)});
  }

  // A share a/b of sums of the same kind, of which `none` is round-off. With no more of a it marks nothing, whatever
  // b is; with no more of both it is 0.
  void share(const char* monitor, double a, double b, double none, Limit threshold, const char* why) {
    const bool little = std::abs(a) <= none;
    const double value = little && std::abs(b) <= none ? 0.0 : b != 0.0 ? a / b : infinite;
    note(monitor, value, little && value != 0.0 ? std::nullopt : threshold, why);
  }

  void energy(), motion(), flow(), fluid(), held_tips(), growth(), surfaces(), deformation(), loading(), contact(),
      rocks();
};

void Watch::energy() {
  // K and openings go with the root of an energy: half a per cent of them.
  constexpr double threshold = 0.01;
  double open = m.largest_open_J;
  note_largest(open, std::abs(state.ledger.open()));
  share("energy_closure", open, state.ledger.largest, nothing.work, threshold,
        "the energy ledger stayed open by more than 1 % of the largest energy exchanged");
  if (!moves) return;
  // A step beyond its limit, or contact that does not converge, feeds modes: dissipation below zero.
  share("energy_made", m.largest_made_J, state.ledger.largest, nothing.work, threshold,
        "the time step and the transfer made more than 1 % of the largest energy exchanged out of nothing");
  // Free vibration has as much of one as of the other; more comes of parts that fly. Below, inertia is the physics of
  // unstable growth. Blocks that a scene itself throws or pulls are not judged.
  const bool thrown = scene.initial.velocity_m_s || scene.body.acceleration_m_s2;
  if (thrown && m.largest_strain_J == 0.0) return;
  share("kinetic_share", m.largest_kinetic_J, m.largest_strain_J, nothing.energy, thrown ? Limit() : 1.0,
        "the largest kinetic energy exceeded the largest strain energy: parts of the block fly freely");
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

void Watch::motion() {
  if (!moves) {
    // What Newton's method on the pieces solves to (1e-9 of the load), with some room for round-off.
    note("contact_residual", m.contact_residual, 1e-8,
         "forces at surfaces were out of balance by more than 1e-8 of the load");
    note("force_balance", m.force_balance, 1e-6,
         "forces at the nodes were out of balance by more than 1e-6 of the load");
    return;
  }
  // c_P dt/h beyond which no block is stable: nodes that keep their velocities, all edges held
  // (verification/stability/theory/step_limit.py). Free edges and transfers lower it, to 0.48 at worst: energy_made.
  note("largest_courant", m.largest_courant, splines ? 1.71 : 1.04,
       "no block of such a shape is stable with so long a time step");
  // Gradients of hat functions jump between cells, and what a point's stress exerts (Steffen, Kirby & Berzins 2008).
  if (scene.numerics.shape == Numerics::Shape::linear && scene.numerics.kinematics == Numerics::Kinematics::updated)
    note("cells_crossed", share_crossed(state), 0.0,
         "particles went into other cells under linear functions, whose gradients jump there: use bspline2");
  // Each step keeps momentum to round-off, 1e-16 of it; 1e6 steps that all erred to one side make 1e-10.
  if (!scene.domain.holds_x() || !scene.domain.holds_y())
    share("momentum", m.largest_drift, m.largest_momentum, nothing.momentum, 1e-8,
          "momentum along an axis that no edge holds is not what started the block and the body force gave");
}

// Judged at growth; where nothing has grown what they are now is told.
void Watch::flow() {
  const std::int64_t growths = m.growths + m.growths_apart;
  const auto where_grown = [growths](double threshold) { return growths > 0 ? Limit(threshold) : std::nullopt; };
  // What the pressure falls by in a cell on its way to the closing stress, over the net pressure at growth. Under law
  // "paper" falls of 0.25, 0.9, 1.16, 1.23 and 1.29 let a ramp start 0, 15, 80, 130 % too high and never; under
  // "reynolds" faces part within cells, and only a rate needs cells that resolve how far the fluid has gone.
  const bool remembers = scene.fluid.law == Fluid::Law::paper || scene.fluid.rate_m2_s;
  note("flow_fall", growths > 0 ? m.largest_flow_fall : m.flow_fall, remembers ? where_grown(0.6) : std::nullopt,
       "at growth the pressure had fallen to the closing stress within a cell or two of the inlet: use smaller cells, "
       "or a larger fluid.minimum_opening_m if closed faces conduct");
  // Equal parts of the inlet's net pressure. At 0.01, 0.09, 0.4, 0.5, 3 and 30 the floor makes fractures that are fed
  // at a rate longer by 1, 4, 11 to 17, 30, 40 and 110 % (verification/analytic/kgd_leakoff.toml, variant none).
  note("floor_share", growths > 0 ? m.floor_share_sum / static_cast<double>(growths) : std::ranges::max(m.floor_share),
       where_grown(0.1),
       "fluid.minimum_opening_m decides about more than a tenth of the inlet's net pressure: lower it or use smaller "
       "cells until results no longer change");
  // At 0.15, 0.20, 0.31, 0.36, 0.41 and 0.45 length, opening and pressure of a fracture that is fed at a rate and grows
  // by K alone were off by 0.6, 1.4, 5, 8, 15 and 21 %, with leak-off at 0.29, 0.34 and 0.38 by 5, 8 and 12 %
  // (kgd_leakoff, toughness numbers 0.16 to 1.18, 11 to 47 cells).
  if (scene.fluid.law == Fluid::Law::reynolds)
    note("viscous_tip", m.viscous_at_growth, where_grown(0.3),
         "where K or energy decides alone (near an interface or a step of the stress, under a given pressure, at the "
         "first growth) the fluid's viscosity takes up more than three tenths of the inlet's net pressure, as K, "
         "within a cell of the tip: the time of growth and "
         "the pressure are off by 5 % and more; use smaller cells");
}

void Watch::fluid() {
  if (!state.has_fracture || scene.fluid.law == Fluid::Law::uniform) return;
  flow();
  if (scene.fluid.law == Fluid::Law::reynolds) {
    double imbalance = m.largest_imbalance;
    note_largest(imbalance, std::abs(m.volume_balance));
    note("fluid_imbalance", imbalance, 1e-8, "more than 1e-8 of the fluid is missing or was made");
  }
  // The study's law (3) has no dw/dt: the fracture takes what opening it needs whatever has come in, in every run.
  const double opened = fracture_volume(state);
  if (scene.fluid.law == Fluid::Law::paper && !(opened <= 0.0))
    note("fluid_imbalance", (opened - m.delivered_m2) / opened, std::nullopt, "");
}

// Of a tip that an edge or coarse cells hold while another may grow: K_I over what the rock asks for. What the other
// then does is not what it would do in rock.
void Watch::held_tips() {
  const bool others = std::ranges::any_of(state.tips, &Tip::growing);
  const Rocks rocks = make_elasticities(scene);
  double most = 0.0;  // of K_Ic
  std::string where;
  for (const Tip& tip : state.tips) {
    const Elasticity& rock = rocks[rock_at(scene, tip_position(state, tip))];
    const double share = tip.K_I / std::max(std::sqrt(rock.J_c * rock.E_prime), 1.0);
    // Where none may grow any more, only what came after its last growth is in doubt.
    const bool later = others || state.time > std::max(tip.last_growth_s, tip.runs_until_s);
    if (tip.stopped_by.empty() || !later || !(share > most)) continue;
    most = share, where = tip.stopped_by;
  }
  // Between events K may be above by their tolerance and by a step's rise; a tenth of K is a fifth of the energy.
  if (!where.empty())
    note("held_tip", most, 1.1,
         "a tip with more than its rock's toughness may not grow while the run goes on: " + where);
}

void Watch::growth() {
  held_tips();
  note("growth_unweighed", static_cast<double>(m.growth_unweighed), 0.0,
       "K decided about growth instead of energy, since surfaces had cut off parts that inertia alone holds");
  if (m.growths == 0) return;
  // A tenth of J is a twentieth of K, and of the pressure at which a tip grows.
  note("J_spread_mean", m.J_spread_sum / static_cast<double>(m.growths), 0.1,
       "J differed between its rings by more than a tenth at growth, on average away from interfaces");
  note("J_spread_largest", m.largest_J_spread, std::nullopt, "");
}

void Watch::surfaces() {
  // One column of nodes is no mean of the traction beside a tip: with one cell slip runs 19 m where it should run 23,
  // with two 22.
  double least = infinite;  // cells that failed interfaces were judged on, at the fracture and where they stop
  // What stops further away than two lengths of the fracture changes the stress there by a sixteenth at most.
  const double near = state.has_fracture ? 2.0 * state.fracture().length() : 0.0;
  const Vec2 inlet = state.has_fracture ? state.fracture().vertices[state.fluid.inlet].x : Vec2(0.0, 0.0);
  for (const Surface& surface : state.surfaces) {
    if (surface.kind != Surface::Kind::interface || !scene.laws[surface.law].has_strength()) continue;
    for (std::size_t k = 1; scene.fracture && k < surface.points.size(); ++k) {
      const SurfacePoint &one = surface.points[k - 1], &next = surface.points[k];
      if (one.split == next.split) continue;
      const double cell = (one.x - inlet).norm() > near ? state.grid.h : std::max({state.grid.h, one.A, next.A});
      least = std::min(least, failure_length(scene, scene.laws[surface.law]) / cell);
    }
  }
  if (least < infinite)
    note("failure_length_unresolved", 2.0 / least, 1.0,
         "an interface has failed in part whose failure_length_m is less than two cells there: where it stops is the "
         "cell's; use smaller cells, also far from the fracture, or let the interface end (from_m, to_m)");
  // At 0.485 of a cell, 1/2.06, the net pressure of a restart is 10 % low, at a quarter 50 % (atlas, cut_increments).
  const bool by_energy = std::ranges::any_of(state.events, [](const Event& e) { return e.by == "energy"; });
  if (scene.fracture && by_energy)
    note("crossing_increment_unresolved", state.grid.h / scene.fracture->crossing_increment(), 2.05,
         "energy decided about growth over less than half a cell: see fracture.crossing_increment_m");
  if (moves && state.ledger.fracture != 0.0)
    note("surface_energy_share", state.ledger.fracture / m.largest_kinetic_J, 0.1,
         "new surface took nothing of the motion's energy, but needs over a tenth: speeds of growth are no result");
}

// The equations are linear in the displacement. What they leave out of the strain is u_k,i u_k,j/2: half a per cent at
// gradients of 0.01. Points that move take up strain in their present places: Hooke's law of logarithmic strain, 5 %
// off at a tenth; their stress does not turn with them.
void Watch::deformation() {
  const bool keeps = scene.numerics.keeps_places();
  const std::string check = "; check rock.*.youngs_modulus_Pa and the pressures";
  note("largest_strain", m.largest_strain, keeps ? 0.01 : 0.1, "strains are not small, as the equations ask" + check);
  note("largest_rotation", m.largest_rotation, 0.01, "rotations are not small, as the equations ask" + check);
  // From half a cell on a node of one face is nearer to another node of the other face than to its own.
  if (keeps)
    note("jump_share", m.largest_jump / state.grid.h, 0.5,
         "faces open or slip by more than half a cell while they are solved as lying where they started" + check +
             ", and whether a failed interface without interface.*.residual_friction lets blocks part");
}

// Explicit runs take for granted that the load is slow. A ramp to p in the time T leaves oscillations of p/(omega T): a
// tenth of the largest net pressure is 4 to 6 % of K at most (omega = pi c_S/(2 L) to 41 rad/s L/80 m).
void Watch::loading() {
  if (!moves || !scene.fracture || m.largest_net_Pa <= 0.0) return;  // a fracture that stays closed loads nothing
  constexpr double threshold = 0.1, pi = std::numbers::pi;
  // Answer of the block (s): a wave's way through it, L/c_S, and with damping d the time d/omega^2 that its slowest
  // mode, omega about pi c_S/L, takes to follow.
  const double slowest = std::ranges::min(make_elasticities(scene), {}, &Elasticity::c_S).c_S;
  const double crossing = std::max(scene.domain.width_m, scene.domain.height_m) / slowest;
  const double d = scene.numerics.damping_1_s, answer = crossing * (1.0 + d * crossing / (pi * pi));
  note("loading_share", scene.fluid.fastest_change() * answer / m.largest_net_Pa, threshold,
       "the load is not slow: the pressure rises by more than a tenth of the largest net pressure while the block "
       "answers; lower fluid.inlet.rate_Pa_s, or check density_kg_m3 and damping_1_s");
  // A pressure above the closing stress at time 0 acts with up to twice its size. What counts is what damping has left
  // of its waves, exp(-d t/2) or, above the critical 2 omega, exp(-omega^2 t/d), at the first growth or the end.
  double until = state.time;
  for (const Event& event : state.events) {
    if (event.kind == "start") until = std::min(until, event.time_s);
  }
  const double left = d == 0.0 ? 1.0 : std::exp(-until * std::min(0.5 * d, 1.0 / answer));
  // A run that ends before waves have crossed the block and come back, and grows nothing, is about these waves.
  const bool of_waves = scene.fracture->growth == Fracture::Growth::none && state.time < 2.0 * answer;
  note("shock_share", m.net_at_start_Pa / m.largest_net_Pa * left, of_waves ? Limit() : threshold,
       "the pressure at time 0 exceeds the closing stress, and its waves have not been damped by the first growth or "
       "the end: start at the closing stress, or use damping_1_s");
}

void Watch::contact() {
  const double stiffest = std::ranges::max(make_elasticities(scene), {}, &Elasticity::E_prime).E_prime;
  // By the laws' contact stiffness faces overlap by 1e-4 of what a cell deforms under the same pressure.
  share("penetration_share", m.largest_penetration * stiffest / state.grid.h, m.largest_contact_Pa, nothing.stress,
        0.01, "closed faces overlapped by more than 1 % of what a cell deforms under the largest contact pressure");
  share("tension_share", m.largest_tension_Pa, m.largest_contact_Pa, nothing.stress, 1e-9,
        "faces that carry no tension by their law carried some");
  if (moves)
    note("contact_left", m.contact_left, 0.01,
         "a step's contact ran out of sweeps while a reaction changed by more than 1 % of the largest");
}

void Watch::rocks() {
  // Functions of low order lock where rock hardly changes its volume: a crack opens too little, by 2.9 % with hat
  // functions at nu = 0.45 (20 cells along it), by 1.8 % with B-splines at 0.495 (10 cells); as 1/(1 - 2 nu).
  double most = 0.0;
  for (const Rock& rock : scene.rocks) most = std::max(most, 1.0 / (1.0 - 2.0 * rock.poisson_ratio));
  note("incompressibility", most, splines ? 101.0 : 10.1,
       "rock is so nearly incompressible that functions of this order lock: it is too stiff");
  if (!splines) return;  // hat functions kink on grid lines
  // B-splines carry the kink of strain at a bonded border over three cells. What they miss is stress in the stiff rock:
  // 2 % of a layer's mean at a contrast of 10 (4 cells a layer), of the size of the stress itself at 100, where K_I of
  // a crack 8 cells away is 1.3 % off.
  double contrast = 1.0;
  for (std::size_t k = 0; k < scene.strata.interfaces.size(); ++k) {
    if (scene.has_law(scene.strata.interfaces[k])) continue;
    const double a = scene.rocks[scene.strata.layers[k].rock].youngs_modulus_Pa;
    const double b = scene.rocks[scene.strata.layers[k + 1].rock].youngs_modulus_Pa;
    contrast = std::max({contrast, a / b, b / a});
  }
  note(
      "stiffness_contrast", contrast, 30.0,
      "rocks bonded to each other differ too much in stiffness: stresses within three cells of their border are wrong");
}

}  // namespace

std::vector<Watched> watched(const Scene& scene, const State& state) {
  Watch watch{scene, state};
  const std::vector<std::string> odd = implausible(scene);
  watch.note("implausible_inputs", static_cast<double>(odd.size()), 0.0, fmt::format("{}", fmt::join(odd, "; ")));
  for (const auto part : {&Watch::energy, &Watch::motion, &Watch::fluid, &Watch::growth, &Watch::surfaces,
                          &Watch::deformation, &Watch::loading, &Watch::contact, &Watch::rocks})
    (watch.*part)();
  return watch.out;
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
