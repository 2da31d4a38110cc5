// Random small scenes: layers, laws, contrasts, edges, cracks and loads from a seed.
#pragma once

#include <random>

#include "small_scenes.hpp"

namespace strata::test {

struct Dice {
  std::mt19937 random;
  explicit Dice(unsigned seed) : random(seed) {}
  double uniform(double from, double to) { return from + (to - from) * (static_cast<double>(random()) / 4294967296.0); }
  double log_uniform(double from, double to) { return from * std::pow(to / from, uniform(0.0, 1.0)); }
  int below(int n) { return static_cast<int>(random() % static_cast<unsigned>(n)); }
  bool chance(double share) { return uniform(0.0, 1.0) < share; }
};

// Numbers are drawn one a statement: compilers evaluate arguments of a call in orders of their own.
inline InterfaceLaw random_law(Dice& dice) {
  const int kind = dice.below(4);
  if (kind == 0) return friction_law(dice.chance(0.2) ? 0.0 : dice.uniform(0.05, 1.2));
  if (kind == 1) {
    const double residual = dice.chance(0.5) ? 0.0 : dice.uniform(0.05, 0.8);
    const double N_c = dice.log_uniform(1e3, 3e6);
    const double S_c = dice.log_uniform(1e3, 3e6);
    return weak_law(S_c, N_c, residual);
  }
  const double D_t = dice.log_uniform(1e3, 1e12);
  const double D_n = dice.log_uniform(1e3, 1e12);
  return soft_law(D_n, D_t, kind == 2 ? InterfaceLaw::Compression::contact : InterfaceLaw::Compression::spring);
}

// A crack from the symmetric bottom, or inside: upright, level or at an angle, on grid lines, at mid-cell or anywhere.
inline void random_crack(Dice& dice, int n, Scene& scene) {
  const double start = dice.uniform(0.0, 3e6);
  const bool from_bottom = scene.domain.bottom == Edge::symmetry && dice.chance(0.6);
  const double half = dice.chance(0.7) ? 0.5 * (1 + dice.below(4)) : dice.uniform(0.8, 2.0);
  double x = 0.5 * (n + dice.below(5) - 2), y = 0.5 * (n + dice.below(5) - 2);
  double angle = dice.chance(0.5) ? 90.0 : (dice.chance(0.5) ? 0.0 : dice.uniform(20.0, 160.0));
  if (from_bottom) y = 0.0, angle = 90.0;
  // A crack along an interface would lie on it.
  const bool along = scene.strata.along == Strata::Along::y ? angle == 0.0 : angle == 90.0;
  for (const InterfacePlace& place : scene.strata.interfaces) {
    double& across = scene.strata.along == Strata::Along::y ? y : x;
    if (along && std::abs(across - place.at_m) < 1.0) across = place.at_m + (place.at_m < 0.5 * n ? 1.5 : -1.5);
  }
  if (scene.strata.interfaces.size() > 1 && along) angle = 90.0 - angle;
  if (from_bottom && angle != 90.0) y = 0.5 * n;
  const double c = half * std::cos(angle * M_PI / 180.0), s = half * std::sin(angle * M_PI / 180.0);
  if (y == 0.0)
    add_fracture(scene, {{x, 0.0}, {x, 2.0 * half}}, start);
  else
    add_fracture(scene, {{x - c, y - s}, {x + c, y + s}}, start);
  scene.fluid.rate_Pa_s = dice.uniform(-2e6, 4e6);
  scene.fluid.start_Pa = start;
}

// Blocks of 8 to 12 cells of 1 m: what lives in them is random, mechanisms included.
inline Scene random_scene(unsigned seed) {
  Dice dice(seed);
  const int n = 8 + dice.below(5);
  Scene scene = block(n, n);
  scene.numerics.mechanics = Numerics::Mechanics::quasistatic;
  scene.domain.bottom = dice.chance(0.7) ? Edge::symmetry : Edge::traction;
  scene.domain.sides = dice.chance(0.6) ? Edge::fixed : Edge::traction;
  scene.domain.top = dice.chance(0.2) ? Edge::fixed : Edge::traction;
  scene.in_situ.vertical_Pa = dice.uniform(-0.5e6, 5e6);
  scene.in_situ.horizontal_Pa = dice.uniform(-0.5e6, 5e6);
  if (dice.chance(0.3)) scene.in_situ.initialise = InSitu::Initialise::loaded;
  scene.strata.along = dice.chance(0.6) ? Strata::Along::y : Strata::Along::x;
  scene.rocks.push_back({"other", dice.log_uniform(0.5e9, 50e9), dice.uniform(0.0, 0.45), 2500.0, 1e6});
  const int interfaces = dice.below(3);
  for (int k = 0; k < interfaces; ++k) {
    const double at = interfaces == 1 ? 0.5 * (n + dice.below(5) - 2) : (k == 0 ? 2.5 : n - 3.0);
    const auto rock = static_cast<std::size_t>(dice.below(2));
    add_interface(scene, random_law(dice), at, rock);
  }
  if (dice.chance(0.9)) random_crack(dice, n, scene);
  if (!scene.fracture) return scene;
  scene.fracture->growth = std::array{Fracture::Growth::none, Fracture::Growth::J,
                                      Fracture::Growth::energy}[static_cast<std::size_t>(dice.below(3))];
  scene.fracture->crossing = Fracture::Crossing::energy;
  scene.fracture->direction = dice.chance(0.7) ? Fracture::Direction::straight : Fracture::Direction::max_hoop;
  return scene;
}

}  // namespace strata::test
