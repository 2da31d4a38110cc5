// The catalogue's entry for the height of a crack through layers of unlike stress and toughness.
#include <algorithm>

#include "catalogue.hpp"
#include "layered_height.hpp"

namespace strata::reference {
namespace {

Answer solve_layered_height(const Inputs& inputs) {
  const StressLayers layers{inputs.numbers("border_m"), inputs.numbers("stress_Pa"),
                            inputs.numbers("toughness_Pa_sqrt_m"), inputs.number("stress_slope_Pa_m"),
                            inputs.number("fluid_weight_Pa_m")};
  const CrackEnds start{inputs.number("bottom_m"), inputs.number("top_m")},
      limits{inputs.number("lower_limit_m"), inputs.number("upper_limit_m")};
  const auto tip_at = [&](double CrackEnds::*end) {
    return at_each(inputs, "pressure_Pa", [&](double P) { return grown_to_rest(layers, start, P, limits).*end; });
  };
  const CriticalPressures first = critical_pressures(layers, start);
  Answer answer;
  answer.values = {{"top_m", tip_at(&CrackEnds::top), "m"},
                   {"bottom_m", tip_at(&CrackEnds::bottom), "m"},
                   {"start_Pa", std::min(first.bottom, first.top), "Pa"}};
  if (inputs.given("height_m")) {
    answer.values.push_back(
        {"pressure_to_pass_Pa",
         at_each(inputs, "height_m", [&](double y) { return pressure_to_pass(layers, start, y, limits); }), "Pa"});
  }
  answer.relative_error = 1e-7;
  answer.error_basis = "order in which two tips move together, of the height; 1e-12 where one moves or both alike";
  return answer;
}

}  // namespace

std::vector<Entry> height_entries() {
  return {{"layered_height",
           "heights at which a crack through layers of unlike stress and toughness rests as the pressure rises",
           {list_input("border_m", "between layers, ascending; one fewer than layers", std::vector<double>{-10, 10}),
            list_input("stress_Pa", "closing stress of each layer, from below; with a slope, at y = 0 on its line",
                       std::vector<double>{2.75e6, 2e6, 2.75e6}),
            list_input("toughness_Pa_sqrt_m", "K_Ic of each layer", std::vector<double>{1e6, 1e6, 1e6}),
            number_input("stress_slope_Pa_m", "d(closing stress)/dy of all layers", 0, -1e9, 1e9),
            number_input("fluid_weight_Pa_m", "density times gravity: the fluid has P - w y", 0, -1e9, 1e9),
            number_input("bottom_m", "lower end of the crack at the start", -5, -1e9, 1e9),
            number_input("top_m", "its upper end", 5, -1e9, 1e9),
            number_input("lower_limit_m", "where the lower tip stops at the latest", -200, -1e9, 1e9),
            number_input("upper_limit_m", "where the upper tip stops at the latest", 200, -1e9, 1e9),
            list_input("pressure_Pa", "of the fluid at y = 0", 2.6e6),
            list_input("height_m", "of which the least pressure to pass it is wanted", 20.0)},
           "Simonson, Abou-Sayed & Clifton 1978; K by Griffith 1921",
           "plane strain, one modulus in all layers, fluid in the whole crack; the pressure only rises; the crack is "
           "open everywhere, or its faces would overlap; a tip at a limit was not held before",
           solve_layered_height}};
}

}  // namespace strata::reference
