// What the command line offers: every entry answers with its defaults, and bad input is refused with all its problems.
// Changes that were made to the catalogue and fail here: a file's comments, line ends, line numbers, blank lines or
// count of bad lines mistaken, the two stiffnesses exchanged, distance_at_K_Ic_m doubled.
#include <unistd.h>

#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <tuple>

#include "catalogue.hpp"

using namespace strata::reference;
using Catch::Contains;

namespace {

double value_of(const Answer& answer, const std::string& name) {
  for (const Value& value : answer.values)
    if (value.name == name) return std::get<double>(value.value);
  FAIL("no value " + name);
  return 0;
}

Answer solve(const std::string& name, const std::vector<std::string>& settings = {}) {
  const Entry entry = find_entry(name);
  return solved(entry, read_inputs(entry, settings));
}

std::string refusal(const std::string& name, const std::vector<std::string>& settings) {
  try {
    solve(name, settings);
  } catch (const std::invalid_argument& problem) {
    return problem.what();
  }
  return "accepted";
}

}  // namespace

TEST_CASE("every entry is documented and answers with its defaults") {
  std::set<std::string> names;
  for (const Entry& entry : catalogue()) {
    CHECK(names.insert(entry.name).second);
    for (const std::string& text : {entry.description, entry.source, entry.validity}) CHECK(text.size() > 10);
    std::set<std::string> keys;
    for (const Input& input : entry.inputs) CHECK(keys.insert(input.key).second);
    const Answer answer = solved(entry, read_inputs(entry, {}));
    CHECK(answer.relative_error > 0);
    CHECK(answer.relative_error < 1e-2);
    CHECK(answer.error_basis.size() > 5);
    for (const Value& value : answer.values) {
      INFO(entry.name << " " << value.name);
      CHECK(!value.unit.empty());
      if (const double* number = std::get_if<double>(&value.value)) CHECK(std::isfinite(*number));
    }
  }
}

TEST_CASE("settings reach the solution") {
  CHECK(value_of(solve("pressurised_crack"), "K_I") == Approx(1.981664e6).epsilon(1e-6));
  CHECK(value_of(solve("pressurised_crack", {"pressure=linear"}), "mouth_opening_m") ==
        Approx(0.654423e-3).epsilon(1e-6));
  CHECK(value_of(solve("pressurised_crack", {"pressure=profile", "profile_x_m=[-5, 5]", "profile_Pa=1e6,1e6"}),
                 "K_I") == Approx(2 * 1.981664e6).epsilon(1e-6));
  CHECK(value_of(solve("block_crack"), "critical_pressure_Pa") == Approx(2.35937e6).epsilon(2e-6));
  CHECK(value_of(solve("block_crack", {"edges=fixed"}), "F") == Approx(0.98129).epsilon(1e-5));
  CHECK(value_of(solve("bonded_normal"), "F_near") == Approx(1.11025).epsilon(1e-5));
  CHECK(value_of(solve("bonded_normal", {"youngs_modulus_Pa=5e9", "beyond_youngs_modulus_Pa=10e9"}), "F_far") ==
        Approx(0.96574).epsilon(1e-5));
  CHECK(value_of(solve("bonded_parallel"), "kink_deg") == Approx(-6.30).epsilon(1e-3));
  CHECK(value_of(solve("bonded_tip_exponent"), "exponent") == Approx(0.576243).epsilon(1e-6));
  CHECK(value_of(solve("spring_interface", {"law=free"}), "F_near") == Approx(1.4637).epsilon(1e-4));
  CHECK(value_of(solve("spring_interface", {"normal_stiffness_Pa_m=2083333333", "shear_stiffness_Pa_m=2083333333"}),
                 "F_near") == Approx(1.0704).epsilon(1e-4));
  const Answer slip = solve("coulomb_first_slip");
  CHECK(value_of(slip, "ratio") == Approx(0.8122).epsilon(1e-4));
  CHECK(value_of(slip, "K_I") == Approx(value_of(slip, "net_pressure_Pa") * std::sqrt(std::acos(-1.0) * 5)));
  // A tip at a small K_Ic makes the interface slip from that distance, which the finite crack reaches there as well.
  const double d = value_of(solve("coulomb_first_slip", {"toughness_Pa_sqrt_m=1.45e4"}), "distance_at_K_Ic_m");
  CHECK(value_of(solve("coulomb_first_slip", {"distance_m=" + std::to_string(d * 1e6) + "e-6"}), "K_I") ==
        Approx(1.45e4).epsilon(0.02));
  CHECK(value_of(solve("layered_wave", {"thickness_m=40", "youngs_modulus_Pa=10e9", "lateral=free", "width_m=1"}),
                 "u_m") !=
        value_of(solve("layered_wave", {"thickness_m=40", "youngs_modulus_Pa=10e9", "lateral=free"}), "u_m"));
  CHECK(value_of(solve("freund_step_pressure"), "K_I") == Approx(0.501643e6).epsilon(1e-6));
  CHECK(value_of(solve("wave_speeds"), "c_R_m_s") == Approx(1176.091).epsilon(1e-6));
  CHECK(value_of(solve("standing_wave"), "f_shear_Hz") == Approx(1825.742).epsilon(1e-6));
  // u = A/sqrt(2) at an eighth of the side; the wave that has crossed from stiff to soft rock: 2 Z1/(Z1 + Z2) = 1.17157
  CHECK(value_of(solve("manufactured_standing", {"y_m=0"}), "u_x_m") == Approx(1e-3 * std::sqrt(0.5)).epsilon(1e-9));
  CHECK(value_of(solve("manufactured_finite", {"angular_frequency_1_s=1000", "time_s=0.0015707963267948966"}),
                 "F_xx") == Approx(1 + 0.02 * std::acos(-1.0) * std::sqrt(0.5)).epsilon(1e-9));
  CHECK(value_of(solve("layered_wave", {"time_s=0.0114516", "pulse_velocity_m_s=2"}), "v_m_s") ==
        Approx(1.17157).epsilon(1e-4));
  const Answer list = solve("channel_no_flux", {"x_m=[0, 2.5]"});
  const auto pressures = std::get<std::vector<double>>(list.values.front().value);
  REQUIRE(pressures.size() == 2);
  CHECK(pressures[1] == Approx(380203.53).epsilon(1e-8));
}

TEST_CASE("settings reach the cut blocks") {
  const Answer crossed = solve("cut_blocks", {"order=6"});
  CHECK(value_of(crossed, "F") == Approx(1.0683).epsilon(1e-4));
  CHECK(value_of(crossed, "stored_J_m") == Approx(38475.4).epsilon(1e-6));
  CHECK(value_of(crossed, "critical_pressure_Pa") == Approx(0.7658e6).epsilon(1e-4));
  const Answer cut = solve("cut_blocks", {"width_m=30", "interface_m=40", "height_m=100", "youngs_modulus_Pa=7e9",
                                          "poisson_ratio=0.3", "pressure_Pa=2e6", "fresh_m=0", "shear_stiffness_Pa_m=0",
                                          "beyond_youngs_modulus_Pa=2e9", "y_m=39", "order=4"});
  CHECK(value_of(cut, "opening_m") == Approx(2e6 * 30 * 0.91 / 7e9).epsilon(1e-6));
  CHECK(value_of(cut, "volume_m2") == Approx(40 * value_of(cut, "cut_opening_m")).epsilon(1e-7));
  CHECK(value_of(cut, "stored_J_m") == Approx(value_of(cut, "cut_stored_J_m")).epsilon(1e-7));
  CHECK(value_of(solve("cut_blocks", {"slipped_m=0", "beyond_poisson_ratio=0.4", "order=4"}), "K_I") !=
        Approx(value_of(solve("cut_blocks", {"slipped_m=0", "order=4"}), "K_I")).epsilon(1e-3));
  CHECK(value_of(solve("crossing_pressure", {"order=6"}), "net_pressure_Pa") == Approx(1.0794e6).epsilon(3e-4));
  CHECK(value_of(solve("crossing_pressure", {"toughness_Pa_sqrt_m=2.9e6", "increment_m=2", "order=4"}),
                 "net_pressure_Pa") < 2 * 0.8 * 1.0794e6);
  const Answer ahead = solve("interface_ahead", {"slipped_m=8", "pressure_Pa=2e6", "shear_strength_Pa=1e6", "order=6"});
  CHECK(value_of(ahead, "shear_Pa") == Approx(2 * 1.74695e6).epsilon(1e-4));
  CHECK(value_of(ahead, "net_pressure_Pa") == Approx(1e6 / 1.74695).epsilon(1e-4));
  CHECK(value_of(solve("interface_ahead", {"order=6"}), "normal_Pa") == Approx(0.67413e6).epsilon(1e-3));
  CHECK(value_of(solve("sliding_blocks", {"order=4"}), "friction_work_J_m") == Approx(134.8).epsilon(1e-2));
  CHECK(value_of(solve("sliding_blocks", {"friction=0.2", "compression_Pa=6e6", "steps=2", "order=4"}),
                 "friction_work_J_m") < 100);
  CHECK_THAT(refusal("cut_blocks", {"fresh_m=70"}), Contains("below the block's top"));
  CHECK_THAT(refusal("interface_ahead", {"slipped_m=40"}), Contains("inside the block"));
}

TEST_CASE("numbers of unknowns reach the solution, and its error estimate holds for them") {
  const auto off = [](const std::string& name, const std::string& of, const std::string& setting) {
    const Answer asked = solve(name, {setting});
    const double error = std::abs(value_of(asked, of) / value_of(solve(name), of) - 1);
    INFO(name << " " << setting << ": " << error << ", estimate " << asked.relative_error);
    CHECK(error < asked.relative_error);
    return error;
  };
  for (const auto& [name, of, key] :
       {std::tuple{"block_crack", "K_I", "terms"}, std::tuple{"bonded_normal", "K_I_near", "nodes"},
        std::tuple{"bonded_parallel", "K_I", "nodes"}, std::tuple{"spring_interface", "K_I_near", "nodes"}}) {
    const std::string setting = std::string(key) + "=";
    const double coarse = off(name, of, setting + "4"), fine = off(name, of, setting + "16");
    CHECK(coarse > 1e-4);
    CHECK(fine < 1e-4);
    CHECK(fine < 0.01 * coarse);
  }
  CHECK(solve("curved_crack", {"refine=2"}).relative_error < 0.6 * solve("curved_crack").relative_error);
  CHECK_THAT(refusal("block_crack", {"terms=4.5"}), Contains("terms must be a whole number"));
  CHECK_THAT(refusal("spring_interface", {"nodes=-1"}), Contains("nodes"));
}

TEST_CASE("the error estimate speaks where accuracy is lost") {
  CHECK(solve("bonded_normal").relative_error == Approx(1e-10));
  // A profile with a jump, against the closed form of the plane: within the estimate.
  const std::vector<std::string> jump = {"pressure=profile", "profile_x_m=-5,-3,-3,5", "profile_Pa=1e6,1e6,2e5,2e5"};
  std::vector<std::string> equal = jump;
  equal.push_back("beyond_youngs_modulus_Pa=10e9");
  const Answer line = solve("bonded_normal", equal), plane = solve("pressurised_crack", jump);
  for (const auto& [of_line, of_plane] :
       {std::pair{"K_I_far", "K_I"}, std::pair{"K_I_near", "K_I_minus"},
        std::pair{"mouth_opening_m", "mouth_opening_m"}, std::pair{"volume_m2", "volume_m2"}})
    CHECK(std::abs(value_of(line, of_line) / value_of(plane, of_plane) - 1) < line.relative_error);
  CHECK(line.relative_error < 1e-8);
  CHECK(solve("pressurised_crack", {"pressure=profile", "profile_x_m=-5,0,1e-6,5", "profile_Pa=1e6,1e6,0,0"})
            .relative_error > 1e-10);
  CHECK(solve("bonded_tip_exponent", {"beyond_youngs_modulus_Pa=1e-2"}).relative_error > 1e-12);
  CHECK(solve("freund_step_pressure", {"time_s=1e-4,1e-2"}).relative_error == 1.0);
  CHECK(solve("freund_step_pressure", {"time_s=1e-4,4e-3"}).relative_error < 1e-12);
  CHECK(solve("channel_ellipse").relative_error == 1e-12);
  CHECK(solve("channel_ellipse", {"time_s=1e-6"}).relative_error == 1e-11);
  // Blocks too slender for the series, and overflow, are no answers.
  CHECK_THROWS_WITH(solve("block_crack", {"width_m=800", "half_height_m=10", "edges=fixed"}), Contains("too slender"));
  CHECK_THROWS_WITH(solve("kgd_toughness", {"time_s=1e300", "rate_m2_s=1e200"}), Contains("not finite"));
}

TEST_CASE("the fracture between the vertices") {
  const Answer viscous = solve("kgd", {"toughness_Pa_sqrt_m=0"}), vertex = solve("kgd_viscosity");
  const Answer tough = solve("kgd", {"viscosity_Pa_s=1e-12"}), other = solve("kgd_toughness", {"viscosity_Pa_s=1e-12"});
  for (const char* name : {"half_length_m", "mouth_opening_m", "inlet_pressure_Pa"}) {
    CHECK(value_of(viscous, name) == Approx(value_of(vertex, name)).epsilon(1e-9));
    CHECK(std::abs(value_of(tough, name) / value_of(other, name) - 1) < tough.relative_error);
  }
  const Answer list = solve("kgd", {"xi=0,-0.5,0.5"});
  for (const Value& value : list.values)
    if (const auto* profile = std::get_if<std::vector<double>>(&value.value)) {
      CHECK(profile->at(0) == Approx(value_of(list, value.unit == "m" ? "mouth_opening_m" : "inlet_pressure_Pa")));
      CHECK(profile->at(1) == profile->at(2));
    }
  CHECK_THAT(refusal("kgd", {"xi=0,1"}), Contains("1 is outside (-1, 1)"));
}

TEST_CASE("bad input is refused, every problem on a line") {
  CHECK_THROWS_WITH(find_entry("block_crak"), Contains("unknown name block_crak. Did you mean block_crack?"));
  const std::string all = refusal("block_crack", {"edgs=fixed", "poisson_ratio=0.5", "edges=fixd", "x_m=a", "width_m"});
  CHECK_THAT(all, Contains("unknown key edgs. Did you mean edges?"));
  CHECK_THAT(all, Contains("\n--set poisson_ratio=0.5: 0.5 is outside [0, 0.5)."));
  CHECK_THAT(all, Contains("\n--set edges=fixd: \"fixd\" is not a choice. Did you mean fixed?"));
  CHECK_THAT(all, Contains("\n--set x_m=a: \"a\" is not a number."));
  CHECK_THAT(all, Contains("\n--set width_m: expected key=value."));
  CHECK_THAT(refusal("block_crack", {"width_m=1", "width_m=2"}), Contains("set twice"));
  CHECK_THAT(refusal("block_crack", {"half_length_m=1,2"}), Contains("not a number"));
  CHECK_THAT(refusal("block_crack", {"half_length_m=79"}), Contains("0.9 half_height"));
  CHECK_THAT(refusal("block_crack", {"pressure=profile", "profile_Pa=0,1,2"}), Contains("symmetric"));
  CHECK_THAT(refusal("channel_no_flux", {"x_m=9"}), Contains("outside"));
  CHECK_THAT(refusal("channel_no_flux", {"viscosity_Pa_s=nan"}), Contains("not a number"));
}

TEST_CASE("a stiffness that the interface's law does not have is refused") {
  for (const char* law : {"law=free", "law=frictionless"}) {
    CHECK_THAT(refusal("spring_interface", {law, "normal_stiffness_Pa_m=1e9"}),
               Contains("normal_stiffness_Pa_m is given, but " + std::string(law) + " means"));
    CHECK_THAT(refusal("spring_interface", {"shear_stiffness_Pa_m=0.5e6", law}),
               Contains("shear_stiffness_Pa_m is given, but " + std::string(law) + " means 0. Leave it out"));
    CHECK(refusal("spring_interface", {law, "shear_stiffness_Pa_m=0"}) == "accepted");
  }
  CHECK_THAT(refusal("spring_interface", {"law=frictionless", "normal_stiffness_Pa_m=0"}), Contains("an infinite one"));
  const auto F = [](const std::vector<std::string>& settings) {
    return value_of(solve("spring_interface", settings), "F_near");
  };
  CHECK(F({"law=frictionless"}) == Approx(1.3659).epsilon(2e-3));
  CHECK(F({"law=free", "normal_stiffness_Pa_m=0", "shear_stiffness_Pa_m=0"}) == F({"law=free"}));
  // Each stiffness is its own direction's: all but closed, and all but fixed in shear.
  CHECK(F({"normal_stiffness_Pa_m=1e20", "shear_stiffness_Pa_m=0"}) == Approx(F({"law=frictionless"})).epsilon(1e-6));
  CHECK(F({"normal_stiffness_Pa_m=0", "shear_stiffness_Pa_m=1e20"}) != Approx(F({"law=frictionless"})).epsilon(1e-3));
}

TEST_CASE("a list may come from a file, one number a line") {
  std::string name = (std::filesystem::temp_directory_path() / "strata-reference-XXXXXX").string();
  const std::filesystem::path folder = ::mkdtemp(name.data());  // another test may run at the same time
  const auto file = [&](const std::string& name, const std::string& content) {
    std::ofstream(folder / name, std::ios::binary) << content;
    return (folder / name).string();
  };
  const auto opening = [](const Answer& answer) {
    for (const Value& value : answer.values)
      if (value.name == "opening_m") return std::get<std::vector<double>>(value.value);
    return std::vector<double>{};
  };
  const std::string three = file("three.csv", "# x in m\n0\r\n\r\n\n  3.0 # off the middle\r\n-4e0");
  const auto w = opening(solve("pressurised_crack", {"x_m=@" + three}));
  REQUIRE(w.size() == 3);
  CHECK(w == opening(solve("pressurised_crack", {"x_m=0,3,-4"})));
  CHECK(opening(solve("pressurised_crack", {"x_m=@" + file("one.csv", "3\n")})).size() == 1);
  CHECK(value_of(solve("pressurised_crack", {"pressure=profile", "profile_x_m=@" + file("x.csv", "-5\n5\n"),
                                             "profile_Pa=@" + file("p.csv", "1e6\n1e6\n")}),
                 "K_I") == Approx(2 * 1.981664e6).epsilon(1e-6));

  const std::string bad = refusal("pressurised_crack", {"x_m=@" + file("bad.csv", "1\n1,2\nx\n")});
  CHECK_THAT(bad, Contains("bad.csv:2: \"1,2\" is not a number."));
  CHECK_THAT(bad, Contains("bad.csv:3: \"x\" is not a number."));
  const std::string seven = refusal("pressurised_crack", {"x_m=@" + file("seven.csv", "a\nb\nc\nd\ne\nf\ng\n")});
  CHECK_THAT(seven, Contains("seven.csv:5: \"e\"") && !Contains("seven.csv:6") && Contains("\n  and 2 lines more."));
  CHECK_THAT(refusal("pressurised_crack", {"x_m=@" + file("one_bad.csv", "1\nx\n")}), !Contains("more."));
  CHECK_THAT(refusal("kgd", {"xi=@" + file("xi.csv", "0.5\n1\n")}), Contains("xi.csv:2: 1 is outside (-1, 1)"));
  CHECK_THAT(refusal("pressurised_crack", {"x_m=@" + (folder / "none.csv").string()}), Contains("cannot read"));
  CHECK_THAT(refusal("pressurised_crack", {"x_m=@" + folder.string()}), Contains("cannot read"));
  CHECK_THAT(refusal("pressurised_crack", {"x_m=@" + file("empty.csv", "# nothing\n")}), Contains("holds no number"));
  CHECK_THAT(refusal("pressurised_crack", {"half_length_m=@" + three}), Contains("takes one number"));
  std::filesystem::remove_all(folder);
}

// Fails without the refusal in knots_of().
TEST_CASE("a profile that the pressure does not use is refused") {
  for (const std::string name : {"pressurised_crack", "bonded_normal", "spring_interface"}) {
    CHECK_THAT(refusal(name, {"profile_Pa=1e6,1e6,1e6"}), Contains("pressure=uniform does not use it"));
    CHECK_THAT(refusal(name, {"pressure=linear", "profile_x_m=-5,0,5"}), Contains("pressure=linear does not use it"));
  }
  CHECK(refusal("pressurised_crack", {"pressure=profile", "profile_x_m=-5,5", "profile_Pa=1e6,1e6"}) == "accepted");
}
