"""What the stability atlas found, as the page shows it: families and their records turned into rows, words and figures' data."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from verification.stability import store
from verification.stability.catalogue import families
from verification.stability.family import FAILED, GARBAGE, MARKED, OUTCOMES, REFUSED, STABLE, Family
from verification.stability.judge import problems
from verification.stability.store import EdgeFound, PointFound, Record

HOW_TO_MAKE = "ci/atlas --accept"
MANY = 6  # families of a section that are drawn one by one
OUTCOME_WORDS = {STABLE: "stable", MARKED: "marked", REFUSED: "refused (exit 2)", FAILED: "ended with its reason (exit 3)", GARBAGE: "GARBAGE"}


@dataclass(frozen=True)
class Walk:
    """A family with what was found of it and what is wrong with that."""

    family: Family
    record: Record | None
    wrong: tuple[str, ...]

    @property
    def points(self) -> tuple[PointFound, ...]:
        """Its points as found."""
        return self.record.points if self.record is not None else ()

    @property
    def edge(self) -> EdgeFound | None:
        """Its edge as found."""
        return self.record.edge if self.record is not None else None


@dataclass(frozen=True)
class Part:
    """Families of a section; the anchor is the first one's name."""

    title: str
    walks: tuple[Walk, ...]

    @property
    def anchor(self) -> str:
        """Where it is on the page."""
        return self.walks[0].family.name

    @property
    def wrong(self) -> tuple[str, ...]:
        """All that is wrong with its families."""
        return tuple(f"{walk.family.title}: {words}" for walk in self.walks for words in walk.wrong)


@dataclass(frozen=True)
class DotShown:
    """A point in a figure: the walked value, the checked error (None of a run without one), and its outcome."""

    x: float
    y: float | None
    outcome: str


@dataclass(frozen=True)
class WalkShown:
    """A panel: its dots, edge predicted and measured, names and scales of its axes."""

    heading: str
    dots: tuple[DotShown, ...]
    predicted: float | None
    measured: float | None
    x_name: str
    y_name: str
    x_log: bool
    y_log: bool


@dataclass(frozen=True)
class EdgesShown:
    """Edges of many families side by side: heading of each, predicted and measured."""

    title: str
    x_name: str
    rows: tuple[tuple[str, float, float], ...]


@dataclass(frozen=True)
class PartFigure:
    """The panels of a section under what they show."""

    title: str
    panels: tuple[WalkShown, ...]


def parts(folder: Path = store.RECORDS, known: dict[str, Family] | None = None) -> tuple[Part, ...]:
    """All families with their records, by section in the order of the catalogue."""
    every = families() if known is None else known
    walks = [Walk(family, store.read(name, folder), tuple(problems(family, store.read(name, folder)))) for name, family in every.items()]
    titles = dict.fromkeys(walk.family.section or walk.family.title for walk in walks)
    return tuple(Part(title, tuple(walk for walk in walks if (walk.family.section or walk.family.title) == title)) for title in titles)


def number(value: float | None, digits: int = 4) -> str:
    """A number for a table; a line for none."""
    return "–" if value is None or not math.isfinite(value) else f"{value:.{digits}g}".replace("-", "−")


def percent(value: float | None) -> str:
    """A signed share in per cent."""
    return "–" if value is None else f"{100.0 * value:+.1f} %".replace("-", "−")


def outcomes_of(points: Sequence[PointFound]) -> str:
    """How many points ended how."""
    counted = Counter(point.outcome for point in points)
    return ", ".join(f"{counted[name]} {name}" for name in OUTCOMES if counted[name])


def beyond_words(walks: Sequence[Walk]) -> str:
    """What strata does beyond the edge."""
    names = dict.fromkeys(name for walk in walks for name in walk.family.beyond)
    words = " or ".join(OUTCOME_WORDS[name] for name in OUTCOMES if name in names)
    return "stable by construction" if list(names) == [STABLE] else words


def span(values: Sequence[float], digits: int = 3) -> str:
    """A number, or from the least to the largest."""
    if not values:
        return "–"
    low, high = number(min(values), digits), number(max(values), digits)
    return low if low == high else f"{low} to {high}"


def verdict(wrong: Sequence[str]) -> tuple[str, str]:
    """A verdict and its kind."""
    return ("as it is to be", "yes") if not wrong else (f"{len(wrong)} NOT as they are to be", "no")


def first_row(part: Part) -> dict[str, str]:
    """A section's row of the first table."""
    edges = [walk.edge for walk in part.walks if walk.edge is not None]
    predicted = [edge.predicted for edge in edges if edge.predicted is not None]
    measured = [edge.measured for edge in edges if edge.measured is not None]
    off = [edge.difference for edge in edges if edge.difference is not None]
    worst = max(off, key=abs, default=None)
    words, kind = verdict(part.wrong)
    walked = dict.fromkeys(unit_of(walk.family) for walk in part.walks)
    return {
        "anchor": part.anchor, "title": part.title, "walks": str(len(part.walks)), "parameter": "; ".join(walked),
        "predicted": span(predicted), "measured": span(measured), "difference": percent(worst),
        "beyond": beyond_words(part.walks), "points": outcomes_of([point for walk in part.walks for point in walk.points]),
        "verdict": words, "kind": kind,
    }  # fmt: skip


def unit_of(family: Family) -> str:
    """The walked parameter with its unit."""
    unit = family.parameter.unit
    return f"{family.parameter.name} ({unit})" if unit else family.parameter.name


def edge_row(walk: Walk) -> list[str]:
    """A family's row of its section's table."""
    edge = walk.edge or EdgeFound(None, None)
    return [walk.family.title, unit_of(walk.family), number(edge.predicted), number(edge.measured), percent(edge.difference),
            beyond_words([walk]), outcomes_of(walk.points), verdict(walk.wrong)[0]]  # fmt: skip


def point_rows(walk: Walk) -> list[list[str]]:
    """All points of a family in words."""
    rows = []
    for point in walk.points:
        checked = point.checked
        found = [number(checked.value), number(checked.reference), number(checked.error, 3)] if checked is not None else ["–", "–", "–"]
        words = "; ".join(filter(None, [checked.words if checked is not None else "", point.reason]))
        rows.append([point.label, number(point.value), point.outcome, *found, words, f"{point.cpu_s:.2g}"])
    return rows


def shown(walk: Walk) -> WalkShown:
    """A family's panel."""
    dots = tuple(DotShown(point.value, finite_error(point), point.outcome) for point in walk.points)
    sizes = [abs(dot.y) for dot in dots if dot.y]
    edge = walk.edge or EdgeFound(None, None)
    y_log = bool(sizes) and max(sizes) > 20.0 * min(sizes)
    own = replaced(dots) if y_log else dots
    heading = walk.family.title.split(": ", 1)[-1]
    return WalkShown(heading, own, edge.predicted, edge.measured, unit_of(walk.family), walk.family.check_name,
                     walk.family.parameter.log, y_log)  # fmt: skip


def replaced(dots: tuple[DotShown, ...]) -> tuple[DotShown, ...]:
    """Sizes of the errors, of which a logarithmic axis can show those above 1e-16."""
    return tuple(DotShown(dot.x, None if dot.y is None else max(abs(dot.y), 1e-16), dot.outcome) for dot in dots)


def finite_error(point: PointFound) -> float | None:
    """The checked error, None where there is no finite one."""
    error = point.checked.error if point.checked is not None else None
    return error if error is not None and math.isfinite(error) else None


def edges_shown(part: Part) -> EdgesShown | None:
    """The edges of a section with more families than are drawn one by one; None where there are few."""
    rows = [(walk.family.title.split(": ", 1)[-1], walk.edge.predicted, walk.edge.measured) for walk in part.walks
            if walk.edge is not None and walk.edge.predicted is not None and walk.edge.measured is not None]  # fmt: skip
    if len(part.walks) <= MANY or len(rows) < 2:
        return None
    worst = max(abs(measured / predicted - 1.0) for _, predicted, measured in rows)
    title = f"{len(rows)} edges measured within {100.0 * worst:.1f} % of what theory says"
    return EdgesShown(title, unit_of(part.walks[0].family), tuple(rows))


def finding(part: Part) -> str:
    """What a section's walks show, in a sentence."""
    off = [walk.edge.difference for walk in part.walks if walk.edge is not None and walk.edge.difference is not None]
    points = [point for walk in part.walks for point in walk.points]
    lead = f"edge within {100.0 * max(map(abs, off)):.1f} % of theory, " if off else ""
    garbage = sum(point.outcome == GARBAGE for point in points)
    rest = f"{garbage} POINTS ARE GARBAGE" if garbage else f"no garbage in {len(points)} points ({outcomes_of(points)})"
    return f"{part.title}: {lead}{rest}"


def headline(every: Sequence[Part]) -> str:
    """What the whole atlas says, in a sentence."""
    walks = [walk for part in every for walk in part.walks]
    points = [point for walk in walks for point in walk.points]
    off = [walk.edge.difference for walk in walks if walk.edge is not None and walk.edge.difference is not None]
    wrong = sum(bool(walk.wrong) for walk in walks)
    said = f"{len(every)} known failures in {len(walks)} walks and {len(points)} points ({outcomes_of(points)})"
    theory = f"; {len(off)} edges that theory gives, measured within {100.0 * max(map(abs, off)):.1f} %" if off else ""
    return said + theory + (f"; {wrong} walks are NOT as they are to be" if wrong else "; all as they are to be")
