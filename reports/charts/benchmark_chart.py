"""Draws what benchmarks found: rates of steps, how costs grow, what events cost."""

from __future__ import annotations

from typing import TYPE_CHECKING

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch

from reports.charts.style import FLAG, INK, PALE, new_figure, panel_grid, put_legend, put_title

if TYPE_CHECKING:  # the other way round at run time: the part of the page draws itself
    from reports.benchmarks import EventFigure, RateFigure, RatePanel, ScalingFigure, ScalingPanel

# By kernels and threads.
_COLOURS: dict[tuple[str, int], str] = {
    ("fast", 1): "#7fb2dd", ("fast", 2): "#0067a5", ("plain", 1): "#d9c27a", ("plain", 2): "#8a6a00",
}
_LINES = ("#0067a5", "#d04a00", "#00845f")


def draw_rates(data: RateFigure) -> Figure:
    """A panel a kinematics, a group of bars a shape function, a bar for kernels and threads; marks dashed."""
    figure, every, _ = panel_grid(data.title, len(data.panels), 3.0)
    for axes, panel in zip(every, data.panels, strict=True):
        _draw_rates(axes, panel)
    every[0].set_ylabel("million particle-steps a second")
    kinds = dict.fromkeys((bar.kernels, bar.threads) for panel in data.panels for _, bars in panel.shapes for bar in bars)
    names = {kind: f"{kind[0]}, {kind[1]} thread{'s' if kind[1] > 1 else ''}" for kind in _COLOURS if kind in kinds}
    handles: list[Patch | Line2D] = [Patch(color=_COLOURS[kind], label=name) for kind, name in names.items()]
    handles.append(Line2D([], [], color=FLAG, linestyle=(0, (4, 2)), linewidth=1.2, label="mark (threads)"))
    put_legend(figure, handles, 5)
    return figure


def _draw_rates(axes: Axes, panel: RatePanel) -> None:
    """The bars of one kinematics."""
    axes.grid(True, axis="y")
    axes.set_title(panel.heading)
    for group, (_, bars) in enumerate(panel.shapes):
        width = 0.84 / len(bars)
        for k, bar in enumerate(bars):
            x = group - 0.42 + (k + 0.5) * width
            axes.bar(x, bar.rate, 0.92 * width, color=_COLOURS[bar.kernels, bar.threads], zorder=3)
            axes.plot([x, x], [bar.low, bar.high], color=INK, linewidth=0.9, zorder=4)
            share = "" if bar.share is None else f"\n{100.0 * bar.share:.0f}\u202f%"
            axes.annotate(f"{bar.rate:.0f}{share}", (x, bar.high), (0, 2), textcoords="offset points", ha="center", va="bottom",
                          fontsize=6.5)  # fmt: skip
    for threads, mark in panel.marks.items():
        axes.axhline(mark, color=FLAG, linestyle=(0, (4, 2)), linewidth=1.2, zorder=2)
        axes.annotate(f"{mark:g} ({threads})", (1.0, mark), (2, 0), xycoords=("axes fraction", "data"), textcoords="offset points",
                      va="center", fontsize=7, color=FLAG, annotation_clip=False)  # fmt: skip
    top = max([bar.high for _, bars in panel.shapes for bar in bars] + list(panel.marks.values()))
    axes.set_ylim(0.0, 1.22 * top)
    axes.set_xlim(-0.5, len(panel.shapes) - 0.5)
    axes.set_xticks(range(len(panel.shapes)), [name for name, _ in panel.shapes])


def draw_scaling(data: ScalingFigure) -> Figure:
    """A panel a kind of cost, both axes logarithmic; the allowed exponent dashed."""
    figure, every, _ = panel_grid(data.title, len(data.panels), 3.2)
    for axes, panel in zip(every, data.panels, strict=True):
        _draw_scaling(axes, panel)
    return figure


def _draw_scaling(axes: Axes, panel: ScalingPanel) -> None:
    """The curves of one kind."""
    axes.grid(True)
    axes.set_title(panel.heading)
    axes.set_xscale("log")
    axes.set_yscale("log")
    for colour, curve in zip(_LINES, panel.curves):
        axes.plot(curve.points, curve.seconds, color=colour, marker="o", markersize=4.5, linewidth=1.6, zorder=4,
                  label=f"{curve.label}: {curve.exponent:.2f}")  # fmt: skip
        first = curve.points[0]
        allowed = [curve.seconds[0] * (points / first) ** panel.allowed for points in curve.points]
        axes.plot(curve.points, allowed, color=PALE, linestyle=(0, (4, 2)), linewidth=1.0, zorder=2)
    axes.plot([], [], color=PALE, linestyle=(0, (4, 2)), linewidth=1.0, label=f"power {panel.allowed:g}")
    axes.legend(loc="upper left", title="exponent", title_fontsize=8)
    axes.set_xlabel("points")
    axes.set_ylabel("s")


def draw_events(data: EventFigure) -> Figure:
    """A line an event on a logarithmic axis of time, the dearest on top: median, least and most."""
    figure = new_figure(8.2, 1.3 + 0.25 * len(data.events))
    put_title(figure, data.title, 85)
    axes = figure.subplots()
    axes.grid(True, axis="x")
    axes.set_xscale("log")
    least = min(low for _, _, low, _ in data.events)
    for place, (_, middle, low, high) in enumerate(data.events):
        axes.plot([low, high], [place, place], color=_COLOURS["fast", 1], linewidth=4.0, zorder=3)
        axes.plot([middle], [place], marker="o", markersize=5, color=_COLOURS["fast", 2], zorder=4)
        axes.annotate(_time(middle), (high, place), (6, 0), textcoords="offset points", va="center", fontsize=7)
    axes.set_yticks(range(len(data.events)), [name for name, *_ in data.events], fontsize=8)
    axes.set_ylim(len(data.events) - 0.4, -0.6)
    axes.set_xlim(0.4 * least, 5.0 * max(high for *_, high in data.events))
    axes.set_xlabel("s")
    return figure


def _time(seconds: float) -> str:
    """A time in two digits."""
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "µs")):
        if seconds * factor >= 1.0:
            return f"{seconds * factor:.2g} {unit}" if seconds * factor < 10.0 else f"{seconds * factor:.0f} {unit}"
    return f"{seconds * 1e9:.0f} ns"
