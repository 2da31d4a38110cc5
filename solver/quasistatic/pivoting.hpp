// Which pieces of the laws Newton's next step takes.
#pragma once

#include <limits>

#include "quasistatic/tangent_factor.hpp"

namespace strata {

// The pieces of Newton's last step, and how it went: by block pivoting (Judice and Pires, Computers Ops Res. 21, 1994),
// which ends where the tangents are P-matrices, as without friction or with little of it. A step takes the pieces that
// the laws answer at all places, as long as fewer and fewer of these are others than the last step took; where that
// fails a few times, the last such place alone changes until there are fewer than ever.
struct Pivoting {
  Answers on;  // of the last step, one a place: only their linear pieces count
  std::size_t fewest = std::numeric_limits<std::size_t>::max();
  int patience = 0;
};

/// The pieces of answers. Throws nothing.
Pieces pieces_of(const Answers& answers);

/// The pieces of the first step: those of the laws' answers at the first guess. Where nothing was guessed, what slides
/// at no jump at all has come there by the jump that friction remembers, and sticks. Throws nothing.
Answers first_pieces(const Places& places, const Answers& laws, bool guessed);

/// Goes on to the pieces of the next step, where `laws` answer to the last one. A place that would turn round sticks
/// first: contact is so stiff that a law answers the smallest way back by full sliding to the other side. Throws
/// nothing.
void pivot(const Places& places, const Answers& laws, Pivoting& pivoting);

}  // namespace strata
