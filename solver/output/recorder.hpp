// All that a run writes while it goes on: history, fields and checkpoints, kept in step with one another.
#pragma once

#include <cstdint>

#include "output/checkpoint.hpp"
#include "output/history.hpp"
#include "output/run_folder.hpp"

namespace strata {

class Recorder {
 public:
  /// Starts the files of a run, or goes on behind what a checkpoint says was written: they end as those of an
  /// uninterrupted run. The scene says which columns the history has. Throws std::runtime_error where fields are
  /// missing: then the run has to start anew. This and all that follows throw OutputFailure where files cannot be
  /// written; what was there before stays.
  explicit Recorder(const RunFolder& folder, Written written = {}, const Scene& scene = Scene());

  /// What was written so far; throws nothing.
  const Written& written() const { return written_; }

  /// Adds a row to the history, after a growth event.
  void row(const Scene& scene, const State& state);

  /// Adds a row and the fields, at an output time.
  void output(const Scene& scene, const State& state);

  /// Makes what was written so far safe, then writes the checkpoint.
  void checkpoint(const Scene& scene, const Checkpoint& checkpoint);

  /// Gathers what was written in result.h5.
  void gather() const;

 private:
  RunFolder folder_;
  Written written_;
  std::vector<HistoryColumn> columns_;
  std::uint64_t history_bytes_ = 0;
};

}  // namespace strata
