#include "scene/points_across.hpp"

#include <cmath>

namespace strata {

namespace {

// Whether a layer between two surfaces, or one and an edge that moves freely, is thinner than 1.5 cells. A layer of one
// cell has four rows of quadratic B-splines, and two rows of particles leave one motion of these without any strain:
// the layer would be a mechanism.
bool has_thin_layer(const Scene& scene) {
  const auto& layers = scene.strata.layers;
  const auto parts = [&](std::size_t interface) {
    return scene.laws[scene.strata.interfaces[interface].law].kind != InterfaceLaw::Kind::perfect;
  };
  const bool along_y = scene.strata.along == Strata::Along::y, ends = scene.domain.beyond_m == 0.0;
  const bool first = ends && (along_y ? scene.domain.bottom : scene.domain.sides) == Edge::traction;
  const bool last = ends && (along_y ? scene.domain.top : scene.domain.sides) == Edge::traction;
  for (std::size_t k = 0; k < layers.size(); ++k) {
    const bool below = k > 0 ? parts(k - 1) : first, above = k + 1 < layers.size() ? parts(k) : last;
    if (below && above && layers[k].to_m - layers[k].from_m < 1.49 * scene.numerics.cell_m) return true;
  }
  return false;
}

}  // namespace

bool may_turn(const Scene& scene) {
  return scene.fracture && scene.fracture->growth != Fracture::Growth::none &&
         scene.fracture->direction == Fracture::Direction::max_hoop;
}

int points_across(const Scene& scene) {
  const int across = static_cast<int>(std::lround(std::sqrt(scene.numerics.particles_per_cell)));
  // Beside a path off the grid's lines 2 x 2 points are not enough (2.6 % in J), and the stiffness of the intact block,
  // which is factored once, must not change as points become finer.
  const bool turns = scene.numerics.mechanics == Numerics::Mechanics::quasistatic && may_turn(scene);
  const bool spline = scene.numerics.shape == Numerics::Shape::bspline2;
  return across == 2 && (turns || (spline && has_thin_layer(scene))) ? 4 : across;
}

}  // namespace strata
