#include "crack_path.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <stdexcept>

namespace strata::reference {
namespace {

constexpr double kNoShear = 1e-5;  // |K_II/K_I| taken for zero
constexpr int kMostTurns = 12;

// K at the tip as an affine function of the pressure.
struct AffineK {
  CrackLine::Intensities still;     // in-situ stress alone
  CrackLine::Intensities per_unit;  // of pressure

  CrackLine::Intensities at(double P) const { return {still.K_I + P * per_unit.K_I, still.K_II + P * per_unit.K_II}; }
  // The larger root P of K_I^2 + K_II^2 = K_Ic^2.
  double critical_pressure(double K_Ic) const {
    const double a = per_unit.K_I * per_unit.K_I + per_unit.K_II * per_unit.K_II;
    const double b = still.K_I * per_unit.K_I + still.K_II * per_unit.K_II;
    const double c = still.K_I * still.K_I + still.K_II * still.K_II - K_Ic * K_Ic;
    if (!(a > 0 && b * b - a * c >= 0)) throw std::runtime_error("no pressure gives the tip its toughness");
    const double P = (-b + std::sqrt(b * b - a * c)) / a;
    if (!(at(P).K_I > 0)) throw std::runtime_error("no pressure opens the tip");
    return P;
  }
};

AffineK tip_of(const std::vector<Point>& path, const CrackPlane& plane, const InSituStress& stress, bool linear) {
  const CurvedCrack crack(path, plane);
  const double length = crack.length();
  const auto profile = [=](double s) { return linear ? 1 - s / length : 1.0; };
  return {crack.solve(in_situ_load([](double) { return 0.0; }, stress.xx, stress.yy)).last,
          crack.solve(in_situ_load(profile, 0, 0)).last};
}

class Grower {
 public:
  Grower(const std::vector<Point>& start, const CrackPlane& plane, const InSituStress& stress, const GrowthRule& rule)
      : path_(start), start_(start.size()), plane_(plane), stress_(stress), rule_(rule), tip_(measure()) {
    held_ = tip_.critical_pressure(rule.toughness);
  }

  GrownPath grow() {
    GrownPath grown;
    for (;;) {
      const double P = rule_.hold_pressure ? held_ : tip_.critical_pressure(rule_.toughness);
      const auto K = tip_.at(P);
      grown.steps.push_back({path_.back(), direction(), K, P, max_hoop_angle(K.K_I, K.K_II)});
      grown.stopped = reason(K);
      if (!grown.stopped.empty()) return grown;
      extend(grown.steps.back().turn);
    }
  }

 private:
  AffineK measure() const { return tip_of(path_, plane_, stress_, rule_.linear_profile); }
  double direction() const { return std::arg(path_.back() - path_[path_.size() - 2]); }

  std::string reason(const CrackLine::Intensities& K) const {
    const double J = K.K_I * K.K_I + K.K_II * K.K_II;
    if (!(K.K_I > 0) || J < rule_.toughness * rule_.toughness * (1 - 1e-9)) return "arrest";
    // Rounding may leave the last increment short of the wanted height by an ulp.
    const double slack = 1e-9 * rule_.increment;
    if (path_.back().imag() >= rule_.stop_height - slack) return "height";
    if (static_cast<double>(path_.size() - start_) * rule_.increment >= rule_.stop_growth - slack) return "growth";
    if (plane_.beyond && std::abs(path_.back().real() - plane_.interface_x) < rule_.stop_distance + rule_.increment)
      return "interface";
    return "";
  }

  // K_II/K_I of the crack whose new last piece runs in `direction`.
  double shear_at(double direction) {
    path_.back() = path_[path_.size() - 2] + std::polar(rule_.increment, direction);
    tip_ = measure();
    const auto K = tip_.at(rule_.hold_pressure ? held_ : tip_.critical_pressure(rule_.toughness));
    return K.K_II / K.K_I;
  }

  void extend(double turn) {
    double direction = this->direction() + turn;
    path_.push_back(path_.back());
    double shear = shear_at(direction);
    if (!rule_.corrected) return;
    double slope = 0.5;  // of K_II/K_I by the direction of a short last piece (Cotterell & Rice 1980)
    for (int i = 0; i < kMostTurns; ++i) {
      if (std::abs(shear) < kNoShear) return;
      const double step = -shear / slope;
      const double next = shear_at(direction + step);
      if (next != shear) slope = (next - shear) / step;
      direction += step;
      shear = next;
    }
    if (!(std::abs(shear) < 10 * kNoShear)) throw std::runtime_error("no direction of growth without K_II was found");
  }

  std::vector<Point> path_;
  std::size_t start_;  // its points before growth
  CrackPlane plane_;
  InSituStress stress_;
  GrowthRule rule_;
  AffineK tip_;
  double held_ = 0.0;
};

}  // namespace

GrownPath grow_path(const std::vector<Point>& start, const CrackPlane& plane, const InSituStress& stress,
                    const GrowthRule& rule) {
  if (!(rule.toughness > 0 && rule.increment > 0))
    throw std::invalid_argument("toughness and increment must be positive");
  return Grower(start, plane, stress, rule).grow();
}

double path_distance(const std::vector<Point>& path, const std::vector<Point>& other) {
  if (path.empty() || other.size() < 2) throw std::invalid_argument("a path needs points, the other one two");
  double largest = 0;
  for (const Point& z : path) {
    double nearest = std::numeric_limits<double>::infinity();
    bool past = false;
    for (std::size_t i = 1; i < other.size(); ++i) {
      const Point along = other[i] - other[i - 1];
      const double t = ((z - other[i - 1]) * std::conj(along)).real() / std::norm(along);
      const double distance = std::abs(z - other[i - 1] - std::clamp(t, 0.0, 1.0) * along);
      if (distance < nearest) {
        nearest = distance;
        past = i + 1 == other.size() && t > 1;
      }
    }
    if (!past) largest = std::max(largest, nearest);
  }
  return largest;
}

}  // namespace strata::reference
