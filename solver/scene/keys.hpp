// The one list of the keys of a scene. Reading, defaults, suggestions, the resolved scene and the table printed by
// `strata keys` all follow from it; defaults are those of the members in scene.hpp that the keys lead to.
#pragma once

#include <cstddef>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

#include "scene/scene.hpp"

namespace strata {

// What a value must be. `layers`, `names` and `points` are strata.layers, strata.interfaces and fracture.path_m, which
// lead to more than one member; `formulas` are two, of x and y; `anything` is a key of which only the name matters.
enum class KeyType { number, integer, word, text, layers, names, points, formulas, anything };

struct Bounds {
  double low = 0.0;
  double high = 0.0;
  bool low_open = false;
  bool high_open = false;
};

// A word that a key may take.
struct Word {
  std::string text;
  int value = 0;
};

// The way from a key to its member of a scene; the second argument is the index of the rock or law, else 0.
using NumberPlace = double& (*)(Scene&, std::size_t);
using OptionalPlace = std::optional<double>& (*)(Scene&, std::size_t);
using IntegerPlace = int& (*)(Scene&, std::size_t);
using TextPlace = std::string& (*)(Scene&, std::size_t);
using FormulasPlace = std::optional<Formulas>& (*)(Scene&, std::size_t);
struct WordPlace {
  int (*get)(Scene&, std::size_t) = nullptr;
  void (*set)(Scene&, std::size_t, int) = nullptr;
};
using Place =
    std::variant<std::monostate, NumberPlace, OptionalPlace, IntegerPlace, TextPlace, FormulasPlace, WordPlace>;

struct Key {
  std::string path;  // "rock.NAME.poisson_ratio": NAME stands for any name, "strata.layers[].rock" is in each element
  KeyType type = KeyType::anything;
  std::string unit;          // empty: none
  Bounds bounds;             // of numbers
  std::vector<int> allowed;  // of integers
  std::vector<Word> words;
  std::vector<std::string> variables;  // that formulas may use
  Place place;
  bool required = false;
  std::string law;     // the interface law or laws that the key belongs to; empty: any
  std::string advice;  // what to do where the value is out of bounds
  std::string help;

  /// Whether the key is one of an interface with this law. Throws nothing.
  bool is_of(std::string_view name) const { return law.empty() || (!name.empty() && law.find(name) != law.npos); }
};

/// All keys, in the order in which a scene is written. Throws nothing but std::bad_alloc.
const std::vector<Key>& scene_keys();

/// The key of which `path` is an instance ("rock.stiff.poisson_ratio"), or nullptr. Throws nothing.
const Key* find_key(std::string_view path);

/// Whether `path` is a table that holds keys ("rock", "rock.stiff", "fluid.inlet"). Throws nothing but std::bad_alloc.
bool is_key_table(std::string_view path);

/// The names that may stand in the table `path` ("" for the top level); NAME is not among them.
/// Throws nothing but std::bad_alloc.
std::vector<std::string> names_in_table(std::string_view path);

/// What is wrong with an unknown key, with the nearest known one: "unknown key fluid.viscosty_Pa_s. Did you mean
/// viscosity_Pa_s?". path: full path of the key. Throws nothing but std::bad_alloc.
std::string unknown_key_message(std::string_view path);

/// "[0, 0.5)", as in messages and help. Throws nothing but std::bad_alloc.
std::string to_text(const Bounds& bounds);

/// The shortest text that reads back as the same double, and as a float in TOML. Throws nothing but std::bad_alloc.
std::string number_text(double value);

/// The default of a key as TOML, taken from a scene of defaults; empty where there is none.
/// Throws nothing but std::bad_alloc.
std::string default_text(const Key& key);

/// The table of all keys in Markdown: key, unit, default, what is allowed, help. Throws nothing but std::bad_alloc.
std::string keys_as_markdown();

}  // namespace strata
