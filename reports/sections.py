"""What the parts of the page of verification are made of.

A module of `reports/` that fills a part of that page has one function

    section(runs: Path, out: Path) -> Section | None

`runs` is the folder of runs (`runs/`), `out` that of the page (`reports/out/`). It reads what it needs below `runs`, draws its
figures with functions of `reports/charts/` and writes them by `put_figure`, and returns plain data; None where there is nothing
to show because the command that makes it was not run. What was run and failed is to be said in a row, a caption or the
intro. Modules in use: `reports.path_check`, `reports.refinement`, `reports.budget`, `reports.benchmarks`, beside the ladder itself.
"""

from __future__ import annotations

from pathlib import Path
from typing import NotRequired, TypedDict

from reports.charts.style import Figure, save


class Picture(TypedDict):
    """A figure of which out/figures/NAME.svg and NAME.png have been written; its title is the finding."""

    name: str
    title: str
    caption: str


class Table(TypedDict):
    """A table in words. `marked`: numbers of the rows (from 0) that fall short; `note` stands below the table."""

    title: str
    header: list[str]
    rows: list[list[str]]
    marked: NotRequired[list[int]]
    note: NotRequired[str]


class Section(TypedDict):
    """A part of the page: what was found (a sentence or two, from the data) in `intro`, then figures, then tables."""

    title: str
    intro: str
    figures: list[Picture]
    tables: list[Table]


def put_figure(figure: Figure, out: Path, name: str, title: str, caption: str) -> Picture:
    """Write a figure below a page's folder; returns what the page needs to show it."""
    save(figure, out / "figures", name)
    return Picture(name=name, title=title, caption=caption)
