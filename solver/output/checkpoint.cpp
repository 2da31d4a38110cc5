#include "output/checkpoint.hpp"

#include <fmt/format.h>

#include <cstring>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>

#include "output/run_folder.hpp"

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
template <class Archive>
void fields(Archive& ar, Is<Grid> auto& grid) {
  auto& [nx, ny, h, x_knots, y_knots] = grid;
  ar(nx, ny, h, x_knots, y_knots);
}

template <class Archive>
void fields(Archive& ar, Is<Particles> auto& particles) {
  for_each_array(particles, [&](auto& array) { ar(array); });
  ar(particles.next_id);
}

template <class Archive>
void fields(Archive& ar, Is<SurfacePoint> auto& point) {
  auto& [x, n, A, arc, w, u, reaction, in_situ, bonded, P, slip, column, sides, split, failed_s] = point;
  ar(x, n, A, arc, w, u, reaction, in_situ, bonded, P, slip, column, sides, split, failed_s);
}

template <class Archive>
void fields(Archive& ar, Is<Surface> auto& surface) {
  auto& [kind, bit, law, vertices, points] = surface;
  ar(kind, bit, law, vertices, points);
}

template <class Archive>
void fields(Archive& ar, Is<FluidLine> auto& fluid) {
  auto& [P, inlet, inlet_Pa, w_rate] = fluid;
  ar(P, inlet, inlet_Pa, w_rate);
}

template <class Archive>
void fields(Archive& ar, Is<ReynoldsLine> auto& line) {
  auto& [length, P, phi, content, w, w_rate, rates_known, inlet, inlet_Pa] = line;
  ar(length, P, phi, content, w, w_rate, rates_known, inlet, inlet_Pa);
}

template <class Archive>
void fields(Archive& ar, Is<FluidBalance> auto& balance) {
  auto& [stored_at_start, injected, stored, largest] = balance;
  ar(stored_at_start, injected, stored, largest);
}

template <class Archive>
void fields(Archive& ar, Is<TipTie> auto& tie) {
  auto& [node, plus, minus, stiffness, s] = tie;
  ar(node, plus, minus, stiffness, s);
}

template <class Archive>
void fields(Archive& ar, Is<Tip> auto& tip) {
  auto& [at_back, growing, stopped_by, K_I, K_II, J, J_spread, ring_m, kink, turn, closed, near, crossed, no_length,
         last_growth_s, last_growth_Pa, due_s, runs_until_s, G_trial, G, G_by_J, criterion, grew_by, has_grown,
         arrested, reached] = tip;
  ar(at_back, growing, stopped_by, K_I, K_II, J, J_spread, ring_m, kink, turn, closed, near, crossed, no_length,
     last_growth_s, last_growth_Pa, due_s, runs_until_s, G_trial, G, G_by_J, criterion, grew_by, has_grown, arrested,
     reached);
}

template <class Archive>
void fields(Archive& ar, Is<Event> auto& event) {
  auto& [kind, time_s, inlet_Pa, tip_x_m, tip_y_m, at_interface, by] = event;
  ar(kind, time_s, inlet_Pa, tip_x_m, tip_y_m, at_interface, by);
}

template <class Archive>
void fields(Archive& ar, Is<Ledger> auto& ledger) {
  for (const auto& energy : ledger_energies) ar(ledger.*energy.value);
  ar(ledger.largest);
}

template <class Archive>
void fields(Archive& ar, Is<Monitors> auto& monitors) {
  auto& [largest_courant, largest_penetration, contact_sweeps, contact_unconverged, largest_particle_velocity,
         contact_residual, volume_balance, mirror, largest_open_J, largest_made_J, largest_strain_J, largest_kinetic_J,
         expected_x, expected_y, largest_drift, largest_momentum, force_balance, largest_imbalance, delivered_m2,
         growths, growths_apart, growth_unweighed, J_spread_sum, largest_J_spread, contact_left, largest_contact_Pa,
         largest_tension_Pa, largest_strain, largest_rotation, largest_jump, net_at_start_Pa, largest_net_Pa,
         flow_growths, flow_fall_Pa, flow_fall, largest_flow_fall, floor_share, floor_share_sum] = monitors;
  ar(largest_courant, largest_penetration, contact_sweeps, contact_unconverged, largest_particle_velocity,
     contact_residual, volume_balance, mirror, largest_open_J, largest_made_J, largest_strain_J, largest_kinetic_J,
     expected_x, expected_y, largest_drift, largest_momentum, force_balance, largest_imbalance, delivered_m2, growths,
     growths_apart, growth_unweighed, J_spread_sum, largest_J_spread, contact_left, largest_contact_Pa,
     largest_tension_Pa, largest_strain, largest_rotation, largest_jump, net_at_start_Pa, largest_net_Pa, flow_growths,
     flow_fall_Pa, flow_fall, largest_flow_fall, floor_share, floor_share_sum);
}

// All of the state but what rebuild_copies() derives of it.
template <class Archive>
void fields(Archive& ar, Is<State> auto& state) {
  ar(state.time, state.step, state.dt, state.grid, state.particles, state.surfaces, state.has_fracture, state.fluid);
  ar(state.reynolds, state.balance, state.tips, state.ties, state.events, state.ledger, state.monitors);
  ar(state.total.velocity);
}

template <class Archive>
void fields(Archive& ar, Is<OutputMark> auto& mark) {
  auto& [history, outputs] = mark;
  ar(history.rows, history.bytes, outputs);
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

}  // namespace strata
