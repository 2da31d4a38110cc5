"""Runs the points of a family through the command line and says how each ended; what was run before is not run again."""

import json
import math
from pathlib import Path

from verification.harness import paths
from verification.harness import run as harness
from verification.harness.choose import claimed, folder_name
from verification.harness.load import OF_SPEEDS, LoadError, Run, load
from verification.harness.paths import ROOT
from verification.harness.run import Job, Outcome
from verification.harness.side_by_side import Tell
from verification.precision.measure import timed
from verification.stability.family import FAILED, GARBAGE, MARKED, REFUSED, STABLE, STRATA, Checked, Family, Point, bisected
from verification.stability.store import EdgeFound, PointFound, Record

RUNS = paths.RUNS / "atlas"
LIMIT_S = 120.0  # a run that takes longer is garbage: nobody knows what it would say
CPU = "cpu_s.json"
REASON_LENGTH = 400
BAD_INPUT, NUMERICS_FAILED = 2, 3


def folder_of(family: Family, point: Point | PointFound, runs: Path = RUNS) -> Path:
    """Where a point's run is."""
    return runs / family.name / folder_name(point.label)


def make(family: Family, point: Point, runs: Path = RUNS) -> tuple[Outcome, float]:
    """A point's run and its CPU time (s), made unless it is there; another process that wants the same one waits for it."""
    folder = folder_of(family, point, runs)
    with claimed(folder):
        outcome, (_, cpu_s) = timed(lambda: harness.run(Job(point.scene, point.variant, folder, point.settings), limit_s=LIMIT_S))
        if outcome.skipped and (folder / CPU).is_file():
            return outcome, float(json.loads((folder / CPU).read_text(encoding="utf-8")))
        (folder / CPU).write_text(json.dumps(round(cpu_s, 4)), encoding="utf-8")
    return outcome, cpu_s


def marks_of(run: Run, family: Family) -> str:
    """Why a completed run is not to be trusted by its own words; nothing where it says nothing."""
    suspect = run.summary.raw.get("suspect") or []
    words = [f"suspect {item['monitor']}: {item['why']}" for item in suspect if item["monitor"] != OF_SPEEDS]
    return "; ".join(filter(None, [*words, family.flag(run)]))


def short(text: str) -> str:
    """A text in a line that is not too long, without the folder where it was run."""
    return " ".join(text.split()).replace(f"{ROOT}/", "")[:REASON_LENGTH]


def of_failure(point: Point, outcome: Outcome, cpu_s: float) -> PointFound:
    """What a run without a result is: refused, failed, or something that must not be (killed, crashed, without a reason)."""
    known = {BAD_INPUT: REFUSED, NUMERICS_FAILED: FAILED}.get(outcome.exit_status, GARBAGE)
    how = short(outcome.reason)
    return PointFound(point.label, point.value, known if how else GARBAGE, None, how or "ended without a reason", round(cpu_s, 2))


def of_run(family: Family, point: Point, run: Run, cpu_s: float) -> PointFound:
    """What a completed run is."""
    try:
        checked, reason = family.check(run), ""
    except LoadError as error:
        checked, reason = Checked(math.nan, math.nan, math.nan, False), short(str(error))
    marks = marks_of(run, family)
    outcome = MARKED if marks else STABLE if checked.holds else GARBAGE
    return PointFound(point.label, point.value, outcome, checked, short(marks or reason), round(cpu_s, 2))


def found(family: Family, point: Point, runs: Path = RUNS) -> PointFound:
    """How a point ends."""
    if point.program != STRATA:
        checked = family.ways[point.program](point)
        return PointFound(point.label, point.value, STABLE if checked.holds else GARBAGE, checked, "")
    outcome, cpu_s = make(family, point, runs)
    if not outcome.ok:
        return of_failure(point, outcome, cpu_s)
    try:
        return of_run(family, point, load(folder_of(family, point, runs)), cpu_s)
    except LoadError as error:
        return PointFound(point.label, point.value, GARBAGE, None, short(str(error)), round(cpu_s, 2))


def edge_of(family: Family, points: tuple[PointFound, ...], runs: Path = RUNS, tell: Tell = lambda _: None) -> EdgeFound | None:
    """The family's edge, predicted and measured."""
    edge = family.edge
    if edge is None:
        return None
    predicted = edge.predicted() if edge.predicted is not None else None
    if edge.read is not None:
        made = {point.label: load(folder_of(family, point, runs)) for point in points if point.checked is not None}
        return EdgeFound(predicted, edge.read(made))
    at = edge.at
    assert at is not None

    def sound(value: float) -> bool:
        one = found(family, at(value), runs)
        tell(f"{family.name}: edge at {value:.5g}? {one.outcome}")
        return one.checked is not None and one.checked.holds if edge.by_check else one.outcome in family.before

    good, bad = bisected(sound, *edge.bracket, edge.resolution)
    return EdgeFound(predicted, 0.5 * (good + bad), good, bad)


def version_of(family: Family, runs: Path) -> str:
    """The version that the family's runs name; empty where none completed."""
    for point in family.points:
        try:
            content = json.loads((folder_of(family, point, runs) / "summary.json").read_text(encoding="utf-8"))
            return str(content["version"])
        except (OSError, ValueError, KeyError):
            continue
    return ""


def walk(family: Family, smoke: bool = False, runs: Path = RUNS, tell: Tell = lambda _: None) -> Record:
    """All points of a family (of a smoke run its smoke points alone, and no edge), and its edge."""
    points = []
    for point in family.points:
        if smoke and not point.smoke:
            continue
        one = found(family, point, runs)
        error = f", error {one.checked.error:.3g}" if one.checked is not None else ""
        tell(f"{family.name}: {point.label}: {one.outcome}{error} {one.reason[:140]}")
        points.append(one)
    edge = None if smoke else edge_of(family, tuple(points), runs, tell)
    return Record(family.name, version_of(family, runs), edge, tuple(points))
