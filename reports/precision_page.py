"""The chart's part of the front page, and the page with all settings behind it."""

from __future__ import annotations

import traceback
from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import jinja2

from reports.charts.precision_chart import draw_front, draw_full
from reports.precision import (
    HOW_TO_MAKE, Measurements, advice_lines, front_figure, full_figure, lack_rows, measurements, percent, point_rows, reference_words,
    seconds, table_of,
)  # fmt: skip
from reports.sections import Picture, put_figure
from reports.words import listed
from verification.precision import store
from verification.precision.judge import TOLERANCES, Dot, Panel, choice_for, run_at

NAME = "precision.html"
CAPTION = (
    "A panel a quantity, every method a curve from coarse to fine: relative error against the wall time of the whole process, both"
    " logarithmic. Errors are drawn as they are judged: where a finer size of the same method is farther off, or the sign has changed, the"
    " smaller error is luck and hangs below. Yellow: what no other run of the solver beats in both. Circles: the cheapest within 1 % and"
    " 0.1 %. Blue ground: the reference is not known better. Pink: methods that were refused, failed, took too long or have no value."
)
FULL_CAPTION = "Every method and setting, its number beside its finest size; filled: graded grid, hollow: uniform. Circles: the cheapest within 1 % and 0.1 %."


@dataclass(frozen=True)
class Front:
    """What the front page shows of the chart; `lack` says how to make it where there are no data."""

    figure: Picture | None
    rows: list[dict[str, object]]
    tolerances: list[str]
    recommendations: list[str]
    recipe: list[tuple[str, str]]
    notes: list[str]
    lack: str
    link: str
    defect: str = ""


def write_precision(out: Path, folder: Path = store.DATA) -> Front:
    """Write the chart and the page of all settings below a page's folder; whatever is wrong with the data is told, not raised."""
    try:
        found = measurements(folder)
        if found is None:
            return _without(f"The work-precision chart has not been measured: {HOW_TO_MAKE}.")
        figure = front_figure(found.panels)
        picture = put_figure(draw_front(figure), out, "precision", figure.title, CAPTION)
        _write_full(found, out)
    except Exception as error:  # a torn file must not cost the reader the rest of the page
        return _without(f"The work-precision chart could not be made: {type(error).__name__}: {error}", traceback.format_exc())
    return Front(picture, table_of(found.panels), [percent(error) for error in TOLERANCES], recommendations(found.panels),
                 list(found.recipe), list(found.notes), "", NAME)  # fmt: skip


def _without(lack: str, defect: str = "") -> Front:
    """What is shown without a chart."""
    return Front(None, [], [], [], [], [], lack, "", defect)


def _write_full(found: Measurements, out: Path) -> None:
    """The page with every method and every point."""
    parts: list[dict[str, Any]] = []
    for panel in found.panels:
        figure = full_figure(panel)
        name = f"precision_{panel.wanted.name}"
        parts.append({
            "name": panel.wanted.name, "title": panel.wanted.title, "says": f"{panel.problem.says}.",
            "reference": reference_words(panel), "advice": list(advice_lines(panel)),
            "figure": put_figure(draw_full(figure), out, name, figure.title, FULL_CAPTION),
            "points": point_rows(panel), "lacks": lack_rows(panel),
        })  # fmt: skip
    loader = jinja2.FileSystemLoader(Path(__file__).parent / "templates")
    environment = jinja2.Environment(loader=loader, autoescape=True, trim_blocks=True, lstrip_blocks=True)
    content = {"parts": parts, "recipe": found.recipe, "notes": found.notes}
    (out / NAME).write_text(environment.get_template("precision.html").render(content), encoding="utf-8")


def recommendations(panels: Sequence[Panel]) -> list[str]:
    """What the chart says each experiment should be run with, and why, a sentence or two a problem."""
    told = []
    for problem in dict.fromkeys(panel.problem.name for panel in panels if panel.problem.experiments):
        own = [panel for panel in panels if panel.problem.name == problem]
        numbers = [str(number) for number in own[0].problem.experiments]
        choice = choice_for(own, TOLERANCES[1])
        if choice is None:
            continue
        heading = f"Experiments {listed(numbers)}: {choice.name}, {seconds(choice.time_s)} a run"
        nearest = "none is within 1 % in all; this comes nearest,"
        reason = "the cheapest within 1 %, or the reference's uncertainty," if choice.within else nearest
        told.append(f"{heading}; {reason} with errors of {_errors(choice.dots, own)}. {_shipped(own)}")
    return told


def _errors(dots: Sequence[Dot], panels: Sequence[Panel]) -> str:
    """The errors of a run in all panels."""
    return listed([f"{percent(dot.judged)} ({panel.wanted.title.split(',')[0]})" for dot, panel in zip(dots, panels)])


def _shipped(panels: Sequence[Panel]) -> str:
    """What the scenes ask for, and what that does."""
    method, level = panels[0].problem.shipped
    label = next((one.label for one in panels[0].problem.methods if one.name == method), method)
    dots = run_at(panels, method, level)
    if dots is None:
        return f"The scenes' own setting ({label}, {level}) has not been measured, or has no value."
    took = seconds(dots[0].time_s)
    return f"The scenes' own setting ({label}, {level}) takes {took}, with errors of {_errors(dots, panels)}; it has inertia."
