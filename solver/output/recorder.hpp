// All that a run writes while it goes on: history, fields and checkpoints, kept in step with one another.
#pragma once

#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "output/result_hdf5.hpp"
#include "output/run_folder.hpp"

namespace strata {

class Recorder {
 public:
  /// Starts the files of a new run. Throws OutputFailure where they cannot be written.
  explicit Recorder(const RunFolder& folder) : folder_(folder), history_(folder.history()), result_(folder.result()) {}

  /// Goes on from a checkpoint: what the files hold beyond it is cut off, so that they end as those of an uninterrupted
  /// run. Throws std::runtime_error where they hold less (then the run has to start anew), OutputFailure where they
  /// cannot be written.
  Recorder(const RunFolder& folder, const OutputMark& mark)
      : folder_(folder), history_(folder.history(), mark.history), result_(folder.result(), mark.outputs) {}

  /// Adds a row to the history, after a growth event; throws OutputFailure where it cannot be written.
  void row(const Scene& scene, const State& state) { history_.append(history_row(scene, state)); }

  /// Adds a row and the fields, at an output time; throws OutputFailure where they cannot be written.
  void output(const Scene& scene, const State& state) {
    row(scene, state);
    result_.write_output(scene, state);
  }

  /// How far the output has come: what belongs to the present state in a checkpoint; throws nothing.
  OutputMark mark() const { return {history_.mark(), result_.outputs()}; }

  /// Makes what was written so far safe, then writes the checkpoint: a state, and the mark of its time. Throws
  /// OutputFailure where that fails; the checkpoint before then stays.
  void checkpoint(const Scene& scene, const State& state, const OutputMark& mark) {
    sync_file(folder_.history());
    result_.sync();
    save_checkpoint(folder_.checkpoint(), scene, state, mark);
  }

  /// Completes result.h5, at the end of the run; throws OutputFailure where that fails.
  void finish() { result_.finish(history_.rows()); }

  /// Number of output times written since the start of the run.
  std::size_t outputs() const { return result_.outputs(); }
  double last_output_s() const { return result_.last_time_s(); }

 private:
  RunFolder folder_;
  HistoryWriter history_;
  ResultFile result_;
};

}  // namespace strata
