// Formulas in a scene: text that is a number for each value of its variables, read and evaluated by muParser.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace strata {

// A variable of a formula and its values, as many as the formula is to be evaluated for.
struct FormulaVariable {
  std::string name;
  const std::vector<double>& values;
};

/// What is wrong with a formula that may use `variables` and pi, with the place in it: "there is no x at character 5.
/// Did you mean X?"; nothing where it can be evaluated. Throws nothing but std::bad_alloc.
std::optional<std::string> fault_in_formula(const std::string& text, const std::vector<std::string>& variables);

/// The formula's value for each of the variables' values, in their order and on one thread. What is not finite is
/// returned as it is. Throws std::logic_error where fault_in_formula() has not passed the text.
std::vector<double> evaluate_formula(const std::string& text, const std::vector<FormulaVariable>& variables);

}  // namespace strata
