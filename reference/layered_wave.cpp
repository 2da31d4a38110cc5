#include "layered_wave.hpp"

#include <gsl/gsl_integration.h>
#include <gsl/gsl_sf_trig.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

// Highest frequency of the sum in units of c/half_width: a gaussian's share of modes is exp(-(w b/(2c))^2), so all but
// round-off lies below 13; what is above serves pulses that touch a border. The cosine's falls as the third power only.
constexpr double kHighestGaussian = 60, kHighestCosine = 1200;

// Gauss points in a panel, and its length in radians of the highest mode.
constexpr std::size_t kPanelPoints = 16;
constexpr double kPanelRadians = 6;

// Five times what springs of 1 and 10 Pa/m show.
constexpr double kRoundOff = 5e-15;

constexpr double kBonded = 1e30;  // Pa/m

// int_{from}^{to} sin(a + q y) dy, for q = 0 too.
double sine_integral(double a, double q, double from, double to) {
  const double length = to - from;
  return length * std::sin(a + 0.5 * q * (from + to)) * gsl_sf_sinc(0.5 * q * length / pi);
}

// Moves an angle by `change(tan)` within its branch (n - 1/2) pi .. (n + 1/2) pi.
template <class Change>
double within_branch(double angle, Change change) {
  const double branch = std::round(angle / pi);
  return branch * pi + change(angle - branch * pi);
}

void require_layers(const std::vector<WaveLayer>& layers, const std::vector<double>& springs) {
  if (layers.empty() || springs.size() + 1 != layers.size())
    throw std::invalid_argument("one layer or more and one spring a border are needed");
  for (const WaveLayer& layer : layers) {
    if (!(layer.thickness > 0 && layer.modulus > 0 && layer.density > 0))
      throw std::invalid_argument("thickness, modulus and density must be positive");
    if (!(layer.lateral_radius >= 0) || (layer.lateral_radius > 0 && layers.size() > 1))
      throw std::invalid_argument("lateral inertia is for one layer, and not negative");
  }
  for (const double spring : springs)
    if (!(spring >= 0)) throw std::invalid_argument("springs must not be negative");
}

}  // namespace

double WaveLayer::speed() const {
  return std::sqrt(modulus / density);
}

double WaveLayer::impedance() const {
  return std::sqrt(modulus * density);
}

double VelocityPulse::operator()(double y) const {
  const double q = (y - middle) / half_width;
  if (form == Form::gaussian) return velocity * std::exp(-q * q);
  return std::abs(q) < 1 ? velocity * std::pow(std::cos(0.5 * pi * q), 2) : 0.0;
}

double VelocityPulse::reach() const {
  return form == Form::gaussian ? 6.3 * half_width : half_width;  // exp(-6.3^2) = 6e-18
}

LayeredWave::LayeredWave(std::vector<WaveLayer> layers, std::vector<double> springs, WaveEnd bottom, WaveEnd top,
                         const VelocityPulse& pulse)
    : layers_(std::move(layers)), springs_(std::move(springs)), pulse_(pulse) {
  require_layers(layers_, springs_);
  if (!(pulse.half_width > 0)) throw std::invalid_argument("the pulse's half_width must be positive");
  double y = 0, fastest = 0;
  for (const WaveLayer& layer : layers_) {
    bottoms_.push_back(y);
    tops_.push_back(y += layer.thickness);
    fastest = std::max(fastest, layer.speed());
  }
  const bool gaussian = pulse.form == VelocityPulse::Form::gaussian;
  const double highest = (gaussian ? kHighestGaussian : kHighestCosine) * fastest / pulse.half_width;
  place_knots(highest);
  for (std::size_t j = 0; j < layers_.size(); ++j)
    for (const Knot& knot : knots_[j]) energy_ += 0.5 * layers_[j].density * knot.weighted * pulse_(knot.y);
  Part part{0, 0, bottom, top};
  for (std::size_t j = 0; j < layers_.size(); ++j) {
    part.last = j;
    const bool end = j + 1 == layers_.size();
    if (!end && springs_[j] > 0) continue;
    part.top = end ? top : WaveEnd::free;
    add_modes(part, highest);
    part = {j + 1, j + 1, WaveEnd::free, top};
  }
  for (const Mode& mode : modes_) {
    frequencies_.push_back(mode.w);
    double largest = 0;
    for (std::size_t k = 0; k < mode.phi.size(); ++k) largest = std::max(largest, amplitude(mode, mode.first + k));
    if (mode.w > 0.5 * highest && pulse.velocity != 0) error_ += std::abs(mode.coefficient / pulse.velocity) * largest;
  }
  // A weak spring's stress is the small rest of large ones: round-off of s is divided by D.
  for (std::size_t j = 0; j + 1 < layers_.size(); ++j)
    if (springs_[j] > 0) error_ += kRoundOff * layers_[j].modulus / (pulse.half_width * springs_[j]);
  std::sort(frequencies_.begin(), frequencies_.end());
  error_ = std::max(error_, 1e-12);
}

double LayeredWave::travel_time() const {
  double time = 0;
  for (const WaveLayer& layer : layers_) time += layer.thickness / layer.speed();
  return time;
}

// Where a pulse meets the layers, with Gauss's weights: panels short against the highest mode and the pulse itself.
void LayeredWave::place_knots(double highest) {
  const std::unique_ptr<gsl_integration_glfixed_table, void (*)(gsl_integration_glfixed_table*)> rule(
      gsl_integration_glfixed_table_alloc(kPanelPoints), gsl_integration_glfixed_table_free);
  knots_.assign(layers_.size(), {});
  for (std::size_t j = 0; j < layers_.size(); ++j) {
    const double from = std::max(bottoms_[j], pulse_.middle - pulse_.reach());
    const double to = std::min(tops_[j], pulse_.middle + pulse_.reach());
    if (!(to > from)) continue;
    const double panel = std::min(kPanelRadians * layers_[j].speed() / highest, 0.5 * pulse_.half_width);
    const auto panels = static_cast<int>(std::ceil((to - from) / panel));
    for (int k = 0; k < panels; ++k) {
      const double a = from + (to - from) * k / panels, b = from + (to - from) * (k + 1) / panels;
      for (std::size_t i = 0; i < kPanelPoints; ++i) {
        double y = 0, weight = 0;
        gsl_integration_glfixed_point(a, b, i, &y, &weight, rule.get());
        knots_[j].push_back({y, weight * pulse_(y)});
      }
    }
  }
}

// Angle of (Z w phi, s) at the part's top, that at its bottom being 0 (held) or pi/2 (free).
double LayeredWave::angle(const Part& part, double w) const {
  double psi = part.bottom == WaveEnd::held ? 0 : 0.5 * pi;
  for (std::size_t j = part.first; j <= part.last; ++j) {
    if (j > part.first) {
      const double Z = layers_[j].impedance(), ratio = Z / layers_[j - 1].impedance();
      const double yields = springs_[j - 1] >= kBonded ? 0 : Z * w / springs_[j - 1];
      // tan psi -> ratio tan psi + Z w/D, by atan2 since tan is infinite where s = 0
      psi = within_branch(
          psi, [&](double p) { return std::atan2(ratio * std::sin(p) + yields * std::cos(p), std::cos(p)); });
    }
    psi += w * layers_[j].thickness / layers_[j].speed();
  }
  return psi;
}

// The w > above at which the angle at the top is `target`.
double LayeredWave::frequency(const Part& part, double target, double above) const {
  const auto off = [&](double w) { return angle(part, w) - target; };
  double time = 0;
  for (std::size_t j = part.first; j <= part.last; ++j) time += layers_[j].thickness / layers_[j].speed();
  double below = above, beyond = above + pi / time;
  while (off(beyond) < 0) below = beyond, beyond += pi / time;
  for (int i = 0; i < 200 && beyond - below > 4e-16 * beyond; ++i) {
    const double mid = 0.5 * (below + beyond);
    (off(mid) < 0 ? below : beyond) = mid;
  }
  return 0.5 * (below + beyond);
}

LayeredWave::Mode LayeredWave::mode(const Part& part, double w) const {
  Mode mode;
  mode.w = w;
  mode.first = part.first;
  double phi = part.bottom == WaveEnd::held ? 0 : 1;
  double s = part.bottom == WaveEnd::held ? w * layers_[part.first].impedance() : 0;
  for (std::size_t j = part.first; j <= part.last; ++j) {
    if (j > part.first && springs_[j - 1] < kBonded) phi += s / springs_[j - 1];
    mode.phi.push_back(phi);
    mode.stress.push_back(s);
    const double turn = w * layers_[j].thickness / layers_[j].speed(), Zw = layers_[j].impedance() * w;
    const double next = std::cos(turn) * phi + std::sin(turn) / Zw * s;
    s = std::cos(turn) * s - std::sin(turn) * Zw * phi;
    phi = next;
  }
  mode.coefficient = coefficient(mode);
  return mode;
}

// A part that nothing holds moves as a whole, at its mean momentum.
LayeredWave::Mode LayeredWave::rigid(const Part& part) const {
  Mode mode;
  mode.first = part.first;
  double mass = 0, momentum = 0;
  for (std::size_t j = part.first; j <= part.last; ++j) {
    mode.phi.push_back(1);
    mode.stress.push_back(0);
    mass += layers_[j].density * layers_[j].thickness;
    for (const Knot& knot : knots_[j]) momentum += layers_[j].density * knot.weighted;
  }
  mode.coefficient = momentum / mass;
  return mode;
}

double LayeredWave::amplitude(const Mode& mode, std::size_t layer) const {
  const std::size_t k = layer - mode.first;
  return mode.w > 0 ? std::hypot(mode.phi[k], mode.stress[k] / (layers_[layer].impedance() * mode.w)) : 1.0;
}

// int v_0 phi dy over a layer.
double LayeredWave::momentum(const Mode& mode, std::size_t layer) const {
  const std::size_t k = layer - mode.first;
  const double kappa = mode.w / layers_[layer].speed(), size = amplitude(mode, layer);
  const double angle = std::atan2(mode.phi[k], mode.stress[k] / (layers_[layer].impedance() * mode.w));
  const double start = angle - kappa * bottoms_[layer];  // phi = size sin(start + kappa y)
  if (pulse_.form == VelocityPulse::Form::gaussian) {
    double sum = 0;
    for (const Knot& knot : knots_[layer]) sum += knot.weighted * std::sin(start + kappa * knot.y);
    return size * sum;
  }
  const double from = std::max(bottoms_[layer], pulse_.middle - pulse_.half_width);
  const double to = std::min(tops_[layer], pulse_.middle + pulse_.half_width);
  if (!(to > from)) return 0;
  // cos^2 = (1 + cos)/2, and the product of sine and cosine is the sum of two sines
  const double beta = pi / pulse_.half_width, shift = beta * pulse_.middle;
  return size * pulse_.velocity *
         (0.5 * sine_integral(start, kappa, from, to) + 0.25 * sine_integral(start - shift, kappa + beta, from, to) +
          0.25 * sine_integral(start + shift, kappa - beta, from, to));
}

double LayeredWave::coefficient(const Mode& mode) const {
  double along = 0, norm = 0;
  for (std::size_t k = 0; k < mode.phi.size(); ++k) {
    const std::size_t j = mode.first + k;
    const WaveLayer& layer = layers_[j];
    const double turn = mode.w * layer.thickness / layer.speed(), size = amplitude(mode, j);
    const double angle = std::atan2(mode.phi[k], mode.stress[k] / (layer.impedance() * mode.w));
    // int sin^2 = h/2 - [sin 2 psi]/(4 kappa)
    const double squared =
        0.5 * layer.thickness * (1 - (std::sin(2 * (angle + turn)) - std::sin(2 * angle)) / (2 * turn));
    norm += layer.density * size * size * squared;
    along += layer.density * momentum(mode, j);
  }
  return along / norm;
}

void LayeredWave::add_modes(const Part& part, double highest) {
  const bool free_bottom = part.bottom == WaveEnd::free, free_top = part.top == WaveEnd::free;
  if (free_bottom && free_top) modes_.push_back(rigid(part));
  // held top: multiples of pi; free top: odd multiples of pi/2; the angle at w = 0 itself is not a mode
  double target = free_top ? (free_bottom ? 1.5 * pi : 0.5 * pi) : pi;
  for (double w = 0;; target += pi) {
    w = frequency(part, target, w);
    if (w > highest) break;
    modes_.push_back(mode(part, w));
  }
}

WaveAt LayeredWave::at(double y, double time) const {
  if (!(y >= 0 && y <= height())) throw std::invalid_argument("y is outside the column");
  if (!(time >= 0)) throw std::invalid_argument("t must not be negative");
  const auto above = std::upper_bound(tops_.begin(), std::prev(tops_.end()), y);
  const auto layer = static_cast<std::size_t>(above - tops_.begin());
  WaveAt sum;
  for (const Mode& mode : modes_) {
    if (layer < mode.first || layer >= mode.first + mode.phi.size()) continue;
    if (mode.w == 0) {
      sum.u += mode.coefficient * time;
      sum.v += mode.coefficient;
      continue;
    }
    const std::size_t k = layer - mode.first;
    const double turn = mode.w * (y - bottoms_[layer]) / layers_[layer].speed();
    const double Zw = layers_[layer].impedance() * mode.w, c = std::cos(turn), s = std::sin(turn);
    const double across = mode.w * layers_[layer].lateral_radius / layers_[layer].speed();
    const double slower = 1 + across * across, w = mode.w / std::sqrt(slower);
    const double swing = mode.coefficient * std::sin(w * time) / w;
    const double phi = c * mode.phi[k] + s / Zw * mode.stress[k];
    sum.u += swing * phi;
    sum.v += mode.coefficient * std::cos(w * time) * phi;
    sum.stress += swing * (c * mode.stress[k] - s * Zw * mode.phi[k]) / slower;
  }
  return sum;
}

}  // namespace strata::reference
