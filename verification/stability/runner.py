"""Runs the points of a family through the command line and says how each ended; what was run before is not run again."""

import json
import math
from pathlib import Path

from verification.harness import paths
from verification.harness.choose import claimed, folder_name
from verification.harness.load import OF_SPEEDS, LoadError, Run, load
from verification.harness.paths import ROOT
from verification.harness.plan import make
from verification.harness.run import Job, Outcome
from verification.harness.side_by_side import Tell
from verification.stability.family import FAILED, GARBAGE, MARKED, REFUSED, STABLE, Checked, Family, Point, bisected
from verification.stability.store import EdgeFound, PointFound, Record

RUNS = paths.RUNS / "atlas"
LIMIT_S = 120.0  # a run that takes longer is garbage: nobody knows what it would say
REASON_LENGTH = 400
BAD_INPUT, NUMERICS_FAILED = 2, 3


def folder_of(family: Family, point: Point | PointFound, runs: Path = RUNS) -> Path:
    """Where a point's run is."""
    return runs / family.name / folder_name(point.label)


def short(text: str) -> str:
    """A text in a line that is not too long, without the folder where it was run."""
    return " ".join(text.split()).replace(f"{ROOT}/", "")[:REASON_LENGTH]


def of_failure(point: Point, outcome: Outcome) -> PointFound:
    """What a run without a result is: refused, failed, or something that must not be (killed, crashed, without a reason)."""
    known = {BAD_INPUT: REFUSED, NUMERICS_FAILED: FAILED}.get(outcome.exit_status, GARBAGE)
    how = short(outcome.reason)
    return PointFound(point.label, point.value, known if how else GARBAGE, None, how or "ended without a reason", round(outcome.cpu_s, 2))


def of_run(family: Family, point: Point, run: Run, cpu_s: float) -> PointFound:
    """What a completed run is: marked where its own words, or the family's flag, say that it is not to be trusted."""
    try:
        checked, reason = family.check(run), ""
    except LoadError as error:
        checked, reason = Checked(math.nan, math.nan, math.nan, False), str(error)
    words = [f"suspect {mark.monitor}: {mark.why}" for mark in run.summary.suspect if mark.monitor != OF_SPEEDS]
    marks = "; ".join(filter(None, [*words, family.flag(run)]))
    outcome = MARKED if marks else STABLE if checked.holds else GARBAGE
    return PointFound(point.label, point.value, outcome, checked, short(marks or reason), round(cpu_s, 2))


def found(family: Family, point: Point, runs: Path = RUNS) -> PointFound:
    """How a point ends; another process that wants the same run waits for it."""
    folder = folder_of(family, point, runs)
    with claimed(folder):
        outcome, run = make(Job(point.scene, point.variant, folder, point.settings), limit_s=LIMIT_S)
    return of_run(family, point, run, outcome.cpu_s) if outcome.ok and run is not None else of_failure(point, outcome)


def edge_of(family: Family, points: tuple[PointFound, ...], runs: Path = RUNS, tell: Tell = lambda _: None) -> EdgeFound | None:
    """The family's edge, predicted and measured."""
    edge = family.edge
    if edge is None:
        return None
    predicted, at = edge.predicted() if edge.predicted is not None else None, edge.at
    if edge.read is not None:
        return EdgeFound(predicted, edge.read({point.label: load(folder_of(family, point, runs)) for point in points if point.checked is not None}))
    assert at is not None

    def sound(value: float) -> bool:
        one = found(family, at(value), runs)
        tell(f"{family.name}: edge at {value:.5g}? {one.outcome}")
        return one.checked is not None and one.checked.holds if edge.by_check else one.outcome in family.before

    good, bad = bisected(sound, *edge.bracket, edge.resolution)
    return EdgeFound(predicted, 0.5 * (good + bad), good, bad)


def walk(family: Family, smoke: bool = False, runs: Path = RUNS, tell: Tell = lambda _: None) -> Record:
    """All points of a family (of a smoke run its smoke points alone, and no edge), and its edge."""
    points = []
    for point in (point for point in family.points if point.smoke or not smoke):
        one = found(family, point, runs)
        error = f", error {one.checked.error:.3g}" if one.checked is not None else ""
        tell(f"{family.name}: {point.label}: {one.outcome}{error} {one.reason[:140]}")
        points.append(one)
    edge = None if smoke else edge_of(family, tuple(points), runs, tell)
    written = [path for point in family.points if (path := folder_of(family, point, runs) / "summary.json").is_file()]
    version = str(json.loads(written[0].read_text(encoding="utf-8"))["version"]) if written else ""
    return Record(family.name, version, edge, tuple(points))
