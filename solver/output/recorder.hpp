// All that a run writes while it goes on: history, fields and checkpoints, kept in step with one another.
#pragma once

#include <cstdint>

#include "output/checkpoint.hpp"
#include "output/run_folder.hpp"

namespace strata {

class Recorder {
 public:
  /// Starts the files of a new run, or goes on behind what a checkpoint says was written, so that they end as those of
  /// an uninterrupted run. Throws std::runtime_error where fields are missing (then the run has to start anew),
  /// OutputFailure where the files cannot be written.
  explicit Recorder(const RunFolder& folder, Written written = {});

  /// What was written so far; throws nothing.
  const Written& written() const { return written_; }

  /// Adds a row to the history, after a growth event; throws OutputFailure where it cannot be written.
  void row(const Scene& scene, const State& state);

  /// Adds a row and the fields, at an output time; throws OutputFailure where they cannot be written.
  void output(const Scene& scene, const State& state);

  /// Makes what was written so far safe, then writes the checkpoint. Throws OutputFailure where that fails; the
  /// checkpoint before then stays.
  void checkpoint(const Scene& scene, const Checkpoint& checkpoint);

  /// Gathers what was written in result.h5; throws OutputFailure, with all as it was, where that fails.
  void gather() const;

 private:
  RunFolder folder_;
  Written written_;
  std::uint64_t history_bytes_ = 0;
};

}  // namespace strata
