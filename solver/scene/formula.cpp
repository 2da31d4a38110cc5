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

// A parser that knows the variables, each bound to a place in `values`, pi and muParser's functions, and nothing else.
mu::Parser parser_of(const std::string& text, const std::vector<std::string>& variables, std::vector<double>& values) {
  mu::Parser parser;
  parser.ClearConst();
  parser.DefineConst("pi", std::numbers::pi);
  for (std::size_t k = 0; k < variables.size(); ++k) parser.DefineVar(variables[k], &values[k]);
  parser.SetExpr(text);
  return parser;
}

// muParser lets a formula assign to a variable; position of such a sign, or npos.
std::size_t assignment_in(const std::string& text) {
  for (std::size_t k = text.find('='); k != std::string::npos; k = text.find('=', k + 1)) {
    if (k + 1 < text.size() && text[k + 1] == '=') {
      ++k;
    } else if (k == 0 || (text[k - 1] != '<' && text[k - 1] != '>' && text[k - 1] != '!')) {
      return k;
    }
  }
  return std::string::npos;
}

// The known name that was meant by one that is not. A single letter is another one's slip only in another case.
std::string meant(const std::string& name, std::vector<std::string> known) {
  for (const char* other : {"pi", "sin", "cos", "tan", "exp", "sqrt", "abs", "min", "max"}) known.emplace_back(other);
  if (name.size() == 1)
    std::erase_if(known,
                  [&](const std::string& other) { return other.size() > 1 || edit_distance(name, other) >= 1.0; });
  return did_you_mean(name, known);
}

std::string message_of(const mu::Parser::exception_type& error, const std::string& text,
                       const std::vector<std::string>& variables) {
  const int at = std::min(error.GetPos(), static_cast<int>(text.size())) + 1;
  if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN) {
    return fmt::format(
        "there is no {} at character {}. A formula may use {}, pi, + - * / ^, a comparison ? : and functions such as "
        "sin, exp, sqrt.{}",
        error.GetToken(), at, fmt::join(variables, ", "), meant(error.GetToken(), variables));
  }
  if (error.GetCode() == mu::ecEXPRESSION_TOO_LONG)
    return fmt::format("its {} characters are too many. Shorten it.", text.size());
  std::string what = error.GetMsg();
  what.resize(std::min({what.size(), what.find(" at position"), what.find_last_not_of('.') + 1}));
  return at >= 1 ? fmt::format("at character {}: {}.", at, what) : what + '.';
}

}  // namespace

std::optional<std::string> fault_in_formula(const std::string& text, const std::vector<std::string>& variables) {
  if (text.find_first_not_of(" \t") == std::string::npos) return "it is empty. Write 0 for nothing.";
  const std::size_t assignment = assignment_in(text);
  if (assignment != std::string::npos)
    return fmt::format("at character {}: a formula assigns nothing. Use == to compare.", assignment + 1);
  std::vector<double> values(variables.size(), 0.5);
  try {
    mu::Parser parser = parser_of(text, variables, values);
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
  std::vector<std::string> names;
  for (const FormulaVariable& variable : variables) names.push_back(variable.name);
  std::vector<double> at(variables.size(), 0.0);
  std::vector<double> out(variables.empty() ? 1 : variables.front().values.size());
  try {
    mu::Parser parser = parser_of(text, names, at);
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
