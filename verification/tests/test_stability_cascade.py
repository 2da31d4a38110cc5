"""The swing of a chain after its last bond has failed, and the checks of the families that are held against it."""

import math
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from verification.harness.load import LoadError
from verification.stability.families import cascade
from verification.stability.theory.swing import Chain, carried, damping_for, most

LIKE, LIGHT = cascade.chain(""), cascade.chain("light")


def marched(chain: Chain, times: np.ndarray, damping: float, dt: float = 2e-4) -> np.ndarray:
    """phi by small steps of Newton's law, spring by spring (leapfrog)."""
    k, m = np.array(chain.springs), np.array(chain.masses)
    u, v, found, t = np.cumsum(1.0 / k), np.zeros(m.size), [], 0.0
    for wanted in times:
        while t < wanted - 0.5 * dt:
            force = k * np.diff(u, prepend=0.0)
            a = (np.append(force[1:], 0.0) - force) / m
            h = dt if t > 0.0 else 0.5 * dt
            v = (v * (1.0 - 0.5 * damping * h) + a * h) / (1.0 + 0.5 * damping * h)
            u, t = u + dt * v, t + dt
        found.append(k[0] * u[0])
    return np.array(found)


@pytest.mark.parametrize(("chain", "damping"), [(LIKE, 0.0), (LIGHT, 0.0), (LIKE, 0.7), (LIGHT, 3.0), (LIKE, 30.0)])
def test_what_is_carried_is_newtons_law(chain: Chain, damping: float) -> None:
    """The modes' sum against a march in time, with little damping and with too much for a swing."""
    times = np.linspace(0.05, 1.5, 12)
    assert np.allclose(carried(chain, times, damping), marched(chain, times, damping), atol=2e-3)


@pytest.mark.parametrize(("chain", "ratio"), [(LIKE, 2.5), (LIGHT, 1.5)])
def test_the_largest_is_the_closed_form(chain: Chain, ratio: float) -> None:
    """Shares R/(R - 1) and -1/(R - 1), the sum of their sizes reached after one period of the slow mode."""
    (slow, fast), shares = chain.modes()
    R = ratio**2
    assert fast / slow == pytest.approx(ratio, rel=1e-12)
    assert shares == pytest.approx([R / (R - 1.0), -1.0 / (R - 1.0)], rel=1e-12)
    assert carried(chain, np.array([0.0, 2.0 * math.pi / slow])) == pytest.approx([1.0, (R + 1.0) / (R - 1.0)], rel=1e-9)
    assert most(chain, 0.0, cascade.SWING_S) == pytest.approx((R + 1.0) / (R - 1.0), rel=1e-6)


def test_damping_at_the_edge() -> None:
    """At the damping found the largest is the strength; there is none for strengths that are never or always reached. One block: phi = cos(w t)."""
    assert most(Chain((1e4,), (0.5e6,)), 0.0, 5.0) == pytest.approx(1.0, abs=1e-12)
    c = damping_for(LIKE, 1.2, cascade.SWING_S)
    assert most(LIKE, c, cascade.SWING_S) == pytest.approx(1.2, rel=1e-5)
    for strength in (1.5, 0.9):
        with pytest.raises(ValueError):
            damping_for(LIKE, strength, cascade.SWING_S)


def made(monkeypatch: pytest.MonkeyPatch, last: float | None, foot: float | None, ratio: float, largest: float = 1.0) -> Any:
    """A run whose bonds failed at these times, and what its foot carried at most."""
    times = {cascade.LAST: last, cascade.FOOT: foot}
    monkeypatch.setattr(cascade, "failed_s", lambda run, interface: times[interface])
    monkeypatch.setattr(cascade, "largest_carried", lambda run: largest)
    scene = {"interface": {"foot": {"tensile_strength_Pa": ratio * cascade.LAST_PA}}, "numerics": {}}
    return SimpleNamespace(scene=scene, folder=Path("made"), summary=SimpleNamespace(variant=""))


def test_swings_that_theory_does_not_know_are_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Too early, too late, or not where theory breaks the foot; too much or too little carried where it holds; the foot first."""
    times = np.linspace(0.0, 1.5, 15001)
    reached = float(times[np.argmax(carried(LIKE, times) >= 1.2)])
    assert cascade.swung(made(monkeypatch, 1.0, 1.0 + reached, 1.2)).holds
    assert cascade.swung(made(monkeypatch, 1.0, None, 1.5, 1.381)).holds
    for late in (0.5 * reached, 2.0 * reached, 1e-3):
        assert not cascade.swung(made(monkeypatch, 1.0, 1.0 + late, 1.2)).holds, late
    for foot, ratio, largest in ((None, 1.2, 1.38), (None, 1.5, 1.3), (None, 1.5, 1.45), (None, 1.5, 0.0), (2.4, 1.5, 1.5)):
        assert not cascade.swung(made(monkeypatch, 1.0, foot, ratio, largest)).holds, (foot, ratio, largest)
    for last, foot in ((None, 1.0), (2.0, 1.0), (None, None)):
        with pytest.raises(LoadError):
            cascade.swung(made(monkeypatch, last, foot, 1.2))


def test_without_inertia_one_bond_fails_at_the_weaker_strength(monkeypatch: pytest.MonkeyPatch) -> None:
    """Both, neither, and failures at other loads are refused."""
    share = (cascade.LAST_PA - cascade.FROM_PA) / (cascade.SHARE * cascade.BLOCK_KG_M2 * cascade.PULL_M_S2)
    due = math.acos(1.0 - 2.0 * share) / (0.5 * math.pi)
    assert cascade.weaker_fails(made(monkeypatch, due, None, 1.2)).holds
    assert not cascade.weaker_fails(made(monkeypatch, None, due, 0.9)).holds
    for wrong in (0.0, 0.9 * due, 1.1 * due, 2.0 * due):
        assert not cascade.weaker_fails(made(monkeypatch, wrong, None, 1.2)).holds, wrong
    for last, foot in ((due, due), (None, None)):
        with pytest.raises(LoadError):
            cascade.weaker_fails(made(monkeypatch, last, foot, 1.2))


def test_an_edge_between_mixed_runs_is_refused(monkeypatch: pytest.MonkeyPatch) -> None:
    """Feet that fail must all be weaker than those that hold."""
    runs = {str(ratio): made(monkeypatch, 1.0, None, ratio) for ratio in (1.2, 1.3, 1.4, 1.5)}
    for weaker, expected in (((1.2, 1.3), 1.35), ((1.2,), 1.25), ((), None), ((1.2, 1.3, 1.4, 1.5), None), ((1.2, 1.4), None)):
        monkeypatch.setattr(cascade, "failed_s", lambda run, interface, weaker=weaker: 2.0 if cascade.strength(run) in weaker else None)
        if expected is not None:
            assert cascade.turns(cascade.strength, runs) == pytest.approx(expected)
            continue
        with pytest.raises(LoadError):
            cascade.turns(cascade.strength, runs)
