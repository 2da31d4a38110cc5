"""Draws paths of runs over those of boundary elements."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.charts.style import INK, PALE, new_figure, put_title

if TYPE_CHECKING:  # the other way round at run time: the part of the page draws itself
    from reports.path_check import PathFigure, PathPanel

_MARKS: tuple[tuple[str, str], ...] = (
    ("#0067a5", "o"), ("#d04a00", "s"), ("#00845f", "^"), ("#a3397f", "D"), ("#8a6a00", "v"), ("#5b8fd9", "X"), ("#7a5230", "P"),
)  # fmt: skip
_TOP_M = 27.0  # what is drawn of runs that go on


def draw_paths(data: PathFigure) -> Figure:
    """A panel an experiment: boundary elements as lines, runs as marks, the interface; a legend beside each."""
    figure = new_figure(5.4 * len(data.panels), 6.6)
    put_title(figure, data.title, 52 * len(data.panels))
    for axes, panel in zip(figure.subplots(1, len(data.panels), squeeze=False)[0], data.panels):
        _draw_panel(axes, panel)
    return figure


def _draw_panel(axes: Axes, panel: PathPanel) -> None:
    """One experiment."""
    axes.grid(True)
    axes.plot(*panel.converged.T, color=PALE, linewidth=5, alpha=0.55, solid_capstyle="butt", label=panel.converged_words, zorder=2)
    for k, run in enumerate(panel.runs):
        colour, mark = _MARKS[k % len(_MARKS)]
        axes.plot(*run.tips.T, color=colour, marker=mark, markersize=3.6, linewidth=0.8, label=run.label, zorder=4)
        if panel.shows_same:
            axes.plot(*run.same.T, color=colour, linewidth=1.3, linestyle=(0, (3, 1.5)), zorder=3)
    _limits(axes, panel)
    axes.set_title(panel.heading)
    axes.set_xlabel("x from the first line (m)")
    axes.set_ylabel("height (m)")
    if panel.shows_same:
        axes.plot([], [], color=INK, linewidth=1.3, linestyle=(0, (3, 1.5)), label="boundary elements, forward, increments of the run")
    axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), fontsize=7.5, ncols=1)


def _limits(axes: Axes, panel: PathPanel) -> None:
    """Room for what is compared; the interface where it is near."""
    every = [panel.converged, *(run.tips for run in panel.runs)]
    shown = [tips[tips[:, 1] <= _TOP_M] for tips in every]
    left, right = min(float(tips[:, 0].min()) for tips in shown), max(float(tips[:, 0].max()) for tips in shown)
    if right > 0.7 * panel.interface_m:
        right = panel.interface_m + 1.0
        axes.axvline(panel.interface_m, color=INK, linewidth=1.6)
        axes.annotate("interface", (panel.interface_m, 0.0), xycoords=("data", "axes fraction"), xytext=(4, 6),
                      textcoords="offset points", rotation=90, ha="left", va="bottom", fontsize=8)  # fmt: skip
    room = 0.06 * (right - left)
    inside = [tips[tips[:, 0] <= right] for tips in shown]
    top = max(float(tips[:, 1].max()) for tips in inside)
    axes.set(xlim=(left - room, right + room), ylim=(4.5, top + 0.5))
