// The catalogue's entries for a fracture that ends on, or has crossed, an interface that passes no shear.
#include <algorithm>
#include <cmath>
#include <numbers>

#include "catalogue.hpp"
#include "cut_blocks.hpp"
#include "sliding_blocks.hpp"

namespace strata::reference {
namespace {

using std::numbers::pi;

constexpr const char* kSource =
    "own elements of high order, graded to the tip (Szabo & Babuska 1991); K from the energy's derivative (Parks 1974)";

std::vector<Input> block_inputs(double fresh, double order) {
  return joined(
      joined({positive_input("width_m", "of the block, whose sides are held", 80),
              positive_input("height_m", "from the symmetry line to the free top", 80),
              positive_input("interface_m", "height of the interface", 10),
              number_input("fresh_m", "length of the fracture beyond the interface; 0: it ends there", fresh, 0, 1e12)},
             joined(rock_inputs("", 10e9), rock_inputs("beyond_", 10e9))),
      {positive_input("pressure_Pa", "net pressure, uniform in the fracture", 1e6),
       number_input("order", "of the elements", order, 4, 12)});
}

CutBlock cut_block_of(const Inputs& inputs) {
  CutBlock block;
  block.width = inputs.number("width_m"), block.height = inputs.number("height_m");
  block.interface = inputs.number("interface_m"), block.fresh = inputs.number("fresh_m");
  block.below = rock_of(inputs, ""), block.above = rock_of(inputs, "beyond_");
  return block;
}

Input springs_input(double standard) {
  return number_input("shear_stiffness_Pa_m", "springs along the decoupled part; 0: frictionless", standard, 0, 1e30);
}

Input slipped_input(double standard) {
  return number_input("slipped_m", "length decoupled on each side; bonded farther out; 1e9: all of it", standard, 0,
                      1e9);
}

Input toughness_input() {
  return positive_input("toughness_Pa_sqrt_m", "K_Ic of the rock above", 1.45e6);
}

double change(double fine, double coarse) {
  return std::abs(fine - coarse) / std::max(std::abs(fine), 1e-300);
}

constexpr const char* kBasis = "change from elements of the order less two, relative; round-off";
constexpr double kRoundOff = 1e-8;

Answer solve_cut_blocks(const Inputs& inputs) {
  CutBlock block = cut_block_of(inputs);
  block.slipped = inputs.number("slipped_m");
  block.shear_stiffness = inputs.number("shear_stiffness_Pa_m");
  const int order = inputs.count("order");
  const double p = inputs.number("pressure_Pa");
  const CutBlocks blocks(block, order), coarse(block, order - 2);
  const double E_below = block.below.E_prime();
  double error = std::max(kRoundOff, change(blocks.energy(), coarse.energy()));
  std::vector<Value> values{{"stored_J_m", blocks.energy() * p * p, "J/m"},
                            {"cut_stored_J_m", 0.5 * p * p * block.width * block.interface / E_below, "J/m"},
                            {"cut_opening_m", p * block.width / E_below, "m"},
                            {"mouth_opening_m", blocks.opening(0) * p, "m"},
                            {"opening_m", at_each(inputs, "y_m", [&](double y) { return blocks.opening(y) * p; }), "m"},
                            {"volume_m2", blocks.volume() * p, "m^2"},
                            {"largest_tension_Pa", blocks.largest_tension() * p, "Pa"}};
  if (block.fresh > 0) {
    const double K = blocks.K_I();
    values.push_back({"K_I", K * p, "Pa sqrt(m)"});
    values.push_back({"F", K / std::sqrt(pi * block.fresh), "1"});
    values.push_back({"J_N_m", K * K * p * p / block.above.E_prime(), "N/m"});
    values.push_back({"critical_pressure_Pa", inputs.number("toughness_Pa_sqrt_m") / K, "Pa"});
    error = std::max(error, change(K, coarse.K_I()));
  }
  return {values, error, kBasis};
}

Entry cut_blocks() {
  return {"cut_blocks",
          "fracture that ends on an interface without shear, or has crossed it: energy, opening, K of its tip",
          joined(block_inputs(1, 8), {springs_input(0.5e6), slipped_input(1e9), toughness_input(),
                                      list_input("y_m", "where the opening is wanted, from the bottom up", 0.0)}),
          kSource,
          "half the fracture above the symmetry line, the block's whole width; the interface stays closed: "
          "largest_tension_Pa below the in-situ stress across it; cut_: closed form for the lower block cut through, "
          "no springs, fresh_m = 0; F = K/(pressure_Pa sqrt(pi fresh_m))",
          solve_cut_blocks};
}

Entry crossing_pressure_entry() {
  return {"crossing_pressure",
          "net pressure at which a fracture crosses an interface without shear by a finite increment",
          joined(block_inputs(0, 8), {springs_input(0.5e6), toughness_input(),
                                      positive_input("increment_m", "by which the fracture grows at once", 1)}),
          std::string(kSource) + "; finite increment: Leguillon 2002, Eur. J. Mech. A 21, 61",
          "as cut_blocks; released energy over the increment is J_c of the rock above; pressure_Pa is not used",
          [](const Inputs& inputs) {
            CutBlock block = cut_block_of(inputs);
            block.shear_stiffness = inputs.number("shear_stiffness_Pa_m");
            const double da = inputs.number("increment_m"), K_Ic = inputs.number("toughness_Pa_sqrt_m");
            const int order = inputs.count("order");
            const double p = crossing_pressure(block, da, K_Ic, order);
            return Answer{
                {{"net_pressure_Pa", p, "Pa"}, {"released_J_m", da * K_Ic * K_Ic / block.above.E_prime(), "J/m"}},
                std::max(kRoundOff, change(p, crossing_pressure(block, da, K_Ic, order - 2))),
                kBasis};
          }};
}

Entry interface_ahead() {
  return {"interface_ahead",
          "stress on a bonded interface ahead of where it has slipped, beside a fracture that ends on it",
          joined(block_inputs(0, 8),
                 {springs_input(0), slipped_input(0), positive_input("ahead_m", "length of the mean, from there", 1),
                  positive_input("shear_strength_Pa", "at which the mean shear lets go", 0.5e6)}),
          kSource,
          "as cut_blocks; shear is the size of s_xy, normal s_yy without the in-situ stress, tension positive; "
          "slipped_m + ahead_m within the block",
          [](const Inputs& inputs) {
            CutBlock block = cut_block_of(inputs);
            block.slipped = inputs.number("slipped_m"), block.ahead = inputs.number("ahead_m");
            block.shear_stiffness = inputs.number("shear_stiffness_Pa_m");
            const int order = inputs.count("order");
            const double p = inputs.number("pressure_Pa");
            const CutBlocks blocks(block, order);
            const auto mean = blocks.mean_traction_ahead(), coarse = CutBlocks(block, order - 2).mean_traction_ahead();
            return Answer{{{"shear_Pa", std::abs(mean.shear) * p, "Pa"},
                           {"normal_Pa", mean.normal * p, "Pa"},
                           {"net_pressure_Pa", inputs.number("shear_strength_Pa") / std::abs(mean.shear), "Pa"},
                           {"largest_tension_Pa", blocks.largest_tension() * p, "Pa"}},
                          std::max(kRoundOff, change(mean.shear, coarse.shear)),
                          kBasis};
          }};
}

Entry sliding_blocks_entry() {
  return {"sliding_blocks",
          "fracture that has crossed a Coulomb interface, under rising pressure: friction work, K, stored energy",
          joined(block_inputs(5, 5),
                 {positive_input("friction", "mu", 0.1), positive_input("compression_Pa", "s_n on the interface", 3e6),
                  number_input("steps", "of the pressure", 20, 1, 1000)}),
          std::string(kSource) + "; linear complementarity (Klarbring 1986)",
          "as cut_blocks, tip at fresh_m > 0 from the start, pressure from 0; refused where the interface opens",
          [](const Inputs& inputs) {
            CutBlock block = cut_block_of(inputs);
            block.widest = 1.0 / 16;
            const int order = inputs.count("order");
            const auto solved = [&](int n) {
              return sliding_blocks(block, inputs.number("friction"), inputs.number("compression_Pa"),
                                    inputs.number("pressure_Pa"), inputs.count("steps"), n);
            };
            const SlidingBlocks end = solved(order), coarse = solved(order - 1);
            return Answer{{{"friction_work_J_m", end.friction_work, "J/m"},
                           {"stored_J_m", end.stored, "J/m"},
                           {"work_J_m", end.work, "J/m"},
                           {"K_I", end.K_I, "Pa sqrt(m)"},
                           {"mouth_opening_m", end.mouth_opening, "m"},
                           {"largest_slip_m", end.largest_slip, "m"},
                           {"slid_to_m", end.slid_to, "m"}},
                          std::max({kRoundOff, change(end.K_I, coarse.K_I), change(end.stored, coarse.stored),
                                    end.friction_work > 0 ? change(end.friction_work, coarse.friction_work) : 0}),
                          "change from elements of the order less one, relative; the ends of sliding: an element"};
          }};
}

}  // namespace

std::vector<Entry> block_entries() {
  return {cut_blocks(), crossing_pressure_entry(), interface_ahead(), sliding_blocks_entry()};
}

}  // namespace strata::reference
