#include "flow/moving_front.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace strata {

using Eigen::Index;
using Eigen::VectorXd;

namespace {

// The cells that a tip's last growth has added, or those that the front came to last on its way through the initial
// fracture, counted from the front on; none before either.
struct AddedCells {
  const ReynoldsLine& line;
  bool at_back;
  std::size_t dry, count = 0;
  double length = 0.0;  // m

  AddedCells(const ReynoldsLine& of, bool back) : line(of), at_back(back), dry(of.dry_cells(back)) {
    const double wet = line.wet_s[cell(0)];
    for (; wet > 0.0 && line.wet_s[cell(count)] == wet; ++count) length += length_of(count);
  }
  // The cells that an initial fracture which is dry beyond starts with.
  void take_first() {
    const std::size_t side = (at_back ? line.size() - line.inlet : line.inlet) - dry;
    for (; count < side; ++count) length += length_of(count);
  }
  std::size_t cell(std::size_t j) const { return at_back ? line.size() - 1 - dry - j : dry + j; }
  double length_of(std::size_t j) const { return line.length[cell(j)]; }
  Index face(std::size_t j) const { return static_cast<Index>(std::min(cell(j), cell(j + 1))); }  // behind a cell
};

// Integral of f from a to b by three points of Gauss,
template <class Of>
double integral(double a, double b, const Of& f) {
  const double middle = 0.5 * (a + b), off = std::sqrt(0.6) * 0.5 * (b - a);
  return (b - a) / 18.0 * (5.0 * f(middle - off) + 8.0 * f(middle) + 5.0 * f(middle + off));
}

// and of f(sqrt(x)) dx, dx = 2 u du.
template <class Of>
double integral_over_x(double from, double to, const Of& f) {
  return integral(std::sqrt(from), std::sqrt(to), [&](double u) { return 2.0 * u * f(u); });
}

// What the rock behind a front is like that is at the tip at a time (s): W (m^(1/2)) at u = sqrt(x) (m^(1/2)).
struct MovingFront {
  double c = 0.0, e = 0.0;  // m^(1/2)
  double d = 0.0;           // m

  MovingFront(const Fluid& fluid, const AddedCells& added, const TipRock& rock, double time) {
    const double V = added.length / (time - added.line.wet_s[added.cell(0)]);
    c = 8.0 * rock.K_Ic / (rock.E_prime * std::sqrt(2.0 * std::numbers::pi));
    d = 18.0 * std::numbers::sqrt3 * 12.0 * fluid.viscosity_Pa_s * V / rock.E_prime;
    e = 4.0 * rock.C_L / std::sqrt(V);
  }
  double slope(double W) const { return 3.0 * W * W * W / (W + e); }  // d du/dW,
  double mean_slope(double W) const {                                 // and its mean from c to W
    return integral(0.0, 1.0, [&](double t) { return slope(c + t * (W - c)); });
  }
  double shape(double u) const {
    double W = std::cbrt(c * c * c + d * u);  // without leak-off; Newton's method passes the root once from below
    for (int k = 0; k < 50 && e > 0.0; ++k) {
      const double change = (d * u - (W - c) * mean_slope(W)) / slope(W);
      W += change;
      if (std::abs(change) <= 1e-12 * W) break;
    }
    return W;
  }
  double opening(double u) const { return u * shape(u); }  // m
  double content(double from, double to) const {           // int w dx (m^2)
    return integral_over_x(from, to, [this](double u) { return opening(u); });
  }
};

}  // namespace

TipRock tip_rock(const Scene& scene, const Rocks& rocks, const State& state, bool at_back) {
  const auto& points = state.fracture().points;
  const std::size_t r = rock_at(scene, (at_back ? points.back() : points.front()).x);
  return {rocks[r].E_prime, std::sqrt(rocks[r].J_c * rocks[r].E_prime), scene.rocks[r].leakoff_m_sqrt_s};
}

double front_filling(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time) {
  AddedCells added(line, at_back);
  if (added.count == 0) added.take_first();
  if (time <= line.wet_s[added.cell(0)]) return 0.0;
  double held = 0.0;
  for (std::size_t j = 0; j < added.count; ++j) held += line.w[added.cell(j)] * added.length_of(j);
  return held / MovingFront(fluid, added, rock, time).content(0.0, added.length);
}

double opening_behind(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time,
                      double from, double to) {
  const AddedCells added(line, at_back);
  if (added.count == 0) return 1.0;
  if (time <= line.wet_s[added.cell(0)]) return 0.0;
  const MovingFront front(fluid, added, rock, time);
  const std::size_t side = at_back ? line.size() - line.inlet : line.inlet;
  double way = 0.0;
  for (std::size_t j = 0; j < side; ++j) way += added.length_of(j);
  const double whole = side == line.size() ? 2.0 * way : std::accumulate(line.length.begin(), line.length.end(), 0.0);
  double x = 0.0, held = 0.0, content = 0.0;
  for (std::size_t j = 0; j < side && x < 0.999 * to; ++j) {
    const double A = added.length_of(j), near = x;
    x += A;
    if (near < 0.999 * std::min(from, 0.5 * way)) continue;
    held += line.w[added.cell(j)] * A;
    content += integral_over_x(near, x, [&](double u) { return front.opening(u) * std::sqrt(1.0 - u * u / whole); });
  }
  return held / content;
}

double toughness_from(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time,
                      double x) {
  const AddedCells added(line, at_back);
  if (added.count == 0 || time <= line.wet_s[added.cell(0)]) return rock.K_Ic;
  return MovingFront(fluid, added, rock, time).shape(std::sqrt(x)) * rock.E_prime / 8.0 *
         std::sqrt(2.0 * std::numbers::pi);
}

double last_wet(const ReynoldsLine& line, bool at_back) {
  const AddedCells added(line, at_back);
  return line.wet_s[added.cell(0)];
}

bool is_new(const ReynoldsLine& line, bool at_back, std::size_t cell) {
  const AddedCells added(line, at_back);
  const std::size_t j = at_back ? line.size() - 1 - cell : cell;
  return j >= added.dry && j < added.dry + added.count;
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

VectorXd front_conductances(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock,
                            double time) {
  const AddedCells added(line, at_back);
  VectorXd conductance = VectorXd::Zero(static_cast<Index>(line.size()) - 1);
  if (added.count == 0) return conductance;
  const MovingFront front(fluid, added, rock, time);
  const double mu = 12.0 * fluid.viscosity_Pa_s;
  double x = 0.0, behind = 0.0;
  for (std::size_t j = 0; j < added.count; ++j) {
    const double A = added.length_of(j), middle = x + 0.5 * A;
    const double own = front.content(x, x + A);
    x += A;
    behind += own;
    double fall = integral_over_x(j == 0 ? x : middle, x + 0.5 * added.length_of(j + 1), [&](double u) {
      const double W = front.shape(u);
      return (1.0 + front.e / W) / (u * u * W * W);
    });
    // P(x) - int P ds/(2 sqrt(x s)), s = 0 to x, over 12 mu V: int sqrt(s/x) (w + e sqrt(s))/w^3 ds, in closed form.
    if (j == 0) fall += 6.0 / front.mean_slope(front.shape(std::sqrt(x)));
    const double passed = behind + 2.0 / 3.0 * front.e * std::pow(x, 1.5);
    conductance(added.face(j)) = (at_back ? 1.0 : -1.0) * passed * A / (own * mu * added.length * fall);
  }
  return conductance;
}

void limit_to_front(const Fluid& fluid, const ReynoldsLine& line, bool at_back, const TipRock& rock, double time,
                    double there, const VectorXd& lost, VectorXd& most) {
  const AddedCells added(line, at_back);
  if (added.count == 0) return;
  const MovingFront front(fluid, added, rock, there);
  const double since = time - line.wet_s[added.cell(0)], way = since / (there - line.wet_s[added.cell(0)]);
  double room = std::max(0.0, (9.0 * way - 1.0) / 8.0) * front.content(0.0, added.length);
  for (std::size_t j = 0; j < added.count && lost.size() > 0; ++j) room += lost(static_cast<Index>(added.cell(j)));
  most(added.face(added.count - 1)) = (at_back ? 1.0 : -1.0) * room / since;
}

}  // namespace strata
