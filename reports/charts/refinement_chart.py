"""Draws what refinement of the mesh does to the numbers of an experiment."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import ScalarFormatter

from reports.charts.style import COLOURS, INK, PALE, panel_grid, put_legend

if TYPE_CHECKING:  # the other way round at run time: the part of the page draws itself
    from reports.refinement import RefinementFigure, RefinementLine, RefinementPanel

_MARKS: dict[str, str] = {"perfect": "o", "friction": "v", "weak": "s", "soft": "^", "weak_soft": "D", "soft_weak": "P"}
_WIDTHS: dict[str, float] = {"perfect": 3.4, "weak": 1.9, "friction": 1.0}


def draw_refinement(data: RefinementFigure) -> Figure:
    """A panel a quantity: values against (h/h0)^p, and the limit with its uncertainty at 0."""
    figure, every, columns = panel_grid(data.title, len(data.panels), 2.9)
    for axes, panel in zip(every, data.panels, strict=True):
        _draw_panel(axes, panel)
    handles = [Line2D([], [], color=COLOURS.get(name, INK), marker=_MARKS.get(name, "o"), markersize=5, linewidth=1.4,
                      label=name.replace("_", "–")) for name in data.variants]
    handles.append(Line2D([], [], color=PALE, marker="_", markersize=9, linestyle="none", label="limit ± uncertainty"))
    handles.append(Line2D([], [], color=PALE, linestyle=(0, (3, 2)), label="no clean order, drawn against h; or sizes it is not of"))
    put_legend(figure, handles, 4 if columns < 3 else 6)
    return figure


def _draw_panel(axes: Axes, panel: RefinementPanel) -> None:
    """One quantity."""
    axes.grid(True)
    for number, line in enumerate(panel.lines):
        _draw_line(axes, line, number)
    axes.set_xlim(-0.09, 1.06)
    axes.set_title(panel.heading)
    clean = [f"{line.order:.2f} {line.variant.replace('_', '–')}" for line in panel.lines if line.order is not None]
    axes.set_xlabel("(h / coarsest h)$^p$" + (f",  p = {', '.join(clean)}" if clean else ""), fontsize=8)
    axes.set_ylabel(panel.unit)
    formatter = ScalarFormatter(useOffset=False)
    formatter.set_scientific(False)
    axes.yaxis.set_major_formatter(formatter)


def _draw_line(axes: Axes, line: RefinementLine, number: int) -> None:
    """One variant, solid over the sizes its order is of; its limit stands a little aside where several have one."""
    colour, mark = COLOURS.get(line.variant, INK), _MARKS.get(line.variant, "o")
    width = _WIDTHS.get(line.variant, 1.4)
    look = {"color": colour, "linewidth": width, "alpha": 0.45 if width > 3 else 1.0, "zorder": 5 - 0.5 * width}
    dashed = len(line.x) if line.order is None else len(line.x) - 2
    axes.plot(line.x, line.y, marker=mark, markersize=5 if width < 3 else 7, linestyle="none", **look)
    axes.plot(line.x[:dashed], line.y[:dashed], linestyle=(0, (3, 2)), **look)
    if line.order is not None:
        axes.plot(line.x[-3:], line.y[-3:], linestyle="-", **look)
    if line.limit is None:
        return
    value, uncertainty = line.limit
    axes.plot((0.0, line.x[-1]), (value, line.y[-1]), color=colour, linewidth=0.8, linestyle=(0, (1, 1.5)), zorder=2)
    axes.errorbar([-0.015 * (1 + number)], [value], yerr=[uncertainty], color=colour, marker="_", markersize=8, capsize=2.5,
                  elinewidth=1.0, zorder=4)
