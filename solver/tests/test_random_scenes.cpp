// Random small scenes end in equilibria that satisfy every law, or in a reported mechanism.
#include <fmt/format.h>

#include <catch2/catch.hpp>

#include <iostream>
#include <map>

#include "interfaces/monitors.hpp"
#include "output/suspect.hpp"
#include "quasistatic/load_steps.hpp"
#include "random_scene.hpp"
#include "statics.hpp"

using namespace strata;
using namespace strata::test;

namespace {

using Piece = LawAnswer::Piece;

double friction_coefficient(const InterfaceLaw& law) {
  if (law.kind == InterfaceLaw::Kind::weak) return law.residual_friction;
  return law.kind == InterfaceLaw::Kind::friction ? law.coefficient : 0.0;
}

// What violates a law most, as a traction (Pa), and where.
struct Worst {
  double by = 0.0;
  std::string what;
  void see(double violation, const char* name) {
    if (!(violation <= by)) by = std::isfinite(violation) ? violation : HUGE_VAL, what = name;
  }
};

// The laws as inequalities, written without the solver's pieces.
void check_place(const State& state, const ContactPlace& place, const LawAnswer& r, const Vec2& w, Worst& worst) {
  const Vec2 t{place.n.y(), -place.n.x()};
  const double P = place.tie >= 0 ? 0.0 : state.surfaces[place.surface].points[place.point].P;
  const double w_n = w.dot(place.n), w_t = w.dot(t), closed = place.in_situ.dot(place.n) - P - place.k * w_n;
  if (place.law.kind == InterfaceLaw::Kind::soft) {
    const double spring = -place.law.normal_stiffness_Pa_m * w_n;
    const bool contact = place.law.compression == InterfaceLaw::Compression::contact;
    worst.see(std::abs(r.n - (contact ? std::max(spring, closed) : spring)), "normal law of a soft place");
    worst.see(std::abs(r.t + place.law.shear_stiffness_Pa_m * w_t), "tangential law of a soft place");
    return;
  }
  worst.see(-r.n, "contact in tension");
  worst.see(closed - r.n, "faces overlap");
  worst.see(std::min(r.n, r.n - closed), "contact without touching");
  const double bound = friction_coefficient(place.law) * r.n, slack = bound - std::abs(r.t);
  worst.see(-slack, "friction beyond its bound");
  const double slip = w_t - place.start.w_t + (r.t - place.start.r_t) / place.k;  // m
  if (r.n <= 0.0) return;
  worst.see(std::min(slack, place.k * std::abs(slip)), "slip below friction's bound");
  if (bound > 0.0)
    worst.see(std::min(std::abs(r.t), place.k * std::max(0.0, slip * std::copysign(1.0, r.t))), "slip with friction");
}

// Forces of the rock on nodes (N/m), with the opposite sign, from the particles' stress.
std::vector<Vec2> rock_forces(const Run& run) {
  const State& state = run.state;
  const Particles& p = state.particles;
  std::vector<Vec2> forces(static_cast<std::size_t>(state.copies.records()), Vec2::Zero());
  for (const Bin& bin : state.bins) {
    for (auto q = static_cast<std::size_t>(bin.first); q < static_cast<std::size_t>(bin.last);
         q += static_cast<std::size_t>(bin.stride)) {
      const Elasticity& rock = run.rocks[p.rock[q]];
      const Stress s = stress_of(rock, p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]);
      const Gradients g = gradients_at(run.scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
      for (std::size_t n = 0; n < 9; ++n)
        forces[static_cast<std::size_t>(bin.record[n])] += p.V[q] * s.on({g.N_x[n], g.N_y[n]});
    }
  }
  return forces;
}

// Largest force out of balance (N/m) at any node, from the particles' stress and the tractions of all places, and the
// largest of the loads that meet there: what the solver's condensed operator has no part in.
std::array<double, 2> balance(const Run& run, const QuasistaticModel& model, const Equilibrium& at) {
  const State& state = run.state;
  const std::vector<Vec2> inner = rock_forces(run);
  std::vector<Vec2> load(state.masters.size(), Vec2::Zero());
  double largest = 0.0;
  for (std::size_t k = 0; k < model.places.size(); ++k) {
    const ContactPlace& place = model.places[k];
    const Vec2 t{place.n.y(), -place.n.x()};
    const double P = place.tie >= 0 ? 0.0 : state.surfaces[place.surface].points[place.point].P;
    const Vec2 force = place.A * ((P + at.answers[k].n) * place.n + at.answers[k].t * t - place.in_situ);
    largest = std::max({largest, place.A * (P * place.n - place.in_situ).norm(), force.norm()});
    if (place.tie >= 0) {
      const TipTie& tie = state.ties[static_cast<std::size_t>(place.tie)];
      load[static_cast<std::size_t>(tie.plus)] += force;
      load[static_cast<std::size_t>(tie.minus)] -= force;
      continue;
    }
    const SurfaceStencil& stencil = state.point_stencils[place.surface][place.point];
    for (std::size_t n = 0; n < 9; ++n) {
      load[static_cast<std::size_t>(stencil.plus[n])] += stencil.N[n] * force;
      load[static_cast<std::size_t>(stencil.minus[n])] -= stencil.N[n] * force;
    }
  }
  std::vector<Vec2> off(load);
  std::fill(off.begin(), off.end(), Vec2::Zero());
  for (std::size_t r = 0; r < off.size(); ++r) {
    const Master& master = state.masters[r];
    const Vec2 f = inner[r] - load[r];
    off[static_cast<std::size_t>(master.record)] += Vec2{master.x * f.x(), master.y * f.y()};
  }
  double most = 0.0;
  for (const Vec2& f : off) most = std::max(most, f.norm());
  return {most, largest};
}

// What the digits of displacements leave of the forces of neighbours that all but cancel (N/m), by the solver's own
// measure of round-off (in_balance): springs as soft as 1e3 Pa/m let blocks go hundreds of metres.
double left_by_digits(const Run& run) {
  constexpr double round_off = 64.0 * std::numeric_limits<double>::epsilon();
  double stiffest = 0.0, farthest = 0.0;
  for (const Rock& rock : run.scene.rocks) stiffest = std::max(stiffest, rock.youngs_modulus_Pa);
  const Particles& p = run.state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) farthest = std::max(farthest, std::hypot(p.u_x[q], p.u_y[q]));
  return round_off * stiffest * farthest;
}

// An equilibrium against laws and balance, all to 1e-8 of the load; "" where it holds.
std::string check(const Run& run, const QuasistaticModel& model, const Equilibrium& at) {
  Worst worst;
  double load = 1.0;
  for (std::size_t k = 0; k < model.places.size(); ++k) {
    const ContactPlace& place = model.places[k];
    if (place.tie < 0)
      load = std::max({load, place.in_situ.norm(), std::abs(run.state.surfaces[place.surface].points[place.point].P)});
  }
  for (std::size_t k = 0; k < model.places.size(); ++k)
    check_place(run.state, model.places[k], at.answers[k], at.w[k], worst);
  const auto [off, largest] = balance(run, model, at);
  if (!(off <= 1e-8 * std::max(largest, 1.0) + left_by_digits(run)))
    return "out of balance by 1e" + std::to_string(std::log10(off / std::max(largest, 1.0))) + " of the load";
  return worst.by <= 1e-8 * load ? "" : worst.what + " by " + std::to_string(worst.by) + " Pa";
}

// Equilibria under three loads in turn, friction remembering, some columns of interfaces having failed.
std::string load_three_times(const Scene& scene, unsigned seed) {
  Dice dice(seed + 1000000U);
  const double share = dice.chance(0.5) ? 1.0 : dice.uniform(0.2, 0.9);
  const bool symmetric = share == 1.0;  // columns that fail at random have no mirror images
  Statics s(scene, symmetric);
  for (Surface& surface : s.state().surfaces) {
    std::vector<char> fails(64);
    for (char& column : fails) column = dice.chance(share) ? 1 : 0;
    for (SurfacePoint& point : surface.points)
      point.split = point.split || fails[static_cast<std::size_t>(point.column)] != 0;
  }
  s.update(symmetric);
  for (int round = 0; round < 3; ++round) {
    press(s.state(), Surface::Kind::fracture, dice.uniform(0.0, 8e6));
    s.solve();
    const std::string wrong = check(s.run, s.model, s.at);
    if (!wrong.empty()) return "load " + std::to_string(round) + ": " + wrong;
    remember(s.state(), s.model, s.at);
  }
  return "";
}

// A run of a second from event to event.
std::string run_a_second(const Scene& scene) {
  constexpr int most_steps = 600;  // columns that fail one by one, and tips that grow
  Run run(scene);
  Quasistatic statics;
  start_quasistatic(run.scene, run.rocks, run.state, statics);
  for (int step = 0; step < most_steps; ++step) {
    set_all_particles(run.scene, run.state, statics.model);
    const std::string wrong = check(run, statics.model, statics.equilibrium);
    if (!wrong.empty()) return "step " + std::to_string(step) + ": " + wrong;
    if (run.state.time >= 1.0 - 1e-9) return "";
    advance_quasistatic(run.scene, run.rocks, 1.0, run.state, statics);
  }
  return "does not come to its end in " + std::to_string(most_steps) + " steps, at " + std::to_string(run.state.time) +
         " s";
}

// Runs the scenes of some seeds; prints what is wrong with which.
void run_seeds(unsigned first, unsigned last) {
  std::map<std::string, int> tally;
  std::string wrong;
  for (unsigned seed = first; seed < last; ++seed) {
    const Scene scene = random_scene(seed);
    for (const bool whole_run : {false, true}) {
      std::string outcome;
      try {
        outcome = whole_run ? run_a_second(scene) : load_three_times(scene, seed);
      } catch (const NumericalFailure& failure) {
        outcome = std::string(failure.what()).find("mechanism") != std::string::npos ? "mechanism" : failure.what();
      }
      ++tally[outcome.empty() ? "solved" : (outcome == "mechanism" ? outcome : "wrong")];
      if (!outcome.empty() && outcome != "mechanism")
        wrong += "seed " + std::to_string(seed) + (whole_run ? " run: " : " loads: ") + outcome + "\n";
    }
  }
  for (const auto& [outcome, count] : tally) std::cout << outcome << ": " << count << '\n';
  INFO(wrong);
  CHECK(wrong.empty());
  CHECK(tally["solved"] > 3 * tally["mechanism"]);
  CHECK(tally["mechanism"] > 0);
}

// The scene with inertia, in rock that goes on beyond the block in growing cells, its points moving by any shape and
// transfer.
Scene moving_in_graded_rock(unsigned seed) {
  Scene scene = random_scene(seed);
  Dice dice(seed + 2000000U);
  scene.numerics.mechanics = Numerics::Mechanics::explicit_dynamics;
  scene.numerics.shape = shapes[static_cast<std::size_t>(dice.below(3))];
  scene.numerics.transfer = transfers[static_cast<std::size_t>(dice.below(3))];
  scene.numerics.particles_per_cell = dice.chance(0.5) ? 4 : 16;
  scene.numerics.damping_1_s = dice.chance(0.5) ? 0.0 : 30.0;
  scene.numerics.courant = 0.4;  // uGIMP beside a free edge stands 0.476 with 16 points
  scene.domain.beyond_m = dice.uniform(3.0, 60.0);
  if (scene.fracture) {
    scene.fracture->crossing = Fracture::Crossing::J;
    if (scene.fracture->growth == Fracture::Growth::energy) scene.fracture->growth = Fracture::Growth::J;
  }
  return scene;
}

// The monitors of balance and contact after 200 steps.
std::map<std::string, double> move_a_while(const Scene& scene) {
  Run run(scene);
  watch_row(run.scene, run.state);
  for (int k = 0; k < 10; ++k) {
    run.advance(20);
    run.state.ledger.strain = strain_energy(run.rocks, run.state.particles);
    watch_row(run.scene, run.state);
  }
  std::map<std::string, double> found;
  for (const Watched& w : watched(run.scene, run.state)) found[w.monitor] = w.value;
  return found;
}

// What grading adds: "" where monitors are as on a uniform grid of the block alone.
std::string compare_grids(const Scene& graded) {
  Scene uniform = graded;
  uniform.domain.beyond_m = 0.0;
  auto on = move_a_while(graded), off = move_a_while(uniform);
  std::string wrong;
  const auto require_below = [&](const char* monitor, double most) {
    if (!(on[monitor] <= most)) wrong += fmt::format("{} {:.3g} (uniform {:.3g}) ", monitor, on[monitor], off[monitor]);
  };
  require_below("energy_closure", 1e-3);
  require_below("energy_made", 0.01 + 2.0 * off["energy_made"]);  // springs that take up a load at once make some
  require_below("momentum", 1e-6);
  require_below("penetration_share", 0.01);
  require_below("tension_share", 1e-9);
  return wrong;
}

}  // namespace

// Requires of random scenes whose points move through graded cells that the ledger closes, momentum stays, and faces
// neither overlap nor hold together, and that steps and transfers make no more energy than on a uniform grid.
TEST_CASE("random scenes with inertia on graded grids keep their balances") {
  std::string wrong;
  constexpr unsigned scenes = 50;
  for (unsigned seed = 0; seed < scenes; ++seed) {
    const Scene scene = moving_in_graded_rock(seed);
    std::string outcome;
    try {
      outcome = compare_grids(scene);
    } catch (const NumericalFailure& failure) {
      outcome = failure.what();
    }
    if (!outcome.empty()) wrong += fmt::format("seed {}: {}\n", seed, outcome);
  }
  INFO(wrong);
  CHECK(wrong.empty());
}

// Requires that every random scene ends in equilibria that are in balance (from the particles' stress) and satisfy
// every law and inequality to 1e-8 of the load, or in a reported mechanism, in a bounded number of steps.
// Mutations that fail: friction's given bound left out on open faces, or its bound 10 % less; its memory left out; no
// line search; the force of tips' springs left out; no check of the smallest eigenvalue (0); corrections that do not
// bring digits back but stay (805, in the thousand). On the way here 10 % of the scenes ended in "no equilibrium".
TEST_CASE("random scenes end in a right state or a mechanism") {
  run_seeds(0, 155);
}

// The same for 1000; hidden since it takes a minute: strata_tests "[thousand]".
TEST_CASE("a thousand random scenes", "[.thousand]") {
  run_seeds(0, 1000);
}
