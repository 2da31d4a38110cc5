// The catalogue's entries for cracks in one rock.
#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

#include "catalogue.hpp"
#include "finite_plate.hpp"
#include "griffith.hpp"
#include "rock.hpp"

namespace strata::reference {
namespace {

// Of the edges, over the pressure: beyond the first the block is refused, up to the second it is the corners' alone.
constexpr double kWorstResidual = 0.02;
constexpr double kCornerResidual = 2e-3;

// What both entries of this file take beside the rock.
std::vector<Input> crack_inputs() {
  return joined(joined({positive_input("half_length_m", "a; the crack is 2a long", 5)}, pressure_inputs()),
                {number_input("toughness_Pa_sqrt_m", "K_Ic, for the critical pressure", 1.45e6, 0, 1e12),
                 number_input("closing_stress_Pa", "added to the net critical pressure", 2e6, -1e12, 1e12),
                 list_input("x_m", "where the opening is wanted, along the crack from its middle", 0.0)});
}

Answer solve_pressurised_crack(const Inputs& inputs) {
  const double a = inputs.number("half_length_m");
  const double E_prime = rock_of(inputs, "").E_prime();
  const LinearlyPressurisedCrack crack(a, E_prime, knots_of(inputs));
  const TipIntensities K = crack.K_I();
  const double critical = griffith_critical_pressure(a, inputs.number("toughness_Pa_sqrt_m"));
  Answer answer;
  answer.values = {
      {"K_I", K.plus, "Pa sqrt(m)"},
      {"K_I_minus", K.minus, "Pa sqrt(m)"},
      {"J_N_m", energy_release_rate(K.plus, E_prime), "N/m"},
      {"J_minus_N_m", energy_release_rate(K.minus, E_prime), "N/m"},
      {"opening_m", at_each(inputs, "x_m", [&](double x) { return crack.opening(x); }), "m"},
      {"mouth_opening_m", crack.opening(0), "m"},
      {"volume_m2", crack.volume(), "m^2"},
      {"energy_J_m", crack.energy(), "J/m"},
      {"E_prime_Pa", E_prime, "Pa"},
      {"critical_net_pressure_Pa", critical, "Pa"},
      {"critical_pressure_Pa", critical + inputs.number("closing_stress_Pa"), "Pa"},
      {"J_c_N_m", energy_release_rate(inputs.number("toughness_Pa_sqrt_m"), E_prime), "N/m"},
  };
  answer.relative_error = profile_error(knots_of(inputs), a);
  answer.error_basis = "closed form; round-off, and quadrature of the energy";
  return answer;
}

Entry pressurised_crack() {
  return {
      "pressurised_crack",
      "pressurised crack in an infinite plane: K_I, J, opening, volume, energy; uniform, linear or any profile",
      joined(rock_inputs("", 10e9), crack_inputs()),
      "Griffith 1921; Sneddon & Lowengrub 1969; Tada, Paris & Irwin 2000",
      "plane strain, linear elastic, open everywhere; K_I at x = +a, K_I_minus at x = -a; critical pressures are for "
      "uniform pressure; volume of the whole crack 2a; w < 0 means that the faces would touch",
      solve_pressurised_crack};
}

Block block_of(const Inputs& inputs) {
  const auto hold = [&](const char* key) { return inputs.word(key) == "fixed" ? EdgeHold::fixed : EdgeHold::traction; };
  return {inputs.number("width_m"),
          inputs.number("half_height_m"),
          inputs.number("half_length_m"),
          hold("edges"),
          hold("top"),
          inputs.number("poisson_ratio")};
}

void require_symmetric(const PressureKnots& knots) {
  knots.validate();
  double largest = 0.0;
  for (double p : knots.p) largest = std::max(largest, std::abs(p));
  for (double x : knots.x)
    if (std::abs(knots(x) - knots(-x)) > 1e-9 * largest)
      throw std::invalid_argument("the profile must be symmetric about the crack's middle in block_crack");
}

Answer solve_block_crack(const Inputs& inputs) {
  const Block block = block_of(inputs);
  const double a = block.half_crack;
  const double E_prime = rock_of(inputs, "").E_prime();
  const int terms = inputs.count("terms");
  const BlockCrack crack(block, terms);
  const double F = crack.F();
  const double residual = crack.edge_residual();
  if (terms == 0 && !(residual < kWorstResidual))
    throw std::runtime_error("the block is too slender for the series: its edges are met only to " +
                             std::to_string(residual) + " of the pressure");
  const double critical = crack.critical_pressure(inputs.number("toughness_Pa_sqrt_m"));
  const PressureKnots knots = knots_of(inputs);
  require_symmetric(knots);
  const bool uniform = inputs.word("pressure") == "uniform";
  const double p = inputs.number("pressure_Pa");
  const double K = uniform ? crack.K_I(p) : block_K_I(block, knots, knots.x);
  const double volume = uniform ? crack.volume(p, E_prime) : block_volume(block, E_prime, knots, knots.x);
  Answer answer;
  answer.values = {
      {"F", F, "1"},
      {"K_I", K, "Pa sqrt(m)"},
      {"J_N_m", energy_release_rate(K, E_prime), "N/m"},
      {"volume_m2", volume, "m^2"},
      {"opening_ratio", crack.opening(0, 1, 1) / (4 * a), "1"},
      {"volume_ratio", crack.volume(1, 1) / (2 * std::numbers::pi * a * a), "1"},
      {"E_prime_Pa", E_prime, "Pa"},
      {"critical_net_pressure_Pa", critical, "Pa"},
      {"critical_pressure_Pa", critical + inputs.number("closing_stress_Pa"), "Pa"},
      {"critical_mouth_opening_m", crack.opening(0, critical, E_prime), "m"},
      {"critical_volume_m2", crack.volume(critical, E_prime), "m^2"},
      {"edge_residual", residual, "1"},
  };
  if (uniform) {
    answer.values.push_back({"mouth_opening_m", crack.opening(0, p, E_prime), "m"});
    answer.values.push_back(
        {"opening_m", at_each(inputs, "x_m", [&](double x) { return crack.opening(x, p, E_prime); }), "m"});
  }
  // A residual at the corners alone does not reach the crack; a large one says that the series has not settled.
  const double change = terms > 0 ? 2 * std::abs(F - BlockCrack(block, 2 * terms).F()) : crack.F_error();
  answer.relative_error = std::max({change / F, uniform ? 1e-8 : 1e-6, residual > kCornerResidual ? residual : 0.0});
  answer.error_basis =
      "change of F from half the terms (given terms: twice the change to twice as many), or the edges' residual if "
      "large; round-off; "
      "the weight function's difference "
      "where p varies";
  return answer;
}

Entry block_crack() {
  std::vector<Input> inputs = joined(rock_inputs("", 10e9), crack_inputs());
  inputs.push_back(positive_input("width_m", "of the block, across the crack", 80));
  inputs.push_back(
      positive_input("half_height_m", "from the crack's middle (the symmetric bottom) to the top edge", 80));
  inputs.push_back(word_input("edges", "the two sides: no net traction, or no normal displacement and no shear",
                              {"traction", "fixed"}));
  inputs.push_back(word_input("top", "the top edge, in the same words", {"traction", "fixed"}));
  inputs.push_back(number_input("terms", "of the series; 0: as many as settle it", 0, 0, 96));
  return {
      "block_crack",
      "crack 2a in the middle of a block width x 2 half_height (or a from its symmetric bottom): F, K_I, opening, "
      "volume, critical pressure",
      inputs,
      "Muskhelishvili 1953, chapters 18-19; edge collocation in the manner of Isida 1971; weight function of Rice 1972",
      "half_length <= 0.9 half_height, width >= half_length/2; slender blocks whose ends are felt are refused "
      "(see edge_residual and the error estimate); "
      "F = K_I/(p sqrt(pi a)) and the ratios to the infinite plane are for uniform p; a pressure that varies must be "
      "symmetric, and its opening is not given; volume of the whole crack 2a",
      solve_block_crack};
}

}  // namespace

std::vector<Entry> crack_entries() {
  return {pressurised_crack(), block_crack()};
}

}  // namespace strata::reference
