"""The page of the stability atlas: families and their records turned into rows, words and figures, and what the front page says."""

import math
import re
from collections import Counter
from collections.abc import Iterable, Sequence
from pathlib import Path

from reports.charts.records import draw_edges, draw_part
from reports.figures import Figure, make, told_of, words_of, write_page
from reports.words import NONE, Shown, general, minus, span
from verification.stability import runner
from verification.stability.families import families
from verification.stability.family import FAILED, GARBAGE, MARKED, OUTCOMES, REFUSED, STABLE, Family
from verification.stability.runner import EdgeFound, PointFound, Record, problems

NAME = "stability.html"
MANY = 6  # families of a section that are drawn one by one
OUTCOME_WORDS = {STABLE: "stable", MARKED: "marked", REFUSED: "refused (exit 2)", FAILED: "ended with its reason (exit 3)", GARBAGE: "GARBAGE"}


def walk_of(family: Family, record: Record | None) -> Shown:
    """A family with what was found of it and what is wrong with that; its heading is its title without that of its section."""
    unit, edge = family.parameter.unit, record.edge if record is not None else None
    return Shown(family=family, record=record, title=family.title, heading=family.title.split(": ", 1)[-1], wrong=problems(family, record),
                 points=record.points if record is not None else (), edge=edge or EdgeFound(None, None),
                 parameter=f"{family.parameter.name} ({unit})" if unit else family.parameter.name)


def parts(folder: Path = runner.RECORDS) -> list[Shown]:
    """All families with their records, by section in the order of the catalogue; the anchor is the first one's name, edges are those that have
    a number under a name ("predicted", "measured" or "difference")."""
    sections: dict[str, list[Shown]] = {}
    for name, family in families().items():
        sections.setdefault(family.section or family.title, []).append(walk_of(family, runner.read(name, folder)))
    return [Shown(title=title, walks=walks, anchor=walks[0].family.name, points=[point for walk in walks for point in walk.points],
                  wrong=[f"{walk.title}: {words}" for walk in walks for words in walk.wrong],
                  edges={key: [value for walk in walks if (value := getattr(walk.edge, key)) is not None]
                         for key in ("predicted", "measured", "difference")})
            for title, walks in sections.items()]


def percent(value: float | None) -> str:
    """A signed share in per cent."""
    return NONE if value is None else minus(f"{100.0 * value:+.1f} %")


def outcomes_of(points: Iterable[PointFound]) -> str:
    """How many points ended how."""
    tally = Counter(point.outcome for point in points)
    return ", ".join(f"{tally[name]} {name}" for name in OUTCOMES if tally[name])


def row_of(what: str, walks: Sequence[Shown], numbers: tuple[str, str, str]) -> list[str]:
    """A section's or a family's row: what is walked, edges predicted and measured, their difference, what strata does beyond, outcomes."""
    names = {name for walk in walks for name in walk.family.beyond}
    beyond = "stable by construction" if names == {STABLE} else " or ".join(OUTCOME_WORDS[name] for name in OUTCOMES if name in names)
    return [what, "; ".join(dict.fromkeys(walk.parameter for walk in walks)), *numbers, beyond,
            outcomes_of(point for walk in walks for point in walk.points)]


def part_row(part: Shown) -> list[str]:
    """A section's row of the first table."""
    edges, off = part.edges, max(part.edges["difference"], key=abs, default=None)
    return row_of(part.title, part.walks, (span(edges["predicted"]), span(edges["measured"]), percent(off)))


def walk_row(walk: Shown) -> list[str]:
    """A family's row of its section's table."""
    edge = walk.edge
    return row_of(walk.title, [walk], (general(edge.predicted), general(edge.measured), percent(edge.difference)))


def point_row(point: PointFound) -> list[str]:
    """A point of a family in words."""
    checked = point.checked
    found = [NONE] * 3 if checked is None else [general(checked.value), general(checked.reference), general(checked.error, 3)]
    words = "; ".join(filter(None, [checked.words if checked is not None else "", point.reason]))
    return [point.label, general(point.value), point.outcome, *found, words, f"{point.cpu_s:.2g}"]


def walk_panel(walk: Shown) -> Shown:
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


def figures_of(part: Shown) -> list[Figure]:
    """The figures of a section: of more families than are drawn one by one their edges side by side, and the first walks."""
    rows = [(walk.heading, walk.edge.predicted, walk.edge.measured) for walk in part.walks if None not in (walk.edge.predicted, walk.edge.measured)]
    figures = []
    if len(part.walks) > MANY and len(rows) > 1:
        worst = max(abs(measured / predicted - 1.0) for _, predicted, measured in rows)
        edges = Shown(title=f"{len(rows)} edges measured within {100.0 * worst:.1f} % of what theory says", x_name=part.walks[0].parameter, rows=rows)
        figures.append(Figure(f"stability_{part.anchor}_edges", edges, draw_edges, "stability_edges", "ci/atlas", narrow=False))
    walks = [walk for walk in part.walks if walk.record is not None]
    if walks:
        data = Shown(title=finding(part), panels=[walk_panel(walk) for walk in walks[:: -(-len(walks) // MANY)]])
        figures.append(Figure(f"stability_{part.anchor}", data, draw_part, "stability", f"ci/atlas --family {walks[0].family.name}", narrow=False))
    return figures


def finding(part: Shown) -> str:
    """What a section's walks show, in a sentence."""
    return words_of("atlas_section", part=part, garbage=sum(point.outcome == GARBAGE for point in part.points), outcomes=outcomes_of(part.points))


def headline(every: Sequence[Shown]) -> str:
    """What the whole atlas says, in a sentence."""
    walks, points = [walk for part in every for walk in part.walks], [point for part in every for point in part.points]
    off = [size for part in every for size in part.edges["difference"]]
    return words_of("atlas", sections=len(every), walks=walks, points=len(points), outcomes=outcomes_of(points), off=off)


def write_stability(out: Path, folder: Path = runner.RECORDS) -> Shown:
    """Write the page below a page's folder; whatever is wrong with the records is told, not raised."""
    return told_of(NAME, lambda: _write(out, folder), "The stability atlas could not be shown")


def _write(out: Path, folder: Path) -> Shown:
    """The page with every family and every point."""
    every = parts(folder)
    versions = sorted({walk.record.version for part in every for walk in part.walks if walk.record is not None and walk.record.version},
                      key=lambda version: [int(number) for number in re.findall(r"\d+", version)])
    if not any(walk.record for part in every for walk in part.walks):
        return Shown(lack="The stability atlas has not been walked: ci/atlas --accept.")
    for part in every:
        part.figures, part.row = [make(figure, out) for figure in figures_of(part)], part_row(part)
        for walk in part.walks:
            walk.row, walk.rows = walk_row(walk), list(map(point_row, walk.points))
    write_page(out, NAME, {"headline": headline(every), "versions": ", ".join(versions), "parts": every, "wrong": [words for part in every for words in part.wrong]})
    return Shown(words=headline(every), versions=", ".join(versions), rows=[part.row[:6] for part in every],
                 defect="\n".join(made.defect for part in every for made in part.figures if made.defect))
