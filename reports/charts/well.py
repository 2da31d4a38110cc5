"""Draws a well's layers and the depth of a fracture's upper tip against its pressure."""

import matplotlib.pyplot as plt
from matplotlib.figure import Figure

from reports.charts.style import DASHED, INK, PALE, entry, interface_lines, new_figure, put_legend
from reports.shown import Shown

_LOOKS = ((INK, "-", 5.0, 0.3), ("#0067a5", "-", 1.5, 1.0), ("#00845f", "-", 1.5, 1.0), ("#d04a00", DASHED, 1.5, 1.0))


def draw_well(data: Shown) -> Figure:
    """Left the closing stress of each layer, darker the stiffer its rock; right a line a way to compute the tip's depth."""
    figure = new_figure(9.4, 6.4, data.title, 98)
    left, right = figure.subplots(1, 2, sharey=True, width_ratios=(1.0, 2.2))
    shade = plt.get_cmap("Greys")
    for layer in data.layers:
        colour = shade(0.1 + 0.5 * layer.modulus_GPa / max(other.modulus_GPa for other in data.layers))
        left.barh(layer.top_m, layer.stress_MPa, layer.thickness_m, align="edge", color=colour, edgecolor="white", linewidth=0.6)
        left.text(data.least_MPa, layer.top_m + layer.thickness_m / 2.0, f" {layer.rock}, {layer.modulus_GPa:g} GPa", va="center", fontsize=7.5)
    left.set(xlabel="closing stress (MPa)", ylabel="depth (m)", xlim=(data.least_MPa, data.stop_MPa), ylim=(data.bottom_m, data.layers[-1].top_m))
    right.grid(True)
    interface_lines(right, [layer.top_m for layer in data.layers])
    for place, name in data.bedding:
        right.axhline(place, color=PALE, linewidth=1.8)
        right.annotate(name, (data.stop_MPa, place), ha="right", va="bottom", fontsize=8)
    for (_, pressures, depths), (colour, dashes, width, alpha) in zip(data.curves, _LOOKS, strict=True):
        right.plot(pressures, depths, drawstyle="steps-post", color=colour, linestyle=dashes, linewidth=width, alpha=alpha)
    right.set(xlabel="pressure in the fracture (MPa)", xlim=(data.least_MPa, data.stop_MPa))
    put_legend(figure, [entry(name, color=look[0], linestyle=look[1], linewidth=look[2], alpha=look[3]) for (name, *_), look in zip(data.curves, _LOOKS)], 2)
    return figure
