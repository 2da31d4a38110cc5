"""Draws walks across the edges of the methods: outcomes along the walked parameter, edges predicted and measured."""

from __future__ import annotations

import textwrap
from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle

from reports.charts.style import INK, PALE, new_figure, panel_grid, put_legend, put_title

if TYPE_CHECKING:  # the other way round at run time: the part of the page draws itself
    from reports.stability import EdgesShown, PartFigure, WalkShown

_COLOURS = {"stable": "#1d7a3e", "marked": "#c98a00", "refused": "#0067a5", "failed": "#a3397f", "garbage": "#d00000"}
_MARKS = {"stable": "o", "marked": "D", "refused": "s", "failed": "X", "garbage": "*"}
_NAMES = {"stable": "stable", "marked": "marked as suspect", "refused": "refused (exit 2)", "failed": "ended with its reason (exit 3)",
          "garbage": "garbage"}  # fmt: skip
_STRIP = 0.93  # height at which outcomes without a value stand, in shares of the axes


def draw_part(data: PartFigure) -> Figure:
    """A panel a walk."""
    figure, every, _ = panel_grid(data.title, len(data.panels), 3.0)
    for axes, panel in zip(every, data.panels, strict=True):
        _draw_walk(axes, panel)
    used = dict.fromkeys(dot.outcome for panel in data.panels for dot in panel.dots)
    handles = [Line2D([], [], color=_COLOURS[name], marker=_MARKS[name], linestyle="none", markersize=6, label=_NAMES[name])
               for name in _NAMES if name in used]  # fmt: skip
    if any(panel.predicted is not None for panel in data.panels):
        handles.append(Line2D([], [], color=INK, linestyle=(0, (4, 2)), linewidth=1.2, label="edge predicted"))
    if any(panel.measured is not None for panel in data.panels):
        handles.append(Line2D([], [], color=PALE, linewidth=4.0, alpha=0.5, label="edge measured"))
    put_legend(figure, handles, 4)
    return figure


def _draw_walk(axes: Axes, panel: WalkShown) -> None:
    """Dots with a value at it, others in a strip at the top."""
    axes.set_title("\n".join(textwrap.wrap(panel.heading, 48)), fontsize=8.2)
    axes.set_xlabel(panel.x_name)
    axes.set_ylabel("\n".join(textwrap.wrap(panel.y_name, 34)), fontsize=7.8)
    if panel.x_log:
        axes.set_xscale("log")
    if panel.y_log:
        axes.set_yscale("log")
    axes.grid(True, which="major")
    for dot in panel.dots:
        look = {"color": _COLOURS[dot.outcome], "marker": _MARKS[dot.outcome], "markersize": 6.0, "linestyle": "none", "zorder": 4}
        if dot.y is None:
            axes.plot([dot.x], [_STRIP], transform=axes.get_xaxis_transform(), clip_on=False, scaley=False, **look)
        else:
            axes.plot([dot.x], [dot.y], **look)
    if any(dot.y is None for dot in panel.dots):
        place = Rectangle((0.0, 2.0 * _STRIP - 1.0), 1.0, 2.0 - 2.0 * _STRIP, transform=axes.transAxes, facecolor="#f3eef2", zorder=0.5)
        axes.add_patch(place)
        axes.margins(y=0.2)
    if panel.measured is not None:
        axes.axvline(panel.measured, color=PALE, linewidth=4.0, alpha=0.5, zorder=2)
    if panel.predicted is not None:
        axes.axvline(panel.predicted, color=INK, linewidth=1.2, linestyle=(0, (4, 2)), zorder=3)


def draw_edges(data: EdgesShown) -> Figure:
    """Many edges under one another: predicted as a line, measured as a dot."""
    figure = new_figure(9.4, 1.1 + 0.19 * len(data.rows))
    put_title(figure, data.title, 96)
    axes = figure.subplots()
    for place, (_, predicted, measured) in enumerate(data.rows):
        axes.plot([predicted, predicted], [place - 0.38, place + 0.38], color=INK, linewidth=1.6, zorder=3)
        axes.plot([measured], [place], marker="o", markersize=4.6, color=_COLOURS["stable"], markeredgecolor="white", markeredgewidth=0.5, zorder=4)
    axes.set_yticks(range(len(data.rows)), [name for name, _, _ in data.rows], fontsize=7.2)
    axes.set_ylim(len(data.rows) - 0.4, -0.6)
    axes.set_xlabel(data.x_name)
    axes.grid(True, axis="x")
    handles = [Line2D([], [], color=INK, marker="|", markersize=9, markeredgewidth=1.6, linestyle="none", label="edge predicted"),
               Line2D([], [], color=_COLOURS["stable"], marker="o", linestyle="none", markersize=5, label="edge measured")]  # fmt: skip
    put_legend(figure, handles, 2)
    return figure
