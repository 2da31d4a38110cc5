"""Draws errors: against wall time, panels of curves with Pareto front, marks of accuracy, uncertainty of the reference, failures; and the accuracy ladder, error
against size, a panel a case."""

import math
from collections.abc import Sequence

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from reports.charts.style import DASHED, FLAG, INK, ONE_COLUMN, PALE, entry, panel_grid, put_legend, wrapped
from reports.words import Shown, order_words

_COLOURS = {"quasistatic": "#0067a5", "updated": "#d04a00", "total": "#a3397f", "elements": "#00845f"}
_NAMES = {
    "quasistatic": "quasi-static", "updated": "explicit, updated", "total": "explicit, total",
    "elements": "boundary elements and collocation (strata-reference)",
}
_MARKS = {"bspline2": "o", "gimp": "^", "linear": "s", "elements": "D"}
_SHAPES = {"bspline2": "quadratic B-spline", "gimp": "GIMP", "linear": "linear"}
_LINES: dict[str, object] = {"-": "-", "--": (0, (4, 1.6)), ":": (0, (1, 1.4)), "-.": (0, (4, 1.4, 1, 1.4))}
_FRONT, _OTHERS = "#f0d468", "#bdbdbd"  # colours of the Pareto front and of methods in the background
_DASHES = {"--": "16 points a cell", ":": "9 points a cell", "-.": "another transfer, Courant number, kernel or flow step"}
_STRIP = 0.075  # height of the strip of failures, in shares of the axes


def draw_front(data: Shown, width_mm: float) -> Figure:
    """All panels, three in a row; methods of the background pale."""
    figure, every, columns = panel_grid(len(data.panels), 58.0, width_mm)
    for k, (axes, panel) in enumerate(zip(every, data.panels, strict=True)):
        _draw_times(axes, panel)
        axes.set_title(wrapped(panel.heading, 26))
        if k % columns == 0:
            axes.set_ylabel("relative error")
        if k + columns >= len(data.panels):
            axes.set_xlabel("wall time (s)")
    put_legend(figure, _legend(data.panels), 2 if width_mm > ONE_COLUMN else 1)
    return figure


def _draw_times(axes: Axes, panel: Shown) -> None:
    """Axes, band, lines, curves, front, failures."""
    axes.set(xscale="log", yscale="log")
    axes.grid(True, which="major")
    if not panel.curves:
        axes.annotate("nothing measured", (0.5, 0.5), xycoords="axes fraction", ha="center", color=FLAG)
        axes.set(xlim=(0.01, 100.0), ylim=(1e-4, 1.0))
        _strip(axes, panel)
        return
    _time_limits(axes, panel)
    for error in (0.05, 0.01, 0.001):
        axes.axhline(error, color=INK if error == 0.01 else PALE, linewidth=1.0, linestyle=DASHED, zorder=1)
    if panel.uncertainty > axes.get_ylim()[0]:
        axes.axhspan(axes.get_ylim()[0], panel.uncertainty, color="#c9d6e6", alpha=0.55, linewidth=0, zorder=0.5)
        axes.annotate("uncertainty of the reference", (0.985, 0.03), xycoords="axes fraction", ha="right", fontsize=5.6, color="#3b5878")
    times, errors = panel.front
    if times:
        axes.plot((*times, axes.get_xlim()[1]), (*errors, errors[-1]), drawstyle="steps-post", color=_FRONT, linewidth=4.5, alpha=0.75,
                  solid_capstyle="butt", zorder=1.5)
    for curve in panel.curves:
        _draw_curve(axes, curve, not curve.main)
    for time, error in panel.chosen:
        axes.plot([time], [error], marker="o", markersize=8, markerfacecolor="none", markeredgecolor=INK, markeredgewidth=1.4, zorder=6)
    _strip(axes, panel)


def _time_limits(axes: Axes, panel: Shown) -> None:
    """Ranges with room for the strip of failures, errors as percentages."""
    low, high = min(panel.errors[0], 6e-4) / 1.6, max(panel.errors[1], 0.06) * 1.5
    axes.set(ylim=(low, low * (high / low) ** (1.0 / (1.0 - _STRIP))), xlim=(panel.times_s[0] / 1.7, panel.times_s[1] * 1.7))
    axes.yaxis.set_major_locator(LogLocator(base=10.0, numticks=20))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100.0 * value:g} %"))
    axes.xaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{value:g}"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.xaxis.set_minor_formatter(NullFormatter())


def _draw_curve(axes: Axes, curve: Shown, pale: bool) -> None:
    """A method's way down; errors that are small by luck hang below their marks."""
    if pale:
        axes.plot(curve.times_s, curve.errors, color=_OTHERS, linewidth=0.7, marker=".", markersize=3, zorder=2)
        return
    colour = _COLOURS[curve.look.family]
    axes.plot(curve.times_s, curve.errors, color=colour, linewidth=1.3, linestyle=_LINES[curve.look.dashes], marker=_MARKS[curve.look.shape],
              markersize=3.4, markerfacecolor=colour if curve.look.filled else "white", markeredgecolor=colour, zorder=4)
    for time, error, lucky in zip(curve.times_s, curve.errors, curve.lucky):
        if lucky is not None:
            axes.plot([time, time], [error, lucky], color=colour, linewidth=0.7, linestyle=":", zorder=3)
            axes.plot([time], [lucky], color=colour, marker="_", markersize=5, zorder=3)


def _strip(axes: Axes, panel: Shown) -> None:
    """What has nothing to show: a cross at the time spent, in a strip above the curves, with their count by how they ended."""
    if not panel.lacks:
        return
    place = Rectangle((0.0, 1.0 - _STRIP), 1.0, _STRIP, transform=axes.transAxes, facecolor="#fbe4e2", edgecolor="none", zorder=2)
    axes.add_patch(place)
    left, right = axes.get_xlim()
    for lack in panel.lacks:
        spent = min(max(lack.time_s, left * 1.08), right / 1.08)
        axes.plot([spent], [1.0 - 0.5 * _STRIP], transform=axes.get_xaxis_transform(), marker="x", markersize=3.5, markeredgewidth=1.0,
                  color=_COLOURS[lack.look.family], zorder=5)
    axes.annotate(panel.lacks_words, (0.985, 0.99 - _STRIP), xycoords="axes fraction", ha="right", va="top", fontsize=5.6, color=FLAG, zorder=6)


def _legend(panels: Sequence[Shown]) -> list[Line2D]:
    """What colours, marks, fillings and lines mean, of those in use."""
    looks = [curve.look for panel in panels for curve in panel.curves if curve.main]
    families, shapes, dashes = ({getattr(look, key) for look in looks} for key in ("family", "shape", "dashes"))
    return [
        *(entry(_NAMES[name], color=colour, linewidth=2.2) for name, colour in _COLOURS.items() if name in families),
        *(entry(words, color=INK, marker=_MARKS[name], linestyle="none", markersize=5) for name, words in _SHAPES.items() if name in shapes),
        entry("hollow: uniform grid; filled: graded", color=INK, marker="o", linestyle="none", markerfacecolor="white", markersize=5),
        *(entry(words, color=INK, linewidth=1.3, linestyle=_LINES[name]) for name, words in _DASHES.items() if name in dashes),
        entry("Pareto front of the solver", color=_FRONT, linewidth=4.5),
        entry("cheapest within 1 % and 0.1 %", color=INK, marker="o", markerfacecolor="none", markersize=8, linestyle="none"),
        entry("other settings (named in the data)", color=_OTHERS, marker=".", linewidth=0.8),
        entry("hangs below: smaller by luck, not counted", color=PALE, marker="_", linestyle=":"),
        entry("refused, failed, too long or without a value", color=FLAG, marker="x", linestyle="none", markersize=5),
    ]


# Wong's palette again and paler ones, each with its own mark for those who see no colours.
_LOOKS: tuple[tuple[str, str], ...] = (
    ("#0067a5", "o"), ("#d04a00", "s"), ("#00845f", "^"), ("#a3397f", "D"), ("#8a6a00", "v"), ("#222222", "P"), ("#5b8fd9", "X"), ("#7a5230", "<"),
    ("#6b6b6b", ">"), ("#e0a030", "h"), ("#35a7b5", "*"), ("#e58a66", "p"), ("#78bd8f", "d"), ("#c98ab5", "H"), ("#9db4d6", "8"), ("#b9a36a", "."),
)
_LABEL_GAP = 0.055  # of the axes' height, between order labels


def draw_convergence(data: Shown, width_mm: float) -> Figure:
    """A panel a case on common scales of error; lines to orders 1 and 2 in a corner, the finest order beside each curve.

    A curve: its errors, its gates as dashes above, crosses where it falls short; dashed where no order is asked for.
    """
    figure, every, columns = panel_grid(len(data.panels), 56.0, width_mm, sharey=True)
    every_error = [error for panel in data.panels for curve in panel.curves for error in (*curve.errors, *curve.gates)]
    known = [error for error in every_error if math.isfinite(error) and error > 0.0]
    low, high = min(known) / 1.8, max(known) * 1.8
    looks = {name: _LOOKS[k % len(_LOOKS)] for k, name in enumerate(data.quantities)}
    for k, (axes, panel) in enumerate(zip(every, data.panels, strict=True)):
        _size_axes(axes, panel, low, high)
        for curve in panel.curves:
            colour, mark = looks[curve.quantity]
            axes.plot(curve.sizes, curve.gates, linestyle="none", marker="_", markersize=7, color=colour, alpha=0.45, zorder=2)
            axes.plot(curve.sizes, curve.errors, color=colour, marker=mark, markersize=3.2, linewidth=1.1,
                      linestyle="-" if curve.judged else (0, (2.5, 1.8)), zorder=3)
            wrong = [(size, error) for size, error, passed in zip(curve.sizes, curve.errors, curve.passed) if not passed]
            axes.plot(*zip(*wrong), linestyle="none", marker="X", markersize=5 if len(curve.sizes) > 1 else 3.5, color=FLAG, zorder=5)
        _order_labels(axes, panel, low, high, {name: colour for name, (colour, _) in looks.items()})
        _slopes(axes)
        if k % columns == 0:
            axes.set_ylabel("relative error")
    handles = [entry(name, color=colour, marker=mark, markersize=5) for name, (colour, mark) in looks.items()]
    handles += [entry("gate", color=PALE, marker="_", markersize=11, linestyle="none"),
                entry("not as its gate asks", color=FLAG, marker="X", markersize=8, linestyle="none")]
    longest = max(len(str(handle.get_label())) for handle in handles)
    put_legend(figure, handles, max(1, min(6, int(figure.get_figwidth() / (0.058 * longest + 0.55)))))  # as many columns as the longest allows
    return figure


def _size_axes(axes: Axes, panel: Shown, low: float, high: float) -> None:
    """Logarithmic axes with the sizes of the levels as ticks; fine on the left, with room there for order labels."""
    sizes = sorted({size for curve in panel.curves for size in curve.sizes})
    axes.set(xscale="log", yscale="log", xlim=(sizes[0] / 1.9, sizes[-1] * 1.25), ylim=(low, high))
    axes.xaxis.set_major_locator(NullLocator())
    axes.xaxis.set_minor_locator(NullLocator())
    axes.set_xticks(sizes, [f"{size:.3g}" for size in sizes])
    axes.xaxis.set_minor_formatter(NullFormatter())
    axes.set(title=wrapped(panel.heading, 34), xlabel={"m": "cell size (m)", "s": "step (s)"}.get(panel.unit, "size (m)"))
    axes.grid(True, which="major")
    axes.yaxis.set_major_locator(LogLocator(base=10.0, numticks=20))
    axes.yaxis.set_major_formatter(FuncFormatter(lambda value, _: f"{100.0 * value:g} %" if value > 9e-7 else f"$10^{{{round(math.log10(value))}}}$"))
    axes.yaxis.set_minor_formatter(NullFormatter())
    axes.tick_params(labelleft=axes.get_subplotspec().is_first_col())


def _order_labels(axes: Axes, panel: Shown, low: float, high: float, colours: dict[str, str]) -> None:
    """The order of the finest pair beside the finest point of each curve that is judged by it, apart where they would overlap."""
    height = math.log(high / low)
    judged = [curve for curve in panel.curves if curve.order is not None and curve.judged]
    wanted = sorted([(math.log(curve.errors[-1] / low) / height, curve) for curve in judged], key=lambda pair: pair[0])
    places = spread_apart([place for place, _ in wanted], _LABEL_GAP)
    for place, (_, curve) in zip(places, wanted):
        axes.annotate(order_words(curve.order), (curve.sizes[-1], low * math.exp(place * height)), xytext=(-7, 0), textcoords="offset points",
                      ha="right", va="center", fontsize=6, color=colours[curve.quantity], fontweight="bold", zorder=6)


def spread_apart(places: list[float], gap: float) -> list[float]:
    """Sorted places moved as little as needed for a gap between neighbours: those too near form a group about their mean."""

    def ends(group: list[float]) -> tuple[float, float]:
        """The first and last place of a group whose members are a gap apart about their mean."""
        middle, half = sum(group) / len(group), 0.5 * gap * (len(group) - 1)
        return middle - half, middle + half

    groups: list[list[float]] = []
    for place in places:
        groups.append([place])
        while len(groups) > 1 and ends(groups[-1])[0] - ends(groups[-2])[1] < gap:
            last = groups.pop()
            groups[-1] += last
    return [ends(group)[0] + gap * k for group in groups for k in range(len(group))]


def _slopes(axes: Axes) -> None:
    """Triangles of order 1 and 2 in the lower right corner, in the scales of the axes."""
    (left, right), (low, high) = axes.get_xlim(), axes.get_ylim()
    across = 0.16 * math.log(right / left)
    x_end = right / math.exp(0.05 * math.log(right / left))
    x_start = x_end / math.exp(across)
    base = low * (high / low) ** 0.05
    for order in (1, 2):
        top = base * math.exp(order * across)
        if top <= high:
            axes.plot([x_start, x_end, x_end, x_start], [base, base, top, base], color=PALE, linewidth=0.8, zorder=1)
            axes.annotate(f"{order}", (x_end, top), xytext=(2.5, 0), textcoords="offset points", fontsize=5.5, color=INK, va="center")
