"""Draws error budgets as tornado charts."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch

from reports.charts.style import FLAG, INK, new_figure, put_legend, put_title

if TYPE_CHECKING:  # the other way round at run time: the part of the page draws itself
    from reports.budget import BudgetFigure, BudgetPanel, BudgetRow

# A pair a group: the first alternative of a factor and the others.
_COLOURS: dict[str, tuple[str, str]] = {
    "numerical": ("#7fb2dd", "#0067a5"), "model": ("#d9c27a", "#8a6a00"), "beside": ("#c9c9c9", "#8a8a8a"),
}
_NAMES: dict[str, str] = {"numerical": "numerical factor", "model": "choice of the model", "beside": "beside, in no sum"}


def draw_budget(data: BudgetFigure) -> Figure:
    """A row of panels a variant, a panel a quantity; bars from 0 to the effect, largest factor on top."""
    columns = max(len(panels) for _, panels in data.variants)
    width = max(8.2, 3.0 * columns)
    figure = new_figure(width, 1.2 + 2.9 * len(data.variants))
    put_title(figure, data.title, int(10.4 * width))
    every = figure.subplots(len(data.variants), columns, squeeze=False)
    for line, (variant, panels) in zip(every, data.variants):
        for axes in line[len(panels):]:
            axes.set_axis_off()
        for k, (axes, panel) in enumerate(zip(line, panels)):
            _draw_panel(axes, panel)
            axes.set_title(f"{variant}\n{panel.heading}" if k == 0 else f"\n{panel.heading}", fontsize=8.5)
    groups = dict.fromkeys(row.group for _, panels in data.variants for panel in panels for row in panel.rows)
    put_legend(figure, [Patch(color=_COLOURS[name][1], label=_NAMES[name]) for name in _NAMES if name in groups], 3)
    return figure


def _draw_panel(axes: Axes, panel: BudgetPanel) -> None:
    """One quantity of one variant."""
    axes.grid(True, axis="x")
    axes.axvline(0.0, color=INK, linewidth=0.8)
    values = [bar.value for row in panel.rows for bar in row.bars if bar.value is not None]
    reach = max((abs(value) for value in values), default=1.0) or 1.0
    low, high = min([0.0, *values]), max([0.0, *values])
    for place, row in enumerate(panel.rows):
        _draw_row(axes, place, row, reach)
    axes.set_yticks(range(len(panel.rows)), [row.label for row in panel.rows], fontsize=7.5)
    axes.set_ylim(len(panel.rows) - 0.5, -0.5)
    axes.set_xlim(low - (0.4 if low < 0.0 else 0.15) * reach, high + (0.4 if high > 0.0 else 0.15) * reach)
    axes.set_xlabel(panel.unit)
    axes.tick_params(axis="x", labelsize=7.5)


def _draw_row(axes: Axes, place: int, row: BudgetRow, reach: float) -> None:
    """One factor: its alternatives under one another."""
    height = 0.76 / max(len(row.bars), 1)
    colours = _COLOURS.get(row.group, _COLOURS["beside"])
    for k, bar in enumerate(row.bars):
        y = place - 0.38 + (k + 0.5) * height
        if bar.value is None:
            axes.plot([0.0], [y], marker="x", color=FLAG, markersize=4.5, zorder=4)
            continue
        axes.barh(y, bar.value, height=0.9 * height, color=colours[min(k + (len(row.bars) == 1), 1)], zorder=3)
        side = 1.0 if bar.value >= 0.0 else -1.0
        axes.text(bar.value + 0.02 * side * reach, y, _told(bar.value), fontsize=5.5, va="center",
                  ha="left" if side > 0.0 else "right")


def _told(value: float) -> str:
    """An effect in two digits, with its sign."""
    if value == 0.0:
        return "0"
    return (f"{value:+.0f}" if abs(value) >= 10.0 else f"{value:+.2g}").replace("-", "−")
