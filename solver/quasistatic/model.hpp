// The rock without inertia: equilibrium of the particles with the pressure in the fracture and the laws of all
// surfaces.
#pragma once

#include <Eigen/SparseCore>
#include <memory>
#include <vector>

#include "interfaces/failure.hpp"
#include "quasistatic/contact_equilibrium.hpp"
#include "state/shape_functions.hpp"

namespace strata {

// What solving a state needs beside it; all of it follows from the state.
struct QuasistaticModel {
  std::shared_ptr<const IntactBody> body;
  Condensed condensed;
  Places places;
  TangentFactor factor;
  Bonds bonds;
  std::vector<std::size_t> watched;  // bins whose fields decide what happens next: around tips and beside bonded
                                     // interfaces, all of them under a body force, whose work needs them
  Asked asked;                       // the records that these reach
  Eigen::SparseMatrix<double, Eigen::RowMajor> vertex_jumps;  // jumps at all vertices (x and y) by the jump unknowns
  Eigen::VectorXd j;                                          // the last solution, as a first guess
  Eigen::VectorXd shown;                                      // the solution whose fields the state was given
  Eigen::MatrixXd dw_dP;                                      // opening_per_pressure(), none where not known,
  Pieces dw_dP_of;                                            // and the pieces for which it holds
};

/// Rebuilds what follows from the state's particles and surfaces (copies, springs of tips, stencils) and brings the
/// model up to date with it; what `model` holds already is reused where it still applies. halve: solve on half of a
/// mirror-symmetric scene. Throws NumericalFailure as rebuild_copies() and IntactBody do.
void update_model(const Scene& scene, const Rocks& rocks, State& state, QuasistaticModel& model, bool halve = true);

/// The same without what set_fields() needs, for a model that equilibria are only asked for.
void update_equations(const Scene& scene, const Rocks& rocks, State& state, QuasistaticModel& model, bool halve = true);

/// Takes back what a model has of former solutions: first guess and factor; friction's memory is that of the state.
void forget_solution(const Scene& scene, const Rocks& rocks, const State& state, QuasistaticModel& model);

/// Equilibrium under the pressures that the state's points hold and the body force at a time (s); see
/// solve_equilibrium(), and what it throws. Sets state.body. Throws NumericalFailure, too, where a formula is not
/// finite, or where the force has a resultant along a motion of the whole block that no edge holds.
Equilibrium find_equilibrium(const Scene& scene, double time, State& state, QuasistaticModel& model);

/// Writes an equilibrium to the state: jumps (m) and reactions (Pa) to the surfaces, displacements and their gradients
/// to the particles that decide what happens next. Friction's memory stays what it was.
void set_fields(const Scene& scene, State& state, QuasistaticModel& model, const Equilibrium& equilibrium);

/// Displacements and their gradients to all particles, for whoever looks at them.
void set_all_particles(const Scene& scene, State& state, const QuasistaticModel& model);

/// Makes the equilibrium that the state holds the one that laws remember.
void remember(State& state, QuasistaticModel& model, const Equilibrium& equilibrium);

/// Energy stored in the laws of surfaces and the springs of tips, that of faces that stick included (J/m).
double stored_in_surfaces(const QuasistaticModel& model, const Equilibrium& equilibrium);

/// What friction has dissipated since the equilibrium that it remembers (J/m): by what it holds now, as where all
/// happens at one load; with_load: as the load went from there to here, also on faces that have parted since. It is
/// then the mean of what it held there and holds here, as the works of loads are, of all places together: what one lets
/// go another takes up. That is kept between the least and the largest that the bounds at both ends allow, so that
/// faces that stuck idle and begin to slide count with their bound.
double dissipated_by_friction(const QuasistaticModel& model, const Equilibrium& equilibrium, bool with_load = false);

}  // namespace strata
