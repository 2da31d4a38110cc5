#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <map>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "output/result_hdf5.hpp"
#include "scene/messages.hpp"
#include "scene/toml_reader.hpp"

namespace strata {

namespace {

constexpr std::string_view magic = "strata-checkpoint\n";
constexpr std::uint32_t format_version = 12;  // to be raised with every change of what is saved
constexpr std::uint32_t byte_order = 0x01020304;

// Values that are saved as the bytes they are.
template <class T>
constexpr bool is_plain = std::is_arithmetic_v<T> || std::is_enum_v<T> || std::is_same_v<T, Stress>;

template <class T, class Plain>
concept Is = std::is_same_v<std::remove_const_t<T>, Plain>;

// What belongs to each structure, for saving and loading alike. A structured binding has to name every member, so that
// a new one cannot be left out by oversight: the compiler asks for it here. Then raise format_version.
#define STRATA_SAVED(Type, ...)                       \
  template <class Archive>                            \
  void fields(Archive& archive, Is<Type> auto& all) { \
    auto& [__VA_ARGS__] = all;                        \
    archive(__VA_ARGS__);                             \
  }
STRATA_SAVED(Grid, nx, ny, h, x_knots, y_knots)
STRATA_SAVED(SurfacePoint, x, n, A, arc, w, u, reaction, in_situ, bonded, P, slip, column, sides, split, failed_s)
STRATA_SAVED(Surface, kind, bit, law, vertices, points)
STRATA_SAVED(FluidLine, P, inlet, inlet_Pa, w_rate)
STRATA_SAVED(ReynoldsLine, length, P, phi, content, w, w_rate, rates_known, inlet, inlet_Pa)
STRATA_SAVED(FluidBalance, stored_at_start, injected, stored, largest)
STRATA_SAVED(TipTie, node, plus, minus, stiffness, s)
STRATA_SAVED(Tip, at_back, growing, stopped_by, K_I, K_II, J, J_spread, ring_m, kink, turn, closed, near, crossed,
             no_length, last_growth_s, last_growth_Pa, due_s, runs_until_s, G_trial, G, G_by_J, criterion, grew_by,
             has_grown, arrested, reached)
STRATA_SAVED(Event, kind, time_s, inlet_Pa, tip_x_m, tip_y_m, at_interface, by)
STRATA_SAVED(Monitors, largest_courant, largest_penetration, contact_sweeps, contact_unconverged,
             largest_particle_velocity, contact_residual, volume_balance, mirror, largest_open_J, largest_made_J,
             largest_strain_J, largest_kinetic_J, expected_x, expected_y, largest_drift, largest_momentum,
             force_balance, largest_imbalance, delivered_m2, growths, growths_apart, growth_unweighed, J_spread_sum,
             largest_J_spread, contact_left, largest_contact_Pa, largest_tension_Pa, largest_strain, largest_rotation,
             largest_jump, net_at_start_Pa, largest_net_Pa, flow_growths, flow_fall_Pa, flow_fall, largest_flow_fall,
             floor_share, floor_share_sum)
STRATA_SAVED(HistoryMark, rows, bytes)
STRATA_SAVED(OutputMark, history, outputs)
#undef STRATA_SAVED

template <class Archive>
void fields(Archive& ar, Is<Particles> auto& particles) {
  for_each_array(particles, [&](auto& array) { ar(array); });
  ar(particles.next_id);
}

template <class Archive>
void fields(Archive& ar, Is<Ledger> auto& ledger) {
  for (const auto& energy : ledger_energies) ar(ledger.*energy.value);
  ar(ledger.largest);
}

// All of the state but what rebuild_copies() derives of it.
template <class Archive>
void fields(Archive& ar, Is<State> auto& state) {
  ar(state.time, state.step, state.dt, state.grid, state.particles, state.surfaces, state.has_fracture, state.fluid);
  ar(state.reynolds, state.balance, state.tips, state.ties, state.events, state.ledger, state.monitors);
  ar(state.total.velocity);
}

// Where bytes go, and where they come from.
struct Saved {
  static constexpr bool loads = false;
  void raw(const void* from, std::size_t n) { bytes.append(static_cast<const char*>(from), n); }
  std::string bytes;
};
struct Loaded {
  static constexpr bool loads = true;
  void raw(void* to, std::size_t n) {
    require(n);
    if (n > 0) std::memcpy(to, rest.data(), n);
    rest.remove_prefix(n);
  }
  void require(std::size_t n) const {
    if (n > rest.size()) throw std::runtime_error("ends too early");
  }
  std::string_view rest;
};

// Saves values one behind another, or loads them.
template <class Store>
struct Archive {
  Store store;

  template <class... T>
  void operator()(T&&... values) {
    (one(values), ...);
  }

 private:
  template <class T>
  void one(T& value) {
    if constexpr (is_plain<std::remove_const_t<T>>) {
      store.raw(&value, sizeof value);
    } else if constexpr (Is<T, Vec2>) {
      store.raw(value.data(), 2 * sizeof(double));
    } else if constexpr (requires { value.capacity(); }) {
      list(value);
    } else {
      fields(*this, value);
    }
  }

  // A text or a vector. Elements take a byte at least, so that a wrong number of them cannot ask for more memory than
  // the file is long.
  template <class List>
  void list(List& values) {
    std::uint64_t n = values.size();
    one(n);
    if constexpr (Store::loads) {
      store.require(n);
      values.resize(n);
    }
    using Element = typename List::value_type;
    if constexpr (is_plain<Element>) {
      store.raw(values.data(), n * sizeof(Element));
    } else {
      for (auto& value : values) one(value);
    }
  }
};

[[noreturn]] void refuse(const std::filesystem::path& file, std::string_view reason) {
  throw std::runtime_error(fmt::format("{}: {}", file.string(), reason));
}

using Lines = std::map<std::string, std::string>;  // "stop.tip_y_m" and its value

// A resolved scene by its keys; a list that has several lines counts as one value.
Lines lines_of(std::string_view text) {
  Lines lines;
  std::string table, key;
  while (!text.empty()) {
    const std::string_view line = text.substr(0, text.find('\n'));
    text.remove_prefix(std::min(line.size() + 1, text.size()));
    const std::size_t equals = line.find(" = ");
    if (line.starts_with('[')) {
      table = std::string(line.substr(1, line.find(']') - 1)) + '.';
    } else if (equals != std::string_view::npos && !line.starts_with(' ')) {
      key = table + std::string(line.substr(0, equals));
      lines[key] += line.substr(equals + 3);
    } else {
      lines[key] += line;
    }
  }
  return lines;
}

std::string value_of(const Lines& lines, const std::string& key) {
  const auto found = lines.find(key);
  return found == lines.end() ? "left out" : shortened(found->second, 60);
}

// "stop.tip_y_m = 20.0 (12.0 in the run)" of each key that differs.
std::vector<std::string> changes(const Lines& run, const Lines& now) {
  Lines all = run;
  all.insert(now.begin(), now.end());
  std::vector<std::string> texts;
  for (const auto& [key, value] : all) {
    if (run.contains(key) && now.contains(key) && run.at(key) == now.at(key)) continue;
    texts.push_back(fmt::format("{} = {} ({} in the run)", key, value_of(now, key), value_of(run, key)));
  }
  return texts;
}

}  // namespace

std::uint64_t scene_hash(const Scene& scene) {
  return checksum(scene.resolved_toml);
}

void save_checkpoint(const std::filesystem::path& file, const Scene& scene, const State& state,
                     const OutputMark& mark) {
  Archive<Saved> content;
  content(mark, state);
  Archive<Saved> out{{std::string(magic)}};
  const std::string& bytes = content.store.bytes;
  out(byte_order, format_version, scene_hash(scene), std::uint64_t{bytes.size()}, checksum(bytes));
  atomic_write(file, out.store.bytes + bytes);
}

Checkpoint load_checkpoint(const std::filesystem::path& file, const Scene& scene) {
  const std::string bytes = read_whole(file);
  if (!bytes.starts_with(magic)) refuse(file, "is no checkpoint of strata");
  Checkpoint checkpoint;
  try {
    Archive<Loaded> header{{std::string_view(bytes).substr(magic.size())}};
    const std::string_view& rest = header.store.rest;
    std::uint32_t order = 0, version = 0;
    std::uint64_t hash = 0, size = 0, sum = 0;
    header(order, version);
    if (order != byte_order) refuse(file, "was written on a machine with another byte order");
    if (version != format_version) {
      refuse(file, fmt::format("has checkpoint format {}, this version reads {}", version, format_version));
    }
    header(hash, size, sum);
    if (hash != scene_hash(scene)) {
      throw OutputFailure(
          fmt::format("{}: belongs to another scene than scene.toml beside it, or to a version of strata with other "
                      "keys. Put scene.toml back as it was, use that version, or run the scene anew with --replace.",
                      file.string()));
    }
    if (rest.size() != size || checksum(rest) != sum) refuse(file, "is torn: its content is not complete");
    header(checkpoint.mark, checkpoint.state);
    if (!rest.empty()) refuse(file, "is torn: it holds more than a state");
  } catch (const std::runtime_error& error) {
    if (std::string_view(error.what()) != "ends too early") throw;
    refuse(file, "is torn: it ends too early");
  }
  return checkpoint;
}

void require_unchanged_scene(const RunFolder& folder, const Scene& scene) {
  const std::string of_run = made_with(folder.result()).scene;
  if (of_run.empty()) return;  // nothing was computed
  // Read as scene.toml is: another version may know more keys.
  const ReadResult read = read_scene_text(of_run, folder.scene().string(), "", {});
  const std::string before = read.scene ? read.scene->resolved_toml : of_run;
  if (before == scene.resolved_toml) return;
  throw OutputFailure(
      fmt::format("{0}: was changed after the run began: {1}. The run belongs to the scene as it was. Put that back, "
                  "or run the changed scene anew: `strata run {0} --out DIR`, or `strata run {0} --out {2} --replace` "
                  "in the place of this run.",
                  folder.scene().string(), fmt::join(changes(lines_of(before), lines_of(scene.resolved_toml)), ", "),
                  folder.path.string()));
}

}  // namespace strata
