#include "output/recorder.hpp"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "output/fields.hpp"

namespace strata {

Recorder::Recorder(const RunFolder& folder, Written written, const Scene& scene)
    : folder_(folder), written_(std::move(written)), columns_(history_columns(scene)) {
  make_folder(folder.all_fields());
  for (std::size_t k = 0; k < written_.output_times.size(); ++k) {
    if (!std::filesystem::exists(folder.fields(k)))
      throw std::runtime_error(fmt::format("{}: is missing.", folder.fields(k).string()));
  }
  std::string history = history_header(columns_);
  for (const HistoryRow& row : written_.rows) history += history_line(row);
  atomic_write(folder.history(), history);
  history_bytes_ = history.size();
}

void Recorder::row(const Scene& scene, const State& state) {
  const HistoryRow row = history_row(scene, state);
  const std::string line = history_line(row);
  append_at(folder_.history(), history_bytes_, line);
  history_bytes_ += line.size();
  written_.rows.push_back(row);
}

void Recorder::output(const Scene& scene, const State& state) {
  row(scene, state);
  write_fields(folder_, written_.output_times.size(), scene, state);
  written_.output_times.push_back(state.time);
}

void Recorder::checkpoint(const Scene& scene, const Checkpoint& checkpoint) {
  sync_file(folder_.history());
  for (std::size_t k = 0; k < written_.output_times.size(); ++k) sync_file(folder_.fields(k));
  save_checkpoint(folder_.checkpoint(), scene, checkpoint);
}

void Recorder::gather() const {
  gather_fields(folder_, columns_, written_.output_times, written_.rows);
}

}  // namespace strata
