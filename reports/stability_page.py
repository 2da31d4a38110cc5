"""The page of the stability atlas, and what the front page says of it."""

from __future__ import annotations

import traceback
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2

from reports.charts.stability_chart import draw_edges, draw_part
from reports.sections import Picture, put_figure
from reports.stability import (
    HOW_TO_MAKE, MANY, Part, PartFigure, beyond_words, edge_row, edges_shown, finding, first_row, headline, parts, point_rows, shown,
)  # fmt: skip
from verification.stability import store

NAME = "stability.html"
CAPTION = (
    "A dot a run: the checked error over the walked parameter, coloured by how the run ended; runs without a value stand at the top."
    " Dashed: the edge that theory predicts; broad: the edge measured by bisection, or between the last sound and the first unsound run."
)
EDGES_CAPTION = "A row a walk: the edge predicted and the edge measured by bisection over runs of the same block."


@dataclass(frozen=True)
class Front:
    """What the front page says: a sentence and where the page is; `lack` instead where there are no records."""

    words: str
    link: str
    lack: str = ""
    defect: str = ""


def write_stability(out: Path, folder: Path = store.RECORDS) -> Front:
    """Write the page below a page's folder; whatever is wrong with the records is told, not raised."""
    try:
        every = parts(folder)
        if not any(walk.record for part in every for walk in part.walks):
            return Front("", "", f"The stability atlas has not been walked: {HOW_TO_MAKE}.")
        _write(every, out)
        return Front(headline(every), NAME)
    except Exception as error:  # a torn file must not cost the reader the rest of the page
        lack = f"The stability atlas could not be shown: {type(error).__name__}: {error}"
        return Front("", "", lack, traceback.format_exc())


def pictures(part: Part, out: Path) -> list[Picture]:
    """The figures of a section: many edges side by side, and the first walks one by one."""
    made = []
    edges = edges_shown(part)
    if edges is not None:
        made.append(put_figure(draw_edges(edges), out, f"stability_{part.anchor}_edges", edges.title, EDGES_CAPTION))
    walks = [walk for walk in part.walks if walk.record is not None]
    step = max(1, -(-len(walks) // MANY))
    figure = PartFigure(finding(part), tuple(shown(walk) for walk in walks[::step]))
    if figure.panels:
        made.append(put_figure(draw_part(figure), out, f"stability_{part.anchor}", figure.title, CAPTION))
    return made


def content_of(part: Part, out: Path) -> dict[str, Any]:
    """What the template needs of a section."""
    first = part.walks[0].family
    sources = dict.fromkeys(walk.family.edge.source for walk in part.walks if walk.family.edge is not None)
    return {
        "anchor": part.anchor, "title": part.title, "about": first.about or first.says, "beyond": beyond_words(part.walks),
        "sources": list(sources), "remarks": list(dict.fromkeys(walk.family.remark for walk in part.walks if walk.family.remark)),
        "says": list(dict.fromkeys(walk.family.says for walk in part.walks)) if first.about else [],
        "wrong": list(part.wrong), "figures": pictures(part, out), "rows": [edge_row(walk) for walk in part.walks],
        "walks": [{"title": walk.family.title, "check": walk.family.check_name, "points": point_rows(walk)} for walk in part.walks],
    }  # fmt: skip


def _write(every: tuple[Part, ...], out: Path) -> None:
    """The page with every family and every point."""
    loader = jinja2.FileSystemLoader(Path(__file__).parent / "templates")
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    versions = dict.fromkeys(walk.record.version for part in every for walk in part.walks if walk.record is not None and walk.record.version)
    content = {"headline": headline(every), "first": [first_row(part) for part in every], "versions": ", ".join(versions),
               "parts": [content_of(part, out) for part in every]}  # fmt: skip
    out.mkdir(parents=True, exist_ok=True)
    (out / NAME).write_text(environment.get_template("stability.html").render(content), encoding="utf-8")
