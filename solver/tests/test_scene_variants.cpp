#include "scene_text.hpp"
#include "temporary_folder.hpp"

#include <cstdio>
#include <filesystem>
#include <fstream>

using namespace strata;
using namespace scene_test;

namespace {

const std::string with_variants = layered + R"([variants.weak]
interface.joint.law = "weak"
interface.joint.shear_strength_Pa = 1e6
[variants.fine]
"numerics.cell_m" = 0.5
numerics.shape = "linear"
[variants.fine.rock]
"soft.youngs_modulus_Pa" = 6e9
[variants.bonded]
strata.interfaces = ["perfect"]
[variants.as_it_is]
)";

}  // namespace

TEST_CASE("Variants are listed in the order of the file") {
  CHECK(list_variants(with_variants, "s.toml").lines == std::vector<std::string>{"weak", "fine", "bonded", "as_it_is"});
  CHECK(list_variants(layered, "s.toml").lines.empty());
  CHECK(of_file("no/such.toml", list_variants).errors.size() == 1);
}

TEST_CASE("A variant replaces values, by dotted keys with and without quotes and by tables") {
  const Scene base = good(with_variants);
  CHECK(base.numerics.cell_m == 1.0);
  const Scene fine = good(with_variants, "fine");
  CHECK(fine.variant == "fine");
  CHECK(fine.numerics.cell_m == 0.5);
  CHECK(fine.numerics.shape == Numerics::Shape::linear);
  CHECK(fine.rocks[0].youngs_modulus_Pa == 6e9);
  CHECK(good(with_variants, "bonded").strata.interfaces[0].law == 0);
  Scene same = good(with_variants, "as_it_is");
  same.variant.clear();
  same.resolved_toml = base.resolved_toml;
  CHECK(same == base);
}

TEST_CASE("Keys of a law that a variant or --set replaces are let be, and leave no trace") {
  const Scene weak = good(with_variants, "weak");
  CHECK(weak.laws[1].kind == InterfaceLaw::Kind::weak);
  CHECK(weak.laws[1].shear_strength_Pa == 1e6);
  CHECK(weak.laws[1].coefficient == InterfaceLaw{}.coefficient);
  CHECK(weak.resolved_toml.find("coefficient") == std::string::npos);
  CHECK(good(with_variants, "weak", {"interface.joint.law=soft"}).laws[1].kind == InterfaceLaw::Kind::soft);
  CHECK(good(with_variants, "", {"interface.joint.law=perfect"}).laws[1].kind == InterfaceLaw::Kind::perfect);
  CHECK_THAT(errors(with_variants, "weak", {"interface.joint.coefficient=0.3"}),
             Catch::StartsWith("--set interface.joint.coefficient=0.3: interface.joint.coefficient belongs to law = "
                               "\"friction\", but interface.joint.law = \"weak\"."));
}

TEST_CASE("Mistakes in variants that are not chosen are mistakes too, at their own place") {
  CHECK_THAT(errors(layered + "[variants.a]\nnumerics.cel_m = 1\n"),
             Catch::StartsWith("scene.toml:28:10: unknown key numerics.cel_m. Did you mean cell_m?"));
  CHECK_THAT(errors(layered + "[variants.a]\n\"numerics.cell_m\" = 0\n"),
             Catch::StartsWith("scene.toml:28:1: numerics.cell_m = 0 is outside (0, inf)."));
}

TEST_CASE("A variant that does not exist is refused with those that do") {
  CHECK_THAT(errors(with_variants, "wek"),
             Catch::Contains("there is no variant wek. It has weak, fine, bonded, as_it_is. Did you mean weak?"));
  CHECK_THAT(errors(layered, "weak"), Catch::Contains("It has no variants."));
}

TEST_CASE("--set acts after the variant, and the last one counts") {
  CHECK(good(with_variants, "fine", {"numerics.cell_m=0.25"}).numerics.cell_m == 0.25);
  CHECK(good(layered, "", {"numerics.cell_m=0.25", "numerics.cell_m = 0.5"}).numerics.cell_m == 0.5);
}

TEST_CASE("The value of --set is TOML, a bare word a string") {
  CHECK(good(layered, "", {"numerics.shape=gimp"}).numerics.shape == Numerics::Shape::gimp);
  CHECK(good(layered, "", {"fluid.time_rule=backward-euler"}).fluid.time_rule == Fluid::TimeRule::backward_euler);
  CHECK(good(layered, "", {"title=\"a = b\""}).title == "a = b");
  CHECK(good(layered, "", {"strata.interfaces=[\"perfect\"]"}).strata.interfaces[0].law == 0);
  CHECK(good(layered, "", {"fluid.inlet={start_Pa = 1e6}"}).fluid.start_Pa == 1e6);
  CHECK_THAT(errors(layered, "", {"strata.interfaces=[perfect]"}), Catch::Contains("neither TOML nor a bare word"));
  CHECK_THAT(errors(layered, "", {"numerics.cell_m="}), Catch::Contains("neither TOML nor a bare word"));
  CHECK_THAT(errors(layered, "", {"title=1\ncell_m=2"}), Catch::Contains("neither TOML nor a bare word"));
  CHECK_THAT(errors(layered, "", {"numerics.cell_m"}), Catch::Contains("this is not key.path=value"));
  CHECK_THAT(errors(layered, "", {"variants.a.title=x"}), Catch::Contains("may replace keys of the scene"));
}

TEST_CASE("A variant and --set may replace a key of an element of a list that is there") {
  CHECK(good(layered, "", {"strata.layers[0].thickness_m=20"}).strata.interfaces[0].at_m == 20.0);
  const std::string text = layered + "[variants.thick]\n\"strata.layers[0].thickness_m\" = 30\n";
  CHECK(good(text, "thick").strata.interfaces[0].at_m == 30.0);
  const std::string both = "strata.layers=[{rock = \"soft\", thickness_m = 5}, {rock = \"soft\"}]";
  CHECK(good(text, "thick", {both}).strata.interfaces[0].at_m == 5.0);
  CHECK(good(layered, "", {"strata.layers.0.thickness_m=20", "strata.interfaces.0=perfect"}) ==
        good(layered, "", {"strata.layers[0].thickness_m=20", "strata.interfaces[0]=perfect"}));
  CHECK(errors(layered, "", {"strata.layers[2].thickness_m=20"}) ==
        "--set strata.layers[2].thickness_m=20: unknown key strata.layers[2].thickness_m. There is no "
        "strata.layers[2]; elements are counted from 0.\n");
  CHECK_THAT(
      errors(layered, "", {"strata.interfaces[0]=3"}),
      Catch::EndsWith("strata.interfaces[0] = 3 is not a table. Write {...} with keys of name, from_m, to_m.\n"));
  CHECK_THAT(errors(layered, "", {"strata.layers[0]=soft"}), Catch::Contains("Write {...} with keys of rock, "));
  CHECK_THAT(errors(layered, "", {"claim[0].id=x"}), Catch::Contains("not claims, variants or a sweep"));
  CHECK_THAT(errors(layered + "[variants.v]\nstrata.layers.0.thickness_m = 30\n", "v"),
             Catch::Contains("in quotes: \"strata.layers[0].thickness_m\" = ..."));
}

TEST_CASE("An interface that --set or a variant names, alone or by its key, takes the place of that in the list") {
  const std::string ends = with(layered, "[\"joint\"]", "[{name = \"joint\", from_m = 15}]");
  for (const std::string key : {"strata.interfaces[0]", "strata.interfaces[0].name"}) {
    CHECK(good(layered, "", {key + "=perfect"}).strata.interfaces[0].law == 0);
    CHECK(good(layered + "[variants.v]\n\"" + key + "\" = \"perfect\"\n", "v").strata.interfaces[0].law == 0);
    CHECK(good(ends, "", {key + "=perfect"}).strata.interfaces[0].from_m == 15.0);
    CHECK(good(layered, "", {key + "=perfect", "strata.interfaces=[\"joint\"]"}).strata.interfaces[0].law == 1);
    CHECK_THAT(errors(layered, "", {key + "=jont"}), Catch::Contains("there is no [interface.jont]"));
  }
}

TEST_CASE("All mistakes in a list of tables are told at once, and none twice") {
  const std::string text =
      with(layered, "{rock = \"stiff\", thickness_m = 10}", "{rock = \"stiff\", thickness_m = -1}, {rok = \"a\"}, 3");
  const ReadResult result = read(text + "[[claim]]\nid = 3\nobservable = \"o\"\n");
  REQUIRE(result.errors.size() == 6);
  CHECK_THAT(result.errors[0], Catch::StartsWith("scene.toml:17:28: strata.layers[0].thickness_m = -1 is outside"));
  CHECK_THAT(result.errors[1], Catch::StartsWith("scene.toml:17:47: strata.layers[1].rock is missing."));
  CHECK_THAT(result.errors[2],
             Catch::StartsWith("scene.toml:17:48: unknown key strata.layers[1].rok. Did you mean rock?"));
  CHECK_THAT(result.errors[3],
             Catch::StartsWith("scene.toml:17:60: strata.layers[2] = 3 is not a table. Write [{rock"));
  CHECK_THAT(result.errors[4], Catch::StartsWith("scene.toml:27:1: claim[0].text is missing."));
  CHECK_THAT(result.errors[5], Catch::StartsWith("scene.toml:28:1: claim[0].id = 3 is not text."));
}

TEST_CASE("Errors of --set name it in the place of a line, and come after those of the file") {
  const std::string text = errors(with(layered, "width_m = 80", "width_m = -80"), "", {"numerics.courant=3"});
  CHECK_THAT(text, Catch::StartsWith("scene.toml:3:1: "));
  CHECK_THAT(text, Catch::Contains("\n--set numerics.courant=3: numerics.courant = 3 is outside (0, 2]."));
}

TEST_CASE("A rock that only --set names is a slip, unless a layer uses it") {
  CHECK_THAT(errors(layered, "", {"rock.sotf.youngs_modulus_Pa=1e9"}), Catch::Contains("Did you mean soft?"));
  const Scene scene =
      good(layered, "", {"rock.new.youngs_modulus_Pa=1e9", "strata.layers=[{rock = \"new\"}]", "strata.interfaces=[]"});
  CHECK(scene.rocks[scene.strata.layers[0].rock].name == "new");
}

TEST_CASE("A rock or interface that nothing uses is noted, unless a variant, a sweep or --set does") {
  const std::string more = layered + "[rock.chalk]\nyoungs_modulus_Pa = 1e9\n[interface.clay]\nlaw = \"weak\"\n";
  const auto notes = [](const std::string& text, const std::vector<std::string>& set = {}) {
    const ReadResult result = read(text, "", set);
    CHECK(result.errors.empty());
    return result.notes;
  };
  CHECK(notes(layered).empty());
  CHECK(notes(more) == std::vector<std::string>{
                           "scene.toml:27:7: note: nothing uses [rock.chalk], neither strata.layers nor a variant.",
                           "scene.toml:29:12: note: nothing uses [interface.clay], neither strata.interfaces nor a "
                           "variant."});
  const std::string clay = "strata.interfaces = [\"clay\"]\n", chalk = "\"strata.layers[1].rock\" = \"chalk\"\n";
  CHECK(notes(more + "[variants.v]\n" + clay + chalk).empty());
  CHECK(notes(more + "[variants.v]\n" + clay + "[variants.w]\n" + chalk).empty());
  CHECK(notes(more + "[sweep]\nstrata.interfaces = [[{name = \"clay\"}], [\"joint\"]]\n").size() == 1);
  CHECK(notes(more, {"strata.interfaces[0]=clay", "strata.layers[1].rock=chalk"}).empty());
  CHECK(notes(good(more).resolved_toml).empty());  // what variants use a run does not know
}

// Requires a note where a stop is given beside stop.time_s = 0, or by a variant over it, and none where time 0 is what
// was said last. Mutation that fails: ranks not looked at.
TEST_CASE("A stop that one equilibrium never reaches is noted") {
  const std::string text = with(layered, "[numerics]\n", "[numerics]\nmechanics = \"quasistatic\"\n");
  const auto notes = [](const std::string& of, const std::string& variant, const std::vector<std::string>& set) {
    const ReadResult result = read(of, variant, set);
    CHECK(result.errors.empty());
    return result.notes;
  };
  CHECK(notes(text, "", {}).empty());
  CHECK(notes(text, "", {"stop.time_s=0"}).empty());
  const std::vector<std::string> said = notes(text + "time_s = 0\n", "", {});
  REQUIRE(said.size() == 1);
  CHECK_THAT(said[0], Catch::Contains("note: stop.inlet_Pa is not reached: stop.time_s = 0 ends"));
  const std::string still = with(text, "inlet_Pa = 4e6", "time_s = 0") + "[variants.v]\nstop = {inlet_Pa = 4e6}\n";
  CHECK(notes(still, "", {}).empty());
  CHECK(notes(still, "v", {}).size() == 1);
  CHECK(notes(still, "v", {"stop.time_s=3"}).empty());
}

TEST_CASE("check reports every file and every variant, and says which variant is to blame") {
  const test::TemporaryFolder folder;
  const std::filesystem::path file = folder.path / "scene.toml";
  std::ofstream(file) << layered << "[variants.coarse]\nnumerics.cell_m = 16\n";
  CHECK_THAT(check("no/such.toml").errors.at(0), Catch::StartsWith("no/such.toml: there is no such file"));
  const std::vector<std::string> lines = check(file).errors;
  REQUIRE(lines.size() == 1);
  CHECK_THAT(lines[0],
             Catch::Contains("neither on a grid line nor at mid-cell") && Catch::EndsWith(" [variant coarse]"));
}
