#include "interfaces/surface_law.hpp"

#include <algorithm>
#include <cmath>

namespace strata {
namespace {

using Piece = LawAnswer::Piece;
using Shear = LawAnswer::Shear;
using Kind = InterfaceLaw::Kind;
using Compression = InterfaceLaw::Compression;

// A spring both ways, D (Pa/m) along the normal and the tangent.
InterfaceLaw spring_law(double D) {
  InterfaceLaw law;
  law.kind = Kind::soft;
  law.normal_stiffness_Pa_m = law.shear_stiffness_Pa_m = D;
  law.compression = Compression::spring;
  return law;
}

LawLine largest_at(const LawLines& law, double w) {
  return std::ranges::max(law.normal(), {}, [w](const LawLine& line) { return line.at(w); });
}

// Where two lines meet (m).
double meeting(const LawLine& a, const LawLine& b) {
  return (a.at(0.0) - b.at(0.0)) / (a.D - b.D);
}

}  // namespace

// --- the laws

LawLines lines_of(const InterfaceLaw& law, double k, const LawStart& start, double n_rest) {
  LawLines lines;
  if (law.kind == Kind::perfect) return lines;
  lines.friction = law.friction(), lines.slides = law.slides();
  if (!law.takes_all_compression()) lines.contact = {Piece::closed, k, n_rest};
  lines.shear = {Piece::open, k, start.r_t, start.w_t};
  if (law.kind == Kind::soft) {
    lines.own.D = law.normal_stiffness_Pa_m;
    lines.shear = {Piece::open, law.shear_stiffness_Pa_m};
  }
  return lines;
}

LawStart start_of(const SurfacePoint& s) {
  const Vec2 t = tangent_of(s.n);
  return {s.w.dot(t), s.reaction.dot(t), s.memory, s.reaction.dot(s.n)};
}

void remember(const InterfaceLaw& law, double /*w_n*/, double dw_t, InterfaceLaw::Memory& memory) {
  if (law.slides()) memory.slip += std::abs(dw_t);
}

double contact_stiffness(const InterfaceLaw& law, const Rocks& rocks, const Grid& grid) {
  double E_prime = 0.0;
  for (const Elasticity& rock : rocks) E_prime = std::max(E_prime, rock.E_prime);
  const double k = 1e4 * E_prime / grid.h;
  return law.kind == Kind::soft ? std::max(k, 10.0 * law.normal_stiffness_Pa_m) : k;
}

InterfaceLaw face_law(const Scene& scene) {
  if (scene.fracture && scene.fracture->faces == Fracture::Faces::free) return spring_law(0.0);
  InterfaceLaw law;
  law.kind = Kind::friction;
  law.coefficient = scene.fracture ? scene.fracture->friction : 0.0;
  return law;
}

InterfaceLaw law_of(const Scene& scene, const Surface& surface) {
  return surface.kind == Surface::Kind::fracture ? face_law(scene) : scene.laws[surface.law];
}

InterfaceLaw tie_law(const TipTie& tie) {
  return spring_law(tie.stiffness);
}

// Closed contact and stick hold r^2/(2k), some 1e-4 of what the rock beside them does: that is left in the ledger's
// friction, which is then negative by as much while load comes on. All of it is counted, so the ledger closes.
double spring_energy_at(const InterfaceLaw& law, const SurfacePoint& s) {
  if (!law.pulls() || !s.split) return 0.0;
  LawLines springs = lines_of(law, HUGE_VAL, start_of(s), 0.0);
  springs.contact = LawLines::none;
  const double w_t = s.w.dot(tangent_of(s.n)), D_t = springs.slides ? 0.0 : springs.shear.D;
  const double w_n = law.takes_all_compression() ? s.opening() : std::max(0.0, s.opening());
  return s.A * (springs.energy(w_n) + 0.5 * D_t * w_t * w_t);
}

double spring_energy(const Scene& scene, const State& state) {
  double energy = 0.0;
  for (const TipTie& tie : state.ties) energy += spring_energy_at(tie_law(tie), tie.s);
  for (const Surface& surface : state.surfaces) {
    if (surface.kind != Surface::Kind::interface) continue;
    for (const SurfacePoint& s : surface.points) energy += spring_energy_at(scene.laws[surface.law], s);
  }
  return energy;
}

// --- what follows from the lines of any law

// In the form that keeps its digits for any D > 0.
double LawLine::at_end_of_step(double w_free, double per) const {
  return D > 0.0 ? (r_0 / D - (w_free - w_0)) / (1.0 / D + per) : r_0;
}

double LawLines::bound(double n) const {
  return slides ? friction * std::max(0.0, n) : HUGE_VAL;
}

LawAnswer LawLines::at(double w_n, double w_t, double given) const {
  LawAnswer r;
  const LawLine line = largest_at(*this, w_n);
  r.piece = line.piece, r.n = line.at(w_n), r.n_0 = line.at(0.0), r.dn_dn = -line.D;
  r.energy = energy(w_n);
  const bool follows = given < 0.0;
  // A bound that is given does not ask for the normal reaction: else friction would jump where a face opens, and the
  // energy with it.
  if (slides && (friction == 0.0 || (follows && r.n <= 0.0))) return r;
  const double held = shear.at(w_t), most = follows || !slides ? bound(r.n) : given;
  r.t = std::clamp(held, -most, most);
  if (r.t == held) {
    if (slides) r.set(Shear::sticks);
    r.t_0 = shear.at(0.0), r.dt_dt = -shear.D;
    r.energy += 0.5 * (shear.r_0 + held) * (shear.w_0 - w_t);
    return r;
  }
  const double sign = std::copysign(1.0, held);
  r.set(sign > 0.0 ? Shear::slips_plus : Shear::slips_minus);
  r.t_0 = follows ? sign * friction * r.n_0 : r.t;
  r.dt_dn = follows ? sign * friction * r.dn_dn : 0.0;
  // A given bound makes sliding the gradient of an energy, too.
  const double slid = follows ? 0.0 : most * std::abs(held - r.t);
  r.energy += (0.5 * (r.t * r.t - shear.r_0 * shear.r_0) + slid) / shear.D;
  return r;
}

// Lines that fall meet the law's answer at the largest of theirs.
Reaction LawLines::at_end_of_step(const FreeJump& w) const {
  double n = -HUGE_VAL;
  for (const LawLine& line : normal()) n = std::max(n, line.at_end_of_step(w.n, w.per_n));
  return admissible({n, shear.at_end_of_step(w.t, w.per_t)});
}

Reaction LawLines::admissible(const Reaction& r) const {
  double n = r.n;
  for (const LawLine& line : normal()) n = std::max(n, line.D > 0.0 ? -HUGE_VAL : line.at(0.0));
  return {n, std::clamp(r.t, -bound(n), bound(n))};
}

// The trapezoidal rule between the ends and where lines meet.
double LawLines::energy(double w_n) const {
  const double from = std::min(0.0, w_n), to = std::max(0.0, w_n);
  std::array cuts{from, meeting(own, contact), to};
  double sum = 0.0;
  for (double& w : cuts) w = std::min(to, std::max(from, w));
  std::ranges::sort(cuts);
  for (std::size_t k = 1; k < cuts.size(); ++k) {
    const double a = cuts[k - 1], b = cuts[k];
    sum += 0.5 * (largest_at(*this, a).at(a) + largest_at(*this, b).at(b)) * (b - a);
  }
  return w_n > 0.0 ? -sum : sum;
}

}  // namespace strata
