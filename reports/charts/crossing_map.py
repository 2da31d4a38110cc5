"""Draws maps of verdicts with lines of criteria over them."""

import math

from matplotlib.figure import Figure
from matplotlib.ticker import FixedLocator, FuncFormatter, NullLocator

from reports.charts.style import DASHED, DOTTED, FLAG, INK, ONE_COLUMN, PALE, entry, panel_grid, put_legend
from reports.shown import Shown

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
