#include "curved_crack.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace strata::reference {
namespace {

using std::numbers::pi;

constexpr int kUnknowns = 2 * kElementModes;
// Gauss points of an element and, for the volume, their weights.
const std::array<double, 3> kGauss{0.5 - std::sqrt(0.15), 0.5, 0.5 + std::sqrt(0.15)};

// Elements grow with the distance from where the jump is not smooth.
constexpr double kGrowth = 0.4;       // of an element's length per distance
constexpr double kTip = 0.15;         // length of a tip element over that of the path's last piece
constexpr double kNearTip = 0.3;      // length of another element over its distance from the tip
constexpr double kPlainKink = 0.04;   // rad, kinks below need no finer elements
constexpr double kToInterface = 0.7;  // length of an element over its distance from the interface

double turn_between(Point before, Point after) {
  return std::arg(after / before);
}

// Length of an element at a kink over that of the shorter piece.
double at_kink(double turn) {
  return turn > kPlainKink ? kPlainKink / turn : 1.0;
}

void check_path(const std::vector<Point>& path, const CrackPlane& plane) {
  if (path.size() < 2) throw std::invalid_argument("a crack's path needs two points");
  for (const Point& z : path)
    if (!std::isfinite(z.real()) || !std::isfinite(z.imag())) throw std::invalid_argument("a point is not finite");
  for (std::size_t i = 1; i < path.size(); ++i) {
    if (!(std::abs(path[i] - path[i - 1]) > 0)) throw std::invalid_argument("points of the path coincide");
    if (i > 1 && std::abs(turn_between(path[i - 1] - path[i - 2], path[i] - path[i - 1])) > 0.9 * pi)
      throw std::invalid_argument("the path doubles back");
  }
  if (plane.beyond) {
    const double side = path.front().real() - plane.interface_x;
    for (const Point& z : path)
      if (!((z.real() - plane.interface_x) * side > 0)) throw std::invalid_argument("the path reaches the interface");
  }
  if (plane.mirrored)
    for (std::size_t i = 0; i < path.size(); ++i)
      if (!(path[i].imag() > 0 || (i == 0 && path[i].imag() == 0)))
        throw std::invalid_argument("a mirrored path may touch y = 0 at its first point only, and lies above");
}

}  // namespace

PathLoad in_situ_load(std::function<double(double)> P, double s_xx, double s_yy) {
  return [P = std::move(P), s_xx, s_yy](double s, double along) {
    const double c = std::cos(along), n = std::sin(along);  // t = (c, n), n = (-n, c)
    return Eigen::Vector2d(P(s) + n * n * s_xx + c * c * s_yy, n * c * (s_yy - s_xx));
  };
}

CurvedCrack::CurvedCrack(std::vector<Point> path, const CrackPlane& plane, int refine)
    : path_(std::move(path)), plane_(plane), refine_(refine) {
  if (refine < 1) throw std::invalid_argument("refine must be at least 1");
  check_path(path_, plane_);
  mirror_ = bonded_mirror(plane.rock, plane.beyond.value_or(plane.rock));
  if (!plane.beyond) mirror_ = {0, 0};
  turn_ = path_.front().real() < plane.interface_x ? Point(0, -1) : Point(0, 1);
  if (!plane.beyond) turn_ = 1.0;
  first_is_tip_ = !(plane.mirrored && path_.front().imag() == 0);
  s_.push_back(0);
  for (std::size_t i = 1; i < path_.size(); ++i) s_.push_back(s_.back() + std::abs(path_[i] - path_[i - 1]));
  length_ = s_.back();
  cut();
  assemble();
}

// --- elements

double CurvedCrack::largest_size(std::size_t segment, double from, double to) const {
  const double middle = 0.5 * (from + to);
  const auto piece_length = [&](std::size_t i) { return s_[i + 1] - s_[i]; };
  const std::size_t last = path_.size() - 2;
  double size = piece_length(segment);
  const auto gap = [&](double place) { return std::max(0.0, std::abs(middle - place) - 0.5 * (to - from)); };
  // An element that touches `place` may have the size `smallest`, the next ones grow.
  const auto limit = [&](double place, double smallest) { size = std::min(size, smallest + kGrowth * gap(place)); };
  const auto limit_at_tip = [&](double tip, double piece) {
    const double distance = gap(tip);
    size = std::min(size, distance > 1e-9 * piece ? kNearTip * distance : kTip * piece);
  };
  limit_at_tip(length_, piece_length(last));
  if (first_is_tip_) limit_at_tip(0, piece_length(0));
  for (std::size_t i = 1; i + 1 < path_.size(); ++i) {
    const double turn = std::abs(turn_between(path_[i] - path_[i - 1], path_[i + 1] - path_[i]));
    limit(s_[i], at_kink(turn) * std::min(piece_length(i - 1), piece_length(i)));
  }
  // A path that leaves the symmetry line at an angle is kinked there.
  if (!first_is_tip_) limit(0, at_kink(std::abs(pi - 2 * std::arg(path_[1] - path_[0]))) * piece_length(0));
  if (plane_.beyond) {
    const Point unit = (path_[segment + 1] - path_[segment]) / piece_length(segment);
    for (const double end : {from, to}) {
      const double x = path_[segment].real() + (end - s_[segment]) * unit.real();
      size = std::min(size, kToInterface * std::abs(x - plane_.interface_x));
    }
  }
  return size / refine_;
}

CrackElement CurvedCrack::element_at(Point start, double direction, double length, bool at_tip) const {
  return {to_frame(start), direction + std::arg(turn_), length, at_tip};
}

void CurvedCrack::add_piece(std::size_t segment, double from, double to) {
  const Point unit = (path_[segment + 1] - path_[segment]) / (s_[segment + 1] - s_[segment]);
  const double along = std::arg(unit);
  const bool first = first_is_tip_ && elements_.empty();
  const bool last = to == length_;
  const Point start = path_[segment] + ((last ? to : from) - s_[segment]) * unit;
  const double direction = last ? along + pi : along;
  elements_.push_back({element_at(start, direction, to - from, first || last),
                       element_at(std::conj(start), -direction, to - from, first || last), from, along, last});
}

void CurvedCrack::cut() {
  for (std::size_t segment = 0; segment + 1 < path_.size(); ++segment) {
    // Halves until all are small enough, from the start onwards.
    std::vector<double> ends{s_[segment + 1]};
    double from = s_[segment];
    while (!ends.empty()) {
      const double to = ends.back();
      if (to - from > largest_size(segment, from, to) * (1 + 1e-9)) {
        ends.push_back(0.5 * (from + to));
        continue;
      }
      add_piece(segment, from, to);
      from = to;
      ends.pop_back();
    }
  }
}

// --- equations

ElementTraction CurvedCrack::influence(const Piece& piece, Point z, double across, bool on_element) const {
  ElementTraction sum = element_traction(piece.element, mirror_, z, across, on_element);
  if (plane_.mirrored) {
    // The image, run through from its own start, has the same opening and the opposite slip.
    const ElementTraction image = element_traction(piece.image, mirror_, z, across, false);
    sum.leftCols<kElementModes>() += image.leftCols<kElementModes>();
    sum.rightCols<kElementModes>() -= image.rightCols<kElementModes>();
  }
  return sum;
}

void CurvedCrack::assemble() {
  const auto n = static_cast<Eigen::Index>(elements_.size());
  Eigen::MatrixXd A(kUnknowns * n, kUnknowns * n);
  for (Eigen::Index i = 0; i < n; ++i) {
    const CrackElement& target = elements_[static_cast<std::size_t>(i)].element;
    for (std::size_t g = 0; g < kGauss.size(); ++g) {
      const Point z = target.at(kGauss[g] * target.length);
      for (Eigen::Index j = 0; j < n; ++j)
        A.block<2, kUnknowns>(kUnknowns * i + 2 * static_cast<Eigen::Index>(g), kUnknowns * j) =
            influence(elements_[static_cast<std::size_t>(j)], z, target.direction, i == j);
    }
  }
  system_.compute(A);
}

CurvedCrack::Solution CurvedCrack::solve(const PathLoad& load) const {
  const double E_prime = plane_.rock.E_prime();
  Eigen::VectorXd b(kUnknowns * static_cast<Eigen::Index>(elements_.size()));
  for (std::size_t i = 0; i < elements_.size(); ++i)
    for (std::size_t g = 0; g < kGauss.size(); ++g) {
      const Piece& piece = elements_[i];
      const double t = piece.reversed ? 1 - kGauss[g] : kGauss[g];
      b.segment<2>(static_cast<Eigen::Index>(kUnknowns * i + 2 * g)) =
          -4 * pi / E_prime * load(piece.s + t * piece.element.length, piece.along);
    }
  Solution solution{system_.solve(b), {}, {}};
  if (!solution.modes.allFinite()) throw std::runtime_error("the crack's equations have no finite solution");
  const auto at_tip = [&](std::size_t i) {
    const double unit = E_prime / 8 * std::sqrt(2 * pi / elements_[i].element.length);
    const auto first = static_cast<Eigen::Index>(kUnknowns * i);
    return CrackLine::Intensities{unit * solution.modes(first), unit * solution.modes(first + kElementModes)};
  };
  if (first_is_tip_) solution.first = at_tip(0);
  solution.last = at_tip(elements_.size() - 1);
  return solution;
}

// --- what the solution gives

std::size_t CurvedCrack::piece_at(double s) const {
  if (!(s >= 0 && s <= length_)) throw std::invalid_argument("the place is not on the path");
  const auto after =
      std::upper_bound(elements_.begin(), elements_.end(), s, [](double at, const Piece& p) { return at < p.s; });
  return static_cast<std::size_t>(after - elements_.begin()) - 1;
}

Eigen::Vector2d CurvedCrack::jump(const Solution& solution, double s) const {
  const std::size_t i = piece_at(s);
  const Piece& piece = elements_[i];
  double t = std::clamp((s - piece.s) / piece.element.length, 0.0, 1.0);
  if (piece.reversed) t = 1 - t;
  const double lead = piece.element.at_tip ? std::sqrt(t) : 1;
  const Eigen::Vector3d b = lead * Eigen::Vector3d(1, t, t * t);
  const auto modes = solution.modes.segment<kUnknowns>(static_cast<Eigen::Index>(kUnknowns * i));
  return {modes.head<kElementModes>().dot(b), modes.tail<kElementModes>().dot(b)};
}

Eigen::Vector2d CurvedCrack::traction(const Solution& solution, Point z, double across) const {
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < elements_.size(); ++i)
    sum += influence(elements_[i], to_frame(z), across + std::arg(turn_), false) *
           solution.modes.segment<kUnknowns>(static_cast<Eigen::Index>(kUnknowns * i));
  return plane_.rock.E_prime() / (4 * pi) * sum;
}

Eigen::Vector2d CurvedCrack::crack_traction(const Solution& solution, double s) const {
  const std::size_t at = piece_at(s);
  const Piece& piece = elements_[at];
  const double t = s - piece.s;
  const Point z = piece.element.at(piece.reversed ? piece.element.length - t : t);
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  for (std::size_t i = 0; i < elements_.size(); ++i)
    sum += influence(elements_[i], z, piece.element.direction, i == at) *
           solution.modes.segment<kUnknowns>(static_cast<Eigen::Index>(kUnknowns * i));
  return plane_.rock.E_prime() / (4 * pi) * sum;
}

double CurvedCrack::volume(const Solution& solution) const {
  double sum = 0;
  for (std::size_t i = 0; i < elements_.size(); ++i)
    for (int k = 0; k < kElementModes; ++k) {
      const double power = elements_[i].element.at_tip ? k + 0.5 : k;
      sum += solution.modes(static_cast<Eigen::Index>(kUnknowns * i) + k) * elements_[i].element.length / (power + 1);
    }
  return sum;
}

double CurvedCrack::error(const PathLoad& load) const {
  const Solution coarse = solve(load);
  const Solution fine = CurvedCrack(path_, plane_, 2 * refine_).solve(load);
  const double size =
      std::max({std::hypot(fine.first.K_I, fine.first.K_II), std::hypot(fine.last.K_I, fine.last.K_II), 1e-300});
  return std::max(std::hypot(fine.first.K_I - coarse.first.K_I, fine.first.K_II - coarse.first.K_II),
                  std::hypot(fine.last.K_I - coarse.last.K_I, fine.last.K_II - coarse.last.K_II)) /
         size;
}

}  // namespace strata::reference
