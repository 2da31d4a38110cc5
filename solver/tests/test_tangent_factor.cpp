#include "quasistatic/tangent_factor.hpp"

#include <catch2/catch.hpp>
#include <cmath>
#include <map>
#include <numeric>

using namespace strata;

namespace {

struct Contact {
  Eigen::MatrixXd S;
  Unknowns unknowns;
  std::vector<ContactPlace> places;
  std::vector<LawAnswer> answers;
};

// Nodes of two unknowns each, in the order given, before a stiffness without free motion, and places on the way from
// each node to the next higher one, each the mean of its neighbours'. What belongs to a node goes by its number alone.
Contact chain(const std::vector<int>& nodes, std::map<int, std::shared_ptr<int>>& made) {
  Contact contact;
  std::map<int, int> index;
  for (const int node : nodes) {
    index[node] = static_cast<int>(contact.unknowns.size());
    for (int c = 0; c < 2; ++c) {
      auto& unknown = made[2 * node + c];
      if (!unknown) unknown = std::make_shared<int>(2 * node + c);
      contact.unknowns.push_back(unknown);
    }
  }
  const auto n = static_cast<Eigen::Index>(contact.unknowns.size());
  contact.S = Eigen::MatrixXd::Identity(n, n) * 3e9;
  for (Eigen::Index a = 0; a < n; ++a) {
    for (Eigen::Index b = 0; b < n; ++b) {
      const int apart = 2 * (nodes[static_cast<std::size_t>(a / 2)] - nodes[static_cast<std::size_t>(b / 2)]);
      contact.S(a, b) += 1e9 * std::exp(-0.2 * std::abs(apart + static_cast<int>(a % 2 - b % 2)));
    }
  }
  for (auto at = index.begin(); std::next(at) != index.end(); ++at) {
    ContactPlace& place = contact.places.emplace_back();
    place.A = 0.5 + 0.01 * at->first;
    place.n = Vec2{std::cos(0.1 * at->first), std::sin(0.1 * at->first)};
    for (int c = 0; c < 2; ++c)
      place.D[static_cast<std::size_t>(c)] = {{at->second + c, 0.7}, {std::next(at)->second + c, 0.3}};
    LawAnswer& answer = contact.answers.emplace_back();
    answer.dn_dn = -1e13, answer.dt_dt = -1e13;  // closed and stuck
  }
  return contact;
}

std::vector<int> numbers(int from, int to) {
  std::vector<int> out(static_cast<std::size_t>(to - from));
  std::iota(out.begin(), out.end(), from);
  return out;
}

// The unknowns in an order of their own.
std::vector<int> backwards(const Contact& contact) {
  std::vector<int> order = numbers(0, static_cast<int>(contact.unknowns.size()));
  std::ranges::reverse(order);
  return order;
}

Contact row_of_places(int n) {
  std::map<int, std::shared_ptr<int>> made;
  return chain(numbers(0, n), made);
}

void open(LawAnswer& answer) {
  answer.dn_dn = answer.dt_dt = answer.dt_dn = 0.0;
}

void slide(LawAnswer& answer) {
  answer.dn_dn = -1e13, answer.dt_dt = 0.0, answer.dt_dn = -0.6e13;
}

// Largest difference of T^-1 b by the factor and by a dense solve, over the latter.
double error_of(const TangentFactor& factor, const Contact& contact) {
  const Eigen::MatrixXd T = tangent(contact.S, contact.places, contact.answers);
  Eigen::MatrixXd b(T.rows(), 2);
  for (Eigen::Index k = 0; k < b.size(); ++k) b(k) = 1e6 * std::sin(1.0 + static_cast<double>(k));
  const Eigen::MatrixXd expected = T.fullPivLu().solve(b);
  return (factor.solve(b) - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

}  // namespace

// Requires that a factor which follows places that open, slide and close again solves with the tangent of each to
// 1e-9, where contact is 1e4 times as stiff as the rock, and that it asks for a factorisation
// when many have changed. Mutations that fail: rows of changes with the other sign, twice, without the coupling of
// sliding, columns of Z by order of change instead of by place.
TEST_CASE("a factored tangent follows the places that change") {
  Contact contact = row_of_places(60);
  TangentFactor factor;
  CHECK_FALSE(factor.follow(contact.places, contact.answers));
  REQUIRE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.unknowns, contact.places,
                           contact.answers, backwards(contact)));
  CHECK(error_of(factor, contact) < 1e-9);
  const std::vector<LawAnswer> closed = contact.answers;
  double worst = 0.0;
  for (const std::size_t k : {40U, 7U, 8U, 21U}) {
    (k == 21U ? slide : open)(contact.answers[k]);
    REQUIRE(factor.follow(contact.places, contact.answers));
    CHECK(factor.changed());
    worst = std::max(worst, error_of(factor, contact));
  }
  contact.answers[40] = closed[40];
  REQUIRE(factor.follow(contact.places, contact.answers));
  worst = std::max(worst, error_of(factor, contact));
  INFO("largest error " << worst);
  CHECK(worst < 1e-9);
  contact.answers = closed;
  REQUIRE(factor.follow(contact.places, contact.answers));
  CHECK_FALSE(factor.changed());
  for (std::size_t k = 0; k < 30; ++k) open(contact.answers[k]);
  CHECK_FALSE(factor.follow(contact.places, contact.answers));
}

// Requires that what would move freely is not followed but left to be factorised, which tells.
TEST_CASE("a tangent that becomes singular is not followed") {
  Contact contact = row_of_places(60);
  contact.S.row(0).setZero(), contact.S.col(0).setZero();  // held by its place alone
  TangentFactor factor;
  REQUIRE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.unknowns, contact.places,
                           contact.answers, backwards(contact)));
  open(contact.answers[0]);
  CHECK_FALSE(factor.follow(contact.places, contact.answers));
  CHECK_FALSE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.unknowns, contact.places,
                               contact.answers, backwards(contact)));
  contact.answers[0].dn_dn = -1e9, contact.answers[0].dt_dt = -1e9;
  REQUIRE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.unknowns, contact.places,
                           contact.answers, backwards(contact), true));
  open(contact.answers[5]);
  CHECK_FALSE(factor.follow(contact.places, contact.answers));  // the one factorised was stiffened
}

// Requires that a factor grows into the tangent of a state with other unknowns and places, in another order, to 1e-9,
// again and again, also without a place whose unknowns stay and without the unknowns that stand first, and follows
// changes there, sliding included, which T_0 does not have. Mutations that fail: rows of new unknowns without those
// above, the product of the rows above added instead of taken off, places that have gone left in, answers of kept rows
// taken from the new state, scales of unknowns that stay taken anew.
TEST_CASE("a factored tangent grows") {
  std::map<int, std::shared_ptr<int>> made;
  Contact contact = chain(numbers(0, 60), made);
  TangentFactor factor;
  REQUIRE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.unknowns, contact.places,
                           contact.answers, backwards(contact)));
  const auto grow_to = [&](const std::vector<int>& nodes, std::size_t without = 1000) {
    contact = chain(nodes, made);
    if (without < contact.places.size()) {
      contact.places.erase(contact.places.begin() + static_cast<std::ptrdiff_t>(without));
      contact.answers.erase(contact.answers.begin() + static_cast<std::ptrdiff_t>(without));
    }
    for (const std::size_t k : {3U, 20U}) open(contact.answers[k]);
    slide(contact.answers[12]), slide(contact.answers.back());
    factor.outdate();
    CHECK_FALSE(factor.holds(static_cast<Eigen::Index>(contact.unknowns.size())));
    CHECK_FALSE(factor.follow(contact.places, contact.answers));
    return factor.grow(contact.S, contact.unknowns, contact.places, contact.answers);
  };
  std::vector<int> nodes{61};
  for (const int node : numbers(0, 56)) nodes.push_back(node);
  for (const int node : {62, 60}) nodes.push_back(node);
  REQUIRE(grow_to(nodes));
  CHECK(factor.holds(static_cast<Eigen::Index>(contact.unknowns.size())));
  CHECK(error_of(factor, contact) < 1e-9);
  open(contact.answers[30]);
  REQUIRE(factor.follow(contact.places, contact.answers));
  CHECK(error_of(factor, contact) < 1e-9);
  nodes.push_back(65), nodes.push_back(63);
  REQUIRE(grow_to(nodes));
  CHECK(error_of(factor, contact) < 1e-9);
  REQUIRE(grow_to(nodes, 41));  // a place has gone, its unknowns stay
  CHECK(error_of(factor, contact) < 1e-9);
  REQUIRE(grow_to(numbers(2, 60)));  // without those that stand first
  CHECK(error_of(factor, contact) < 1e-9);
}
