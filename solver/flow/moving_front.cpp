#include "flow/moving_front.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace strata {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// The cells that a tip's last growth has added, counted from the tip on; none where it has not grown.
struct AddedCells {
  const ReynoldsLine& line;
  bool at_back;
  std::size_t count = 0;
  double length = 0.0;  // m

  AddedCells(const ReynoldsLine& of, bool back) : line(of), at_back(back) {
    const double wet = line.wet_s[cell(0)];
    for (; wet > 0.0 && line.wet_s[cell(count)] == wet; ++count) length += length_of(count);
  }
  std::size_t cell(std::size_t j) const { return at_back ? line.size() - 1 - j : j; }
  double length_of(std::size_t j) const { return line.length[cell(j)]; }
  Index face(std::size_t j) const { return static_cast<Index>(std::min(cell(j), cell(j + 1))); }  // behind a cell
};

// What the rock behind a front is like that is at the tip at a time (s).
struct MovingFront {
  double c = 0.0;  // 8 K_Ic/(E' sqrt(2 pi)) (m^(1/2))
  double d = 0.0;  // 2 3^(5/2) 12 mu V/E' (m)

  MovingFront(const Fluid& fluid, const AddedCells& added, double E_prime, double K_Ic, double time) {
    const double V = added.length / (time - added.line.wet_s[added.cell(0)]);
    c = 8.0 * K_Ic / (E_prime * std::sqrt(2.0 * std::numbers::pi));
    d = 18.0 * std::numbers::sqrt3 * 12.0 * fluid.viscosity_Pa_s * V / E_prime;
  }
  double opening(double u) const { return u * std::cbrt(c * c * c + d * u); }  // m, at u = sqrt(x)
};

// Of f(sqrt(x)) dx, dx = 2 u du, by three points of Gauss.
template <class Of>
double integral(double from, double to, const Of& f) {
  const double middle = 0.5 * (std::sqrt(from) + std::sqrt(to)), half = std::sqrt(to) - middle;
  const auto at = [&](double off) { return 2.0 * (middle + off * half) * f(middle + off * half); };
  return half / 9.0 * (5.0 * at(-std::sqrt(0.6)) + 8.0 * at(0.0) + 5.0 * at(std::sqrt(0.6)));
}

}  // namespace

void guess_new_cells(ReynoldsLine& line) {
  for (const bool at_back : {false, true}) {
    const AddedCells added(line, at_back);
    for (std::size_t j = 0; j < added.count; ++j) {
      line.P[added.cell(j)] = line.P[added.cell(added.count)];
      line.phi[added.cell(j)] = line.phi[added.cell(added.count)];
    }
  }
}

std::vector<double> wet_times(const ReynoldsLine& line, double time, bool at_front, bool at_back) {
  std::vector<double> wet = line.wet_s;
  for (const bool back : {false, true}) {
    if (!(back ? at_back : at_front)) continue;
    const AddedCells added(line, back);
    double x = 0.0;
    for (std::size_t j = 0; j < added.count; ++j) {
      double& t = wet[added.cell(j)];
      t = time - (time - t) * (x + 0.5 * added.length_of(j)) / added.length;
      x += added.length_of(j);
    }
  }
  return wet;
}

VectorXd front_conductances(const Fluid& fluid, const ReynoldsLine& line, bool at_back, double E_prime, double K_Ic,
                            double time) {
  const AddedCells added(line, at_back);
  VectorXd conductance = VectorXd::Zero(static_cast<Index>(line.size()) - 1);
  if (added.count == 0) return conductance;
  const MovingFront front(fluid, added, E_prime, K_Ic, time);
  const double mu = 12.0 * fluid.viscosity_Pa_s;
  double x = 0.0, behind = 0.0;
  for (std::size_t j = 0; j < added.count; ++j) {
    const double A = added.length_of(j), middle = x + 0.5 * A;
    const double own = integral(x, x + A, [&](double u) { return front.opening(u); });
    x += A;
    behind += own;
    double fall = integral(j == 0 ? x : middle, x + 0.5 * added.length_of(j + 1),
                           [&](double u) { return std::pow(front.opening(u), -2); });
    // P(x) - int P ds/(2 sqrt(x s)), s = 0 to x, over 12 mu V: int sqrt(s/x)/w^2 ds, in closed form.
    const double a = front.opening(std::sqrt(x)) / std::sqrt(x), c = front.c;
    if (j == 0) fall += 6.0 / (a * a + a * c + c * c);
    conductance(added.face(j)) = (at_back ? 1.0 : -1.0) * behind * A / (own * mu * added.length * fall);
  }
  return conductance;
}

void limit_to_front(const Fluid& fluid, const ReynoldsLine& line, bool at_back, double E_prime, double K_Ic,
                    double time, double there, const VectorXd& lost, VectorXd& most) {
  const AddedCells added(line, at_back);
  if (added.count == 0) return;
  const MovingFront front(fluid, added, E_prime, K_Ic, there);
  const double since = time - line.wet_s[added.cell(0)], way = since / (there - line.wet_s[added.cell(0)]);
  double room =
      std::max(0.0, (9.0 * way - 1.0) / 8.0) * integral(0.0, added.length, [&](double u) { return front.opening(u); });
  for (std::size_t j = 0; j < added.count && lost.size() > 0; ++j) room += lost(static_cast<Index>(added.cell(j)));
  most(added.face(added.count - 1)) = (at_back ? 1.0 : -1.0) * room / since;
}

}  // namespace strata
