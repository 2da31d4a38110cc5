"""The fluid's weight: K under a linear pressure, growth in a stress that falls as the fluid's pressure does, and which end goes first."""

import math

import pytest

from verification.harness.paths import ANALYTIC
from verification.tests.cases import completed

SCENE = ANALYTIC / "heavy_fluid.toml"
WEIGHTLESS = ("fluid.density_kg_m3=0",)
rho_g, half, net = 9806.65, 10.0, 0.3e6  # N/m^3, m, Pa


def K_of_ends(variant: str, settings: tuple[str, ...] = ()) -> tuple[float, float]:
    """K_I of the lower and the upper tip, Pa sqrt(m)."""
    lower, upper = sorted(completed(SCENE, variant, settings).summary.tips, key=lambda tip: tip.y_m)
    return lower.K_I_Pa_sqrt_m, upper.K_I_Pa_sqrt_m


def test_K_under_the_weight_of_resting_fluid() -> None:
    """sqrt(pi a) (p +- rho g a/2): their mean to 0.2 %, their difference, all of it the weight's, to 1 %; the volume is the weightless one's."""
    lower, upper = K_of_ends("")
    scale = math.sqrt(math.pi * half)
    assert 0.5 * (lower + upper) == pytest.approx(scale * net, rel=2e-3)
    assert lower - upper == pytest.approx(scale * rho_g * half, rel=1e-2)
    heavy, light = completed(SCENE).summary, completed(SCENE, "", WEIGHTLESS).summary
    assert heavy.fracture_volume_m2 == pytest.approx(light.fracture_volume_m2, rel=1e-9)
    # Clapeyron: half of int p w ds, of which the odd part of p adds to the energy: pi a^4 (rho g)^2/(8 E') for both faces' ends.
    E_prime = 10e9 / 0.96
    odd = math.pi * half**4 * rho_g**2 / (8.0 * E_prime)
    assert heavy.energy["strain_J"] - light.energy["strain_J"] == pytest.approx(odd, rel=3e-2)


def test_stress_that_falls_as_the_fluids_pressure_does_takes_the_weight_away() -> None:
    lower, upper = K_of_ends("balanced")
    light = K_of_ends("", WEIGHTLESS)
    assert lower == pytest.approx(upper, rel=1e-9) and lower == pytest.approx(light[0], rel=1e-9)


def starts(variant: str, settings: tuple[str, ...] = ()) -> tuple[float, float]:
    """When the lower and the upper tip of a fracture fed at its middle begin to grow, s; no fluid may be missing."""
    summary = completed(SCENE, variant, settings).summary
    assert abs(summary.monitors["volume_balance"]) < 1e-8
    lower, upper = sorted((event for event in summary.events if event.kind == "start"), key=lambda event: event.tip_y_m)
    return lower.time_s, upper.time_s


def test_a_fed_fracture_grows_as_without_weight_in_such_a_stress() -> None:
    """Both ends start together, to 0.2 % when those under a weightless fluid do. In even stress the weight brings the lower one first: K of
    the two is 7 % more and less than their mean, and K^2 rises about as the time does."""
    light, heavy, sinks = starts("fed", WEIGHTLESS), starts("fed_balanced"), starts("fed")
    assert heavy[0] == pytest.approx(heavy[1], rel=1e-3) and heavy[0] == pytest.approx(light[0], rel=2e-3)
    assert sinks[0] < 0.985 * light[0] and sinks[1] > 1.015 * light[0]


def test_with_inertia_it_comes_to_rest_at_the_same_K() -> None:
    moved, still = K_of_ends("moving"), K_of_ends("resting")
    assert moved == pytest.approx(still, rel=1e-2) and moved[0] > 1.2 * moved[1]
