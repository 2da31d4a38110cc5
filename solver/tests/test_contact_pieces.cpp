#include "quasistatic/contact_equilibrium.hpp"

#include <catch2/catch.hpp>

using namespace strata;

namespace {

using Piece = LawAnswer::Piece;

LawAnswer answer(Piece piece) {
  LawAnswer r;
  r.piece = piece;
  r.n_0 = 2.0, r.dn_dn = -10.0;
  if (piece == Piece::stick) r.dt_dt = -10.0;
  if (piece == Piece::slip_plus) r.t_0 = 1.2, r.dt_dn = -6.0;
  if (piece == Piece::slip_minus) r.t_0 = -1.2, r.dt_dn = 6.0;
  return r;
}

std::vector<LawAnswer> answers(const Pieces& pieces) {
  std::vector<LawAnswer> out;
  for (const Piece piece : pieces) out.push_back(answer(piece));
  return out;
}

std::vector<ContactPlace> places_with_memory(std::size_t n) {
  std::vector<ContactPlace> places(n);
  for (ContactPlace& place : places) place.k = 10.0, place.start.w_t = 0.25, place.start.r_t = -0.5;
  return places;
}

}  // namespace

// Requires that a place which slides and would slide the other way sticks in between, on the line of the law that
// sticks: t = r_t_start - k (w_t - w_t_start), and the normal reaction as it was. Mutations that fail: turns taken as
// the laws answer them, w_t_start with the other sign, dt_dn kept.
TEST_CASE("a place that turns round sticks first") {
  const std::vector<ContactPlace> places = places_with_memory(3);
  Pivoting pivoting{answers({Piece::slip_plus, Piece::slip_plus, Piece::stick})};
  pivot(places, answers({Piece::slip_minus, Piece::slip_plus, Piece::slip_minus}), pivoting);
  CHECK(pieces_of(pivoting.on) == Pieces{Piece::stick, Piece::slip_plus, Piece::slip_minus});
  const LawAnswer& stuck = pivoting.on[0];
  CHECK(stuck.t_0 == Approx(-0.5 + 10.0 * 0.25));
  CHECK(stuck.dt_dt == -10.0);
  CHECK(stuck.dt_dn == 0.0);
  CHECK(stuck.n_0 == 2.0);
  CHECK(stuck.dn_dn == -10.0);
  pivot(places, answers({Piece::slip_minus, Piece::slip_plus, Piece::slip_minus}), pivoting);
  CHECK(pieces_of(pivoting.on) == Pieces{Piece::slip_minus, Piece::slip_plus, Piece::slip_minus});
}

// Requires that without a guess all that slides sticks first, and with one nothing does. A mutation that fails:
// sticking whatever was guessed.
TEST_CASE("without a guess what slides sticks first") {
  const std::vector<ContactPlace> places = places_with_memory(3);
  const std::vector<LawAnswer> laws = answers({Piece::slip_plus, Piece::open, Piece::slip_minus});
  CHECK(pieces_of(first_pieces(places, laws, false)) == Pieces{Piece::stick, Piece::open, Piece::stick});
  CHECK(pieces_of(first_pieces(places, laws, true)) == pieces_of(laws));
}

// Requires that all places follow the laws while fewer and fewer differ, that after three steps without a gain the last
// one changes alone, and that all do again once there are fewer than ever. Mutations that fail: the first one changes
// alone, patience that does not come back.
TEST_CASE("places change one at a time where changes of all of them gain nothing") {
  const std::vector<ContactPlace> places = places_with_memory(4);
  const Pieces open(4, Piece::open), closed(4, Piece::closed);
  Pivoting pivoting{answers(open)};
  for (int step = 0; step < 4; ++step) {
    pivot(places, answers(step % 2 == 0 ? closed : open), pivoting);
    CHECK(pieces_of(pivoting.on) == (step % 2 == 0 ? closed : open));
  }
  pivot(places, answers(closed), pivoting);
  CHECK(pieces_of(pivoting.on) == Pieces{Piece::open, Piece::open, Piece::open, Piece::closed});
  pivot(places, answers(closed), pivoting);  // three differ: fewer than ever
  CHECK(pieces_of(pivoting.on) == closed);
}
