"""Draws the small picture of a gallery scene: what a run gave over what its source gives."""

from matplotlib.figure import Figure

from reports.charts.style import DASHED, INK, new_figure
from reports.shown import Shown

# The source wide and pale, the run on it, a second run or a later time dashed; a single number as a cross.
_LOOKS = {"source": {"color": INK, "linewidth": 4.5, "alpha": 0.25}, "run": {"color": "#0067a5", "linewidth": 1.3},
          "other": {"color": "#d04a00", "linewidth": 1.3, "linestyle": DASHED}}


def draw_gallery(data: Shown) -> Figure:
    """A curve each of `data.curves`: name, look, x, y and whether it holds its value until the next."""
    figure = new_figure(89.0, 61.0)
    axes = figure.subplots()
    axes.grid(True)
    for name, look, x, y, steps in data.curves:
        axes.plot(x, y, label=name, drawstyle="steps-post" if steps else "default", **_LOOKS[look])
    axes.set(xlabel=data.x, ylabel=data.y, ylim=data.y_range)
    axes.legend(fontsize=6.5, handlelength=2.0)
    return figure
