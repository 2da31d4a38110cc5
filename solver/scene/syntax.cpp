#include "scene/syntax.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <optional>
#include <utility>
#include <vector>

#include "scene/messages.hpp"

namespace strata {
namespace {

bool is_control(char c) {
  return c != '\t' && (static_cast<unsigned char>(c) < 0x20 || c == 0x7f);
}

bool has(std::string_view set, char c) {
  return set.find(c) != std::string_view::npos;
}

bool is_toml(std::string_view value) {
  try {
    return toml::parse(fmt::format("value = {}", value)).size() == 1;
  } catch (const toml::parse_error&) {
    return false;
  }
}

// "key = value" in a line, by the places of its parts.
struct Assignment {
  std::size_t key = 0, key_end = 0, value = 0, value_end = 0;
  bool nested = false;  // in brackets or braces
};

// A line up to its comment, taken apart without asking whether it is TOML.
struct Line {
  std::string_view text;
  std::size_t end = 0;  // of what is no comment
  int depth = 0;        // brackets and braces that are open at the end
  bool quoted = false;  // quotes that are open at the end
  std::vector<Assignment> assignments;

  std::string_view part(std::size_t from, std::size_t to) const { return text.substr(from, to - from); }
  std::string_view key(const Assignment& a) const { return part(a.key, a.key_end); }
  std::string_view value(const Assignment& a) const {
    const std::string_view whole = trimmed(part(a.value, a.value_end)),
                           scalar = trimmed(whole, a.nested ? ",}]{[" : "");
    return scalar.empty() ? whole : scalar;
  }
};

// The key in front of the '=' at `equals`.
Assignment assignment_at(std::string_view text, std::size_t equals, int depth) {
  Assignment a;
  a.nested = depth > 0;
  a.value = equals + 1;
  a.key_end = a.key = text.find_last_not_of(" \t", equals - 1) + 1;
  while (a.key > 0 &&
         (std::isalnum(static_cast<unsigned char>(text[a.key - 1])) != 0 || has("_-.\"'", text[a.key - 1])))
    --a.key;
  return a;
}

Line read_line(std::string_view text) {
  Line line;
  line.text = text;
  char quote = '\0', before = '\0';  // the last sign that is no space
  std::size_t at = 0;
  for (; at < text.size(); ++at) {
    const char c = text[at];
    if (quote != '\0') {
      if (c == '\\' && quote == '"') ++at;
      if (c == quote) quote = '\0';
      continue;
    }
    if (c == '#') break;
    if ((c == '"' || c == '\'') && (before == '\0' || has("=[{,(.", before))) quote = c;
    if (has("[{", c)) ++line.depth;
    if (has("]}", c)) --line.depth;
    if (c == '=' && at > 0) line.assignments.push_back(assignment_at(text, at, line.depth));
    if (!has(" \t", c)) before = c;
  }
  line.quoted = quote != '\0';
  line.end = std::min(at, text.size());
  for (std::size_t k = 0; k < line.assignments.size(); ++k)
    line.assignments[k].value_end = k + 1 < line.assignments.size() ? line.assignments[k + 1].key : line.end;
  return line;
}

// A key of which the last name is that of `path`: units and words go by names.
const Key* key_called(std::string_view path) {
  const std::string_view name = path.substr(path.rfind('.') + 1);
  const auto key = std::ranges::find_if(scene_keys(), [&](const Key& k) { return k.name() == name; });
  return name.empty() || key == scene_keys().end() ? nullptr : &*key;
}

// The table whose lines follow the header "[table]"; nothing where the line is no header.
std::optional<std::string> table_of(std::string_view text) {
  const Line line = read_line(text);
  const std::string_view header = trimmed(line.part(0, line.end));
  if (header.size() < 3 || header.front() != '[' || header.back() != ']') return std::nullopt;
  const std::string_view name = trimmed(header.substr(1, header.size() - 2));
  if (name.empty() || !line.assignments.empty() || name.find_first_of(",{ ") != std::string_view::npos)
    return std::nullopt;
  if (!std::isalpha(static_cast<unsigned char>(name.front()))) return std::nullopt;
  return std::string(name);
}

// As messages about values show it: the whole path, without the variant.
std::string shown_path(std::string_view key, std::string_view table, bool nested) {
  if (table.starts_with("variants.")) {
    table.remove_prefix(std::min(table.find('.', 9), table.size() - 1) + 1);
  }
  return nested || table.empty() ? std::string(key) : fmt::format("{}.{}", table, key);
}

std::string advice_on_quotes(std::string_view value) {
  const char quote = value.front();
  std::size_t end = 1;
  while (end < value.size() && value[end] != quote) end += value[end] == '\\' && quote == '"' ? 2 : 1;
  if (end >= value.size()) return " Close the quotes.";
  const std::string_view behind = trimmed(value.substr(end + 1));
  if (std::ranges::any_of(value, is_control)) return " Remove the control character.";
  if (behind.empty()) return value.find('\\') == std::string_view::npos ? "" : " A \\ is written \\\\ between quotes.";
  if (behind.find(quote) != std::string_view::npos)
    return quote == '"' ? " Write a quote within quotes as \\\"." : " Put text with a ' in it between double quotes.";
  return fmt::format(" Write {} alone: a comment begins with #, a key on a line of its own.", value.substr(0, end + 1));
}

// More lists than one, as for more fractures than one.
std::string advice_on_list(std::string_view value, const Key* key) {
  int depth = 0;
  const auto end = std::ranges::find_if(value, [&](char c) {
    if (c == '[') ++depth;
    return c == ']' && --depth == 0;
  });
  const std::string_view behind = trimmed(value.substr(static_cast<std::size_t>(end - value.begin())), "]");
  if (behind.size() < 2) return {};
  if (key != nullptr && key->is<Way<Path>>()) return std::string(note_on_table("fracture"));
  return " Nothing but a comment stands behind the ] of a list.";
}

std::string advice_on_word(std::string_view value, const Key* key) {
  if (key != nullptr && (key->is_number() || key->is<Way<int>>())) return " Write a number.";
  return fmt::format(" Text stands in quotes: \"{}\".", shortened(value, 60));
}

// A value or key at the place where the parser stopped, between brackets, commas and the line's ends.
std::string_view token_at(const Line& line, std::size_t at) {
  constexpr std::string_view ends = "[]{},=#";
  std::size_t from = std::min(at, line.end), to = from;
  while (from > 0 && !has(ends, line.text[from - 1])) --from;
  while (to < line.end && !has(ends, line.text[to])) ++to;
  return trimmed(line.part(from, to));
}

// The byte at which a column of letters begins.
std::size_t byte_at(std::string_view text, unsigned column) {
  std::size_t at = 0;
  for (unsigned k = 1; at < text.size(); ++at) {
    if ((text[at] & 0xC0) != 0x80 && k++ == column) break;
  }
  return at;
}

unsigned column_at(std::string_view text, std::size_t byte) {
  const auto letters = std::ranges::count_if(text.substr(0, byte), [](char c) { return (c & 0xC0) != 0x80; });
  return static_cast<unsigned>(letters) + 1;
}

bool is_comment(std::string_view content) {
  static constexpr std::string_view marks[] = {"//", "/*", "*", "%", ";", "!", "--"};
  return std::ranges::any_of(marks, [&](std::string_view mark) { return content.starts_with(mark); });
}

std::ptrdiff_t keys_of_its_own(const Line& line) {
  return std::ranges::count_if(line.assignments, [](const Assignment& a) { return !a.nested; });
}

// What is wrong with a line that is not TOML.
struct Complaint {
  std::size_t at = 0;  // byte
  std::string text;
  const Assignment* about = nullptr;
};

// What can be said of single values of the line.
std::vector<Complaint> complaints_on_values(const Line& line, const std::string& table) {
  std::vector<Complaint> complaints;
  for (const Assignment& a : line.assignments) {
    const std::string_view key = line.key(a), value = line.value(a);
    const std::string advice = advice_on_value(value, key_called(key));
    if (advice.empty()) continue;
    complaints.push_back(
        {a.key,
         fmt::format("{} = {}: this is not TOML.{}", shown_path(key, table, a.nested), shortened(value, 60), advice),
         &a});
  }
  return complaints;
}

// What can be said of a line as a whole, by its text and by why the parser stopped at the byte `at`.
std::string complaint_on_line(const Line& line, std::size_t at, const std::string& why) {
  const std::string_view content = trimmed(line.part(0, line.end));
  const auto stopped_by = [&](const char* reason) { return why.find(reason) != std::string::npos; };
  const auto contains = [&](const char* part) { return content.find(part) != std::string_view::npos; };
  const bool is_head = content.starts_with('['), assigns = !line.assignments.empty();
  const Key* key = assigns ? key_called(line.key(line.assignments.front())) : nullptr;
  if (stopped_by("utf-8")) return "this is not text in UTF-8. Save the file in UTF-8.";
  if (contains("\r"))
    return "this is not TOML: lines that end with \\r alone. Save the file with the line ends \\n or \\r\\n.";
  if (std::ranges::any_of(content, is_control)) return "this is not TOML: a control character. Remove it.";
  if (is_comment(content)) return "this is not TOML. A comment begins with #.";
  const bool at_start = trimmed(line.part(0, std::min(at, line.end))).empty();
  const bool begins = table_of(line.text).has_value() || (assigns && !line.assignments.front().nested);
  if (at_start && begins && stopped_by("closing ']'"))
    return "this is not TOML. A list that begins above is not closed: put its ] at its end.";
  if (is_head && !assigns && stopped_by("redefine") && stopped_by("header")) {
    return fmt::format("{} is given twice: this is not TOML. Put its keys under one.{}", content,
                       contains("[fracture") ? " A scene has one fracture." : "");
  }
  if (is_head && !assigns && stopped_by("header")) {
    return fmt::format(
        "this is not TOML: {}. The head of a table is [NAME] or [NAME.NAME], alone on its line; a name is of letters, "
        "digits, _ and -.",
        why);
  }
  if (keys_of_its_own(line) > 1 || (is_head && assigns))
    return "this is not TOML. Write each key, and each [table], on a line of its own.";
  const std::size_t colon = content.find_first_of(": \t");
  if (!assigns && colon != content.npos && key_called(content.substr(0, colon)) != nullptr) {
    return fmt::format("{}: this is not TOML. Write {} = {}.", shortened(content, 60), content.substr(0, colon),
                       shortened(trimmed(content.substr(colon + 1)), 60));
  }
  if (assigns && stopped_by("redefine"))
    return fmt::format("{} is given twice: this is not TOML. Remove one.{}", line.key(line.assignments.front()),
                       key != nullptr && key->is<Way<Path>>() ? note_on_table("fracture") : "");
  if (contains(",}") || contains(", }")) return "this is not TOML. Take the comma before } away.";
  if (stopped_by("inline table") && stopped_by("saw '\\n'"))
    return "this is not TOML. A table in braces ends on the line on which it begins; or write [NAME] and a key a line.";
  const std::string_view token = token_at(line, at);
  if (const std::string advice = advice_on_value(token, key); !advice.empty() && !token.empty())
    return fmt::format("{}: this is not TOML.{}", shortened(token, 60), advice);
  return fmt::format("this is not TOML: {}. {}.", why,
                     stopped_by("expected comma")
                         ? "Put a comma between what a list or a table in braces holds"
                         : "Write key = value, text in quotes, lists in [ ], a comment behind #");
}

std::string table_above(const std::vector<std::string>& lines, std::size_t number) {
  for (std::size_t k = number; k-- > 0;) {
    if (auto table = table_of(lines[k])) return *table;
  }
  return {};
}

// The first line with a key of so many names that the parser, which goes from one into the next, would run out of
// stack; 0 where there is none.
unsigned line_of_deep_key(std::string_view text) {
  constexpr int most_dots = 1000;  // of several 10,000 that it takes
  int dots = 0;
  unsigned line = 1;
  for (const char c : text) {
    if (has("\n[]{},=#", c)) dots = 0;
    if (c == '\n') ++line;
    if (c == '.' && ++dots > most_dots) return line;
  }
  return 0;
}

// The line as TOML, with nan for what is none, so that what is given is not missed; nothing where it does not say by
// itself what it gives.
std::optional<std::string> mended(const Line& line, const std::vector<Complaint>& complaints, bool repeated) {
  const std::string_view content = trimmed(line.part(0, line.end));
  const bool goes_on = line.depth != 0 || line.quoted || content.find("\"\"\"") != std::string_view::npos;
  if (goes_on || content.starts_with('[') || keys_of_its_own(line) > 1) return std::nullopt;
  if (repeated || is_comment(content)) return "";
  std::string text(line.text);
  for (auto c = complaints.rbegin(); c != complaints.rend(); ++c) {
    const std::string_view value = line.value(*c->about);
    const std::size_t from =
        value.empty() ? c->about->value : static_cast<std::size_t>(value.data() - line.text.data());
    text.replace(from, value.size(), " nan");
  }
  if (!complaints.empty()) return text;
  const std::string_view key =
      line.assignments.empty() ? content.substr(0, content.find_first_of(": \t")) : line.key(line.assignments.front());
  return key_called(key) != nullptr ? std::optional(fmt::format("{} = nan", key)) : std::nullopt;
}

// Adds what is wrong with the line that the parser stopped at and mends it in `text`, if it can be.
bool mend_line(std::string& text, const toml::parse_error& error, const Origin& origin, Faults& faults) {
  const unsigned number = error.source().begin.line, column = error.source().begin.column;
  const std::string why(error.description());
  std::vector<std::string> lines = split(text, "\n");
  lines.resize(std::max<std::size_t>(lines.size(), number));  // the end of the text is behind its last line
  std::string& typed = lines[number - 1];
  const Line line = read_line(typed);
  const bool single = keys_of_its_own(line) < 2 && std::ranges::none_of(trimmed(typed), is_control);
  const auto complaints =
      single ? complaints_on_values(line, table_above(lines, number - 1)) : std::vector<Complaint>();
  const auto add = [&](unsigned at, const std::string& what) {
    faults.add({fmt::format("{}:{}:{}", origin.name, number, at), number, at, origin.rank}, what);
  };
  for (const Complaint& c : complaints) add(column_at(typed, c.at), c.text);
  if (complaints.empty()) add(column, complaint_on_line(line, byte_at(typed, column), why));
  const auto as_toml = mended(line, complaints, complaints.empty() && why.find("redefine") != std::string::npos);
  if (!as_toml) return false;
  typed = *as_toml;
  text = fmt::format("{}\n", fmt::join(lines, "\n"));
  return true;
}

}  // namespace

std::string advice_on_value(std::string_view value, const Key* key) {
  if (value.empty()) return " Give it a value.";
  for (const std::string_view quote : {"\u201c", "\u201d", "\u201e", "\u2018", "\u2019", "\u00ab"}) {
    if (value.starts_with(quote)) return " Use straight quotes, \"...\".";
  }
  if (is_toml(value)) return {};
  if (has("\"'", value.front()))
    return value.starts_with("\"\"\"") || value.starts_with("'''") ? "" : advice_on_quotes(value);
  if (value.front() == '(') return " Lists stand in [ ].";
  if (value.front() == '[') return advice_on_list(value, key);
  if (value.front() == '{') return {};
  if (const auto advice = advice_on_number(value, key != nullptr ? &key->unit : nullptr)) return *advice;
  if (std::ranges::all_of(value, [](char c) { return has("0123456789.eE+-", c); }))
    return " Write it with few digits and an exponent that a double takes, as 1.5e20.";
  const bool word = std::isalpha(static_cast<unsigned char>(value.front())) != 0 && !value.ends_with('"');
  return word ? advice_on_word(value, key) : "";
}

Parsed parse_toml(std::string_view text, const Origin& origin, Faults& faults) {
  if (const unsigned line = line_of_deep_key(text); line > 0) {
    faults.add({fmt::format("{}:{}:1", origin.name, line), line, 1, origin.rank},
               "a key of more than a thousand names. A key has at most three, as rock.NAME.poisson_ratio.");
    return {{}, {}, false};
  }
  constexpr std::size_t most_lines = 100;  // each asks for the text to be parsed anew
  Parsed parsed;
  std::string rest(text);
  while (true) {
    try {
      parsed.table = toml::parse(rest, origin.name);
      return parsed;
    } catch (const toml::parse_error& error) {
      const bool first = parsed.mended.insert(error.source().begin.line).second;
      parsed.whole = first && mend_line(rest, error, origin, faults) && parsed.mended.size() < most_lines;
      if (!parsed.whole) return parsed;
    }
  }
}

}  // namespace strata
