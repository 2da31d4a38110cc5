"""The models that the families of long flow steps are held against, on problems whose answers are known, and the families' checks."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from verification.stability.families import lagging
from verification.stability.theory import flow
from verification.stability.theory.flow import BULK_PA, E_PRIME_PA, FLOOR_M, HALF_LENGTH_M, compliance, diffused, paper, reynolds

CELLS = 20
DS = HALF_LENGTH_M / CELLS


def test_a_step_diffuses_as_fourier_has_it() -> None:
    """A quarter wave between a held inlet and a closed end decays by exp(-kappa (pi/2L)^2 t), at an opening and at the floor of it."""
    x = np.linspace(0.0, HALF_LENGTH_M, CELLS + 1)
    wave = np.sin(0.5 * math.pi * x / HALF_LENGTH_M)
    for opening, conducts in ((3e-4, 3e-4), (0.2 * FLOOR_M, FLOOR_M)):
        kappa = BULK_PA * conducts**2 / 12.0
        time = 0.5 * HALF_LENGTH_M**2 / kappa
        found = diffused(1e5 * wave, np.full(CELLS, opening), DS, time, 1.0, (0.0, 0.0))
        assert found == pytest.approx(1e5 * wave * math.exp(-0.5 * (0.5 * math.pi) ** 2), rel=2e-3, abs=1e-9)


def test_a_ramp_ends_at_its_end_and_opening_is_sneddons() -> None:
    """The inlet's pressure, and that of all else after a long time. 4 p a/E' at the middle under even pressure, to half a per cent with 20 cells."""
    assert (compliance(CELLS)[0] @ np.full(CELLS, 3e5))[0] == pytest.approx(4.0 * 3e5 * HALF_LENGTH_M / E_PRIME_PA, rel=5e-3)
    p = diffused(np.zeros(CELLS + 1), np.full(CELLS, 1e-3), DS, 1e3, 1.0, (0.0, 2e5))
    assert p[0] == pytest.approx(2e5, rel=1e-12) and p[-1] == pytest.approx(2e5, rel=1e-2) and p[-1] < 2e5


def test_the_crack_takes_up_what_comes_in(monkeypatch: pytest.MonkeyPatch) -> None:
    """With a slow ramp the pressure is even and the opening the compliance's; with a quick one the inlet is ahead of the tip."""
    slow, w = reynolds([1e4] * 20, 3e5, 5e-1, CELLS)
    assert slow == pytest.approx(np.full(CELLS, 4e5), rel=5e-3)
    assert w == pytest.approx(compliance(CELLS)[0] @ slow, rel=1e-9)
    quick, _ = reynolds([0.01] * 10, 3e5, 1e6, CELLS)
    assert quick[0] > 3.2e5 > quick[-1]
    monkeypatch.setattr(flow, "BULK_PA", 1e2 * BULK_PA)  # what is stored by compression is next to nothing: the crack's own answer stays
    assert reynolds([0.01] * 10, 3e5, 1e6, CELLS)[0] == pytest.approx(quick, rel=2e-2)


def test_short_steps_agree() -> None:
    """Halving them changes nothing to speak of."""
    fine, finer = (float(paper([2.0 / n] * n, 0.05e6, 0.35e6, 1.0)[-1]) for n in (1000, 2000))
    assert fine == pytest.approx(finer, rel=1e-3)


def made(monkeypatch: pytest.MonkeyPatch, tip_Pa: float, opened_m: float) -> Any:
    """A run that ends at this net pressure at its tip, its mean opening grown by so much in a second."""
    p = np.array([2.1e6, lagging.CLOSING_PA + tip_Pa])
    outputs = [(0.1 * k, {"pressure_Pa": p, "opening_m": np.full(4, 1e-4 + 0.1 * k * opened_m)}) for k in range(11)]
    monkeypatch.setattr(lagging, "frames", lambda run, group: outputs)
    return SimpleNamespace(scene={"fluid": {"viscosity_Pa_s": 1.0}}, folder=Path("made"), summary=SimpleNamespace(steps=10))


def test_checks_refuse_what_is_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """None, twice, the other sign, and what long steps make of it."""
    tip, opened = lagging.resolved(1.0), lagging.opened(1.0)
    assert lagging.tip_pressure(made(monkeypatch, tip, opened)).holds and lagging.mean_opening(made(monkeypatch, tip, opened)).holds
    for share in (0.0, 0.2, 0.9, 1.1, 2.0, -1.0):
        run = made(monkeypatch, share * tip, share * opened)
        assert not lagging.tip_pressure(run).holds and not lagging.mean_opening(run).holds, share
