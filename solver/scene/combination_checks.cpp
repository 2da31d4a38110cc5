// Keys that are sound each by itself but do not go together.
#include <fmt/format.h>

#include <algorithm>

#include "scene/keys.hpp"
#include "scene/scene_checks.hpp"

namespace strata {
namespace {

// What mechanics = "explicit" cannot do.
void check_explicit(const Scene& scene, const Positions& positions, Faults& faults) {
  const auto refuse = [&](std::string_view path, const std::string& typed, std::string_view advice) {
    if (positions.sound(path)) faults.add(where_is(positions, path), fmt::format("{} {}", typed, advice));
  };
  if (scene.fracture && scene.fracture->growth == Fracture::Growth::energy) {
    refuse("fracture.growth",
           "fracture.growth = \"energy\" compares equilibria and needs mechanics = \"quasistatic\", "
           "but mechanics = \"explicit\".",
           "Use growth = \"J\" or \"none\".");
  }
  if (scene.fracture && scene.fracture->order == Fracture::Order::larger_margin) {
    refuse("fracture.order",
           "fracture.order = \"larger_margin\" asks what goes first at one load and needs mechanics = \"quasistatic\", "
           "but mechanics = \"explicit\", where either takes its time.",
           "Use order = \"interfaces\".");
  }
  if (scene.fluid.law == Fluid::Law::reynolds) {
    refuse("fluid.law",
           "fluid.law = \"reynolds\" is solved together with the rock's equilibrium and needs mechanics = "
           "\"quasistatic\", but mechanics = \"explicit\".",
           "Use law = \"paper\" or \"uniform\".");
  }
  if (scene.stop.time_s && *scene.stop.time_s == 0.0) {
    refuse("stop.time_s",
           "stop.time_s = 0 asks for one equilibrium and needs mechanics = \"quasistatic\", but "
           "mechanics = \"explicit\".",
           "Give a time above 0, or use quasistatic.");
  }
}

// What mechanics = "quasistatic" cannot do.
void check_quasistatic(const Scene& scene, const Positions& positions, Faults& faults) {
  if (!scene.initial.velocity_m_s || !positions.sound("initial.velocity_m_s")) return;
  faults.add(
      where_is(positions, "initial.velocity_m_s"),
      "initial.velocity_m_s moves the block at time 0, which needs inertia, but mechanics = \"quasistatic\". Use "
      "mechanics = \"explicit\", or leave it out.");
}

// uGIMP weights follow particles that move.
void check_shape_functions(const Scene& scene, const Positions& positions, Faults& faults) {
  if (scene.numerics.shape != Numerics::Shape::gimp) return;
  const bool quasistatic = scene.numerics.mechanics == Numerics::Mechanics::quasistatic;
  if (!quasistatic && scene.numerics.kinematics != Numerics::Kinematics::total) return;
  faults.add(where_is(positions, "numerics.shape"),
             fmt::format("numerics.shape = \"gimp\" is for moving points only, but {} leaves them in their reference "
                         "place, where it is linear. Use shape = \"bspline2\" or \"linear\".",
                         quasistatic ? "mechanics = \"quasistatic\"" : "kinematics = \"total\""));
}

// The middle one of three stands on the border of two spans: at a loaded edge, which halves a span, its weights do not
// integrate the derivative of a B-spline, and a uniform stress would not be in equilibrium.
void check_nine_points(const Scene& scene, const Positions& positions, std::string_view key, double value,
                       Faults& faults) {
  if (scene.numerics.particles_per_cell != 9 || !positions.sound("numerics.particles_per_cell")) return;
  faults.add(where_is(positions, "numerics.particles_per_cell"),
             fmt::format("numerics.particles_per_cell = 9 is for uniform grids, but {} = {} grades this one. Use 4 or "
                         "16, or leave {} out.",
                         key, number_text(value), key.substr(key.find('.') + 1)));
}

void check_beyond(const Scene& scene, const Positions& positions, Faults& faults) {
  const double beyond = scene.domain.beyond_m, cell = scene.numerics.cell_m;
  if (beyond == 0.0 || !positions.usable("domain.beyond_m") || !positions.usable("numerics.cell_m")) return;
  const double least = 2.0 * std::max(cell, scene.numerics.far_cell_m.value_or(cell));  // shorter, cells would shrink
  if (beyond < least) {
    faults.add(where_is(positions, "domain.beyond_m"),
               fmt::format("domain.beyond_m = {} is less than two of the cells at the block's edges. Give at least {}, "
                           "or 0: the rock ends there.",
                           number_text(beyond), number_text(least)));
  }
  check_nine_points(scene, positions, "domain.beyond_m", beyond, faults);
}

void check_far_cell(const Scene& scene, const Positions& positions, Faults& faults) {
  const Numerics& numerics = scene.numerics;
  if (!numerics.far_cell_m || !positions.usable("numerics.far_cell_m") || !positions.usable("numerics.cell_m")) return;
  if (*numerics.far_cell_m > numerics.cell_m)
    check_nine_points(scene, positions, "numerics.far_cell_m", *numerics.far_cell_m, faults);
  if (*numerics.far_cell_m >= numerics.cell_m) return;
  faults.add(where_is(positions, "numerics.far_cell_m"),
             fmt::format("numerics.far_cell_m = {} is below numerics.cell_m = {}: cells grow away from the fracture. "
                         "Give at least cell_m, or leave it out.",
                         number_text(*numerics.far_cell_m), number_text(numerics.cell_m)));
}

// Ends of the fine cells: on the far side of the initial fracture, and of a graded grid.
void check_fine_ends(const Scene& scene, const Positions& positions, Faults& faults) {
  if (!scene.fracture) return;
  const Numerics& n = scene.numerics;
  struct End {
    std::string_view key;
    const std::optional<double>& at;
    std::size_t axis;
    bool is_least;
  };
  for (const End& end :
       {End{"numerics.fine_left_m", n.fine_left_m, 0, true}, End{"numerics.fine_right_m", n.fine_right_m, 0, false},
        End{"numerics.fine_bottom_m", n.fine_bottom_m, 1, true}, End{"numerics.fine_top_m", n.fine_top_m, 1, false}}) {
    if (!end.at || !positions.usable(end.key)) continue;
    if (!positions.given("numerics.far_cell_m")) {
      faults.add(
          where_is(positions, end.key),
          fmt::format("{} = {} says where a graded grid is fine, but numerics.far_cell_m is missing: all cells are "
                      "of cell_m. Give it, or leave {} out.",
                      end.key, number_text(*end.at), end.key.substr(end.key.find('.') + 1)));
    }
    if (!positions.usable("fracture.path_m")) continue;
    const auto [low, high] =
        std::ranges::minmax_element(scene.fracture->path_m, {}, [&](const auto& x) { return x[end.axis]; });
    const double fracture = (end.is_least ? *low : *high)[end.axis];
    if (end.is_least ? *end.at <= fracture : *end.at >= fracture) continue;
    faults.add(where_is(positions, end.key),
               fmt::format("{} = {} lies within the initial fracture, which reaches to {}. Give at {} that.", end.key,
                           number_text(*end.at), number_text(fracture), end.is_least ? "most" : "least"));
  }
}

void check_fluid(const Scene& scene, const Positions& positions, Faults& faults) {
  const Fluid& fluid = scene.fluid;
  if (!positions.sound("fluid.law")) return;
  if (fluid.rate_m2_s && fluid.law != Fluid::Law::reynolds) {
    faults.add(where_is(positions, "fluid.inlet.rate_m2_s"),
               fmt::format("fluid.inlet.rate_m2_s = {} needs a law that conserves the fluid's mass, but fluid.law = "
                           "\"{}\". Use law = \"reynolds\", or inlet = {{start_Pa, rate_Pa_s}}.",
                           number_text(*fluid.rate_m2_s), fluid.law == Fluid::Law::paper ? "paper" : "uniform"));
  }
  const bool sound = positions.sound("fluid.cavitation_Pa") && positions.usable("fluid.inlet.start_Pa");
  if (sound && !fluid.rate_m2_s && fluid.cavitation_Pa > fluid.start_Pa) {
    faults.add(where_is(positions, "fluid.cavitation_Pa"),
               fmt::format("fluid.cavitation_Pa = {} is above fluid.inlet.start_Pa = {}, but no pressure may be below "
                           "it. Lower it, or start higher.",
                           number_text(fluid.cavitation_Pa), number_text(fluid.start_Pa)));
  }
}

// What a state holds at most: a bit for each surface, a byte for a particle's rock.
void check_numbers(const Scene& scene, const Positions& positions, Faults& faults) {
  constexpr std::size_t most_surfaces = 31, most_rocks = 255;
  std::size_t surfaces = scene.fracture ? 1 : 0;
  for (const InterfacePlace& place : scene.strata.interfaces) {
    if (scene.laws[place.law].kind != InterfaceLaw::Kind::perfect) ++surfaces;
  }
  if (surfaces > most_surfaces) {
    faults.add(
        where_is(positions, "strata.interfaces"),
        fmt::format("strata.interfaces: {} surfaces{} are more than {}. Make some interfaces perfect.", surfaces,
                    scene.fracture ? ", the fracture and all interfaces that are not perfect," : "", most_surfaces));
  }
  if (scene.rocks.size() > most_rocks) {
    faults.add(where_is(positions, "rock"),
               fmt::format("there are {} rocks, more than {}. Remove those that no layer uses, or let layers share.",
                           scene.rocks.size(), most_rocks));
  }
}

}  // namespace

void check_combinations(const Scene& scene, const Positions& positions, Faults& faults) {
  if (positions.sound("numerics.mechanics")) {
    const bool quasistatic = scene.numerics.mechanics == Numerics::Mechanics::quasistatic;
    (quasistatic ? check_quasistatic : check_explicit)(scene, positions, faults);
    check_shape_functions(scene, positions, faults);
  }
  check_far_cell(scene, positions, faults);
  check_fine_ends(scene, positions, faults);
  check_beyond(scene, positions, faults);
  if (scene.fracture) check_fluid(scene, positions, faults);
  check_numbers(scene, positions, faults);
}

}  // namespace strata
