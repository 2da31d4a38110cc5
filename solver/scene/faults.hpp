// What is wrong with a scene, gathered so that all of it is reported in one pass.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scene/spelling.hpp"

namespace strata {

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
