"""Draws Figures 3 to 6: a layout, and fracture height against inlet pressure."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.charts.layout_chart import draw_layout
from reports.charts.style import (
    COLOURS, FLAG, INK, KIND_NAMES, MARKERS, PALE, interface_lines, line_of, new_figure, put_legend,
    put_title,
)
from reports.curves import HeightCurve, HeightFigure, Mark


def draw_heights(data: HeightFigure) -> Figure:
    """Layout, heights over the whole block, and the surroundings of the interfaces."""
    figure = new_figure(13.0, 5.6)
    put_title(figure, data.title, 120)
    left, middle, right = figure.subplots(1, 3, gridspec_kw={"width_ratios": (1.0, 1.05, 1.25)})
    draw_layout(left, data.layout)
    left.set_title("Layout")
    for axes in (middle, right):
        axes.grid(True)
        interface_lines(axes, data.layout.heights_m)
        for curve in data.curves:
            _draw_curve(axes, curve, any(one.beside for one in data.curves))
        axes.set_xlabel("inlet pressure (MPa)")
    middle.set_ylim(0, data.layout.height_m)
    middle.set_ylabel("fracture height (m)")
    middle.set_title("Whole block")
    middle.set_xlim(*data.pressure_MPa)
    right.set_xlim(*data.zoom_MPa)
    right.set_ylim(*data.zoom_m)
    right.set_ylabel("fracture height (m)")
    right.set_title("About the interfaces")
    _legends(figure, data)
    return figure


def _draw_curve(axes: Axes, curve: HeightCurve, overlaid: bool) -> None:
    """One variant's curve: the tip stays until the row that says it has grown."""
    axes.plot(curve.inlet_MPa, curve.height_m, drawstyle="steps-post", **line_of(curve.variant, curve.beside, overlaid))
    for mark in curve.marks:
        _draw_mark(axes, mark, curve)
    if curve.failed:
        axes.plot(curve.inlet_MPa[-1:], curve.height_m[-1:], marker="X", markersize=9, color=FLAG, zorder=6)


def _draw_mark(axes: Axes, mark: Mark, curve: HeightCurve) -> None:
    """One event; an arrest decided by J at an interface gets a ring of its own. The mechanics shown beside is hollow."""
    colour = COLOURS.get(curve.variant, PALE)
    if curve.beside:
        axes.plot([mark.inlet_MPa], [mark.height_m], marker=MARKERS[mark.kind], markersize=4.2, markerfacecolor="white",
                  markeredgecolor=colour, markeredgewidth=0.8, zorder=4.5, clip_on=True)
    else:
        _draw_full_mark(axes, mark, colour)
    if mark.flag:
        axes.plot([mark.inlet_MPa], [mark.height_m], marker="o", markersize=13, markerfacecolor="none",
                  markeredgecolor=FLAG, markeredgewidth=1.5, zorder=6, clip_on=True)


def _draw_full_mark(axes: Axes, mark: Mark, colour: str) -> None:
    """An event of the mechanics that the figure tells of."""
    axes.plot([mark.inlet_MPa], [mark.height_m], marker=MARKERS[mark.kind], markersize=6, color=colour,
              markeredgecolor=colour if mark.kind in ("stop", "reach_interface") else "white",
              markeredgewidth=1.6 if mark.kind in ("stop", "reach_interface") else 0.7, zorder=5, clip_on=True)


def _legends(figure: Figure, data: HeightFigure) -> None:
    """Variants and kinds of event below the charts."""
    told = [curve for curve in data.curves if not curve.beside]
    variants = [Line2D([], [], label=curve.label, **line_of(curve.variant, solid=len(told) < len(data.curves)))
                for curve in told]
    beside = dict.fromkeys(curve.mechanics for curve in data.curves if curve.beside)
    variants += [Line2D([], [], label=f"{name} (thin, hollow)", **{**line_of("", True), "color": INK}) for name in beside]
    kinds = {mark.kind for curve in data.curves for mark in curve.marks}
    marks = [
        Line2D([], [], marker=MARKERS[kind], color=INK, linestyle="none", label=name)
        for kind, name in KIND_NAMES.items() if kind in kinds
    ]
    if data.flagged:
        marks.append(Line2D([], [], marker="o", markersize=11, markerfacecolor="none", markeredgecolor=FLAG,
                            markeredgewidth=1.5, linestyle="none", label="J at interface: not to be trusted"))
    put_legend(figure, variants + marks, 6)
