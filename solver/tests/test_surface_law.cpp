#include "interfaces/surface_law.hpp"

#include <catch2/catch.hpp>

#include <cmath>
#include <set>
#include <string>

#include "small_scenes.hpp"

using namespace strata;
using namespace strata::test;

namespace {

using Compression = InterfaceLaw::Compression;

constexpr double k = 1e12;       // Pa/m, of closed contact
constexpr double spread = 3e-6;  // m: jumps up to this on both sides of where a law changes
constexpr int steps = 13;        // of jumps each way

// What a law is asked at a place.
struct LawInput {
  double w_n = 0.0, w_t = 0.0;              // jump (m)
  double w_t_start = 0.0, r_t_start = 0.0;  // what friction remembers (m, Pa)
  double bound = -1.0;                      // of friction where it is given (Pa)
  double n_rest = 0.0;                      // Pa
};

LawAnswer law_at(const InterfaceLaw& law, double stiffness, const LawInput& in) {
  return lines_of(law, stiffness, {in.w_t_start, in.r_t_start, {}}, in.n_rest).at(in.w_n, in.w_t, in.bound);
}

// A law with all that a place asks it but the jump.
struct Case {
  std::string name;
  InterfaceLaw law;
  LawInput at;
  double mu = 0.0;
  LawAnswer operator()(const Vec2& w) const {
    LawInput in = at;
    in.w_n = w.x(), in.w_t = w.y();
    return law_at(law, k, in);
  }
  bool has_energy() const { return mu == 0.0 || at.bound >= 0.0; }  // else friction depends on n
  Vec2 start() const { return {0.0, at.w_t_start}; }
};

// Every law, the stress at rest of either sign and none, friction with memory of either sign, its bound given or not;
// soft interfaces softer and stiffer than contact.
std::vector<Case> cases() {
  std::vector<Case> all;
  for (const double n_rest : {7e5, 0.0, -4e5}) {
    for (const double memory : {0.0, 1.5e5, -1.5e5}) {
      for (const double bound : {-1.0, 2e5}) {
        const LawInput in{0.0, 0.0, 1e-6 * std::copysign(1.0, memory), memory, bound, n_rest};
        all.push_back({"friction", friction_law(0.6), in, 0.6});
        all.push_back({"residual friction", weak_law(1e5, 1e5, 0.3), in, 0.3});
      }
    }
    const LawInput in{0.0, 0.0, 0.0, 0.0, -1.0, n_rest};
    all.push_back({"face", face_law(Scene{}), in});
    all.push_back({"failed weak", weak_law(1e5, 1e5), in});
    for (const double D : {1e9, 0.4 * k, 2.5 * k}) {
      all.push_back({"soft contact", soft_law(D, 0.3 * D), in});
      all.push_back({"soft spring", soft_law(D, 0.3 * D, Compression::spring), in});
    }
  }
  return all;
}

double jump(int step) {
  return spread * (2.0 * step / (steps - 1) - 0.97);
}

template <class See>
void at_all_jumps(int stride, const See& see) {
  for (const Case& c : cases()) {
    for (int a = 0; a < steps; a += stride) {
      for (int b = 0; b < steps; b += stride) {
        CAPTURE(c.name, c.at.n_rest, c.at.r_t_start, c.at.bound, c.law.normal_stiffness_Pa_m, jump(a), jump(b));
        see(c, Vec2{jump(a), jump(b)});
      }
    }
  }
}

// Work (J/m^2) taken up on a straight way between two jumps, by the trapezoidal rule.
double work_taken(const Case& c, const Vec2& from, const Vec2& to) {
  constexpr int parts = 2000;
  const Vec2 d = (to - from) / parts;
  double sum = 0.0;
  for (int q = 0; q <= parts; ++q) {
    const LawAnswer r = c(from + q * d);
    sum -= (q == 0 || q == parts ? 0.5 : 1.0) * (r.n * d.x() + r.t * d.y());
  }
  return sum;
}

}  // namespace

// Requires the reactions of header and study by hand: contact, stick and slip of both signs, a soft interface that
// hands over from contact to spring, softer and stiffer than contact. Mutations that fail: n_rest left out, the
// smaller of spring and contact, contact wherever w_n < 0, a given bound left out (on open faces or all), slip's sign,
// memory's reaction or jump left out, the coefficient read for the residual friction.
TEST_CASE("laws by hand") {
  const auto n = [](const InterfaceLaw& law, double n_rest, double w_n) {
    return law_at(law, k, {w_n, 0.0, 0.0, 0.0, -1.0, n_rest}).n;
  };
  CHECK(n(face_law(Scene{}), 7e5, -1e-6) == Approx(1.7e6));
  CHECK(n(face_law(Scene{}), 7e5, 0.8e-6) == 0.0);
  Scene free;
  free.fracture.emplace().faces = Fracture::Faces::free;
  CHECK(n(face_law(free), 7e5, -1e-6) == 0.0);
  CHECK(n(face_law(free), 7e5, 0.8e-6) == 0.0);
  CHECK(n(soft_law(0.4 * k, 0.0), 7e5, -1e-6) == Approx(1.7e6));
  CHECK(n(soft_law(0.4 * k, 0.0), 7e5, 1e-6) == Approx(-3e5));
  CHECK(n(soft_law(0.4 * k, 0.0), 7e5, 3e-6) == Approx(-1.2e6));
  CHECK(n(soft_law(2.5 * k, 0.0), 7e5, -1e-6) == Approx(2.5e6));
  CHECK(n(soft_law(2.5 * k, 0.0), 7e5, 1e-6) == Approx(-3e5));
  CHECK(n(soft_law(0.4 * k, 0.0, Compression::spring), 7e5, -1e-6) == Approx(4e5));
  const auto t = [](double w_n, double w_t, double bound) {
    return law_at(friction_law(0.6), k, {w_n, w_t, 1e-6, 1e5, bound, 7e5}).t;
  };
  CHECK(t(0.0, 1e-6, -1.0) == Approx(1e5));
  CHECK(t(0.0, 1.3e-6, -1.0) == Approx(-2e5));
  CHECK(t(0.0, 2e-6, -1.0) == Approx(-4.2e5));
  CHECK(t(0.0, 0.0, -1.0) == Approx(4.2e5));
  CHECK(t(1e-6, 0.0, -1.0) == 0.0);
  CHECK(t(1e-6, 0.0, 3e5) == Approx(3e5));
  CHECK(t(1e-6, 2e-6, 3e5) == Approx(-3e5));
  CHECK(t(1e-6, 1.3e-6, 3e5) == Approx(-2e5));
  CHECK(law_at(weak_law(1e5, 1e5, 0.3), k, {0.0, 2e-6, 0.0, 0.0, -1.0, 7e5}).t == Approx(-2.1e5));
  CHECK(law_at(soft_law(0.0, 2e11), k, {0.0, 3e-6}).t == Approx(-6e5));
}

// Requires that a law is the linear function that its answer names (n = n_0 + dn_dn w_n, t = t_0 + dt_dn w_n + dt_dt
// w_t), that its derivatives are those of differences, and that all pieces are met. Mutations that fail: n_0 or t_0
// without n_rest, memory or bound; the sign or size of dn_dn; dt_dt of stick left out; dt_dn 0, or that of a bound that
// follows n where one is given.
TEST_CASE("laws are linear in pieces") {
  constexpr double step = 1e-10;  // m
  std::set<LawAnswer::Piece> met;
  at_all_jumps(1, [&](const Case& c, const Vec2& w) {
    const LawAnswer r = c(w);
    met.insert(r.piece);
    CHECK(r.n == Approx(r.n_0 + r.dn_dn * w.x()).margin(1e-3));
    CHECK(r.t == Approx(r.t_0 + r.dt_dn * w.x() + r.dt_dt * w.y()).margin(1e-3));
    for (const Vec2& along : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}}) {
      const LawAnswer more = c(w + step * along), less = c(w - step * along);
      if (more.piece != r.piece || less.piece != r.piece) continue;
      const double dn = (more.n - less.n) / (2.0 * step), dt = (more.t - less.t) / (2.0 * step);
      CHECK(dn == Approx(r.dn_dn * along.x()).margin(1e-6 * k));
      CHECK(dt == Approx(r.dt_dn * along.x() + r.dt_dt * along.y()).margin(1e-6 * k));
    }
  });
  CHECK(met.size() == 8);
}

// Requires that reactions do not jump where pieces change: the change is bisected, along normal, tangential and oblique
// ways, down to neighbouring numbers (1e-3 Pa). Mutations that fail: contact wherever w_n < 0,
// a given bound left out on open faces, slip's sign; of the energy, where contact hands over to the spring, and slip
// without what it starts from.
TEST_CASE("laws are continuous where pieces change") {
  int changes = 0;
  at_all_jumps(1, [&](const Case& c, const Vec2& w) {
    for (const Vec2& along : {Vec2{1.0, 0.0}, Vec2{0.0, 1.0}, Vec2{1.0, -0.7}}) {
      Vec2 here = w, there = w + 5e-7 * along;
      if (c(here).piece == c(there).piece) continue;
      for (int halving = 0; halving < 60; ++halving) {
        const Vec2 middle = 0.5 * (here + there);
        (c(middle).piece == c(here).piece ? here : there) = middle;
      }
      const LawAnswer before = c(here), after = c(there);
      ++changes;
      CHECK(std::abs(after.n - before.n) < 1e-3);
      CHECK(std::abs(after.t - before.t) < 1e-3);
      if (c.has_energy()) CHECK(std::abs(after.energy - before.energy) < 1e-8);
    }
  });
  CHECK(changes > 1000);
}

// Requires that the energy is 0 at no jump (where friction starts) and elsewhere the integral of -r on the way from
// there, straight or first along the normal: 1e-4 of the 5 J/m^2 reached. Friction whose bound follows n has none;
// while closed it holds contact's and its spring's. Mutations that fail: contact's energy
// doubled, of the other sign, or not taken from rest; shear of a soft interface left out; slip as if it were stick;
// what friction remembers not taken off.
TEST_CASE("energy of a law is what its reaction takes up") {
  at_all_jumps(3, [&](const Case& c, const Vec2& w) {
    CHECK(std::abs(c(c.start()).energy) < 1e-12);
    const LawAnswer r = c(w);
    if (c.has_energy()) {
      const Vec2 corner{w.x(), c.at.w_t_start};
      CHECK(r.energy == Approx(work_taken(c, c.start(), w)).margin(5e-4));
      CHECK(r.energy == Approx(work_taken(c, c.start(), corner) + work_taken(c, corner, w)).margin(5e-4));
    } else if (r.n > 0.0) {
      const double contact = Case{"face", face_law(Scene{}), c.at}(w).energy;
      CHECK(r.energy == Approx(contact + (r.t * r.t - c.at.r_t_start * c.at.r_t_start) / (2.0 * k)));
    }
  });
}

// Requires, by hand, what laws allow whatever the jump: contact only pushes, friction holds 0.6 of that, springs
// anything but without normal stiffness. Mutations that fail: contact that pulls, friction's bound doubled or left out.
TEST_CASE("reactions that a law allows") {
  const auto allowed = [](const InterfaceLaw& law, double n, double t) {
    const Reaction r = lines_of(law, k, {}, 7e5).admissible({n, t});
    return Vec2{r.n, r.t};
  };
  CHECK(allowed(friction_law(0.6), -1e5, 2e5) == Vec2{0.0, 0.0});
  CHECK(allowed(friction_law(0.6), 1e5, -2e5).isApprox(Vec2{1e5, -6e4}));
  CHECK(allowed(friction_law(0.6), 1e5, 5e4) == Vec2{1e5, 5e4});
  CHECK(allowed(soft_law(1e9, 1e9), -1e5, 2e5) == Vec2{-1e5, 2e5});
  CHECK(allowed(soft_law(0.0, 1e9), -1e5, 2e5) == Vec2{0.0, 2e5});
}

// Requires the energy of springs by hand, A (D_n w_n^2 + D_t w_t^2)/2 with A = 0.5 m, D_n = 2e9, D_t = 1e9 Pa/m, w_t =
// 2 and w_n = 3 or -3 mm: 0.5 (9e3 + 2e3) J/m, without D_n where faces meet; none of friction, nor of what is whole.
// Mutations that fail: either half of it doubled or left out, springs in faces that meet, none where springs act.
TEST_CASE("energy that springs hold") {
  const auto energy = [](const InterfaceLaw& law, double w_n, bool split = true) {
    SurfacePoint s;
    s.n = {0.0, 1.0}, s.A = 0.5, s.w = {2e-3, w_n}, s.split = split;
    return spring_energy_at(law, s);
  };
  CHECK(energy(soft_law(2e9, 1e9), 3e-3) == Approx(5500.0));
  CHECK(energy(soft_law(2e9, 1e9), -3e-3) == Approx(1000.0));
  CHECK(energy(soft_law(2e9, 1e9, Compression::spring), -3e-3) == Approx(5500.0));
  CHECK(energy(soft_law(2e9, 1e9), 3e-3, false) == 0.0);
  CHECK(energy(friction_law(0.6), 3e-3) == 0.0);
}
