"""A settled pressurised crack across the grid at an angle: K_I of the reference, no K_II, at both tips."""
from __future__ import annotations

import pytest

from verification.harness.compare import Expected, compare, require, within
from verification.harness.paths import ANALYTIC
from verification.harness.reference import value
from verification.tests.cases import completed

SCENE = ANALYTIC / "inclined_crack.toml"


@pytest.mark.slow
@pytest.mark.parametrize("degrees", [10, 30, 45])
def test_K_I_and_K_II(degrees: int) -> None:
    run = completed(SCENE, f"degrees_{degrees}")
    net_Pa = run.summary.inlet_Pa - float(run.scene["in_situ"]["horizontal_Pa"])
    K_I = value("block_crack", "K_I", half_length_m=5.0, pressure_Pa=net_Pa, width_m=160.0, half_height_m=80.0)
    assert len(run.summary.tips) == 2
    for tip in run.summary.tips:
        require(
            compare("K_I", tip.K_I_Pa_sqrt_m, within(K_I, 0.01, "Pa sqrt(m)")),
            compare("K_II", tip.K_II_Pa_sqrt_m, Expected(0.0, 0.005 * K_I, "Pa sqrt(m)", scale=K_I)),
        )
