"""What is told of a tip: numbers where there are numbers, null with the reason where there are none."""

import math

import numpy as np
import pytest

from verification.harness.load import Run
from verification.harness.paths import ANALYTIC
from verification.tests.cases import completed

SCENE = ANALYTIC / "three_layers.toml"
SHALE_E_PRIME_PA = 10.0e9 / 0.96


@pytest.mark.parametrize("cell_m", [1.0, 0.5])
def test_no_row_has_a_number_that_no_tip_has(cell_m: float) -> None:
    """Of a straight path in like rocks: K_I >= 0, J >= 0 and within 35 N/m of K_I^2/E' (a sixth of J_c), no kink beyond round-off. A tip without K_I
    has J = 0 and no kink; J and K are absent where the interface is near and only there."""
    history = completed(SCENE, "", (f"numerics.cell_m={cell_m}",)).history
    K, J, kink = history["K_I_Pa_sqrt_m"], history["J_N_m"], history["kink_deg"]
    known = np.isfinite(K)
    assert known.sum() > 20 and (K[known] > 1e6).any() and (K[known] == 0.0).any()
    assert (K[known] >= 0.0).all() and (J[np.isfinite(J)] >= 0.0).all()
    assert (np.abs(kink[np.isfinite(kink)]) < 1e-6).all()
    closed = K == 0.0
    assert (J[closed] == 0.0).all() and np.isnan(kink[closed]).all()
    told = np.isfinite(J) & ~closed
    off = np.abs(J[told] - K[told] ** 2 / SHALE_E_PRIME_PA)
    assert (off < 35.0).all()
    assert (history["near"][~known] == 1).all() and set(history["near"]) <= {0.0, 1.0}
    assert (history["at_interface"] == history["near"]).all()


def tip(run: Run) -> dict:
    """The leading tip as summary.json has it."""
    return max(run.summary.raw["tips"], key=lambda tip: tip["y_m"])


def test_J_beside_faces_that_are_apart_is_null_and_why() -> None:
    """2 m below a weak interface that has failed: K alone at 2 cells, J too at 4 and 8, K alike to 1 %."""
    coarse = tip(completed(SCENE, "below_frail"))
    assert coarse["J_N_m"] is None and coarse["J_spread"] is None and coarse["kink_deg"] == pytest.approx(0.0, abs=1e-6)
    assert "interface" in coarse["reason"] and coarse["near"] == "interface" and coarse["at_interface"] is True
    fine, finer = (tip(completed(SCENE, "below_frail", (f"numerics.cell_m={cell}",))) for cell in (0.5, 0.25))
    for known in (fine, finer):
        assert known["reason"] == known["near"] == "" and known["at_interface"] is False
        assert math.isfinite(known["J_N_m"]) and known["kink_deg"] == pytest.approx(0.0, abs=1e-6)
    assert [one["K_I_Pa_sqrt_m"] for one in (coarse, fine)] == pytest.approx([finer["K_I_Pa_sqrt_m"]] * 2, rel=0.01)


def test_a_bond_between_like_rocks_is_no_obstacle() -> None:
    """Strong enough to hold: K_I 2 cells below it is that of the rock without it, to 1 %, and unmarked."""
    strong = ("interface.frail.shear_strength_Pa=1e9", "interface.frail.tensile_strength_Pa=1e9", "interface.rough.coefficient=1e3")
    bonded = tip(completed(SCENE, "below_frail", strong))
    alone = tip(completed(SCENE, "below_frail", ("strata.interfaces=[\"perfect\",\"perfect\"]",)))
    assert bonded["reason"] == bonded["near"] == "" and bonded["at_interface"] is False
    assert bonded["K_I_Pa_sqrt_m"] == pytest.approx(alone["K_I_Pa_sqrt_m"], rel=0.01)
