#include "scene/formula.hpp"

#include <fmt/format.h>
#include <muParser.h>

#include <algorithm>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "scene/messages.hpp"

namespace strata {
namespace {

// A parser that knows pi and muParser's functions, and nothing else.
mu::Parser parser_of(const std::string& text) {
  mu::Parser parser;
  parser.ClearConst();
  parser.DefineConst("pi", std::numbers::pi);
  parser.SetExpr(text);
  return parser;
}

std::string message_of(const mu::Parser::exception_type& error, const std::string& text,
                       const std::vector<std::string>& variables) {
  const int at = std::min(error.GetPos(), static_cast<int>(text.size())) + 1;
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
    std::vector<std::string> known = variables;
    for (const char* name : {"pi", "sin", "cos", "tan", "exp", "sqrt", "abs", "min", "max"}) known.emplace_back(name);
    const double most = error.GetToken().size() == 1 ? 0.5 : 2.0;  // a letter is another one's slip only in its case
    return fmt::format(
        "there is no {} at character {}. A formula may use {}, pi, + - * / ^, a comparison ? : and functions such as "
        "sin, exp, sqrt.{}",
        error.GetToken(), at, fmt::join(variables, ", "), did_you_mean(error.GetToken(), known, most));
  }
  if (error.GetCode() == mu::ecEXPRESSION_TOO_LONG)
    return fmt::format("its {} characters are too many. Shorten it.", text.size());
  std::string what = error.GetMsg();
  what.resize(std::min({what.size(), what.find(" at position"), what.find_last_not_of('.') + 1}));
  const char* advice = error.GetToken() == "=" ? " Use == to compare." : "";
  return at >= 1 ? fmt::format("at character {}: {}.{}", at, what, advice) : what + '.';
}

}  // namespace

std::optional<std::string> fault_in_formula(const std::string& text, const std::vector<std::string>& variables) {
  if (text.find_first_not_of(" \t") == std::string::npos) return "it is empty. Write 0 for nothing.";
  try {
    mu::Parser parser = parser_of(text);
    for (const std::string& name : variables) parser.DefineConst(name, 0.5);  // to which nothing can be assigned
    int results = 0;
    parser.Eval(results);
    if (results != 1) return fmt::format("it has {} values, separated by commas. Give one.", results);
  } catch (const mu::Parser::exception_type& error) {
    if (error.GetCode() == mu::ecDIV_BY_ZERO || error.GetCode() == mu::ecDOMAIN_ERROR) return std::nullopt;
    return message_of(error, text, variables);
  }
  return std::nullopt;
}

std::vector<double> evaluate_formula(const std::string& text, const std::vector<FormulaVariable>& variables) {
  std::vector<double> at(variables.size(), 0.0);
  std::vector<double> out(variables.empty() ? 1 : variables.front().values.size());
  try {
    mu::Parser parser = parser_of(text);
    for (std::size_t v = 0; v < at.size(); ++v) parser.DefineVar(variables[v].name, &at[v]);
    for (std::size_t k = 0; k < out.size(); ++k) {
      for (std::size_t v = 0; v < at.size(); ++v) at[v] = variables[v].values[k];
      try {
        out[k] = parser.Eval();
      } catch (const mu::Parser::exception_type& error) {
        if (error.GetCode() != mu::ecDIV_BY_ZERO && error.GetCode() != mu::ecDOMAIN_ERROR) throw;
        out[k] = std::numeric_limits<double>::quiet_NaN();
      }
    }
  } catch (const mu::Parser::exception_type& error) {
    throw std::logic_error(fmt::format("the formula \"{}\" was not checked: {}", text, error.GetMsg()));
  }
  return out;
}

}  // namespace strata
