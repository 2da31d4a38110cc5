#include "quasistatic/pivoting.hpp"

namespace strata {
namespace {

using Shear = LawAnswer::Shear;

// The linear piece of a law that sticks, for one that slides.
LawAnswer sticking(const ContactPlace& place, LawAnswer r) {
  r.set(Shear::sticks);
  r.t_0 = place.start.r_t + place.k * place.start.w_t;
  r.dt_dt = -place.k, r.dt_dn = 0.0;
  return r;
}

// 1, -1: slides so; 0: does not.
int sense(const LawAnswer& r) {
  return r.shear() == Shear::slips_plus ? 1 : r.shear() == Shear::slips_minus ? -1 : 0;
}

}  // namespace

Pieces pieces_of(const Answers& answers) {
  Pieces pieces;
  pieces.reserve(answers.size());
  for (const LawAnswer& r : answers) pieces.push_back(r.piece);
  return pieces;
}

Answers first_pieces(const Places& places, const Answers& laws, bool guessed) {
  Answers on = laws;
  for (std::size_t k = 0; k < on.size() && !guessed; ++k) {
    if (sense(on[k]) != 0) on[k] = sticking(places[k], on[k]);
  }
  return on;
}

void pivot(const Places& places, const Answers& laws, Pivoting& pivoting) {
  constexpr int steps_without_gain = 3;  // with 10 Experiment 6 friction takes 2 % more of them
  Answers& on = pivoting.on;
  std::vector<std::size_t> differ;
  for (std::size_t k = 0; k < laws.size(); ++k) {
    if (laws[k].piece != on[k].piece) differ.push_back(k);
  }
  if (differ.size() < pivoting.fewest) {
    pivoting.fewest = differ.size();
    pivoting.patience = steps_without_gain;
  } else {
    --pivoting.patience;
  }
  for (const std::size_t k : differ) {
    if (pivoting.patience < 0 && k != differ.back()) continue;
    const bool turns = sense(on[k]) * sense(laws[k]) < 0;
    on[k] = turns ? sticking(places[k], laws[k]) : laws[k];
  }
}

}  // namespace strata
