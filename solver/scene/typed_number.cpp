#include "scene/syntax.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdlib>
#include <regex>
#include <utility>
#include <vector>

namespace strata {
namespace {

bool is_digit(char c) {
  return c >= '0' && c <= '9';
}

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

// What text processors and keyboards put in the place of plain signs.
std::string with_plain_signs(std::string_view typed) {
  static constexpr std::pair<std::string_view, std::string_view> signs[] = {
      {"\u2212", "-"}, {"\u2013", "-"},  {"\u00a0", " "},  {"\u2009", " "},   {"\u202f", " "},
      {"\u2019", "'"}, {"\u00d7", "x"},  {"\u00b7", "*"},  {"\u22c5", "*"},   {"\u00b5", "u"},
      {"\u03bc", "u"}, {"\u00b2", "^2"}, {"\u00b3", "^3"}, {"\u221a", "sqrt"}};
  std::string text(typed);
  for (const auto& [from, to] : signs) replace_all(text, from, to);
  return std::string(trimmed(text));
}

// A number taken apart; TOML takes sign, whole, '.', fraction, 'e', exponent.
struct Number {
  std::string sign, whole, fraction, exponent;
  bool comma = false;    // for a point
  bool grouped = false;  // digits with something between them
  bool either = false;   // "10,500": a decimal sign or a group
  std::string behind;    // a unit, a comment or whatever else

  std::string as_toml(int shift = 0) const {
    std::string text = sign + (whole.empty() ? "0" : whole) + (fraction.empty() ? "" : "." + fraction);
    if (!exponent.empty() || shift != 0) text += fmt::format("e{}", std::atoi(exponent.c_str()) + shift);
    return text;
  }
};

// What to type, times a power of ten; both where a comma may be one or the other.
std::string readings(const Number& number, int shift = 0) {
  std::string text = number.as_toml(shift);
  if (!number.either) return text;
  Number grouped = number;
  grouped.whole += std::exchange(grouped.fraction, "");
  return fmt::format("{}, or {} where the comma groups digits", text, grouped.as_toml(shift));
}

std::size_t count_digits(std::string_view text) {
  return static_cast<std::size_t>(std::ranges::find_if_not(text, is_digit) - text.begin());
}

// Whether all groups behind the first one have three digits, as those of thousands do.
bool are_thousands(std::string_view body, char mark) {
  for (std::size_t at = body.find(mark); at != std::string_view::npos; at = body.find(mark, at + 1)) {
    if (count_digits(body.substr(at + 1)) != 3) return false;
  }
  return true;
}

// Takes the digits and their marks apart; false where they are no number ("1,2,3", "3.5.2").
bool read_body(std::string body, Number& number) {
  for (const char mark : {'\'', '_', ' '}) number.grouped = std::erase(body, mark) > 0 || number.grouped;
  const auto points = std::ranges::count(body, '.'), commas = std::ranges::count(body, ',');
  const std::size_t last = body.find_last_of(".,");
  const char mark = last == std::string::npos ? '\0' : body[last];
  const bool decimal = mark == '.' ? points == 1 : mark == ',' && commas == 1;
  const char group = !decimal ? mark : mark == '.' ? ',' : '.';  // the other one
  if (!are_thousands(std::string_view(body).substr(0, decimal ? last : body.size()), group)) return false;
  number.grouped = number.grouped || (points + commas > (decimal ? 1 : 0));
  number.comma = decimal && mark == ',';
  number.whole = body.substr(0, decimal ? last : body.size());
  number.fraction = decimal ? body.substr(last + 1) : "";
  std::erase(number.whole, group);
  number.either = number.comma && points == 0 && number.fraction.size() == 3 && number.whole != "0";
  const std::size_t zeros = std::min(number.whole.find_first_not_of('0'), number.whole.size());
  number.whole.erase(0, zeros);
  return last == std::string::npos || body.size() > 1;
}

// Sign, digits with what stands between them, "e9", "d9", "*10^9" or "x 10**9", and what is behind.
std::optional<Number> read_number(std::string_view typed) {
  static const std::regex form(R"(([-+]?)\s*((?:\d+|(?=\.\d))(?:\.\d*|[,'_]\d+| \d{3}(?!\d))*))"
                               R"((?: *(?:[eEdD]|[*xX] *10 *(?:\^|\*\*)) *\+?(-?\d{1,4})(?!\d))?\s*(.*))");
  const std::string text = with_plain_signs(typed);
  constexpr std::size_t longest = 200;  // std::regex calls itself for each letter
  std::smatch parts;
  if (text.size() > longest || !std::regex_match(text, parts, form)) return std::nullopt;
  Number number;
  if (parts[1] == "-") number.sign = "-";
  if (!read_body(parts[2], number)) return std::nullopt;
  number.exponent = parts[3];
  number.behind = parts[4];
  number.either = number.either && number.exponent.empty();
  return number;
}

// A unit without what people write in different ways.
std::string bare_unit(std::string_view unit) {
  std::string text(unit);
  for (const std::string_view root : {"m^0.5", "m^(1/2)", "m^1/2", "m^{1/2}"}) replace_all(text, root, "sqrt(m)");
  std::erase_if(text, [](char c) { return std::string_view(" *.^()[]").find(c) != std::string_view::npos; });
  return text;
}

bool same_letters(std::string_view a, std::string_view b) {
  return std::ranges::equal(
      a, b, {}, [](unsigned char c) { return std::tolower(c); }, [](unsigned char c) { return std::tolower(c); });
}

// The power of ten by which a number in `typed` becomes one in `unit`, where it is one of its prefixes.
std::optional<int> power_of_ten(std::string_view typed, std::string_view unit) {
  constexpr std::string_view prefixes = "GgMkKcmun";
  constexpr int powers[] = {9, 9, 6, 3, 3, -2, -3, -6, -9};
  const std::string is = bare_unit(typed), wanted = bare_unit(unit);
  if (same_letters(is, wanted)) return 0;
  const bool takes_prefix = std::isalpha(static_cast<unsigned char>(unit[0])) != 0 && !unit.starts_with("m^");
  if (!takes_prefix || !same_letters(is.substr(1), wanted)) return std::nullopt;
  if (is[0] == 'm' && is.substr(1) != wanted) return std::nullopt;  // mpa: milli or mega
  const std::size_t prefix = prefixes.find(is[0]);
  return prefix == prefixes.npos ? std::nullopt : std::optional(powers[prefix]);
}

// What to type where more than a number was typed.
std::string advice_on_rest(const Number& number, const std::string* unit) {
  const std::string& behind = number.behind;
  for (const std::string_view comment : {"//", ";", "!", "--", "/*", "("}) {
    if (behind.starts_with(comment)) return fmt::format(" Write {}: a comment begins with #.", readings(number));
  }
  if (std::isalpha(static_cast<unsigned char>(behind[0])) == 0 && behind[0] != '%' && behind.find("1/") != 0)
    return " Write one number, worked out.";
  if (unit == nullptr) return " Write the number alone: units stand in the names of keys.";
  if (unit->empty()) return " Write the number alone: this key has no unit.";
  if (const auto power = power_of_ten(behind, *unit))
    return fmt::format(" Write {}: the unit, {}, stands in the key.", readings(number, *power), *unit);
  return fmt::format(" Write the number alone, in {}.", *unit);
}

}  // namespace

std::optional<std::string> advice_on_number(std::string_view typed, const std::string* unit) {
  const std::optional<Number> number = read_number(typed);
  if (!number) return std::nullopt;
  if (!number->behind.empty()) return advice_on_rest(*number, unit);
  const std::string written = readings(*number);
  if (number->comma) return fmt::format(" Write {}: the decimal sign is a point.", written);
  if (number->grouped) return fmt::format(" Write {}: nothing stands between digits.", written);
  if (written == trimmed(typed)) return std::nullopt;
  return fmt::format(" Write {}.", written);
}

}  // namespace strata
