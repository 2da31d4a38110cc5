"""Orders, limits and their uncertainty of made-up sequences; and what is said where there is no order."""

import math

import numpy as np
import pytest

from verification.harness.richardson import estimate, estimate_of_changes, observed_order, told

HALVES, THREE = (2.0, 1.0, 0.5, 0.25), (1.0, 0.5, 0.25)


def law(sizes: tuple[float, ...], limit: float, factor: float, order: float) -> list[float]:
    """f + C h^p."""
    return [limit + factor * h**order for h in sizes]


@pytest.mark.parametrize("order", [0.5, 0.73, 1.0, 1.5, 2.0, 3.0, -0.3, -1.0])
@pytest.mark.parametrize("sizes", [(1.0, 0.5, 0.25), (2.0, 1.0, 0.5), (1.0, 0.7, 0.2), (3.0, 2.9, 0.1)])
def test_the_order_of_a_power_is_its_exponent_for_any_sizes(order: float, sizes: tuple[float, float, float]) -> None:
    assert observed_order(sizes, law(sizes, 2.4e6, -3.0e4, order)) == pytest.approx(order, abs=1e-7)
    assert observed_order(sizes, [math.log(h) for h in sizes]) == pytest.approx(0.0, abs=1e-9), "an order of zero is a logarithm"


@pytest.mark.parametrize("order", [0.55, 1.0, 2.0, 2.9])
def test_the_limit_of_a_clean_order_is_found_and_its_uncertainty_is_the_index(order: float) -> None:
    values = law(HALVES, 2.4e6, 5.0e4, order)
    found = estimate(HALVES, values, unit="Pa")
    assert found.kind == "clean" and found.order == pytest.approx(order, abs=1e-7) and found.extrapolate == pytest.approx(2.4e6, abs=1.0)
    assert found.uncertainty == pytest.approx(1.25 * (values[-1] - 2.4e6), rel=1e-5)
    assert [item.order for item in found.triples] == pytest.approx([order, order], abs=1e-6)


@pytest.mark.parametrize(("values", "expected"), [((8.0, 4.0, 2.0), (1.0, 0.0, 2.5)), ((17.0, 5.0, 2.0), (2.0, 1.0, 1.25))])
def test_hand_numbers(values: tuple[float, ...], expected: tuple[float, ...]) -> None:
    """Celik et al. 2008 ask for GCI = 1.25 e/(r^p - 1)."""
    found = estimate((4.0, 2.0, 1.0), values)
    assert (found.order, found.extrapolate, found.uncertainty) == pytest.approx(expected, abs=1e-9)


def test_a_limit_lies_within_its_uncertainty_where_a_second_term_is_small() -> None:
    rng = np.random.default_rng(7)
    for _ in range(200):
        limit, first, order = rng.uniform(1.0, 3.0), rng.uniform(-1.0, 1.0), rng.uniform(0.8, 2.0)
        second = 0.05 * first * rng.uniform(-1.0, 1.0)
        found = estimate(HALVES, [limit + first * h**order + second * h ** (order + 1.0) for h in HALVES])
        assert found.kind == "clean" and found.extrapolate is not None and found.uncertainty is not None
        assert abs(found.extrapolate - limit) <= found.uncertainty


@pytest.mark.parametrize(("values", "noise", "kind", "order", "says"), [
    ((1.0, 3.0, 2.0), 0.0, "oscillates", None, "oscillates: spread 2 m over the finest three, last change 1 m"),
    (law(THREE, 0.0, 1.0, -0.3), 0.0, "diverges", -0.3, "order -0.30: not converging"),
    (law(THREE, 1.0, 1.0, 0.3), 0.0, "odd order", 0.3, "order 0.30 is outside"), (law(THREE, 1.0, 1.0, 4.0), 0.0, "odd order", 4.0, "order 4.00 is outside"),
    ((2.0, 2.0 + 3e-5, 2.0 - 4e-5), 1e-4, "still", None, "the same"), ((11.0, 11.0, 11.0), 0.0, "still", None, "the same at the finest three sizes"),
    ((2.5, 2.0, 2.00004), 1e-4, "settled", None, "settled"), ((2.0, 2.00004, 2.5), 1e-4, "diverges", None, "not converging"),
    ((2.5, 2.0, 2.00004), 1e-6, "oscillates", None, "oscillates"),
])  # fmt: skip
def test_what_has_no_clean_order_has_no_limit(values: tuple[float, ...], noise: float, kind: str, order: float | None, says: str) -> None:
    found = estimate(THREE, values, noise, "m")
    assert (found.kind, found.extrapolate, found.uncertainty) == (kind, None, None) and found.says.startswith(says)
    assert found.order == (order if order is None else pytest.approx(order)) and found.spread == max(values) - min(values)


def test_a_coarse_size_that_does_not_fit_raises_the_factor_of_safety() -> None:
    fine = law(THREE, 2.0, 0.1, 1.0)
    alone, with_coarse = estimate(THREE, fine), estimate(HALVES, [0.0, *fine])
    assert with_coarse.extrapolate == pytest.approx(alone.extrapolate) and with_coarse.uncertainty == pytest.approx(3.0 / 1.25 * alone.uncertainty)
    assert "factor of safety is 3" in with_coarse.says and "oscillates with 2 m" in with_coarse.says


def test_changes_give_the_order_of_a_path() -> None:
    """Distances 4, 2, 1 between successive sizes: order 1; the finest is still 1 (with the factor 1.25) from the limit."""
    found = estimate_of_changes(HALVES, (4.0, 2.0, 1.0))
    assert found.kind == "clean" and found.extrapolate is None and (found.order, found.uncertainty) == pytest.approx((1.0, 1.25), abs=1e-9)
    assert estimate_of_changes(HALVES, (1.0, 2.0, 3.0)).kind == "diverges"


def test_few_values_say_so_and_wrong_ones_are_refused() -> None:
    assert estimate((1.0, 0.5), (2.0, 1.5), unit="m").says == "two sizes only, 0.5 m apart"
    assert estimate((1.0,), (2.0,)).says == "one size only (1 m)" and estimate((), ()).kind == "too few"
    assert (told(5770.0, "Pa"), told(0.5, "m"), told(0.5, "")) == ("5.77 kPa", "0.5 m", "0.5")
    wrong = ((observed_order, (1.0, 1.0, 0.5), (1.0, 2.0, 3.0), "do not fall"), (estimate, THREE, (1.0, 2.0), "sizes and"),
             (estimate_of_changes, (1.0, 0.5), (1.0, 2.0), "changes"))  # fmt: skip
    for function, sizes, values, why in wrong:
        with pytest.raises(ValueError, match=why):
            function(sizes, values)
