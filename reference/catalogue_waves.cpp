// The catalogue's entries for waves and suddenly loaded cracks.
#include <algorithm>

#include "catalogue.hpp"
#include "dynamics.hpp"

namespace strata::reference {
namespace {

std::vector<Input> heavy_rock() {
  return joined(rock_inputs("", 10e9), {positive_input("density_kg_m3", "rho", 2500)});
}

Entry wave_speeds_entry() {
  return {"wave_speeds",
          "speeds of dilatational, shear and Rayleigh waves",
          heavy_rock(),
          "Achenbach 1973, Wave propagation in elastic solids, chapter 5",
          "isotropic, plane strain",
          [](const Inputs& inputs) {
            const WaveSpeeds c = wave_speeds(rock_of(inputs, ""), inputs.number("density_kg_m3"));
            return Answer{{{"c_P_m_s", c.c_P, "m/s"}, {"c_S_m_s", c.c_S, "m/s"}, {"c_R_m_s", c.c_R, "m/s"}},
                          1e-14,
                          "closed form; root of Rayleigh's equation"};
          }};
}

Entry freund_step_pressure_entry() {
  return {"freund_step_pressure",
          "K_I(t) of a crack whose faces are pressed apart at once and from then on",
          joined(heavy_rock(), {number_input("pressure_Pa", "net pressure from t = 0 on", 1e6, -1e12, 1e12),
                                list_input("time_s", "since then; a list too", 1e-4),
                                positive_input("half_length_m", "a, for the time at which the other tip is felt", 5)}),
          "Freund 1990, Dynamic fracture mechanics, chapter 2",
          "semi-infinite crack that does not grow: exact for a crack 2a until valid_until_s = 2a/c_P",
          [](const Inputs& inputs) {
            const Rock rock = rock_of(inputs, "");
            const double density = inputs.number("density_kg_m3");
            const double p = inputs.number("pressure_Pa");
            const auto K = [&](double t) { return freund_step_pressure(rock, density, p, t); };
            const double until = 2 * inputs.number("half_length_m") / wave_speeds(rock, density).c_P;
            const auto times = inputs.numbers("time_s");
            const bool late = *std::max_element(times.begin(), times.end()) > until;
            return Answer{{{"K_I", at_each(inputs, "time_s", K), "Pa sqrt(m)"}, {"valid_until_s", until, "s"}},
                          late ? 1.0 : 1e-14,
                          late ? "none for a crack 2a: a time is beyond valid_until_s" : "closed form"};
          }};
}

Entry standing_wave() {
  return {
      "standing_wave",
      "frequencies of u = (A sin kx cos ky, B cos kx sin ky), k = 2 pi/side, in a square on rollers",
      joined(heavy_rock(), {positive_input("side_m", "of the square", 1)}),
      "insertion into Navier's equations",
      "small strain, plane strain; dilatation: A = B; shear: A = -B",
      [](const Inputs& inputs) {
        const StandingWaves f =
            standing_waves(rock_of(inputs, ""), inputs.number("density_kg_m3"), inputs.number("side_m"));
        return Answer{{{"f_dilatation_Hz", f.dilatation, "Hz"}, {"f_shear_Hz", f.shear, "Hz"}}, 1e-14, "closed form"};
      }};
}

}  // namespace

std::vector<Entry> wave_entries() {
  return {wave_speeds_entry(), freund_step_pressure_entry(), standing_wave()};
}

}  // namespace strata::reference
