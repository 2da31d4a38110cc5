// The schema of a scene: each key is declared once, in key_list.cpp, with the member of scene.hpp that it leads to.
// Reading, checks, defaults, suggestions, the resolved scene and the table printed by `strata keys` all follow from it.
#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <variant>
#include <vector>

#include "scene/messages.hpp"
#include "scene/scene.hpp"

namespace strata {

struct Bounds {
  double low = -std::numeric_limits<double>::infinity();
  double high = std::numeric_limits<double>::infinity();
  bool low_open = true;
  bool high_open = true;

  bool contain(double x) const { return (low_open ? x > low : x >= low) && (high_open ? x < high : x <= high); }
};

// The way from a key to its member; the second argument is the index of the rock or law, else 0. None (nullptr) for
// keys of list elements.
template <class Member>
using Way = Member& (*)(Scene&, std::size_t);
// The same to an enumeration, whose values are counted in the order of its words.
struct WordWay {
  std::string_view words;
  int (*get)(Scene&, std::size_t);
  void (*set)(Scene&, std::size_t, int);
};
using Path = std::vector<std::array<double, 2>>;
// The type of the member is that of the value.
using Place =
    std::variant<Way<double>, Way<std::optional<double>>, Way<int>, WordWay, Way<std::string>,
                 Way<std::optional<Formulas>>, Way<std::vector<Layer>>, Way<std::vector<InterfacePlace>>, Way<Path>>;

template <class Object>
Object& inside(Object& object, std::size_t) {
  return object;
}
template <class Element>
Element& inside(std::vector<Element>& list, std::size_t index) {
  return list[index];
}
inline Fracture& inside(std::optional<Fracture>& fracture, std::size_t) {
  return *fracture;
}

// object.first.second...; of a list of rocks or laws the one at `index`.
template <auto first, auto... rest>
auto& reach(auto& object, std::size_t index) {
  if constexpr (sizeof...(rest) == 0) {
    return object.*first;
  } else {
    return reach<rest...>(inside(object.*first, index), index);
  }
}

template <auto... members>
constexpr Place place_at() {
  using Member = std::remove_reference_t<decltype(reach<members...>(std::declval<Scene&>(), 0))>;
  if constexpr (std::is_enum_v<Member>) {
    return WordWay{
        words(Member{}), [](Scene& s, std::size_t index) { return static_cast<int>(reach<members...>(s, index)); },
        [](Scene& s, std::size_t index, int value) { reach<members...>(s, index) = static_cast<Member>(value); }};
  } else {
    return Way<Member>{[](Scene& s, std::size_t index) -> Member& { return reach<members...>(s, index); }};
  }
}

// Where the member scene.first.second... is, by pointers to members.
template <auto... members>
constexpr Place at = place_at<members...>();

struct Key {
  std::string_view path;  // "rock.NAME.poisson_ratio": NAME is any name, "strata.layers[].rock" is in each element
  Place place;
  std::string help;
  std::string unit{};                  // empty: none
  Bounds bounds{};                     // of numbers
  std::vector<std::string> allowed{};  // words, integers, or the variables of formulas
  std::string_view advice{};           // what to do where the value is out of bounds
  bool required = false;
  std::string_view law{};  // the interface law or laws that the key belongs to; empty: any

  template <class Type>
  bool is() const {
    return std::holds_alternative<Type>(place);
  }
  bool is_number() const { return is<Way<double>>() || is<Way<std::optional<double>>>(); }
  bool is_list() const {
    return is<Way<std::vector<Layer>>>() || is<Way<std::vector<InterfacePlace>>>() || is<Way<Path>>();
  }

  std::string_view table() const { return path.substr(0, path.rfind('.') + 1); }  // with the dot
  std::string_view name() const { return path.substr(path.rfind('.') + 1); }
  bool in_list() const { return path.find('[') != path.npos; }

  // Whether the key is one of an interface with this law.
  bool is_of(std::string_view name) const { return law.empty() || (!name.empty() && law.find(name) != law.npos); }
};

/// The word of an enumeration's value, "weak". Throws nothing but std::bad_alloc.
std::string word_of(auto value) {
  return split(words(value), ", ")[static_cast<std::size_t>(value)];
}

/// All keys, in the order in which a scene is written. Throws nothing but std::bad_alloc.
const std::vector<Key>& scene_keys();

/// The key of which `path` is an instance ("rock.stiff.poisson_ratio"), or nullptr. Throws nothing but std::bad_alloc.
const Key* find_key(std::string_view path);

/// Whether `path` is a table that holds keys ("rock", "rock.stiff", "fluid.inlet"). Throws nothing but std::bad_alloc.
bool is_key_table(std::string_view path);

/// The names that may stand in the table `path` ("" for the top level); NAME is not among them.
/// Throws nothing but std::bad_alloc.
std::vector<std::string> names_in_table(std::string_view path);

/// What is wrong with an unknown key, with the nearest known one: "unknown key fluid.viscosty_Pa_s. Did you mean
/// viscosity_Pa_s?". path: full path of the key. Throws nothing but std::bad_alloc.
std::string unknown_key_message(std::string_view path);

/// What to do instead of giving the key `path`, which people look for and this version does not have, " In this version
/// ..."; "" where nothing is known of it. Throws nothing.
std::string_view advice_on_absent_key(std::string_view path);

/// What there is one of in a scene, for those who type `path` to have more of it; "" for others. Throws nothing.
std::string_view note_on_table(std::string_view path);

/// "[0, 0.5)", as in messages and help. Throws nothing but std::bad_alloc.
std::string to_text(const Bounds& bounds);

/// The value of a key in a scene as TOML, doubles to the last digit; empty where an optional one is absent.
/// index: of the rock or law, else 0. Throws nothing but std::bad_alloc.
std::string value_text(const Key& key, Scene& scene, std::size_t index);

/// The default of a key as TOML, taken from a scene of defaults; empty where there is none.
/// Throws nothing but std::bad_alloc.
std::string default_text(const Key& key);

/// The table of all keys in Markdown: key, unit, default, what is allowed, help. Throws nothing but std::bad_alloc.
std::string keys_as_markdown();

/// The scene as TOML, every key with its value; reading it gives the same scene. claims: [[claim]] tables as TOML, put
/// at the end. Throws nothing but std::bad_alloc.
std::string resolved_toml(Scene scene, std::string_view claims);

}  // namespace strata
