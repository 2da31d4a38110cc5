// What is wrong with a scene, gathered so that all of it is reported in one pass, and texts of messages.
// Nothing here throws but std::bad_alloc.
#pragma once

#include <fmt/format.h>

#include <cstdio>
#include <initializer_list>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace strata {

/// Edit distance of two words: insertions, deletions, substitutions and swaps of neighbours, each counted 1
/// (optimal string alignment); case counts half as much as a letter would, so that "Weak" is near "weak".
double edit_distance(std::string_view a, std::string_view b);

/// " Did you mean X?" with the candidate nearest to `word`, or "" where none is near. most: changes of a letter that a
/// slip may have, where a third of the word would be more.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates, double most = 100.0);

/// `text`, or where it has more than `longest` bytes its beginning and its end: "abc...xyz (100000 characters)".
std::string shortened(std::string_view text, std::size_t longest);

/// `text` without the spaces around it.
std::string_view trimmed(std::string_view text);

/// Whether a name is of letters, digits, _ and -, and of what `also` holds; at least one.
bool is_plain_name(std::string_view name, std::string_view also = "");

/// The parts of `text` between separators, at least one.
std::vector<std::string> split(std::string_view text, std::string_view separator);

/// The shortest text that reads back as the same double, and as a float in TOML.
std::string number_text(double value);

// A place in the input: file, line and column, or "--set key.path=value" and 0, 0.
struct Where {
  std::string source;
  int rank = 0;  // 0 the scene itself, 1 a variant, 2 --set
  unsigned line = 0, column = 0;
};

struct Fault {
  Where where;
  std::string text;
};

// A text "key.path=value" from the command line, or from a sweep in the scene.
struct Setting {
  std::string text;
  Where where;
};

/// The faults as lines "file:line:column: what", in the order of the input and each once. A text of more than 1000
/// bytes is shortened in the middle, control characters are written out.
std::vector<std::string> as_lines(std::vector<Fault> faults);

// Regular expressions with a group before what is to have a colour and a group of that; the colour as terminals number
// it.
using Colours = std::initializer_list<std::pair<const char*, const char*>>;

/// `text` for the standard error output: the first match of each in its colour where that is a terminal and NO_COLOR
/// (no-color.org) is not set; elsewhere as it is.
std::string in_colour(std::string text, Colours colours);

/// The same of a line of an error: its place, key, value and suggestion.
std::string error_in_colour(std::string line);

/// Writes to the standard error output; where that takes nothing more (a full disc), nobody is told and the run goes
/// on.
template <class... Values>
void tell(fmt::format_string<const Values&...> text, const Values&... values) {
  std::fputs(fmt::format(text, values...).c_str(), stderr);
}

}  // namespace strata
