"""The atlas' judge on made-up families: what it must refuse; the swing of a chain after its last bond has failed, the models that the families of long
flow steps are held against, on problems whose answers are known, and the families' checks."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import numpy as np
import pytest

from verification.harness.load import LoadError
from verification.harness.run import Outcome
from verification.stability.families import cascade, check, lagging
from verification.stability.family import FAILED, GARBAGE, MARKED, REFUSED, STABLE, Checked, Edge, Family, Parameter, Point, at_most, bisected, close
from verification.stability.runner import EdgeFound, PointFound, Record, changes, differs, of_failure, of_run, problems
from verification.stability.theory import flow
from verification.stability.theory.flow import BULK_PA, E_PRIME_PA, FLOOR_M, HALF_LENGTH_M, compliance, diffused, paper, reynolds
from verification.stability.theory.swing import Chain, carried, damping_for, most

SCENE = Path(__file__)


def a_walk(**more: Any) -> Family:
    """A family with points at 0.5, 0.9, 1.1 and 2 whose edge is to be at 1."""
    points = tuple(Point(f"{value:g}", value, SCENE, smoke=value < 1.0) for value in (0.5, 0.9, 1.1, 2.0))
    edge = Edge("Made up.", lambda: 1.0, lambda value: Point(f"at {value}", value, SCENE), (0.5, 2.0))
    given = {"beyond": (FAILED,), "edge": edge} | more
    return Family("walk", "A walk", "It walks.", Parameter("x"), points, pytest.fail, **given)


def recorded(outcomes: str = "ssff", measured: float | None = 1.01) -> Record:
    """A record of that family: outcomes by their first letters (x: garbage)."""
    names = {"s": STABLE, "m": MARKED, "r": REFUSED, "f": FAILED, "x": GARBAGE}
    points = tuple(PointFound(f"{value:g}", value, names[letter], Checked(1.0, 1.0, 0.1, True)) for value, letter in zip((0.5, 0.9, 1.1, 2.0), outcomes))
    return Record("walk", "1", EdgeFound(1.0, measured, 1.0, 1.02), points)


@pytest.mark.parametrize(("record", "said"), [
    (recorded("ssfx"), "2: garbage"), (recorded("sxff"), "0.9: garbage"), (recorded("ssfs"), "2: stable beyond the edge"),
    (recorded("ssfr"), "2: refused beyond the edge"), (recorded("ssfm"), "2: marked beyond the edge"),
    (recorded("sfff"), "0.9: failed before the edge"), (recorded("smff"), "0.9: marked before the edge"),
    (recorded(measured=1.05), "+5.0 % off"), (recorded(measured=0.95), "-5.0 % off"), (recorded(measured=0.0), "-100.0 % off"),
    (recorded(measured=2.0), "+100.0 % off"), (recorded(measured=-1.0), "-200.0 % off"), (recorded(measured=math.nan), "nan"),
    (recorded(measured=None), "not found"), (recorded("ssf"), "2: not measured"), (None, "never measured"),
])  # fmt: skip
def test_what_is_not_as_declared_is_refused(record: Record | None, said: str) -> None:
    """Garbage anywhere, other outcomes than declared on either side, an edge 5 % off, an edge or a point that was not measured."""
    assert any(said in problem for problem in problems(a_walk(), record)), problems(a_walk(), record)


BELOW, FAR = Edge("", lambda: 1.0, unsound_above=False), Edge("", lambda: 3.0)
NEAR = (*a_walk().points, Point("1.02", 1.02, SCENE))  # the last one within the tolerance of the edge


@pytest.mark.parametrize(("given", "record", "fine"), [
    ({}, recorded(), True),  # as declared, with the edge one per cent off
    ({}, replace(recorded(), edge=EdgeFound(None, 1.0, 0.9, 1.1)), False),  # the predicted edge was not computed
    ({"edge": None, "beyond": (STABLE, FAILED)}, recorded(), False),  # an edge was measured that the family does not have
    ({"edge": BELOW}, recorded("ffss"), True), ({"edge": BELOW}, recorded("ssff"), False),  # what lies below the edge is beyond it
    ({"before": (STABLE, MARKED)}, recorded("smff"), True), ({"before": (STABLE, MARKED)}, recorded("sfff"), False),
    ({"edge": FAR}, replace(recorded("ssss"), edge=EdgeFound(3.0, 3.0, 2.9, 3.1)), False),  # no points on both sides of the edge
    ({"edge": None, "beyond": (STABLE,)}, replace(recorded("ssss"), edge=None), True),  # stable by construction means everywhere
    ({"edge": None, "beyond": (STABLE,)}, replace(recorded("sssf"), edge=None), False),
    *(({"points": NEAR}, replace(recorded(), points=(*recorded().points, PointFound("1.02", 1.02, outcome))), fine)  # either side, but garbage never
      for outcome, fine in ((STABLE, True), (FAILED, True), (REFUSED, False), (GARBAGE, False))),
])  # fmt: skip
def test_what_is_declared_decides(given: dict[str, Any], record: Record, fine: bool) -> None:
    """Sides of the edge, outcomes before and beyond it, a family without one."""
    found = problems(replace(a_walk(), **{"beyond": (FAILED,)} | given), record)
    assert (found == []) == fine, found


def test_checks_refuse_zero_twice_and_the_other_sign() -> None:
    """No tolerance lets them pass; not a number never does."""
    assert close(1.04, 1.0, 0.05).holds
    assert not any(close(value, 1.0, 0.9).holds for value in (0.0, 2.0, -1.0, math.nan, math.inf))
    assert at_most(0.9, 1.0).holds
    assert not any(at_most(value, 1.0).holds for value in (1.1, -0.1, math.nan, math.inf))
    for tolerance in (1.0, 0.0, -0.1):
        with pytest.raises(ValueError):
            close(1.0, 1.0, tolerance)
    with pytest.raises(ValueError):
        close(1.0, 0.0, 0.1)


def test_bisection_finds_the_edge() -> None:
    """From either side, to its resolution; a bracket that does not enclose it is an error."""
    below, above = bisected(lambda value: value < 1.234, 0.5, 2.0, 0.001), bisected(lambda value: value > 1.234, 2.0, 0.5, 0.001)
    assert below[0] < 1.234 <= below[1] < below[0] + 0.002 and above[1] <= 1.234 < above[0] < above[1] + 0.002
    for wrong in ((0.5, 1.0), (1.5, 2.0)):
        with pytest.raises(ValueError):
            bisected(lambda value: value < 1.234, *wrong, 0.001)


def test_families_are_checked() -> None:
    """Twice the same label, no smoke point, an outcome that may not be declared, a scene that is not there."""
    family = a_walk()
    check(family)
    wrong = (
        replace(family, points=(*family.points, family.points[0])), replace(family, beyond=(GARBAGE,)), replace(family, beyond=()), replace(family, before=(FAILED,)),
        replace(family, points=tuple(replace(point, smoke=False) for point in family.points)), replace(family, says=""),
        replace(family, points=(*family.points, Point("3", 3.0, Path("no/such.toml")))),
        replace(family, edge=Edge("Made up.")),
    )  # fmt: skip
    for one in wrong:
        with pytest.raises(ValueError, match="^walk: "):
            check(one)


def test_changes_are_told() -> None:
    """Outcomes, errors and edges that are not as they were accepted; rounding is not told."""
    record = recorded()
    assert changes(record, record) == []
    first, *others = record.points
    for one, told in ((replace(first, checked=Checked(1.0, 1.0, 0.1 + 1e-9, True)), 0), (replace(first, checked=Checked(1.0, 1.0, 0.2, True)), 1),
                      (replace(first, outcome=MARKED), 1)):  # fmt: skip
        assert len(changes(record, replace(record, points=(one, *others)))) == told
    assert len(changes(record, replace(record, edge=EdgeFound(1.0, 1.03)))) == 1
    assert changes(None, record) == ["walk: new"]
    assert not differs(math.nan, math.nan) and differs(math.nan, 0.0) and differs(0.1, math.nan)


def test_what_a_run_is_and_one_that_was_killed() -> None:
    """Sound, wrong, or marked by itself; a run that died without the solver's word is garbage."""
    family, mark = a_walk(), SimpleNamespace(monitor="momentum", why="it drifted")
    for value, suspect, outcome in ((0.9, (), STABLE), (1.1, (), GARBAGE), (math.nan, (), GARBAGE), (1.1, (mark,), MARKED)):
        run: Any = SimpleNamespace(summary=SimpleNamespace(suspect=suspect))
        assert of_run(replace(family, check=lambda _, value=value: at_most(value, 1.0)), family.points[0], run, 0.0).outcome == outcome
    died = Outcome("scene", "", "failed", -9, "killed by signal 9", 1.0, "")
    for exit_status, outcome in ((-9, GARBAGE), (0, GARBAGE), (1, GARBAGE), (124, GARBAGE), (2, REFUSED), (3, FAILED)):
        assert of_failure(family.points[0], replace(died, exit_status=exit_status)).outcome == outcome
    assert of_failure(family.points[0], replace(died, exit_status=3, reason="")).outcome == GARBAGE


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


def grown_run(monkeypatch: pytest.MonkeyPatch, tip_Pa: float, opened_m: float) -> Any:
    """A run that ends at this net pressure at its tip, its mean opening grown by so much in a second."""
    p = np.array([2.1e6, lagging.CLOSING_PA + tip_Pa])
    outputs = [(0.1 * k, {"pressure_Pa": p, "opening_m": np.full(4, 1e-4 + 0.1 * k * opened_m)}) for k in range(11)]
    monkeypatch.setattr(lagging, "frames", lambda run, group: outputs)
    return SimpleNamespace(scene={"fluid": {"viscosity_Pa_s": 1.0}}, folder=Path("made"), summary=SimpleNamespace(steps=10))


def test_checks_refuse_what_is_off(monkeypatch: pytest.MonkeyPatch) -> None:
    """None, twice, the other sign, and what long steps make of it."""
    tip, opened = lagging.resolved(1.0), lagging.opened(1.0)
    assert lagging.tip_pressure(grown_run(monkeypatch, tip, opened)).holds and lagging.mean_opening(grown_run(monkeypatch, tip, opened)).holds
    for share in (0.0, 0.2, 0.9, 1.1, 2.0, -1.0):
        run = grown_run(monkeypatch, share * tip, share * opened)
        assert not lagging.tip_pressure(run).holds and not lagging.mean_opening(run).holds, share
