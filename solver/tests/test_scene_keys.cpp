#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <set>

#include "scene/keys.hpp"
#include "scene/messages.hpp"

using namespace strata;

TEST_CASE("Every key is declared once, has help, and says what it takes") {
  std::set<std::string_view> paths;
  for (const Key& key : scene_keys()) {
    CAPTURE(key.path);
    CHECK(paths.insert(key.path).second);
    CHECK_FALSE(key.help.empty());
    CHECK(key.bounds.low < key.bounds.high);
    const bool chooses = key.kind == Key::Kind::word || key.kind == Key::Kind::integer;
    if (chooses || key.kind == Key::Kind::formula) CHECK_FALSE(key.allowed.empty());
    if (key.kind == Key::Kind::list) CHECK_FALSE(key.advice.empty());
    CHECK((key.member.read != nullptr && key.member.text != nullptr));
  }
}

namespace {

bool among(const std::string& word, std::string_view words) {
  const auto all = split(words, ", ");
  return std::ranges::find(all, word) != all.end();
}

}  // namespace

TEST_CASE("Every default is one that its key allows") {
  for (const Key& key : scene_keys()) {
    const std::string text = default_text(key);
    CAPTURE(key.path, text);
    if (text.empty()) continue;
    if (key.kind == Key::Kind::number) CHECK(key.bounds.contain(std::stod(text)));
    if (key.kind == Key::Kind::integer) CHECK(among(text, key.allowed));
    if (key.kind == Key::Kind::word)
      CHECK(among(text.front() == '"' ? text.substr(1, text.size() - 2) : text, key.allowed));
  }
}

// Requires bounds to hold their ends where they are closed and not where they are open.
TEST_CASE("Bounds are open or closed at each end by itself") {
  const Bounds low{0.0, 1.0, true, false}, high{0.0, 1.0, false, true};
  CHECK((!low.contain(0.0) && low.contain(0.5) && low.contain(1.0) && !low.contain(1.1)));
  CHECK((high.contain(0.0) && high.contain(0.5) && !high.contain(1.0) && !high.contain(-0.1)));
}

// Requires each key's words to be among those of its enumeration, so that what is typed is what is set.
TEST_CASE("Words that are offered are those of the member") {
  for (const Key& key : scene_keys()) {
    CAPTURE(key.path);
    CHECK((key.kind == Key::Kind::word) == !key.member.words.empty());
    if (key.kind != Key::Kind::word) continue;
    for (const std::string& word : split(key.allowed, ", ")) CHECK(among(word, key.member.words));
  }
  CHECK(word_of(Fluid::TimeRule::backward_euler) == "backward-euler");
  CHECK(word_of(Numerics::Mechanics::explicit_dynamics) == "explicit");
}

TEST_CASE("Defaults are those of the scene") {
  CHECK(default_text(*find_key("rock.any.poisson_ratio")) == "0.2");
  CHECK(default_text(*find_key("numerics.particles_per_cell")) == "4");
  CHECK(default_text(*find_key("fluid.law")) == "\"paper\"");
  CHECK(default_text(*find_key("domain.width_m")).empty());
  CHECK(default_text(*find_key("stop.time_s")).empty());
}

TEST_CASE("A path finds its key with any name in the place of NAME") {
  CHECK(find_key("rock.stiff.poisson_ratio")->path == "rock.NAME.poisson_ratio");
  CHECK(find_key("strata.layers[12].rock")->path == "strata.layers[].rock");
  CHECK(find_key("rock.stiff") == nullptr);
  CHECK(find_key("rock.stiff.poisson") == nullptr);
  CHECK(find_key("rock.a[0].poisson_ratio") == nullptr);
  CHECK(names_in_table("fluid.inlet") == std::vector<std::string>{"start_Pa", "rate_Pa_s", "rate_m2_s", "table", "of"});
  CHECK(names_in_table("strata.layers[0]") ==
        std::vector<std::string>{"rock", "thickness_m", "horizontal_Pa", "vertical_Pa"});
  CHECK(names_in_table("rock.stiff").size() == 5);
  CHECK(names_in_table("rock") == std::vector<std::string>{"NAME"});
  for (const char* path : {"strata.layers", "rock.a[0]", "fluid.law", "fluids"}) CHECK(names_in_table(path).empty());
}

TEST_CASE("Edit distance by hand") {
  CHECK(edit_distance("", "abc") == 3.0);
  CHECK(edit_distance("weak", "weak") == 0.0);
  CHECK(edit_distance("wake", "weak") == 2.0);
  CHECK(edit_distance("kitten", "sitting") == 3.0);
  CHECK(edit_distance("sotf", "soft") == 1.0);
  CHECK(edit_distance("Weak", "weak") == 0.5);
}

TEST_CASE("The nearest word is suggested, and none that is far") {
  CHECK(did_you_mean("frction", {"weak", "friction", "soft"}) == " Did you mean friction?");
  CHECK(did_you_mean("viscosity", {"law", "viscosity_Pa_s"}) == " Did you mean viscosity_Pa_s?");
  CHECK(did_you_mean("perfect", {"weak", "friction", "soft"}).empty());
  CHECK(did_you_mean("x", {}).empty());
}

TEST_CASE("An unknown key names the nearest one, or the table it belongs in, or what there is") {
  CHECK(unknown_key_message("fluid.viscosty_Pa_s") == "unknown key fluid.viscosty_Pa_s. Did you mean viscosity_Pa_s?");
  CHECK(unknown_key_message("domain.courant") ==
        "unknown key domain.courant. Did you mean numerics.courant? [domain] has width_m, height_m, beyond_m, bottom, "
        "sides, top.");
  CHECK(unknown_key_message("stop.never") ==
        "unknown key stop.never. [stop] has tip_y_m, lower_tip_y_m, inlet_Pa, time_s.");
}

TEST_CASE("A number's text reads back as the same number and is a float in TOML") {
  for (const double value : {0.1, 1.0 / 3.0, 1e300, 5e-324, -2e6, 0.0, 123456789012345680.0}) {
    const std::string text = number_text(value);
    CAPTURE(text);
    CHECK(std::strtod(text.c_str(), nullptr) == value);
    CHECK(text.find_first_of(".e") != std::string::npos);
  }
  CHECK(to_text({0.0, 0.5, false, true}) == "[0, 0.5)");
  CHECK(to_text({0.0, std::numeric_limits<double>::infinity(), true, true}) == "(0, inf)");
}

TEST_CASE("The table in Markdown has a row for each key") {
  const std::string table = keys_as_markdown();
  for (const Key& key : scene_keys()) CHECK(table.find("| `" + std::string(key.path) + "` |") != std::string::npos);
}
