"""Draws what each ingredient of the scenes is worth as a matrix of ingredients by scenes."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from reports.charts.style import INK, new_figure, put_legend, put_title
from verification.ablation.effects import CHANGES

if TYPE_CHECKING:  # the other way round at run time: the part of the page draws itself
    from reports.ablation import AblationFigure, Cell

# Effects from these shares on, with their colour and name.
_STEPS: tuple[tuple[float, str, str], ...] = (
    (0.0, "#eef3f8", "below 0.1 %"), (1e-3, "#c9dcee", "0.1 to 1 %"), (1e-2, "#f3c67a", "1 to 10 %"), (1e-1, "#e07b39", "10 % and more"),
)
_OTHER = ("#8c2d04", "≠ something else happens")
_FAILED = ("#d9d9d9", "the run says nothing")


def draw_ablation(data: AblationFigure) -> Figure:
    """A row an ingredient, a column a scene; colours by the size of the effect, the time below it."""
    width, height = 2.9 + 0.72 * len(data.columns), 1.9 + 0.36 * len(data.rows)
    figure = new_figure(max(width, 8.0), height)
    put_title(figure, data.title, int(11.0 * max(width, 8.0)))
    axes = figure.subplots()
    for place, (_, _, cells) in enumerate(data.rows):
        for column, cell in enumerate(cells):
            _draw_cell(axes, column, place, cell)
    groups = [group for _, group, _ in data.rows]
    for place in range(1, len(groups)):
        if groups[place] != groups[place - 1]:
            axes.axhline(place - 0.5, color=INK, linewidth=1.2)
    axes.set_xlim(-0.5, len(data.columns) - 0.5)
    axes.set_ylim(len(data.rows) - 0.5, -0.5)
    axes.set_xticks(range(len(data.columns)), data.columns, fontsize=8)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(data.rows)), [label if group != "gone without" else f"+ {label}" for label, group, _ in data.rows], fontsize=8)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    patches = [Patch(facecolor=colour, label=name) for _, colour, name in _STEPS]
    patches += [Patch(facecolor=colour, label=name) for colour, name in (_OTHER, _FAILED)]
    put_legend(figure, patches, 3)
    return figure


def colour_of(cell: Cell) -> str:
    """The colour of a cell by its effect."""
    if cell.verdict == CHANGES:
        return _OTHER[0]
    if cell.share is None:
        return _FAILED[0]
    return [colour for least, colour, _ in _STEPS if cell.share >= least][-1]


def _words(cell: Cell) -> str:
    """The effect in per cent, or a sign."""
    if cell.verdict == CHANGES:
        return "≠"
    if cell.share is None:
        return "?"
    per_cent = 100.0 * cell.share
    return f"{per_cent:.0f}" if per_cent >= 10.0 else f"{per_cent:.1f}" if per_cent >= 1.0 else f"{per_cent:.2f}"


def _draw_cell(axes: Axes, column: int, place: int, cell: Cell | None) -> None:
    """One cell: a rectangle with the effect and the time."""
    if cell is None:
        return
    colour = colour_of(cell)
    axes.add_patch(Rectangle((column - 0.47, place - 0.46), 0.94, 0.92, facecolor=colour, edgecolor="none"))
    dark = colour == _OTHER[0]
    axes.text(column, place - 0.13, _words(cell), ha="center", va="center", fontsize=8, color="white" if dark else INK)
    time = f"×{cell.time:.1f}" if cell.time >= 1.0 else f"×{cell.time:.2f}"
    axes.text(column, place + 0.28, time, ha="center", va="center", fontsize=6.5, color="white" if dark else INK)
