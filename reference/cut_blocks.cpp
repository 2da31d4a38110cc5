#include "cut_blocks.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace strata::reference {
namespace {

using Index = Eigen::Index;

// The finest element over the shortest length: K is then right to 1e-5. Finer ones are so flat that round-off in the
// energy, their length over their height times 1e-16, shows in its differences; so the least over the block, too.
constexpr double kFinest = 3e-4, kFlattest = 1e-7;

void check(const CutBlock& block) {
  for (const double length : {block.width, block.height, block.interface})
    if (!(length > 0 && std::isfinite(length)))
      throw std::invalid_argument("width, height and interface must be positive and finite");
  if (!(block.fresh >= 0 && block.slipped >= 0 && block.shear_stiffness >= 0))
    throw std::invalid_argument("fresh, slipped and shear_stiffness must not be negative");
  if (!(block.ahead >= 0 && (block.ahead == 0 || block.slipped + block.ahead < block.width / 2)))
    throw std::invalid_argument("ahead must not be negative, and end inside the block");
  if (!(block.interface + block.fresh < block.height))
    throw std::invalid_argument("interface and tip must lie below the block's top");
}

// Splits an element's unknowns: those of its sides and those of its inside.
struct Split {
  std::vector<int> sides, inside;

  explicit Split(int order) {
    for (int at = 0; at < 2 * (order + 1) * (order + 1); ++at) {
      const int i = at / 2 % (order + 1), j = at / 2 / (order + 1);
      (i % order == 0 || j % order == 0 ? sides : inside).push_back(at);
    }
  }
};

}  // namespace

// The unknowns of block r: those of line r (the lower edge of row r, on the interface of both faces), then those of
// the upright sides inside row r. -1: held.
struct CutBlocks::Numbers {
  struct Point {
    int below, above, up;  // u_x seen from below and from above, u_y
  };
  struct Place {
    std::size_t block;
    int at;
  };
  std::vector<std::vector<Place>> of_sides;  // by element, row after row, then side unknown
  std::vector<int> on_line, in_block;        // counts
  std::vector<Point> slip;                   // the interface's points that slide
};

CutBlocks::CutBlocks(const CutBlock& block, const LineBasis& line) : block_(block), line_(line) {
  check(block_);
  block_.slipped = std::min(block_.slipped, block_.width / 2);
  set_lines();
}

CutBlocks::CutBlocks(const CutBlock& block, int order, const Eigen::VectorXd& shear)
    : CutBlocks(block, LineBasis(order)) {
  solve(shear);
}

CutBlocks::Influence CutBlocks::influence(const CutBlock& block, int order) {
  return CutBlocks(block, LineBasis(order)).unit_loads();
}

void CutBlocks::set_lines() {
  const double half = block_.width / 2, tip = block_.interface + block_.fresh;
  const bool ends = block_.slipped > 0 && block_.slipped < half;
  const bool crossed = block_.fresh > 0;
  double shortest = std::min({half, block_.interface, block_.height - tip});
  if (ends) shortest = std::min({shortest, block_.slipped, half - block_.slipped});
  if (crossed) shortest = std::min(shortest, block_.fresh);
  if (block_.ahead > 0) shortest = std::min({shortest, block_.ahead, half - block_.slipped - block_.ahead});
  const double finest = std::max(kFinest * shortest, kFlattest * std::max(half, block_.height)),
               reach = block_.slipped + block_.ahead;
  const auto append = [](std::vector<double>& to, const std::vector<double>& lines) {
    to.insert(to.end(), lines.begin(), lines.end());
  };
  if (block_.slipped > 0) append(x_, graded_lines(0, block_.slipped, true, ends, finest));
  if (block_.ahead > 0) append(x_, graded_lines(block_.slipped, reach, true, false, finest));
  if (reach < half) append(x_, graded_lines(reach, half, true, false, block_.ahead > 0 ? block_.ahead : finest));
  x_.push_back(half);
  for (std::size_t c = 0; c + 1 < x_.size();)  // halved until none is too wide
    if (h_x(c) > block_.widest * half)
      x_.insert(x_.begin() + std::ptrdiff_t(c) + 1, 0.5 * (x_[c] + x_[c + 1]));
    else
      ++c;
  y_ = graded_lines(0, block_.interface, false, true, finest);
  interface_row_ = y_.size();
  if (crossed) append(y_, graded_lines(block_.interface, tip, true, true, finest));
  tip_row_ = y_.size();
  append(y_, graded_lines(tip, block_.height, true, false, finest));
  y_.push_back(block_.height);
}

CutBlocks::Numbers CutBlocks::numbered() const {
  const std::size_t rows = y_.size() - 1, columns = x_.size() - 1, order = std::size_t(line_.order);
  const std::size_t across = columns * order + 1;
  Numbers numbers;
  numbers.in_block.assign(rows + 1, 0), numbers.on_line.assign(rows + 1, 0);
  std::vector<Numbers::Point> points(across * (rows * order + 1));
  for (std::size_t j = 0; j <= rows * order; ++j)
    for (std::size_t i = 0; i < across; ++i) {
      if (i % order != 0 && j % order != 0) continue;  // inside an element
      const double x = x_[i / order] + (i % order == 0 ? 0 : 1e-3 * h_x(i / order));
      const bool slides = j == interface_row_ * order && x < block_.slipped;
      const bool open = j < tip_row_ * order, side = i + 1 == across;
      int& count = numbers.in_block[j / order];
      auto& [below, above, up] = points[j * across + i];
      below = side || (i == 0 && !open && !slides) ? -1 : count++;
      above = !slides ? below : side || (i == 0 && !open) ? -1 : count++;
      up = j == 0 ? -1 : count++;
      if (slides) numbers.slip.push_back(points[j * across + i]);
      if (j % order == 0) numbers.on_line[j / order] = count;
    }
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      std::vector<Numbers::Place> places;
      for (const int at : Split(line_.order).sides) {
        const std::size_t i = std::size_t(at) / 2 % (order + 1), j = std::size_t(at) / 2 / (order + 1);
        const Numbers::Point& point = points[(r * order + j) * across + c * order + i];
        places.push_back({r + j / order, at % 2 == 1 ? point.up : j == order ? point.below : point.above});
      }
      numbers.of_sides.push_back(std::move(places));
    }
  return numbers;
}

CutBlocks::System CutBlocks::assembled(const Numbers& numbers) const {
  const std::size_t rows = y_.size() - 1, columns = x_.size() - 1;
  const Split split(line_.order);
  const int stride = 2 * (line_.order + 1);  // from a point to the one above
  System system;
  auto& [diagonal, above] = system.equations;
  for (std::size_t r = 0; r <= rows; ++r) {
    diagonal.push_back(Eigen::MatrixXd::Zero(numbers.in_block[r], numbers.in_block[r]));
    system.loads.push_back(Eigen::MatrixXd::Zero(numbers.in_block[r], 1));
    if (r < rows) above.push_back(Eigen::MatrixXd::Zero(numbers.in_block[r], numbers.on_line[r + 1]));
  }
  for (std::size_t r = 0; r < rows; ++r) {
    if (r == interface_row_) system.lower = {above[r - 1], diagonal[r]};
    for (std::size_t c = 0; c < columns; ++c) {
      const Eigen::MatrixXd K = element_stiffness(line_, rock(r), h_x(c), h_y(r));
      system.inside.emplace_back(-K(split.inside, split.inside).llt().solve(K(split.inside, split.sides)));
      const Eigen::MatrixXd condensed =
          K(split.sides, split.sides) + K(split.sides, split.inside) * system.inside.back();
      const auto& places = numbers.of_sides[r * columns + c];
      for (std::size_t b = 0; b < places.size(); ++b) {
        const auto [block, at] = places[b];
        if (at < 0) continue;
        if (c == 0 && r < tip_row_ && split.sides[b] % stride == 0)
          system.loads[block](at) += 0.5 * h_y(r) * line_.weights(split.sides[b] / stride);
        for (std::size_t a = 0; a < places.size(); ++a) {
          if (places[a].at < 0 || places[a].block > block) continue;
          Eigen::MatrixXd& target = places[a].block == block ? diagonal[block] : above[r];
          target(places[a].at, at) += condensed(Index(a), Index(b));
        }
      }
    }
  }
  add_springs(numbers, diagonal[interface_row_]);
  return system;
}

void CutBlocks::add_springs(const Numbers& numbers, Eigen::MatrixXd& diagonal) const {
  const std::size_t order = std::size_t(line_.order);
  for (std::size_t c = 0; c * order < numbers.slip.size(); ++c)
    for (std::size_t i = 0; i <= order; ++i)
      for (std::size_t k = 0; k <= order; ++k) {
        if (std::max(i, k) + c * order >= numbers.slip.size()) continue;  // no slip at its end
        const double D = block_.shear_stiffness * 0.5 * h_x(c) * line_.mass(Index(i), Index(k));
        const auto one = numbers.slip[c * order + i], other = numbers.slip[c * order + k];
        for (const auto& [a, sign_a] : {std::pair{one.below, 1}, std::pair{one.above, -1}})
          for (const auto& [b, sign_b] : {std::pair{other.below, 1}, std::pair{other.above, -1}})
            if (a >= 0 && b >= 0) diagonal(a, b) += sign_a * sign_b * D;
      }
}

void CutBlocks::solve(const Eigen::VectorXd& shear) {
  const std::size_t rows = y_.size() - 1, columns = x_.size() - 1;
  const Numbers numbers = numbered();
  System system = assembled(numbers);
  const auto fluid = system.loads;
  for (Index k = 0; k < shear.size(); ++k) {
    const auto& point = numbers.slip.at(std::size_t(k));
    if (point.below >= 0) system.loads[interface_row_](point.below) += shear(k);
    if (point.above >= 0) system.loads[interface_row_](point.above) -= shear(k);
  }
  const auto u = std::move(system.equations).solve(system.loads);
  for (std::size_t r = 0; r <= rows; ++r) {  // half the width each
    energy_ += system.loads[r].col(0).dot(u[r].col(0));
    volume_ += 2 * fluid[r].col(0).dot(u[r].col(0));
  }
  const Split split(line_.order);
  u_.assign(rows, {});
  for (std::size_t r = 0; r < rows; ++r)
    for (std::size_t c = 0; c < columns; ++c) {
      const auto& places = numbers.of_sides[r * columns + c];
      Eigen::VectorXd sides(Index(places.size())), all(Index(split.sides.size() + split.inside.size()));
      for (std::size_t a = 0; a < places.size(); ++a)
        sides(Index(a)) = places[a].at < 0 ? 0 : u[places[a].block](places[a].at, 0);
      all(split.sides) = sides;
      all(split.inside) = system.inside[r * columns + c] * sides;
      u_[r].push_back(std::move(all));
    }
}

CutBlocks::Influence CutBlocks::unit_loads() const {
  const Numbers numbers = numbered();
  System system = assembled(numbers);
  const auto count = Index(numbers.slip.size());
  for (auto& load : system.loads) load.conservativeResizeLike(Eigen::MatrixXd::Zero(load.rows(), 1 + count));
  for (Index k = 0; k < count; ++k) {
    const auto& point = numbers.slip[std::size_t(k)];
    if (point.below >= 0) system.loads[interface_row_](point.below, 1 + k) = 1;
    if (point.above >= 0) system.loads[interface_row_](point.above, 1 + k) = -1;
  }
  const auto u = std::move(system.equations).solve(system.loads);
  double volume = 0;
  for (std::size_t r = 0; r < u.size(); ++r) volume += 2 * system.loads[r].col(0).dot(u[r].col(0));
  const auto& [coupled, own] = system.lower;
  const Eigen::MatrixXd& at = u[interface_row_];
  const Eigen::MatrixXd forces = coupled.transpose() * u[interface_row_ - 1] + own.topRows(coupled.cols()) * at;
  Influence influence;
  influence.volume = volume;
  influence.slip = influence.tension = Eigen::MatrixXd::Zero(count, 1 + count);
  influence.x = influence.weights = Eigen::VectorXd::Zero(count);
  for (Index k = 0; k < count; ++k) {
    const auto& point = numbers.slip[std::size_t(k)];
    if (point.below >= 0) influence.slip.row(k) += at.row(point.below);
    if (point.above >= 0) influence.slip.row(k) -= at.row(point.above);
    influence.tension.row(k) = forces.row(point.up);
    const Index c = k / line_.order, i = k % line_.order;
    const double h = h_x(std::size_t(c));
    influence.x(k) = x_[std::size_t(c)] + 0.5 * h * (1 + line_.nodes(i));
    influence.weights(k) = 0.5 * h * line_.weights(i);
    if (i == 0 && c > 0) influence.weights(k) += 0.5 * h_x(std::size_t(c - 1)) * line_.weights(line_.order);
  }
  return influence;
}

double CutBlocks::energy_rate() const {
  const std::size_t from = block_.fresh > 0 ? interface_row_ : 0;
  const double tip = y_[tip_row_], below = tip - y_[from], above = y_.back() - tip;
  const Index stride = 2 * Index(line_.order + 1);  // from a point to the one above
  double rate = 0;
  for (std::size_t r = from; r + 1 < y_.size(); ++r) {
    const double stretch = r < tip_row_ ? 1 / below : -1 / above;  // d ln(h_y)/d(tip)
    for (std::size_t c = 0; c + 1 < x_.size(); ++c) {
      const Eigen::VectorXd& u = u_[r][c];
      rate -= stretch * u.dot(element_stiffness(line_, rock(r), h_x(c), h_y(r), true) * u);
    }
    if (r < tip_row_)
      for (Index j = 0; j <= line_.order; ++j)
        rate += 2 * stretch * 0.5 * h_y(r) * line_.weights(j) * u_[r][0](stride * j);
  }
  return rate;
}

double CutBlocks::K_I() const {
  const bool same = block_.below.youngs_modulus == block_.above.youngs_modulus &&
                    block_.below.poisson_ratio == block_.above.poisson_ratio;
  if (block_.fresh == 0 && (block_.slipped > 0 || !same))
    throw std::invalid_argument("a tip on a decoupled interface or between two rocks has no K");
  const double rate = energy_rate();
  if (!(rate > 0)) throw std::runtime_error("K is lost in round-off: the rocks or lengths are too far apart");
  return std::sqrt(block_.above.E_prime() * rate);
}

double CutBlocks::opening(double y) const {
  if (!(y >= 0 && y < y_[tip_row_])) return 0;
  const auto r = std::size_t(std::upper_bound(y_.begin(), y_.end(), y) - y_.begin()) - 1;
  const Eigen::VectorXd N = line_.values(2 * (y - y_[r]) / h_y(r) - 1);
  const Index stride = 2 * Index(line_.order + 1);
  double u = 0;
  for (Index j = 0; j <= line_.order; ++j) u += N(j) * u_[r][0](stride * j);
  return 2 * u;
}

CutBlocks::Traction CutBlocks::traction(std::size_t column, double xi) const {
  Eigen::Vector3d stress = Eigen::Vector3d::Zero();
  for (const std::size_t row : {interface_row_ - 1, interface_row_})
    stress += 0.5 * element_stress(line_, rock(row), h_x(column), h_y(row), u_[row][column], xi,
                                   row < interface_row_ ? 1 : -1);
  return {stress(1), stress(2)};
}

CutBlocks::Traction CutBlocks::mean_traction_ahead() const {
  const auto line_at = [&](double x) { return std::size_t(std::lower_bound(x_.begin(), x_.end(), x) - x_.begin()); };
  if (!(block_.ahead > 0)) throw std::invalid_argument("mean traction needs a length ahead");
  const std::size_t first = line_at(block_.slipped), last = line_at(block_.slipped + block_.ahead) - 1;
  const std::size_t row = interface_row_ - 1;
  const int n = line_.order + 1, top = 2 * n * line_.order;  // an element's upper left unknown
  Eigen::Vector2d force = Eigen::Vector2d::Zero();
  for (std::size_t c = first > 0 ? first - 1 : 0; c <= last; ++c) {
    const Eigen::VectorXd f = element_stiffness(line_, block_.below, h_x(c), h_y(row)) * u_[row][c];
    const int from = c < first ? line_.order : 0, to = c == last ? 0 : line_.order;
    for (int i = from; i <= to; ++i) force += f.segment<2>(top + 2 * i);
  }
  for (int i = 1; i <= line_.order; ++i) {  // Lobatto's rule
    const Traction at = traction(last, line_.nodes(i));
    force += 0.5 * h_x(last) * line_.weights(i) * Eigen::Vector2d(at.shear, at.normal);
  }
  return {force(1) / block_.ahead, force(0) / block_.ahead};
}

double CutBlocks::largest_tension() const {
  double largest = 0;
  for (std::size_t c = 0; c + 1 < x_.size() && x_[c] < block_.slipped; ++c)
    for (int i = 0; i <= line_.order; ++i) largest = std::max(largest, traction(c, line_.nodes(i)).normal);
  return largest;
}

double crossing_pressure(const CutBlock& block, double increment, double toughness, int order) {
  if (!(increment > 0 && toughness > 0)) throw std::invalid_argument("increment and toughness must be positive");
  CutBlock grown = block;
  grown.fresh += increment;
  const double released = CutBlocks(grown, order).energy() - CutBlocks(block, order).energy();
  return toughness * std::sqrt(increment / (block.above.E_prime() * released));
}

}  // namespace strata::reference
