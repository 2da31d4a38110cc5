// All that a run writes while it goes on: history, fields and checkpoints, kept in step with one another.
#pragma once

#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "output/result_hdf5.hpp"
#include "output/run_folder.hpp"

namespace strata {

class Recorder {
 public:
  /// Starts the files of a new run. Throws std::runtime_error where they cannot be written.
  explicit Recorder(const RunFolder& folder);

  /// Goes on from a checkpoint: what the files hold beyond it is cut off, so that they end as those of an uninterrupted
  /// run. Throws std::runtime_error where they hold less (then the run has to start anew).
  Recorder(const RunFolder& folder, const OutputMark& mark);

  /// Adds a row to the history, after a growth event; throws std::runtime_error where it cannot be written.
  void row(const Scene& scene, const State& state);

  /// Adds a row and the fields, at an output time; throws std::runtime_error where they cannot be written.
  void output(const Scene& scene, const State& state);

  /// Makes what was written so far safe, then writes the checkpoint; throws std::runtime_error where that fails.
  void checkpoint(const Scene& scene, const State& state);

  /// Completes history.csv and result.h5, at the end of the run; throws std::runtime_error where that fails.
  void finish();

  /// Number of output times written since the start of the run.
  std::size_t outputs() const { return result_.outputs(); }
  double last_output_s() const { return result_.last_time_s(); }

 private:
  RunFolder folder_;
  HistoryWriter history_;
  ResultFile result_;
};

}  // namespace strata
