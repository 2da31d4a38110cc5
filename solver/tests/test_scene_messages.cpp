// What is said of values that are typed as people write them, and not as TOML or a key takes them.
#include "scene/messages.hpp"
#include "scene/syntax.hpp"
#include "scene_text.hpp"

using namespace strata;
using namespace scene_test;

namespace {

constexpr const char* modulus = "youngs_modulus_Pa = 10e9";

// What is said of `value` in the place of the stiff rock's modulus.
std::string of_modulus(const std::string& value) {
  return errors(with(layered, modulus, "youngs_modulus_Pa = " + value));
}

std::string of_path(const std::string& value) {
  return errors(with(layered, "path_m = [[40, 0], [40, 5]]", "path_m = " + value));
}

std::size_t lines_in(const std::string& text) {
  return static_cast<std::size_t>(std::count(text.begin(), text.end(), '\n'));
}

std::string repeated(const std::string& what, std::size_t times) {
  std::string text;
  for (std::size_t k = 0; k < times; ++k) text += what;
  return text;
}

}  // namespace

TEST_CASE("A number with something that TOML does not take gets the number to type") {
  const std::pair<const char*, const char*> typed[] = {
      {"10,0e9", "Write 10.0e9: the decimal sign is a point."},
      {"0,35e6", "Write 0.35e6: the decimal sign is a point."},
      {"-0,5", "Write -0.5: the decimal sign is a point."},
      {"10,000", "Write 10.000, or 10000 where the comma groups digits: the decimal sign is a point."},
      {"10,000,000", "Write 10000000: nothing stands between digits."},
      {"1.234.567,8", "Write 1234567.8: the decimal sign is a point."},
      {"10 000 000", "Write 10000000: nothing stands between digits."},
      {"10'000'000", "Write 10000000: nothing stands between digits."},
      {"10 GPa", "Write 10e9: the unit, Pa, stands in the key."},
      {"10GPa", "Write 10e9: the unit, Pa, stands in the key."},
      {"10.0e9 Pa", "Write 10.0e9: the unit, Pa, stands in the key."},
      {"10e9Pa", "Write 10e9: the unit, Pa, stands in the key."},
      {"1.5e1 GPa", "Write 1.5e10: the unit, Pa, stands in the key."},
      {"10,5 GPa", "Write 10.5e9: the unit, Pa, stands in the key."},
      {"10,000 MPa", "Write 10.000e6, or 10000e6 where the comma groups digits: the unit, Pa, stands in the key."},
      {"10000 Mpa", "Write 10000e6: the unit, Pa, stands in the key."},
      {"10\u00a0GPa", "Write 10e9: the unit, Pa, stands in the key."},
      {"10000 mpa", "Write the number alone, in Pa."},  // milli or mega
      {"1.5e6 psi", "Write the number alone, in Pa."},
      {"10 %", "Write the number alone, in Pa."},
      {"10e9 // Young", "Write 10e9: a comment begins with #."},
      {"10e9;", "Write 10e9: a comment begins with #."},
      {".5e9", "Write 0.5e9."},
      {"10.", "Write 10."},
      {"10.e9", "Write 10e9."},
      {"10d9", "Write 10e9."},
      {"10 e9", "Write 10e9."},
      {"10*10^9", "Write 10e9."},
      {"1 x 10^10", "Write 1e10."},
      {"007", "Write 7."},
      {"\u221210e9", "Write -10e9."},
      {"10*1e9", "Write one number, worked out."},
      {"1/3", "Write one number, worked out."},
      {"99999999999999999999", "Write it with few digits and an exponent"},
      {"1e400", "Write it with few digits and an exponent"},
      {"stiff", "Write a number."},
      {"", "Give it a value."},
      {"\u201c10e9\u201d", "Use straight quotes, \"...\"."},
      {"\"10e9", "Close the quotes."},
  };
  for (const auto& [value, advice] : typed) {
    CAPTURE(value);
    const std::string said = of_modulus(value);
    CHECK_THAT(said, Catch::StartsWith("scene.toml:9:1: rock.stiff.youngs_modulus_Pa = "));
    CHECK_THAT(said, Catch::EndsWith(std::string(": this is not TOML. ") + advice + '\n') ||
                         Catch::Contains(std::string(": this is not TOML. ") + advice + " "));
    CHECK(lines_in(said) == 1);
  }
}

TEST_CASE("The same between quotes, in lists, tables in braces and on the command line") {
  CHECK_THAT(of_modulus("\"10 GPa\""), Catch::Contains("= \"10 GPa\" is not a number. Write 10e9: the unit, Pa"));
  CHECK_THAT(of_modulus("\"10,0e9\""), Catch::Contains("is not a number. Write 10.0e9: the decimal sign"));
  CHECK_THAT(of_modulus("\"10e9\""), Catch::Contains("is not a number. Write a number without quotes."));
  const std::string inlet = "{start_Pa = 2e6, rate_Pa_s = 0.35e6}";
  const std::string both = errors(with(layered, inlet, "{start_Pa = 2,0e6, rate_Pa_s = 0.35 MPa/s}"));
  CHECK_THAT(both, Catch::Contains("start_Pa = 2,0e6: this is not TOML. Write 2.0e6: the decimal sign is a point."));
  CHECK_THAT(both, Catch::Contains("rate_Pa_s = 0.35 MPa/s: this is not TOML. Write 0.35e6: the unit, Pa/s, stands"));
  CHECK(lines_in(both) == 2);
  CHECK_THAT(errors(with(layered, "thickness_m = 10}", "thickness_m = 10,5}")),
             Catch::StartsWith("scene.toml:17:28: thickness_m = 10,5: this is not TOML. Write 10.5: the decimal sign"));
  CHECK_THAT(of_path("[[40,5, 0], [40,5, 5]]"),
             Catch::Contains("fracture.path_m[0] = [ 40, 5, 0 ] is not a point. Write [x, y]: two numbers, whose "
                             "decimal sign is a point."));
  CHECK_THAT(of_path("[[40 m, 0], [40, 5]]"), Catch::Contains("40 m: this is not TOML. Write 40: the unit, m, stands"));
  const auto set = [](const std::string& setting) { return errors(layered, "", {setting}); };
  CHECK_THAT(set("rock.stiff.youngs_modulus_Pa=10,0e9"), Catch::Contains("Write 10.0e9: the decimal sign is a point."));
  CHECK_THAT(set("rock.stiff.youngs_modulus_Pa=10 GPa"), Catch::Contains("Write 10e9: the unit, Pa, stands"));
  CHECK_THAT(set("rock.stiff.youngs_modulus_Pa=10GPa"), Catch::Contains("Write 10e9: the unit, Pa, stands"));
  CHECK_THAT(set("fluid.inlet={start_Pa=2,0e6}"), Catch::Contains("start_Pa = 2,0e6: this is not TOML. Write 2.0e6"));
}

TEST_CASE("Prefixes count where the unit is not a power, and letters may be of either case") {
  const auto advice = [](const char* typed, const std::string& unit) { return *advice_on_number(typed, &unit); };
  CHECK_THAT(advice("5 mm", "m"), Catch::Contains("Write 5e-3:"));
  CHECK_THAT(advice("5 cm", "m"), Catch::Contains("Write 5e-2:"));
  CHECK_THAT(advice("2 km", "m"), Catch::Contains("Write 2e3:"));
  CHECK_THAT(advice("1 mPa s", "Pa s"), Catch::Contains("Write 1e-3:"));
  CHECK_THAT(advice("1 mPa*s", "Pa s"), Catch::Contains("Write 1e-3:"));
  CHECK_THAT(advice("1.45 MPa m^0.5", "Pa sqrt(m)"), Catch::Contains("Write 1.45e6:"));
  CHECK_THAT(advice("1.45 MPa\u221am", "Pa sqrt(m)"), Catch::Contains("Write 1.45e6:"));
  CHECK_THAT(advice("2500 kg/m3", "kg/m^3"), Catch::Contains("Write 2500:"));
  CHECK_THAT(advice("20 1/s", "1/s"), Catch::Contains("Write 20:"));
  CHECK_THAT(advice("1 cm^2/s", "m^2/s"), Catch::Contains("Write the number alone, in m^2/s."));
  CHECK_THAT(advice("2.5 g/cm3", "kg/m^3"), Catch::Contains("Write the number alone, in kg/m^3."));
  CHECK_THAT(advice("10 min", "s"), Catch::Contains("Write the number alone, in s."));
  CHECK_THAT(advice("0.6 rad", ""), Catch::Contains("this key has no unit."));
  CHECK_FALSE(advice_on_number("10e9", nullptr).has_value());
  CHECK_FALSE(advice_on_number("weak", nullptr).has_value());
}

TEST_CASE("What is right is left alone") {
  for (const char* value : {"1e10 # ok", "10_000_000_000", "+1e10", "10000000000", "1E10"}) {
    CHECK(good(with(layered, modulus, std::string("youngs_modulus_Pa = ") + value)).rocks[1].youngs_modulus_Pa == 1e10);
  }
  CHECK(good(with(layered, "\"two layers\"", "\"10,0e9 = 10 GPa, [ { # \"")).title == "10,0e9 = 10 GPa, [ { # ");
}

TEST_CASE("Lines that are no TOML do not hide each other, nor the mistakes of other lines") {
  std::string text = with(layered, modulus, "youngs_modulus_Pa = 10 GPa");
  text = with(text, "horizontal_Pa = 2e6", "horizontal_Pa = 2,0e6");
  text = with(text, "law = \"friction\"", "law = friction");
  text = with(text, "cell_m = 1", "cel_m = 1");
  const ReadResult result = read(text);
  REQUIRE(result.errors.size() == 5);
  CHECK_THAT(result.errors[0], Catch::StartsWith("scene.toml:7:1: in_situ.horizontal_Pa = 2,0e6: this is not TOML."));
  CHECK_THAT(result.errors[1], Catch::StartsWith("scene.toml:9:1: rock.stiff.youngs_modulus_Pa = 10 GPa"));
  CHECK_THAT(result.errors[2], Catch::StartsWith("scene.toml:14:1: interface.joint.law = friction") &&
                                   Catch::EndsWith("Text stands in quotes: \"friction\"."));
  CHECK_THAT(result.errors[3], Catch::Contains("numerics.cell_m is missing"));
  CHECK_THAT(result.errors[4], Catch::Contains("unknown key numerics.cel_m. Did you mean cell_m?"));
}

TEST_CASE("Other slips of writing are named") {
  const auto of_width = [](const char* line) { return errors(with(layered, "width_m = 80", line)); };
  CHECK_THAT(of_width("width_m: 80"), Catch::Contains("width_m: 80: this is not TOML. Write width_m = 80."));
  CHECK_THAT(of_width("width_m 80"), Catch::Contains("Write width_m = 80."));
  CHECK_THAT(of_width("width_m = 80, beyond_m = 0"), Catch::Contains("Write each key, and each [table], on a line"));
  CHECK_THAT(of_width("// wide\nwidth_m = 80"), Catch::Contains(":3:1: this is not TOML. A comment begins with #."));
  CHECK_THAT(of_width("width_m = 80\nwidth_m = 90"), Catch::Contains("width_m is given twice"));
  CHECK_THAT(errors(with(layered, "{start_Pa = 2e6,", "{start_Pa = 2e6,\n")),
             Catch::Contains("A table in braces ends on the line on which it begins"));
  CHECK_THAT(errors(with(layered, "0.35e6}", "0.35e6,}")), Catch::Contains("Take the comma before } away."));
  CHECK_THAT(of_path("[[40, 0] [40, 5]]"), Catch::Contains("Put a comma between"));
  CHECK_THAT(of_path("[\n[40, 0]\n[40, 5]\n]"), Catch::Contains("Put a comma between"));
  CHECK_THAT(of_path("[[40, 0], [40, 5]"), Catch::Contains("A list that begins above is not closed"));
  CHECK_THAT(of_path("[(40, 0), (40, 5)]"), Catch::Contains("Lists stand in [ ]."));
  CHECK_THAT(errors(with(layered, "[\"joint\"]", "[joint]")), Catch::Contains("Text stands in quotes: \"joint\"."));
  CHECK_THAT(errors(with(layered, "\"two layers\"", "'don't'")), Catch::Contains("between double quotes"));
  CHECK_THAT(errors(with(layered, "layers\"", "l\xe4yers\"")), Catch::Contains("Save the file in UTF-8."));
  CHECK_THAT(errors(with(layered, "width_m", std::string("wid\0th_m", 8))), Catch::Contains("a control character"));
}

TEST_CASE("A second fracture is refused as such, however it is typed") {
  const std::string second = "path_m = [[42, 0], [42, 5]]\n";
  const auto one = Catch::Contains("one fracture");
  CHECK_THAT(of_path("[[[40, 0], [40, 5]], [[42, 0], [42, 5]]]"), one && Catch::Contains("has 2 lines of points"));
  CHECK_THAT(of_path("[[[[40, 0], [40, 5]]], [[[42, 0], [42, 5]]]]"), one);
  CHECK_THAT(of_path("[[40, 0], [40, 5]], [[42, 0], [42, 5]]"), one);
  CHECK_THAT(of_path("[[40, 0], [40, 5]]\n" + second), one);
  for (const char* head :
       {"[fracture]", "[[fracture]]", "[fracture.2]", "[fracture.left]", "[fracture_2]", "[fractures]"}) {
    CAPTURE(head);
    CHECK_THAT(errors(layered + head + "\n" + second), one);
  }
  const std::string listed = errors(with(layered, "[fracture]", "[[fracture]]") + "[[fracture]]\n" + second);
  CHECK_THAT(listed, Catch::Contains("is a list of tables, but a scene has one. Write [fracture] once."));
  CHECK(lines_in(listed) == 1);
  CHECK_THAT(of_path("[[[40, 0], [40, 5]]]"), Catch::Contains("has brackets too many. Write one line of points"));
  CHECK_THAT(of_path("[40, 0, 40, 5]"), Catch::Contains("has no brackets around its points"));
}

TEST_CASE("A stress of a layer's own is refused with what there is instead") {
  const auto one = Catch::Contains("the in-situ stress is one for the whole block: in_situ.horizontal_Pa");
  for (const char* key : {"horizontal_Pa", "vertical_Pa", "stress_Pa"}) {
    CAPTURE(key);
    CHECK_THAT(errors(with(layered, "thickness_m = 10}", std::string("thickness_m = 10, ") + key + " = 3e6}")), one);
  }
  CHECK_THAT(errors(with(layered, modulus, std::string(modulus) + "\nhorizontal_Pa = 3e6")), one);
  CHECK_THAT(errors(with(layered, "horizontal_Pa = 2e6", "horizontal_Pa = [2e6, 3e6]")), one);
  CHECK_THAT(errors(with(layered, "horizontal_Pa = 2e6", "horizontal_Pa = \"2e6 + 1e4*Y\"")), one);
  CHECK_THAT(errors(layered + "[in_situ.soft]\nhorizontal_Pa = 3e6\n"), one);
  CHECK_THAT(errors(with(layered, "vertical_Pa", "vertcal_Pa")), !one);  // a slip is only a slip
}

TEST_CASE("Heights are told to those who count depths") {
  const auto upwards = Catch::Contains("y is counted upwards from the block's lower edge");
  CHECK_THAT(of_path("[[40, -2000], [40, -1995]]"),
             upwards && Catch::Contains("a point d below its top has y = 80.0 - d.") && !Catch::Contains("both ends"));
  CHECK_THAT(of_path("[[40, 2000], [40, 1995]]"), upwards);
  CHECK_THAT(of_path("[[-40, 0], [-40, 5]]"), Catch::Contains("x is counted from the block's left edge") && !upwards);
  CHECK_THAT(errors(with(layered, "height_m = 80", "height_m = -80")), upwards);
  CHECK_THAT(errors(layered + "tip_y_m = -1990\n"), upwards);
  CHECK_THAT(errors(layered + "tip_y_m = 1990\n"), upwards);
  CHECK_THAT(errors(with(layered, "thickness_m = 10", "thickness_m = -10")),
             Catch::Contains("Layers are stacked upwards"));
}

TEST_CASE("Keys that this version does not have are refused with what to do instead") {
  const std::pair<std::string, const char*> typed[] = {
      {with(layered, "horizontal_Pa = 2e6", "horizontal_Pa = 2e6\nshear_Pa = 1e6"), "lay the block along"},
      {with(layered, "horizontal_Pa = 2e6", "horizontal_Pa = 2e6\nweight = true"), "give those at the fracture"},
      {with(layered, modulus, std::string(modulus) + "\nleakoff_m_sqrt_s = 1e-5"), "rock takes no fluid"},
      {with(layered, "coefficient = 0.4", "toughness_Pa_sqrt_m = 1e6"), "an interface fails by strength"},
      {with(layered, "[fracture]\n", "[fracture]\nfriction = 0.3\n"), "meet without friction"},
      {with(layered, "{start_Pa", "{table = [[0, 2e6]], start_Pa"), "the inlet has one rate"},
      {with(layered, "[\"joint\"]", "[{name = \"joint\", from_m = 0, to_m = 5}]"), "one law from edge to edge"},
      {layered + "[sweep]\nnumerics.cell_m = [1, 0.5]\n", "each case is a variant"},
  };
  for (const auto& [text, advice] : typed) CHECK_THAT(errors(text), Catch::Contains(advice));
}

TEST_CASE("No message is longer than a screen, whatever its key, value, name or setting") {
  const std::string letters(100000, 'q'), words = repeated("a b ", 25000);
  CHECK(shortened("four", 4) == "four");
  CHECK(shortened(letters, 60) == std::string(30, 'q') + "..." + std::string(20, 'q') + " (100000 characters)");
  CHECK(shortened(repeated("\u00e9", 40), 60) ==
        repeated("\u00e9", 15) + "..." + repeated("\u00e9", 10) + " (40 characters)");  // whole letters of 2 bytes
  const std::string typed[] = {
      errors(letters + " = 1\n" + layered),
      errors("\"" + words + "\" = 1\n" + layered),
      errors(with(layered, "[rock.soft]", "[rock." + letters + "]")),
      errors(with(layered, "rock = \"soft\"", "rock = \"" + letters + "\"")),
      errors(with(layered, "[\"joint\"]", "[\"" + letters + "\"]")),
      errors(with(layered, "\"friction\"", letters)),
      errors(with(layered, "\"friction\"", "\"" + words + "\"")),
      errors(layered + "[" + letters + "]\n"),
      errors(layered + "[variants." + letters + "]\n"),
      errors(layered + "[body]\nacceleration_m_s2 = [\"" + letters + "\", 0]\n"),
      errors(layered, letters),
      errors(layered, "", {letters}),
      errors(layered, "", {letters + "=1"}),
      errors(layered, "", {"stop.time_s=" + words}),
      errors(layered, "", {"rock.stiff.youngs_modulus_Pa=" + letters}),
      of_modulus(std::string(100000, '1')),
      of_modulus("1." + std::string(100000, '1')),
      of_path(std::string(200, '[') + std::string(200, ']')),
      of_path(std::string(100000, '[')),
      errors(layered + "a" + repeated(".a", 100000) + " = 1\n"),
      errors(layered + "[a" + repeated(" . a", 100000) + "]\n"),
  };
  for (const std::string& said : typed) {
    CAPTURE(said.substr(0, 300));
    for (std::size_t from = 0; from < said.size();) {
      const std::size_t end = said.find('\n', from);
      CHECK(end - from < 1200);
      from = end + 1;
    }
  }
  CHECK_THAT(typed[0], Catch::Contains("qqq...qqq") && Catch::Contains("q (100000 characters)."));
}

TEST_CASE("Control characters in keys and values are written out") {
  const std::string said = errors(layered + "[\"a\\u001b[31m\\nb\"]\n");
  CHECK_THAT(said, Catch::Contains("unknown key a\\u001B[31m\\u000Ab"));
  CHECK(lines_in(said) == 1);
}
