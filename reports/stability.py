"""The page of the stability atlas: families and their records turned into rows, words and figures, and what the front page says."""

import math
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from reports.charts.stability import draw_edges, draw_part
from reports.figures import Figure, make, told_of, write_page
from reports.shown import Shown
from reports.words import NONE, general, minus, span
from verification.stability import store
from verification.stability.families import families
from verification.stability.family import FAILED, GARBAGE, MARKED, OUTCOMES, REFUSED, STABLE, Family
from verification.stability.judge import problems
from verification.stability.store import EdgeFound, PointFound, Record

NAME = "stability.html"
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
    def edge(self) -> EdgeFound:
        """Its edge as found, without numbers where there is none."""
        return (self.record.edge if self.record is not None else None) or EdgeFound(None, None)

    @property
    def parameter(self) -> str:
        """The walked parameter with its unit."""
        unit = self.family.parameter.unit
        return f"{self.family.parameter.name} ({unit})" if unit else self.family.parameter.name

    @property
    def heading(self) -> str:
        """Its title without that of its section."""
        return self.family.title.split(": ", 1)[-1]


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

    @property
    def points(self) -> list[PointFound]:
        """All points of its families."""
        return [point for walk in self.walks for point in walk.points]

    def edges(self, key: str) -> list[float]:
        """A number of all edges that have it: "predicted", "measured" or "difference"."""
        return [value for walk in self.walks if (value := getattr(walk.edge, key)) is not None]


def parts(folder: Path = store.RECORDS, known: dict[str, Family] | None = None) -> tuple[Part, ...]:
    """All families with their records, by section in the order of the catalogue."""
    sections: dict[str, list[Walk]] = {}
    for name, family in (families() if known is None else known).items():
        record = store.read(name, folder)
        sections.setdefault(family.section or family.title, []).append(Walk(family, record, tuple(problems(family, record))))
    return tuple(Part(title, tuple(walks)) for title, walks in sections.items())


def percent(value: float | None) -> str:
    """A signed share in per cent."""
    return NONE if value is None else minus(f"{100.0 * value:+.1f} %")


def outcomes_of(points: Sequence[PointFound]) -> str:
    """How many points ended how."""
    tally = Counter(point.outcome for point in points)
    return ", ".join(f"{tally[name]} {name}" for name in OUTCOMES if tally[name])


def beyond_words(walks: Sequence[Walk]) -> str:
    """What strata does beyond the edge."""
    names = {name for walk in walks for name in walk.family.beyond}
    return "stable by construction" if names == {STABLE} else " or ".join(OUTCOME_WORDS[name] for name in OUTCOMES if name in names)


def verdict(wrong: Sequence[str]) -> tuple[str, str]:
    """A verdict and its kind."""
    return ("as it is to be", "yes") if not wrong else (f"{len(wrong)} NOT as they are to be", "no")


def first_row(part: Part) -> dict[str, str]:
    """A section's row of the first table."""
    words, kind = verdict(part.wrong)
    return {
        "anchor": part.anchor, "title": part.title, "walks": str(len(part.walks)),
        "parameter": "; ".join(dict.fromkeys(walk.parameter for walk in part.walks)), "predicted": span(part.edges("predicted")),
        "measured": span(part.edges("measured")), "difference": percent(max(part.edges("difference"), key=abs, default=None)),
        "beyond": beyond_words(part.walks), "points": outcomes_of(part.points), "verdict": words, "kind": kind,
    }


def edge_row(walk: Walk) -> list[str]:
    """A family's row of its section's table."""
    edge = walk.edge
    return [walk.family.title, walk.parameter, general(edge.predicted), general(edge.measured), percent(edge.difference), beyond_words([walk]),
            outcomes_of(walk.points), verdict(walk.wrong)[0]]


def point_row(point: PointFound) -> list[str]:
    """A point of a family in words."""
    checked = point.checked
    found = [NONE] * 3 if checked is None else [general(checked.value), general(checked.reference), general(checked.error, 3)]
    words = "; ".join(filter(None, [checked.words if checked is not None else "", point.reason]))
    return [point.label, general(point.value), point.outcome, *found, words, f"{point.cpu_s:.2g}"]


def walk_panel(walk: Walk) -> Shown:
    """A family's panel: the checked error (None where there is no finite one) over the walked parameter; edges predicted and measured."""
    errors = [point.checked.error if point.checked is not None else None for point in walk.points]
    errors = [error if error is not None and math.isfinite(error) else None for error in errors]
    sizes = [abs(error) for error in errors if error]
    y_log = bool(sizes) and max(sizes) > 20.0 * min(sizes)
    if y_log:  # a logarithmic axis shows sizes above 1e-16
        errors = [None if error is None else max(abs(error), 1e-16) for error in errors]
    dots = [Shown(x=point.value, y=error, outcome=point.outcome) for point, error in zip(walk.points, errors)]
    return Shown(heading=walk.heading, dots=dots, predicted=walk.edge.predicted, measured=walk.edge.measured, x_name=walk.parameter,
                 y_name=walk.family.check_name, x_log=walk.family.parameter.log, y_log=y_log)


def edges_shown(part: Part) -> Shown | None:
    """The edges of a section with more families than are drawn one by one; None where there are few."""
    rows = [(walk.heading, walk.edge.predicted, walk.edge.measured) for walk in part.walks
            if walk.edge.predicted is not None and walk.edge.measured is not None]
    if len(part.walks) <= MANY or len(rows) < 2:
        return None
    worst = max(abs(measured / predicted - 1.0) for _, predicted, measured in rows)
    return Shown(title=f"{len(rows)} edges measured within {100.0 * worst:.1f} % of what theory says", x_name=part.walks[0].parameter, rows=rows)


def finding(part: Part) -> str:
    """What a section's walks show, in a sentence."""
    off, points = part.edges("difference"), part.points
    lead = f"edge within {100.0 * max(map(abs, off)):.1f} % of theory, " if off else ""
    garbage = sum(point.outcome == GARBAGE for point in points)
    rest = f"{garbage} POINTS ARE GARBAGE" if garbage else f"no garbage in {len(points)} points ({outcomes_of(points)})"
    return f"{part.title}: {lead}{rest}"


def headline(every: Sequence[Part]) -> str:
    """What the whole atlas says, in a sentence."""
    walks, points = [walk for part in every for walk in part.walks], [point for part in every for point in part.points]
    off = [size for part in every for size in part.edges("difference")]
    wrong = sum(bool(walk.wrong) for walk in walks)
    said = f"{len(every)} known failures in {len(walks)} walks and {len(points)} points ({outcomes_of(points)})"
    theory = f"; {len(off)} edges that theory gives, measured within {100.0 * max(map(abs, off)):.1f} %" if off else ""
    return said + theory + (f"; {wrong} walks are NOT as they are to be" if wrong else "; all as they are to be")


def figures_of(part: Part) -> list[Figure]:
    """The figures of a section: many edges side by side, and the first walks one by one."""
    edges = edges_shown(part)
    made = [] if edges is None else [Figure(f"stability_{part.anchor}_edges", edges, draw_edges, "stability_edges")]
    walks = [walk for walk in part.walks if walk.record is not None]
    panels = [walk_panel(walk) for walk in walks[:: max(1, -(-len(walks) // MANY))]]
    return made + ([Figure(f"stability_{part.anchor}", Shown(title=finding(part), panels=panels), draw_part, "stability")] if panels else [])


def content_of(part: Part, pictures: list[Shown]) -> dict[str, Any]:
    """What the template needs of a section."""
    first = part.walks[0].family
    return {
        "anchor": part.anchor, "title": part.title, "about": first.about or first.says, "beyond": beyond_words(part.walks),
        "sources": list(dict.fromkeys(walk.family.edge.source for walk in part.walks if walk.family.edge is not None)),
        "remarks": list(dict.fromkeys(walk.family.remark for walk in part.walks if walk.family.remark)),
        "says": list(dict.fromkeys(walk.family.says for walk in part.walks)) if first.about else [],
        "wrong": list(part.wrong), "figures": pictures, "rows": [edge_row(walk) for walk in part.walks],
        "walks": [{"title": walk.family.title, "check": walk.family.check_name, "points": list(map(point_row, walk.points))} for walk in part.walks],
    }


def write_stability(out: Path, folder: Path = store.RECORDS) -> Shown:
    """Write the page below a page's folder; whatever is wrong with the records is told, not raised."""
    return told_of(NAME, lambda: _write(out, folder), "The stability atlas could not be shown")


def _write(out: Path, folder: Path) -> Shown:
    """The page with every family and every point."""
    every = parts(folder)
    records = [walk.record for part in every for walk in part.walks if walk.record is not None]
    if not records:
        return Shown(lack="The stability atlas has not been walked: ci/atlas --accept.")
    pictures = [[make(figure, out) for figure in figures_of(part)] for part in every]
    versions = dict.fromkeys(record.version for record in records if record.version)
    write_page(out, NAME, {"headline": headline(every), "first": [first_row(part) for part in every], "versions": ", ".join(versions),
                           "parts": [content_of(part, own) for part, own in zip(every, pictures)]})
    return Shown(words=headline(every), defect="\n".join(made.defect for own in pictures for made in own if made.defect))
