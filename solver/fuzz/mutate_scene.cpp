// Mutations that keep a scene TOML, beside libFuzzer's own of bytes: most of those end at the parser, and what is
// looked for lies behind it.
#include <algorithm>
#include <array>
#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

extern "C" std::size_t LLVMFuzzerMutate(std::uint8_t* data, std::size_t size, std::size_t most);
extern "C" std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed);
extern "C" std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size,
                                                 const std::uint8_t* second, std::size_t second_size, std::uint8_t* out,
                                                 std::size_t most, unsigned seed);

namespace {

using Random = std::minstd_rand;

constexpr std::array<const char*, 44> values{"0",
                                             "-0.0",
                                             "1",
                                             "2",
                                             "0.5",
                                             "0.25",
                                             "0.1",
                                             "1e-9",
                                             "1e-300",
                                             "5e-324",
                                             "1e9",
                                             "1e18",
                                             "1e308",
                                             "-1",
                                             "-1e308",
                                             "inf",
                                             "-inf",
                                             "nan",
                                             "4",
                                             "9",
                                             "16",
                                             "20",
                                             "10.0",
                                             "true",
                                             "\"\"",
                                             "\"x\"",
                                             "\"perfect\"",
                                             "[]",
                                             "[[]]",
                                             "{}",
                                             "[0, 0]",
                                             "[[10, 0], [10, 5]]",
                                             "[[10, 0], [10, 5], [12, 9]]",
                                             "\"explicit\"",
                                             "\"quasistatic\"",
                                             "\"total\"",
                                             "\"traction\"",
                                             "\"energy\"",
                                             "\"max_hoop\"",
                                             "\"reynolds\"",
                                             "\"x\"",
                                             "1979-05-27",
                                             "9223372036854775807",
                                             "[\"X/0\", \"sqrt(-1)*t\"]"};

std::vector<std::string> lines_of(std::string_view text) {
  std::vector<std::string> lines;
  while (!text.empty()) {
    const std::size_t end = std::min(text.find('\n'), text.size());
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(std::min(end + 1, text.size()));
  }
  if (lines.empty()) lines.emplace_back();
  return lines;
}

std::size_t written(const std::vector<std::string>& lines, std::uint8_t* out, std::size_t most) {
  std::string text;
  for (const std::string& line : lines) text += line + '\n';
  const std::size_t size = std::min(text.size(), most);
  std::copy_n(text.begin(), size, out);
  return size;
}

std::size_t one_of(std::size_t n, Random& random) {
  return std::uniform_int_distribution<std::size_t>(0, n - 1)(random);
}

std::string value_of(const std::string& line) {
  const std::size_t equals = line.find('=');
  return equals == std::string::npos ? "1" : line.substr(equals + 1);
}

// The line with another value: one of the table, that of another line, or, where it has a number, that number changed.
void change_value(std::string& line, const std::string& other, Random& random) {
  const std::size_t equals = line.find('=');
  if (equals == std::string::npos) return;
  const std::size_t digit = line.find_first_of("0123456789", equals);
  switch (one_of(4, random)) {
    case 0:
      line = line.substr(0, equals + 1) + ' ' + values[one_of(values.size(), random)];
      break;
    case 1:
      line = line.substr(0, equals + 1) + value_of(other);
      break;
    case 2:
      if (digit != std::string::npos) line[digit] = static_cast<char>('0' + one_of(10, random));
      break;
    default:
      if (digit != std::string::npos) line.insert(digit, 1, static_cast<char>('0' + one_of(10, random)));
  }
}

}  // namespace

std::size_t LLVMFuzzerCustomMutator(std::uint8_t* data, std::size_t size, std::size_t most, unsigned seed) {
  Random random(seed);
  if (one_of(3, random) == 0) return LLVMFuzzerMutate(data, size, most);
  std::vector<std::string> lines = lines_of({reinterpret_cast<const char*>(data), size});
  for (std::size_t changes = 1 + one_of(3, random); changes > 0; --changes) {
    const std::size_t at = one_of(lines.size(), random), other = one_of(lines.size(), random);
    const auto here = lines.begin() + static_cast<std::ptrdiff_t>(at);
    switch (one_of(6, random)) {
      case 0:
        if (lines.size() > 1) lines.erase(here);
        break;
      case 1:
        lines.insert(here, std::string(lines[other]));
        break;
      case 2:
        lines.insert(here, "#set " + lines[other]);
        break;
      default:
        change_value(lines[at], lines[other], random);
    }
  }
  return written(lines, data, most);
}

// Lines of the one up to somewhere, then lines of the other.
std::size_t LLVMFuzzerCustomCrossOver(const std::uint8_t* first, std::size_t first_size, const std::uint8_t* second,
                                      std::size_t second_size, std::uint8_t* out, std::size_t most, unsigned seed) {
  Random random(seed);
  std::vector<std::string> lines = lines_of({reinterpret_cast<const char*>(first), first_size});
  const std::vector<std::string> others = lines_of({reinterpret_cast<const char*>(second), second_size});
  lines.resize(one_of(lines.size(), random) + 1);
  lines.insert(lines.end(), others.begin() + static_cast<std::ptrdiff_t>(one_of(others.size(), random)), others.end());
  return written(lines, out, most);
}
