// A scene: what a run is asked to compute, as plain data that nothing changes once it is read.
// Units are SI and stand in the names; in-situ stress and fluid pressure are positive in compression.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strata {

using Point = std::array<double, 2>;  // a place's x and y (m), or a row of a table
using Path = std::vector<Point>;

constexpr double standard_gravity = 9.80665;  // m/s^2

// An enumeration of a structure, whose values have their names in a scene. Where they cannot, words() gives the words
// of the scene in their order.
#define STRATA_ENUM(Enum, ...)                    \
  enum class Enum { __VA_ARGS__ };                \
  friend constexpr std::string_view words(Enum) { \
    return #__VA_ARGS__;                          \
  }

enum class Edge { symmetry, fixed, traction };
constexpr std::string_view words(Edge) {
  return "symmetry, fixed, traction";
}

// A vector's x and y component as formulas (see formula.hpp) of X and Y (m), the place where a particle starts, and
// where the key says so of the time t (s).
using Formulas = std::array<std::string, 2>;

// A quantity that may change with place: a number, or a formula (see formula.hpp) of X and Y (m).
struct Field {
  double number = 0.0;
  std::string formula{};  // empty: the number everywhere

  Field(double number_everywhere = 0.0) : number(number_everywhere) {}
  explicit Field(std::string of_place) : formula(std::move(of_place)) {}
  bool operator==(const Field&) const = default;
};

// A stretch along an axis (m).
struct Stretch {
  double from = 0.0, to = 0.0;
};

struct Domain {
  double width_m = 0.0;
  double height_m = 0.0;
  Edge bottom = Edge::symmetry;
  Edge sides = Edge::fixed;
  Edge top = Edge::traction;
  double beyond_m = 0.0;  // how far the rock goes on beyond the block's edges, but not below a symmetry line

  // From edge to edge of the rock, with what goes on beyond the block.
  Stretch along_x() const { return {-beyond_m, width_m + beyond_m}; }
  Stretch along_y() const { return {bottom == Edge::symmetry ? 0.0 : -beyond_m, height_m + beyond_m}; }
  double extent_m(std::size_t axis) const { return axis == 0 ? width_m : height_m; }  // of the block along x (0), y (1)

  // Whether an edge holds the block's motion along x or y; what none holds is free as a whole.
  bool holds_x() const { return sides == Edge::fixed; }
  bool holds_y() const { return bottom == Edge::symmetry || top == Edge::fixed; }
  bool operator==(const Domain&) const = default;
};

struct InSitu {
  STRATA_ENUM(Initialise, uniform, loaded);
  Field vertical_Pa;  // see in_situ.hpp
  Field horizontal_Pa;
  Initialise initialise = Initialise::uniform;
  double shear_Pa = 0.0;
  bool weight = false;  // of the rock
  bool operator==(const InSitu&) const = default;
};

// What acts on the whole block beyond the in-situ state.
struct Body {
  std::optional<Formulas> acceleration_m_s2;  // body force per mass, of X, Y, t; absent: none
  bool operator==(const Body&) const = default;
};

// How the block moves at time 0.
struct Initial {
  std::optional<Formulas> velocity_m_s;  // of X, Y; absent: at rest
  bool operator==(const Initial&) const = default;
};

struct Rock {
  std::string name;
  double youngs_modulus_Pa = 0.0;
  double poisson_ratio = 0.2;
  double density_kg_m3 = 2500.0;
  double toughness_Pa_sqrt_m = 1.45e6;
  double leakoff_m_sqrt_s = 0.0;  // Carter's C_L of each face
  bool operator==(const Rock&) const = default;
};

// The law of an interface between two layers. Members of other laws keep their defaults and are not used.
struct InterfaceLaw {
  STRATA_ENUM(Kind, perfect, friction, weak, soft);
  STRATA_ENUM(Compression, contact, spring);
  std::string name = "perfect";
  Kind kind = Kind::perfect;
  double coefficient = 0.6;                  // friction
  double shear_strength_Pa = 0.5e6;          // weak
  double tensile_strength_Pa = 0.5e6;        // weak
  double residual_friction = 0.0;            // weak, after failure
  std::optional<double> failure_length_m{};  // weak, friction; absent: the increment of growth
  double normal_stiffness_Pa_m = 0.5e6;      // soft
  double shear_stiffness_Pa_m = 0.5e6;       // soft
  Compression compression = Compression::contact;
  std::optional<double> toughness_Pa_sqrt_m{};  // weak; present: it parts by energy, and has no strengths

  // What a place under it remembers beside its last jump and reaction; of numbers alone, as it is saved byte by byte.
  struct Memory {
    double slip = 0.0;  // sliding distance, summed (m)
  };

  // Whether its faces are apart from the start: nothing bonds springs, nor faces without friction.
  bool apart_at_start() const { return kind == Kind::soft || (kind == Kind::friction && coefficient == 0.0); }

  // Whether its springs go on carrying the in-situ stress, so that their reaction is the change from it.
  bool takes_all_compression() const { return kind == Kind::soft && compression == Compression::spring; }

  // Whether strengths bond it, or a toughness; friction alone does, which gives nothing up where it lets go.
  bool has_strength() const { return kind == Kind::weak && !toughness_Pa_sqrt_m; }
  bool has_toughness() const { return kind == Kind::weak && toughness_Pa_sqrt_m; }
  bool only_sticks() const { return kind == Kind::friction; }

  // Whether its faces pull each other where they are apart; whether they hold in shear until they slide, not by
  // springs.
  bool pulls() const { return kind == Kind::soft; }
  bool slides() const { return kind != Kind::soft; }

  // Coefficient of friction between split faces, that of sliding where strength has failed.
  double friction() const { return only_sticks() ? coefficient : kind == Kind::weak ? residual_friction : 0.0; }
  bool operator==(const InterfaceLaw&) const = default;
};

// A layer from `from_m` to `to_m` along the stacking axis.
struct Layer {
  std::size_t rock = 0;  // index into Scene::rocks
  double from_m = 0.0;
  double to_m = 0.0;
  std::optional<Field> horizontal_Pa{}, vertical_Pa{};  // absent: the scene's

  bool has_stress_of(const Layer& other) const {
    return horizontal_Pa == other.horizontal_Pa && vertical_Pa == other.vertical_Pa;
  }
  bool operator==(const Layer&) const = default;
};

// The interface between layer k and layer k + 1.
struct InterfacePlace {
  std::size_t law = 0;                     // index into Scene::laws
  double at_m = 0.0;                       // position along the stacking axis
  std::optional<double> from_m{}, to_m{};  // where the law holds along it; absent: from, to the block's edge

  bool holds_at(double along) const { return along >= from_m.value_or(along) && along <= to_m.value_or(along); }
  bool operator==(const InterfacePlace&) const = default;
};

struct Strata {
  STRATA_ENUM(Along, x, y);
  Along along = Along::y;
  std::vector<Layer> layers;
  std::vector<InterfacePlace> interfaces;  // layers.size() - 1 of them

  bool upwards() const { return along == Along::y; }  // interfaces run along x
  bool operator==(const Strata&) const = default;
};

struct Fracture {
  STRATA_ENUM(Growth, none, J, energy);
  STRATA_ENUM(Direction, straight, max_hoop);
  STRATA_ENUM(Crossing, J, energy);
  STRATA_ENUM(Order, interfaces, larger_margin);
  STRATA_ENUM(Faces, contact, free);
  Path path_m;  // an end on the symmetry line comes first
  Growth growth = Growth::J;
  double increment_m = 1.0;
  double turn_share = 0.5;  // largest share of the maximum-hoop kink that an increment turns by
  Direction direction = Direction::straight;
  Crossing crossing = Crossing::energy;
  std::optional<double> crossing_increment_m;  // absent: increment_m
  Order order = Order::interfaces;
  Faces faces = Faces::contact;
  double friction = 0.0;  // of faces that meet

  double crossing_increment() const { return crossing_increment_m.value_or(increment_m); }
  bool operator==(const Fracture&) const = default;
};

struct Fluid {
  STRATA_ENUM(Law, uniform, paper, reynolds);
  STRATA_ENUM(NewPoint, dry, inherit);
  enum class TimeRule { trapezoid, backward_euler, explicit_euler };
  friend constexpr std::string_view words(TimeRule) { return "trapezoid, backward-euler, explicit"; }
  Law law = Law::paper;
  double bulk_modulus_Pa = 1.0e9;
  double viscosity_Pa_s = 0.1;
  double minimum_opening_m = 1.0e-4;
  double start_Pa = 0.0;            // inlet pressure at time 0
  double rate_Pa_s = 0.0;           // and its rise
  std::optional<double> rate_m2_s;  // instead of a pressure: what the whole fracture is fed
  // Or either of them by rows of time (s) and value, linear between, the last one held; start_Pa or rate_m2_s is then
  // the first one. Empty: none.
  STRATA_ENUM(TableOf, rate_m2_s, pressure_Pa);
  Path table;
  TableOf table_of = TableOf::rate_m2_s;
  double cavitation_Pa = 0.0;  // absolute lower bound of the fluid pressure
  double density_kg_m3 = 0.0;  // 0: without weight
  NewPoint new_point = NewPoint::dry;
  TimeRule time_rule = TimeRule::trapezoid;

  // The pressure (Pa) of fluid at rest so far (m) above a place where it is P; none falls below cavitation by its
  // weight.
  double weight() const { return density_kg_m3 * standard_gravity; }  // N/m^3
  double at_rest(double P, double above) const { return std::max(P - weight() * above, std::min(P, cavitation_Pa)); }

  // What the inlet prescribes at a time (s): a pressure (Pa), or what the whole fracture is fed (m^2/s) of a fluid fed
  // at a rate. The fastest change of the pressure (Pa/s), at least 0. The time of the table's next row, between which
  // all is linear; infinite after the last and without a table.
  double inlet_pressure(double time) const;
  double inlet_rate(double time) const;
  double fastest_change() const;
  double next_row(double time) const;
  bool operator==(const Fluid&) const = default;
};

struct Numerics {
  enum class Mechanics { explicit_dynamics, quasistatic };
  friend constexpr std::string_view words(Mechanics) { return "explicit, quasistatic"; }
  STRATA_ENUM(Shape, bspline2, linear, gimp);
  STRATA_ENUM(Transfer, flip, pic, xpic2);
  STRATA_ENUM(Kinematics, updated, total);
  STRATA_ENUM(Kernels, fast, plain);
  Mechanics mechanics = Mechanics::explicit_dynamics;
  Kinematics kinematics = Kinematics::updated;
  Kernels kernels = Kernels::fast;
  double cell_m = 0.0;
  std::optional<double> far_cell_m;  // absent: the grid is uniform
  // Where the fine cells around the fracture end (m); absent: 10 cells from it and its straight way.
  std::optional<double> fine_left_m, fine_right_m, fine_bottom_m, fine_top_m;
  int particles_per_cell = 4;  // 4, 9 or 16
  Shape shape = Shape::bspline2;
  Transfer transfer = Transfer::flip;
  double courant = 0.5;  // c_P dt / h
  double damping_1_s = 0.0;
  int tip_steps = 4;         // explicit: steps from one look at the tips to the next
  double ring_cells = 4.0;   // outer radius of the widest ring around a tip, in cells
  double flow_change = 0.3;  // of the nearest event's margin in a step of the flow
  double flow_error = 1e-3;  // of the largest opening (reynolds) or net pressure (paper) in a step of the flow

  // Whether particles and surfaces stay in their reference places while displacements advance.
  bool keeps_places() const { return mechanics == Mechanics::quasistatic || kinematics == Kinematics::total; }

  // Whether neighbouring bins of particles are lanes of vectors (see state/copies.hpp).
  bool in_lanes() const { return !keeps_places() && kernels == Kernels::fast; }
  bool operator==(const Numerics&) const = default;
};

// The first bound reached ends the run; one that is absent does not stop it.
struct Stop {
  std::optional<double> tip_y_m, lower_tip_y_m;
  std::optional<double> inlet_Pa;
  std::optional<double> time_s;
  bool operator==(const Stop&) const = default;
};

struct Output {
  std::optional<double> fields_every_s;  // absent: 1/50 of the run, or see run.cpp where its length is not known
  bool operator==(const Output&) const = default;
};

struct Scene {
  std::string title;
  std::string name;     // of the file it was first read from, without folder and .toml
  std::string variant;  // empty: none chosen
  Domain domain;
  InSitu in_situ;
  Body body;
  Initial initial;
  std::vector<Rock> rocks;
  std::vector<InterfaceLaw> laws;  // laws[0] is always "perfect"
  Strata strata;
  std::optional<Fracture> fracture;
  Fluid fluid;  // used where there is a fracture
  Numerics numerics;
  Stop stop;
  Output output;
  std::string resolved_toml;  // the scene as text, every key with its value, variant and --set applied

  // Whether rocks of unlike elastic constants meet at an interface.
  bool stiffness_changes_at(std::size_t interface) const {
    const Rock &before = rocks[strata.layers[interface].rock], &beyond = rocks[strata.layers[interface + 1].rock];
    return before.youngs_modulus_Pa != beyond.youngs_modulus_Pa || before.poisson_ratio != beyond.poisson_ratio;
  }

  bool has_law(const InterfacePlace& place) const { return laws[place.law].kind != InterfaceLaw::Kind::perfect; }

  // Whether an interface is more than a border of toughness or in-situ stress: a law, or another stiffness beyond it.
  bool changes_at(std::size_t interface) const {
    return has_law(strata.interfaces[interface]) || stiffness_changes_at(interface);
  }

  // The same at a place along it (m).
  bool changes_at(std::size_t interface, double along) const {
    return stiffness_changes_at(interface) || (changes_at(interface) && strata.interfaces[interface].holds_at(along));
  }

  // Whether any rock takes up fluid.
  bool leaks() const {
    return std::ranges::any_of(rocks, [](const Rock& rock) { return rock.leakoff_m_sqrt_s > 0.0; });
  }

  // Whether any interface parts by energy.
  bool parts_by_energy() const { return std::ranges::any_of(laws, &InterfaceLaw::has_toughness); }

  // From edge to edge of the rock along interfaces, and where the law of one holds (m).
  Stretch along_interfaces() const { return strata.upwards() ? domain.along_x() : domain.along_y(); }
  Stretch held_by(const InterfacePlace& place) const {
    const Stretch rock = along_interfaces();
    return {place.from_m.value_or(rock.from), place.to_m.value_or(rock.to)};
  }

  // Coordinates of a place (m): along interfaces, and that along which layers are stacked.
  double beside(const auto& x) const { return strata.upwards() ? x[0] : x[1]; }
  double stacking(const auto& x) const { return strata.upwards() ? x[1] : x[0]; }
  bool operator==(const Scene&) const = default;
};

#undef STRATA_ENUM

}  // namespace strata
