"""Draws the parts of the page of verification: ingredients, benchmarks, budgets, refinement, paths."""

from typing import Any

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle
from matplotlib.ticker import ScalarFormatter

from reports.charts.style import COLOURS, DASHED, FLAG, INK, PALE, entry, new_figure, panel_grid, panel_rows, put_legend
from reports.shown import Shown

# Effects of leaving an ingredient out from these shares on, with their colour and name.
_STEPS: tuple[tuple[float, str, str], ...] = (
    (0.0, "#eef3f8", "below 0.1 %"), (1e-3, "#c9dcee", "0.1 to 1 %"), (1e-2, "#f3c67a", "1 to 10 %"), (1e-1, "#e07b39", "10 % and more"),
)
_OTHER, _FAILED = ("#8c2d04", "≠ something else happens"), ("#d9d9d9", "the run says nothing")


def draw_ablation(data: Shown) -> Figure:
    """A row an ingredient, a column a scene; colours by the size of the effect, the time below it."""
    width = max(2.9 + 0.72 * len(data.columns), 8.0)
    figure = new_figure(width, 1.9 + 0.36 * len(data.rows), data.title, int(11.0 * width))
    axes = figure.subplots()
    for place, (_, cells) in enumerate(data.rows):
        for column, cell in enumerate(cells):
            if cell is not None:
                _draw_cell(axes, column, place, cell)
    axes.set(xlim=(-0.5, len(data.columns) - 0.5), ylim=(len(data.rows) - 0.5, -0.5))
    axes.set_xticks(range(len(data.columns)), data.columns, fontsize=8)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(data.rows)), [label for label, _ in data.rows], fontsize=8)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    put_legend(figure, [Patch(facecolor=look[-2], label=look[-1]) for look in (*_STEPS, _OTHER, _FAILED)], 3)
    return figure


def _draw_cell(axes: Axes, column: int, place: int, cell: Shown) -> None:
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
    ink = "white" if cell.changes else INK
    axes.text(column, place - 0.13, words, ha="center", va="center", fontsize=8, color=ink)
    time = f"×{cell.time:.1f}" if cell.time >= 1.0 else f"×{cell.time:.2f}"
    axes.text(column, place + 0.28, time, ha="center", va="center", fontsize=6.5, color=ink)


# --- benchmarks; colours by kernels and threads

_RATES: dict[tuple[str, int], str] = {("fast", 1): "#7fb2dd", ("fast", 2): "#0067a5", ("plain", 1): "#d9c27a", ("plain", 2): "#8a6a00"}
_LINES = ("#0067a5", "#d04a00", "#00845f")


def draw_rates(data: Shown) -> Figure:
    """A panel a kinematics, a group of bars a shape function, a bar for kernels and threads; marks dashed."""
    figure, every, _ = panel_grid(data.title, len(data.panels), 3.0)
    for axes, panel in zip(every, data.panels, strict=True):
        _draw_rates(axes, panel)
    every[0].set_ylabel("million particle-steps a second")
    kinds = {(bar.kernels, bar.threads) for panel in data.panels for _, bars in panel.shapes for bar in bars}
    handles: list[Any] = [Patch(color=colour, label=f"{kernels}, {threads} thread{'s' if threads > 1 else ''}")
                          for (kernels, threads), colour in _RATES.items() if (kernels, threads) in kinds]
    put_legend(figure, [*handles, entry("mark (threads)", color=FLAG, linestyle=DASHED, linewidth=1.2)], 5)
    return figure


def _draw_rates(axes: Axes, panel: Shown) -> None:
    """The bars of one kinematics."""
    axes.grid(True, axis="y")
    axes.set_title(panel.heading)
    for group, (_, bars) in enumerate(panel.shapes):
        width = 0.84 / len(bars)
        for k, bar in enumerate(bars):
            x = group - 0.42 + (k + 0.5) * width
            axes.bar(x, bar.rate, 0.92 * width, color=_RATES[bar.kernels, bar.threads], zorder=3)
            axes.plot([x, x], [bar.low, bar.high], color=INK, linewidth=0.9, zorder=4)
            share = "" if bar.share is None else f"\n{100.0 * bar.share:.0f}\u202f%"
            axes.annotate(f"{bar.rate:.0f}{share}", (x, bar.high), (0, 2), textcoords="offset points", ha="center", va="bottom", fontsize=6.5)
    for threads, mark in panel.marks.items():
        axes.axhline(mark, color=FLAG, linestyle=DASHED, linewidth=1.2, zorder=2)
        axes.annotate(f"{mark:g} ({threads})", (1.0, mark), (2, 0), xycoords=("axes fraction", "data"), textcoords="offset points", va="center",
                      fontsize=7, color=FLAG, annotation_clip=False)
    top = max([bar.high for _, bars in panel.shapes for bar in bars] + list(panel.marks.values()))
    axes.set(xlim=(-0.5, len(panel.shapes) - 0.5), ylim=(0.0, 1.22 * top))
    axes.set_xticks(range(len(panel.shapes)), [name for name, _ in panel.shapes])


def draw_scaling(data: Shown) -> Figure:
    """A panel a kind of cost, both axes logarithmic; the allowed exponent dashed."""
    figure, every, _ = panel_grid(data.title, len(data.panels), 3.2)
    dashed: dict[str, Any] = {"color": PALE, "linestyle": DASHED, "linewidth": 1.0}
    for axes, panel in zip(every, data.panels, strict=True):
        axes.grid(True)
        axes.set(title=panel.heading, xscale="log", yscale="log", xlabel="points", ylabel="s")
        for colour, curve in zip(_LINES, panel.curves):
            label = f"{curve.label}: {curve.exponent:.2f}"
            axes.plot(curve.points, curve.seconds, color=colour, marker="o", markersize=4.5, linewidth=1.6, zorder=4, label=label)
            allowed = [curve.seconds[0] * (points / curve.points[0]) ** panel.allowed for points in curve.points]
            axes.plot(curve.points, allowed, zorder=2, **dashed)
        axes.plot([], [], label=f"power {panel.allowed:g}", **dashed)
        axes.legend(loc="upper left", title="exponent", title_fontsize=8)
    return figure


def draw_events(data: Shown) -> Figure:
    """A line an event on a logarithmic axis of time, the dearest on top: median, least and most."""
    figure = new_figure(8.2, 1.3 + 0.25 * len(data.events), data.title, 85)
    axes = figure.subplots()
    axes.grid(True, axis="x")
    axes.set_xscale("log")
    for place, (_, middle, low, high) in enumerate(data.events):
        axes.plot([low, high], [place, place], color=_RATES["fast", 1], linewidth=4.0, zorder=3)
        axes.plot([middle], [place], marker="o", markersize=5, color=_RATES["fast", 2], zorder=4)
        axes.annotate(_time(middle), (high, place), (6, 0), textcoords="offset points", va="center", fontsize=7)
    axes.set_yticks(range(len(data.events)), [name for name, *_ in data.events], fontsize=8)
    axes.set(ylim=(len(data.events) - 0.4, -0.6), xlim=(0.4 * min(low for _, _, low, _ in data.events), 5.0 * max(high for *_, high in data.events)))
    axes.set(xlabel="s")
    return figure


def _time(seconds: float) -> str:
    """A time in two digits."""
    for factor, unit in ((1.0, "s"), (1e3, "ms"), (1e6, "µs")):
        if seconds * factor >= 1.0:
            return f"{seconds * factor:.2g} {unit}" if seconds * factor < 10.0 else f"{seconds * factor:.0f} {unit}"
    return f"{seconds * 1e9:.0f} ns"


# --- budgets; a pair of colours a group: the first alternative of a factor and the others

_GROUPS: dict[str, tuple[str, str, str]] = {
    "numerical": ("#7fb2dd", "#0067a5", "numerical factor"), "model": ("#d9c27a", "#8a6a00", "choice of the model"),
    "beside": ("#c9c9c9", "#8a8a8a", "beside, in no sum"),
}


def draw_budget(data: Shown) -> Figure:
    """A row of panels a variant, a panel a quantity; bars from 0 to the effect, largest factor on top."""
    width = max(8.2, 3.0 * max(len(panels) for _, panels in data.variants))
    figure = new_figure(width, 1.2 + 2.9 * len(data.variants), data.title, int(10.4 * width))
    rows = [[(variant, panel) for panel in panels] for variant, panels in data.variants]
    for axes, (variant, panel), first in panel_rows(figure, rows):
        _draw_budget_panel(axes, panel)
        axes.set_title(f"{variant}\n{panel.heading}" if first else f"\n{panel.heading}", fontsize=8.5)
    groups = {row.group for _, panels in data.variants for panel in panels for row in panel.rows}
    put_legend(figure, [Patch(color=colour, label=name) for group, (_, colour, name) in _GROUPS.items() if group in groups], 3)
    return figure


def _draw_budget_panel(axes: Axes, panel: Shown) -> None:
    """One quantity of one variant."""
    axes.grid(True, axis="x")
    axes.axvline(0.0, color=INK, linewidth=0.8)
    values = [bar.value for row in panel.rows for bar in row.bars if bar.value is not None]
    reach = max((abs(value) for value in values), default=1.0) or 1.0
    for place, row in enumerate(panel.rows):
        _draw_factor(axes, place, row, reach)
    low, high = min([0.0, *values]), max([0.0, *values])
    axes.set_yticks(range(len(panel.rows)), [row.label for row in panel.rows], fontsize=7.5)
    axes.set(ylim=(len(panel.rows) - 0.5, -0.5), xlim=(low - (0.4 if low < 0.0 else 0.15) * reach, high + (0.4 if high > 0.0 else 0.15) * reach))
    axes.set(xlabel=panel.unit)
    axes.tick_params(axis="x", labelsize=7.5)


def _draw_factor(axes: Axes, place: int, row: Shown, reach: float) -> None:
    """One factor: its alternatives under one another, each with its effect in two digits."""
    height = 0.76 / max(len(row.bars), 1)
    colours = _GROUPS.get(row.group, _GROUPS["beside"])
    for k, bar in enumerate(row.bars):
        y = place - 0.38 + (k + 0.5) * height
        if bar.value is None:
            axes.plot([0.0], [y], marker="x", color=FLAG, markersize=4.5, zorder=4)
            continue
        axes.barh(y, bar.value, height=0.9 * height, color=colours[min(k + (len(row.bars) == 1), 1)], zorder=3)
        told = "0" if bar.value == 0.0 else (f"{bar.value:+.0f}" if abs(bar.value) >= 10.0 else f"{bar.value:+.2g}").replace("-", "−")
        side, where = (1.0, "left") if bar.value >= 0.0 else (-1.0, "right")
        axes.text(bar.value + 0.02 * side * reach, y, told, fontsize=5.5, va="center", ha=where)


# --- refinement

_MARKS: dict[str, str] = {"perfect": "o", "friction": "v", "weak": "s", "soft": "^", "weak_soft": "D", "soft_weak": "P"}
_WIDTHS: dict[str, float] = {"perfect": 3.4, "weak": 1.9, "friction": 1.0}


def draw_refinement(data: Shown) -> Figure:
    """A panel a quantity: values against (h/h0)^p, and the limit with its uncertainty at 0."""
    figure, every, columns = panel_grid(data.title, len(data.panels), 2.9)
    for axes, panel in zip(every, data.panels, strict=True):
        axes.grid(True)
        for number, line in enumerate(panel.lines):
            _draw_refined(axes, line, number)
        axes.set(xlim=(-0.09, 1.06), title=panel.heading)
        clean = [f"{line.order:.2f} {line.variant.replace('_', '–')}" for line in panel.lines if line.order is not None]
        axes.set_xlabel("(h / coarsest h)$^p$" + (f",  p = {', '.join(clean)}" if clean else ""), fontsize=8)
        axes.set_ylabel(panel.unit)
        formatter = ScalarFormatter(useOffset=False)
        formatter.set_scientific(False)
        axes.yaxis.set_major_formatter(formatter)
    handles = [entry(name.replace("_", "–"), color=COLOURS.get(name, INK), marker=_MARKS.get(name, "o"), markersize=5, linewidth=1.4)
               for name in data.variants]
    handles.append(entry("limit ± uncertainty", color=PALE, marker="_", markersize=9, linestyle="none"))
    handles.append(entry("no clean order, drawn against h; or sizes it is not of", color=PALE, linestyle=(0, (3, 2))))
    put_legend(figure, handles, 4 if columns < 3 else 6)
    return figure


def _draw_refined(axes: Axes, line: Shown, number: int) -> None:
    """One variant, solid over the sizes its order is of; its limit stands a little aside where several have one."""
    colour, mark = COLOURS.get(line.variant, INK), _MARKS.get(line.variant, "o")
    width = _WIDTHS.get(line.variant, 1.4)
    look: dict[str, Any] = {"color": colour, "linewidth": width, "alpha": 0.45 if width > 3 else 1.0, "zorder": 5 - 0.5 * width}
    dashed = len(line.x) if line.order is None else len(line.x) - 2
    axes.plot(line.x, line.y, marker=mark, markersize=5 if width < 3 else 7, linestyle="none", **look)
    axes.plot(line.x[:dashed], line.y[:dashed], linestyle=(0, (3, 2)), **look)
    if line.order is not None:
        axes.plot(line.x[-3:], line.y[-3:], linestyle="-", **look)
    if line.limit is not None:
        value, uncertainty = line.limit
        axes.plot((0.0, line.x[-1]), (value, line.y[-1]), color=colour, linewidth=0.8, linestyle=(0, (1, 1.5)), zorder=2)
        axes.errorbar([-0.015 * (1 + number)], [value], yerr=[uncertainty], color=colour, marker="_", markersize=8, capsize=2.5, elinewidth=1.0,
                      zorder=4)


# --- paths beside boundary elements

_RUNS: tuple[tuple[str, str], ...] = (
    ("#0067a5", "o"), ("#d04a00", "s"), ("#00845f", "^"), ("#a3397f", "D"), ("#8a6a00", "v"), ("#5b8fd9", "X"), ("#7a5230", "P"),
)
_TOP_M = 27.0  # what is drawn of runs that go on


def draw_path_check(data: Shown) -> Figure:
    """A panel an experiment: boundary elements as lines, runs as marks, the interface; a legend beside each."""
    figure = new_figure(5.4 * len(data.panels), 6.6, data.title, 52 * len(data.panels))
    dashed: dict[str, Any] = {"linewidth": 1.3, "linestyle": (0, (3, 1.5))}
    for axes, panel, _ in panel_rows(figure, [data.panels]):
        axes.grid(True)
        axes.plot(*panel.converged.T, color=PALE, linewidth=5, alpha=0.55, solid_capstyle="butt", label=panel.converged_words, zorder=2)
        for k, run in enumerate(panel.runs):
            colour, mark = _RUNS[k % len(_RUNS)]
            axes.plot(*run.tips.T, color=colour, marker=mark, markersize=3.6, linewidth=0.8, label=run.label, zorder=4)
            if panel.shows_same:
                axes.plot(*run.same.T, color=colour, zorder=3, **dashed)
        _show_compared(axes, panel)
        axes.set(title=panel.heading, xlabel="x from the first line (m)", ylabel="height (m)")
        if panel.shows_same:
            axes.plot([], [], color=INK, label="boundary elements, forward, increments of the run", **dashed)
        axes.legend(loc="upper center", bbox_to_anchor=(0.5, -0.1), fontsize=7.5, ncols=1)
    return figure


def _show_compared(axes: Axes, panel: Shown) -> None:
    """Room for what is compared; the interface where it is near."""
    shown = [tips[tips[:, 1] <= _TOP_M] for tips in (panel.converged, *(run.tips for run in panel.runs))]
    left, right = min(float(tips[:, 0].min()) for tips in shown), max(float(tips[:, 0].max()) for tips in shown)
    if right > 0.7 * panel.interface_m:
        right = panel.interface_m + 1.0
        axes.axvline(panel.interface_m, color=INK, linewidth=1.6)
        axes.annotate("interface", (panel.interface_m, 0.0), xycoords=("data", "axes fraction"), xytext=(4, 6), textcoords="offset points",
                      rotation=90, ha="left", va="bottom", fontsize=8)
    room = 0.06 * (right - left)
    top = max(float(tips[tips[:, 0] <= right][:, 1].max()) for tips in shown)
    axes.set(xlim=(left - room, right + room), ylim=(4.5, top + 0.5))
