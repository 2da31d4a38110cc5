// The catalogue's entries for cracks beside an interface.
#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>
#include <stdexcept>

#include "bimaterial.hpp"
#include "catalogue.hpp"
#include "interface_springs.hpp"

namespace strata::reference {
namespace {

using std::numbers::pi;

std::vector<Input> two_rocks() {
  return joined(rock_inputs("", 10e9), rock_inputs("beyond_", 5e9, true));
}

std::vector<Input> crack_inputs(const char* distance_help, double distance) {
  return joined(joined({positive_input("half_length_m", "a; the crack is 2a long", 5),
                        positive_input("distance_m", distance_help, distance)},
                       pressure_inputs()),
                {list_input("x_m", "where the opening is wanted, along the crack from its middle", 0.0),
                 number_input("nodes", "on the crack; 0: as many as settle K", 0, 0, 512)});
}

// Everything that is read off a crack line; the ratio is to uniform pressure pressure_Pa in the infinite plane.
std::vector<Value> line_values(const Inputs& inputs, const CrackLine& line, double E_prime, const char* minus,
                               const char* plus) {
  const double unit = inputs.number("pressure_Pa") * std::sqrt(pi * inputs.number("half_length_m"));
  std::vector<Value> values;
  for (const bool at_plus : {false, true}) {
    const auto K = at_plus ? line.at_plus() : line.at_minus();
    const std::string tip = at_plus ? plus : minus;
    values.push_back({"K_I" + tip, K.K_I, "Pa sqrt(m)"});
    values.push_back({"K_II" + tip, K.K_II, "Pa sqrt(m)"});
    values.push_back({"J" + tip + "_N_m", (K.K_I * K.K_I + K.K_II * K.K_II) / E_prime, "N/m"});
    values.push_back({"kink" + tip + "_deg", max_hoop_angle(K.K_I, K.K_II) * kDegrees, "deg"});
    if (unit != 0) {
      values.push_back({"F" + tip, K.K_I / unit, "1"});
      values.push_back({"F_II" + tip, K.K_II / unit, "1"});
    }
  }
  values.push_back({"mouth_opening_m", line.jump(0)(0), "m"});
  values.push_back({"opening_m", at_each(inputs, "x_m", [&](double x) { return line.jump(x)(0); }), "m"});
  values.push_back({"slip_m", at_each(inputs, "x_m", [&](double x) { return line.jump(x)(1); }), "m"});
  values.push_back({"volume_m2", line.volume(), "m^2"});
  return values;
}

// Change of K at the tips from one solution to another, over the larger |K|.
double change_of_K(const CrackLine& line, const CrackLine& other) {
  double change = 0, size = 1e-300;
  for (const auto& [K, K_other] :
       {std::pair{line.at_minus(), other.at_minus()}, std::pair{line.at_plus(), other.at_plus()}}) {
    change = std::max(change, std::hypot(K.K_I - K_other.K_I, K.K_II - K_other.K_II));
    size = std::max(size, std::hypot(K_other.K_I, K_other.K_II));
  }
  return change / size;
}

// The answer of a crack line that `solve` gives for a number of nodes, 0 for as many as settle it. Round-off where a
// profile is steep comes on top of the line's own estimate.
Answer line_answer(const Inputs& inputs, double E_prime, const char* minus, const char* plus,
                   const std::function<CrackLine(int)>& solve) {
  const int nodes = inputs.count("nodes");
  const CrackLine line = solve(nodes);
  const double change = nodes > 0 ? 2 * change_of_K(line, solve(2 * nodes)) : line.error();
  return {line_values(inputs, line, E_prime, minus, plus),
          std::max({change, 1e-10, profile_error(knots_of(inputs), inputs.number("half_length_m"))}),
          "change of K from half the nodes (given nodes: twice the change to twice as many), over |K|; round-off"};
}

Answer solve_bonded(const Inputs& inputs, bool normal, const char* minus, const char* plus) {
  const double a = inputs.number("half_length_m");
  const double d = inputs.number("distance_m");
  const Rock rock = rock_of(inputs, "");
  const BondedCrack::Geometry geometry{a, normal ? d + a : d, normal ? pi / 2 : 0.0};
  return line_answer(inputs, rock.E_prime(), minus, plus, [&](int nodes) {
    return BondedCrack(geometry, rock, rock_of(inputs, "beyond_"), knots_of(inputs), nodes).line();
  });
}

Entry bonded_normal() {
  return {
      "bonded_normal",
      "pressurised crack normal to a bonded interface to another rock: K at the near and the far tip",
      joined(two_rocks(), crack_inputs("from the interface to the near tip", 1)),
      "Cook & Erdogan 1972; Suo 1989; Erdogan & Gupta 1972; Krenk 1975",
      "the rock without prefix holds the crack; beyond_youngs_modulus_Pa = 0 is a free surface; x_m = -a is the near "
      "tip; F = K/(pressure_Pa sqrt(pi a)); distance > about a/1000",
      [](const Inputs& inputs) { return solve_bonded(inputs, true, "_near", "_far"); }};
}

Entry bonded_parallel() {
  return {
      "bonded_parallel",
      "pressurised crack parallel to a bonded interface to another rock: K_I, K_II and kink angle",
      joined(two_rocks(), crack_inputs("from the interface to the crack", 2.5)),
      "Suo 1989; Erdogan & Gupta 1972; kink by maximum hoop stress, Erdogan & Sih 1963",
      "the rock without prefix holds the crack and lies above the interface; no suffix: the tip at +a, where K_II > 0 "
      "and kink < 0 turn to the interface; _minus: the tip at -a; F = K/(pressure_Pa sqrt(pi a))",
      [](const Inputs& inputs) { return solve_bonded(inputs, false, "_minus", ""); }};
}

Entry bonded_tip_exponent_entry() {
  return {"bonded_tip_exponent",
          "exponent of the stress r^-exponent at a crack tip that ends normal to, and on, a bonded interface",
          joined(rock_inputs("", 10e9), rock_inputs("beyond_", 5e9)),
          "Zak & Williams 1963",
          "the rock without prefix holds the crack; plane strain",
          [](const Inputs& inputs) {
            const Rock rock = rock_of(inputs, "");
            const Rock beyond = rock_of(inputs, "beyond_");
            const BondedMirror mirror = bonded_mirror(rock, beyond);
            const double exponent = bonded_tip_exponent(rock, beyond);
            // Where E beyond is all but 0 the root is almost a double one.
            const double slope = pi * std::sin(pi * exponent) + 4 * mirror.Pi * (1 - exponent);
            return Answer{{{"exponent", exponent, "1"}, {"Pi", mirror.Pi, "1"}, {"Lambda", mirror.La, "1"}},
                          std::max(1e-14, std::min(1e-7, 1e-15 / std::abs(slope))),
                          "root of a closed equation; round-off"};
          }};
}

// Throws std::invalid_argument for a stiffness that is given but is not that of the law.
SpringInterface interface_of(const Inputs& inputs) {
  const std::string& law = inputs.word("law");
  const double normal = inputs.number("normal_stiffness_Pa_m"), shear = inputs.number("shear_stiffness_Pa_m");
  if (law == "spring") return {normal, shear};
  const bool closed = law == "frictionless";
  for (const auto& [key, meant] :
       {std::pair{"normal_stiffness_Pa_m", closed ? "an infinite one" : "0"}, std::pair{"shear_stiffness_Pa_m", "0"}})
    if (inputs.given(key) && (inputs.number(key) != 0 || *meant != '0'))
      throw std::invalid_argument(std::string(key) + " is given, but law=" + law + " means " + meant +
                                  ". Leave it out, or set law=spring.");
  return {closed ? std::numeric_limits<double>::infinity() : 0, 0};
}

Entry spring_interface() {
  std::vector<Input> inputs = joined(rock_inputs("", 10e9), crack_inputs("from the interface to the near tip", 1));
  inputs.push_back(word_input("law", "springs; closed without friction; or free", {"spring", "frictionless", "free"}));
  inputs.push_back(number_input("normal_stiffness_Pa_m", "D_n of the springs; not with another law", 0.5e6, 0, 1e30));
  inputs.push_back(number_input("shear_stiffness_Pa_m", "D_t of the springs; not with another law", 0.5e6, 0, 1e30));
  return {
      "spring_interface",
      "pressurised crack normal to a soft, frictionless or free interface in one rock: K at the near and the far tip",
      inputs,
      "own derivation (Fourier transform along the interface); Erdogan & Gupta 1972",
      "the same rock on both sides; springs act alike in tension and compression; frictionless stays closed; x_m = -a "
      "is the near tip; F = K/(pressure_Pa sqrt(pi a)); distance > about a/1000",
      [](const Inputs& in) {
        const double E_prime = rock_of(in, "").E_prime();
        return line_answer(in, E_prime, "_near", "_far", [&](int nodes) {
          return spring_interface_crack(interface_of(in), in.number("half_length_m"), in.number("distance_m"), E_prime,
                                        knots_of(in), nodes);
        });
      }};
}

Entry coulomb_first_slip() {
  return {"coulomb_first_slip",
          "when a Coulomb interface ahead of a uniformly pressurised crack, normal to it, first slips",
          {positive_input("friction", "mu", 0.4), positive_input("compression_Pa", "s_n on the interface", 3e6),
           positive_input("half_length_m", "a; the crack is 2a long", 5),
           positive_input("distance_m", "from the interface to the near tip", 0.05),
           positive_input("toughness_Pa_sqrt_m", "K_Ic", 1.45e6)},
          "the tip's own field, and Westergaard's function of the finite crack; own evaluation",
          "one rock, interface without cohesion and unslipped before; ratio: distance << a; distance_at_K_Ic_m: where "
          "a tip at K_Ic makes the interface slip",
          [](const Inputs& in) {
            const double s_n = in.number("compression_Pa");
            const double a = in.number("half_length_m");
            const double ratio = first_slip_ratio(in.number("friction"));
            const double p = first_slip_pressure(a, in.number("distance_m"), s_n, in.number("friction"));
            const double root = in.number("toughness_Pa_sqrt_m") / (ratio * s_n);
            return Answer{{{"ratio", ratio, "1"},
                           {"net_pressure_Pa", p, "Pa"},
                           {"K_I", p * std::sqrt(pi * a), "Pa sqrt(m)"},
                           {"distance_at_K_Ic_m", root * root / (2 * pi), "m"}},
                          1e-9,
                          "maximum over the interface by golden section; ratio: relative to the tip's own field"};
          }};
}

}  // namespace

std::vector<Entry> interface_entries() {
  return {bonded_normal(), bonded_parallel(), bonded_tip_exponent_entry(), spring_interface(), coulomb_first_slip()};
}

}  // namespace strata::reference
