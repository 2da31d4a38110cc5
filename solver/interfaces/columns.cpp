#include "interfaces/columns.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <cmath>
#include <vector>

#include "state/rebuild.hpp"
#include "state/shape_functions.hpp"

namespace strata {

Band band_of(const Scene& scene, const State& state, const Surface& surface) {
  const Grid& g = state.grid;
  Band band;
  band.along_x = scene.strata.along == Strata::Along::y;
  const Vec2 x = surface.vertices.front().x;
  const int at = band.along_x ? g.row_at(x.y()) : g.column_at(x.x());
  const double offset =
      (band.along_x ? x.y() - g.y(at) : x.x() - g.x(at)) / g.h;  // 0 on a grid line, +-1/2 at mid-cell
  const double reach = support_in_cells(scene) - 0.02;
  band.first = at + static_cast<int>(std::ceil(offset - reach));
  band.last = at + static_cast<int>(std::floor(offset + reach));
  return band;
}

ColumnWeights column_weights(const Scene& scene, const Grid& g, const Band& band, const Vec2& x, const Vec2& half) {
  const int i = std::clamp(g.column_at(x.x()), 0, g.nx), j = std::clamp(g.row_at(x.y()), 0, g.ny);
  // A place without size weighs by hat functions where particles weigh by uGIMP's, as surfaces do.
  const bool hat = scene.numerics.shape == Numerics::Shape::gimp && half.isZero();
  const Gradients N = with_shape(hat ? Numerics::Shape::linear : scene.numerics.shape,
                                 [&](auto shape) { return gradients_of<decltype(shape)>(g, i, j, x, half); });
  ColumnWeights out;
  for (std::size_t n = 0; n < 9; ++n) {
    const int node_i = i + static_cast<int>(n % 3) - 1, node_j = j + static_cast<int>(n / 3) - 1;
    const std::size_t a = band.along_x ? n % 3 : n / 3;
    out.column[a] = band.along_x ? node_i : node_j;
    if (!band.holds(band.along_x ? node_j : node_i)) continue;
    out.Phi[a] += N.N[n];
    out.grad[a] += Vec2{N.N_x[n], N.N_y[n]};
  }
  return out;
}

namespace {

// Force of the rock on the - side on the columns from -1 on, beyond that of the stress that balances the edges.
Eigen::MatrixX2d forces_from_below(const Scene& scene, const State& state, const Surface& surface, const Band& band,
                                   const Stress& even, Eigen::Index columns) {
  Eigen::MatrixX2d forces = Eigen::MatrixX2d::Zero(columns, 2);
  const Particles& p = state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    if ((p.sides[q] & surface.mask()) != 0) continue;
    const ColumnWeights w = column_weights(scene, state.grid, band, {p.x[q], p.y[q]}, p.half(q));
    for (std::size_t a = 0; a < 3; ++a)
      forces.row(w.column[a] + 1) -= (p.in_situ[q] + -1.0 * even).on(p.V[q] * w.grad[a]).transpose();
  }
  return forces;
}

}  // namespace

void hand_over_in_situ(const Scene& scene, State& state) {
  const Stress even{-scene.in_situ.horizontal_Pa, -scene.in_situ.vertical_Pa, 0.0};
  for (Surface& surface : state.surfaces) {
    const InterfaceLaw& law = scene.laws[surface.law];
    if (surface.kind != Surface::Kind::interface || law.takes_all_compression()) continue;
    const Band band = band_of(scene, state, surface);
    const Eigen::Index columns = (band.along_x ? state.grid.nx : state.grid.ny) + 3;
    std::vector<Eigen::Triplet<double>> entries;
    std::vector<ColumnWeights> at;
    for (const SurfacePoint& s : surface.points) {
      const ColumnWeights& w = at.emplace_back(column_weights(scene, state.grid, band, s.x, Vec2::Zero()));
      for (std::size_t a = 0; a < 3; ++a) {
        for (std::size_t b = 0; b < 3; ++b)
          entries.emplace_back(w.column[a] + 1, w.column[b] + 1, s.A * w.Phi[a] * w.Phi[b]);
      }
    }
    Eigen::SparseMatrix<double> M(columns, columns);
    M.setFromTriplets(entries.begin(), entries.end());
    for (Eigen::Index c = 0; c < columns; ++c) {
      if (M.coeff(c, c) == 0.0) M.coeffRef(c, c) = 1.0;  // hat functions do not reach in from beyond the edges
    }
    const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> factor(M);
    if (factor.info() != Eigen::Success)
      throw NumericalFailure(
          "the loaded in-situ state cannot be handed to an interface: its columns are not told apart");
    const Eigen::MatrixX2d t = factor.solve(forces_from_below(scene, state, surface, band, even, columns));
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      SurfacePoint& s = surface.points[q];
      s.in_situ = -even.on(s.n);
      for (std::size_t a = 0; a < 3; ++a) s.in_situ += at[q].Phi[a] * t.row(at[q].column[a] + 1).transpose();
    }
  }
}

}  // namespace strata
