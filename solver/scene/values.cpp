// Values of keys: from TOML to the member that a key leads to, and back.
#include <algorithm>
#include <cmath>

#include "scene/formula.hpp"
#include "scene/reading.hpp"

namespace strata {
namespace {

bool refuse(const Value& v, std::string_view text) {
  v.faults.push_back({v.where, fmt::format("{} = {} is {}", v.path, as_typed(v.node), text)});
  return false;
}

bool refuse_list(const Value& v, std::string_view is_not) {
  return refuse(v, fmt::format("not {}. {}", is_not, v.key.advice));
}

// The list that a value is, if it has `size` elements.
const toml::array* list_of(const Value& v, std::size_t size) {
  const toml::array* list = v.node.as_array();
  return list != nullptr && list->size() == size ? list : nullptr;
}

// Whether all elements of a list pass.
bool all(const Value& v, const auto& check) {
  bool sound = true;
  for (std::size_t k = 0; k < v.node.as_array()->size(); ++k) {
    const toml::node& node = (*v.node.as_array())[k];
    const Value element{fmt::format("{}[{}]", v.path, k), v.key, node, where_of(v.where, node.source()), v.faults};
    sound = check(element, k) && sound;
  }
  return sound;
}

bool read_number(const Value& v, const Bounds& bounds, double& member) {
  if (!v.node.is_number()) {
    const std::string unit = v.key.unit.empty() ? "." : fmt::format(", in {}: the unit stands in the key.", v.key.unit);
    return refuse(v, "not a number. Write a number without quotes" + unit);
  }
  member = v.node.is_integer() ? static_cast<double>(v.node.as_integer()->get()) : v.node.as_floating_point()->get();
  if (!std::isfinite(member)) return refuse(v, "not finite. Write a finite number.");
  const char* space = v.key.advice.empty() ? "" : " ";
  return bounds.contain(member) || refuse(v, fmt::format("outside {}.{}{}", to_text(bounds), space, v.key.advice));
}

// A number stands for the formula that is it.
bool read_formula(const Value& v, std::string& member) {
  if (v.node.is_number()) {
    double number = 0.0;
    const bool sound = read_number(v, {}, number);
    member = number_text(number);
    return sound;
  }
  if (!v.node.is_string()) return refuse(v, "not a formula. Put it in quotes.");
  member = v.node.as_string()->get();
  const auto wrong = fault_in_formula(member, split(v.key.allowed, ", "));
  return !wrong || refuse(v, "not a formula: " + *wrong);
}

}  // namespace

bool read(const Value& v, double& member) {
  if (v.key.kind == Key::Kind::integer && v.node.is_floating_point()) return refuse(v, "no integer.");
  return read_number(v, v.key.bounds, member);
}

bool read(const Value& v, int& member) {
  const auto* integer = v.node.as_integer();
  const auto allowed = split(v.key.allowed, ", ");
  if (integer == nullptr || std::ranges::find(allowed, std::to_string(integer->get())) == allowed.end())
    return refuse(v, fmt::format("not allowed. Use one of {}.", v.key.allowed));
  member = static_cast<int>(integer->get());
  return true;
}

bool read_word(const Value& v, std::string_view words, int& member) {
  const auto allowed = split(v.key.allowed, ", "), all_words = split(words, ", ");
  const auto* text = v.node.as_string();
  if (text == nullptr || std::ranges::find(allowed, text->get()) == allowed.end()) {
    // "implicit" is near "explicit": where all words are shown, only what cannot be another word is taken for one.
    const std::string meant = text == nullptr ? "" : did_you_mean(text->get(), allowed, 1.0);
    return refuse(v, fmt::format("not {}. Use one of \"{}\".{}", text == nullptr ? "a word" : "allowed",
                                 fmt::join(allowed, "\", \""), meant));
  }
  member = static_cast<int>(std::ranges::find(all_words, text->get()) - all_words.begin());
  return true;
}

bool read(const Value& v, std::string& member) {
  if (v.key.kind == Key::Kind::formula) return read_formula(v, member);
  if (!v.node.is_string()) return refuse(v, "not text. Put it in quotes.");
  member = v.node.as_string()->get();
  return true;
}

bool read(const Value& v, bool& member) {
  if (!v.node.is_boolean()) return refuse(v, "neither true nor false.");
  member = v.node.as_boolean()->get();
  return true;
}

bool read(const Value& v, Field& member) {
  if (v.node.is_number()) return read_number(v, {}, member.number);
  if (!v.node.is_string()) return refuse(v, "neither a number nor a formula in quotes.");
  return read_formula(v, member.formula);
}

bool read(const Value& v, Formulas& member) {
  if (list_of(v, 2) == nullptr) return refuse(v, "not a pair of formulas. Write [\"x component\", \"y component\"].");
  return all(v, [&](const Value& formula, std::size_t k) { return read(formula, member[k]); });
}

bool read(const Value& v, Path& member) {
  const toml::array* pairs = v.node.as_array();
  if (pairs == nullptr || pairs->size() < 2)
    return refuse_list(v, v.key.name() == "table" ? "a list of at least two rows" : "a list of at least two points");
  member.resize(pairs->size());
  return all(v, [&](const Value& pair, std::size_t k) {
    const toml::array* both = list_of(pair, 2);
    if (both == nullptr || both->front().is_array()) return refuse_list(pair, "a pair of numbers");
    return all(pair, [&](const Value& x, std::size_t axis) { return read_number(x, {}, member[k][axis]); });
  });
}

bool read(const Value& v, std::vector<Layer>& member) {
  const toml::array* tables = v.node.as_array();
  if (tables == nullptr || tables->empty()) return refuse_list(v, "a list of tables");
  member.assign(tables->size(), {});
  return all(v, [](const Value& layer, std::size_t) { return layer.node.is_table() || refuse_list(layer, "a table"); });
}

bool read(const Value& v, std::vector<InterfacePlace>& member) {
  if (!v.node.is_array()) return refuse_list(v, "a list of names");
  member.assign(v.node.as_array()->size(), {});
  return all(v, [](const Value& name, std::size_t) {
    return name.node.is_string() || name.node.is_table() || refuse_list(name, "a name");
  });
}

std::string text_of(Scene&, const std::string& member) {
  return as_one_line(toml::value<std::string>(member));
}

std::string text_of(Scene& scene, const std::vector<InterfacePlace>& member) {
  std::vector<std::string> texts;
  for (std::size_t k = 0; k < member.size(); ++k) {
    const bool ends = member[k].from_m || member[k].to_m;
    const auto keys = lines_of("strata.interfaces[].", scene, k);
    texts.push_back(ends ? fmt::format("{{{}}}", fmt::join(keys, ", "))
                         : text_of(scene, scene.laws[member[k].law].name));
  }
  return fmt::format("[{}]", fmt::join(texts, ", "));
}

std::string text_of(Scene& scene, const std::vector<Layer>& member) {
  std::string text = "[\n";
  for (std::size_t k = 0; k < member.size(); ++k)
    text += fmt::format("  {{{}}},\n", fmt::join(lines_of("strata.layers[].", scene, k), ", "));
  return text + "]";
}

}  // namespace strata
