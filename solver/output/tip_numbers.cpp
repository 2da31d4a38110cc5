#include "output/tip_numbers.hpp"

#include <array>
#include <limits>
#include <numbers>

namespace strata {

namespace {

struct Words {
  const char* name;
  const char* crossed;
};

constexpr std::array<Words, 6> words{
    Words{"", ""},
    Words{"interface", "an interface whose faces have come apart"},
    Words{"rock border", "another rock"},
    Words{"symmetry line", "the symmetry line"},
    Words{"edge", "an edge of the block"},
    Words{"fracture", "another part of the fracture"},
};

const Words& words_of(Obstacle what) {
  return words[static_cast<std::size_t>(what)];
}

}  // namespace

const char* name_of(Obstacle what) {
  return words_of(what).name;
}

TipNumbers tip_numbers(const Scene& scene, const Tip& tip) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  TipNumbers told{tip.K_I, tip.K_II, tip.J, tip.J_spread, tip.kink * (180.0 / std::numbers::pi), ""};
  const bool shut = tip.closed && tip.J == 0.0;  // whatever is near
  if (tip.crossed && !shut) {
    told = {none, none, none, none, none, std::string("the rings on which J and K are measured cross ")};
    told.reason += words_of(tip.near).crossed;
    if (tip.no_length)
      told.reason = "the tip stands on an interface whose faces have come apart: it has no length in the rock ahead";
  } else if (tip.closed) {
    told.kink_deg = none;
    told.reason = "the tip is closed: it has no direction to open into";
  } else if (tip.near == Obstacle::interface) {
    told.J_N_m = told.J_spread = none;
    told.reason = "the rings on which J is measured reach over an interface whose faces have come apart";
  } else if (tip.J < 0.0 && scene.numerics.mechanics == Numerics::Mechanics::quasistatic) {
    told.J_N_m = told.J_spread = none;
    told.reason =
        "J comes out below 0, which no tip at rest has: cells are too coarse for what the pressure does there";
  }
  return told;
}

}  // namespace strata
