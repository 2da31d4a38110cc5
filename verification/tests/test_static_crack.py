"""A settled pressurised crack in the study's block against strata-reference block_crack."""
from __future__ import annotations

from dataclasses import dataclass

import pytest

from verification.harness.compare import Expected, compare, require, within
from verification.harness.load import Run, Tip
from verification.harness.paths import ANALYTIC
from verification.harness.reference import value
from verification.tests.cases import completed

SCENE = ANALYTIC / "static_crack.toml"
NET_PA = 0.3e6  # start_Pa of the scene less its closing stress, checked below


@dataclass(frozen=True)
class Allowed:
    """Relative tolerances of a cell size."""

    K_I: float
    J: float
    mouth: float
    places: float  # crack on a grid line against crack at mid-cell


ALLOWED = {1.0: Allowed(0.005, 0.010, 0.015, 0.010), 0.5: Allowed(0.003, 0.006, 0.008, 0.005)}
RING_SPREAD = 0.008
K_II_SHARE = 0.002

PLACES = {
    (1.0, "grid_line"): "grid_line",
    (1.0, "mid_cell"): "mid_cell",
    (0.5, "grid_line"): "grid_line",
    (0.5, "mid_cell"): "mid_cell_half_metre",
}


def reference(quantity: str, net_Pa: float = NET_PA) -> float:
    """A value of the reference for the scene's block, SI."""
    return value("block_crack", quantity, half_length_m=5.0, pressure_Pa=net_Pa, width_m=80.0, half_height_m=80.0)


def K_by_J(tip: Tip) -> float:
    """K_I that J stands for, Pa sqrt(m)."""
    return float((tip.J_N_m * reference("E_prime_Pa")) ** 0.5)


def settled(variant: str, cell_m: float = 1.0) -> tuple[Run, Tip]:
    """The settled run of a variant at a cell size (m), and its tip."""
    run = completed(SCENE, variant, (f"numerics.cell_m={cell_m}",))
    return run, run.summary.tips[0]


@pytest.mark.slow
@pytest.mark.parametrize("cell_m, place", PLACES)
def test_K_J_and_opening(cell_m: float, place: str) -> None:
    run, tip = settled(PLACES[cell_m, place], cell_m)
    assert run.summary.inlet_Pa - float(run.scene["in_situ"]["horizontal_Pa"]) == pytest.approx(NET_PA, rel=1e-12)
    allowed, K_I = ALLOWED[cell_m], reference("K_I")
    require(
        compare("K_I by interaction integral", tip.K_I_Pa_sqrt_m, within(K_I, allowed.K_I, "Pa sqrt(m)")),
        compare("K_I by J", K_by_J(tip), within(K_I, allowed.J, "Pa sqrt(m)")),
        compare("mouth opening", run.summary.mouth_opening_m, within(reference("mouth_opening_m"), allowed.mouth, "m")),
        compare("K_II", tip.K_II_Pa_sqrt_m, Expected(0.0, K_II_SHARE * K_I, "Pa sqrt(m)", scale=K_I)),
        compare("spread of J over the rings", tip.J_spread, Expected(0.0, RING_SPREAD, scale=1.0)),
    )


@pytest.mark.slow
@pytest.mark.parametrize("cell_m", [1.0, 0.5])
def test_grid_line_and_mid_cell_agree(cell_m: float) -> None:
    (run, tip), (other, other_tip) = (settled(PLACES[cell_m, place], cell_m) for place in ("grid_line", "mid_cell"))
    share = ALLOWED[cell_m].places
    require(
        compare("K_I", tip.K_I_Pa_sqrt_m, within(other_tip.K_I_Pa_sqrt_m, share, "Pa sqrt(m)")),
        compare("J", tip.J_N_m, within(other_tip.J_N_m, share, "N/m")),
        compare("mouth opening", run.summary.mouth_opening_m, within(other.summary.mouth_opening_m, share, "m")),
    )


@pytest.mark.parametrize("variant", ["closed", "closed_mid_cell"])
def test_nothing_happens_at_the_closing_stress(variant: str) -> None:
    run, tip = settled(variant)
    J_c = reference("J_N_m", reference("critical_net_pressure_Pa"))
    scale = reference("mouth_opening_m")
    require(
        compare("J at P = s_h", tip.J_N_m, Expected(0.0, 1e-3 * J_c, "N/m", scale=J_c)),
        compare("mouth opening at P = s_h", run.summary.mouth_opening_m, Expected(0.0, 1e-6 * scale, "m", scale=scale)),
    )


@pytest.mark.parametrize("variant", ["linear", "gimp"])
def test_other_shapes(variant: str) -> None:
    _, tip = settled(variant)
    require(compare("K_I by J", K_by_J(tip), within(reference("K_I"), 0.035, "Pa sqrt(m)")))
