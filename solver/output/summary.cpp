#include "output/summary.hpp"

#include <limits>
#include <nlohmann/json.hpp>

#include "output/history.hpp"
#include "output/suspect.hpp"
#include "scene/derived.hpp"

namespace strata {
namespace {

using Json = nlohmann::ordered_json;

Json energy_json(const Ledger& ledger) {
  Json json;
  for (const auto& [name, value, description] : ledger_energies) json[name + std::string("_J")] = ledger.*value;
  json.update({{"stored_J", ledger.stored()},
               {"supplied_J", ledger.supplied()},
               {"dissipated_J", ledger.dissipated()},
               {"largest_J", ledger.largest},
               {"closure", ledger.closure()}});
  return json;
}

Json tips_json(const Scene& scene, const State& state) {
  Json tips = Json::array();
  for (const Tip& tip : state.tips) {
    const Vec2 x = tip_position(state, tip);
    const TipNumbers told = tip_numbers(scene, tip);
    tips.push_back({{"x_m", x.x()},
                    {"y_m", x.y()},
                    {"K_I_Pa_sqrt_m", told.K_I_Pa_sqrt_m},
                    {"K_II_Pa_sqrt_m", told.K_II_Pa_sqrt_m},
                    {"J_N_m", told.J_N_m},
                    {"J_spread", told.J_spread},
                    {"G_N_m", weighs_energy(tip) ? tip.G_trial : tip.G},
                    {"kink_deg", told.kink_deg},
                    {"reason", told.reason},
                    {"near", name_of(tip.near)},
                    {"at_interface", at_interface(tip)},
                    {"growing", tip.growing},
                    {"stopped_by", tip.stopped_by},
                    {"ring_m", tip.ring_m},
                    {"tip", tip_name(state, tip)}});
    if (scene.parts_by_energy()) tips.back()["G_along_N_m"] = tip.G_along;
  }
  return tips;
}

Json events_json(const std::vector<Event>& events) {
  Json list = Json::array();
  for (const Event& event : events) {
    list.push_back({{"kind", event.kind},
                    {"time_s", event.time_s},
                    {"inlet_Pa", event.inlet_Pa},
                    {"tip_x_m", event.tip_x_m},
                    {"tip_y_m", event.tip_y_m},
                    {"at_interface", event.at_interface},
                    {"by", event.by},
                    {"tip", event.tip}});
  }
  return list;
}

// Counts and sizes first, then the shares that are judged.
Json monitors_json(const Monitors& monitors, const std::vector<Watched>& shares) {
  Json json = {{"largest_courant", monitors.largest_courant},
               {"largest_penetration_m", monitors.largest_penetration},
               {"contact_sweeps", monitors.contact_sweeps},
               {"contact_unconverged", monitors.contact_unconverged},
               {"largest_particle_velocity_m_s", monitors.largest_particle_velocity},
               {"contact_residual", monitors.contact_residual},
               {"volume_balance", monitors.volume_balance},
               {"mirror", monitors.mirror != 0},
               {"growths", monitors.growths},
               {"growths_at_interfaces", monitors.growths_apart},
               {"growth_unweighed", monitors.growth_unweighed},
               {"largest_contact_Pa", monitors.largest_contact_Pa},
               {"largest_tension_Pa", monitors.largest_tension_Pa},
               {"largest_kinetic_J", monitors.largest_kinetic_J},
               {"largest_strain_J", monitors.largest_strain_J}};
  for (const Watched& share : shares) json[share.monitor] = share.value;
  return json;
}

Json suspect_json(const std::vector<Watched>& marks) {
  Json list = Json::array();
  for (const Watched& mark : marks) {
    // A figure that is only told marks a run, too, where it is no number.
    const Json threshold = mark.threshold ? Json(*mark.threshold) : Json(nullptr);
    list.push_back({{"monitor", mark.monitor}, {"value", mark.value}, {"threshold", threshold}, {"why", mark.why}});
  }
  return list;
}

}  // namespace

std::string version() {
  return STRATA_VERSION;
}

std::string summary_json(const Scene& scene, const State& state, const RunRecord& record) {
  Json summary;
  summary["scene"] = record.scene_name;
  summary["variant"] = scene.variant;
  summary["status"] = record.status;
  summary["reason"] = record.reason;
  summary["mechanics"] =
      scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics ? "explicit" : "quasistatic";
  summary["cells"] = static_cast<std::int64_t>(state.grid.nx) * state.grid.ny;
  summary["particles"] = state.particles.size();
  summary["steps"] = state.step;
  summary["time_s"] = state.time;
  summary["inlet_Pa"] = state.has_fracture ? state.fluid.inlet_Pa : 0.0;
  summary["wall_s"] = record.wall_s;
  summary["particle_steps_per_s"] = record.particle_steps / record.wall_s;
  const double none = std::numeric_limits<double>::quiet_NaN();
  summary["peak_memory_MB"] = bytes_by_system("/proc/self/status", "VmHWM:", none) / 1e6;
  summary["version"] = version();
  summary["threads"] = record.threads;
  summary["energy"] = energy_json(state.ledger);
  summary["mouth_opening_m"] = mouth_opening(state);
  summary["fracture_volume_m2"] = fracture_volume(state);
  if (scene.leaks()) summary["leaked_m2"] = leaked_volume(state);
  summary["tips"] = tips_json(scene, state);
  summary["events"] = events_json(state.events);
  summary["monitors"] = monitors_json(state.monitors, watched(scene, state));
  summary["suspect"] = suspect_json(suspicions(scene, state));
  // The library writes numbers that are not finite as null; bytes that are no UTF-8 are replaced, not refused.
  return summary.dump(2, ' ', false, Json::error_handler_t::replace) + '\n';
}

}  // namespace strata
