// The catalogue's entries for cracks that are not straight, and for the paths they take.
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "arc_crack.hpp"
#include "catalogue.hpp"
#include "crack_path.hpp"

namespace strata::reference {
namespace {

std::vector<Input> plane_inputs(const std::string& interface) {
  return joined(joined(rock_inputs("", 5e9), rock_inputs("beyond_", 10e9, true)),
                {word_input("interface", "bonded at x = interface_x_m, or none: one rock", {"bonded", "none"}),
                 number_input("interface_x_m", interface, 5, -1e6, 1e6)});
}

std::vector<Input> stress_inputs(double s_xx, double s_yy) {
  return {number_input("s_xx_Pa", "in-situ stress, tension positive", s_xx, -1e12, 1e12),
          number_input("s_yy_Pa", "in-situ stress, tension positive", s_yy, -1e12, 1e12)};
}

CrackPlane plane_of(const Inputs& inputs, bool mirrored) {
  CrackPlane plane{rock_of(inputs, ""), {}, inputs.number("interface_x_m"), mirrored};
  if (inputs.word("interface") == "bonded") plane.beyond = rock_of(inputs, "beyond_");
  return plane;
}

void add_tip(std::vector<Value>& values, const std::string& tip, const CrackLine::Intensities& K, double E_prime) {
  values.push_back({"K_I" + tip, K.K_I, "Pa sqrt(m)"});
  values.push_back({"K_II" + tip, K.K_II, "Pa sqrt(m)"});
  values.push_back({"J" + tip + "_N_m", (K.K_I * K.K_I + K.K_II * K.K_II) / E_prime, "N/m"});
  values.push_back({"kink" + tip + "_deg", max_hoop_angle(K.K_I, K.K_II) * kDegrees, "deg"});
}

Answer solve_curved(const Inputs& inputs) {
  const auto x = inputs.numbers("x_m"), y = inputs.numbers("y_m");
  if (x.size() != y.size()) throw std::invalid_argument("x_m and y_m must have as many numbers");
  std::vector<Point> path;
  for (std::size_t i = 0; i < x.size(); ++i) path.emplace_back(x[i], y[i]);
  const CrackPlane plane = plane_of(inputs, inputs.word("mirror") == "y=0");
  const double P = inputs.number("pressure_Pa");
  const PathLoad load = in_situ_load([P](double) { return P; }, inputs.number("s_xx_Pa"), inputs.number("s_yy_Pa"));
  const CurvedCrack crack(path, plane, inputs.count("refine"));
  const auto solution = crack.solve(load);
  std::vector<Value> values;
  add_tip(values, "", solution.last, plane.rock.E_prime());
  add_tip(values, "_first", solution.first, plane.rock.E_prime());
  values.push_back({"opening_m", at_each(inputs, "s_m", [&](double s) { return crack.jump(solution, s)(0); }), "m"});
  values.push_back({"slip_m", at_each(inputs, "s_m", [&](double s) { return crack.jump(solution, s)(1); }), "m"});
  values.push_back({"volume_m2", crack.volume(solution), "m^2"});
  values.push_back({"length_m", crack.length(), "m"});
  return {std::move(values), std::max(crack.error(load), 1e-12), "change of K with elements half as long"};
}

Entry curved_crack() {
  return {
      "curved_crack",
      "pressurised crack along any polyline, in one rock or beside a bonded interface: K and kink angle of its tips",
      joined(joined(plane_inputs("m; the crack lies on one side"), stress_inputs(-2e6, -3e6)),
             {list_input("x_m", "points of the path", std::vector<double>{0, 0, -0.2}),
              list_input("y_m", "points of the path", std::vector<double>{0, 5, 8}),
              word_input("mirror", "y=0: the image (x, -y) is cracked too; or none", {"y=0", "none"}),
              number_input("pressure_Pa", "fluid pressure", 2.5e6, -1e12, 1e12),
              list_input("s_m", "where the opening is wanted, along the path from its first point", 2.5),
              number_input("refine", "so many times shorter elements", 1, 1, 16)}),
      "Suo 1989; elements of higher order: Crawford & Curran 1982; Crouch & Starfield 1983",
      "open and clear of the interface; the tip without suffix is the path's last point, K_II > 0 and kink < 0 turn it "
      "clockwise; _first: its first point (0 on the symmetry line); a smooth curve needs short end pieces",
      solve_curved};
}

Entry arc_crack_entry() {
  return {"arc_crack",
          "crack along an arc of a circle in the infinite plane, pressurised or under remote stress",
          joined({positive_input("radius_m", "R", 10), positive_input("half_angle_rad", "alpha, below pi", 0.5),
                  number_input("pressure_Pa", "net pressure", 1e6, -1e12, 1e12)},
                 stress_inputs(0, 0)),
          "Muskhelishvili 1953; Cotterell & Rice 1980",
          "chord along x, the arc's middle on top; the tip at the right; open everywhere",
          [](const Inputs& in) {
            const auto K = arc_crack(in.number("radius_m"), in.number("half_angle_rad"),
                                     {in.number("pressure_Pa"), in.number("s_xx_Pa"), in.number("s_yy_Pa")});
            return Answer{{{"K_I", K.K_I, "Pa sqrt(m)"},
                           {"K_II", K.K_II, "Pa sqrt(m)"},
                           {"kink_deg", max_hoop_angle(K.K_I, K.K_II) * kDegrees, "deg"}},
                          1e-14,
                          "closed form; round-off"};
          }};
}

GrowthRule rule_of(const Inputs& inputs) {
  GrowthRule rule;
  rule.toughness = inputs.number("toughness_Pa_sqrt_m");
  rule.increment = inputs.number("increment_m");
  rule.corrected = inputs.word("turning") == "corrected";
  rule.hold_pressure = inputs.word("pressure") == "held";
  rule.linear_profile = inputs.word("profile") == "linear";
  rule.stop_height = inputs.number("stop_height_m");
  rule.stop_growth = inputs.number("stop_growth_m");
  rule.stop_distance = inputs.number("stop_distance_m");
  return rule;
}

std::vector<Input> growth_inputs() {
  return {positive_input("half_length_m", "of the first crack, x = 0, |y| < a", 5),
          positive_input("toughness_Pa_sqrt_m", "K_Ic", 1.25e6),
          positive_input("increment_m", "length of an increment", 1),
          word_input("turning", "corrected: K_II = 0 after each increment; forward: by maximum hoop stress before it",
                     {"corrected", "forward"}),
          word_input("pressure", "held at what starts the growth, or critical at each increment", {"held", "critical"}),
          word_input("profile", "uniform, or falling linearly from y = 0 to nothing at the tip", {"uniform", "linear"}),
          positive_input("stop_height_m", "y of the tip", 15),
          positive_input("stop_growth_m", "length of new path", 20),
          positive_input("stop_distance_m", "of the next tip from the interface", 0.5)};
}

Answer solve_path(const Inputs& inputs) {
  const CrackPlane plane = plane_of(inputs, true);
  const InSituStress stress{inputs.number("s_xx_Pa"), inputs.number("s_yy_Pa")};
  const GrownPath grown = grow_path({0, Point(0, inputs.number("half_length_m"))}, plane, stress, rule_of(inputs));
  std::vector<double> x, y, K_I, K_II, pressure, turn;
  std::vector<Point> path{0};
  for (const PathStep& step : grown.steps) {
    path.push_back(step.tip);
    x.push_back(step.tip.real());
    y.push_back(step.tip.imag());
    K_I.push_back(step.K.K_I);
    K_II.push_back(step.K.K_II);
    pressure.push_back(step.pressure);
    turn.push_back(step.turn * kDegrees);
  }
  const double P = pressure.back();
  const bool linear = inputs.word("profile") == "linear";
  const CurvedCrack crack(path, plane);
  const double length = crack.length();
  const PathLoad load = in_situ_load([=](double s) { return linear ? P * (1 - s / length) : P; }, stress.xx, stress.yy);
  return {{{"x_m", x, "m"},
           {"y_m", y, "m"},
           {"K_I", K_I, "Pa sqrt(m)"},
           {"K_II", K_II, "Pa sqrt(m)"},
           {"pressure_Pa", pressure, "Pa"},
           {"kink_deg", turn, "deg"},
           {"stopped", grown.stopped, "word"}},
          std::max(crack.error(load), 1e-12),
          "change of K at the last tip with elements half as long; the increment's own error is not in it"};
}

Entry crack_path() {
  return {"crack_path",
          "path of a crack growing under fluid pressure beside a bonded interface: maximum hoop stress in increments",
          joined(joined(plane_inputs("m; the first crack is x = 0"), stress_inputs(-2e6, -3e6)), growth_inputs()),
          "as curved_crack; Erdogan & Sih 1963; Goldstein & Salganik 1974; Cotterell & Rice 1980",
          "infinite plane, mirrored in y = 0; a list an answer, its first number before any growth; ends before the "
          "interface; forward turning zigzags for increments that are not small, see crack_path.hpp",
          solve_path};
}

}  // namespace

std::vector<Entry> path_entries() {
  return {curved_crack(), arc_crack_entry(), crack_path()};
}

}  // namespace strata::reference
