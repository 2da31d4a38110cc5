// The catalogue's entries for flow: a channel of given opening, and a fracture fed at a rate.
#include <algorithm>
#include <cmath>

#include "catalogue.hpp"
#include "channel_flow.hpp"
#include "kgd.hpp"
#include "kgd_leakoff.hpp"

namespace strata::reference {
namespace {

std::vector<Input> fluid_inputs() {
  return {positive_input("viscosity_Pa_s", "mu", 0.1), positive_input("bulk_modulus_Pa", "M", 1e9),
          number_input("rate_Pa_s", "r of the inlet's ramp", 0.35e6, -1e15, 1e15)};
}

std::vector<Input> channel_inputs(const char* length_key, const char* opening_key, double opening, double time) {
  std::vector<Input> inputs{positive_input(length_key, "from the inlet to the end", 5),
                            positive_input(opening_key, "face to face", opening)};
  for (Input& input : fluid_inputs()) inputs.push_back(input);
  inputs.push_back(list_input("x_m", "from the inlet, within the channel", 2.5));
  inputs.push_back(number_input("time_s", "since the ramp began", time, 0, 1e15));
  return inputs;
}

Channel channel_of(const Inputs& inputs, const char* length_key, const char* opening_key) {
  return {inputs.number(length_key), inputs.number(opening_key), inputs.number("viscosity_Pa_s"),
          inputs.number("bulk_modulus_Pa"), inputs.number("rate_Pa_s")};
}

Answer answer_of(const Inputs& inputs, const Channel& channel, const std::function<double(double)>& pressure) {
  Answer answer;
  answer.values = {{"pressure_Pa", at_each(inputs, "x_m", pressure), "Pa"},
                   {"inlet_pressure_Pa", channel.rate * inputs.number("time_s"), "Pa"},
                   {"far_end_pressure_Pa", pressure(channel.length), "Pa"},
                   {"diffusivity_m2_s", channel.diffusivity(), "m^2/s"}};
  answer.relative_error = 1e-12;
  answer.error_basis = "of the inlet's pressure; two forms of the solution compared";
  return answer;
}

Entry ramp_entry(const char* name, const char* description, FarEnd end) {
  return {name,
          description,
          channel_inputs("length_m", "opening_m", 1e-4, 2),
          "Carslaw & Jaeger 1959, chapters 3 and 12",
          "constant opening, the study's linear law, rest at t = 0, any t >= 0",
          [end](const Inputs& inputs) {
            const Channel channel = channel_of(inputs, "length_m", "opening_m");
            const double t = inputs.number("time_s");
            return answer_of(inputs, channel, [&](double x) { return ramped_channel(channel, end, x, t); });
          }};
}

Entry channel_ellipse() {
  return {"channel_ellipse",
          "ramped inlet, elliptic opening w0 sqrt(1 - (x/a)^2), the study's law dP/dt = (M/mu) d/dx(w^2/12 dP/dx)",
          channel_inputs("half_length_m", "mouth_opening_m", 2e-4, 0.5),
          "own derivation: Legendre's equation, odd polynomials",
          "fixed elliptic opening, the study's law (no storage by opening), rest at t = 0, any t >= 0",
          [](const Inputs& inputs) {
            const Channel channel = channel_of(inputs, "half_length_m", "mouth_opening_m");
            const double t = inputs.number("time_s");
            Answer answer = answer_of(inputs, channel, [&](double x) { return ramped_ellipse(channel, x, t); });
            if (channel.diffusivity() * t < 1e-4 * channel.length * channel.length) answer.relative_error = 1e-11;
            return answer;
          }};
}

std::vector<Input> kgd_inputs() {
  return joined(rock_inputs("", 10e9), {number_input("toughness_Pa_sqrt_m", "K_Ic", 1.45e6, 0, 1e12),
                                        positive_input("viscosity_Pa_s", "mu", 0.1),
                                        positive_input("rate_m2_s", "Q_0, both wings together", 1e-3),
                                        positive_input("time_s", "since injection began", 10)});
}

Answer kgd_answer(const Inputs& inputs, const KgdState& state, double error, const char* basis) {
  const double number = kgd_toughness_number(rock_of(inputs, "").E_prime(), inputs.number("rate_m2_s"),
                                             inputs.number("viscosity_Pa_s"), inputs.number("toughness_Pa_sqrt_m"));
  return {{{"half_length_m", state.half_length, "m"},
           {"mouth_opening_m", state.mouth_opening, "m"},
           {"inlet_pressure_Pa", state.inlet_pressure, "Pa"},
           {"volume_m2", inputs.number("rate_m2_s") * inputs.number("time_s"), "m^2"},
           {"toughness_number", number, "1"}},
          error,
          basis};
}

Entry kgd_toughness_entry() {
  return {"kgd_toughness",
          "plane-strain hydraulic fracture at a constant rate, toughness-dominated: length, opening, net pressure",
          kgd_inputs(),
          "Detournay 2004; Griffith's crack holding the injected fluid",
          "no leak-off, incompressible fluid, infinite plane, toughness_number above about 4; net pressure",
          [](const Inputs& in) {
            const KgdState state = kgd_toughness(rock_of(in, "").E_prime(), in.number("rate_m2_s"), in.number("time_s"),
                                                 in.number("toughness_Pa_sqrt_m"));
            return kgd_answer(in, state, 1e-14, "closed form");
          }};
}

// The shape of one toughness number, and how far its numbers, and its profiles at xi, move from half the knots.
struct SettledShape {
  explicit SettledShape(double toughness_number, const std::vector<double>& xi = {}) : shape(toughness_number) {
    const KgdShape half(toughness_number, kKnots / 2);
    const double w = shape.opening(0), p = shape.pressure(0);
    error = std::abs(shape.length_factor() / half.length_factor() - 1);
    error = std::max({error, std::abs(half.opening(0) / w - 1), std::abs(half.pressure(0) / p - 1), 1e-9});
    for (double at : xi) {
      const double p_at = shape.pressure(at);
      error = std::max({error, std::abs(half.opening(at) - shape.opening(at)) / w,
                        std::abs(half.pressure(at) - p_at) / std::max(p, std::abs(p_at))});
    }
  }

  static constexpr int kKnots = 400;
  KgdShape shape;
  double error;
};

constexpr const char* kShapeError = "change of length, opening, pressure from half the knots, over the inlet's";

Entry kgd_viscosity_entry() {
  return {"kgd_viscosity",
          "plane-strain hydraulic fracture at a constant rate, viscosity-dominated: length, opening, net pressure",
          kgd_inputs(),
          "self-similar equations of Adachi & Detournay 2002, own solution",
          "no leak-off, incompressible fluid, infinite plane, no fluid lag, toughness_number below about 1 (kgd takes "
          "any); the mass balance w_t + q_x = 0, not the study's law; net pressure",
          [](const Inputs& in) {
            const SettledShape settled(0);
            const KgdShape& shape = settled.shape;
            const KgdState state = kgd_fracture(shape, rock_of(in, "").E_prime(), in.number("rate_m2_s"),
                                                in.number("time_s"), in.number("viscosity_Pa_s"));
            Answer answer = kgd_answer(in, state, settled.error, kShapeError);
            answer.values.push_back({"length_factor", shape.length_factor(), "1"});
            answer.values.push_back({"opening_factor", shape.opening(0), "1"});
            answer.values.push_back({"pressure_factor", shape.pressure(0), "1"});
            return answer;
          }};
}

Answer solve_kgd(const Inputs& in) {
  const double E_prime = rock_of(in, "").E_prime();
  const double rate = in.number("rate_m2_s"), mu = in.number("viscosity_Pa_s");
  const double number = kgd_toughness_number(E_prime, rate, mu, in.number("toughness_Pa_sqrt_m"));
  const SettledShape settled(number, in.numbers("xi"));
  const KgdShape& shape = settled.shape;
  const KgdState state = kgd_fracture(shape, E_prime, rate, in.number("time_s"), mu);
  const auto opening = [&](double xi) { return state.mouth_opening * shape.opening(xi) / shape.opening(0); };
  const auto pressure = [&](double xi) { return state.inlet_pressure * shape.pressure(xi) / shape.pressure(0); };
  Answer answer = kgd_answer(in, state, settled.error, kShapeError);
  answer.values.push_back({"opening_m", at_each(in, "xi", opening), "m"});
  answer.values.push_back({"pressure_Pa", at_each(in, "xi", pressure), "Pa"});
  return answer;
}

Entry kgd_entry() {
  Input xi = list_input("xi", "x/l, where opening and pressure are wanted", 0.5);
  xi.least = -1;
  xi.most = 1;
  xi.least_excluded = xi.most_excluded = true;
  return {"kgd",
          "plane-strain hydraulic fracture at a constant rate, any toughness and viscosity: length, opening, net "
          "pressure, profiles",
          joined(kgd_inputs(), {xi}),
          "self-similar for every toughness number (Spence & Sharp 1985; Adachi & Detournay 2002), own solution",
          "no leak-off, incompressible fluid, infinite plane, no fluid lag, tip at K_I = K_Ic; the mass balance "
          "w_t + q_x = 0, not the study's law; net pressure, without lower bound at the tip",
          solve_kgd};
}

// The fracture of references that others computed too (Dontsov 2017).
std::vector<Input> leakoff_inputs() {
  return joined(rock_inputs("", 20e9), {number_input("toughness_Pa_sqrt_m", "K_Ic", 1e6, 0, 1e12),
                                        positive_input("rate_m2_s", "Q_0, both wings together", 5e-5),
                                        number_input("leakoff_m_sqrt_s", "C_L of each face", 1e-5, 0, 1)});
}

Entry kgd_leakoff_entry() {
  return {
      "kgd_leakoff",
      "plane-strain hydraulic fracture at a constant rate with Carter leak-off, any toughness and viscosity: length, "
      "opening, net pressure, efficiency",
      joined(leakoff_inputs(),
             {positive_input("viscosity_Pa_s", "mu", 0.01), positive_input("time_s", "since injection began", 500)}),
      "lubrication, elasticity and Carter's law (Adachi & Detournay 2008), own solution marched in t^(1/6)",
      "Carter's law 2 C_L/sqrt(t - t_0) of both faces, no lag, incompressible fluid, infinite plane, tip at K_I = "
      "K_Ic; net pressure",
      [](const Inputs& in) {
        const double rate = in.number("rate_m2_s"), t = in.number("time_s");
        const SettledLeakoff settled = kgd_leakoff(rock_of(in, "").E_prime(), rate, t, in.number("viscosity_Pa_s"),
                                                   in.number("toughness_Pa_sqrt_m"), in.number("leakoff_m_sqrt_s"));
        Answer answer = kgd_answer(in, settled.state, settled.error,
                                   "what extrapolation from half the knots and half the steps adds, relative");
        answer.values[3].value = rate * t * settled.state.efficiency;
        answer.values.push_back({"efficiency", settled.state.efficiency, "1"});
        answer.values.push_back({"leaked_m2", rate * t * (1 - settled.state.efficiency), "m^2"});
        return answer;
      }};
}

Answer solve_shut_in(const Inputs& in) {
  const double E_prime = rock_of(in, "").E_prime();
  const auto at = [&](double ShutInState::*value, double time, int steps = 400) {
    return shut_in_fracture(E_prime, in.number("rate_m2_s"), in.number("shut_in_s"), in.number("toughness_Pa_sqrt_m"),
                            in.number("leakoff_m_sqrt_s"), time, steps).*
           value;
  };
  Answer answer;
  const auto add = [&](const char* name, double ShutInState::*value, const char* unit) {
    answer.values.push_back({name, at_each(in, "time_s", [&](double t) { return at(value, t); }), unit});
  };
  add("half_length_m", &ShutInState::half_length, "m");
  add("mouth_opening_m", &ShutInState::mouth_opening, "m");
  add("inlet_pressure_Pa", &ShutInState::inlet_pressure, "Pa");
  add("efficiency", &ShutInState::efficiency, "1");
  add("leaked_m2", &ShutInState::leaked, "m^2");
  const double t = in.numbers("time_s").front();
  answer.relative_error = 1e-12;
  using Number = double ShutInState::*;
  for (const Number value : {Number(&ShutInState::half_length), &ShutInState::leaked})
    answer.relative_error = std::max(answer.relative_error, std::abs(at(value, t, 200) / at(value, t) - 1));
  answer.error_basis = "change of length and leaked volume at the first time from half the steps";
  return answer;
}

Entry shut_in_entry() {
  Input time = list_input("time_s", "since injection began", 600.0);
  time.least = 0;
  time.least_excluded = true;
  return {
      "shut_in",
      "plane-strain fracture with Carter leak-off and a fluid without viscosity, fed until shut-in: length, opening, "
      "net pressure",
      joined(leakoff_inputs(), {positive_input("shut_in_s", "when the rate becomes 0", 500), time}),
      "own solution: Griffith's crack at K_I = K_Ic, then at rest, and Carter's law over its history",
      "uniform pressure (toughness_number of kgd_leakoff above about 4), no lag, incompressible fluid, infinite plane, "
      "until the fracture closes: then pressure and opening are 0; toughness above 0; net pressure",
      solve_shut_in};
}

}  // namespace

std::vector<Entry> flow_entries() {
  return {ramp_entry("channel_no_flux", "ramped inlet, constant opening, closed far end: pressure", FarEnd::no_flux),
          ramp_entry("channel_zero_pressure", "ramped inlet, constant opening, zero pressure at the far end: pressure",
                     FarEnd::zero_pressure),
          channel_ellipse(),
          kgd_toughness_entry(),
          kgd_viscosity_entry(),
          kgd_entry(),
          kgd_leakoff_entry(),
          shut_in_entry()};
}

}  // namespace strata::reference
