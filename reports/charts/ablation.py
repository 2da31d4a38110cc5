"""Draws what each ingredient of a scene is worth."""

from matplotlib.axes import Axes
from matplotlib.figure import Figure
from matplotlib.patches import Patch, Rectangle

from reports.charts.style import ONE_COLUMN, new_figure, put_legend, wrapped
from reports.shown import Shown

# Effects of leaving an ingredient out from these shares on, with their colour and name.
_STEPS: tuple[tuple[float, str, str], ...] = (
    (0.0, "#eef3f8", "below 0.1 %"), (1e-3, "#c9dcee", "0.1 to 1 %"), (1e-2, "#f3c67a", "1 to 10 %"), (1e-1, "#e07b39", "10 % and more"),
)
_OTHER, _FAILED = ("#8c2d04", "≠ something else happens"), ("#d9d9d9", "the run says nothing")
_DARK_INK, _LIGHT_INK = "#1c1c1d", "#fffffe"  # in cells, which are alike on light and dark pages: colours that no dark page changes


def draw_ablation(data: Shown, width_mm: float) -> Figure:
    """A row an ingredient, a column a scene; colours by the size of the effect, the time below it."""
    wide = width_mm > ONE_COLUMN
    figure = new_figure(width_mm, 38.0 + 8.5 * len(data.rows))
    axes = figure.subplots()
    for place, (_, cells) in enumerate(data.rows):
        for column, cell in enumerate(cells):
            if cell is not None:
                _draw_cell(axes, column, place, cell, 1.0 if wide else 0.68)
    axes.set(xlim=(-0.5, len(data.columns) - 0.5), ylim=(len(data.rows) - 0.5, -0.5))
    axes.set_xticks(range(len(data.columns)), data.columns, fontsize=6, rotation=90)
    axes.xaxis.tick_top()
    axes.set_yticks(range(len(data.rows)), [label if wide else wrapped(label, 15) for label, _ in data.rows], fontsize=7 if wide else 6)
    axes.tick_params(length=0)
    for spine in axes.spines.values():
        spine.set_visible(False)
    put_legend(figure, [Patch(facecolor=look[-2], label=look[-1]) for look in (*_STEPS, _OTHER, _FAILED)], 3 if wide else 2)
    return figure


def _draw_cell(axes: Axes, column: int, place: int, cell: Shown, size: float) -> None:
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
    ink = _LIGHT_INK if cell.changes else _DARK_INK
    axes.text(column, place - 0.13, words, ha="center", va="center", fontsize=6.5 * size, color=ink)
    time = f"×{cell.time:.1f}" if cell.time >= 1.0 else f"×{cell.time:.2f}"
    axes.text(column, place + 0.28, time, ha="center", va="center", fontsize=5 * size, color=ink)
