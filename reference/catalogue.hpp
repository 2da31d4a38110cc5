// The reference solutions by name, as the command line offers them: inputs with defaults and bounds, and the answers.
// Defaults are the study's (stiff rock, initial crack, its fluid); SI throughout, the unit in the key.
#pragma once

#include <functional>
#include <limits>
#include <map>
#include <numbers>
#include <set>
#include <string>
#include <variant>
#include <vector>

#include "griffith.hpp"
#include "rock.hpp"

namespace strata::reference {

constexpr double kDegrees = 180 / std::numbers::pi;  // in a radian

// A number, a list of numbers, or a word.
using InputValue = std::variant<double, std::vector<double>, std::string>;

// One input of a solution. One that takes a list takes a single number too, and its answers are then numbers.
struct Input {
  std::string key;
  std::string help;
  InputValue standard;  // its default
  bool takes_list = false;
  double least = -std::numeric_limits<double>::infinity();
  double most = std::numeric_limits<double>::infinity();
  bool least_excluded = false;
  bool most_excluded = false;
  std::vector<std::string> choices = {};  // of a word
};

// The values of all inputs of one call.
class Inputs {
 public:
  double number(const std::string& key) const { return std::get<double>(values_.at(key)); }
  const std::string& word(const std::string& key) const { return std::get<std::string>(values_.at(key)); }
  // A whole number. Throws std::invalid_argument for another.
  int count(const std::string& key) const;
  // The numbers of a list; one for a single number.
  std::vector<double> numbers(const std::string& key) const;
  const InputValue& operator[](const std::string& key) const { return values_.at(key); }
  void set(const std::string& key, InputValue value) { values_[key] = std::move(value); }
  // As set, for what is asked for rather than a default; and whether `key` was.
  void give(const std::string& key, InputValue value) {
    set(key, std::move(value));
    given_.insert(key);
  }
  bool given(const std::string& key) const { return given_.contains(key); }

 private:
  std::map<std::string, InputValue> values_;
  std::set<std::string> given_;
};

struct Value {
  std::string name;
  InputValue value;
  std::string unit;
};

struct Answer {
  std::vector<Value> values;
  double relative_error = 0.0;  // the solution's own estimate
  std::string error_basis;      // where the estimate comes from, and relative to what
};

struct Entry {
  std::string name;
  std::string description;
  std::vector<Input> inputs;
  std::string source;
  std::string validity;
  std::function<Answer(const Inputs&)> solve;
};

// All solutions, in the order in which they are listed.
std::vector<Entry> catalogue();

// The entry called `name`. Throws std::invalid_argument, with the nearest name, if there is none.
Entry find_entry(const std::string& name);

// The entry's defaults changed by settings "key=value"; a list is written 1,2,3 or [1, 2, 3], or @path for the numbers
// of a file, one a line, where '#' begins a comment (such a list's answers are a list even if it holds one number).
// Throws std::invalid_argument whose text lists every problem of every setting, a line each.
Inputs read_inputs(const Entry& entry, const std::vector<std::string>& settings);

// The entry's answer to the inputs. Throws as its solve, and std::runtime_error if a value is not finite.
Answer solved(const Entry& entry, const Inputs& inputs);

// f at every number of input `key`: a list if the input is one, else a number.
InputValue at_each(const Inputs& inputs, const std::string& key, const std::function<double(double)>& f);

// Inputs that several entries share.
Input number_input(std::string key, std::string help, double standard, double least, double most);
Input positive_input(std::string key, std::string help, double standard);
Input word_input(std::string key, std::string help, std::vector<std::string> choices);  // the first is the default
Input list_input(std::string key, std::string help, InputValue standard);

// Inputs of a rock, keys with a prefix: E > 0 (or >= 0 where may_vanish) and nu in [0, 0.5); and the rock they give.
std::vector<Input> rock_inputs(const std::string& prefix, double youngs_modulus, bool may_vanish = false);
Rock rock_of(const Inputs& inputs, const std::string& prefix);

// Inputs of a crack's net pressure, "uniform", "linear" or "profile"; and the knots they give for its half_length_m.
std::vector<Input> pressure_inputs();
PressureKnots knots_of(const Inputs& inputs);

std::vector<Input> joined(std::vector<Input> first, const std::vector<Input>& second);

// Parts of the catalogue, a file each.
std::vector<Entry> block_entries();
std::vector<Entry> crack_entries();
std::vector<Entry> flow_entries();
std::vector<Entry> interface_entries();
std::vector<Entry> motion_entries();
std::vector<Entry> path_entries();
std::vector<Entry> wave_entries();
std::vector<Entry> laminate_entries();
std::vector<Entry> height_entries();

}  // namespace strata::reference
