#include "output/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <functional>
#include <limits>
#include <numbers>
#include <stdexcept>
#include <system_error>

#include "output/run_folder.hpp"

namespace strata {

struct RowSource {
  const State& state;
  const Tip* tip;  // the leading one, or none
  Vec2 x;          // where it is
  TipNumbers numbers;
};

namespace {

// What is too near to a tip, and what its rings then cross.
struct Words {
  const char* name;
  const char* crossed;
};
constexpr Words words_of(Obstacle what) {
  constexpr Words words[] = {
      {"", ""},
      {"interface", "an interface whose faces have come apart"},
      {"rock border", "another rock"},
      {"symmetry line", "the symmetry line"},
      {"edge", "an edge of the block"},
      {"fracture", "another part of the fracture"},
  };
  return words[static_cast<std::size_t>(what)];
}

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

// Those that the first versions had come first, so that files of all can be laid side by side.
std::vector<HistoryColumn> make_columns() {
  using From = const RowSource&;
  const auto of_tip = [](auto value) {
    return [value](From of) { return of.tip != nullptr ? static_cast<double>(std::invoke(value, *of.tip)) : nan; };
  };
  std::vector<HistoryColumn> all{
      {"time_s", "s", [](From of) { return of.state.time; }},
      {"inlet_Pa", "Pa", [](From of) { return of.state.has_fracture ? of.state.fluid.inlet_Pa : 0.0; }},
      {"tip_x_m", "m", [](From of) { return of.x.x(); }},
      {"tip_y_m", "m", [](From of) { return of.x.y(); }},
      {"height_m", "m", [](From of) { return of.x.y(); }},  // above y = 0, the symmetry line
      {"J_N_m", "N/m", [](From of) { return of.numbers.J_N_m; }},
      {"K_I_Pa_sqrt_m", "Pa m^0.5", [](From of) { return of.numbers.K_I_Pa_sqrt_m; }},
      {"K_II_Pa_sqrt_m", "Pa m^0.5", [](From of) { return of.numbers.K_II_Pa_sqrt_m; }},
      {"mouth_opening_m", "m", [](From of) { return mouth_opening(of.state); }},
      {"fracture_volume_m2", "m^2", [](From of) { return fracture_volume(of.state); }},
  };
  const auto add_energies = [&](bool first) {
    for (const auto& energy : ledger_energies) {
      if (first == (energy.value == &Ledger::body_work || energy.value == &Ledger::initial_kinetic)) continue;
      all.push_back(
          {energy.name + std::string("_J"), "J/m", [value = energy.value](From of) { return of.state.ledger.*value; }});
    }
  };
  add_energies(true);
  all.insert(all.end(), {
                            {"energy_closure", "1", [](From of) { return of.state.ledger.closure(); }},
                            {"J_spread", "1", [](From of) { return of.numbers.J_spread; }},
                            {"kink_deg", "deg", [](From of) { return of.numbers.kink_deg; }},
                            {"at_interface", "1", of_tip(at_interface)},
                            {"ring_m", "m", of_tip(&Tip::ring_m)},
                            {"G_N_m", "N/m", of_tip(&Tip::G)},
                            {"G_by_J_N_m", "N/m", of_tip(&Tip::G_by_J)},
                            {"fluid_volume_balance", "1", [](From of) { return of.state.monitors.volume_balance; }},
                        });
  add_energies(false);
  all.push_back({"near", "1", of_tip(&Tip::near)});
  return all;
}

std::string header() {
  std::string line;
  for (const HistoryColumn& column : history_columns()) line += (line.empty() ? "" : ",") + column.name;
  return line + '\n';
}

std::string text_of(const HistoryRow& row) {
  fmt::memory_buffer line;
  for (const double value : row) {
    if (line.size() > 0) line.push_back(',');
    fmt::format_to(std::back_inserter(line), "{}", std::isnan(value) ? nan : value);  // nan has no sign in the file
  }
  line.push_back('\n');
  return fmt::to_string(line);
}

// The row in `line`, which ends before its newline; false where it is not one.
bool parse_row(std::string_view line, HistoryRow& row) {
  const char* at = line.data();
  const char* const end = at + line.size();
  row.resize(history_columns().size());
  for (double& value : row) {
    const auto [rest, error] = std::from_chars(at, end, value);
    const bool last = &value == &row.back();
    if (error != std::errc{} || (last ? rest != end : rest == end || *rest != ',')) return false;
    at = rest + (last ? 0 : 1);
  }
  return true;
}

std::vector<HistoryRow> parse_history(std::string_view text, const std::filesystem::path& file) {
  std::vector<HistoryRow> rows;
  for (std::size_t number = 1; !text.empty(); ++number) {
    const std::size_t end = text.find('\n');
    const std::string_view line = text.substr(0, end);
    const bool whole = end != std::string_view::npos;
    HistoryRow row;
    if (number == 1 ? !whole || line != std::string_view(header()).substr(0, header().size() - 1)
                    : !whole || !parse_row(line, row)) {
      throw std::runtime_error(fmt::format("{}:{}: not {} of a history", file.string(), number,
                                           number == 1 ? "the header" : "a complete row"));
    }
    if (number > 1) rows.push_back(row);
    text.remove_prefix(end + 1);
  }
  return rows;
}

std::string first_bytes(const std::filesystem::path& file, std::uint64_t bytes) {
  std::ifstream in(file, std::ios::binary);
  std::string text(bytes, '\0');
  in.read(text.data(), static_cast<std::streamsize>(bytes));
  if (!in) throw std::runtime_error(fmt::format("{}: shorter than the {} bytes it should hold", file.string(), bytes));
  return text;
}

}  // namespace

const std::vector<HistoryColumn>& history_columns() {
  static const std::vector<HistoryColumn> all = make_columns();
  return all;
}

const char* name_of(Obstacle what) {
  return words_of(what).name;
}

TipNumbers tip_numbers(const Scene& scene, const Tip& tip) {
  TipNumbers told{tip.K_I, tip.K_II, tip.J, tip.J_spread, tip.kink * (180.0 / std::numbers::pi), ""};
  const bool shut = tip.closed && tip.J == 0.0;  // whatever is near
  if (tip.crossed && !shut) {
    told = {nan, nan, nan, nan, nan, std::string("the rings on which J and K are measured cross ")};
    told.reason += words_of(tip.near).crossed;
    if (tip.no_length)
      told.reason = "the tip stands on an interface whose faces have come apart: it has no length in the rock ahead";
  } else if (tip.closed) {
    told.kink_deg = nan;
    told.reason = "the tip is closed: it has no direction to open into";
  } else if (tip.near == Obstacle::interface) {
    told.J_N_m = told.J_spread = nan;
    told.reason = "the rings on which J is measured reach over an interface whose faces have come apart";
  } else if (tip.J < 0.0 && scene.numerics.mechanics == Numerics::Mechanics::quasistatic) {
    told.J_N_m = told.J_spread = nan;
    told.reason =
        "J comes out below 0, which no tip at rest has: cells are too coarse for what the pressure does there";
  }
  return told;
}

const Tip* leading_tip(const State& state) {
  if (!state.has_fracture || state.tips.empty()) return nullptr;
  return &*std::max_element(state.tips.begin(), state.tips.end(), [&](const Tip& a, const Tip& b) {
    return tip_position(state, a).y() < tip_position(state, b).y();
  });
}

double mouth_opening(const State& state) {
  if (!state.has_fracture) return 0.0;
  const Surface& fracture = state.fracture();
  // Vertices follow the rock: one that started on the line may be off it by round-off.
  const auto on_symmetry_line = [&](const SurfacePoint& s) { return std::abs(s.x.y()) < 1e-6 * state.grid.h; };
  const auto& v = fracture.vertices;
  if (on_symmetry_line(v.front())) return v.front().opening();
  if (on_symmetry_line(v.back())) return v.back().opening();
  double largest = v.front().opening();
  for (const SurfacePoint& s : v) largest = std::max(largest, s.opening());
  return largest;
}

double fracture_volume(const State& state) {
  if (!state.has_fracture) return 0.0;
  double volume = 0.0;
  for (const SurfacePoint& s : state.fracture().points) volume += s.A * s.opening();
  return volume;
}

HistoryRow history_row(const Scene& scene, const State& state) {
  const Tip* tip = leading_tip(state);
  if (state.has_fracture && tip == nullptr) throw std::logic_error("history_row: the fracture has no tip");
  const RowSource source{state, tip, tip ? tip_position(state, *tip) : Vec2{nan, nan},
                         tip ? tip_numbers(scene, *tip) : TipNumbers{nan, nan, nan, nan, nan, ""}};
  HistoryRow row;
  for (const HistoryColumn& column : history_columns()) row.push_back(column.value(source));
  return row;
}

HistoryWriter::HistoryWriter(const std::filesystem::path& file) : file_(file), bytes_(header().size()) {
  atomic_write(file, header());
}

HistoryWriter::HistoryWriter(const std::filesystem::path& file, const HistoryMark& mark)
    : file_(file), bytes_(mark.bytes), rows_(parse_history(first_bytes(file, mark.bytes), file)) {
  if (rows_.size() != mark.rows) {
    throw std::runtime_error(
        fmt::format("{}: holds {} rows where {} were expected", file.string(), rows_.size(), mark.rows));
  }
  std::error_code error;
  std::filesystem::resize_file(file, mark.bytes, error);
  if (error) throw OutputFailure(fmt::format("{}: cannot be written: {}", file.string(), error.message()));
}

void HistoryWriter::append(const HistoryRow& row) {
  const std::string line = text_of(row);
  append_at(file_, bytes_, line);
  bytes_ += line.size();
  rows_.push_back(row);
}

std::vector<HistoryRow> read_history(const std::filesystem::path& file) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(file, error);
  if (error) throw std::runtime_error(fmt::format("{}: {}", file.string(), error.message()));
  return parse_history(first_bytes(file, bytes), file);
}

}  // namespace strata
