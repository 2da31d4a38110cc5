// What is said of values that are typed as people write them, and not as TOML or a key takes them.
#include "scene/messages.hpp"
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

TEST_CASE("What is no TOML is said with its place, its key and value, and how values are written") {
  for (const char* value :
       {"10,0e9", "10 000 000", "10'000'000", "10 GPa", "10GPa", "10e9 // Young", "10e9;", ".5e9", "10.", "007",
        "\u221210e9", "10*1e9", "1/3", "99999999999999999999", "stiff", "\u201c10e9\u201d", "\"10e9", ""}) {
    CAPTURE(value);
    const std::string said = of_modulus(value), line = std::string("youngs_modulus_Pa = ") + value;
    CHECK_THAT(said, Catch::StartsWith("scene.toml:9:") &&
                         Catch::Contains(": this is not TOML: " + std::string(trimmed(line)) + ": ") &&
                         Catch::Contains(" Write key = value: text in quotes, lists in [ ], numbers with a decimal "
                                         "point and no unit, which stands in the key."));
    CHECK(lines_in(said) == 1);
  }
}

TEST_CASE("A number in quotes, in a list or on the command line is refused with the key's unit or what to write") {
  CHECK_THAT(of_modulus("\"10 GPa\""),
             Catch::Contains("= \"10 GPa\" is not a number. Write a number without quotes, in "
                             "Pa: the unit stands in the key."));
  CHECK_THAT(errors(with(layered, "coefficient = 0.4", "coefficient = true")),
             Catch::EndsWith("coefficient = true is not a number. Write a number without quotes.\n"));
  CHECK_THAT(of_path("[[40,5, 0], [40,5, 5]]"),
             Catch::Contains("fracture.path_m[0] = [ 40, 5, 0 ] is not a pair of numbers. Write [[x, y], [x, y]] with "
                             "decimal points"));
  for (const char* value : {"10,0e9", "10 GPa", "[stiff]", ""}) {
    CAPTURE(value);
    const std::string setting = std::string("rock.stiff.youngs_modulus_Pa=") + value;
    const std::string said = errors(layered, "", {setting});
    const std::string shown = *value == '\0' ? "an empty value" : value;
    CHECK_THAT(said, Catch::StartsWith("--set " + setting + ": " + shown + " is neither TOML nor a bare word."));
  }
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
  CHECK_THAT(result.errors[0], Catch::StartsWith("scene.toml:7:18: this is not TOML: horizontal_Pa = 2,0e6: "));
  CHECK_THAT(result.errors[1], Catch::StartsWith("scene.toml:9:24: this is not TOML: youngs_modulus_Pa = 10 GPa: "));
  CHECK_THAT(result.errors[2], Catch::StartsWith("scene.toml:14:8: this is not TOML: law = friction: "));
  CHECK_THAT(result.errors[3], Catch::Contains("numerics.cell_m is missing"));
  CHECK_THAT(result.errors[4], Catch::Contains("unknown key numerics.cel_m. Did you mean cell_m?"));
}

TEST_CASE("A line that no value can stand for ends the reading with the place of what is wrong") {
  const auto of_width = [](const char* line) { return errors(with(layered, "width_m = 80", line)); };
  for (const char* line : {"width_m: 80", "width_m 80", "// wide\nwidth_m = 80", "width_m = 80\nwidth_m = 90"}) {
    CAPTURE(line);
    CHECK_THAT(of_width(line), Catch::Contains(": this is not TOML: "));
  }
  CHECK_THAT(of_width("width_m = 80\nwidth_m = 90"),
             Catch::StartsWith("scene.toml:4:") && Catch::Contains("cannot redefine existing integer 'width_m'"));
  for (const char* path : {"[[40, 0] [40, 5]]", "[\n[40, 0]\n[40, 5]\n]", "[[40, 0], [40, 5]", "[(40, 0), (40, 5)]"}) {
    CAPTURE(path);
    CHECK_THAT(of_path(path), Catch::Contains(": this is not TOML: "));
  }
  CHECK_THAT(errors(with(layered, "layers\"", "l\xe4yers\"")), Catch::Contains("utf-8"));
  CHECK_THAT(errors(with(layered, "width_m", std::string("wid\0th_m", 8))), Catch::Contains("this is not TOML"));
}

TEST_CASE("A second fracture is refused, however it is typed") {
  const std::string second = "path_m = [[42, 0], [42, 5]]\n";
  const auto one = Catch::Contains("one fracture");
  CHECK_THAT(of_path("[[[40, 0], [40, 5]], [[42, 0], [42, 5]]]"), one);
  CHECK_THAT(of_path("[[[[40, 0], [40, 5]]], [[[42, 0], [42, 5]]]]"), one);
  CHECK_THAT(of_path("[[[40, 0], [40, 5]]]"), one);
  CHECK_THAT(of_path("[40, 0, 40, 5]"), one);
  CHECK_THAT(of_path("[[40, 0], [40, 5]]\n" + second), Catch::Contains("cannot redefine existing array 'path_m'"));
  CHECK_THAT(errors(layered + "[fracture]\n" + second), Catch::Contains("cannot redefine existing table 'fracture'"));
  for (const char* head : {"fracture_2", "fractures"}) {
    CAPTURE(head);
    CHECK_THAT(errors(layered + '[' + head + "]\n" + second), Catch::Contains("Did you mean fracture?"));
  }
  CHECK_THAT(errors(layered + "[fracture.2]\n" + second), Catch::Contains("unknown key fracture.2. [fracture] has"));
  const std::string listed = errors(with(layered, "[fracture]", "[[fracture]]") + "[[fracture]]\n" + second);
  CHECK_THAT(listed, Catch::Contains("is not a table. Write [fracture] once"));
  CHECK(lines_in(listed) == 1);
}

TEST_CASE("Heights are told to those who count depths") {
  const auto upwards = Catch::Contains("y is counted upwards from the block's lower edge");
  CHECK_THAT(of_path("[[40, -2000], [40, -1995]]"),
             upwards && Catch::Contains("a point d below its top has y = 80 - d.") && !Catch::Contains("both ends"));
  CHECK_THAT(of_path("[[40, 2000], [40, 1995]]"), upwards);
  CHECK_THAT(of_path("[[-40, 0], [-40, 5]]"), Catch::Contains("x is counted from the block's left edge") && !upwards);
  CHECK_THAT(errors(with(layered, "height_m = 80", "height_m = -80")), upwards);
  CHECK_THAT(errors(layered + "tip_y_m = -1990\n"), upwards);
  CHECK_THAT(errors(layered + "tip_y_m = 1990\n"), upwards);
  CHECK_THAT(errors(with(layered, "thickness_m = 10", "thickness_m = -10")),
             Catch::Contains("Layers are stacked upwards"));
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
  CHECK_THAT(typed[0], Catch::Contains("qqq...qqq") && Catch::Contains("characters)"));
}

TEST_CASE("Control characters in keys and values are written out") {
  const std::string said = errors(layered + "[\"a\\u001b[31m\\nb\"]\n");
  CHECK_THAT(said, Catch::Contains("unknown key \"a\\u001B[31m\\u000Ab\""));
  CHECK(lines_in(said) == 1);
}
