"""Draws what was measured beside what runs gave, over time."""

from matplotlib.figure import Figure

from reports.charts.style import DASHED, INK, ONE_COLUMN, PALE, entry, panel_grid, put_legend
from reports.shown import Shown

_LOOKS = (("#0067a5", "-", 1.6), ("#d04a00", DASHED, 1.2), ("#00845f", (0, (3, 1.2, 1, 1.2)), 1.2), ("#a3397f", (0, (1, 1.5)), 1.4))


def draw_measured(data: Shown, width_mm: float) -> Figure:
    """A panel a quantity: points as measured, hollow ones less the gauges' zero, a line a run; grey up to where errors count."""
    figure, every, _ = panel_grid(len(data.panels), 58.0, width_mm)
    for axes, panel in zip(every, data.panels, strict=True):
        axes.grid(True)
        axes.axvspan(0.0, data.from_s, color=PALE, alpha=0.12, linewidth=0)
        for (_, times, values), (colour, dashes, width) in zip(panel.curves, _LOOKS):
            axes.plot(times, values, color=colour, linestyle=dashes, linewidth=width, zorder=3)
        axes.plot(panel.times, panel.points, linestyle="none", marker="o", markersize=3.6, color=INK, zorder=5)
        if panel.lowered:
            axes.plot(panel.times, panel.lowered, linestyle="none", marker="o", markersize=3.6, color=INK, markerfacecolor="white", zorder=4)
        axes.set(xlabel="time (s)", ylabel=f"{panel.heading.lower()} ({panel.unit})", xlim=(0.0, 1.04 * panel.times[-1]), ylim=(0.0, 1.12 * max(panel.points)))
    handles = [entry("measured", color=INK, marker="o", linestyle="none"),
               entry(f"measured less {data.zero_MPa:.3f} MPa", color=INK, marker="o", markerfacecolor="white", linestyle="none")]
    handles += [entry(name, color=colour, linestyle=dashes, linewidth=width) for (name, *_), (colour, dashes, width) in zip(data.panels[0].curves, _LOOKS)]
    put_legend(figure, handles, len(handles) if width_mm > ONE_COLUMN else 2)
    return figure
