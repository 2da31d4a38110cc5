"""Draws the accuracy ladder: error against size, a panel a case, and error against cost, a panel a family."""

from __future__ import annotations

import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from reports.charts.style import FLAG, INK, PALE, panel_grid, put_legend
from reports.ladder import ConvergenceFigure, CostFigure, Curve, Panel, order_words
from reports.words import mechanics_name

# Wong's palette again and paler ones, each with its own mark for those who see no colours.
_LOOKS: tuple[tuple[str, str], ...] = (
    ("#0067a5", "o"), ("#d04a00", "s"), ("#00845f", "^"), ("#a3397f", "D"), ("#8a6a00", "v"), ("#222222", "P"),
    ("#5b8fd9", "X"), ("#7a5230", "<"), ("#6b6b6b", ">"), ("#e0a030", "h"), ("#35a7b5", "*"), ("#e58a66", "p"), ("#78bd8f", "d"),
    ("#c98ab5", "H"), ("#9db4d6", "8"), ("#b9a36a", "."),
)
_LABEL_GAP = 0.055  # of the axes' height, between order labels


def draw_convergence(data: ConvergenceFigure) -> Figure:
    """A panel a case on common scales of error; lines to orders 1 and 2 in a corner, the finest order beside each curve."""
    figure, every, columns = panel_grid(data.title, len(data.panels), 3.4, sharey=True)
    low, high = _decades([error for panel in data.panels for curve in panel.curves for error in (*curve.errors, *curve.gates)])
    looks = {name: _LOOKS[k % len(_LOOKS)] for k, name in enumerate(data.quantities)}
    for k, (axes, panel) in enumerate(zip(every, data.panels, strict=True)):
        _size_axes(axes, panel, low, high)
        for curve in panel.curves:
            _draw_curve(axes, curve, *looks[curve.quantity])
        _order_labels(axes, panel, low, high, {name: colour for name, (colour, _) in looks.items()})
        _slopes(axes)
        if k % columns == 0:
            axes.set_ylabel("relative error")
    handles = [Line2D([], [], color=colour, marker=mark, markersize=5, label=name) for name, (colour, mark) in looks.items()]
    handles.append(Line2D([], [], color=PALE, marker="_", markersize=11, linestyle="none", label="gate"))
    handles.append(Line2D([], [], color=FLAG, marker="X", markersize=8, linestyle="none", label="not as its gate asks"))
    put_legend(figure, handles, _legend_columns(handles, figure.get_figwidth()))
    return figure


def draw_cost(data: CostFigure) -> Figure:
    """Every case's way down in error with wall time, a panel a family and a colour a mechanics."""
    figure, every, columns = panel_grid(data.title, len(data.panels), 3.1, sharey=True, sharex=True)
    looks = {name: _LOOKS[k] for k, name in enumerate(data.mechanics)}
    for k, (axes, panel) in enumerate(zip(every, data.panels, strict=True)):
        axes.grid(True, which="major")
        axes.set(xscale="log", yscale="log")
        axes.set_title(panel.heading)
        _percent_axis(axes)
        axes.axhline(0.01, color=PALE, linewidth=0.9, linestyle=(0, (4, 2)), zorder=1)
        for curve in panel.curves:
            colour, mark = looks[curve.mechanics]
            axes.plot(curve.walls_s, curve.errors, color=colour, linewidth=0.9, marker=mark, markersize=3.4, alpha=0.75, zorder=3)
            _crosses(axes, curve.walls_s, curve)
        if k % columns == 0:
            axes.set_ylabel("largest relative error of the case")
        if k + columns >= len(data.panels):
            axes.set_xlabel("wall time of the run (s)")
            axes.tick_params(labelbottom=True)
    handles = [Line2D([], [], color=colour, marker=mark, markersize=5, label=mechanics_name(name))
               for name, (colour, mark) in looks.items()]
    handles.append(Line2D([], [], color=FLAG, marker="X", markersize=8, linestyle="none", label="not as its gate asks"))
    put_legend(figure, handles, _legend_columns(handles, figure.get_figwidth()))
    return figure


def _legend_columns(handles: list[Line2D], width_in: float) -> int:
    """As many columns as the longest label lets into a width."""
    longest = max(len(str(handle.get_label())) for handle in handles)
    return max(1, min(6, int(width_in / (0.075 * longest + 0.7))))


def _size_axes(axes: Axes, panel: Panel, low: float, high: float) -> None:
    """Logarithmic axes with the sizes of the levels as ticks; fine on the left, with room there for order labels."""
    sizes = sorted({size for curve in panel.curves for size in curve.sizes})
    axes.set(xscale="log", yscale="log", xlim=(sizes[0] / 1.9, sizes[-1] * 1.25), ylim=(low, high))
    axes.xaxis.set_major_locator(NullLocator())
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(sizes, [f"{size:.3g}" for size in sizes])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set_title(panel.heading)
    axes.set_xlabel({"m": "cell size (m)", "s": "step (s)"}.get(panel.unit, "size (m)"))
    axes.grid(True, which="major")
    _percent_axis(axes)


def _percent_axis(axes: Axes) -> None:
    """Errors as percentages on the decades."""
    axes.yaxis.set_major_locator(LogLocator(base=10.0, numticks=20))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100.0 * value:g} %" if value >= 1e-7 else f"{value:.0e}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(labelleft=axes.get_subplotspec().is_first_col())


def _decades(errors: list[float]) -> tuple[float, float]:
    """A range of errors that holds all of them with some room."""
    known = [error for error in errors if math.isfinite(error) and error > 0.0]
    return min(known) / 1.8, max(known) * 1.8


def _draw_curve(axes: Axes, curve: Curve, colour: str, mark: str) -> None:
    """One quantity: its errors, its gates as dashes above, crosses where it falls short; dashed where no order is asked for."""
    axes.plot(curve.sizes, curve.gates, linestyle="none", marker="_", markersize=11, color=colour, alpha=0.45, zorder=2)
    axes.plot(curve.sizes, curve.errors, color=colour, marker=mark, markersize=4.6, linewidth=1.5,
              linestyle="-" if curve.judged else (0, (2.5, 1.8)), zorder=3)
    _crosses(axes, curve.sizes, curve)


def _crosses(axes: Axes, places: tuple[float, ...], curve: Curve) -> None:
    """A red cross on every point that is not as its gate asks."""
    size = 7 if len(places) > 1 else 4.5
    wrong = [(place, error) for place, error, passed in zip(places, curve.errors, curve.passed) if not passed]
    if wrong:
        axes.plot(*zip(*wrong), linestyle="none", marker="X", markersize=size, color=FLAG, zorder=5)


def _order_labels(axes: Axes, panel: Panel, low: float, high: float, colours: dict[str, str]) -> None:
    """The order of the finest pair beside the finest point of each curve that is judged by it, apart where they would overlap."""
    height = math.log(high / low)
    judged = [curve for curve in panel.curves if curve.order is not None and curve.judged]
    known = [(math.log(curve.errors[-1] / low) / height, curve) for curve in judged]
    wanted = sorted(known, key=lambda pair: pair[0])
    places = spread_apart([place for place, _ in wanted], _LABEL_GAP)
    for place, (_, curve) in zip(places, wanted):
        end = (curve.sizes[-1], low * math.exp(place * height))
        axes.annotate(order_words(curve.order), end, xytext=(-7, 0), textcoords="offset points", ha="right", va="center",
                      fontsize=8.5, color=colours[curve.quantity], fontweight="bold", zorder=6)


def spread_apart(places: list[float], gap: float) -> list[float]:
    """Sorted places moved as little as needed for a gap between neighbours: those too near form a group about their mean."""
    groups: list[list[float]] = []
    for place in places:
        groups.append([place])
        while len(groups) > 1 and _ends(groups[-1], gap)[0] - _ends(groups[-2], gap)[1] < gap:
            last = groups.pop()
            groups[-1] += last
    return [_ends(group, gap)[0] + gap * k for group in groups for k in range(len(group))]


def _ends(group: list[float], gap: float) -> tuple[float, float]:
    """The first and last place of a group whose members are a gap apart about their mean."""
    middle, half = sum(group) / len(group), 0.5 * gap * (len(group) - 1)
    return middle - half, middle + half


def _slopes(axes: Axes) -> None:
    """Triangles of order 1 and 2 in the lower right corner, in the scales of the axes."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    across = 0.16 * math.log(right / left)
    x_end = right / math.exp(0.05 * math.log(right / left))
    x_start = x_end / math.exp(across)
    base = low * (high / low) ** 0.05
    for order in (1, 2):
        top = base * math.exp(order * across)
        if top > high:
            continue
        axes.plot([x_start, x_end, x_end, x_start], [base, base, top, base], color=PALE, linewidth=0.8, zorder=1)
        axes.annotate(f"{order}", (x_end, top), xytext=(2.5, 0), textcoords="offset points", fontsize=7.5, color=INK, va="center")
