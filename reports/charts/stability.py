"""Draws walks across the edges of the methods: outcomes along the walked parameter, edges predicted and measured."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Rectangle

from reports.charts.style import DASHED, INK, PALE, entry, new_figure, panel_grid, put_legend, wrapped
from reports.words import Shown

# Colour, mark and name of each outcome.
_OUTCOMES = {
    "stable": ("#1d7a3e", "o", "stable"), "marked": ("#c98a00", "D", "marked as suspect"), "refused": ("#0067a5", "s", "refused (exit 2)"),
    "failed": ("#a3397f", "X", "ended with its reason (exit 3)"), "garbage": ("#d00000", "*", "garbage"),
}
_STRIP = 0.93  # height at which outcomes without a value stand, in shares of the axes


def draw_part(data: Shown, width_mm: float) -> Figure:
    """A panel a walk."""
    figure, every, _ = panel_grid(len(data.panels), 52.0, width_mm)
    for axes, panel in zip(every, data.panels, strict=True):
        _draw_walk(axes, panel)
    used = {dot.outcome for panel in data.panels for dot in panel.dots}
    handles = [entry(words, color=colour, marker=mark, linestyle="none", markersize=4.2)
               for name, (colour, mark, words) in _OUTCOMES.items() if name in used]
    if any(panel.predicted is not None for panel in data.panels):
        handles.append(entry("edge predicted", color=INK, linestyle=DASHED, linewidth=1.2))
    if any(panel.measured is not None for panel in data.panels):
        handles.append(entry("edge measured", color=PALE, linewidth=4.0, alpha=0.5))
    put_legend(figure, handles, 4)
    return figure


def _draw_walk(axes: Axes, panel: Shown) -> None:
    """Dots with a value at it, others in a strip at the top."""
    axes.set_title(wrapped(panel.heading, 40), fontsize=6.5)
    axes.set_xlabel(wrapped(panel.x_name, 34), fontsize=6.5)
    axes.set_ylabel(wrapped(panel.y_name, 34), fontsize=6.5)
    axes.set(xscale="log" if panel.x_log else "linear", yscale="log" if panel.y_log else "linear")
    axes.grid(True, which="major")
    for dot in panel.dots:
        colour, mark, _ = _OUTCOMES[dot.outcome]
        look: dict[str, Any] = {"color": colour, "marker": mark, "markersize": 4.2, "linestyle": "none", "zorder": 4}
        if dot.y is None:
            axes.plot([dot.x], [_STRIP], transform=axes.get_xaxis_transform(), clip_on=False, scaley=False, **look)
        else:
            axes.plot([dot.x], [dot.y], **look)
    if any(dot.y is None for dot in panel.dots):
        axes.add_patch(Rectangle((0.0, 2.0 * _STRIP - 1.0), 1.0, 2.0 - 2.0 * _STRIP, transform=axes.transAxes, facecolor="#f3eef2", zorder=0.5))
        axes.margins(y=0.2)
    if panel.measured is not None:
        axes.axvline(panel.measured, color=PALE, linewidth=4.0, alpha=0.5, zorder=2)
    if panel.predicted is not None:
        axes.axvline(panel.predicted, color=INK, linewidth=1.2, linestyle=DASHED, zorder=3)


def draw_edges(data: Shown, width_mm: float) -> Figure:
    """Many edges under one another: predicted as a line, measured as a dot."""
    figure = new_figure(width_mm, 22.0 + 3.4 * len(data.rows))
    axes, colour = figure.subplots(), _OUTCOMES["stable"][0]
    for place, (_, predicted, measured) in enumerate(data.rows):
        axes.plot([predicted, predicted], [place - 0.38, place + 0.38], color=INK, linewidth=1.6, zorder=3)
        axes.plot([measured], [place], marker="o", markersize=3.4, color=colour, markeredgecolor="white", markeredgewidth=0.5, zorder=4)
    axes.set_yticks(range(len(data.rows)), [name for name, _, _ in data.rows], fontsize=5.6)
    axes.set(ylim=(len(data.rows) - 0.4, -0.6), xlabel=data.x_name)
    axes.grid(True, axis="x")
    put_legend(figure, [entry("edge predicted", color=INK, marker="|", markersize=9, markeredgewidth=1.6, linestyle="none"),
                        entry("edge measured", color=colour, marker="o", linestyle="none", markersize=5)], 2)
    return figure
