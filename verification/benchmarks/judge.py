"""What figures say: now against the last record of the same machine, and against the marks."""

import math
from collections.abc import Sequence
from dataclasses import asdict, dataclass

from verification.benchmarks.figure import NONE, Figure, exponent
from verification.benchmarks.records import Record, check_machine

# A figure is slower where its calibrated cost is more than this times the last record's, and faster below its inverse. On an
# idle machine medians of five repetitions keep within a few per cent; virtual machines drift by a tenth.
BAND = 1.25
FARTHER = 2.0  # times the round trip between processors: figures on several threads are then those of another machine
ENOUGH = 5  # repetitions on both sides; of fewer a median is no median

SLOWER, FASTER, SAME, NEW, GONE, BROKEN, UNJUDGED = "slower", "faster", "same", "new", "gone", "broken", "not judged"
BAD = (SLOWER, GONE, BROKEN)


@dataclass(frozen=True)
class Line:
    """A figure now beside then: ratio of calibrated costs (above 1: slower), the verdict and why."""

    name: str
    ratio: float
    verdict: str
    why: str = ""


def _cost(figure: Figure) -> float:
    """What is compared: the calibrated cost, or the plain one of what no kernel calibrates."""
    return figure.median if figure.bound == NONE else figure.calibrated


def compare_figure(now: Figure | None, then: Figure | None) -> Line:
    """The verdict on one figure."""
    if now is None:
        return Line(then.name if then else "", math.nan, GONE, "it was recorded before and was not measured now")
    wrong = now.wrong()
    if wrong:
        before = now.problem and then is not None and then.problem
        return Line(now.name, math.nan, UNJUDGED if before else BROKEN, f"as when it was recorded: {wrong}" if before else wrong)
    if then is None or then.wrong():
        return Line(now.name, math.nan, NEW, "nothing to compare with" if then is None else "it failed when it was recorded")
    ratio = _cost(now) / _cost(then)
    if not math.isfinite(ratio) or ratio <= 0.0:
        return Line(now.name, ratio, BROKEN, "it has no calibration beside it")
    few = min(len(now.values), len(then.values))
    if now.bound != NONE and few < ENOUGH:
        return Line(now.name, ratio, UNJUDGED, f"{few} repetitions are too few")
    apart = now.distance / then.distance
    if not 1.0 / FARTHER < apart < FARTHER and math.isfinite(apart):
        why = f"processors are {1e9 * now.distance:.0f} ns apart and back, {1e9 * then.distance:.0f} when it was recorded"
        return Line(now.name, ratio, UNJUDGED, why)
    if ratio > BAND:
        return Line(now.name, ratio, SLOWER, f"{ratio:.2f} times the recorded cost, more than {BAND:g}")
    return Line(now.name, ratio, FASTER if ratio < 1.0 / BAND else SAME)


def compare(now: Record, then: Record) -> list[Line]:
    """A line a figure; raises OtherMachine where the records are not of the same machine."""
    check_machine(now.machine, then.machine)
    lines = [compare_figure(figure, then.figure(figure.name)) for figure in now.figures]
    if not now.part:
        here = {figure.name for figure in now.figures}
        lines += [compare_figure(None, figure) for figure in then.figures if figure.name not in here]
    return lines


@dataclass(frozen=True)
class Mark:
    """Something that must be reached on two cores: what, the value wanted and found, and whether that is at least or at most."""

    what: str
    wanted: float
    found: float
    unit: str
    at_least: bool = False
    note: str = ""

    @property
    def reached(self) -> bool:
        """Whether it is; never where nothing was found."""
        if not math.isfinite(self.found) or self.found <= 0.0:
            return False
        return self.found >= self.wanted if self.at_least else self.found <= self.wanted


def as_plain(found: Sequence[Mark]) -> tuple[dict[str, object], ...]:
    """Marks as tables, with whether each is reached."""
    return tuple({**asdict(mark), "reached": mark.reached} for mark in found)


def sizes(record: Record, kinematics: str) -> list[tuple[float, float]]:
    """Points of the explicit block at one thread, and seconds a whole step, in order of size."""
    found = {}
    for figure in record.figures:
        parts = figure.name.split("/")
        own = parts[1:6] == [kinematics, "bspline2", "flip", "fast", "points4"] and parts[-1] == "threads1"
        if parts[0] in ("step", "scaling") and own and figure.values:
            found[float(figure.about["particles"])] = figure.median * float(figure.about["particles"])
    return sorted(found.items())


def best_crack(record: Record, error: float) -> Figure | None:
    """The fastest setting whose K_I of the crack in the block is within a relative error."""
    good = [figure for figure in record.figures if figure.name.startswith("crack/") and figure.values
            and abs(float(figure.about.get("error", math.inf))) <= error]  # fmt: skip
    return min(good, key=lambda figure: figure.median, default=None)


def _rate(figure: Figure | None) -> float:
    """Millions of particle-steps a second."""
    return 1e-6 / figure.median if figure is not None and figure.values and figure.median > 0.0 else math.nan


def _speed(record: Record, name: str, what: str, wanted: float) -> list[Mark]:
    """The mark on a figure's particle-steps, with how far apart its processors were."""
    figure = record.figure(name)
    if figure is None:
        return []
    apart = f"processors {1e9 * figure.distance:.0f} ns apart and back" if math.isfinite(figure.distance) else ""
    return [Mark(what, wanted, _rate(figure), "million/s", True, apart)]


def _exponent(what: str, wanted: float, found: Sequence[tuple[float, float]]) -> list[Mark]:
    """The mark on the exponent of cost against points."""
    if len(found) < 3:
        return []
    reach = f"{found[0][0]:.3g} to {found[-1][0]:.3g} points"
    return [Mark(what, wanted, exponent(*zip(*found)), "", False, reach)]


def _batch(record: Record, name: str, limit_s: float) -> list[Mark]:
    """The mark on the time of a batch of experiments."""
    figure = record.figure(f"experiments/{name}")
    return [] if figure is None else [Mark(f"all experiments, {name}", limit_s, figure.median, "s", note=figure.problem)]


def marks(record: Record) -> list[Mark]:
    """All marks of which the record has what they are about."""
    block = "bspline2/flip/fast/points4"
    rate, total = "particle-steps of `updated`", "particle-steps of `total`, equivalent"
    step, beyond = f"step/{{}}/{block}/cells80/threads{{}}", f"scaling/updated/{block}/cells320/threads"  # beyond the caches
    drop = _rate(record.figure(f"{beyond}1")) / _rate(record.figure(step.format("updated", 1)))
    whole = sorted((float(figure.about["particles"]), figure.median) for figure in record.figures
                   if figure.name.startswith("whole/quasistatic/") and figure.values)  # fmt: skip
    best, cracks = best_crack(record, 1e-3), any(figure.name.startswith("crack/") for figure in record.figures)
    found = best.median if best else math.nan
    return [
        *_speed(record, step.format("updated", 1), f"{rate}, 1 thread", 60.0),
        *_speed(record, step.format("updated", 2), f"{rate}, 2 threads", 110.0),
        *_speed(record, f"{beyond}1", "at 320 x 320 cells, 80 % of the mark, 1 thread", 48.0),
        *_speed(record, f"{beyond}2", "at 320 x 320 cells, 80 % of the mark, 2 threads", 88.0),
        *([Mark("at 320 x 320 cells, of what is found at 80 x 80", 0.8, drop, "", True)] if math.isfinite(drop) else []),
        *_speed(record, step.format("total", 1), f"{total}, 1 thread", 300.0),
        *_exponent("exponent of a step's cost, `updated`", 1.05, sizes(record, "updated")),
        *_exponent("exponent of a step's cost, `total`", 1.05, sizes(record, "total")),
        *_exponent("exponent of a run without inertia", 1.5, whole),
        *([Mark("K_I of the crack in the block to 0.1 %", 0.1, found, "s", note=best.name if best else "")] if cracks else []),
        *_batch(record, "quasistatic/cell1m", 10.0), *_batch(record, "explicit/cell1m", 120.0), *_batch(record, "quasistatic/cell0.25m", 300.0),
    ]  # fmt: skip
