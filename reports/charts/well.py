"""Draws a well: its layers with the fracture in them, their closing stress, and the depth of the fracture's upper tip against its pressure."""

import matplotlib.pyplot as plt
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from reports.charts.style import DASHED, FLAG, FLUID, INK, TWO_COLUMNS, entry, interface_lines, new_figure, put_legend, wrapped
from reports.shown import Shown

_LOOKS = ((INK, "-", 5.0, 0.3), ("#0067a5", "-", 1.5, 1.0), ("#00845f", "-", 1.5, 1.0), ("#d04a00", DASHED, 1.5, 1.0))


def _draw_layout(axes: Axes, stress: Axes, data: Shown) -> None:
    """The layers as they lie, darker the stiffer, with what their borders are and the fracture at some pressures; beside them their closing stresses."""
    shade = plt.get_cmap("Greys")
    for layer in data.layers:
        colour = shade(0.05 + 0.45 * layer.modulus_GPa / max(other.modulus_GPa for other in data.layers))
        for panel, left, right in ((axes, 0.0, 1.0), (stress, data.least_MPa, layer.stress_MPa)):
            panel.barh(layer.top_m, right - left, layer.thickness_m, left=left, align="edge", color=colour, edgecolor="white", linewidth=0.6)
        axes.text(0.01, layer.top_m + 0.5 * layer.thickness_m, f"{layer.rock}, {layer.modulus_GPa:g} GPa", va="center", fontsize=5.6)
    for place, name in data.bedding:
        for panel in (axes, stress):
            panel.axhline(place, color=FLAG, linewidth=1.8)
        stress.text(data.stop_MPa, place, name, color=FLAG, fontsize=6.5, ha="right", va="bottom")
    places = [0.42 + 0.54 * k / (len(data.fractures) - 1) for k in range(len(data.fractures))]
    for x, (_, bottom, top) in zip(places, data.fractures):
        axes.plot((x, x), (bottom, top), color=FLUID, linewidth=2.2, solid_capstyle="butt")
    axes.set_xticks(places, [f"{pressure:.1f}" for pressure, _, _ in data.fractures], fontsize=5.6)
    axes.set(xlabel="layers, and the fracture at pressures (MPa)", ylabel="depth (m)", xlim=(0.0, 1.0), ylim=(data.bottom_m, data.layers[-1].top_m))
    stress.set(xlabel="closing stress (MPa)", xlim=(data.least_MPa, data.stop_MPa))


def draw_well(data: Shown) -> Figure:
    """Left the layout and the closing stress of each layer; right a line a way to compute the tip's depth."""
    figure = new_figure(TWO_COLUMNS, 115.0)
    figure.suptitle(wrapped(data.title, 118), x=0.008, ha="left", fontweight="bold")
    layout, stress, right = figure.subplots(1, 3, sharey=True, width_ratios=(1.3, 0.8, 2.2))
    _draw_layout(layout, stress, data)
    right.grid(True)
    interface_lines(right, [layer.top_m for layer in data.layers])
    for place, _ in data.bedding:
        right.axhline(place, color=FLAG, linewidth=1.8, alpha=0.6)
    for (_, pressures, depths), (colour, dashes, width, alpha) in zip(data.curves, _LOOKS, strict=True):
        right.plot(pressures, depths, drawstyle="steps-post", color=colour, linestyle=dashes, linewidth=width, alpha=alpha)
    right.set(xlabel="pressure in the fracture (MPa)", xlim=(data.least_MPa, data.stop_MPa))
    put_legend(figure, [entry(name, color=look[0], linestyle=look[1], linewidth=look[2], alpha=look[3]) for (name, *_), look in zip(data.curves, _LOOKS)], 2)
    return figure
