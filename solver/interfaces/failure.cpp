#include "interfaces/failure.hpp"

#include <Eigen/SparseCholesky>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <span>
#include <tuple>
#include <vector>

#include "state/particle_loop.hpp"
#include "state/rebuild.hpp"

namespace strata {
namespace {

// --- columns of nodes across an interface

// The rows (for a vertical interface: columns) of nodes that an interface splits when it lets go.
struct Band {
  bool along_x = true;
  int first = 0, last = 0;
  bool holds(int across) const { return across >= first && across <= last; }
};

// The weight Phi = sum N_i over the band, and its gradient (1/m), of the three columns around a place.
struct ColumnWeights {
  std::array<int, 3> column{};
  std::array<double, 3> Phi{};
  std::array<Vec2, 3> grad{Vec2::Zero(), Vec2::Zero(), Vec2::Zero()};
};

Band band_of(const Scene& scene, const State& state, const Surface& surface) {
  const Grid& g = state.grid;
  Band band;
  band.along_x = scene.strata.upwards();
  const Vec2 x = surface.vertices.front().x;
  const int at = band.along_x ? g.row_at(x.y()) : g.column_at(x.x());
  const double offset =
      (band.along_x ? x.y() - g.y(at) : x.x() - g.x(at)) / g.h;  // 0 on a grid line, +-1/2 at mid-cell
  const double reach = support_in_cells(scene) - 0.02;
  band.first = at + static_cast<int>(std::ceil(offset - reach));
  band.last = at + static_cast<int>(std::floor(offset + reach));
  return band;
}

// The weights at a place x (m) of a particle of half sides `half` (m).
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

// Force of the rock on the - side on the columns from -1 on, beyond that of the prescribed stress, which is in balance.
Eigen::MatrixX2d forces_from_below(const Scene& scene, const State& state, const Surface& surface, const Band& band,
                                   const std::vector<Stress>& prescribed, Eigen::Index columns) {
  Eigen::MatrixX2d forces = Eigen::MatrixX2d::Zero(columns, 2);
  const Particles& p = state.particles;
  for (std::size_t q = 0; q < p.size(); ++q) {
    if ((p.sides[q] & surface.mask()) != 0) continue;
    const ColumnWeights w = column_weights(scene, state.grid, band, {p.x[q], p.y[q]}, p.half(q));
    for (std::size_t a = 0; a < 3; ++a)
      forces.row(w.column[a] + 1) -= (p.in_situ[q] + -1.0 * prescribed[q]).on(p.V[q] * w.grad[a]).transpose();
  }
  return forces;
}

// --- what bonded places carry

// Places under friction give nothing up where they are split: they stick. So they are split at this share of what makes
// them slide, and slip zones run in rock that is split already. The friction work of slip zones over 25 m is then 128
// to 133 J/m at cells of 1, 0.5 and 0.25 m, graded or not, where strata-reference sliding_blocks has 134.8; columns
// that are split as they slide make 130 to 270 J/m of it.
constexpr double lets_go_sticking = 0.3;

constexpr double least_share = 0.1;  // of a cell: a column that reaches less of the interface has no mean to speak of

// Whether the fracture splits the nodes of a column on one side of the interface, for rock on these sides of others.
bool split_by_fracture(const State& state, const Band& band, int column, SideWord sides, bool plus) {
  const int across = plus ? band.last : band.first;
  const int node = band.along_x ? state.grid.node(column, across) : state.grid.node(across, column);
  const CutNode* cut = state.copies.cut_at(node);
  return cut != nullptr && cut->key(sides | cut->fracture) != cut->key(sides & ~cut->fracture);
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
  sides = plus ? sides | b.surface.mask() : sides & ~b.surface.mask();
  const bool parted = b.state.has_fracture && split_by_fracture(b.state, b.band, column, sides, plus);
  return {column, plus, parted ? ((sides & b.state.fracture().mask()) != 0 ? 1 : 0) : -1};
}

void add_particles(SampleBuilder& b) {
  const Particles& p = b.state.particles;
  const Grid& g = b.state.grid;
  const bool has_body = b.scene.body.acceleration_m_s2.has_value();
  for (std::size_t q = 0; q < p.size(); ++q) {
    const Vec2 x{p.x[q], p.y[q]};
    const int across = b.band.along_x ? g.row_at(x.y()) : g.column_at(x.x());
    if (across < b.band.first - 2 || across > b.band.last + 2) continue;
    const ColumnWeights w = column_weights(b.scene, b.state.grid, b.band, x, p.half(q));
    const bool plus = (p.sides[q] & b.surface.mask()) != 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (w.grad[a].isZero() && (!has_body || w.Phi[a] == 0.0)) continue;
      b.samples[key_at(b, w.column[a], p.sides[q], plus)].particles.push_back({q, p.V[q] * w.grad[a], w.Phi[a]});
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
    const ColumnWeights w = column_weights(b.scene, b.state.grid, b.band, s.x, Vec2::Zero());
    const bool plus = (s.sides & b.surface.mask()) != 0;
    for (std::size_t a = 0; a < 3; ++a) {
      if (w.Phi[a] == 0.0) continue;
      for (const double face : {1.0, -1.0}) {
        const SampleKey key = key_at(b, w.column[a], face > 0.0 ? s.sides | fracture.mask() : s.sides, plus);
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
      const ColumnWeights w = column_weights(b.scene, b.state.grid, b.band, x, Vec2::Zero());
      const SideWord sides = sides_at(b.state, x, b.surface.bit);
      for (std::size_t a = 0; a < 3; ++a) {
        const double share = s.A / parts * w.Phi[a];
        if (share == 0.0) continue;
        for (const bool plus : {false, true}) {
          BondSample& sample = b.samples[key_at(b, w.column[a], sides, plus)];
          sample.length += share;
          if (s.split) sample.loose.push_back({q, {share, 0.0}, 0.0});
        }
      }
    }
  }
}

// Whether a bonded point is the first behind what has let go or behind the fracture, where that reaches the interface.
bool begins_stretch(const State& state, const Band& band, const Surface& surface, std::size_t q) {
  if (q == 0 || surface.points[q - 1].split) return true;
  const SurfacePoint &s = surface.points[q], &before = surface.points[q - 1];
  if (!state.has_fracture || ((s.sides ^ before.sides) & state.fracture().mask()) == 0) return false;
  const auto parted = [&](int column, bool plus) {
    return split_by_fracture(state, band, column, plus ? s.sides | surface.mask() : s.sides, plus);
  };
  return parted(s.column, false) || parted(s.column, true) || parted(before.column, false) ||
         parted(before.column, true);
}

// Masses of the column's own nodes, lumped as in the step: sum_p m_p N_ip by records.
void add_inertia(SampleBuilder& b) {
  if (b.scene.numerics.mechanics == Numerics::Mechanics::quasistatic) return;
  const Particles& p = b.state.particles;
  const std::vector<std::size_t> bin_of = bins_of_particles(b.state);
  for (auto& [key, sample] : b.samples) {
    std::map<int, double> masses;
    for (const BondSample::Share& share : sample.particles) {
      const std::size_t q = share.index;
      const Bin& bin = b.state.bins[bin_of[q]];
      const Gradients g = gradients_at(b.scene, b.state, bin, q);
      for (std::size_t n = 0; n < 9; ++n) {
        const int i = bin.i + static_cast<int>(n % 3) - 1, j = bin.j + static_cast<int>(n / 3) - 1;
        const bool own = (b.band.along_x ? i : j) == std::get<0>(key) && b.band.holds(b.band.along_x ? j : i);
        if (own) masses[bin.record[n]] += p.m[q] * g.N[n];
      }
    }
    for (const auto& [record, m] : masses) sample.inertia.push_back({record, m});
  }
}

// Columns without a bonded point of their own: beyond an edge or the fracture they reach over with a corner of their
// functions, and what they carry there is given to the column beside them; where the column has let go its copies carry
// nothing but what its points exert.
void join_columns(SampleBuilder& b) {
  std::set<SampleKey> bonded;
  std::set<int> loose;
  for (const SurfacePoint& s : b.surface.points) {
    if (s.split) loose.insert(s.column);
    for (const bool plus : {false, true}) {
      if (!s.split) bonded.insert(key_at(b, s.column, s.sides, plus));
    }
  }
  std::map<SampleKey, BondSample> kept;
  for (auto& [key, sample] : b.samples) {
    const auto& [column, plus, side] = key;
    SampleKey to = key;
    for (const SampleKey& beside : {SampleKey{column + 1, plus, side}, SampleKey{column - 1, plus, side}}) {
      if (!bonded.contains(key) && bonded.contains(beside)) to = beside;
    }
    if (loose.contains(column) || !bonded.contains(to)) continue;
    BondSample& into = kept[to];
    const auto append = [](auto& all, const auto& more) { all.insert(all.end(), more.begin(), more.end()); };
    append(into.particles, sample.particles), append(into.faces, sample.faces), append(into.loose, sample.loose);
    append(into.inertia, sample.inertia);
    into.length += sample.length;
  }
  std::erase_if(kept, [&](const auto& entry) { return entry.second.length < least_share * b.state.grid.h; });
  b.samples = std::move(kept);
}

// Traction of a sample's bonded places (Pa, on the + face, less the in-situ one) where its rock exerts a force.
Vec2 traction(const State& state, const BondSample& sample, Vec2 force) {
  for (const BondSample::Share& share : sample.faces) {
    const SurfacePoint& s = state.fracture().points[share.index];
    force -= share.weight.x() * (s.P * s.n - s.in_situ + s.reaction);
  }
  force *= -sample.sign;
  for (const BondSample::Share& share : sample.loose) {
    const SurfacePoint& s = state.surfaces[sample.surface].points[share.index];
    force -= share.weight.x() * (s.reaction - s.in_situ);
  }
  return force / sample.length;
}

// What has let go ends at the first node that is not split, as a fracture does: the piece between the two belongs to it
// and carries what it does; the rest of what the node's column carries is that of the place's other piece.
void weigh(const Surface& surface, BondedPlace& place) {
  const auto& points = surface.points;
  const SurfacePoint& s = points[place.point];
  const SurfacePoint* beside = nullptr;
  if (place.point > 0 && points[place.point - 1].split) beside = &points[place.point - 1];
  if (place.point + 1 < points.size() && points[place.point + 1].split) beside = &points[place.point + 1];
  place.length = beside == nullptr ? s.A : 0.0;
  place.force = s.A * (beside == nullptr ? place.carried : Vec2{place.carried - beside->reaction});
}

// Judges the places of one stretch of bonded interface: what its pieces of a length carry on average counts for the
// places in them that carry most, or that slide.
void judge(const Surface& surface, const InterfaceLaw& law, double length, std::span<BondedPlace> stretch) {
  constexpr double round_off = 1e-9, as_bad = 1.0 - 1e-6;
  const Vec2 n = surface.points.front().n, t = tangent_of(n);
  const double least = law.only_sticks() ? lets_go_sticking : 1.0;
  const auto index_of = [&](const Vec2& carried) { return failure_index(law, carried.dot(n), carried.dot(t)) / least; };
  double all = 0.0;
  for (BondedPlace& place : stretch) {
    weigh(surface, place);
    all += place.length, place.own = index_of(place.carried), place.index = 0.0;
  }
  if (all == 0.0) {  // one column between two ends
    for (BondedPlace& place : stretch) {
      place.length = surface.points[place.point].A, place.force = place.length * place.carried;
      all += place.length;
    }
  }
  length = std::min(length, all);
  for (const bool back : {false, true}) {
    const auto at = [&](std::size_t k) { return back ? stretch.size() - 1 - k : k; };
    for (std::size_t from = 0; from < stretch.size(); ++from) {
      Vec2 force = Vec2::Zero();
      double left = length, most = 0.0;
      std::size_t k = from;
      for (; k < stretch.size() && left > round_off * length; ++k) {
        const BondedPlace& place = stretch[at(k)];
        force += (place.length > left ? left / place.length : 1.0) * place.force;
        left -= place.length;
        if (!(place.own <= most)) most = place.own;
      }
      if (left > round_off * length) break;  // the rest is shorter still
      const double index = index_of(force / length);
      if (law.only_sticks()) most = std::min(most, 1.0);  // all that slide let go
      for (std::size_t j = from; j < k; ++j) {
        BondedPlace& place = stretch[at(j)];
        if (!(place.own < as_bad * most) && !(index <= place.index)) place.index = index;  // no number stays
      }
    }
  }
}

}  // namespace

double failure_index(const InterfaceLaw& law, double n, double t) {
  if (law.has_strength()) {
    const double S = t / law.shear_strength_Pa, N = std::max(0.0, -n) / law.tensile_strength_Pa;
    return std::sqrt(S * S + N * N);
  }
  if (!law.only_sticks()) return 0.0;
  if (n < 0.0) return HUGE_VAL;
  return t == 0.0 ? 0.0 : std::abs(t) / (law.coefficient * n);
}

Bonds find_bonds(const Scene& scene, const State& state) {
  Bonds bonds;
  for (std::size_t k = 0; k < state.surfaces.size(); ++k) {
    const Surface& surface = state.surfaces[k];
    if (surface.kind != Surface::Kind::interface || scene.laws[surface.law].apart_at_start()) continue;
    SampleBuilder b{scene, state, surface, band_of(scene, state, surface), {}};
    add_particles(b);
    add_faces(b);
    add_lengths(b);
    add_inertia(b);
    join_columns(b);
    std::map<SampleKey, std::size_t> at;
    for (auto& [key, sample] : b.samples) {
      sample.sign = std::get<1>(key) ? -1.0 : 1.0;
      sample.surface = k;
      at.emplace(key, bonds.samples.size());
      bonds.samples.push_back(std::move(sample));
    }
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      const SurfacePoint& s = surface.points[q];
      if (s.split) continue;
      BondedPlace place{k, q, {}, begins_stretch(state, b.band, surface, q), Vec2::Zero(), 0.0};
      const bool below = split_by_fracture(state, b.band, s.column, s.sides, false),
                 above = split_by_fracture(state, b.band, s.column, s.sides | surface.mask(), true);
      for (const bool plus : {false, true}) {
        if (below != above && (plus ? above : below) == false) continue;  // the side that the fracture parts tells more
        const auto found = at.find(key_at(b, s.column, s.sides, plus));
        if (found != at.end()) place.samples.push_back(found->second);
      }
      bonds.places.push_back(place);
    }
  }
  bonds.forces.reserve(bonds.samples.size());
  return bonds;
}

void find_forces(const Rocks& rocks, const State& state, Bonds& bonds) {
  const Particles& p = state.particles;
  bonds.forces.assign(bonds.samples.size(), Vec2::Zero());
  for (std::size_t k = 0; k < bonds.samples.size(); ++k) {
    Vec2& force = bonds.forces[k];
    for (const BondSample::Share& share : bonds.samples[k].particles) {
      const std::size_t q = share.index;
      force += stress_of(rocks[p.rock[q]], p.g_xx[q], p.g_xy[q], p.g_yx[q], p.g_yy[q]).on(share.weight);
    }
    for (const BondSample::Mass& mass : bonds.samples[k].inertia) {
      const NodeMotion node = state.motion[static_cast<std::size_t>(mass.record)];
      force += mass.m / state.dt * Vec2{node.dv_x, node.dv_y};
    }
  }
}

void judge_bonds(const Scene& scene, const State& state, Bonds& bonds) {
  for (std::size_t k = 0; k < bonds.samples.size() && !state.body.empty(); ++k) {
    for (const BondSample::Share& share : bonds.samples[k].particles)
      bonds.forces[k] -= state.particles.m[share.index] * share.Phi * state.body[share.index];
  }
  for (BondedPlace& place : bonds.places) {
    place.carried = state.surfaces[place.surface].points[place.point].in_situ;
    for (const std::size_t k : place.samples)
      place.carried += traction(state, bonds.samples[k], bonds.forces[k]) / static_cast<double>(place.samples.size());
  }
  bonds.worst = 0.0;
  for (auto first = bonds.places.begin(); first != bonds.places.end();) {
    const auto last = std::find_if(first + 1, bonds.places.end(), [](const BondedPlace& p) { return p.begins; });
    const Surface& surface = state.surfaces[first->surface];
    const InterfaceLaw& law = scene.laws[surface.law];
    judge(surface, law, failure_length(scene, law), {first, last});
    for (; first != last; ++first) {
      if (!(first->index <= bonds.worst)) bonds.worst = first->index;
    }
  }
}

Columns failing_columns(const Scene& scene, const State& state, const Bonds& bonds) {
  constexpr double as_bad = 1e-6;
  const bool inertia = scene.numerics.mechanics == Numerics::Mechanics::explicit_dynamics;
  Columns columns;
  for (const BondedPlace& place : bonds.places) {
    const Surface& surface = state.surfaces[place.surface];
    const bool sticks = scene.laws[surface.law].only_sticks();
    if (place.index >= (sticks || inertia ? 1.0 : std::max(1.0, (1.0 - as_bad) * bonds.worst)))
      columns.emplace(place.surface, surface.points[place.point].column);
  }
  return columns;
}

void let_go(const Columns& columns, const Bonds& bonds, State& state, SideWord mask, SideWord sides) {
  for (const BondedPlace& place : bonds.places) {
    SurfacePoint& s = state.surfaces[place.surface].points[place.point];
    if (!columns.contains({place.surface, s.column}) || (s.sides & mask) != sides) continue;
    s.split = true;
    s.failed_s = state.time;
    s.bonded = s.w;  // what neighbours' splitting let it open while bonded is no gap, and no overlap to push back
    s.w = Vec2::Zero();
    s.reaction = place.carried - std::min(0.0, place.carried.dot(s.n)) * s.n;
  }
}

void hand_over_in_situ(const Scene& scene, State& state) {
  const Particles& p = state.particles;
  std::vector<Vec2> places;
  for (std::size_t q = 0; q < p.size(); ++q) places.emplace_back(p.x[q], p.y[q]);
  const std::vector<Stress> prescribed = prescribed_stress(scene, places);
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
    const Eigen::MatrixX2d t = factor.solve(forces_from_below(scene, state, surface, band, prescribed, columns));
    for (std::size_t q = 0; q < surface.points.size(); ++q) {
      SurfacePoint& s = surface.points[q];
      s.in_situ = -prescribed_stress(scene, {s.x})[0].on(s.n);
      for (std::size_t a = 0; a < 3; ++a) s.in_situ += at[q].Phi[a] * t.row(at[q].column[a] + 1).transpose();
    }
  }
}

}  // namespace strata
