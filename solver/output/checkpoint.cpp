#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "output/fields.hpp"
#include "scene/toml_reader.hpp"

namespace strata {
namespace {

// A file is this line, with a number to be raised with every change of what is saved, the checksum of what follows,
// the scene as it was resolved, what was written, and the state.
constexpr std::string_view magic = "strata-checkpoint 17\n";

template <class T, class Plain>
concept Is = std::is_same_v<std::remove_const_t<T>, Plain>;

// The members of each structure, for saving and loading alike. A structured binding has to name every one, so that a
// new one cannot be left out by oversight: the compiler asks for it here. Structures of numbers without gaps (Ledger,
// Monitors, FluidBalance, Stress, InterfaceLaw::Memory) are saved as the bytes they are.
#define STRATA_SAVED(Type, ...)                       \
  template <class Archive>                            \
  void fields(Archive& archive, Is<Type> auto& all) { \
    auto& [__VA_ARGS__] = all;                        \
    archive(__VA_ARGS__);                             \
  }
STRATA_SAVED(Grid, nx, ny, h, x_knots, y_knots)
STRATA_SAVED(SurfacePoint, x, n, A, arc, w, u, reaction, in_situ, bonded, P, memory, column, sides, split, failed_s)
STRATA_SAVED(Surface, kind, bit, law, vertices, points)
STRATA_SAVED(FluidLine, P, inlet, inlet_Pa, w_rate)
STRATA_SAVED(ReynoldsLine, length, P, phi, content, w, w_rate, wet_s, leaked, rates_known, inlet, inlet_Pa)
STRATA_SAVED(GrownFluid, time, took, line, balance)
STRATA_SAVED(TipTie, node, plus, minus, stiffness, s)
STRATA_SAVED(Tip, at_back, growing, stopped_by, K_I, K_II, J, J_spread, ring_m, kink, turn, closed, near, crossed,
             no_length, last_growth_s, last_growth_Pa, due_s, runs_until_s, G_trial, G_along, G, G_by_J, criterion,
             grew_by, has_grown, arrested, reached)
STRATA_SAVED(Event, kind, time_s, inlet_Pa, tip_x_m, tip_y_m, at_interface, by, tip)
STRATA_SAVED(SavedState, time, step, dt, grid, particles, surfaces, has_fracture, fluid, reynolds, balance, grown, tips,
             ties, events, ledger, monitors)
STRATA_SAVED(Written, rows, output_times)
#undef STRATA_SAVED

template <class Archive>
void fields(Archive& archive, Is<Particles> auto& particles) {
  for_each_array(particles, [&](auto& array) { archive(array); });
  archive(particles.next_id);
}

// Saves values one behind another, or loads them.
template <bool loads>
struct Archive {
  std::conditional_t<loads, std::string_view, std::string> bytes;  // so far, or left

  template <class... T>
  void operator()(T&&... values) {
    (one(values), ...);
  }

 private:
  template <class T>
  void raw(T* values, std::size_t n) {
    if constexpr (loads) {
      bytes.copy(reinterpret_cast<char*>(values), n * sizeof(T));
      bytes = bytes.substr(n * sizeof(T));
    } else {
      bytes.append(reinterpret_cast<const char*>(values), n * sizeof(T));
    }
  }

  template <class T>
  void one(T& value) {
    if constexpr (std::is_trivially_copyable_v<T>) {
      raw(&value, 1);
    } else if constexpr (Is<T, Vec2>) {
      raw(value.data(), 2);
    } else if constexpr (requires { value.capacity(); }) {  // a text or a vector
      std::size_t n = value.size();
      one(n);
      if constexpr (loads) value.resize(n);
      if constexpr (std::is_trivially_copyable_v<typename T::value_type>) {
        raw(value.data(), n);
      } else {
        for (auto& element : value) one(element);
      }
    } else {
      fields(*this, value);
    }
  }
};

std::size_t checksum(std::string_view bytes) {
  return std::hash<std::string_view>()(bytes);
}

[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view reason) {
  throw std::runtime_error(fmt::format("{}: {}.", file.string(), reason));
}

using Lines = std::set<std::string>;

// The lines of a resolved scene, each with its table before it: "stop.tip_y_m = 20.0".
Lines lines_of(const std::string& text) {
  Lines lines;
  std::string table;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with('[')) table = line.substr(1, line.find(']') - 1) + '.';
    if (line.find('=') != std::string::npos) lines.insert(table + line);
  }
  return lines;
}

// Those of `some` that `others` have not.
std::string missing(const Lines& others, const Lines& some) {
  std::vector<std::string> found;
  std::ranges::set_difference(some, others, std::back_inserter(found));
  return found.empty() ? "nothing" : fmt::format("{}", fmt::join(found, ", "));
}

}  // namespace

// All of the state but what rebuild_copies() derives of it.
void save_checkpoint(const std::filesystem::path& file, const Scene& scene, const Checkpoint& checkpoint) {
  Archive<false> content, sum;
  const State& state = checkpoint.state;
  content(scene.resolved_toml, checkpoint.written, static_cast<const SavedState&>(state), state.total.velocity);
  sum(checksum(content.bytes));
  atomic_write(file, std::string(magic) + sum.bytes + content.bytes);
}

Checkpoint load_checkpoint(const std::filesystem::path& file, const Scene& scene) {
  const std::string bytes = read_whole(file);
  if (!bytes.starts_with(magic)) refuse(file, "is no checkpoint of strata, or has another version's format");
  Archive<true> content{std::string_view(bytes).substr(magic.size())};
  std::size_t sum = 0;
  if (content.bytes.size() > sizeof sum) content(sum);
  if (checksum(content.bytes) != sum) refuse(file, "is torn");
  std::string of_run;
  content(of_run);
  if (of_run != scene.resolved_toml) {
    throw OutputFailure(
        fmt::format("{}: belongs to another scene than scene.toml beside it, or to a version of strata with other "
                    "keys. Put scene.toml back as it was, use that version, or run the scene anew with --replace.",
                    file.string()));
  }
  Checkpoint checkpoint;
  content(checkpoint.written, static_cast<SavedState&>(checkpoint.state), checkpoint.state.total.velocity);
  return checkpoint;
}

void require_unchanged_scene(const RunFolder& folder, const Scene& scene) {
  const std::string of_run = made_with(folder).scene;
  if (of_run.empty()) return;  // nothing was computed
  // Read as scene.toml is: another version may know more keys.
  const ReadResult read = read_scene_text(of_run, folder.scene().string(), "", {});
  const std::string& before = read.scene ? read.scene->resolved_toml : of_run;
  if (before == scene.resolved_toml) return;
  const Lines run = lines_of(before), now = lines_of(scene.resolved_toml);
  throw OutputFailure(
      fmt::format("{0}: was changed after the run began: it says {1}; the run has {2}. The run belongs to the scene as "
                  "it was. Put that back, or run the changed scene anew: `strata run {0} --out DIR`, or `strata run "
                  "{0} --out {3} --replace` in the place of this run.",
                  folder.scene().string(), missing(run, now), missing(now, run), folder.path.string()));
}

}  // namespace strata
