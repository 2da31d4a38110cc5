// Keys that are sound each by itself but do not go together.
#include <algorithm>

#include "scene/scene_checks.hpp"

namespace strata {
namespace {

// What one of the two mechanics cannot do.
void check_mechanics(const SceneChecks& checks) {
  if (!checks.entries.sound("numerics.mechanics")) return;
  const Scene& scene = checks.scene;
  const bool rests = scene.numerics.mechanics == Numerics::Mechanics::quasistatic, moves = !rests;
  const Fracture fracture = scene.fracture.value_or(Fracture());
  const bool gimp_in_place = scene.numerics.shape == Numerics::Shape::gimp && scene.numerics.keeps_places();
  const std::string in_place = rests ? "mechanics = \"quasistatic\"" : "kinematics = \"total\"";
  struct Refusal {
    bool applies;
    std::string_view key;
    std::string why;
  };
  const std::string without = "needs mechanics = \"quasistatic\", but mechanics = \"explicit\"";
  for (const auto& [applies, key, why] : {
           Refusal{moves && fracture.growth == Fracture::Growth::energy, "fracture.growth",
                   " = \"energy\" compares equilibria and " + without + ". Use growth = \"J\" or \"none\"."},
           Refusal{moves && fracture.order == Fracture::Order::larger_margin, "fracture.order",
                   " = \"larger_margin\" asks what goes first at one load and " + without +
                       ", where either takes its time. Use order = \"interfaces\"."},
           Refusal{moves && scene.fluid.law == Fluid::Law::reynolds, "fluid.law",
                   " = \"reynolds\" is solved together with the rock's equilibrium and " + without +
                       ". Use law = \"paper\" or \"uniform\"."},
           Refusal{moves && scene.stop.time_s == 0.0, "stop.time_s",
                   " = 0 asks for one equilibrium and " + without + ". Give a time above 0, or use quasistatic."},
           Refusal{rests && scene.initial.velocity_m_s.has_value(), "initial.velocity_m_s",
                   " moves the block at time 0, which needs inertia, but mechanics = \"quasistatic\". Use mechanics = "
                   "\"explicit\", or leave it out."},
           // uGIMP weights follow particles that move.
           Refusal{gimp_in_place, "numerics.shape",
                   " = \"gimp\" is for moving points only, but " + in_place +
                       " leaves them in their reference place, where it is linear. Use shape = \"bspline2\" or "
                       "\"linear\"."},
       }) {
    if (applies && checks.entries.sound(key)) checks.refuse(key, std::string(key) + why);
  }
}

// The middle one of three stands on the border of two spans: at a loaded edge, which halves a span, its weights do not
// integrate the derivative of a B-spline, and a uniform stress would not be in equilibrium.
void check_nine_points(const SceneChecks& checks, std::string_view key, double value) {
  if (checks.scene.numerics.particles_per_cell != 9 || !checks.entries.sound("numerics.particles_per_cell")) return;
  checks.refuse("numerics.particles_per_cell",
                "numerics.particles_per_cell = 9 is for uniform grids, but {} = {} grades this one. Use 4 or 16, or "
                "leave {} out.",
                key, value, key.substr(key.find('.') + 1));
}

void check_beyond(const SceneChecks& checks) {
  const double beyond = checks.scene.domain.beyond_m, cell = checks.scene.numerics.cell_m;
  if (beyond == 0.0 || !checks.usable("domain.beyond_m", "numerics.cell_m")) return;
  // Shorter, cells would shrink.
  const double least = 2.0 * std::max(cell, checks.scene.numerics.far_cell_m.value_or(cell));
  if (beyond < least) {
    checks.refuse(
        "domain.beyond_m",
        "domain.beyond_m = {} is less than two of the cells at the block's edges. Give at least {}, or 0: the "
        "rock ends there.",
        beyond, least);
  }
  check_nine_points(checks, "domain.beyond_m", beyond);
}

void check_far_cell(const SceneChecks& checks) {
  if (!checks.usable("numerics.far_cell_m", "numerics.cell_m")) return;
  const double cell = checks.scene.numerics.cell_m, far = *checks.scene.numerics.far_cell_m;
  if (far > cell) check_nine_points(checks, "numerics.far_cell_m", far);
  if (far >= cell) return;
  checks.refuse("numerics.far_cell_m",
                "numerics.far_cell_m = {} is below numerics.cell_m = {}: cells grow away from the fracture. Give at "
                "least cell_m, or leave it out.",
                far, cell);
}

// Ends of the fine cells: on the far side of the initial fracture, and of a graded grid.
void check_fine_ends(const SceneChecks& checks) {
  if (!checks.scene.fracture) return;
  const Numerics& n = checks.scene.numerics;
  struct End {
    std::string_view key;
    const std::optional<double>& at;
    std::size_t axis;
    bool is_least;
  };
  for (const End& end :
       {End{"numerics.fine_left_m", n.fine_left_m, 0, true}, End{"numerics.fine_right_m", n.fine_right_m, 0, false},
        End{"numerics.fine_bottom_m", n.fine_bottom_m, 1, true}, End{"numerics.fine_top_m", n.fine_top_m, 1, false}}) {
    if (!checks.usable(end.key)) continue;
    if (!checks.entries.given("numerics.far_cell_m")) {
      checks.refuse(end.key,
                    "{} = {} says where a graded grid is fine, but numerics.far_cell_m is missing: all cells are of "
                    "cell_m. Give it, or leave {} out.",
                    end.key, *end.at, end.key.substr(end.key.find('.') + 1));
    }
    if (!checks.usable("fracture.path_m")) continue;
    const auto [low, high] =
        std::ranges::minmax_element(checks.scene.fracture->path_m, {}, [&](const auto& x) { return x[end.axis]; });
    const double fracture = (end.is_least ? *low : *high)[end.axis];
    if (end.is_least ? *end.at <= fracture : *end.at >= fracture) continue;
    checks.refuse(end.key, "{} = {} lies within the initial fracture, which reaches to {}. Give at {} that.", end.key,
                  *end.at, fracture, end.is_least ? "most" : "least");
  }
}

void check_fluid(const SceneChecks& checks) {
  const Fluid& fluid = checks.scene.fluid;
  if (!checks.scene.fracture || !checks.entries.sound("fluid.law")) return;
  if (fluid.rate_m2_s && fluid.law != Fluid::Law::reynolds) {
    checks.refuse("fluid.inlet.rate_m2_s",
                  "fluid.inlet.rate_m2_s = {} needs a law that conserves the fluid's mass, but fluid.law = \"{}\". Use "
                  "law = \"reynolds\", or inlet = {{start_Pa, rate_Pa_s}}.",
                  *fluid.rate_m2_s, word_of(fluid.law));
  }
  const bool sound = checks.entries.sound("fluid.cavitation_Pa") && checks.usable("fluid.inlet.start_Pa");
  if (sound && !fluid.rate_m2_s && fluid.cavitation_Pa > fluid.start_Pa) {
    checks.refuse("fluid.cavitation_Pa",
                  "fluid.cavitation_Pa = {} is above fluid.inlet.start_Pa = {}, but no pressure may be below it. Lower "
                  "it, or start higher.",
                  fluid.cavitation_Pa, fluid.start_Pa);
  }
}

// What a state holds at most: a bit for each surface, a byte for a particle's rock.
void check_numbers(const SceneChecks& checks) {
  constexpr std::size_t most_surfaces = 31, most_rocks = 255;
  const Scene& scene = checks.scene;
  const auto with_laws = std::ranges::count_if(scene.strata.interfaces, [&](const InterfacePlace& place) {
    return scene.laws[place.law].kind != InterfaceLaw::Kind::perfect;
  });
  const std::size_t surfaces = static_cast<std::size_t>(with_laws) + (scene.fracture ? 1 : 0);
  if (surfaces > most_surfaces) {
    checks.refuse("strata.interfaces",
                  "strata.interfaces: {} surfaces{} are more than {}. Make some interfaces perfect.", surfaces,
                  scene.fracture ? ", the fracture and all interfaces that are not perfect," : "", most_surfaces);
  }
  if (scene.rocks.size() > most_rocks) {
    checks.refuse("rock", "there are {} rocks, more than {}. Remove those that no layer uses, or let layers share.",
                  scene.rocks.size(), most_rocks);
  }
}

}  // namespace

void check_combinations(const SceneChecks& checks) {
  check_mechanics(checks);
  check_far_cell(checks);
  check_fine_ends(checks);
  check_beyond(checks);
  check_fluid(checks);
  check_numbers(checks);
}

}  // namespace strata
