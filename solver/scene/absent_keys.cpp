// Keys that people look for and that this version does not have.
#include <algorithm>
#include <iterator>

#include "scene/keys.hpp"

namespace strata {
namespace {

// A path by its table and its last name; anything may stand between.
struct Absent {
  std::string_view table, name, advice;
};

constexpr std::string_view one_stress =
    " In this version the in-situ stress is one for the whole block: in_situ.horizontal_Pa and in_situ.vertical_Pa. "
    "in_situ.initialise = \"loaded\" gives each layer what its stiffness takes of them.";

constexpr Absent absent[] = {
    {"in_situ.", "shear_Pa",
     " In this version there is no in-situ shear stress: lay the block along the principal stresses."},
    {"in_situ.", "weight", " In this version stresses do not grow with depth: give those at the fracture."},
    {"strata.layers[", "_Pa", one_stress},
    {"rock.", ".horizontal_Pa", one_stress},
    {"rock.", ".vertical_Pa", one_stress},
    {"rock.", ".leakoff_m_sqrt_s", " In this version rock takes no fluid: leave it out."},
    {"interface.", ".toughness_Pa_sqrt_m",
     " In this version an interface fails by strength: law = \"weak\", shear_strength_Pa and tensile_strength_Pa."},
    {"fracture.", "friction", " In this version the fracture's faces meet without friction: leave it out."},
    {"fluid.inlet.", "table",
     " In this version the inlet has one rate: inlet = {start_Pa, rate_Pa_s}, or {rate_m2_s} with law = \"reynolds\"."},
    {"sweep", "", " In this version each case is a variant: [variants.NAME] and below it the keys that differ."},
};

}  // namespace

std::string_view advice_on_absent_key(std::string_view path) {
  const auto found = std::ranges::find_if(absent, [&](const Absent& key) {
    return path.size() >= key.table.size() + key.name.size() && path.starts_with(key.table) && path.ends_with(key.name);
  });
  return found == std::end(absent) ? std::string_view() : found->advice;
}

std::string_view note_on_table(std::string_view path) {
  if (path.starts_with("in_situ")) return one_stress;
  if (path.starts_with("fracture")) return " A scene has one fracture: [fracture] with path_m = [[x, y], [x, y]].";
  return {};
}

}  // namespace strata
