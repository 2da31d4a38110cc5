// Material points as a structure of arrays. Strain is small and the rock linear elastic, so stress is a function of the
// displacement gradient that a particle carries; the in-situ stress comes on top of it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "state/spread_array.hpp"
#include "state/types.hpp"

namespace strata {

struct Particles {
  SpreadArray x, y;                // position (m)
  SpreadArray u_x, u_y;            // displacement since the in-situ state (m)
  SpreadArray v_x, v_y;            // velocity (m/s)
  SpreadArray g_xx, g_xy;          // displacement gradient: g_xy = du_x/dy
  SpreadArray g_yx, g_yy;          //
  SpreadArray m;                   // mass per metre of thickness (kg/m)
  SpreadArray V;                   // area (m^2)
  SpreadArray half_x, half_y;      // half of the sides of a particle's rectangle (m), for uGIMP
  std::vector<std::uint8_t> rock;  // index into Scene::rocks
  std::vector<SideWord> sides;     // side of each surface
  std::vector<Stress> in_situ;     // in-situ stress (Pa), tension positive
  std::vector<std::int32_t> id;    // fixed for life; the arrays are reordered as particles change bins
  std::int32_t next_id = 0;

  std::size_t size() const { return x.size(); }
  Vec2 half(std::size_t q) const { return {half_x[q], half_y[q]}; }
};

// What particles say of a step: their kinetic energy (J/m) before and after they took up the grid's motion, the energy
// of the step's own strain, sum V dsigma : de/2 (J/m), the square of their largest speed (m^2/s^2), and how far any is
// from the middle node of its bin (spans, along x or y). Real: a number, or lanes of them, with twice the energies.
template <class Real>
struct MotionReport {
  Real before{}, after{}, step_strain{}, largest_speed2{}, farthest_cells{};

  MotionReport& operator+=(const MotionReport& more) {
    before += more.before, after += more.after, step_strain += more.step_strain;
    largest_speed2 = std::max(largest_speed2, more.largest_speed2);
    farthest_cells = std::max(farthest_cells, more.farthest_cells);
    return *this;
  }
};
using ParticleReport = MotionReport<double>;

// Calls visit(array) for each array of some particles, so that reordering and saving are written once.
template <class AnyParticles, class Visit>
void for_each_array(AnyParticles& p, Visit visit) {
  visit(p.x), visit(p.y), visit(p.u_x), visit(p.u_y), visit(p.v_x), visit(p.v_y);
  visit(p.g_xx), visit(p.g_xy), visit(p.g_yx), visit(p.g_yy);
  visit(p.m), visit(p.V), visit(p.half_x), visit(p.half_y);
  visit(p.rock), visit(p.sides), visit(p.in_situ), visit(p.id);
}

}  // namespace strata
