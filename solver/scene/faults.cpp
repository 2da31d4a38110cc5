#include "scene/faults.hpp"

#include <algorithm>
#include <tuple>

namespace strata {

std::vector<std::string> as_lines(const Faults& faults) {
  std::vector<Fault> sorted = faults.list;
  std::ranges::stable_sort(sorted, [](const Fault& a, const Fault& b) {
    const bool a_set = a.where.line == 0;  // what was given on the command line comes last
    const bool b_set = b.where.line == 0;
    return std::tie(a_set, a.where.line, a.where.column) < std::tie(b_set, b.where.line, b.where.column);
  });
  std::vector<std::string> lines;
  for (const Fault& fault : sorted) {
    std::string line = fault.where.text + ": " + fault.text;
    if (std::ranges::find(lines, line) == lines.end()) lines.push_back(std::move(line));
  }
  return lines;
}

Where where_is(const Positions& positions, std::string_view path) {
  while (!path.empty()) {
    const auto found = positions.at.find(path);
    if (found != positions.at.end()) return found->second;
    const std::size_t end = path.find_last_of(".[");
    path = end == std::string_view::npos ? std::string_view() : path.substr(0, end);
  }
  return positions.start;
}

}  // namespace strata
