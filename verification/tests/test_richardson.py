"""Orders, limits and their uncertainty of made-up sequences; and what is said where there is no order.

Mutations that were run and fail here: the order's logarithm of the inverse ratio, the denominator r^p - 1 without the 1, the
safety factor left out, oscillating differences taken by their size.
"""

import math

import numpy as np
import pytest

from verification.harness.richardson import estimate, estimate_of_changes, observed_order, told

HALVES = (2.0, 1.0, 0.5, 0.25)


def law(sizes: tuple[float, ...], limit: float, factor: float, order: float) -> list[float]:
    """f + C h^p."""
    return [limit + factor * h**order for h in sizes]


@pytest.mark.parametrize("order", [0.5, 0.73, 1.0, 1.5, 2.0, 3.0, -0.3, -1.0])
@pytest.mark.parametrize("sizes", [(1.0, 0.5, 0.25), (2.0, 1.0, 0.5), (1.0, 0.7, 0.2), (3.0, 2.9, 0.1)])
def test_the_order_of_a_power_is_its_exponent_for_any_sizes(order: float, sizes: tuple[float, float, float]) -> None:
    assert observed_order(sizes, law(sizes, 2.4e6, -3.0e4, order)) == pytest.approx(order, abs=1e-7)


def test_an_order_of_zero_is_a_logarithm() -> None:
    sizes = (1.0, 0.5, 0.125)
    assert observed_order(sizes, [math.log(h) for h in sizes]) == pytest.approx(0.0, abs=1e-9)


@pytest.mark.parametrize("order", [0.55, 1.0, 2.0, 2.9])
def test_the_limit_of_a_clean_order_is_found_and_its_uncertainty_is_the_index(order: float) -> None:
    values = law(HALVES, 2.4e6, 5.0e4, order)
    found = estimate(HALVES, values, unit="Pa")
    assert found.kind == "clean"
    assert found.order == pytest.approx(order, abs=1e-7)
    assert found.extrapolate == pytest.approx(2.4e6, abs=1.0)
    assert found.uncertainty == pytest.approx(1.25 * (values[-1] - 2.4e6), rel=1e-5)
    assert [item.order for item in found.triples] == pytest.approx([order, order], abs=1e-6)


def test_hand_numbers() -> None:
    """Celik et al. 2008 ask for GCI = 1.25 e/(r^p - 1): values 8, 4, 2 at halved sizes are of order 1 with limit 0."""
    found = estimate((4.0, 2.0, 1.0), (8.0, 4.0, 2.0))
    assert (found.order, found.extrapolate, found.uncertainty) == pytest.approx((1.0, 0.0, 2.5), abs=1e-9)
    second = estimate((4.0, 2.0, 1.0), (17.0, 5.0, 2.0))
    assert (second.order, second.extrapolate, second.uncertainty) == pytest.approx((2.0, 1.0, 1.25), abs=1e-9)


def test_a_limit_lies_within_its_uncertainty_where_a_second_term_is_small() -> None:
    rng = np.random.default_rng(7)
    for _ in range(200):
        limit, first, order = rng.uniform(1.0, 3.0), rng.uniform(-1.0, 1.0), rng.uniform(0.8, 2.0)
        second = 0.05 * first * rng.uniform(-1.0, 1.0)
        found = estimate(HALVES, [limit + first * h**order + second * h ** (order + 1.0) for h in HALVES])
        assert found.kind == "clean" and found.extrapolate is not None and found.uncertainty is not None
        assert abs(found.extrapolate - limit) <= found.uncertainty


def test_what_oscillates_has_no_limit() -> None:
    found = estimate((1.0, 0.5, 0.25), (1.0, 3.0, 2.0), unit="m")
    assert (found.kind, found.order, found.extrapolate, found.uncertainty, found.spread) == ("oscillates", None, None, None, 2.0)
    assert found.says == "oscillates: spread 2 m over the finest three, last change 1 m"


def test_what_moves_apart_has_no_limit_but_its_order() -> None:
    found = estimate((1.0, 0.5, 0.25), law((1.0, 0.5, 0.25), 0.0, 1.0, -0.3), unit="Pa")
    assert (found.kind, found.extrapolate) == ("diverges", None)
    assert found.order == pytest.approx(-0.3) and found.says.startswith("order -0.30: not converging")


@pytest.mark.parametrize("order", [0.3, 4.0])
def test_an_order_that_no_scheme_has_gives_no_limit(order: float) -> None:
    found = estimate((1.0, 0.5, 0.25), law((1.0, 0.5, 0.25), 1.0, 1.0, order))
    assert (found.kind, found.extrapolate) == ("odd order", None)
    assert f"order {order:.2f} is outside" in found.says


def test_differences_below_the_noise_mean_nothing() -> None:
    assert estimate((1.0, 0.5, 0.25), (2.0, 2.0 + 3e-5, 2.0 - 4e-5), 1e-4).kind == "still"
    assert estimate((1.0, 0.5, 0.25), (2.5, 2.0, 2.00004), 1e-4).kind == "settled"
    assert estimate((1.0, 0.5, 0.25), (2.0, 2.00004, 2.5), 1e-4).kind == "diverges"
    assert estimate((1.0, 0.5, 0.25), (2.5, 2.0, 2.00004), 1e-6).kind == "oscillates"
    assert estimate((1.0, 0.5, 0.25), (11.0, 11.0, 11.0)).says == "the same at the finest three sizes"


def test_a_coarse_size_that_does_not_fit_raises_the_factor_of_safety() -> None:
    fine = law((1.0, 0.5, 0.25), 2.0, 0.1, 1.0)
    alone, with_coarse = estimate((1.0, 0.5, 0.25), fine), estimate(HALVES, [0.0, *fine])
    assert with_coarse.extrapolate == pytest.approx(alone.extrapolate)
    assert with_coarse.uncertainty == pytest.approx(3.0 / 1.25 * alone.uncertainty)
    assert "factor of safety is 3" in with_coarse.says and "oscillates with 2 m" in with_coarse.says


def test_changes_give_the_order_of_a_path() -> None:
    """Distances 4, 2, 1 between successive sizes: order 1; the finest is still 1 (with the factor 1.25) from the limit."""
    found = estimate_of_changes(HALVES, (4.0, 2.0, 1.0))
    assert found.kind == "clean" and found.extrapolate is None
    assert (found.order, found.uncertainty) == pytest.approx((1.0, 1.25), abs=1e-9)
    assert estimate_of_changes(HALVES, (1.0, 2.0, 3.0)).kind == "diverges"


def test_few_values_say_so_and_wrong_ones_are_refused() -> None:
    assert estimate((1.0, 0.5), (2.0, 1.5), unit="m").says == "two sizes only, 0.5 m apart"
    assert estimate((1.0,), (2.0,)).says == "one size only (1 m)"
    assert estimate((), ()).kind == "too few"
    with pytest.raises(ValueError, match="do not fall"):
        observed_order((1.0, 1.0, 0.5), (1.0, 2.0, 3.0))
    with pytest.raises(ValueError, match="sizes and"):
        estimate((1.0, 0.5, 0.25), (1.0, 2.0))
    with pytest.raises(ValueError, match="changes"):
        estimate_of_changes((1.0, 0.5), (1.0, 2.0))


def test_differences_are_told_in_kPa() -> None:
    assert (told(5770.0, "Pa"), told(0.5, "m"), told(0.5, "")) == ("5.77 kPa", "0.5 m", "0.5")
