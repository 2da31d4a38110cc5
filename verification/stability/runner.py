"""Runs the points of a family through the command line and says how each ended (what was run before is not run again), keeps what was found as
verification/stability/records/FAMILY.json (written by ci/atlas --accept, read by page and tests), and judges it: no garbage, the edge where theory says, and
beyond it what the family declares."""

import json
import math
from dataclasses import dataclass, replace
from pathlib import Path

from verification.harness import paths, store
from verification.harness.command import folder_name
from verification.harness.load import OF_SPEEDS, LoadError, Run, load
from verification.harness.paths import ROOT
from verification.harness.run import Job, Outcome, Tell, claimed, make
from verification.stability.family import FAILED, GARBAGE, MARKED, REFUSED, STABLE, Checked, Family, Point, bisected

RECORDS = Path(__file__).resolve().parent / "records"


@dataclass(frozen=True)
class PointFound:
    """How a point ended: outcome, what the check found of a completed run, why (of one that is not stable), and its CPU time (s)."""

    label: str
    value: float
    outcome: str
    checked: Checked | None = None
    reason: str = ""
    cpu_s: float = 0.0


@dataclass(frozen=True)
class EdgeFound:
    """The edge of a family: as predicted, as measured, and the last sound and first unsound value that were tried."""

    predicted: float | None
    measured: float | None
    sound: float | None = None
    unsound: float | None = None

    @property
    def difference(self) -> float | None:
        """Measured edge over predicted one less 1; None where one of them is not known."""
        return None if self.predicted is None or self.measured is None else self.measured / self.predicted - 1.0


@dataclass(frozen=True)
class Record:
    """All that was found of a family, by which version of strata."""

    family: str
    version: str
    edge: EdgeFound | None
    points: tuple[PointFound, ...]

    def point(self, label: str) -> PointFound | None:
        """The point of a label."""
        return next((point for point in self.points if point.label == label), None)


def read(family: str, folder: Path = RECORDS) -> Record | None:
    """A family's record; None where there is none. Raises ValueError for a file that cannot be understood."""
    return store.read(Record, folder / f"{family}.json")


def write(record: Record, folder: Path = RECORDS) -> Path:
    """Write a family's record, a point a line, what checks found to seven digits."""
    points = tuple(replace(point, checked=point.checked and point.checked.rounded()) for point in record.points)
    return store.write(replace(record, points=points), folder / f"{record.family}.json", ("edge", "points"))


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


def side(family: Family, point: Point, record: Record) -> bool | None:
    """Whether a point is beyond the family's edge; None where it is so near (the edge's tolerance, or between its bounds) that it may be either.
    Without an edge all points are beyond: what is declared must hold everywhere."""
    if point.beyond is not None:
        return point.beyond
    if family.edge is None or record.edge is None:
        return True
    place = record.edge.measured if record.edge.predicted is None else record.edge.predicted
    if place is None:
        return None
    if abs(point.value - place) <= family.edge.tolerance * abs(place):
        return None
    return (point.value > place) == family.edge.unsound_above


def problem_of_point(family: Family, point: Point, record: Record) -> str:
    """What is wrong with a point's outcome, or nothing."""
    found = record.point(point.label)
    if found is None:
        return "not measured"
    if found.outcome == GARBAGE:
        return f"garbage: {found.reason or (found.checked.words if found.checked else '')}"
    beyond = side(family, point, record)
    allowed = {True: family.beyond, False: family.before, None: (*family.before, *family.beyond)}[beyond]
    if found.outcome in allowed:
        return ""
    where = {True: "beyond the edge", False: "before the edge", None: "at the edge"}[beyond]
    return f"{found.outcome} {where}, where it is to be {' or '.join(allowed)}"


def problems_of_edge(family: Family, record: Record) -> list[str]:
    """What is wrong with a family's edge."""
    edge, found = family.edge, record.edge
    if edge is None:
        return [] if found is None else ["an edge was measured that the family does not have"]
    if found is None or found.measured is None:
        return ["the edge was not found"]
    if edge.predicted is not None and found.difference is None:
        return ["the predicted edge was not computed"]
    if found.difference is not None and not abs(found.difference) <= edge.tolerance:
        return [f"the edge is {100.0 * found.difference:+.1f} % off what theory says ({found.measured:.4g} for {found.predicted:.4g})"]
    sides = {side(family, point, record) for point in family.points}
    return [] if True in sides and len(sides) > 1 else ["no points on both sides of the edge"]


def problems(family: Family, record: Record | None, smoke: bool = False) -> list[str]:
    """All that is wrong with a family; of a smoke run its smoke points alone, by the edge of `record`."""
    if record is None:
        return ["never measured: ci/atlas --accept"]
    told = {point.label: problem_of_point(family, point, record) for point in family.points if point.smoke or not smoke}
    labels = {point.label for point in family.points}
    gone = [f"{found.label}: no point of the family any more" for found in record.points if found.label not in labels]
    return [f"{label}: {problem}" for label, problem in told.items() if problem] + gone + ([] if smoke else problems_of_edge(family, record))


def changes(before: Record | None, now: Record) -> list[str]:
    """What is not as it was accepted: outcomes, errors by more than a fifth, edges by more than a hundredth."""
    if before is None:
        return [f"{now.family}: new"]
    told = []
    for point in now.points:
        old = before.point(point.label)
        if old is None:
            told.append(f"{now.family}, {point.label}: new, {point.outcome}")
        elif old.outcome != point.outcome:
            told.append(f"{now.family}, {point.label}: {old.outcome} before, {point.outcome} now")
        elif old.checked and point.checked and differs(old.checked.error, point.checked.error):
            told.append(f"{now.family}, {point.label}: error {old.checked.error:.3g} before, {point.checked.error:.3g} now")
    if before.edge and now.edge and before.edge.measured and now.edge.measured:
        if abs(now.edge.measured / before.edge.measured - 1.0) > 0.01:
            told.append(f"{now.family}: edge {before.edge.measured:.5g} before, {now.edge.measured:.5g} now")
    return told


def differs(before: float, now: float, share: float = 0.2, floor: float = 1e-6) -> bool:
    """Whether an error has changed by more than a share of itself and more than rounding makes of it; nan stays nan where a run tells no number."""
    if math.isnan(before) and math.isnan(now):
        return False
    return not abs(now - before) <= share * abs(before) + floor
