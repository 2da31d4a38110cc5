// The schema of a scene: each key is declared once, in key_list.cpp, with the member of scene.hpp that it leads to.
// Reading, checks, defaults, suggestions, the resolved scene and the table printed by `strata keys` all follow from it.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

#include "scene/messages.hpp"
#include "scene/scene.hpp"

namespace strata {

struct Value;  // a key's value in TOML, see reading.hpp

/// Whether a value is one that its key and the type of the member allow; it is then written to the member, and what is
/// wrong with it is a fault otherwise. Of layers and interfaces, which name others, only the number is written.
bool read(const Value& value, double& member);
bool read(const Value& value, int& member);
bool read(const Value& value, std::string& member);  // text or, by the key, a formula
bool read(const Value& value, bool& member);
bool read(const Value& value, Field& member);
bool read(const Value& value, Formulas& member);
bool read(const Value& value, Path& member);  // pairs of numbers
bool read(const Value& value, std::vector<Layer>& member);
bool read(const Value& value, std::vector<InterfacePlace>& member);
/// The same of one of the key's words; member: its number in `words`.
bool read_word(const Value& value, std::string_view words, int& member);

/// Text as TOML; layers, and interfaces, in a list.
std::string text_of(Scene& scene, const std::string& member);
std::string text_of(Scene& scene, const std::vector<Layer>& member);
std::string text_of(Scene& scene, const std::vector<InterfacePlace>& member);

/// The word of an enumeration's value, "weak".
std::string word_of(auto value) {
  return split(words(value), ", ")[static_cast<std::size_t>(value)];
}

template <class Type>
bool read(const Value& value, std::optional<Type>& member) {
  return read(value, member.emplace()) || (member.reset(), false);
}
template <class Enum>
requires std::is_enum_v<Enum>
bool read(const Value& value, Enum& member) {
  int number = 0;
  if (!read_word(value, words(member), number)) return false;
  member = static_cast<Enum>(number);
  return true;
}
/// A member as TOML, doubles to the last digit; "" where an optional one is absent.
template <class Type>
std::string text_of(Scene& scene, const Type& member) {
  if constexpr (std::is_enum_v<Type>) {
    return '"' + word_of(member) + '"';
  } else if constexpr (std::is_same_v<Type, double>) {
    return number_text(member);
  } else if constexpr (std::is_arithmetic_v<Type>) {
    return fmt::format("{}", member);
  } else if constexpr (std::is_same_v<Type, Field>) {
    return member.formula.empty() ? number_text(member.number) : text_of(scene, member.formula);
  } else if constexpr (requires { member.has_value(); }) {
    return member ? text_of(scene, *member) : std::string();
  } else {
    std::vector<std::string> texts;
    for (const auto& element : member) texts.push_back(text_of(scene, element));
    return fmt::format("[{}]", fmt::join(texts, ", "));
  }
}

// object.first.second...; of a list the element at `index`, of an optional what it holds.
template <auto first, auto... rest>
auto& reach(auto& object, std::size_t index) {
  auto& member = object.*first;
  if constexpr (sizeof...(rest) == 0) {
    return member;
  } else if constexpr (requires { member[index]; }) {
    return reach<rest...>(member[index], index);
  } else if constexpr (requires { *member; }) {
    return reach<rest...>(*member, index);
  } else {
    return reach<rest...>(member, index);
  }
}

// How the member that a key leads to is read and written; index: of the rock, law or element of a list, else 0.
struct Member {
  bool (*read)(const Value&, Scene&, std::size_t index);
  std::string (*text)(Scene&, std::size_t index);
  std::string_view words = {};  // of an enumeration or a truth
};

// The member scene.first.second..., by pointers to members.
template <auto... members>
constexpr Member at = [] {
  using Type = std::remove_reference_t<decltype(reach<members...>(std::declval<Scene&>(), 0))>;
  Member member{[](const Value& value, Scene& s, std::size_t k) { return read(value, reach<members...>(s, k)); },
                [](Scene& s, std::size_t k) { return text_of(s, reach<members...>(s, k)); }};
  if constexpr (std::is_enum_v<Type>) member.words = words(Type{});
  if constexpr (std::is_same_v<Type, bool>) member.words = "true, false";
  return member;
}();

// Of a key that is checked and has no member.
template <class Type>
constexpr Member nowhere{[](const Value& value, Scene&, std::size_t) {
                           Type none{};
                           return read(value, none);
                         },
                         [](Scene&, std::size_t) { return std::string(); }};

struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = true;
  bool high_open = true;

  bool contain(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
};

struct Key {
  enum class Kind { number, integer, word, text, formula, list };
  Kind kind;
  std::string_view path;  // "rock.NAME.poisson_ratio": NAME is any name, "strata.layers[].rock" is in each element
  Member member;
  std::string_view help;
  std::string_view unit = {};     // "": none
  Bounds bounds = {};             // of numbers
  std::string_view allowed = {};  // "a, b": words, integers, or the variables of formulas
  std::string_view advice = {};   // what to do where the value is out of bounds, or no such list
  std::string_view law = {};      // the interface law or laws that the key belongs to; "": any
  bool required = false;

  constexpr std::string_view table() const { return path.substr(0, path.find_last_of('.') + 1); }  // with the dot
  constexpr std::string_view name() const { return path.substr(path.rfind('.') + 1); }
  constexpr bool in_list() const { return path.find('[') != path.npos; }

  // Whether it says how strong an interface is: none of one that has a toughness instead.
  constexpr bool of_strength() const {
    return name() == "shear_strength_Pa" || name() == "tensile_strength_Pa" || name() == "failure_length_m";
  }

  // Whether the key is one of an interface with this law.
  bool is_of(std::string_view name) const { return law.empty() || (!name.empty() && law.find(name) != law.npos); }
};

/// All keys, in the order in which a scene is written.
std::span<const Key> scene_keys();

/// A scene with one element of each list, into which all keys lead.
Scene scene_of_one();

/// A path as the keys have it: "rock.NAME.poisson_ratio" of "rock.stiff.poisson_ratio", "strata.layers[].rock" of
/// "strata.layers[1].rock".
std::string pattern_of(std::string_view path);

/// The key of which `path` is an instance, or nullptr.
const Key* find_key(std::string_view path);

/// The names that may stand in the table `path` ("" for the top level, NAME for any name); none where it is no table of
/// keys.
std::vector<std::string> names_in_table(std::string_view path);

/// What is wrong with the unknown key `path`, with the nearest known one: "unknown key fluid.viscosty_Pa_s. Did you
/// mean viscosity_Pa_s?".
std::string unknown_key_message(std::string_view path);

/// "[0, 0.5)", as in messages and help.
std::string to_text(const Bounds& bounds);

/// "name = value" of each key of a table ("rock.NAME.", "strata.layers[].") that is in force.
std::vector<std::string> lines_of(std::string_view table, Scene& scene, std::size_t index);

/// What a key's value may be: bounds, words, "list", "text" or the variables of formulas.
std::string allowed_text(const Key& key);

/// The default of a key as TOML, taken from a scene of defaults; empty where there is none.
std::string default_text(const Key& key);

/// The table of all keys in Markdown: key, unit, default, what is allowed, help.
std::string keys_as_markdown();

/// The scene as TOML, every key with its value; reading it gives the same scene. claims: [[claim]] tables as TOML, put
/// at the end.
std::string resolved_toml(Scene scene, std::string_view claims);

}  // namespace strata
