#include "output/history.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <system_error>

#include "output/run_folder.hpp"
#include "output/tip_numbers.hpp"

namespace strata {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

constexpr HistoryColumn columns[] = {
    {"time_s", "s", &HistoryRow::time_s},
    {"inlet_Pa", "Pa", &HistoryRow::inlet_Pa},
    {"tip_x_m", "m", &HistoryRow::tip_x_m},
    {"tip_y_m", "m", &HistoryRow::tip_y_m},
    {"height_m", "m", &HistoryRow::height_m},
    {"J_N_m", "N/m", &HistoryRow::J_N_m},
    {"K_I_Pa_sqrt_m", "Pa m^0.5", &HistoryRow::K_I_Pa_sqrt_m},
    {"K_II_Pa_sqrt_m", "Pa m^0.5", &HistoryRow::K_II_Pa_sqrt_m},
    {"mouth_opening_m", "m", &HistoryRow::mouth_opening_m},
    {"fracture_volume_m2", "m^2", &HistoryRow::fracture_volume_m2},
    {"kinetic_J", "J/m", &HistoryRow::kinetic_J},
    {"strain_J", "J/m", &HistoryRow::strain_J},
    {"interface_strain_J", "J/m", &HistoryRow::interface_strain_J},
    {"fluid_work_J", "J/m", &HistoryRow::fluid_work_J},
    {"in_situ_work_J", "J/m", &HistoryRow::in_situ_work_J},
    {"edge_work_J", "J/m", &HistoryRow::edge_work_J},
    {"damping_J", "J/m", &HistoryRow::damping_J},
    {"transfer_J", "J/m", &HistoryRow::transfer_J},
    {"integration_J", "J/m", &HistoryRow::integration_J},
    {"friction_J", "J/m", &HistoryRow::friction_J},
    {"failure_J", "J/m", &HistoryRow::failure_J},
    {"fracture_J", "J/m", &HistoryRow::fracture_J},
    {"excess_J", "J/m", &HistoryRow::excess_J},
    {"energy_closure", "1", &HistoryRow::energy_closure},
    {"J_spread", "1", &HistoryRow::J_spread},
    {"kink_deg", "deg", &HistoryRow::kink_deg},
    {"at_interface", "1", &HistoryRow::at_interface},
    {"ring_m", "m", &HistoryRow::ring_m},
    {"G_N_m", "N/m", &HistoryRow::G_N_m},
    {"G_by_J_N_m", "N/m", &HistoryRow::G_by_J_N_m},
    {"fluid_volume_balance", "1", &HistoryRow::fluid_volume_balance},
    {"body_work_J", "J/m", &HistoryRow::body_work_J},
    {"initial_kinetic_J", "J/m", &HistoryRow::initial_kinetic_J},
    {"near", "1", &HistoryRow::near},
};
static_assert(sizeof(HistoryRow) == std::size(columns) * sizeof(double), "every member of HistoryRow is a column");

std::string header() {
  std::string line;
  for (const HistoryColumn& column : columns) line += fmt::format("{}{}", line.empty() ? "" : ",", column.name);
  return line + '\n';
}

std::string text_of(const HistoryRow& row) {
  fmt::memory_buffer line;
  for (const HistoryColumn& column : columns) {
    if (line.size() > 0) line.push_back(',');
    const double value = row.*column.value;
    fmt::format_to(std::back_inserter(line), "{}", std::isnan(value) ? nan : value);  // nan has no sign in the file
  }
  line.push_back('\n');
  return fmt::to_string(line);
}

// The row in `line`, which ends before its newline; false where it is not one.
bool parse_row(std::string_view line, HistoryRow& row) {
  const char* at = line.data();
  const char* const end = at + line.size();
  for (const HistoryColumn& column : columns) {
    const auto [rest, error] = std::from_chars(at, end, row.*column.value);
    const bool last = &column == std::end(columns) - 1;
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

std::span<const HistoryColumn> history_columns() {
  return columns;
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
  HistoryRow row;
  row.time_s = state.time;
  row.inlet_Pa = state.has_fracture ? state.fluid.inlet_Pa : 0.0;
  row.mouth_opening_m = mouth_opening(state);
  row.fracture_volume_m2 = fracture_volume(state);
  const Tip* tip = leading_tip(state);
  if (state.has_fracture && tip == nullptr) throw std::logic_error("history_row: the fracture has no tip");
  const Vec2 x = tip ? tip_position(state, *tip) : Vec2{nan, nan};
  row.tip_x_m = x.x();
  row.tip_y_m = x.y();
  row.height_m = x.y();
  const TipNumbers told = tip ? tip_numbers(scene, *tip) : TipNumbers{nan, nan, nan, nan, nan, ""};
  row.J_N_m = told.J_N_m;
  row.K_I_Pa_sqrt_m = told.K_I_Pa_sqrt_m;
  row.K_II_Pa_sqrt_m = told.K_II_Pa_sqrt_m;
  row.J_spread = told.J_spread;
  row.kink_deg = told.kink_deg;
  row.at_interface = tip ? (at_interface(*tip) ? 1.0 : 0.0) : nan;
  row.near = tip ? static_cast<double>(tip->near) : nan;
  row.ring_m = tip ? tip->ring_m : nan;
  row.G_N_m = tip ? tip->G : nan;
  row.G_by_J_N_m = tip ? tip->G_by_J : nan;
  row.fluid_volume_balance = state.monitors.volume_balance;
  const Ledger& ledger = state.ledger;
  row.kinetic_J = ledger.kinetic;
  row.strain_J = ledger.strain;
  row.interface_strain_J = ledger.interface_strain;
  row.fluid_work_J = ledger.fluid_work;
  row.in_situ_work_J = ledger.in_situ_work;
  row.edge_work_J = ledger.edge_work;
  row.body_work_J = ledger.body_work;
  row.initial_kinetic_J = ledger.initial_kinetic;
  row.damping_J = ledger.damping;
  row.transfer_J = ledger.transfer;
  row.integration_J = ledger.integration;
  row.friction_J = ledger.friction;
  row.failure_J = ledger.failure;
  row.fracture_J = ledger.fracture;
  row.excess_J = ledger.excess;
  row.energy_closure = ledger.closure();
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
