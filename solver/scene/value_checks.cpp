// Is a value one that its key may take? A function for each type of key.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "scene/absent_keys.hpp"
#include "scene/entries.hpp"
#include "scene/formula.hpp"
#include "scene/spelling.hpp"
#include "scene/typed_number.hpp"

namespace strata {
namespace {

std::vector<std::string> words_of(const Key& key) {
  std::vector<std::string> words;
  for (const Word& word : key.words) words.push_back(word.text);
  return words;
}

std::string list_of_words(const Key& key) {
  return fmt::format("\"{}\"", fmt::join(words_of(key), "\", \""));
}

bool fault(Faults& faults, const Where& where, std::string text) {
  faults.add(where, std::move(text));
  return false;
}

// What to write in place of a value that is no number.
std::string advice_on_no_number(const std::string& path, const Key& key, const toml::node& value) {
  const auto* text = value.as_string();
  const auto typed = text != nullptr ? advice_on_number(text->get(), &key.unit) : std::nullopt;
  const std::string usual = text != nullptr ? " Write a number without quotes." : " Write a number.";
  return typed.value_or(usual) + std::string(path.starts_with("in_situ.") ? note_on_table(path) : "");
}

bool check_number(const std::string& path, const Key& key, const toml::node& value, const Where& where,
                  Faults& faults) {
  const std::string typed = path + " = " + as_typed(value);
  if (!value.is_number())
    return fault(faults, where, typed + " is not a number." + advice_on_no_number(path, key, value));
  const double number =
      value.is_integer() ? static_cast<double>(value.as_integer()->get()) : value.as_floating_point()->get();
  if (!std::isfinite(number)) return fault(faults, where, typed + " is not finite. Write a finite number.");
  const Bounds& b = key.bounds;
  const bool inside =
      (b.low_open ? number > b.low : number >= b.low) && (b.high_open ? number < b.high : number <= b.high);
  if (inside) return true;
  const std::string advice = key.advice.empty() ? "" : ' ' + key.advice;
  return fault(faults, where, fmt::format("{} is outside {}.{}", typed, to_text(b), advice));
}

bool check_integer(const std::string& path, const Key& key, const toml::node& value, const Where& where,
                   Faults& faults) {
  const auto* integer = value.as_integer();
  if (integer != nullptr && std::ranges::find(key.allowed, integer->get()) != key.allowed.end()) return true;
  return fault(
      faults, where,
      fmt::format("{} = {} is not allowed. Use one of {}.", path, as_typed(value), fmt::join(key.allowed, ", ")));
}

bool check_word(const std::string& path, const Key& key, const toml::node& value, const Where& where, Faults& faults) {
  const std::string typed = path + " = " + as_typed(value);
  const auto* text = value.as_string();
  if (text == nullptr) return fault(faults, where, typed + " is not a word. Use one of " + list_of_words(key) + ".");
  const auto word = std::ranges::find(key.words, text->get(), &Word::text);
  if (word == key.words.end()) {
    const std::string meant = did_you_mean(text->get(), words_of(key));
    return fault(faults, where, typed + " is not allowed. Use one of " + list_of_words(key) + "." + meant);
  }
  return true;
}

bool check_text(const std::string& path, const toml::node& value, const Where& where, Faults& faults) {
  if (value.is_string()) return true;
  return fault(faults, where, fmt::format("{} = {} is not text. Put it in quotes.", path, as_typed(value)));
}

bool check_layer(const std::string& path, const toml::table& layer, bool is_last, const Origin& origin,
                 Faults& faults) {
  bool sound = true;
  for (const auto& [name, value] : layer) {
    const std::string text(name.str());
    const Where where = where_of(origin, name.source());
    const Key* key = find_key("strata.layers[]." + text);
    if (key == nullptr) {
      faults.add(where, fmt::format("unknown key {}.{}. A layer has rock and thickness_m.{}{}", path, text,
                                    did_you_mean(text, names_in_table("strata.layers[]")),
                                    advice_on_absent_key(path + '.' + text)));
      sound = false;
    } else if (!check_value(path + '.' + text, {key, &value, origin, where, true}, faults)) {
      sound = false;
    }
  }
  const Where where = where_of(origin, layer.source());
  if (!layer.contains("rock")) sound = fault(faults, where, path + " has no rock. Name a [rock.NAME] table.");
  if (!is_last && !layer.contains("thickness_m")) {
    sound = fault(faults, where, path + " has no thickness_m. Only the last layer may leave it out.");
  }
  return sound;
}

bool check_layers(const std::string& path, const Given& given, Faults& faults) {
  const toml::array* layers = given.value->as_array();
  if (layers == nullptr || layers->empty()) {
    return fault(faults, given.where,
                 fmt::format("{} = {} is not a list of layers. Write [{{rock = \"NAME\", thickness_m = 10}}, ..., "
                             "{{rock = \"NAME\"}}].",
                             path, as_typed(*given.value)));
  }
  bool sound = true;
  for (std::size_t k = 0; k < layers->size(); ++k) {
    const toml::node& element = (*layers)[k];
    const std::string name = fmt::format("{}[{}]", path, k);
    if (const toml::table* layer = element.as_table()) {
      sound = check_layer(name, *layer, k + 1 == layers->size(), given.origin, faults) && sound;
    } else {
      sound = fault(
          faults, where_of(given.origin, element.source()),
          fmt::format("{} = {} is not a layer. Write {{rock = \"NAME\", thickness_m = 10}}.", name, as_typed(element)));
    }
  }
  return sound;
}

bool check_names(const std::string& path, const Given& given, Faults& faults) {
  const toml::array* names = given.value->as_array();
  if (names == nullptr) {
    return fault(faults, given.where,
                 fmt::format("{} = {} is not a list of names. Write [\"NAME\", ...].", path, as_typed(*given.value)));
  }
  bool sound = true;
  for (std::size_t k = 0; k < names->size(); ++k) {
    const toml::node& name = (*names)[k];
    const Where where = where_of(given.origin, name.source());
    if (name.is_string()) continue;
    sound = fault(faults, where,
                  fmt::format("{}[{}] = {} is not a name. Write \"NAME\".{}", path, k, as_typed(name),
                              name.is_table() ? " In this version an interface has one law from edge to edge." : ""));
  }
  return sound;
}

// What to write where a path is not one line of points: several of them, brackets too many, or none around a point.
std::optional<std::string> advice_on_lines(const toml::array& points) {
  const auto is_line = [](const toml::node& node) {
    const toml::array* line = node.as_array();
    return line != nullptr && !line->empty() && line->front().is_array();
  };
  const auto lines = std::ranges::count_if(points, is_line);
  if (lines > 1)
    return fmt::format(" has {} lines of points, but a scene has one fracture. Write one line, [[x, y], [x, y]].",
                       lines);
  if (lines == 1) return " has brackets too many. Write one line of points, [[x, y], [x, y]].";
  if (!points.empty() && points.is_homogeneous() && points.front().is_number())
    return " has no brackets around its points. Write [[x, y], [x, y]].";
  return std::nullopt;
}

bool check_points(const std::string& path, const Given& given, Faults& faults) {
  const toml::array* points = given.value->as_array();
  if (points == nullptr) {
    return fault(faults, given.where,
                 fmt::format("{} = {} is not a list of points. Write [[x, y], [x, y]].", path, as_typed(*given.value)));
  }
  if (const auto advice = advice_on_lines(*points))
    return fault(faults, given.where, fmt::format("{} = {}{}", path, as_typed(*given.value), *advice));
  if (points->size() < 2) {
    return fault(faults, given.where,
                 fmt::format("{} = {} has fewer than 2 points. Write [[x, y], [x, y]].", path, as_typed(*given.value)));
  }
  Key coordinate;
  coordinate.type = KeyType::number;
  coordinate.unit = given.key->unit;
  coordinate.bounds = {-HUGE_VAL, HUGE_VAL, true, true};  // inside the block: checked where the block is known
  bool sound = true;
  for (std::size_t k = 0; k < points->size(); ++k) {
    const toml::node& element = (*points)[k];
    const Where where = where_of(given.origin, element.source());
    const std::string name = fmt::format("{}[{}]", path, k);
    const toml::array* point = element.as_array();
    if (point == nullptr || point->size() != 2) {
      const bool longer = point != nullptr && point->size() > 2;
      sound = fault(faults, where,
                    fmt::format("{} = {} is not a point. Write [x, y]{}.", name, as_typed(element),
                                longer ? ": two numbers, whose decimal sign is a point" : ""));
      continue;
    }
    for (std::size_t c = 0; c < 2; ++c) {
      sound = check_number(fmt::format("{}[{}]", name, c), coordinate, (*point)[c], where, faults) && sound;
    }
  }
  return sound;
}

bool check_formulas(const std::string& path, const Given& given, Faults& faults) {
  const toml::array* both = given.value->as_array();
  if (both == nullptr || both->size() != 2) {
    return fault(faults, given.where,
                 fmt::format("{} = {} is not a pair of formulas. Write [\"x component\", \"y component\"].", path,
                             as_typed(*given.value)));
  }
  bool sound = true;
  for (std::size_t k = 0; k < both->size(); ++k) {
    const toml::node& formula = (*both)[k];
    const Where where = where_of(given.origin, formula.source());
    const std::string name = fmt::format("{}[{}]", path, k);
    if (formula.is_number()) {
      Key number;
      number.type = KeyType::number;
      number.bounds = {-HUGE_VAL, HUGE_VAL, true, true};
      sound = check_number(name, number, formula, where, faults) && sound;
    } else if (!formula.is_string()) {
      sound = fault(faults, where, fmt::format("{} = {} is not a formula. Put it in quotes.", name, as_typed(formula)));
    } else if (const auto wrong = fault_in_formula(formula.as_string()->get(), given.key->variables)) {
      sound = fault(faults, where, fmt::format("{} = {}: {}", name, as_typed(formula), *wrong));
    }
  }
  return sound;
}

}  // namespace

bool check_value(const std::string& path, const Given& given, Faults& faults) {
  const Key& key = *given.key;
  switch (key.type) {
    case KeyType::number:
      return check_number(path, key, *given.value, given.where, faults);
    case KeyType::integer:
      return check_integer(path, key, *given.value, given.where, faults);
    case KeyType::word:
      return check_word(path, key, *given.value, given.where, faults);
    case KeyType::text:
      return check_text(path, *given.value, given.where, faults);
    case KeyType::layers:
      return check_layers(path, given, faults);
    case KeyType::names:
      return check_names(path, given, faults);
    case KeyType::points:
      return check_points(path, given, faults);
    case KeyType::formulas:
      return check_formulas(path, given, faults);
    case KeyType::anything:
      break;
  }
  return true;
}

void check_claims(const toml::node& claims, const Origin& origin, Faults& faults) {
  const toml::array* list = claims.as_array();
  if (list == nullptr || !list->is_homogeneous(toml::node_type::table)) {
    faults.add(where_of(origin, claims.source()), "claim is not a list of tables. Write [[claim]] above each.");
    return;
  }
  for (std::size_t k = 0; k < list->size(); ++k) {
    const toml::table& claim = *(*list)[k].as_table();
    const std::string path = fmt::format("claim[{}]", k);
    for (const std::string& name : names_in_table("claim[]")) {
      const auto found = claim.find(name);
      if (found == claim.end()) {
        faults.add(where_of(origin, claim.source()), fmt::format("{} has no {}.", path, name));
      } else {
        check_text(path + '.' + name, found->second, where_of(origin, found->first.source()), faults);
      }
    }
  }
}

}  // namespace strata
