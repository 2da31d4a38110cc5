// Quantities of nodes, one array each: neighbours along a row are then neighbours in memory. A record (see copies.hpp)
// is read and written as a whole through operator[].
#pragma once

#include <cstddef>

#include "state/spread_array.hpp"

namespace strata {

// What a node has gathered from particles.
struct NodeSums {
  double m = 0.0;                   // mass (kg/m)
  double mom_x = 0.0, mom_y = 0.0;  // momentum (kg/s)
  double f_x = 0.0, f_y = 0.0;      // force (N/m)
};

// What a node gives back to particles.
struct NodeMotion {
  double v_x = 0.0, v_y = 0.0;    // velocity at the end of the step (m/s)
  double dv_x = 0.0, dv_y = 0.0;  // what forces added to it in the step (m/s)
};

struct NodalSums {
  SpreadArray m, mom_x, mom_y, f_x, f_y;

  struct Record {
    double &m, &mom_x, &mom_y, &f_x, &f_y;
    operator NodeSums() const { return {m, mom_x, mom_y, f_x, f_y}; }
    const Record& operator=(const NodeSums& s) const {
      m = s.m, mom_x = s.mom_x, mom_y = s.mom_y, f_x = s.f_x, f_y = s.f_y;
      return *this;
    }
  };

  explicit NodalSums(std::size_t n = 0) : m(n), mom_x(n), mom_y(n), f_x(n), f_y(n) {}
  std::size_t size() const { return m.size(); }
  Record operator[](std::size_t r) { return {m[r], mom_x[r], mom_y[r], f_x[r], f_y[r]}; }
  NodeSums operator[](std::size_t r) const { return {m[r], mom_x[r], mom_y[r], f_x[r], f_y[r]}; }

  // n records of 0.
  void clear(std::size_t n) {
    for (auto* array : {&m, &mom_x, &mom_y, &f_x, &f_y}) array->assign(n, 0.0);
  }
};

struct NodalMotion {
  SpreadArray v_x, v_y, dv_x, dv_y;

  struct Record {
    double &v_x, &v_y, &dv_x, &dv_y;
    operator NodeMotion() const { return {v_x, v_y, dv_x, dv_y}; }
    const Record& operator=(const NodeMotion& s) const {
      v_x = s.v_x, v_y = s.v_y, dv_x = s.dv_x, dv_y = s.dv_y;
      return *this;
    }
  };

  explicit NodalMotion(std::size_t n = 0) : v_x(n), v_y(n), dv_x(n), dv_y(n) {}
  std::size_t size() const { return v_x.size(); }
  Record operator[](std::size_t r) { return {v_x[r], v_y[r], dv_x[r], dv_y[r]}; }
  NodeMotion operator[](std::size_t r) const { return {v_x[r], v_y[r], dv_x[r], dv_y[r]}; }

  void clear(std::size_t n) {
    for (auto* array : {&v_x, &v_y, &dv_x, &dv_y}) array->assign(n, 0.0);
  }
};

}  // namespace strata
