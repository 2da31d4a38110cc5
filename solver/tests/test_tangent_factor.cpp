#include "quasistatic/tangent_factor.hpp"

#include <catch2/catch.hpp>
#include <cmath>

using namespace strata;

namespace {

struct Contact {
  Eigen::MatrixXd S;
  std::vector<ContactPlace> places;
  std::vector<LawAnswer> answers;
};

// n nodes of two unknowns each before a stiffness without free motion, and places on the way from each node to the
// next, each the mean of its neighbours'.
Contact row_of_places(int n) {
  Contact contact;
  contact.S = Eigen::MatrixXd::Identity(2 * n, 2 * n) * 3e9;
  for (Eigen::Index a = 0; a < 2 * n; ++a) {
    for (Eigen::Index b = 0; b < 2 * n; ++b)
      contact.S(a, b) += 1e9 * std::exp(-0.2 * static_cast<double>(std::abs(a - b)));
  }
  for (int node = 0; node + 1 < n; ++node) {
    ContactPlace& place = contact.places.emplace_back();
    place.A = 0.5 + 0.01 * node;
    place.n = Vec2{std::cos(0.1 * node), std::sin(0.1 * node)};
    for (int c = 0; c < 2; ++c) place.D[static_cast<std::size_t>(c)] = {{2 * node + c, 0.7}, {2 * node + 2 + c, 0.3}};
    LawAnswer& answer = contact.answers.emplace_back();
    answer.dn_dn = -1e13, answer.dt_dt = -1e13;  // closed and stuck
  }
  return contact;
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
  REQUIRE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.places, contact.answers));
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
  REQUIRE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.places, contact.answers));
  open(contact.answers[0]);
  CHECK_FALSE(factor.follow(contact.places, contact.answers));
  CHECK_FALSE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.places, contact.answers));
  contact.answers[0].dn_dn = -1e9, contact.answers[0].dt_dt = -1e9;
  REQUIRE(factor.factorise(tangent(contact.S, contact.places, contact.answers), contact.places, contact.answers, true));
  open(contact.answers[5]);
  CHECK_FALSE(factor.follow(contact.places, contact.answers));  // the one factorised was stiffened
}
