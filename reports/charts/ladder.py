"""Draws the accuracy ladder: error against size, a panel a case."""

import math

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.ticker import FuncFormatter, LogLocator, NullFormatter, NullLocator

from reports.charts.style import FLAG, INK, PALE, entry, panel_grid, put_legend, wrapped
from reports.words import Shown, order_words

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
