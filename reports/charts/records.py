"""Draws what records and small scenes show: runs beside what was measured, what each ingredient of a scene is worth, maps of verdicts with lines of criteria,
the small picture of a gallery scene, a well with its layers, the fracture in them and the depth of its upper tip against its pressure, and walks across the edges
of the methods: outcomes along the walked parameter, edges predicted and measured."""

import math
from typing import Any

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from reports.charts.style import (
    DASHED, DOTTED, FLAG, FLUID, INK, ONE_COLUMN, PALE, TWO_COLUMNS, entry, interface_lines, new_figure, panel_grid, put_legend, wrapped,
)  # fmt: skip
from reports.words import Shown

_RUNS = (("#0067a5", "-", 1.6), ("#d04a00", DASHED, 1.2), ("#00845f", (0, (3, 1.2, 1, 1.2)), 1.2), ("#a3397f", (0, (1, 1.5)), 1.4))


def draw_measured(data: Shown, width_mm: float) -> Figure:
    """A panel a quantity: points as measured, hollow ones less the gauges' zero, a line a run; grey up to where errors count."""
    figure, every, _ = panel_grid(len(data.panels), 58.0, width_mm)
    for axes, panel in zip(every, data.panels, strict=True):
        axes.grid(True)
        axes.axvspan(0.0, data.from_s, color=PALE, alpha=0.12, linewidth=0)
        for (_, times, values), (colour, dashes, width) in zip(panel.curves, _RUNS):
            axes.plot(times, values, color=colour, linestyle=dashes, linewidth=width, zorder=3)
        axes.plot(panel.times, panel.points, linestyle="none", marker="o", markersize=3.6, color=INK, zorder=5)
        if panel.lowered:
            axes.plot(panel.times, panel.lowered, linestyle="none", marker="o", markersize=3.6, color=INK, markerfacecolor="white", zorder=4)
        axes.set(xlabel="time (s)", ylabel=f"{panel.heading.lower()} ({panel.unit})", xlim=(0.0, 1.04 * panel.times[-1]), ylim=(0.0, 1.12 * max(panel.points)))
    handles = [entry("measured", color=INK, marker="o", linestyle="none"),
               entry(f"measured less {data.zero_MPa:.3f} MPa", color=INK, marker="o", markerfacecolor="white", linestyle="none")]
    handles += [entry(name, color=colour, linestyle=dashes, linewidth=width) for (name, *_), (colour, dashes, width) in zip(data.panels[0].curves, _RUNS)]
    put_legend(figure, handles, len(handles) if width_mm > ONE_COLUMN else 2)
    return figure


# Effects of leaving an ingredient out from these shares on, with their colour and name.
_STEPS: tuple[tuple[float, str, str], ...] = (
    (0.0, "#eef3f8", "below 0.1 %"), (1e-3, "#c9dcee", "0.1 to 1 %"), (1e-2, "#f3c67a", "1 to 10 %"), (1e-1, "#e07b39", "10 % and more"),
)
_OTHER, _FAILED = ("#8c2d04", "≠ something else happens"), ("#d9d9d9", "the run says nothing")
_DARK_INK, _LIGHT_INK = "#1c1c1d", "#fffffe"  # in cells, which are alike on light and dark pages: colours that no dark page changes


def draw_ablation(data: Shown, width_mm: float) -> Figure:
    """A row an ingredient, a column a scene; colours by the size of the effect, the time below it."""
    wide = width_mm > ONE_COLUMN
    figure = new_figure(width_mm, 38.0 + 8.5 * len(data.rows))
    axes = figure.subplots()
    for place, (_, cells) in enumerate(data.rows):
        for column, cell in enumerate(cells):
            if cell is not None:
                _draw_cell(axes, column, place, cell, 1.0 if wide else 0.68)
    axes.set(xlim=(-0.5, len(data.columns) - 0.5), ylim=(len(data.rows) - 0.5, -0.5))
    axes.set_xticks(range(len(data.columns)), data.columns, fontsize=6, rotation=90)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(data.rows)), [label if wide else wrapped(label, 15) for label, _ in data.rows], fontsize=7 if wide else 6)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    put_legend(figure, [Patch(facecolor=look[-2], label=look[-1]) for look in (*_STEPS, _OTHER, _FAILED)], 3 if wide else 2)
    return figure


def _draw_cell(axes: Axes, column: int, place: int, cell: Shown, size: float) -> None:
    """One cell: a rectangle coloured by the effect, with the effect in per cent or a sign and the time."""
    colour, words = [colour for least, colour, _ in _STEPS if (cell.share or 0.0) >= least][-1], "?"
    if cell.changes:
        colour, words = _OTHER[0], "≠"
    elif cell.share is None:
        colour = _FAILED[0]
    else:
        per_cent = 100.0 * cell.share
        words = f"{per_cent:.0f}" if per_cent >= 10.0 else f"{per_cent:.1f}" if per_cent >= 1.0 else f"{per_cent:.2f}"
    axes.add_patch(Rectangle((column - 0.47, place - 0.46), 0.94, 0.92, facecolor=colour, edgecolor="none"))
    ink = _LIGHT_INK if cell.changes else _DARK_INK
    axes.text(column, place - 0.13, words, ha="center", va="center", fontsize=6.5 * size, color=ink)
    time = f"×{cell.time:.1f}" if cell.time >= 1.0 else f"×{cell.time:.2f}"
    axes.text(column, place + 0.28, time, ha="center", va="center", fontsize=5 * size, color=ink)


_VERDICTS = {"crosses": ("#0067a5", "s"), "stops": ("#d9a400", "^"), "gives way": ("#d04a00", "o"), "failed": (FLAG, "x")}
_LINES = {
    "Renshaw & Pollard": (INK, "-"), "Gu & Weng": (INK, DASHED), "Blanton": (INK, DOTTED), "slip 1 m ahead of the tip": (PALE, DASHED),
    "mean over 2 m slides": ("#00845f", "-"), "mean shear over 1 m, like rocks": ("#00845f", "none"),
    "mean over 2 m slides, like rocks": ("#9b59b6", "none"),
}  # fmt: skip


def draw_crossing_map(data: Shown, width_mm: float) -> Figure:
    """A panel a map: a mark a run, larger the more the inlet rose before the fracture was beyond; a line a criterion."""
    figure, every, _ = panel_grid(len(data.panels), 62.0, width_mm)
    for axes, panel in zip(every, data.panels, strict=True):
        for verdict, (colour, marker) in _VERDICTS.items():
            chosen = [(x, y, 9.0 if math.isnan(rise) else 2.5 + 14.0 * min(rise, 1.0)) for x, y, word, rise in panel.runs if word == verdict]
            if chosen:
                axes.scatter(*zip(*chosen), color=colour, marker=marker, linewidths=0.5)
        for name, (xs, ys) in panel.lines.items():
            colour, dashes = _LINES[name]
            axes.plot(xs, ys, color=colour, linestyle=dashes, linewidth=1.4, marker="*" if dashes == "none" else None, markersize=9, zorder=4)
        axes.set_xscale("log" if panel.x.log else "linear")
        axes.set_yscale("log" if panel.y.log else "linear")
        for axis, own in ((axes.xaxis, panel.x), (axes.yaxis, panel.y)):
            if own.log:
                axis.set_major_locator(FixedLocator([0.1, 0.2, 0.5, 1.0, 2.0, 5.0, 10.0]))
                axis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
                axis.set_minor_locator(NullLocator())
        margins = (0.85, 1.18) if panel.x.log else (0.9, 1.05)
        ends = [end(x for x, *_ in panel.runs) for end in (min, max)]
        axes.set(title=panel.heading, xlabel=panel.x.label, ylabel=panel.y.label, xlim=(ends[0] * margins[0], ends[1] * margins[1]))
    handles = [entry(word, color=colour, marker=marker, linestyle="none") for word, (colour, marker) in _VERDICTS.items()
               if any(run[2] == word for panel in data.panels for run in panel.runs)]
    handles += [entry(name, color=_LINES[name][0], linestyle=_LINES[name][1], marker="*" if _LINES[name][1] == "none" else None)
                for name in dict.fromkeys(name for panel in data.panels for name in panel.lines)]
    put_legend(figure, handles, 3 if width_mm > ONE_COLUMN else 2)
    return figure


# The source wide and pale, the run on it, a second run or a later time dashed; a single number as a cross.
_CURVES = {"source": {"color": INK, "linewidth": 4.5, "alpha": 0.25}, "run": {"color": "#0067a5", "linewidth": 1.3},
          "other": {"color": "#d04a00", "linewidth": 1.3, "linestyle": DASHED}}


def draw_gallery(data: Shown) -> Figure:
    """A curve each of `data.curves`: name, look, x, y and whether it holds its value until the next."""
    figure = new_figure(89.0, 61.0)
    axes = figure.subplots()
    axes.grid(True)
    for name, look, x, y, steps in data.curves:
        axes.plot(x, y, label=name, drawstyle="steps-post" if steps else "default", **_CURVES[look])
    axes.set(xlabel=data.x, ylabel=data.y, ylim=data.y_range)
    axes.legend(fontsize=6.5, handlelength=2.0)
    return figure


_WAYS = ((INK, "-", 5.0, 0.3), ("#0067a5", "-", 1.5, 1.0), ("#00845f", "-", 1.5, 1.0), ("#d04a00", DASHED, 1.5, 1.0))


def _draw_layers(axes: Axes, stress: Axes, data: Shown) -> None:
    """The layers as they lie, darker the stiffer, with what their borders are and the fracture at some pressures; beside them their closing stresses."""
    shade = plt.get_cmap("Greys")
    for layer in data.layers:
        colour = shade(0.05 + 0.45 * layer.modulus_GPa / max(other.modulus_GPa for other in data.layers))
        for panel, left, right in ((axes, 0.0, 1.0), (stress, data.least_MPa, layer.stress_MPa)):
            panel.barh(layer.top_m, right - left, layer.thickness_m, left=left, align="edge", color=colour, edgecolor="white", linewidth=0.6)
        axes.text(0.01, layer.top_m + 0.5 * layer.thickness_m, f"{layer.rock}, {layer.modulus_GPa:g} GPa", va="center", fontsize=5.6)
    for place, name in data.bedding:
        for panel in (axes, stress):
            panel.axhline(place, color=FLAG, linewidth=1.8)
        stress.text(data.stop_MPa, place, name, color=FLAG, fontsize=6.5, ha="right", va="bottom")
    places = [0.42 + 0.54 * k / (len(data.fractures) - 1) for k in range(len(data.fractures))]
    for x, (_, bottom, top) in zip(places, data.fractures):
        axes.plot((x, x), (bottom, top), color=FLUID, linewidth=2.2, solid_capstyle="butt")
    axes.set_xticks(places, [f"{pressure:.1f}" for pressure, _, _ in data.fractures], fontsize=5.6)
    axes.set(xlabel="layers, and the fracture at pressures (MPa)", ylabel="depth (m)", xlim=(0.0, 1.0), ylim=(data.bottom_m, data.layers[-1].top_m))
    stress.set(xlabel="closing stress (MPa)", xlim=(data.least_MPa, data.stop_MPa))


def draw_well(data: Shown) -> Figure:
    """Left the layout and the closing stress of each layer; right a line a way to compute the tip's depth."""
    figure = new_figure(TWO_COLUMNS, 115.0)
    figure.suptitle(wrapped(data.title, 104), x=0.008, ha="left", fontweight="bold")
    layout, stress, right = figure.subplots(1, 3, sharey=True, width_ratios=(1.3, 0.8, 2.2))
    _draw_layers(layout, stress, data)
    right.grid(True)
    interface_lines(right, [layer.top_m for layer in data.layers])
    for place, _ in data.bedding:
        right.axhline(place, color=FLAG, linewidth=1.8, alpha=0.6)
    for (_, pressures, depths), (colour, dashes, width, alpha) in zip(data.curves, _WAYS, strict=True):
        right.plot(pressures, depths, drawstyle="steps-post", color=colour, linestyle=dashes, linewidth=width, alpha=alpha)
    right.set(xlabel="pressure in the fracture (MPa)", xlim=(data.least_MPa, data.stop_MPa))
    put_legend(figure, [entry(name, color=look[0], linestyle=look[1], linewidth=look[2], alpha=look[3]) for (name, *_), look in zip(data.curves, _WAYS)], 2)
    return figure


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
