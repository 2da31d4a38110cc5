// The catalogue's entry for layers that share a load.
#include <stdexcept>

#include "catalogue.hpp"
#include "laminate.hpp"

namespace strata::reference {
namespace {

// The k-th of a list, or the one number that stands for all.
double element(const std::vector<double>& list, std::size_t k, std::size_t n, const char* key) {
  if (list.size() != 1 && list.size() != n)
    throw std::invalid_argument(std::string(key) + " has another length than thickness_m.");
  return list.size() == 1 ? list.front() : list[k];
}

Answer solve_loaded_layers(const Inputs& inputs) {
  const std::vector<double> thickness = inputs.numbers("thickness_m"), E = inputs.numbers("youngs_modulus_Pa"),
                            nu = inputs.numbers("poisson_ratio");
  std::vector<Ply> plies;
  for (std::size_t k = 0; k < thickness.size(); ++k) {
    const std::size_t n = thickness.size();
    plies.push_back({{element(E, k, n, "youngs_modulus_Pa"), element(nu, k, n, "poisson_ratio")}, thickness[k]});
  }
  const Laminate state = loaded_laminate(plies, inputs.number("horizontal_Pa"), inputs.number("vertical_Pa"));
  return {{{"stress_xx_Pa", state.stress_xx, "Pa"},
           {"stress_yy_Pa", state.stress_yy, "Pa"},
           {"strain_xx", state.strain_xx, "1"},
           {"strain_yy", state.strain_yy, "1"}},
          1e-14,
          "closed form"};
}

Input many(std::string key, std::string help, std::vector<double> standard, double least, double most) {
  Input input = list_input(std::move(key), std::move(help), std::move(standard));
  input.least = least, input.most = most;
  input.least_excluded = least == 0.0 && most > 1.0, input.most_excluded = most == 0.5;
  return input;
}

}  // namespace

std::vector<Entry> laminate_entries() {
  return {{"loaded_layers",
           "stress of bonded layers stacked along y under edge tractions, far from the sides",
           {many("thickness_m", "of each layer", {10, 70}, 0, 1e300),
            many("youngs_modulus_Pa", "E of each layer, or of all", {10e9, 5e9}, 0, 1e300),
            many("poisson_ratio", "nu of each layer, or of all", {0.2}, 0, 0.5),
            number_input("horizontal_Pa", "traction on the sides, positive in compression", 2e6, -1e12, 1e12),
            number_input("vertical_Pa", "traction on top, positive in compression", 3e6, -1e12, 1e12)},
           "Hooke's law and balance of force; Jones 1999, Mechanics of composite materials, chapter 3",
           "plane strain, no bending, farther from the sides than some heights of the stack; stresses tension positive",
           solve_loaded_layers}};
}

}  // namespace strata::reference
