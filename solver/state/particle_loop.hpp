// Loops over particles with their weights at the nine nodes around.
#pragma once

#include <vector>

#include "state/shape_functions.hpp"
#include "state/state.hpp"

namespace strata {

/// The weights of a bin's particle. Throws nothing.
inline Gradients gradients_at(const Scene& scene, const State& state, const Bin& bin, std::size_t q) {
  const Particles& p = state.particles;
  return gradients_at(scene, state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q));
}

/// Calls visit(bin, particle, its weights) for the particles of some bins.
template <class Bins, class Visit>
void for_each_particle(const Scene& scene, const State& state, const Bins& bins, Visit visit) {
  const Particles& p = state.particles;
  with_shape(scene.numerics.shape, [&](auto shape) {  // asked for once
    for (const Bin& bin : bins) {
      for (const std::size_t q : bin)
        visit(bin, q, gradients_of<decltype(shape)>(state.grid, bin.i, bin.j, {p.x[q], p.y[q]}, p.half(q)));
    }
  });
}

/// A field of records at a particle: sum N_i v_i.
inline Vec2 interpolate(const Gradients& g, const Bin& bin, const std::vector<Vec2>& v) {
  Vec2 sum = Vec2::Zero();
  for (std::size_t n = 0; n < 9; ++n) sum += g.N[n] * v[static_cast<std::size_t>(bin.record[n])];
  return sum;
}

}  // namespace strata
