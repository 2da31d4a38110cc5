"""The atlas' judge on made-up families: what it must refuse."""

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from verification.harness.run import Outcome
from verification.stability.families import check
from verification.stability.family import (
    FAILED, GARBAGE, MARKED, REFUSED, STABLE, Checked, Edge, Family, Parameter, Point, at_most, bisected, close,
)  # fmt: skip
from verification.stability.judge import changes, differs, problems
from verification.stability.runner import of_failure, of_run
from verification.stability.store import EdgeFound, PointFound, Record

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
