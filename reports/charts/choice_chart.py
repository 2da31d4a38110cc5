"""Draws an open point: every choice beside the default, one panel an experiment and one row a mechanics."""

from __future__ import annotations

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.charts.style import COLOURS, FLAG, INK, PALE, new_figure, put_legend, put_title
from reports.choices import ChoiceFigure, ChoiceLine, ChoicePanel

_DASHES: tuple[object, ...] = ("-", (0, (5, 1.8)), (0, (1.2, 1.4)), (0, (5, 1.4, 1.2, 1.4)))


def draw_choice(data: ChoiceFigure) -> Figure:
    """The default wide and pale, the choices thin and dashed; the colour says which interface."""
    columns = max(len(row) for row in data.rows)
    width = max(8.2, 4.6 * columns + 0.6)
    figure = new_figure(width, 0.9 + 4.1 * len(data.rows))
    put_title(figure, data.title, int(10.4 * width))
    every = figure.subplots(len(data.rows), columns, squeeze=False)
    for line, row in zip(every, data.rows):
        for axes in line[len(row):]:
            axes.set_axis_off()
        for axes, panel in zip(line, row):
            _draw_panel(axes, panel)
    handles = [Line2D([], [], color=COLOURS.get(name, PALE), linewidth=2.4, label=name.replace("_", "–"))
               for name in data.variants]
    handles.append(Line2D([], [], label=f"default: {data.default}", **{**_look(0), "color": INK}))
    handles += [Line2D([], [], label=name, **{**_look(index), "color": INK}) for index, name in enumerate(data.choices, 1)]
    put_legend(figure, handles, 4 if columns > 1 else 2)
    return figure


def _look(choice: int) -> dict[str, object]:
    """Width and dashes of a choice's line; 0 is the default."""
    if choice == 0:
        return {"linewidth": 5.0, "alpha": 0.28, "linestyle": "-", "solid_capstyle": "butt", "zorder": 2.0}
    return {"linewidth": 1.5, "linestyle": _DASHES[choice % len(_DASHES)], "zorder": 3.0}


def _draw_panel(axes: Axes, panel: ChoicePanel) -> None:
    """One experiment in one mechanics."""
    axes.grid(True)
    mark = axes.axvline if panel.is_path else axes.axhline
    for place in panel.interfaces:
        mark(place, color=PALE, linewidth=0.9, linestyle=(0, (1, 1.5)), zorder=1)
    for line in panel.lines:
        _draw_line(axes, line, panel.is_path)
    axes.set_xlim(*panel.x_range)
    axes.set_ylim(*panel.y_range)
    axes.set_title(panel.heading)
    axes.set_xlabel("x (m)" if panel.is_path else "inlet pressure (MPa)")
    axes.set_ylabel("height above the symmetry line (m)" if panel.is_path else "fracture height (m)")


def _draw_line(axes: Axes, line: ChoiceLine, is_path: bool) -> None:
    """One run."""
    colour = COLOURS.get(line.variant, PALE)
    axes.plot(line.x, line.y, drawstyle="default" if is_path else "steps-post", color=colour, **_look(line.choice))
    if line.failed:
        axes.plot(line.x[-1:], line.y[-1:], marker="X", markersize=8, color=FLAG, zorder=6)
    elif line.choice:
        axes.plot(line.x[-1:], line.y[-1:], marker="x", markersize=4.5, color=colour, zorder=5)
