// strata-reference [NAME [--set key=value]...]: analytic and semi-analytic values as JSON; without a name, the list.
#include <CLI/CLI.hpp>
#include <exception>
#include <iostream>
#include <nlohmann/json.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "catalogue.hpp"

namespace {

using strata::reference::Answer;
using strata::reference::Entry;
using strata::reference::Inputs;
using strata::reference::InputValue;
using Json = nlohmann::ordered_json;

Json to_json(const InputValue& value) {
  return std::visit([](const auto& content) { return Json(content); }, value);
}

Json listing() {
  Json list = Json::array();
  for (const Entry& entry : strata::reference::catalogue()) {
    Json inputs = Json::object();
    for (const auto& input : entry.inputs) {
      inputs[input.key] = {{"default", to_json(input.standard)}, {"help", input.help}};
      if (!input.choices.empty()) inputs[input.key]["choices"] = input.choices;
    }
    list.push_back({{"name", entry.name}, {"description", entry.description}, {"inputs", inputs}});
  }
  return list;
}

Json solution(const Entry& entry, const Inputs& inputs) {
  const Answer answer = strata::reference::solved(entry, inputs);
  Json values = Json::object();
  for (const auto& value : answer.values) values[value.name] = {{"value", to_json(value.value)}, {"unit", value.unit}};
  Json used = Json::object();
  for (const auto& input : entry.inputs) used[input.key] = to_json(inputs[input.key]);
  return {{"name", entry.name},
          {"values", values},
          {"inputs", used},
          {"source", entry.source},
          {"validity", entry.validity},
          {"error_estimate", {{"relative", answer.relative_error}, {"basis", answer.error_basis}}}};
}

}  // namespace

int main(int argc, char** argv) try {
  CLI::App app{"Analytic and semi-analytic reference values as JSON. Without a NAME: the list of them.",
               "strata-reference"};
  std::string name;
  std::vector<std::string> settings;
  app.add_option("NAME", name, "which solution");
  // Each --set takes one value as it stands, so that lists may hold commas.
  app.add_option("--set", settings, "key=value, any number of times; a list as 1,2,3 or @file with a number a line")
      ->expected(1)
      ->take_all()
      ->allow_extra_args(false)
      ->needs("NAME");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& problem) {
    return app.exit(problem) == 0 ? 0 : 2;
  }
  try {
    if (name.empty()) {
      std::cout << listing().dump(2) << '\n';
      return 0;
    }
    const Entry entry = strata::reference::find_entry(name);
    const Inputs inputs = strata::reference::read_inputs(entry, settings);
    std::cout << solution(entry, inputs).dump(2) << '\n';
    return 0;
  } catch (const std::invalid_argument& problem) {
    std::cerr << problem.what() << '\n';
    return 2;
  } catch (const std::exception& problem) {
    std::cerr << "numerics failed: " << problem.what() << '\n';
    return 3;
  }
} catch (const std::exception& problem) {
  std::cerr << "a bug: " << problem.what() << '\n';
  return 1;
}
