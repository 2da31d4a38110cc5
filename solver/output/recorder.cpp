#include "output/recorder.hpp"

namespace strata {

Recorder::Recorder(const RunFolder& folder) : folder_(folder), history_(folder.history()), result_(folder.result()) {}

Recorder::Recorder(const RunFolder& folder, const OutputMark& mark)
    : folder_(folder), history_(folder.history(), mark.history), result_(folder.result(), mark.outputs) {}

void Recorder::row(const Scene& scene, const State& state) {
  history_.append(history_row(scene, state));
}

void Recorder::output(const Scene& scene, const State& state) {
  row(scene, state);
  result_.write_output(scene, state);
}

OutputMark Recorder::mark() const {
  return {history_.mark(), result_.outputs()};
}

void Recorder::checkpoint(const Scene& scene, const State& state, const OutputMark& mark) {
  sync_file(folder_.history());
  sync_file(folder_.result());
  save_checkpoint(folder_.checkpoint(), scene, state, mark);
}

void Recorder::finish() {
  result_.write_history(history_.rows());
}

}  // namespace strata
