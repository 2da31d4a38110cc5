// The declarations themselves, a function for each table of a scene.
#include <limits>
#include <type_traits>
#include <utility>

#include "scene/keys.hpp"

namespace strata {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Bounds positive{0.0, infinity, true, true};
constexpr Bounds not_negative{0.0, infinity, false, true};
constexpr Bounds finite{-infinity, infinity, true, true};

Key number(std::string path, std::string unit, Bounds bounds, Place place, std::string help, std::string advice = "") {
  Key key;
  key.path = std::move(path);
  key.type = KeyType::number;
  key.unit = std::move(unit);
  key.bounds = bounds;
  key.place = place;
  key.help = std::move(help);
  key.advice = std::move(advice);
  return key;
}

Key other(std::string path, KeyType type, Place place, std::string help) {
  Key key;
  key.path = std::move(path);
  key.type = type;
  key.place = place;
  key.help = std::move(help);
  return key;
}

// `member` is a captureless function from a scene and an index to a member of an enumerated type.
template <class Member>
Key word(std::string path, std::vector<Word> words, Member, std::string help) {
  Key key = other(std::move(path), KeyType::word, {}, std::move(help));
  key.words = std::move(words);
  key.place = WordPlace{[](Scene& s, std::size_t i) { return static_cast<int>(Member{}(s, i)); },
                        [](Scene& s, std::size_t i, int value) {
                          auto& member = Member{}(s, i);
                          member = static_cast<std::remove_reference_t<decltype(member)>>(value);
                        }};
  return key;
}

template <class Enumerator>
Word as(std::string text, Enumerator value) {
  return {std::move(text), static_cast<int>(value)};
}

// Formulas of a vector's two components. `variables`: what they may use.
Key formulas(std::string path, std::string unit, std::vector<std::string> variables, FormulasPlace place,
             std::string help) {
  Key key = other(std::move(path), KeyType::formulas, place, std::move(help));
  key.unit = std::move(unit);
  key.variables = std::move(variables);
  return key;
}

Key points(std::string path, std::string unit, std::string help) {
  Key key = other(std::move(path), KeyType::points, {}, std::move(help));
  key.unit = std::move(unit);
  return key;
}

Key required(Key key) {
  key.required = true;
  return key;
}

Key of_law(std::string law, Key key) {
  key.law = std::move(law);
  return key;
}

std::vector<Key> heading_keys() {
  return {
      other(
          "title", KeyType::text, +[](Scene& s, std::size_t) -> std::string& { return s.title; },
          "What the scene shows, in a line."),
      other(
          "resolved_from.scene", KeyType::text, +[](Scene& s, std::size_t) -> std::string& { return s.name; },
          "Name of the file that a resolved scene was made from; written by a run."),
      other(
          "resolved_from.variant", KeyType::text, +[](Scene& s, std::size_t) -> std::string& { return s.variant; },
          "Variant that was chosen then; written by a run."),
  };
}

std::vector<Key> domain_keys() {
  return {
      required(number(
          "domain.width_m", "m", positive, +[](Scene& s, std::size_t) -> double& { return s.domain.width_m; },
          "Width of the block; the origin is its lower left corner.")),
      required(number(
          "domain.height_m", "m", positive, +[](Scene& s, std::size_t) -> double& { return s.domain.height_m; },
          "Height of the block.", "y is counted upwards from the block's lower edge.")),
      number(
          "domain.beyond_m", "m", not_negative, +[](Scene& s, std::size_t) -> double& { return s.domain.beyond_m; },
          "How far the rock goes on beyond the block's edges, but not below a symmetry line, in cells that grow by at "
          "most 1.5 each; what is said of the edges holds where the rock ends. 20 times the block stands for a rock "
          "without end."),
      word(
          "domain.bottom", {as("symmetry", Edge::symmetry), as("traction", Edge::traction)},
          [](Scene& s, std::size_t) -> Edge& { return s.domain.bottom; },
          "Lower edge: mirror line, or loaded by the in-situ traction."),
      word(
          "domain.sides", {as("fixed", Edge::fixed), as("traction", Edge::traction)},
          [](Scene& s, std::size_t) -> Edge& { return s.domain.sides; },
          "Both sides: no further normal displacement once the in-situ state is on, or the in-situ traction."),
      word(
          "domain.top", {as("traction", Edge::traction), as("fixed", Edge::fixed)},
          [](Scene& s, std::size_t) -> Edge& { return s.domain.top; }, "Upper edge, as for the sides."),
      number(
          "in_situ.vertical_Pa", "Pa", finite, +[](Scene& s, std::size_t) -> double& { return s.in_situ.vertical_Pa; },
          "Vertical stress before the fracture is loaded, positive in compression."),
      number(
          "in_situ.horizontal_Pa", "Pa", finite,
          +[](Scene& s, std::size_t) -> double& { return s.in_situ.horizontal_Pa; },
          "Horizontal stress, positive in compression."),
      word(
          "in_situ.initialise", {as("uniform", InSitu::Initialise::uniform), as("loaded", InSitu::Initialise::loaded)},
          [](Scene& s, std::size_t) -> InSitu::Initialise& { return s.in_situ.initialise; },
          "The two stresses everywhere, or the static state of the bonded stack under them as edge tractions."),
  };
}

std::vector<Key> load_keys() {
  return {
      formulas(
          "body.acceleration_m_s2", "m/s^2", {"X", "Y", "t"},
          +[](Scene& s, std::size_t) -> std::optional<Formulas>& { return s.body.acceleration_m_s2; },
          "Body force per mass beyond what the in-situ state balances, [\"x component\", \"y component\"]: formulas of "
          "the place X, Y (m) where a particle starts and the time t (s). Left out: none."),
      formulas(
          "initial.velocity_m_s", "m/s", {"X", "Y"},
          +[](Scene& s, std::size_t) -> std::optional<Formulas>& { return s.initial.velocity_m_s; },
          "Velocity at time 0, explicit only: formulas as for body. Left out: at rest."),
  };
}

std::vector<Key> rock_keys() {
  return {
      required(number(
          "rock.NAME.youngs_modulus_Pa", "Pa", positive,
          +[](Scene& s, std::size_t i) -> double& { return s.rocks[i].youngs_modulus_Pa; }, "Young's modulus.")),
      number(
          "rock.NAME.poisson_ratio", "", {0.0, 0.5, false, true},
          +[](Scene& s, std::size_t i) -> double& { return s.rocks[i].poisson_ratio; }, "Poisson's ratio.",
          "In plane strain the stiffness is infinite at 0.5; 0.49 is nearly incompressible."),
      number(
          "rock.NAME.density_kg_m3", "kg/m^3", positive,
          +[](Scene& s, std::size_t i) -> double& { return s.rocks[i].density_kg_m3; }, "Density."),
      number(
          "rock.NAME.toughness_Pa_sqrt_m", "Pa sqrt(m)", not_negative,
          +[](Scene& s, std::size_t i) -> double& { return s.rocks[i].toughness_Pa_sqrt_m; },
          "Fracture toughness K_Ic; with 0 a fracture grows while J > 0."),
  };
}

std::vector<Key> interface_keys() {
  using Kind = InterfaceLaw::Kind;
  using Compression = InterfaceLaw::Compression;
  return {
      required(word(
          "interface.NAME.law",
          {as("friction", Kind::friction), as("weak", Kind::weak), as("soft", Kind::soft),
           as("perfect", Kind::perfect)},
          [](Scene& s, std::size_t i) -> Kind& { return s.laws[i].kind; },
          "How the interface passes load; the interface named perfect needs no table.")),
      of_law("friction",
             number(
                 "interface.NAME.coefficient", "", not_negative,
                 +[](Scene& s, std::size_t i) -> double& { return s.laws[i].coefficient; }, "Coulomb coefficient.")),
      of_law(
          "weak",
          number(
              "interface.NAME.shear_strength_Pa", "Pa", positive,
              +[](Scene& s, std::size_t i) -> double& { return s.laws[i].shear_strength_Pa; },
              "Shear strength Sc; the interface fails for good where (S/Sc)^2 + (N/Nc)^2 reaches 1, N in tension only.",
              "For an interface without strength use law = \"friction\".")),
      of_law("weak", number(
                         "interface.NAME.tensile_strength_Pa", "Pa", positive,
                         +[](Scene& s, std::size_t i) -> double& { return s.laws[i].tensile_strength_Pa; },
                         "Tensile strength Nc.", "For an interface without strength use law = \"friction\".")),
      of_law("weak", number(
                         "interface.NAME.residual_friction", "", not_negative,
                         +[](Scene& s, std::size_t i) -> double& { return s.laws[i].residual_friction; },
                         "Coulomb coefficient where it has failed.")),
      of_law(
          "weak or friction",
          number(
              "interface.NAME.failure_length_m", "m", positive,
              +[](Scene& s, std::size_t i) -> std::optional<double>& { return s.laws[i].failure_length_m; },
              "Length of bonded interface over which the mean traction decides whether it fails or slips; by default "
              "fracture.increment_m, without a fracture numerics.cell_m.")),
      of_law("soft", number(
                         "interface.NAME.normal_stiffness_Pa_m", "Pa/m", not_negative,
                         +[](Scene& s, std::size_t i) -> double& { return s.laws[i].normal_stiffness_Pa_m; },
                         "Normal traction by opening, D_n.")),
      of_law("soft", number(
                         "interface.NAME.shear_stiffness_Pa_m", "Pa/m", not_negative,
                         +[](Scene& s, std::size_t i) -> double& { return s.laws[i].shear_stiffness_Pa_m; },
                         "Shear traction by slip, D_t.")),
      of_law("soft",
             word(
                 "interface.NAME.compression", {as("contact", Compression::contact), as("spring", Compression::spring)},
                 [](Scene& s, std::size_t i) -> Compression& { return s.laws[i].compression; },
                 "In compression: the faces meet, or the spring acts there too.")),
  };
}

std::vector<Key> strata_keys() {
  return {
      word(
          "strata.along", {as("y", Strata::Along::y), as("x", Strata::Along::x)},
          [](Scene& s, std::size_t) -> Strata::Along& { return s.strata.along; },
          "Layers stacked upwards, or from left to right."),
      required(
          other("strata.layers", KeyType::layers, {}, "The layers in that order: [{rock, thickness_m}, ..., {rock}].")),
      required(other("strata.layers[].rock", KeyType::text, {}, "Name of a [rock.NAME] table.")),
      number("strata.layers[].thickness_m", "m", positive, {},
             "Thickness; the last layer may leave it out and takes what remains.",
             "Layers are stacked upwards from the block's lower edge (along = \"x\": from its left)."),
      other("strata.interfaces", KeyType::names, {},
            "A name between each two layers, [interface.NAME] or perfect; each on a grid line or at mid-cell. Left "
            "out: all perfect."),
  };
}

std::vector<Key> fracture_keys() {
  return {
      required(points("fracture.path_m", "m",
                      "Points of the initial fracture, [[x, y], ...]; one end on the symmetry line, or neither.")),
      word(
          "fracture.growth",
          {as("J", Fracture::Growth::J), as("none", Fracture::Growth::none), as("energy", Fracture::Growth::energy)},
          [](Scene& s, std::size_t) -> Fracture::Growth& { return s.fracture->growth; },
          "Grow where J reaches J_c of the rock ahead, or never; energy: by the energy released over a finite "
          "increment everywhere, as crossing does near interfaces."),
      number(
          "fracture.increment_m", "m", positive,
          +[](Scene& s, std::size_t) -> double& { return s.fracture->increment_m; }, "Length of a growth step.",
          "For no growth use growth = \"none\"."),
      word(
          "fracture.direction",
          {as("straight", Fracture::Direction::straight), as("max_hoop", Fracture::Direction::max_hoop)},
          [](Scene& s, std::size_t) -> Fracture::Direction& { return s.fracture->direction; },
          "Ahead, or normal to the largest hoop stress by K_I and K_II."),
      number(
          "fracture.turn_share", "1", {0.05, 1.0, false, false},
          +[](Scene& s, std::size_t) -> double& { return s.fracture->turn_share; },
          "Most of the kink of max_hoop that one increment turns by; less where it has fewer than 3 cells."),
      word(
          "fracture.crossing", {as("J", Fracture::Crossing::J), as("energy", Fracture::Crossing::energy)},
          [](Scene& s, std::size_t) -> Fracture::Crossing& { return s.fracture->crossing; },
          "The criterion where an interface is near the tip: J, or the energy released over crossing_increment_m and, "
          "past an interface whose faces are apart, K."),
      number(
          "fracture.crossing_increment_m", "m", positive,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.fracture->crossing_increment_m; },
          "Length over which the energy of crossing is released; by default increment_m."),
      word(
          "fracture.order",
          {as("interfaces", Fracture::Order::interfaces), as("larger_margin", Fracture::Order::larger_margin)},
          [](Scene& s, std::size_t) -> Fracture::Order& { return s.fracture->order; },
          "What goes first where an interface fails and a tip grows at one load: interfaces, until nothing more fails, "
          "or whichever is further beyond its strength (without inertia)."),
      word(
          "fracture.faces", {as("contact", Fracture::Faces::contact), as("free", Fracture::Faces::free)},
          [](Scene& s, std::size_t) -> Fracture::Faces& { return s.fracture->faces; },
          "Where the fracture closes its faces meet, or they pass through each other as rock does not: to see what "
          "contact is worth."),
  };
}

std::vector<Key> fluid_keys() {
  return {
      word(
          "fluid.law",
          {as("paper", Fluid::Law::paper), as("uniform", Fluid::Law::uniform), as("reynolds", Fluid::Law::reynolds)},
          [](Scene& s, std::size_t) -> Fluid::Law& { return s.fluid.law; },
          "Pressure diffusion along the fracture by eq. (3), the inlet's pressure everywhere in it, or lubrication "
          "that conserves mass."),
      number(
          "fluid.bulk_modulus_Pa", "Pa", positive,
          +[](Scene& s, std::size_t) -> double& { return s.fluid.bulk_modulus_Pa; }, "Bulk modulus M."),
      number(
          "fluid.viscosity_Pa_s", "Pa s", positive,
          +[](Scene& s, std::size_t) -> double& { return s.fluid.viscosity_Pa_s; }, "Dynamic viscosity.",
          "For a fluid without viscosity use law = \"uniform\"."),
      number(
          "fluid.minimum_opening_m", "m", not_negative,
          +[](Scene& s, std::size_t) -> double& { return s.fluid.minimum_opening_m; },
          "Least opening in the permeability w^2/12: what closed faces conduct."),
      number(
          "fluid.inlet.start_Pa", "Pa", not_negative,
          +[](Scene& s, std::size_t) -> double& { return s.fluid.start_Pa; },
          "Inlet pressure at time 0, and of the initial fracture.", "Fluid pressure is positive in compression."),
      number(
          "fluid.inlet.rate_Pa_s", "Pa/s", finite, +[](Scene& s, std::size_t) -> double& { return s.fluid.rate_Pa_s; },
          "Rise of the inlet pressure."),
      number(
          "fluid.inlet.rate_m2_s", "m^2/s", positive,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.fluid.rate_m2_s; },
          "Fluid fed into the whole fracture per metre out of plane, instead of a pressure; with symmetry at the "
          "bottom the modelled half gets half of it."),
      word(
          "fluid.new_point", {as("dry", Fluid::NewPoint::dry), as("inherit", Fluid::NewPoint::inherit)},
          [](Scene& s, std::size_t) -> Fluid::NewPoint& { return s.fluid.new_point; },
          "Pressure of a new fracture point: 0, or the former tip's."),
      word(
          "fluid.time_rule",
          {as("trapezoid", Fluid::TimeRule::trapezoid), as("backward-euler", Fluid::TimeRule::backward_euler),
           as("explicit", Fluid::TimeRule::explicit_euler)},
          [](Scene& s, std::size_t) -> Fluid::TimeRule& { return s.fluid.time_rule; }, "Time integration of the flow."),
      number(
          "fluid.cavitation_Pa", "Pa", not_negative,
          +[](Scene& s, std::size_t) -> double& { return s.fluid.cavitation_Pa; },
          "Absolute lower bound of the fluid pressure under law = \"reynolds\"."),
  };
}

std::vector<Key> numerics_keys() {
  Key particles = other(
      "numerics.particles_per_cell", KeyType::integer,
      +[](Scene& s, std::size_t) -> int& { return s.numerics.particles_per_cell; },
      "Particles in each cell, a square of them.");
  particles.allowed = {4, 9, 16};
  Key tip_steps = other(
      "numerics.tip_steps", KeyType::integer, +[](Scene& s, std::size_t) -> int& { return s.numerics.tip_steps; },
      "Explicit only: steps from one look at the tips, by which they may grow, to the next. A P wave takes 2/courant "
      "steps from the tip to half of a ring of 4 cells; J and K of every row of the history are of its own time.");
  tip_steps.allowed = {1, 2, 3, 4, 5, 6, 7, 8};
  using Mechanics = Numerics::Mechanics;
  using Shape = Numerics::Shape;
  using Transfer = Numerics::Transfer;
  return {
      word(
          "numerics.mechanics",
          {as("explicit", Mechanics::explicit_dynamics), as("quasistatic", Mechanics::quasistatic)},
          [](Scene& s, std::size_t) -> Mechanics& { return s.numerics.mechanics; },
          "How the rock is solved: with inertia, or without."),
      required(number(
          "numerics.cell_m", "m", positive, +[](Scene& s, std::size_t) -> double& { return s.numerics.cell_m; },
          "Side of a square cell; divides width and height of the block.")),
      number(
          "numerics.far_cell_m", "m", positive,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.numerics.far_cell_m; },
          "Side of the cells far away: cells are of cell_m within 10 of "
          "them around the initial fracture and its straight way up to stop.tip_y_m, and within 4 of them around "
          "interfaces and borders of rocks elsewhere; then coarser by at most 1.2 a cell. Left out: uniform."),
      number(
          "numerics.fine_left_m", "m", finite,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.numerics.fine_left_m; },
          "With far_cell_m, for a path that turns: lowest x at which the fine cells around it end. Left out: 10 cells "
          "from the initial fracture and its straight way."),
      number(
          "numerics.fine_right_m", "m", finite,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.numerics.fine_right_m; },
          "With far_cell_m, for a path that turns: largest x at which the fine cells around it end. Left out: 10 cells "
          "from the initial fracture and its straight way."),
      number(
          "numerics.fine_bottom_m", "m", finite,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.numerics.fine_bottom_m; },
          "With far_cell_m, for a path that turns: lowest y at which the fine cells around it end. Left out: 10 cells "
          "from the initial fracture and its straight way."),
      number(
          "numerics.fine_top_m", "m", finite,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.numerics.fine_top_m; },
          "With far_cell_m, for a path that turns: largest y at which the fine cells around it end. Left out: 10 cells "
          "from the initial fracture and its straight way."),
      particles,
      word(
          "numerics.shape", {as("bspline2", Shape::bspline2), as("linear", Shape::linear), as("gimp", Shape::gimp)},
          [](Scene& s, std::size_t) -> Shape& { return s.numerics.shape; },
          "Shape functions: quadratic B-spline, linear, or generalised interpolation (uGIMP)."),
      word(
          "numerics.transfer", {as("flip", Transfer::flip), as("pic", Transfer::pic), as("xpic2", Transfer::xpic2)},
          [](Scene& s, std::size_t) -> Transfer& { return s.numerics.transfer; },
          "Velocity from the grid back to particles. Under kinematics = \"total\" nodes keep their velocities: nothing "
          "is transferred, and all choices are the same."),
      word(
          "numerics.kinematics",
          {as("updated", Numerics::Kinematics::updated), as("total", Numerics::Kinematics::total)},
          [](Scene& s, std::size_t) -> Numerics::Kinematics& { return s.numerics.kinematics; },
          "Particles move and weights are computed again, or all stays in its reference place between growth events."),
      word(
          "numerics.kernels", {as("fast", Numerics::Kernels::fast), as("plain", Numerics::Kernels::plain)},
          [](Scene& s, std::size_t) -> Numerics::Kernels& { return s.numerics.kernels; },
          "How an explicit step is computed: by its fast loops, or by plain ones over particles to check them against; "
          "results differ by round-off."),
      number(
          "numerics.courant", "", {0.0, 2.0, true, false},
          +[](Scene& s, std::size_t) -> double& { return s.numerics.courant; }, "Time step as c_P dt / cell_m.",
          "Steps are stable up to 0.65 to 1.2 by shape and transfer, uGIMP beside loaded edges up to 0.48; a run that "
          "becomes unstable ends and says so."),
      number(
          "numerics.damping_1_s", "1/s", not_negative,
          +[](Scene& s, std::size_t) -> double& { return s.numerics.damping_1_s; },
          "Damping of velocity: a = f/m - damping v."),
      tip_steps,
      number(
          "numerics.ring_cells", "cells", {2.5, 8.0, false, false},
          +[](Scene& s, std::size_t) -> double& { return s.numerics.ring_cells; },
          "Outer radius of the widest of three rings around a tip, by which J and K are measured; edges, interfaces "
          "and the other tip may leave less.",
          "A smaller ring holds little but the tip's own error, a larger one leaves the fine cells of a graded grid."),
      number(
          "numerics.flow_change", "", {0.0, 1.0, true, false},
          +[](Scene& s, std::size_t) -> double& { return s.numerics.flow_change; },
          "Quasi-static only: change of the nearest event's margin (1: the event) aimed at in a step of a flow that "
          "takes time; steps that change it by twice as much are tried again with half the length."),
      number(
          "numerics.flow_error", "", {0.0, 1.0, true, false},
          +[](Scene& s, std::size_t) -> double& { return s.numerics.flow_error; },
          "Quasi-static, error aimed at in a step of the flow: under fluid.law = \"reynolds\" of the largest opening, "
          "under \"paper\" half of what the mean of the openings at both ends would have changed of any pressure, over "
          "the largest net one. "
          "Steps with four times as much are tried again with half the length."),
  };
}

std::vector<Key> run_keys() {
  return {
      number(
          "stop.tip_y_m", "m", positive,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.stop.tip_y_m; },
          "Ends the run when a tip is as high.", "y is counted upwards from the block's lower edge."),
      number(
          "stop.inlet_Pa", "Pa", finite,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.stop.inlet_Pa; },
          "Ends the run when the inlet pressure is as high."),
      number(
          "stop.time_s", "s", not_negative,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.stop.time_s; },
          "Ends the run at this time; 0, quasi-static only: one equilibrium at the start pressure."),
      number(
          "output.fields_every_s", "s", positive,
          +[](Scene& s, std::size_t) -> std::optional<double>& { return s.output.fields_every_s; },
          "Time between stored fields; by default 1/50 of the run."),
      required(other("claim[].id", KeyType::text, {}, "Name of the claim; further keys are the harness's.")),
      required(other("claim[].text", KeyType::text, {}, "The claim in words.")),
      required(other("claim[].observable", KeyType::text, {}, "What of a run it is judged by.")),
  };
}

}  // namespace

const std::vector<Key>& scene_keys() {
  static const std::vector<Key> keys = [] {
    std::vector<Key> all;
    for (auto table : {heading_keys, domain_keys, load_keys, rock_keys, interface_keys, strata_keys, fracture_keys,
                       fluid_keys, numerics_keys, run_keys}) {
      for (Key& key : table()) all.push_back(std::move(key));
    }
    return all;
  }();
  return keys;
}

}  // namespace strata
