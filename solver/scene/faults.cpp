#include "scene/faults.hpp"

#include <algorithm>
#include <set>
#include <tuple>

namespace strata {
namespace {

// Control characters as TOML writes them, so that no key or value moves the cursor of a terminal.
std::string with_visible_controls(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    out += code < 0x20 || code == 0x7f ? fmt::format("\\u{:04X}", code) : std::string(1, c);
  }
  return out;
}

// Every message is of one line that a screen holds, however long the keys and values in it are.
std::string bounded(std::string_view text) {
  constexpr std::size_t longest_word = 100, longest_text = 1000;
  constexpr std::string_view marks = ".,:;";  // behind a word
  std::string out;
  while (!text.empty()) {
    const std::string_view word = text.substr(0, text.find(' '));
    const std::size_t end = word.find_last_not_of(marks) + 1;
    out += shortened(word.substr(0, end), longest_word);
    out += word.substr(end);
    text.remove_prefix(word.size());
    const std::size_t next = std::min(text.find_first_not_of(' '), text.size());
    out += text.substr(0, next);
    text.remove_prefix(next);
  }
  return shortened(with_visible_controls(out), longest_text);
}

}  // namespace

std::vector<std::string> as_lines(const Faults& faults) {
  std::vector<Fault> sorted = faults.list;
  std::ranges::stable_sort(sorted, [](const Fault& a, const Fault& b) {
    const bool a_set = a.where.line == 0, b_set = b.where.line == 0;  // what the command line gave comes last
    return std::tie(a_set, a.where.line, a.where.column) < std::tie(b_set, b.where.line, b.where.column);
  });
  std::vector<std::string> lines;
  std::set<std::string> seen;
  for (const Fault& fault : sorted) {
    const bool from_file = fault.where.rank < 2;  // whose name is needed whole
    std::string line = (from_file ? fault.where.text : bounded(fault.where.text)) + ": " + bounded(fault.text);
    if (seen.insert(line).second) lines.push_back(std::move(line));
  }
  return lines;
}

}  // namespace strata
