// The history of a run: one row per growth event and per output time, without anything that depends on the wall clock.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scene/scene.hpp"
#include "state/state.hpp"

namespace strata {

struct RowSource;  // what a row is made of

// A column's name, which ends in its unit, the unit apart, and where its values come from.
struct HistoryColumn {
  std::string name;
  const char* unit;
  std::function<double(const RowSource&)> value;
};

/// The columns in the order of history.csv; throws nothing but std::bad_alloc.
const std::vector<HistoryColumn>& history_columns();

// J, K and kink of a tip; not-a-number where there is no such number, and then why.
struct TipNumbers {
  double K_I_Pa_sqrt_m, K_II_Pa_sqrt_m, J_N_m, J_spread, kink_deg;
  std::string reason;  // why some are none, a sentence; empty where all are there
};

/// The numbers of a tip. Where its rings cross an obstacle J and K are none (but for a tip whose faces touch and do not
/// slide: 0), nor is the kink of a closed tip, nor a J below zero without inertia. Throws nothing but std::bad_alloc.
TipNumbers tip_numbers(const Scene& scene, const Tip& tip);

/// What is too near to a tip, in a word or two: "interface", "rock border", "symmetry line", "edge", "fracture"; ""
/// where nothing. Throws nothing.
const char* name_of(Obstacle what);

// A row: a value of each column. The tip is the leading one, with the largest y; its numbers are nan where they are
// none (tip_numbers()), and so is what belongs to a tip where there is no fracture (opening, volume and inlet
// pressure are 0 then). Energies are per metre of thickness, as in Ledger.
using HistoryRow = std::vector<double>;

/// The row that describes a state. Throws std::logic_error where a fracture has no tip.
HistoryRow history_row(const Scene& scene, const State& state);

/// The tip with the largest y, the first of equal ones, or nullptr where there is none; throws nothing.
const Tip* leading_tip(const State& state);

/// Opening face to face (m) where the fracture starts on the symmetry line y = 0: at its first or its last vertex, or,
/// where neither lies there, the largest of its vertices; 0 without a fracture. Throws nothing.
double mouth_opening(const State& state);

/// Area between the fracture's faces (m^2), the sum of A w . n over its points, of the modelled domain: what symmetry
/// left out is not added. 0 without a fracture. Throws nothing.
double fracture_volume(const State& state);

// Where history.csv stands: what a checkpoint remembers of it.
struct HistoryMark {
  std::uint64_t rows = 0;
  std::uint64_t bytes = 0;
};

// Writes history.csv and keeps its rows for result.h5. Numbers are the shortest that read back to the same double. Each
// row reaches the system whole, by one call, in the file that has the name then: if the process ends, no row is torn,
// and a file that is gone or that another has changed is noticed.
class HistoryWriter {
 public:
  /// Starts `file` with its header, in place of what was there. Throws OutputFailure if it cannot be written.
  explicit HistoryWriter(const std::filesystem::path& file);

  /// Goes on behind the rows of `mark`: what follows them is cut off. Throws std::runtime_error where the file does not
  /// hold these rows, OutputFailure if it cannot be written.
  HistoryWriter(const std::filesystem::path& file, const HistoryMark& mark);

  /// Adds a row; throws OutputFailure, with the file as it was, where the disc refuses it.
  void append(const HistoryRow& row);

  /// Where the file stands; throws nothing.
  HistoryMark mark() const { return {rows_.size(), bytes_}; }

  /// All rows from the start of the run.
  const std::vector<HistoryRow>& rows() const { return rows_; }

 private:
  std::filesystem::path file_;
  std::uint64_t bytes_ = 0;
  std::vector<HistoryRow> rows_;
};

/// Reads the rows of a history.csv. Throws std::runtime_error naming file and line where it is not one.
std::vector<HistoryRow> read_history(const std::filesystem::path& file);

}  // namespace strata
