#include "scene/messages.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <regex>
#include <set>
#include <tuple>
#include <utility>

namespace strata {
namespace {

double substitution(char a, char b) {
  if (a == b) return 0.0;
  const auto lower = [](char c) { return std::tolower(static_cast<unsigned char>(c)); };
  return lower(a) == lower(b) ? 0.5 : 1.0;
}

// A unit left off or a word cut short: "viscosity" for "viscosity_Pa_s".
bool is_stem(std::string_view part, std::string_view whole) {
  return part.size() >= 4 && whole.size() > part.size() && whole.starts_with(part) && whole[part.size()] == '_';
}

// Control characters as TOML writes them, so that no key or value moves the cursor of a terminal.
std::string with_visible_controls(std::string_view text) {
  std::string out;
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    out += code < 0x20 || code == 0x7f ? fmt::format("\\u{:04X}", code) : std::string(1, c);
  }
  return out;
}

}  // namespace

double edit_distance(std::string_view a, std::string_view b) {
  const std::size_t columns = b.size() + 1;
  std::vector<double> d((a.size() + 1) * columns);
  const auto at = [&](std::size_t i, std::size_t j) -> double& { return d[i * columns + j]; };
  for (std::size_t i = 0; i <= a.size(); ++i) at(i, 0) = static_cast<double>(i);
  for (std::size_t j = 0; j <= b.size(); ++j) at(0, j) = static_cast<double>(j);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    for (std::size_t j = 1; j <= b.size(); ++j) {
      at(i, j) =
          std::min({at(i - 1, j) + 1.0, at(i, j - 1) + 1.0, at(i - 1, j - 1) + substitution(a[i - 1], b[j - 1])});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) at(i, j) = std::min(at(i, j), at(i - 2, j - 2) + 1.0);
    }
  }
  return at(a.size(), b.size());
}

std::string did_you_mean(std::string_view word, const std::vector<std::string>& candidates, double most) {
  constexpr std::size_t longest = 200;  // a slip in a longer word is not worth a table of its size squared
  std::string nearest;
  double nearest_distance = 0.0;
  for (const std::string& candidate : candidates) {
    if (std::max(word.size(), candidate.size()) > longest) continue;
    // A third of the letters wrong is still a slip of the fingers; more is another word.
    const double third = static_cast<double>(std::max(word.size(), candidate.size())) / 3.0;
    const double allowed = std::min(most, std::max(1.0, third));
    double distance = edit_distance(word, candidate);
    if (is_stem(word, candidate) || is_stem(candidate, word)) distance = std::min(distance, 0.9);
    if (distance > allowed || (!nearest.empty() && distance >= nearest_distance)) continue;
    nearest = candidate;
    nearest_distance = distance;
  }
  return nearest.empty() ? "" : " Did you mean " + nearest + "?";
}

std::string shortened(std::string_view text, std::size_t longest) {
  if (text.size() <= longest) return std::string(text);
  const auto begins = [](char c) { return (c & 0xC0) != 0x80; };  // a letter of UTF-8
  std::size_t head = longest / 2, tail = text.size() - longest / 3;
  while (head > 0 && !begins(text[head])) --head;
  while (tail < text.size() && !begins(text[tail])) ++tail;
  return fmt::format("{}...{} ({} characters)", text.substr(0, head), text.substr(tail),
                     std::ranges::count_if(text, begins));
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(" \t\r");
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(" \t\r") + 1 - first);
}

bool is_plain_name(std::string_view name, std::string_view also) {
  return !name.empty() && std::ranges::all_of(name, [&](char c) {
    return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '-' || also.find(c) != also.npos;
  });
}

std::vector<std::string> split(std::string_view text, std::string_view separator) {
  std::vector<std::string> parts;
  for (;;) {
    const std::size_t end = text.find(separator);
    parts.emplace_back(text.substr(0, end));
    if (end == std::string_view::npos) return parts;
    text.remove_prefix(end + separator.size());
  }
}

std::string number_text(double value) {
  std::string text = fmt::format("{}", value);
  if (std::isfinite(value) && text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::vector<std::string> as_lines(std::vector<Fault> faults) {
  std::ranges::stable_sort(faults, {}, [](const Fault& f) {
    return std::tuple(f.where.line == 0, f.where.line, f.where.column);  // what the command line gave comes last
  });
  std::vector<std::string> lines;
  std::set<std::string> seen;
  for (const auto& [where, text] : faults) {
    const std::string place = where.line == 0 ? "" : fmt::format(":{}:{}", where.line, where.column);
    const std::size_t longest =
        where.rank < 2 || where.line > 0 ? where.source.npos : 200;  // a file's name is needed whole
    const std::string source = shortened(with_visible_controls(where.source), longest);
    std::string line = source + place + ": " + shortened(with_visible_controls(text), 1000);
    if (seen.insert(line).second) lines.push_back(std::move(line));
  }
  return lines;
}

std::string in_colour(std::string text, Colours colours) {
  const auto variable = [](const char* name) {
    const char* value = std::getenv(name);
    return std::string_view(value == nullptr ? "" : value);
  };
  if (::isatty(STDERR_FILENO) == 0 || !variable("NO_COLOR").empty() || variable("TERM") == "dumb") return text;
  for (const auto& [pattern, colour] : colours) {
    const auto shown = fmt::format("$1\x1b[{}m$2\x1b[0m", colour);
    text = std::regex_replace(text, std::regex(pattern), shown, std::regex_constants::format_first_only);
  }
  return text;
}

std::string error_in_colour(std::string line) {
  constexpr const char *bold = "1", *red = "31", *green = "32", *yellow = "33";
  return in_colour(std::move(line), {{R"re((: [\w.[\]-]+ = )("[^"]*"|\S+))re", yellow},
                                     {R"re((: unknown key |: )([\w.[\]-]+(?= = |\. | is missing)))re", bold},
                                     {R"re(( Did you mean )(.*(?=\?)))re", green},
                                     {R"re(^()(.*?:\d+:\d+|--set .*?|[^ :]+)(?=: ))re", red}});
}

}  // namespace strata
