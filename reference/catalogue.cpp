#include "catalogue.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <set>
#include <sstream>
#include <stdexcept>

namespace strata::reference {
namespace {

// Levenshtein's distance between two words.
std::size_t edit_distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t changed = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({row[j] + 1, row[j - 1] + 1, changed});
    }
  }
  return row[b.size()];
}

// " Did you mean X?" for the nearest candidate, or a list of all where none is near.
std::string suggestion(const std::string& word, const std::vector<std::string>& candidates) {
  const auto nearest = std::min_element(candidates.begin(), candidates.end(), [&](const auto& a, const auto& b) {
    return edit_distance(word, a) < edit_distance(word, b);
  });
  if (nearest != candidates.end() && edit_distance(word, *nearest) <= std::max<std::size_t>(2, nearest->size() / 2))
    return " Did you mean " + *nearest + "?";
  std::string all = " Known:";
  for (const std::string& candidate : candidates) all.append(" ").append(candidate);
  return all + ".";
}

std::string trimmed(const std::string& text) {
  const auto from = text.find_first_not_of(" \t\"[");
  const auto to = text.find_last_not_of(" \t\"]");
  return from == std::string::npos ? "" : text.substr(from, to - from + 1);
}

std::string printed(double number) {
  std::ostringstream out;
  out.precision(15);
  out << number;
  return out.str();
}

std::string range_text(const Input& input) {
  std::ostringstream out;
  out.precision(15);
  out << (input.least_excluded ? '(' : '[') << input.least << ", " << input.most << (input.most_excluded ? ')' : ']');
  return out.str();
}

double read_number(const Input& input, const std::string& text) {
  const std::string word = trimmed(text);
  char* end = nullptr;
  const double number = std::strtod(word.c_str(), &end);
  if (word.empty() || *end != '\0' || !std::isfinite(number))
    throw std::invalid_argument("\"" + word + "\" is not a number.");
  const bool low = input.least_excluded ? number <= input.least : number < input.least;
  const bool high = input.most_excluded ? number >= input.most : number > input.most;
  if (low || high) throw std::invalid_argument(printed(number) + " is outside " + range_text(input) + ".");
  return number;
}

// The numbers of a file, one a line; blank lines and what follows a '#' do not count.
// Throws std::invalid_argument for a file that cannot be read or holds none, with every bad line.
std::vector<double> read_number_file(const Input& input, const std::string& path) {
  constexpr int kProblemsShown = 5;
  std::ifstream file(path);
  // A folder opens like a file but holds no line.
  if (!file || file.peek() == std::ifstream::traits_type::eof())
    throw std::invalid_argument("cannot read numbers from file \"" + path + "\" (missing, empty or not a file).");
  std::vector<double> numbers;
  std::string problems;
  int bad = 0, at = 0;
  for (std::string line; std::getline(file, line);) {
    ++at;
    if (!line.empty() && line.back() == '\r') line.pop_back();
    const std::string word = trimmed(line.substr(0, line.find('#')));
    if (word.empty()) continue;
    try {
      numbers.push_back(read_number(input, word));
    } catch (const std::invalid_argument& problem) {
      if (++bad <= kProblemsShown) problems += "\n  " + path + ":" + std::to_string(at) + ": " + problem.what();
    }
  }
  if (bad > kProblemsShown) problems += "\n  and " + std::to_string(bad - kProblemsShown) + " lines more.";
  if (bad > 0) throw std::invalid_argument("the file needs one number a line:" + problems);
  if (numbers.empty()) throw std::invalid_argument("file \"" + path + "\" holds no number.");
  return numbers;
}

InputValue read_value(const Input& input, const std::string& text) {
  if (std::holds_alternative<std::string>(input.standard)) {
    const std::string word = trimmed(text);
    if (std::find(input.choices.begin(), input.choices.end(), word) == input.choices.end())
      throw std::invalid_argument("\"" + word + "\" is not a choice." + suggestion(word, input.choices));
    return word;
  }
  if (const std::string word = trimmed(text); !word.empty() && word.front() == '@') {
    if (!input.takes_list) throw std::invalid_argument("takes one number, not a file of them.");
    return read_number_file(input, word.substr(1));
  }
  const bool many = text.find_first_of(",[") != std::string::npos;
  if (!input.takes_list || !many) return read_number(input, text);
  std::vector<double> numbers;
  std::istringstream parts(trimmed(text));
  for (std::string part; std::getline(parts, part, ',');) numbers.push_back(read_number(input, part));
  return numbers;
}

}  // namespace

int Inputs::count(const std::string& key) const {
  const double value = number(key);
  if (value != std::floor(value)) throw std::invalid_argument(key + " must be a whole number");
  return static_cast<int>(value);
}

std::vector<double> Inputs::numbers(const std::string& key) const {
  const InputValue& value = values_.at(key);
  if (const double* one = std::get_if<double>(&value)) return {*one};
  return std::get<std::vector<double>>(value);
}

std::vector<Entry> catalogue() {
  std::vector<Entry> all;
  for (auto part : {crack_entries(), block_entries(), flow_entries(), interface_entries(), path_entries(),
                    wave_entries(), motion_entries(), laminate_entries(), height_entries()})
    for (Entry& entry : part) all.push_back(std::move(entry));
  return all;
}

Entry find_entry(const std::string& name) {
  std::vector<std::string> names;
  for (const Entry& entry : catalogue()) {
    if (entry.name == name) return entry;
    names.push_back(entry.name);
  }
  throw std::invalid_argument("unknown name " + name + "." + suggestion(name, names));
}

Inputs read_inputs(const Entry& entry, const std::vector<std::string>& settings) {
  Inputs inputs;
  std::vector<std::string> keys;
  for (const Input& input : entry.inputs) {
    inputs.set(input.key, input.standard);
    keys.push_back(input.key);
  }
  std::ostringstream problems;
  std::set<std::string> seen;
  for (const std::string& setting : settings) {
    const auto complain = [&](const std::string& what) {
      problems << (problems.tellp() > 0 ? "\n" : "") << "--set " << setting << ": " << what;
    };
    const auto equals = setting.find('=');
    const std::string key = trimmed(setting.substr(0, equals));
    const auto input =
        std::find_if(entry.inputs.begin(), entry.inputs.end(), [&](const Input& i) { return i.key == key; });
    if (equals == std::string::npos) {
      complain("expected key=value.");
    } else if (input == entry.inputs.end()) {
      complain("unknown key " + key + "." + suggestion(key, keys));
    } else if (!seen.insert(key).second) {
      complain("set twice.");
    } else {
      try {
        inputs.give(key, read_value(*input, setting.substr(equals + 1)));
      } catch (const std::invalid_argument& problem) {
        complain(problem.what());
      }
    }
  }
  if (problems.tellp() > 0) throw std::invalid_argument(problems.str());
  return inputs;
}

Answer solved(const Entry& entry, const Inputs& inputs) {
  Answer answer = entry.solve(inputs);
  for (const Value& value : answer.values) {
    bool finite = true;
    if (const double* one = std::get_if<double>(&value.value)) finite = std::isfinite(*one);
    if (const auto* many = std::get_if<std::vector<double>>(&value.value))
      finite = std::all_of(many->begin(), many->end(), [](double number) { return std::isfinite(number); });
    if (!finite) throw std::runtime_error(value.name + " of " + entry.name + " is not finite for these inputs");
  }
  return answer;
}

InputValue at_each(const Inputs& inputs, const std::string& key, const std::function<double(double)>& f) {
  if (const double* one = std::get_if<double>(&inputs[key])) return f(*one);
  std::vector<double> values;
  for (double number : inputs.numbers(key)) values.push_back(f(number));
  return values;
}

Input number_input(std::string key, std::string help, double standard, double least, double most) {
  Input input{std::move(key), std::move(help), standard};
  input.least = least;
  input.most = most;
  return input;
}

Input positive_input(std::string key, std::string help, double standard) {
  Input input{std::move(key), std::move(help), standard};
  input.least = 0;
  input.least_excluded = true;
  return input;
}

Input word_input(std::string key, std::string help, std::vector<std::string> choices) {
  Input input{std::move(key), std::move(help), choices.front()};
  input.choices = std::move(choices);
  return input;
}

Input list_input(std::string key, std::string help, InputValue standard) {
  Input input{std::move(key), std::move(help), std::move(standard)};
  input.takes_list = true;
  return input;
}

std::vector<Input> rock_inputs(const std::string& prefix, double youngs_modulus, bool may_vanish) {
  Input modulus = positive_input(prefix + "youngs_modulus_Pa", "E", youngs_modulus);
  modulus.least_excluded = !may_vanish;
  Input poisson = number_input(prefix + "poisson_ratio", "nu", 0.2, 0, 0.5);
  poisson.most_excluded = true;
  return {modulus, poisson};
}

Rock rock_of(const Inputs& inputs, const std::string& prefix) {
  return {inputs.number(prefix + "youngs_modulus_Pa"), inputs.number(prefix + "poisson_ratio")};
}

std::vector<Input> pressure_inputs() {
  return {number_input("pressure_Pa", "net pressure (fluid minus closing stress), at the middle where it varies", 0.5e6,
                       -1e12, 1e12),
          word_input("pressure", "uniform, linear: falling to 0 at the tips, or the profile below",
                     {"uniform", "linear", "profile"}),
          list_input("profile_x_m", "knots of the profile from -a to a; twice the same for a jump; 0 outside",
                     std::vector<double>{-5, 0, 5}),
          list_input("profile_Pa", "net pressure at the knots, linear between", std::vector<double>{0, 0.5e6, 0})};
}

PressureKnots knots_of(const Inputs& inputs) {
  const std::string& shape = inputs.word("pressure");
  for (const char* key : {"profile_x_m", "profile_Pa"}) {
    if (shape != "profile" && inputs.given(key))
      throw std::invalid_argument(std::string(key) + " is given, but pressure=" + shape +
                                  " does not use it. Set pressure=profile or leave it out.");
  }
  const double a = inputs.number("half_length_m");
  const double p = inputs.number("pressure_Pa");
  PressureKnots knots;
  if (shape == "uniform")
    knots = {{-a, a}, {p, p}};
  else if (shape == "linear")
    knots = {{-a, 0, a}, {0, p, 0}};
  else
    knots = {inputs.numbers("profile_x_m"), inputs.numbers("profile_Pa")};
  knots.validate();
  return knots;
}

std::vector<Input> joined(std::vector<Input> first, const std::vector<Input>& second) {
  first.insert(first.end(), second.begin(), second.end());
  return first;
}

}  // namespace strata::reference
