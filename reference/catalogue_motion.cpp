// The catalogue's entries for motions that are known everywhere: manufactured ones, and waves in a column of layers.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "catalogue.hpp"
#include "layered_wave.hpp"
#include "manufactured.hpp"

namespace strata::reference {
namespace {

using Eigen::Vector2d;

// Waves of an input that counts them.
int whole(const Inputs& inputs, const std::string& key) {
  const double number = inputs.number(key);
  if (number != std::round(number)) throw std::invalid_argument(key + " must be a whole number");
  return static_cast<int>(number);
}

std::vector<Input> points(double x, double y, double time) {
  return {list_input("x_m", "material points, in the unstrained rock", x),
          list_input("y_m", "as many as x_m, or one for all of them", y), number_input("time_s", "t", time, 0, 1e9)};
}

std::vector<Input> square_rock() {
  return joined(rock_inputs("", 10e9), {positive_input("density_kg_m3", "rho", 2500),
                                        positive_input("side_m", "of the square, from the origin", 1),
                                        number_input("angular_frequency_1_s", "w", 0, -1e9, 1e9)});
}

// Numbers of a list repeated to a length. Throws where the list has another length, and more than one number.
std::vector<double> repeated(const Inputs& inputs, const std::string& key, std::size_t count) {
  std::vector<double> numbers = inputs.numbers(key);
  if (numbers.size() == 1) numbers.assign(count, numbers.front());
  if (numbers.size() != count) throw std::invalid_argument(key + " must hold " + std::to_string(count) + " numbers");
  return numbers;
}

using Picked = double (*)(const MotionAt&);

struct Field {
  const char* name;
  const char* unit;
  Picked pick;
};

// J sigma and J itself beside the fields themselves: a code that keeps volumes holds Kirchhoff's stress.
constexpr Field kKinematic[] = {{"u_x_m", "m", [](const MotionAt& p) { return p.u.x(); }},
                                {"u_y_m", "m", [](const MotionAt& p) { return p.u.y(); }},
                                {"v_x_m_s", "m/s", [](const MotionAt& p) { return p.v.x(); }},
                                {"v_y_m_s", "m/s", [](const MotionAt& p) { return p.v.y(); }},
                                {"sigma_xx_Pa", "Pa", [](const MotionAt& p) { return p.sigma(0, 0); }},
                                {"sigma_yy_Pa", "Pa", [](const MotionAt& p) { return p.sigma(1, 1); }},
                                {"sigma_xy_Pa", "Pa", [](const MotionAt& p) { return p.sigma(0, 1); }},
                                {"b_x_m_s2", "m/s^2", [](const MotionAt& p) { return p.b.x(); }},
                                {"b_y_m_s2", "m/s^2", [](const MotionAt& p) { return p.b.y(); }}};
constexpr Field kGradient[] = {
    {"F_xx", "1", [](const MotionAt& p) { return p.F(0, 0); }},
    {"F_xy", "1", [](const MotionAt& p) { return p.F(0, 1); }},
    {"F_yx", "1", [](const MotionAt& p) { return p.F(1, 0); }},
    {"F_yy", "1", [](const MotionAt& p) { return p.F(1, 1); }},
    {"det_F", "1", [](const MotionAt& p) { return p.F.determinant(); }},
    {"tau_xx_Pa", "Pa", [](const MotionAt& p) { return p.F.determinant() * p.sigma(0, 0); }},
    {"tau_yy_Pa", "Pa", [](const MotionAt& p) { return p.F.determinant() * p.sigma(1, 1); }},
    {"tau_xy_Pa", "Pa", [](const MotionAt& p) { return p.F.determinant() * p.sigma(0, 1); }}};

// Fields of a motion at all points: numbers for a single point, else lists.
Answer motion_answer(const Inputs& inputs, bool finite, const std::function<MotionAt(const Vector2d&)>& at) {
  const std::size_t count = std::max(inputs.numbers("x_m").size(), inputs.numbers("y_m").size());
  const std::vector<double> x = repeated(inputs, "x_m", count), y = repeated(inputs, "y_m", count);
  std::vector<MotionAt> found;
  for (std::size_t i = 0; i < count; ++i) found.push_back(at({x[i], y[i]}));
  const bool one = std::holds_alternative<double>(inputs["x_m"]) && std::holds_alternative<double>(inputs["y_m"]);
  Answer answer;
  const auto add = [&](const Field& field) {
    std::vector<double> values;
    for (const MotionAt& point : found) values.push_back(field.pick(point));
    answer.values.push_back({field.name, one ? InputValue(values.front()) : InputValue(values), field.unit});
  };
  std::for_each(std::begin(kKinematic), std::end(kKinematic), add);
  if (finite) std::for_each(std::begin(kGradient), std::end(kGradient), add);
  answer.relative_error = 1e-13;
  answer.error_basis = "closed form; round-off";
  return answer;
}

Entry standing_entry() {
  std::vector<Input> inputs = joined(square_rock(), points(0.125, 0.25, 0));
  inputs.push_back(number_input("A_m", "amplitude of u_x", 1e-3, -1e9, 1e9));
  inputs.push_back(number_input("B_m", "amplitude of u_y", 1e-3, -1e9, 1e9));
  inputs.push_back(number_input("waves", "wave lengths along a side", 1, 1, 1000));
  inputs.push_back(word_input("time", "T = cos wt or sin wt; w = 0 with the cosine is static", {"cosine", "sine"}));
  return {
      "manufactured_standing",
      "u = (A sin kx cos ky, B cos kx sin ky) T(t), k = 2 pi waves/side, in a square on rollers, and its body force",
      inputs,
      "insertion into Navier's equations; Wallstedt & Guilkey 2008, doi 10.1016/j.jcp.2008.07.019",
      "small strain, plane strain; exact for any place and time; b = (b_x_amplitude sin kx cos ky, b_y_amplitude "
      "cos kx sin ky) T",
      [](const Inputs& in) {
        const StandingMotion motion{
            rock_of(in, ""),          in.number("density_kg_m3"),           in.number("side_m"),
            whole(in, "waves"),       {in.number("A_m"), in.number("B_m")}, in.number("angular_frequency_1_s"),
            in.word("time") == "sine"};
        Answer answer =
            motion_answer(in, false, [&](const Vector2d& place) { return motion.at(place, in.number("time_s")); });
        answer.values.push_back({"b_x_amplitude_m_s2", motion.body_amplitude().x(), "m/s^2"});
        answer.values.push_back({"b_y_amplitude_m_s2", motion.body_amplitude().y(), "m/s^2"});
        return answer;
      }};
}

Entry finite_entry() {
  std::vector<Input> inputs = joined(square_rock(), points(0.125, 0.25, 0));
  inputs.push_back(number_input("amplitude_m", "A", 0.01, -1e9, 1e9));
  inputs.push_back(number_input("halves", "n, half wave lengths along a side", 2, 1, 1000));
  inputs.push_back(number_input("phase_rad", "of u_y", 0, -1e9, 1e9));
  inputs.push_back(word_input("law", "J sigma = lambda ln J I + 2 mu ln V, or lambda ln J I + mu (F F^T - I)",
                              {"hencky", "neo-hookean"}));
  return {"manufactured_finite",
          "u_x = A sin(n pi X/side) sin(wt), u_y = A sin(n pi Y/side) sin(wt + phase) at finite strain, and its body "
          "force",
          inputs,
          "Kamojjala et al. 2015, doi 10.1007/s00366-013-0342-x (neo-Hookean); own derivation for ln V",
          "plane strain; material points of the unstrained square; rollers all round; n pi |A|/side < 1",
          [](const Inputs& in) {
            const AxisMotion motion{rock_of(in, ""),
                                    in.word("law") == "hencky" ? FiniteLaw::hencky : FiniteLaw::neo_hookean,
                                    in.number("density_kg_m3"),
                                    in.number("side_m"),
                                    whole(in, "halves"),
                                    in.number("amplitude_m"),
                                    in.number("angular_frequency_1_s"),
                                    in.number("phase_rad")};
            return motion_answer(in, true,
                                 [&](const Vector2d& place) { return motion.at(place, in.number("time_s")); });
          }};
}

Entry vortex_entry() {
  std::vector<Input> inputs =
      joined(joined(rock_inputs("", 10e9), {positive_input("density_kg_m3", "rho", 2500),
                                            number_input("angular_frequency_1_s", "w", 1000, -1e9, 1e9)}),
             points(1.1, 0, 1e-3));
  inputs.push_back(positive_input("inner_m", "radius below which all rests", 0.75));
  inputs.push_back(positive_input("outer_m", "radius beyond which all rests", 1.25));
  inputs.push_back(number_input("turn_rad", "G, largest turn of the middle circle", 1, -1e3, 1e3));
  return {
      "manufactured_vortex",
      "a ring turned by alpha = G (1 - q^2)^2 sin(wt), q from -1 to 1 across it, neo-Hookean, and its body force",
      inputs,
      "Kamojjala et al. 2015, doi 10.1007/s00366-013-0342-x",
      "plane strain, finite strain and rotation; material points from the ring's centre; b jumps on the ring's "
      "borders, stress does not",
      [](const Inputs& in) {
        const VortexMotion motion{rock_of(in, ""),      in.number("density_kg_m3"), in.number("inner_m"),
                                  in.number("outer_m"), in.number("turn_rad"),      in.number("angular_frequency_1_s")};
        return motion_answer(in, true, [&](const Vector2d& place) { return motion.at(place, in.number("time_s")); });
      }};
}

std::vector<Input> column_inputs() {
  Input thickness = list_input("thickness_m", "of the layers, from the bottom", std::vector<double>{20, 20});
  Input E = list_input("youngs_modulus_Pa", "E of each layer, or one for all", std::vector<double>{10e9, 5e9});
  Input nu = list_input("poisson_ratio", "nu of each layer, or one for all", 0.2);
  Input density = list_input("density_kg_m3", "rho of each layer, or one for all", 2500.0);
  Input spring = list_input("spring_Pa_m", "D of each border, or one for all; 1e30: bonded; 0: apart", 1e30);
  for (Input* input : {&thickness, &E, &density}) input->least = 0, input->least_excluded = true;
  nu.least = 0, nu.most = 0.5, nu.most_excluded = true;
  spring.least = 0;
  return {
      thickness,
      E,
      nu,
      density,
      spring,
      word_input("lateral", "held: plane wave; free: thin bar, plane strain along its other side", {"held", "free"}),
      number_input("width_m", "of a bar of one layer, for its lateral inertia; 0: thin", 0, 0, 1e9),
      word_input("bottom", "end at y = 0", {"held", "free"}),
      word_input("top", "the other end", {"held", "free"}),
      word_input("pulse", "V exp(-q^2), or V cos^2(pi q/2) for |q| < 1; q = (y - middle)/half_width",
                 {"gaussian", "cosine_squared"}),
      number_input("pulse_middle_m", "middle of the pulse", 10, -1e9, 1e9),
      positive_input("pulse_half_width_m", "of the pulse", 2),
      number_input("pulse_velocity_m_s", "V", 1, -1e9, 1e9),
      list_input("y_m", "where it is wanted", 30.0),
      number_input("time_s", "since the pulse was there", 0.01, 0, 1e9)};
}

LayeredWave column_of(const Inputs& in) {
  const std::vector<double> thickness = in.numbers("thickness_m");
  const std::size_t n = thickness.size();
  const std::vector<double> E = repeated(in, "youngs_modulus_Pa", n), nu = repeated(in, "poisson_ratio", n),
                            density = repeated(in, "density_kg_m3", n);
  const bool bar = in.word("lateral") == "free";
  const double width = in.number("width_m");
  if (width > 0 && !bar) throw std::invalid_argument("width_m is for lateral=free");
  std::vector<WaveLayer> layers;
  for (std::size_t j = 0; j < n; ++j) {
    const Rock rock{E[j], nu[j]};
    const double plane = E[j] * (1 - nu[j]) / ((1 + nu[j]) * (1 - 2 * nu[j]));
    layers.push_back(
        {thickness[j], bar ? rock.E_prime() : plane, density[j], nu[j] / (1 - nu[j]) * width / std::sqrt(12.0)});
  }
  const auto end = [&](const char* key) { return in.word(key) == "held" ? WaveEnd::held : WaveEnd::free; };
  const VelocityPulse pulse{
      in.word("pulse") == "gaussian" ? VelocityPulse::Form::gaussian : VelocityPulse::Form::cosine_squared,
      in.number("pulse_middle_m"), in.number("pulse_half_width_m"), in.number("pulse_velocity_m_s")};
  const std::vector<double> springs = n > 1 ? repeated(in, "spring_Pa_m", n - 1) : std::vector<double>{};
  return LayeredWave(layers, springs, end("bottom"), end("top"), pulse);
}

Entry layered_wave_entry() {
  return {
      "layered_wave",
      "plane waves along a column of layers, bonded or on springs, from a pulse of velocity: u, v, stress",
      column_inputs(),
      "sum over normal modes, Courant & Hilbert 1953, chapters V and VI; Achenbach 1973, chapter 1; lateral inertia "
      "Love 1927, article 278",
      "linear, undamped, at rest in u at t = 0; springs act alike in tension and compression; a bar with "
      "free sides is for wave lengths long against its width, beginning with v_x = -nu/(1-nu) x dv/dy (x from its "
      "middle) where width_m is given; a pulse that is not zero on a held end or a border converges "
      "slowly (see the error estimate)",
      [](const Inputs& in) {
        const LayeredWave wave = column_of(in);
        const double t = in.number("time_s");
        Answer answer;
        answer.values = {{"u_m", at_each(in, "y_m", [&](double y) { return wave.at(y, t).u; }), "m"},
                         {"v_m_s", at_each(in, "y_m", [&](double y) { return wave.at(y, t).v; }), "m/s"},
                         {"stress_Pa", at_each(in, "y_m", [&](double y) { return wave.at(y, t).stress; }), "Pa"},
                         {"height_m", wave.height(), "m"},
                         {"travel_time_s", wave.travel_time(), "s"},
                         {"energy_J_m2", wave.energy(), "J/m^2"}};
        answer.relative_error = wave.error();
        answer.error_basis = "of v, and of stress/impedance, to the pulse's V: what the upper half of all modes adds";
        return answer;
      }};
}

}  // namespace

std::vector<Entry> motion_entries() {
  return {standing_entry(), finite_entry(), vortex_entry(), layered_wave_entry()};
}

}  // namespace strata::reference
