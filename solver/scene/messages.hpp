// What is wrong with a scene, gathered so that all of it is reported in one pass, and texts of messages: which known
// word was meant by one that is not known, numbers, what is too long to be shown.
#pragma once

#include <fmt/format.h>

#include <cstddef>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strata {

/// Edit distance of two words: insertions, deletions, substitutions and swaps of neighbours, each counted 1
/// (optimal string alignment); case counts half as much as a letter would, so that "Weak" is near "weak".
/// a, b: any words, no units. Throws nothing but std::bad_alloc.
double edit_distance(std::string_view a, std::string_view b);

/// " Did you mean X?", or an empty text where no candidate is near; to be put behind an error.
/// word: as typed; candidates: the words that would be allowed. Throws nothing but std::bad_alloc.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates);

/// `text`, or where it has more than `longest` bytes its beginning and its end: "abc...xyz (100000 characters)".
/// Throws nothing but std::bad_alloc.
std::string shortened(std::string_view text, std::size_t longest);

/// `text` without the spaces around it, nor what of `also_behind` is at its end. Throws nothing but std::bad_alloc.
std::string_view trimmed(std::string_view text, std::string_view also_behind = "");

/// Whether a name is of letters, digits, _ and -, at least one. Throws nothing.
bool is_plain_name(std::string_view name);

/// The parts of `text` between separators, at least one. Throws nothing but std::bad_alloc.
std::vector<std::string> split(std::string_view text, std::string_view separator);

/// The shortest text that reads back as the same double, and as a float in TOML. Throws nothing but std::bad_alloc.
std::string number_text(double value);

// A place in the input: "exp1.toml:14:1" or "--set key.path=value".
struct Where {
  std::string text;
  unsigned line = 0;
  unsigned column = 0;
  int rank = 0;  // 0 the scene itself, 1 its variant, 2 --set
};

// Numbers in messages are those of TOML.
template <class Value>
const Value& shown(const Value& value) {
  return value;
}
inline std::string shown(const double& value) {
  return number_text(value);
}
template <class... Values>
using Message = fmt::basic_format_string<char, decltype(shown(std::declval<const Values&>()))...>;

struct Fault {
  Where where;
  std::string text;
};

struct Faults {
  std::vector<Fault> list;

  void add(const Where& where, std::string text) { list.push_back({where, std::move(text)}); }

  template <class... Values>
  requires(sizeof...(Values) > 0) void add(const Where& where, Message<Values...> text, const Values&... values) {
    add(where, fmt::format(text, shown(values)...));
  }
};

/// The faults as lines "where: what", in the order of the input and each once. Words of more than 100 bytes and texts
/// of more than 1000 are shortened in the middle, control characters are written out. Throws nothing but
/// std::bad_alloc.
std::vector<std::string> as_lines(const Faults& faults);

}  // namespace strata
