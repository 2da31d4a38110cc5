#include "mechanics/failure.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <tuple>

#include "mechanics/stiffness.hpp"
#include "state/rebuild.hpp"

namespace strata {

namespace {

constexpr double least_share = 0.1;  // of a cell: a column that reaches less of the interface has no mean to speak of

// The rows (for a vertical interface: columns) of nodes that an interface splits when it lets go.
struct Band {
  bool along_x = true;
  int first = 0, last = 0;
  bool holds(int across) const { return across >= first && across <= last; }
};

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

// Whether the fracture splits the nodes of a column on one side of the interface.
bool split_by_fracture(const State& state, const Band& band, int column, bool plus) {
  const int across = plus ? band.last : band.first;
  const int node = band.along_x ? state.grid.node(column, across) : state.grid.node(across, column);
  const int c = state.copies.cut_of_node[static_cast<std::size_t>(node)];
  return c >= 0 && state.copies.cut[static_cast<std::size_t>(c)].fracture != 0;
}

// Column, side of the interface, side of the fracture (-1: not told apart).
using SampleKey = std::tuple<int, bool, int>;

struct SampleBuilder {
  const Scene& scene;
  const State& state;
  const Surface& surface;
  Band band;
  std::map<SampleKey, BondSample> samples;
};

SampleKey key_at(const SampleBuilder& b, int column, SideWord sides, bool plus) {
  const bool parted = b.state.has_fracture && split_by_fracture(b.state, b.band, column, plus);
  return {column, plus, parted ? ((sides & b.state.fracture().mask()) != 0 ? 1 : 0) : -1};
}

// The weight Phi and its gradient of the three columns around a place.
struct ColumnWeights {
  std::array<int, 3> column{};
  std::array<double, 3> Phi{};
  std::array<Vec2, 3> grad{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
};

ColumnWeights column_weights(const SampleBuilder& b, const Vec2& x, const Vec2& half) {
  const Grid& g = b.state.grid;
  const int i = std::clamp(g.column_at(x.x()), 0, g.nx), j = std::clamp(g.row_at(x.y()), 0, g.ny);
  const Gradients N = gradients_at(b.scene, g, i, j, x, half);
  ColumnWeights out;
  for (std::size_t n = 0; n < 9; ++n) {
    const int node_i = i + static_cast<int>(n % 3) - 1, node_j = j + static_cast<int>(n / 3) - 1;
    const std::size_t a = b.band.along_x ? n % 3 : n / 3;
    out.column[a] = b.band.along_x ? node_i : node_j;
    if (!b.band.holds(b.band.along_x ? node_j : node_i)) continue;
    out.Phi[a] += N.N[n];
    out.grad[a] += Vec2{N.N_x[n], N.N_y[n]};
  }
  return out;
}

void add_particles(SampleBuilder& b) {
  const Particles& p = b.state.particles;
  const Grid& g = b.state.grid;
  struct Last {
    SampleKey key{};
    BondSample* sample = nullptr;
  };
  std::array<Last, 3> last;  // particles of a bin follow each other, and have the same keys but for sides
  const bool has_body = b.scene.body.acceleration_m_s2.has_value();
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 x{p.x[q], p.y[q]};
    const int across = b.band.along_x ? g.row_at(x.y()) : g.column_at(x.x());
    if (across < b.band.first - 2 || across > b.band.last + 2) continue;
    const ColumnWeights w = column_weights(b, x, p.half(q));
    const bool plus = (p.sides[q] & b.surface.mask()) != 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (w.grad[a].isZero() && (!has_body || w.Phi[a] == 0.0)) continue;
      const SampleKey key = key_at(b, w.column[a], p.sides[q], plus);
      if (last[a].sample == nullptr || last[a].key != key) last[a] = {key, &b.samples[key]};
      last[a].sample->particles.push_back({q, p.V[q] * w.grad[a], w.Phi[a]});
    }
  }
}

// The fracture's two faces load the columns on its two sides.
void add_faces(SampleBuilder& b) {
  if (!b.state.has_fracture) return;
  const Surface& fracture = b.state.fracture();
  for (std::size_t q = 0; q < fracture.points.size(); ++q) {
    const SurfacePoint& s = fracture.points[q];
    const Grid& g = b.state.grid;
    const int across = b.band.along_x ? g.row_at(s.x.y()) : g.column_at(s.x.x());
    if (across < b.band.first - 2 || across > b.band.last + 2) continue;
    const ColumnWeights w = column_weights(b, s.x, Vec2::Zero());
    const bool plus = (s.sides & b.surface.mask()) != 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (w.Phi[a] == 0.0) continue;
      for (const double face : {1.0, -1.0}) {
        const SampleKey key = key_at(b, w.column[a], face > 0.0 ? fracture.mask() : SideWord{0}, plus);
        if (std::get<2>(key) < 0) continue;  // both faces in one column: no force
        b.samples[key].faces.push_back({q, {face * s.A * w.Phi[a], 0.0}, 0.0});
      }
    }
  }
}

// The same rule along the interface as the particles': then a uniform stress implies its own traction to round-off, at
// columns that an edge or the fracture cuts off too.
void add_lengths(SampleBuilder& b) {
  const auto& sizes = b.band.along_x ? b.state.particles.half_x : b.state.particles.half_y;
  const double half = *std::min_element(sizes.begin(), sizes.end());
  for (std::size_t q = 0; q < b.surface.points.size(); ++q) {
    const SurfacePoint& s = b.surface.points[q];
    const int parts = std::max(1, static_cast<int>(std::lround(0.5 * b.state.grid.h / (2.0 * half))));
    for (int part = 0; part < parts; ++part) {
      const Vec2 along{s.n.y(), -s.n.x()};
      const Vec2 x = s.x + s.A * ((part + 0.5) / parts - 0.5) * along;
      const ColumnWeights w = column_weights(b, x, Vec2::Zero());
      const SideWord sides = sides_at(b.state, x, b.surface.bit);
      for (std::size_t a = 0; a < 3; ++a) {
        const double share = s.A / parts * w.Phi[a];
        if (share == 0.0) continue;
        for (const bool plus : {false, true}) {
          BondSample& sample = b.samples[key_at(b, w.column[a], sides, plus)];
          if (s.split) {
            sample.loose.push_back({q, {share, 0.0}, 0.0});
          } else {
            sample.length += share;
          }
        }
      }
    }
  }
}

// Mean total stress that a sample implies on the interface, on the + face.
Vec2 traction(const std::vector<Elasticity>& rocks, const State& state, const Surface& surface,
              const BondSample& sample) {
  const Particles& p = state.particles;
  Vec2 force = Vec2::Zero();
  for (const BondSample::Share& share : sample.particles) {
    const std::size_t q = share.index;
    force += stress_of(rocks[p.rock[q]], p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]).on(share.weight);
    if (!state.body.empty()) force -= p.m[q] * share.Phi * state.body[q];
  }
  for (const BondSample::Share& share : sample.faces) {
    const SurfacePoint& s = state.fracture().points[share.index];
    force -= share.weight.x() * (s.P * s.n - s.in_situ + s.reaction);
  }
  force *= -sample.sign;
  for (const BondSample::Share& share : sample.loose) {
    const SurfacePoint& s = surface.points[share.index];
    force -= share.weight.x() * (s.reaction - s.in_situ);
  }
  return force / sample.length;
}

}  // namespace

double failure_index(const InterfaceLaw& law, double n, double t) {
  if (law.kind == InterfaceLaw::Kind::weak) {
    const double S = t / law.shear_strength_Pa, N = std::max(0.0, -n) / law.tensile_strength_Pa;
    return std::sqrt(S * S + N * N);
  }
  if (law.kind != InterfaceLaw::Kind::friction) return 0.0;
  if (n < 0.0) return HUGE_VAL;
  return t == 0.0 ? 0.0 : std::abs(t) / (law.coefficient * n);
}

Bonds find_bonds(const Scene& scene, const State& state) {
  Bonds bonds;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const Surface& surface = state.surfaces[k];
    if (surface.kind != Surface::Kind::interface) continue;
    const InterfaceLaw::Kind kind = scene.laws[surface.law].kind;
    if (kind != InterfaceLaw::Kind::weak && kind != InterfaceLaw::Kind::friction) continue;
    SampleBuilder b{scene, state, surface, band_of(scene, state, surface), {}};
    add_particles(b);
    add_faces(b);
    add_lengths(b);
    std::map<SampleKey, std::size_t> at;
    for (auto& [key, sample] : b.samples) {
      if (sample.length < least_share * state.grid.h) continue;
      sample.sign = std::get<1>(key) ? -1.0 : 1.0;
      at.emplace(key, bonds.samples.size());
      bonds.samples.push_back(std::move(sample));
    }
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      const SurfacePoint& s = surface.points[q];
      if (s.split) continue;
      BondedPlace place{k, q, {}, 0.0, Vec2::Zero()};
      const bool below = split_by_fracture(state, b.band, s.column, false),
                 above = split_by_fracture(state, b.band, s.column, true);
      for (const bool plus : {false, true}) {
        if (below != above && (plus ? above : below) == false) continue;  // the side that the fracture parts tells more
        const auto found = at.find(key_at(b, s.column, s.sides, plus));
        if (found != at.end()) place.samples.push_back(found->second);
      }
      bonds.places.push_back(place);
    }
  }
  return bonds;
}

void load_bonds(const Scene& scene, const std::vector<Elasticity>& rocks, const State& state, Bonds& bonds) {
  std::vector<std::optional<Vec2>> of_sample(bonds.samples.size());  // places of a column share theirs
  for (BondedPlace& place : bonds.places) {
    const Surface& surface = state.surfaces[place.surface];
    const SurfacePoint& s = surface.points[place.point];
    place.carried = s.in_situ;
    for (const std::size_t k : place.samples) {
      if (!of_sample[k]) of_sample[k] = traction(rocks, state, surface, bonds.samples[k]);
      place.carried += *of_sample[k] / static_cast<double>(place.samples.size());
    }
    const Vec2 t{s.n.y(), -s.n.x()};
    place.index = failure_index(scene.laws[surface.law], place.carried.dot(s.n), place.carried.dot(t));
  }
}

}  // namespace strata
