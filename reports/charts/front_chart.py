"""Draws the README's picture: heights against inlet pressure or paths, a panel an experiment, with the verdicts on its claims."""
from __future__ import annotations

from dataclasses import dataclass

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.lines import Line2D

from reports.charts.style import INK, interface_lines, line_of, new_figure, put_legend

SIGNS = {"reproduced": "✓", "only under a variant": "(✓)", "not reproduced": "✗"}


@dataclass(frozen=True)
class Curve:
    """A run's curve: inlet pressure (MPa) or x (m) against height (m); beside: of the other mechanics, drawn thin."""

    variant: str
    x: tuple[float, ...]
    height_m: tuple[float, ...]
    beside: bool


@dataclass(frozen=True)
class Panel:
    """An experiment: its curves, whether they are paths, interfaces' places (m), and verdicts (id, without and with inertia)."""

    title: str
    is_path: bool
    curves: tuple[Curve, ...]
    interfaces_m: tuple[float, ...]
    verdicts: tuple[tuple[str, str, str], ...]


def draw_front(panels: tuple[Panel, ...]) -> Figure:
    """Two rows of three panels with one legend."""
    figure = new_figure(11.0, 7.4)
    axes = [one for row in figure.subplots(2, 3) for one in row]
    for one, panel in zip(axes, panels):
        _draw_panel(one, panel)
    variants = dict.fromkeys(curve.variant for panel in panels for curve in panel.curves)
    lines = [Line2D([], [], label=name.replace("_", " below "), **line_of(name, solid=True)) for name in variants]
    lines += [Line2D([], [], color=INK, linewidth=1.1, linestyle=(0, (4.5, 2.2)), label="with inertia (thin, dashed)")]
    lines += [Line2D([], [], linestyle="", label=f"{sign} claim {verdict}") for verdict, sign in SIGNS.items()]
    put_legend(figure, lines, 5)
    return figure


def _draw_panel(axes: Axes, panel: Panel) -> None:
    """Curves, interfaces, and below the title each claim's id with its verdict, without and with inertia."""
    axes.grid(True)
    axes.set_title(f"{panel.title}\n\n", color=INK)
    if panel.is_path:
        for place in panel.interfaces_m:
            axes.axvline(place, color=INK, linewidth=0.9, linestyle=(0, (1, 1.5)), zorder=1)
    else:
        interface_lines(axes, panel.interfaces_m)
    for curve in panel.curves:
        how = {} if panel.is_path else {"drawstyle": "steps-post"}
        axes.plot(curve.x, curve.height_m, **how, **line_of(curve.variant, curve.beside, True))
    axes.set_xlabel("x (m)" if panel.is_path else "inlet pressure (MPa)")
    axes.set_ylabel("height (m)")
    for place, (words, above) in enumerate((("without inertia", 1.08), ("with inertia", 1.02)), 1):
        told = "   ".join(f"{verdict[0]} {SIGNS.get(verdict[place], '?')}" for verdict in panel.verdicts)
        axes.text(0.0, above, f"{words}:  {told}", transform=axes.transAxes, fontsize=8.5)
