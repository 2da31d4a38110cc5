"""What a number does as the mesh is refined: observed order, Richardson's extrapolate and its uncertainty, or why there is none.

Sources: Roache, J. Fluids Eng. 116 (1994) 405; Celik et al., J. Fluids Eng. 130 (2008) 078001; for the factor of safety where
the order is not confirmed, Oberkampf & Roy, Verification and Validation in Scientific Computing (2010), section 8.7.
"""

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

from scipy.optimize import brentq

# Orders outside this range are no order of a scheme whose terms are of first and second order.
CLEAN_ORDERS = (0.5, 3.0)

# Factors of safety of the grid convergence index; the second where the coarser sizes do not show the same order.
SAFETY, SAFETY_UNCONFIRMED = 1.25, 3.0

# Orders of two successive triples within this are the same order.
SAME_ORDER = 0.5


@dataclass(frozen=True)
class Triple:
    """Three sizes from coarse to fine: kind 'converges', 'oscillates', 'diverges' or 'still'; the order where there is one. 'still': no two values
    differ by more than the noise. 'settled': the last two do not, the first two do."""

    sizes: tuple[float, float, float]
    kind: str
    order: float | None

    @property
    def clean(self) -> bool:
        """Whether the order is one of a converging scheme."""
        return self.kind == "converges" and self.order is not None and CLEAN_ORDERS[0] <= self.order <= CLEAN_ORDERS[1]


@dataclass(frozen=True)
class Estimate:
    """What refinement says of a number; `says` in words, the unit is that of the values. kind: 'clean' (order, extrapolate and uncertainty are
    given), 'still' (the same at all sizes but for the noise), 'settled' (the last refinement moved it by no more than the noise), else 'oscillates',
    'diverges', 'odd order', 'too few'. spread is the largest difference among the finest three values."""

    kind: str
    says: str
    triples: tuple[Triple, ...] = ()
    order: float | None = None
    extrapolate: float | None = None
    uncertainty: float | None = None
    spread: float | None = None


def observed_order(sizes: Sequence[float], values: Sequence[float]) -> float:
    """Order p for which three values lie on f + C h^p, of any three sizes; NaN where the differences differ in sign.
    (f1 - f2)/(f2 - f3) = (h1^p - h2^p)/(h2^p - h3^p), whose right side grows with p (Celik et al. 2008, eq. 3). Sizes coarse to fine. Infinite where
    f2 = f3; raises ValueError for sizes that do not fall."""
    h1, h2, h3 = sizes
    if not h1 > h2 > h3 > 0.0:
        raise ValueError(f"sizes {h1:g}, {h2:g}, {h3:g} do not fall")
    coarse, fine = values[0] - values[1], values[1] - values[2]
    if fine == 0.0:
        return math.inf if coarse != 0.0 else math.nan
    if coarse / fine <= 0.0:
        return -math.inf if coarse == 0.0 else math.nan
    a, b, wanted = math.log(h1 / h2), math.log(h2 / h3), math.log(coarse / fine)

    def off(p: float) -> float:
        return b * p + math.log(math.expm1(a * p) / math.expm1(b * p) if abs(p) * max(a, b) > 1e-9 else a / b) - wanted

    if off(-60.0) > 0.0 or off(60.0) < 0.0:
        return math.copysign(math.inf, -off(0.0))
    return float(brentq(off, -60.0, 60.0, xtol=1e-12))


def triple(sizes: Sequence[float], values: Sequence[float], noise: float) -> Triple:
    """What three successive values say; differences up to `noise` (unit of the values) mean nothing."""
    three = (float(sizes[0]), float(sizes[1]), float(sizes[2]))
    coarse, fine = values[0] - values[1], values[1] - values[2]
    if abs(fine) <= noise:
        return Triple(three, "still" if abs(coarse) <= noise else "settled", None)
    if abs(coarse) <= noise or coarse * fine < 0.0:
        return Triple(three, "diverges" if abs(coarse) <= noise else "oscillates", None)
    order = observed_order(three, values)
    return Triple(three, "converges" if order > 0.0 else "diverges", order if math.isfinite(order) else None)


def told(value: float, unit: str) -> str:
    """A difference with its unit, pressures in kPa."""
    return f"{value / 1e3:.3g} kPa" if unit == "Pa" else f"{value:.3g} {unit}".rstrip()


def estimate(sizes: Sequence[float], values: Sequence[float], noise: float = 0.0, unit: str = "") -> Estimate:
    """Order, extrapolate and uncertainty of values at sizes (coarse to fine), judged by the finest three. Extrapolate f3 + (f3 - f2)/(r^p - 1),
    uncertainty F_s |f3 - f2|/(r^p - 1) with r = h2/h3 (Roache 1994). F_s is 1.25, and 3 where the three sizes before show another order or none. The
    unit is for the words."""
    if len(sizes) != len(values):
        raise ValueError(f"{len(sizes)} sizes and {len(values)} values")
    if len(sizes) < 3:
        spread = abs(values[1] - values[0]) if len(values) == 2 else None
        says = "at no size" if not sizes else f"one size only ({sizes[0]:g} m)"
        return Estimate("too few", says if spread is None else f"two sizes only, {told(spread, unit)} apart", spread=spread)
    triples = tuple(triple(sizes[k : k + 3], values[k : k + 3], noise) for k in range(len(sizes) - 2))
    spread = max(values[-3:]) - min(values[-3:])
    last = triples[-1]
    if not last.clean:
        kind = last.kind if last.kind != "converges" else "odd order"
        return Estimate(kind, _why_not(last, spread, abs(values[-1] - values[-2]), noise, unit), triples, last.order, spread=spread)
    assert last.order is not None
    before = triples[-2] if len(triples) > 1 else last
    agrees = before.clean and abs((before.order or 0.0) - last.order) <= SAME_ORDER
    safety = SAFETY if agrees else SAFETY_UNCONFIRMED
    doubt = "" if agrees else f"; {_triple_words(before)} with {before.sizes[0]:g} m, so the factor of safety is {safety:g}"
    beyond = (values[-1] - values[-2]) / ((sizes[-2] / sizes[-1]) ** last.order - 1.0)
    return Estimate("clean", f"order {last.order:.2f}{doubt}", triples, last.order, values[-1] + beyond, safety * abs(beyond), spread)


def estimate_of_changes(sizes: Sequence[float], changes: Sequence[float], noise: float = 0.0, unit: str = "") -> Estimate:
    """The same for something of which only the distances between successive sizes are known, such as a path. The extrapolate is left out; the
    uncertainty is that of the finest, F_s d/(r^p - 1) with d the last distance."""
    if len(changes) != max(len(sizes) - 1, 0):
        raise ValueError(f"{len(sizes)} sizes have {len(sizes) - 1} changes, not {len(changes)}")
    values = [math.fsum(changes[k:]) for k in range(len(sizes))]
    return replace(estimate(sizes, values, noise, unit), extrapolate=None)


def _triple_words(item: Triple) -> str:
    """What a triple shows, in words."""
    if item.kind == "converges" and item.order is not None:
        return f"order {item.order:.2f}"
    words = {"converges": "too fast for an order", "still": "no change beyond the noise", "settled": "no change beyond the noise"}
    return words.get(item.kind, item.kind) + (f" (order {item.order:.2f})" if item.order is not None else "")


def _why_not(last: Triple, spread: float, change: float, noise: float, unit: str) -> str:
    """Why the finest three values show no order."""
    moves = f"spread {told(spread, unit)} over the finest three, last change {told(change, unit)}"
    order = "" if last.order is None else f"order {last.order:.2f}: "
    return {
        "still": "the same at the finest three sizes" + (f" to {told(noise, unit)}" if noise > 0.0 else ""),
        "settled": f"settled: the last refinement moves it by no more than {told(noise, unit)}",
        "oscillates": f"oscillates: {moves}",
        "diverges": f"{order}not converging, {moves}",
        "converges": f"order {'above 60' if last.order is None else f'{last.order:.2f}'} is outside {CLEAN_ORDERS[0]:g} to {CLEAN_ORDERS[1]:g}: "
        f"no extrapolate, {moves}",
    }[last.kind]
