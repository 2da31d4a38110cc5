// Is a value one that its key may take, and what a scene holds for it: by the type of the member that the key leads to.
#include <algorithm>
#include <cmath>

#include "scene/entries.hpp"
#include "scene/formula.hpp"
#include "scene/syntax.hpp"

namespace strata {
namespace {

// A value, or an element of one, and the path that messages have for it.
struct Value {
  std::string path;
  const Key& key;
  const toml::node& node;
  const Origin& origin;
  Where where;
  Faults& faults;

  std::string typed() const { return path + " = " + as_typed(node); }

  bool refuse(const std::string& text) const {
    faults.add(where, typed() + text);
    return false;
  }

  Value element(std::size_t k, const toml::node& element) const {
    return {fmt::format("{}[{}]", path, k), key, element, origin, where_of(origin, element.source()), faults};
  }

  // Whether all elements of the list pass.
  template <class Check>
  bool all(const Check& check) const {
    bool sound = true;
    const toml::array& list = *node.as_array();
    for (std::size_t k = 0; k < list.size(); ++k) sound = check(element(k, list[k])) && sound;
    return sound;
  }
};

bool check_number(const Value& v, const Bounds& bounds) {
  if (!v.node.is_number()) {
    const auto* text = v.node.as_string();
    const auto typed = text != nullptr ? advice_on_number(text->get(), &v.key.unit) : std::nullopt;
    const std::string usual = text != nullptr ? " Write a number without quotes." : " Write a number.";
    return v.refuse(fmt::format(" is not a number.{}{}", typed.value_or(usual),
                                v.path.starts_with("in_situ.") ? note_on_table(v.path) : ""));
  }
  const double number = as_number(v.node);
  if (!std::isfinite(number)) return v.refuse(" is not finite. Write a finite number.");
  if (bounds.contain(number)) return true;
  return v.refuse(fmt::format(" is outside {}.{}{}", to_text(bounds), v.key.advice.empty() ? "" : " ", v.key.advice));
}

bool check_text(const Value& v) {
  return v.node.is_string() || v.refuse(" is not text. Put it in quotes.");
}

bool check_integer(const Value& v) {
  const auto* integer = v.node.as_integer();
  const auto& allowed = v.key.allowed;
  if (integer != nullptr && std::ranges::find(allowed, std::to_string(integer->get())) != allowed.end()) return true;
  return v.refuse(fmt::format(" is not allowed. Use one of {}.", fmt::join(allowed, ", ")));
}

bool check_word(const Value& v) {
  const auto& allowed = v.key.allowed;
  const auto* text = v.node.as_string();
  if (text != nullptr && std::ranges::find(allowed, text->get()) != allowed.end()) return true;
  return v.refuse(fmt::format(" is not {}. Use one of \"{}\".{}", text == nullptr ? "a word" : "allowed",
                              fmt::join(allowed, "\", \""), text == nullptr ? "" : did_you_mean(text->get(), allowed)));
}

bool check_layer(const Value& v, bool is_last) {
  const toml::table* layer = v.node.as_table();
  if (layer == nullptr) return v.refuse(" is not a layer. Write {rock = \"NAME\", thickness_m = 10}.");
  bool sound = true;
  const auto refuse = [&](const Where& where, const std::string& text) {
    v.faults.add(where, text);
    sound = false;
  };
  for (const auto& [name, value] : *layer) {
    const std::string text(name.str()), path = v.path + '.' + text;
    const Where where = where_of(v.origin, name.source());
    const Key* key = find_key("strata.layers[]." + text);
    if (key == nullptr) {
      refuse(where, fmt::format("unknown key {}. A layer has rock and thickness_m.{}{}", path,
                                did_you_mean(text, names_in_table("strata.layers[]")), advice_on_absent_key(path)));
    } else {
      sound = check_value(path, {key, &value, v.origin, where}, v.faults) && sound;
    }
  }
  if (!layer->contains("rock")) refuse(v.where, v.path + " has no rock. Name a [rock.NAME] table.");
  if (!is_last && !layer->contains("thickness_m"))
    refuse(v.where, v.path + " has no thickness_m. Only the last layer may leave it out.");
  return sound;
}

bool check_layers(const Value& v) {
  const toml::array* layers = v.node.as_array();
  if (layers == nullptr || layers->empty()) {
    return v.refuse(" is not a list of layers. Write [{rock = \"NAME\", thickness_m = 10}, ..., {rock = \"NAME\"}].");
  }
  return v.all([&](const Value& layer) { return check_layer(layer, &layer.node == &layers->back()); });
}

bool check_names(const Value& v) {
  if (!v.node.is_array()) return v.refuse(" is not a list of names. Write [\"NAME\", ...].");
  return v.all([](const Value& name) {
    if (name.node.is_string()) return true;
    const bool table = name.node.is_table();
    return name.refuse(std::string(" is not a name. Write \"NAME\".") +
                       (table ? " In this version an interface has one law from edge to edge." : ""));
  });
}

bool check_point(const Value& v) {
  const toml::array* point = v.node.as_array();
  if (point == nullptr || point->size() != 2) {
    const bool longer = point != nullptr && point->size() > 2;
    return v.refuse(std::string(" is not a point. Write [x, y]") +
                    (longer ? ": two numbers, whose decimal sign is a point." : "."));
  }
  return v.all([&](Value coordinate) {
    coordinate.where = v.where;
    return check_number(coordinate, {});  // inside the block: checked where the block is known
  });
}

bool check_points(const Value& v) {
  const std::string write = " Write [[x, y], [x, y]].";
  const toml::array* points = v.node.as_array();
  if (points == nullptr) return v.refuse(" is not a list of points." + write);
  const auto lines = std::ranges::count_if(*points, [](const toml::node& node) {
    const toml::array* line = node.as_array();
    return line != nullptr && !line->empty() && line->front().is_array();
  });
  if (lines > 1) {
    return v.refuse(
        fmt::format(" has {} lines of points, but a scene has one fracture. Write one line, [[x, y], [x, y]].", lines));
  }
  if (lines == 1) return v.refuse(" has brackets too many. Write one line of points, [[x, y], [x, y]].");
  if (!points->empty() && points->is_homogeneous() && points->front().is_number())
    return v.refuse(" has no brackets around its points." + write);
  if (points->size() < 2) return v.refuse(" has fewer than 2 points." + write);
  return v.all(check_point);
}

bool check_formulas(const Value& v) {
  const toml::array* both = v.node.as_array();
  if (both == nullptr || both->size() != 2)
    return v.refuse(" is not a pair of formulas. Write [\"x component\", \"y component\"].");
  return v.all([](const Value& formula) {
    if (formula.node.is_number()) return check_number(formula, {});
    if (!formula.node.is_string()) return formula.refuse(" is not a formula. Put it in quotes.");
    const auto wrong = fault_in_formula(formula.node.as_string()->get(), formula.key.allowed);
    return !wrong || formula.refuse(": " + *wrong);
  });
}

// A check for each type of member.
struct Check {
  const Value& v;
  bool operator()(Way<double>) const { return check_number(v, v.key.bounds); }
  bool operator()(Way<std::optional<double>>) const { return check_number(v, v.key.bounds); }
  bool operator()(Way<int>) const { return check_integer(v); }
  bool operator()(const WordWay&) const { return check_word(v); }
  bool operator()(Way<std::string>) const { return check_text(v); }
  bool operator()(Way<std::optional<Formulas>>) const { return check_formulas(v); }
  bool operator()(Way<std::vector<Layer>>) const { return check_layers(v); }
  bool operator()(Way<std::vector<InterfacePlace>>) const { return check_names(v); }
  bool operator()(Way<Path>) const { return check_points(v); }
};

// A number stands for the formula that is it.
std::string formula_text(const toml::node& node) {
  return node.is_string() ? node.as_string()->get() : number_text(as_number(node));
}

// And what is written.
struct Apply {
  const Given& given;
  std::size_t index;
  Scene& scene;
  void operator()(Way<double> at) const { at(scene, index) = as_number(*given.value); }
  void operator()(Way<std::optional<double>> at) const { at(scene, index) = as_number(*given.value); }
  void operator()(Way<int> at) const { at(scene, index) = static_cast<int>(given.value->as_integer()->get()); }
  void operator()(const WordWay& at) const {
    const auto words = split(at.words, ", ");
    const auto word = std::ranges::find(words, given.value->as_string()->get());
    at.set(scene, index, static_cast<int>(word - words.begin()));
  }
  void operator()(Way<std::string> at) const { at(scene, index) = given.value->as_string()->get(); }
  void operator()(Way<std::optional<Formulas>> at) const {
    const toml::array& both = *given.value->as_array();
    at(scene, index) = Formulas{formula_text(both[0]), formula_text(both[1])};
  }
  void operator()(Way<Path> at) const {
    for (const toml::node& node : *given.value->as_array()) {
      const toml::array& point = *node.as_array();
      at(scene, index).push_back({as_number(point[0]), as_number(point[1])});
    }
  }
  void operator()(Way<std::vector<Layer>>) const {}
  void operator()(Way<std::vector<InterfacePlace>>) const {}
};

}  // namespace

bool check_value(const std::string& path, const Given& given, Faults& faults) {
  return std::visit(Check{{path, *given.key, *given.value, given.origin, given.where, faults}}, given.key->place);
}

void apply_value(const Given& given, std::size_t index, Scene& scene) {
  if (given.sound) std::visit(Apply{given, index, scene}, given.key->place);
}

void check_claims(const toml::node& claims, const Origin& origin, Faults& faults) {
  const toml::array* list = claims.as_array();
  if (list == nullptr || !list->is_homogeneous(toml::node_type::table)) {
    faults.add(where_of(origin, claims.source()), "claim is not a list of tables. Write [[claim]] above each.");
    return;
  }
  for (std::size_t k = 0; k < list->size(); ++k) {
    const toml::table& claim = *(*list)[k].as_table();
    for (const std::string& name : names_in_table("claim[]")) {
      const auto found = claim.find(name);
      if (found == claim.end()) {
        faults.add(where_of(origin, claim.source()), "claim[{}] has no {}.", k, name);
      } else {
        check_value(fmt::format("claim[{}].{}", k, name),
                    {find_key("claim[]." + name), &found->second, origin, where_of(origin, found->first.source())},
                    faults);
      }
    }
  }
}

}  // namespace strata
