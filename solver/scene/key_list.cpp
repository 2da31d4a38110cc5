// The declarations themselves.
#include <fmt/format.h>

#include <cmath>
#include <cstdlib>

#include "scene/keys.hpp"

namespace strata {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr Bounds positive{0.0, infinity, true, true}, not_negative{0.0, infinity, false, true}, finite{};

using Text = std::string_view;
using Kind = Key::Kind;

constexpr Key number(Text path, Member member, Text unit, Bounds bounds, Text help, Text advice = "", Text law = "") {
  return {Kind::number, path, member, help, unit, bounds, "", advice, law};
}

constexpr Key integer(Text path, Member member, Text help, Text allowed) {
  return {.kind = Kind::integer, .path = path, .member = member, .help = help, .allowed = allowed};
}

// `offered`: the words that the key may take, in the order of help; empty for all of the enumeration.
constexpr Key word(Text path, Member member, Text help, Text offered = "", Text law = "") {
  return {Kind::word, path, member, help, "", {}, offered.empty() ? member.words : offered, "", law};
}

constexpr Key text(Text path, Member member, Text help) {
  return {Kind::text, path, member, help};
}

// `write`: what to type.
constexpr Key list(Text path, Member member, Text help, Text write, Text unit = "") {
  return {Kind::list, path, member, help, unit, {}, "", write};
}

// A formula, or those of a vector's two components. `variables`: what they may use.
constexpr Key formula(Text path, Member member, Text unit, Text variables, Text help) {
  return {Kind::formula, path, member, help, unit, {}, variables};
}

constexpr Key required(Key key) {
  key.required = true;
  return key;
}

// A layer's rock is found by its name when all names are known.
constexpr Member layer_rock{nowhere<std::string>.read, [](Scene& scene, std::size_t k) {
                              return text_of(scene, scene.rocks[scene.strata.layers[k].rock].name);
                            }};

constexpr Member interface_name{nowhere<std::string>.read, [](Scene& scene, std::size_t k) {
                                  return text_of(scene, scene.laws[scene.strata.interfaces[k].law].name);
                                }};

// Layers end on grid lines or at mid-cell and are put back there when read, so a thickness needs no digits of
// round-off. Until then the end of the layer holds its thickness.
constexpr Member layer_thickness{
    at<&Scene::strata, &Strata::layers, &Layer::to_m>.read, [](Scene& scene, std::size_t k) {
      const Layer& layer = scene.strata.layers[k];
      const double thickness = layer.to_m - layer.from_m;
      const double rounded = std::strtod(fmt::format("{:.9g}", thickness).c_str(), nullptr);
      const bool is_round = std::abs(rounded - thickness) < 1e-7 * scene.numerics.cell_m;
      const bool is_last = k + 1 == scene.strata.layers.size();
      return is_last ? std::string() : number_text(is_round ? rounded : thickness);
    }};

// The path of a key in a table and its member of the table, the list or what is optional, of one name: AT(domain,
// width_m) is "domain.width_m" and Scene::domain.width_m.
#define KEY(table, member, Type, name) table "." #name, at<&Scene::member, &Type::name>
#define AT(table, name) KEY(#table, table, decltype(Scene::table), name)
#define ROCK(name) KEY("rock.NAME", rocks, Rock, name)
#define INTERFACE(name) KEY("interface.NAME", laws, InterfaceLaw, name)
#define FRACTURE(name) KEY("fracture", fracture, Fracture, name)

constexpr Key keys[] = {
    text("title", at<&Scene::title>, "What the scene shows, in a line."),
    text("resolved_from.scene", at<&Scene::name>,
         "Name of the file that a resolved scene was made from; written by a run."),
    text("resolved_from.variant", at<&Scene::variant>, "Variant that was chosen then; written by a run."),
    required(number(AT(domain, width_m), "m", positive, "Width of the block; the origin is its lower left corner.")),
    required(number(AT(domain, height_m), "m", positive, "Height of the block.",
                    "y is counted upwards from the block's lower edge.")),
    number(AT(domain, beyond_m), "m", not_negative,
           "How far the rock goes on beyond the block's edges, but not below a symmetry line, in cells that grow by "
           "at most 1.5 each; what is said of the edges holds where the rock ends. 20 times the block stands for a "
           "rock without end."),
    word(AT(domain, bottom), "Lower edge: mirror line, or loaded by the in-situ traction.", "symmetry, traction"),
    word(AT(domain, sides),
         "Both sides: no further normal displacement once the in-situ state is on, or the in-situ traction.",
         "fixed, traction"),
    word(AT(domain, top), "Upper edge, as for the sides.", "traction, fixed"),
    formula(AT(in_situ, vertical_Pa), "Pa", "X, Y",
            "Vertical stress before the fracture is loaded, positive in compression: a number, or a formula of X."),
    formula(AT(in_situ, horizontal_Pa), "Pa", "X, Y",
            "Horizontal stress, positive in compression: a number, or a formula of Y."),
    word(AT(in_situ, initialise),
         "The two stresses everywhere, or the static state of the bonded stack under them as edge tractions."),
    number(AT(in_situ, shear_Pa), "Pa", finite,
           "Shear stress sigma_xy everywhere: positive, it drags the face towards +x towards +y."),
    word(
        AT(in_situ, weight),
        "Whether the rock's weight acts: vertical_Pa is then the stress at the block's top, which grows by rho g below "
        "(g = 9.80665 m/s^2), or a formula of Y that does so itself to 0.1 %."),
    formula(AT(body, acceleration_m_s2), "m/s^2", "X, Y, t",
            "Body force per mass beyond what the in-situ state balances, [\"x component\", \"y component\"]: "
            "formulas of the place X, Y (m) where a particle starts and the time t (s). Left out: none."),
    formula(AT(initial, velocity_m_s), "m/s", "X, Y",
            "Velocity at time 0, explicit only: formulas as for body. Left out: at rest."),
    required(number(ROCK(youngs_modulus_Pa), "Pa", positive, "Young's modulus.")),
    number(ROCK(poisson_ratio), "", {0.0, 0.5, false, true}, "Poisson's ratio.",
           "In plane strain the stiffness is infinite at 0.5; 0.49 is nearly incompressible."),
    number(ROCK(density_kg_m3), "kg/m^3", positive, "Density."),
    number(ROCK(toughness_Pa_sqrt_m), "Pa sqrt(m)", not_negative,
           "Fracture toughness K_Ic; with 0 a fracture grows while J > 0."),
    number(
        ROCK(leakoff_m_sqrt_s), "m/s^0.5", not_negative,
        "Carter's C_L under fluid.law = \"reynolds\": each face of the fracture loses C_L/sqrt(t - t_0), t_0 the time "
        "when the tip came by.",
        "Rock that takes no fluid has 0."),
    required(word("interface.NAME.law", at<&Scene::laws, &InterfaceLaw::kind>,
                  "How the interface passes load; the interface named perfect needs no table.",
                  "friction, weak, soft, perfect")),
    number(INTERFACE(coefficient), "", not_negative, "Coulomb coefficient.", "", "friction"),
    number(INTERFACE(shear_strength_Pa), "Pa", positive,
           "Shear strength Sc; the interface fails for good where (S/Sc)^2 + (N/Nc)^2 reaches 1, N in tension only.",
           "For an interface without strength use law = \"friction\".", "weak"),
    number(INTERFACE(tensile_strength_Pa), "Pa", positive, "Tensile strength Nc.",
           "For an interface without strength use law = \"friction\".", "weak"),
    number(INTERFACE(toughness_Pa_sqrt_m), "Pa sqrt(m)", positive,
           "Instead of strengths (without inertia): from where the fracture meets it, or from the edge of what has "
           "parted, it parts over fracture.crossing_increment_m where that releases K^2/E' per length, if the tip is "
           "not nearer to growth; faces that part so are dry.",
           "For an interface without toughness use law = \"friction\".", "weak"),
    number(INTERFACE(residual_friction), "", not_negative, "Coulomb coefficient where it has failed.", "", "weak"),
    number(INTERFACE(failure_length_m), "m", positive,
           "Length of bonded interface over which the mean traction decides whether it fails or slips; by default "
           "fracture.increment_m, without a fracture numerics.cell_m.",
           "", "weak or friction"),
    number(INTERFACE(normal_stiffness_Pa_m), "Pa/m", not_negative, "Normal traction by opening, D_n.", "", "soft"),
    number(INTERFACE(shear_stiffness_Pa_m), "Pa/m", not_negative, "Shear traction by slip, D_t.", "", "soft"),
    word(INTERFACE(compression), "In compression: the faces meet, or the spring acts there too.", "", "soft"),
    word(AT(strata, along), "Layers stacked upwards, or from left to right.", "y, x"),
    required(list(AT(strata, layers), "The layers in that order: [{rock, thickness_m}, ..., {rock}].",
                  "Write [{rock = \"NAME\", thickness_m = 10}, ..., {rock = \"NAME\"}].")),
    required(text("strata.layers[].rock", layer_rock, "Name of a [rock.NAME] table.")),
    number("strata.layers[].thickness_m", layer_thickness, "m", positive,
           "Thickness; the last layer may leave it out and takes what remains.",
           "Layers are stacked upwards from the block's lower edge (along = \"x\": from its left)."),
    formula("strata.layers[].horizontal_Pa", at<&Scene::strata, &Strata::layers, &Layer::horizontal_Pa>, "Pa", "X, Y",
            "Horizontal stress of a layer stacked upwards; left out: in_situ.horizontal_Pa."),
    formula("strata.layers[].vertical_Pa", at<&Scene::strata, &Strata::layers, &Layer::vertical_Pa>, "Pa", "X, Y",
            "Vertical stress of a layer stacked from left to right; left out: in_situ.vertical_Pa."),
    list(AT(strata, interfaces),
         "A name between each two layers, [interface.NAME] or perfect, or {name, from_m, to_m}; each on a grid line or "
         "at "
         "mid-cell. Left out: all perfect.",
         "Write [\"NAME\", ...], or {name = \"NAME\", from_m = 15, to_m = 65} for one that ends."),
    required(text("strata.interfaces[].name", interface_name, "Name of an interface that ends.")),
    number("strata.interfaces[].from_m", at<&Scene::strata, &Strata::interfaces, &InterfacePlace::from_m>, "m", finite,
           "Where its law begins along it, on a grid line; left out: at the edge. Beyond its ends the rock is bonded."),
    number("strata.interfaces[].to_m", at<&Scene::strata, &Strata::interfaces, &InterfacePlace::to_m>, "m", finite,
           "Where its law ends."),
    required(list(FRACTURE(path_m),
                  "Points of the initial fracture, [[x, y], ...]; one end on the symmetry line, or neither.",
                  "Write [[x, y], [x, y]] with decimal points: a scene has one fracture.", "m")),
    word(FRACTURE(growth),
         "Grow where J reaches J_c of the rock ahead, or never; energy: by the energy released over a finite "
         "increment everywhere, as crossing does near interfaces.",
         "J, none, energy"),
    number(FRACTURE(increment_m), "m", positive, "Length of a growth step.", "For no growth use growth = \"none\"."),
    word(FRACTURE(direction), "Ahead, or normal to the largest hoop stress by K_I and K_II."),
    number(FRACTURE(turn_share), "1", {0.05, 1.0, false, false},
           "Most of the kink of max_hoop that one increment turns by; less where it has fewer than 3 cells."),
    word(FRACTURE(crossing),
         "The criterion where an interface is near the tip: J, or the energy released over crossing_increment_m and, "
         "past an interface whose faces are apart, K."),
    number(FRACTURE(crossing_increment_m), "m", positive,
           "Length over which the energy of crossing is released; by default increment_m."),
    word(FRACTURE(order),
         "What goes first where an interface fails and a tip grows at one load: interfaces, until nothing more "
         "fails, or whichever is further beyond its strength (without inertia)."),
    word(FRACTURE(faces),
         "Where the fracture closes its faces meet, or they pass through each other as rock does not: to see what "
         "contact is worth."),
    number(FRACTURE(friction), "", not_negative, "Coulomb coefficient of the fracture's faces where they meet."),
    word(AT(fluid, law),
         "Pressure diffusion along the fracture by eq. (3), the inlet's pressure everywhere in it, or lubrication "
         "that conserves mass.",
         "paper, uniform, reynolds"),
    number(AT(fluid, bulk_modulus_Pa), "Pa", positive, "Bulk modulus M."),
    number(
        AT(fluid, density_kg_m3), "kg/m^3", not_negative,
        "Density, by which the pressure of the fluid at rest falls by rho g upwards (g = 9.80665 m/s^2); 0: it has no "
        "weight. Under law = \"uniform\" inlet's pressure is that at the inlet's height.",
        "Water has 1000."),
    number(AT(fluid, viscosity_Pa_s), "Pa s", positive, "Dynamic viscosity.",
           "For a fluid without viscosity use law = \"uniform\"."),
    number(AT(fluid, minimum_opening_m), "m", not_negative,
           "Least opening in the permeability w^2/12: what closed faces conduct."),
    number(KEY("fluid.inlet", fluid, Fluid, start_Pa), "Pa", not_negative,
           "Inlet pressure at time 0, and of the initial fracture.", "Fluid pressure is positive in compression."),
    number(KEY("fluid.inlet", fluid, Fluid, rate_Pa_s), "Pa/s", finite, "Rise of the inlet pressure."),
    number(
        KEY("fluid.inlet", fluid, Fluid, rate_m2_s), "m^2/s", positive,
        "Fluid fed into the middle of the whole fracture per metre out of plane, instead of a pressure; with symmetry "
        "at the bottom the modelled half gets half of it, at its foot."),
    list(KEY("fluid.inlet", fluid, Fluid, table),
         "Instead of these: rows [time_s, value], from time 0 on; linear between rows, the last value is held.",
         "Write [[0, value], [time_s, value]].", "s"),
    word("fluid.inlet.of", at<&Scene::fluid, &Fluid::table_of>,
         "What the table's values are: a rate as rate_m2_s, or the inlet's pressure. Shut-in is a rate of 0."),
    word(AT(fluid, new_point), "Pressure of a new fracture point: 0, or the former tip's."),
    word(AT(fluid, time_rule), "Time integration of the flow."),
    number(AT(fluid, cavitation_Pa), "Pa", not_negative,
           "Absolute lower bound of the fluid pressure under law = \"reynolds\"."),
    word(AT(numerics, mechanics), "How the rock is solved: with inertia, or without."),
    required(
        number(AT(numerics, cell_m), "m", positive, "Side of a square cell; divides width and height of the block.")),
    number(AT(numerics, far_cell_m), "m", positive,
           "Side of the cells far away: cells are of cell_m within 10 of them around the initial fracture and its "
           "straight way up to stop.tip_y_m, and within 4 of them around interfaces and borders of rocks elsewhere; "
           "then coarser by at most 1.2 a cell. Left out: uniform."),
    number(AT(numerics, fine_left_m), "m", finite,
           "With far_cell_m, for a path that turns: lowest x of the fine cells around it. Left out: see far_cell_m."),
    number(AT(numerics, fine_right_m), "m", finite,
           "With far_cell_m, for a path that turns: largest x of the fine cells around it. Left out: see far_cell_m."),
    number(AT(numerics, fine_bottom_m), "m", finite,
           "With far_cell_m, for a path that turns: lowest y of the fine cells around it. Left out: see far_cell_m."),
    number(AT(numerics, fine_top_m), "m", finite,
           "With far_cell_m, for a path that turns: largest y of the fine cells around it. Left out: see far_cell_m."),
    integer(AT(numerics, particles_per_cell), "Particles in each cell, a square of them.", "4, 9, 16"),
    word(AT(numerics, shape), "Shape functions: quadratic B-spline, linear, or generalised interpolation (uGIMP)."),
    word(AT(numerics, transfer),
         "Velocity from the grid back to particles. Under kinematics = \"total\" nodes keep their velocities: "
         "nothing is transferred, and all choices are the same."),
    word(AT(numerics, kinematics),
         "Particles move and weights are computed again, or all stays in its reference place between growth events."),
    word(AT(numerics, kernels),
         "How an explicit step is computed: by its fast loops, or by plain ones over particles to check them "
         "against; results differ by round-off."),
    number(AT(numerics, courant), "", {0.0, 2.0, true, false}, "Time step as c_P dt / cell_m.",
           "Steps are stable up to 0.65 to 1.2 by shape and transfer, uGIMP beside loaded edges up to 0.48; a run "
           "that becomes unstable ends and says so."),
    number(AT(numerics, damping_1_s), "1/s", not_negative, "Damping of velocity: a = f/m - damping v."),
    integer(AT(numerics, tip_steps),
            "Explicit only: steps from one look at the tips, by which they may grow, to the next. A P wave takes "
            "2/courant steps from the tip to half of a ring of 4 cells; J and K of every row of the history are of "
            "its own time.",
            "1, 2, 3, 4, 5, 6, 7, 8"),
    number(AT(numerics, ring_cells), "cells", {2.5, 8.0, false, false},
           "Outer radius of the widest of three rings around a tip, by which J and K are measured; edges, interfaces "
           "and the other tip may leave less.",
           "A smaller ring holds little but the tip's own error, a larger one leaves the fine cells of a graded grid."),
    number(AT(numerics, flow_change), "", {0.0, 1.0, true, false},
           "Quasi-static only: change of the nearest event's margin (1: the event) aimed at in a step of a flow that "
           "takes time; steps that change it by twice as much are tried again with half the length."),
    number(AT(numerics, flow_error), "", {0.0, 1.0, true, false},
           "Quasi-static, error aimed at in a step of the flow: under fluid.law = \"reynolds\" of the largest "
           "opening, under \"paper\" half of what the mean of the openings at both ends would have changed of any "
           "pressure, over the largest net one. Steps with four times as much are tried again with half the length."),
    number(AT(stop, tip_y_m), "m", positive, "Ends the run when a tip is as high.",
           "y is counted upwards from the block's lower edge."),
    number(AT(stop, lower_tip_y_m), "m", positive, "Ends the run when the lower one of two tips has come down to it."),
    number(AT(stop, inlet_Pa), "Pa", finite, "Ends the run when the inlet pressure is as high."),
    number(AT(stop, time_s), "s", not_negative,
           "Ends the run at this time; 0, quasi-static only: one equilibrium at the start pressure."),
    number(AT(output, fields_every_s), "s", positive,
           "Time between stored fields; by default 1/50 of the run, or where no time or pressure ends it 0.02 s, "
           "from 0.2 s on a tenth of the time so far."),
    required(text("claim[].id", nowhere<std::string>, "Name of the claim; further keys are the harness's.")),
    required(text("claim[].text", nowhere<std::string>, "The claim in words.")),
    required(text("claim[].observable", nowhere<std::string>, "What of a run it is judged by.")),
};

#undef KEY
#undef AT
#undef ROCK
#undef INTERFACE
#undef FRACTURE

}  // namespace

std::span<const Key> scene_keys() {
  return keys;
}

}  // namespace strata
